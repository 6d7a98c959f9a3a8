"""Modes in decays against the tones that they are made of: how many of the 95 % intervals
hold the truth.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees

AGAINST = Against(
    "synthetic decay signals with known parameters",
    "closed form",
    "sensors and signals",
    "five damped tones with noise at -40 dB, in the test",
)


RATE, SAMPLES, DRAWS = 25600.0, 8192, 240
FREQUENCIES = np.array([310.0, 800.0, 815.0, 1700.3, 3100.0])
RATIOS = np.array([0.008, 0.004, 0.006, 0.01, 0.02])


@pytest.mark.slow
def test_intervals_hold_the_truth(agrees: Agrees, population: Callable[..., int]) -> None:
    """Five tones of random sizes and phases under noise 40 dB down: 95 % of the intervals
    hold, none is missed, and few are invented.
    """
    time = np.arange(SAMPLES) / RATE
    draws = population(DRAWS)
    held, invented = np.zeros(2), 0
    for seed in range(draws):
        random = np.random.default_rng(seed)
        phases, sizes = random.uniform(0.0, 2.0 * np.pi, (5, 1)), random.uniform(0.5, 1.5, (5, 1))
        omega = 2.0 * np.pi * FREQUENCIES[:, None]
        tones = np.exp(-RATIOS[:, None] * omega * time) * np.sin(
            omega * np.sqrt(1.0 - RATIOS[:, None] ** 2) * time + phases
        )
        value = (sizes * tones).sum(axis=0)
        value += 0.01 * np.sqrt(np.mean(value**2)) * random.standard_normal(SAMPLES)
        found = vi.signals.modes_in_decay(
            [vi.signals.Record("a", value, RATE, "m/s2")], (200.0, 5000.0)
        )
        invented += len(found) - 5
        for frequency, ratio in zip(FREQUENCIES, RATIOS, strict=True):
            mode = min(found, key=lambda one: abs(one.frequency.value - frequency))
            agrees(
                "240 decays of five tones, signal-to-noise ratio 40 dB",
                "natural frequency",
                mode.frequency.value,
                frequency,
                unit="Hz",
                relative=1e-3,
            )
            truths = (mode.frequency, frequency), (mode.damping_ratio, ratio)
            held += [one.interval[0] <= truth <= one.interval[1] for one, truth in truths]
    assert invented <= 0.02 * draws
    part = held / (5 * draws)  # of frequencies and of damping ratios
    agrees(
        "240 decays of five tones, signal-to-noise ratio 40 dB",
        "coverage of the 95 % confidence intervals",
        part,
        0.95,
        absolute=0.02,
    )
