"""Modes in the decay of records: against the tones that they are sums of."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.signals.record import Record

RATE, SAMPLES = 12800.0, 4800
FREQUENCIES = (310.0, 800.0, 815.0, 1700.3, 3100.0)
RATIOS = (0.008, 0.004, 0.006, 0.01, 0.02)


def tone(frequency: float, ratio: float, phase: float = 0.4) -> np.ndarray:
    time = np.arange(SAMPLES) / RATE
    decay, omega = (
        2.0 * np.pi * ratio * frequency,
        2.0 * np.pi * frequency * np.sqrt(1.0 - ratio**2),
    )
    return np.asarray(np.exp(-decay * time) * np.sin(omega * time + phase))


def record(value: np.ndarray, noise: float = 0.0, seed: int = 0) -> Record:
    return Record(
        "a", value + noise * np.random.default_rng(seed).standard_normal(len(value)), RATE, "m/s2"
    )


def test_a_sum_without_noise() -> None:
    found = vi.signals.modes_in_decay(
        [record(sum(map(tone, FREQUENCIES, RATIOS)))], (200.0, 5000.0)
    )
    assert [mode.frequency.value for mode in found] == pytest.approx(FREQUENCIES, rel=1e-6)
    assert [mode.damping_ratio.value for mode in found] == pytest.approx(RATIOS, rel=1e-4)
    assert [mode.amplitude[0] for mode in found] == pytest.approx(np.ones(5), rel=1e-3)
    assert not any(mode.doubt for mode in found)


def test_a_sum_in_noise() -> None:
    value = sum(map(tone, FREQUENCIES, RATIOS))
    found = vi.signals.modes_in_decay(
        [record(value, 0.01 * np.sqrt(np.mean(value**2)), seed=3)], (200.0, 5000.0)
    )
    assert [mode.frequency.value for mode in found] == pytest.approx(FREQUENCIES, rel=1e-4)
    for mode, frequency, ratio in zip(found, FREQUENCIES, RATIOS, strict=True):
        assert abs(mode.frequency.value - frequency) < 3.5 * mode.frequency.deviation
        assert abs(np.log(mode.damping_ratio.value / ratio)) < 3.5 * mode.damping_ratio.deviation
        assert mode.damping_ratio.deviation < 0.02


def test_records_together_tell_more_than_one() -> None:
    """A mode that one record hears and the other does not, under noise of different levels."""
    one, other = tone(800.0, 0.004), tone(1300.0, 0.01)
    records = [record(one + 0.3 * other, 0.02, seed=1), record(other, 0.002, seed=2)]
    found = vi.signals.modes_in_decay(records, (500.0, 2000.0))
    assert [mode.frequency.value for mode in found] == pytest.approx([800.0, 1300.0], rel=1e-4)
    assert found[0].amplitude == pytest.approx((1.0, 0.0), abs=0.01)
    assert found[1].amplitude == pytest.approx((0.3, 1.0), rel=0.02)
    alone = vi.signals.modes_in_decay(records[:1], (500.0, 2000.0))
    assert found[1].damping_ratio.deviation < 0.3 * alone[1].damping_ratio.deviation


def test_modes_too_close_are_one_or_are_doubted() -> None:
    value = tone(800.0, 0.004) + tone(800.4, 0.004, 2.0)
    found = vi.signals.modes_in_decay([record(value, 0.02)], (500.0, 1200.0))
    assert len(found) == 1 or all("too close to the mode at" in mode.doubt for mode in found)


def test_a_weak_mode_is_doubted() -> None:
    value = tone(800.0, 0.004) + 0.02 * tone(1300.0, 0.02)
    found = vi.signals.modes_in_decay([record(value, 0.015)], (500.0, 2000.0))
    assert found[0].doubt == ""
    assert all(mode.doubt == "too noisy, or too weak" for mode in found[1:])


@pytest.mark.parametrize("seed", range(3))
def test_noise_has_no_modes(seed: int) -> None:
    assert vi.signals.modes_in_decay([record(np.zeros(SAMPLES), 1.0, seed)], (200.0, 5000.0)) == ()


def test_deviations_are_near_the_bound_of_cramer_and_rao() -> None:
    """Of one tone that has decayed, of unit amplitude: var(decay) = var(omega) = 16 decay^3 v under
    white noise of variance v.

    The fit does not see what lies outside the band, nor what its polynomial takes of the tails.
    """
    decay = 2.0 * np.pi * 0.01 * 800.0 / RATE
    (mode,) = vi.signals.modes_in_decay([record(tone(800.0, 0.01), 0.003)], (500.0, 1200.0))
    bound = 4.0 * decay**1.5 * 0.003
    assert 1.0 < mode.damping_ratio.deviation / (bound / decay) < 1.2
    assert 1.0 < mode.frequency.deviation / (bound * RATE / (2.0 * np.pi)) < 1.2


@pytest.mark.parametrize(
    ("records", "band", "words"),
    [
        ([], (200.0, 500.0), "no record"),
        ([record(np.zeros(SAMPLES))], (200.0, 5000.0), '"a" is constant'),
        ([record(np.full(SAMPLES, np.nan))], (200.0, 5000.0), "not a finite number"),
        (
            [record(tone(800.0, 0.01)), record(tone(800.0, 0.01)[1:])],
            (200.0, 5000.0),
            "different rates or numbers of samples",
        ),
        (
            [record(tone(800.0, 0.01))],
            (500.0, 200.0),
            "its ends must rise, from above 0 to 6400 Hz",
        ),
        (
            [record(tone(800.0, 0.01))],
            (500.0, 7000.0),
            "its ends must rise, from above 0 to 6400 Hz",
        ),
        ([record(tone(800.0, 0.01)[:100])], (700.0, 900.0), "take a longer decay or a wider band"),
    ],
)
def test_what_is_refused(records: list[Record], band: tuple[float, float], words: str) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.signals.modes_in_decay(records, band)
