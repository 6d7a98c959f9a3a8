"""Records of bouncing balls, made by hand."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import vibroimpact as vi

RATE = 48_000.0
# frequency, decay and amplitude of what rings
_TONES = ((2300.0, 3e-3, 1.0), (5100.0, 1.5e-3, 0.6))


class Heard(NamedTuple):
    """A record, the times of the touches [s], and the restitution of each but the first
    and the last.
    """

    record: vi.signals.Record
    touches: np.ndarray
    restitution: np.ndarray


def burst(time: np.ndarray, at: float) -> np.ndarray:
    """What a touch sounds like, of amplitude 1."""
    since = (time - at).clip(0.0)
    rise = -np.expm1(-since / 1.5e-4)
    return rise**2 * sum(
        size * np.exp(-since / decay) * np.sin(2.0 * np.pi * one * since)
        for one, decay, size in _TONES
    )


def heard(
    seed: int,
    restitution: float,
    touches: int,
    *,
    decibels: float = np.inf,
    hum: float = 0.0,
    clicks: int = 0,
    doubles: int = 0,
    flight: float = 0.4,
    rate: float = RATE,
) -> Heard:
    """Bounces in white noise, so many decibels below the mean power, with hum, clicks and
    second contacts of the first bounces.
    """
    random = np.random.default_rng(seed)
    flights = flight * restitution ** np.arange(touches - 1)
    times = 0.2 + random.uniform(0.0, 1e-3) + np.concatenate([[0.0], np.cumsum(flights)])
    time = np.arange(int((times[-1] + 0.3) * rate)) / rate
    value = np.zeros_like(time)
    for number, at in enumerate(times):
        value += restitution**number * burst(time, at)
        if number < doubles:
            value += 0.5 * restitution**number * burst(time, at + random.uniform(1.5e-3, 4e-3))
    value += random.normal(
        scale=np.sqrt(np.mean(value**2)) * 10.0 ** (-decibels / 20.0), size=len(time)
    )
    value += hum * np.sin(2.0 * np.pi * 50.0 * time + random.uniform(0.0, 6.0))
    value[random.integers(0, len(time), clicks)] += random.choice(
        [-1.0, 1.0], clicks
    ) * random.uniform(0.5, 2.0, clicks)
    return Heard(
        vi.signals.Record("microphone", value, rate, "Pa"), times, np.full(touches - 2, restitution)
    )


def music(seed: int, duration: float = 5.0) -> vi.signals.Record:
    """Plucked notes, at random times or in a rhythm."""
    random = np.random.default_rng(seed)
    value = random.normal(scale=0.02, size=int(duration * RATE))
    time = np.arange(4800) / RATE
    rhythm = (
        np.sort(random.uniform(0.1, duration, random.integers(8, 40))),
        np.arange(0.1, duration, random.choice([0.2, 0.25, 0.5])) + random.normal(scale=3e-3),
        0.1 + np.cumsum(random.choice([0.125, 0.25, 0.5], size=20)),
    )[seed % 3]
    for at in rhythm[rhythm < duration - 0.2]:
        first = int(at * RATE)
        tone = np.exp(-time / 0.02) * np.sin(
            2.0 * np.pi * random.choice([440.0, 880.0, 1320.0, 2200.0]) * time
        )
        value[first : first + len(time)] += random.uniform(0.2, 1.0) * tone
    return vi.signals.Record("microphone", value, RATE, "Pa")
