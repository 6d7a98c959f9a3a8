"""What is not sure about a correlation, and why."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.quoting import quoted
from vibroimpact.signals.delay import Delay
from vibroimpact.signals.flat_tops import clipped_count
from vibroimpact.test_analysis.acquired import LEAD, Acquired
from vibroimpact.test_analysis.excitation import Excited, is_excited

_ALIKE = 0.7
"""Correlation coefficient below which the delay may be off by a period."""
_TOGETHER = 0.5
"""Delay behind a force of the same acquisition that is none, in samples."""
_GAIN, _GAIN_ALIKE = 0.05, 0.95
"""Logarithm of a gain from which on it is doubted, and the correlation coefficient from
which on it is one.
"""


def doubts_about(
    problem: Problem,
    acquired: Acquired,
    delay: Delay,
    corrected: Delay,
    skew: Floats,
    excited: Excited,
    aligned: float,
) -> Iterator[str]:
    """Yield the doubts about a correlation, one sentence each without its full stop.

    Parameters
    ----------
    problem : Problem
        The problem of the case.
    acquired : Acquired
        The records.
    delay : Delay
        How they were aligned.
    corrected : Delay
        How they are aligned with a simulation of frequencies and damping as they were measured.
    skew : array, shape (S,)
        How much later each record is than the others [s].
    excited : Excited
        The bands of frequencies, and where the force ends.
    aligned : float
        Time from the first touch on by which they were aligned [s].
    """
    early = f"in the first {1e3 * aligned:.3g} ms"
    rates = {
        sensor.rate
        for sensor in problem.sensors
        if sensor.name in {one.name for one in acquired.sensors}
    } - {acquired.rate}
    if rates:
        others = ", ".join(f"{rate:g}" for rate in sorted(rates))
        words = "it was simulated at the rate of the records"
        yield (
            f"the records have {acquired.rate:g} samples per second, and the case specifies "
            f"{others}: {words}"
        )
    of_sensors = acquired.recorded[: len(acquired.sensors)]
    parts = zip(
        acquired.sensors, acquired.value, of_sensors, delay.polarity, delay.correlation, strict=True
    )
    for sensor, value, recorded, sign, alike in parts:
        name = quoted(sensor.name)
        if sign < 0.0:
            yield f"the record {name} has inverted polarity; its sign is changed"
        if alike < _ALIKE:
            words = (
                f"the first {1e3 * aligned:.3g} ms of {name} and of its simulation differ "
                f"(correlation {alike:.2f})"
            )
            yield f"{words}: the delay may be wrong by a period"
        suffers = (
            "its FRAC and residual suffer, and its damping if it is clipped after "
            "the end of the force"
        )
        yield from _clipped(f"the record {name}", value, recorded, acquired.onsets[0], suffers)
    for sensor, late in zip(acquired.sensors, skew, strict=True):
        if late:
            words = (
                f"{abs(late) * acquired.rate:.3g} samples "
                f"{'later' if late > 0.0 else 'earlier'} than the others and its simulation"
            )
            cause = "its channel may not have been sampled with theirs, or it passed another filter"
            yield (
                f"the record {quoted(sensor.name)} comes {words}: {cause}; its FRAC and "
                "residual suffer"
            )
    yield from _of_gains(acquired, corrected, early)
    if acquired.force is not None:
        yield from _of_force(acquired, delay)
    yield from _of_excitation(acquired, excited)
    assert problem.plate.modes is not None
    highest = float(problem.plate.modes.frequencies[-1])
    if highest < excited.sought[1]:
        yield (
            f"the modes of the case end at {highest:.5g} Hz, and modes are sought up to "
            f"{excited.sought[1]:.5g} Hz: ask for more modes"
        )


def _clipped(
    what: str, value: np.ndarray, recorded: np.ndarray, onset: int, suffers: str
) -> Iterator[str]:
    samples = clipped_count(value, recorded, value[: max(0, onset - LEAD)])
    if samples:
        yield f"{what} is clipped: at least {samples} samples lie at an end of its range; {suffers}"


def _of_gains(acquired: Acquired, delay: Delay, early: str) -> Iterator[str]:
    """Yield the doubts about records that are larger or smaller than their simulations,
    which else are like them; `early`: when.
    """
    gain, like = np.abs(delay.gain), delay.correlation > _GAIN_ALIKE
    others = (
        "the impact and the contact of the case"
        if acquired.force is None
        else "the calibration of the force"
    )
    off = like & (np.abs(np.log(np.maximum(gain, 1e-300))) > _GAIN)
    if off.all() and np.ptp(np.log(gain)) < _GAIN:
        every = (
            f"{'all records are' if len(gain) > 1 else 'the record is'} "
            f"{np.exp(np.mean(np.log(gain))):.3g} times the simulation"
        )
        sensitivities = "the sensitivities" if len(gain) > 1 else "the sensitivity"
        yield f"{every} {early}: check {others}, {sensitivities}, and mass and damping of the plate"
        return
    for sensor, times, wrong in zip(acquired.sensors, gain, off, strict=True):
        if wrong:
            words = "check its sensitivity and place, and the damping of the case"
            yield (
                f"the record {quoted(sensor.name)} is {times:.3g} times its simulation {early}: "
                f"{words}"
            )


def _of_force(acquired: Acquired, delay: Delay) -> Iterator[str]:
    """Yield the doubts about the force of a hammer."""
    assert acquired.force is not None
    yield from _clipped(
        "the force",
        acquired.force,
        acquired.recorded[-1],
        acquired.onsets[0],
        "frequency responses and simulation suffer",
    )
    if (delay.polarity < 0.0).all():
        every = "all records have" if len(delay.polarity) > 1 else "the only record has"
        yield f"{every} inverted polarity: the sign of the force may be wrong"
    samples = delay.time * acquired.rate
    if abs(samples) > _TOGETHER:
        way = "later" if samples > 0.0 else "earlier"
        words = f"the records come {abs(samples):.3g} samples {way} than computed from the force"
        yield (
            f"{words}: the channels may not have been sampled simultaneously, or passed "
            "different filters"
        )
    if len(acquired.pulses) > len(acquired.onsets):
        yield (
            f"double hit of the hammer: there are {len(acquired.pulses)} pulses of force in "
            f"{len(acquired.onsets)} hits"
        )


def _of_excitation(acquired: Acquired, excited: Excited) -> Iterator[str]:
    """Yield where the force excites little."""
    band, ends = excited.compared, excited.ends
    if ends is None:
        return
    measured = acquired.force is not None
    fallen = (
        f"the spectrum of {'the force' if measured else 'the contact force of the case'} has "
        f"fallen by 20 dB at {ends:.4g} Hz"
    )
    harder = "a harder tip" if measured else "a smaller or harder sphere"
    if not is_excited(band, ends):
        yield (
            f"{fallen}, and the band begins at {band[0]:.4g} Hz: hardly anything is excited in "
            f"it; use {harder}"
        )
    elif ends == band[1]:
        yield (
            f"{fallen}, where the band ends: only decays are evaluated above; use {harder} to "
            "compare more, or state a band"
        )
    elif measured:  # what is divided by it is noise
        yield f"{fallen}; use {harder}, or a band that ends there"
