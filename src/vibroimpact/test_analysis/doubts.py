"""What is not sure about a correlation, and why."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.quoting import quoted
from vibroimpact.signals.delay import Delay
from vibroimpact.test_analysis.acquired import LEAD, Acquired
from vibroimpact.test_analysis.excitation import Excited, is_excited
from vibroimpact.test_analysis.flat_tops import clipped_count

_ALIKE = 0.7
"""Correlation coefficient below which the delay may be off by a period."""

_TOGETHER = 0.5
"""Delay behind a force of the same acquisition that is none, in samples."""

_GAIN = 0.05
_GAIN_ALIKE = 0.95
"""Logarithm of a gain from which on it is doubted, and the correlation coefficient from which on
it is one.
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
    yield from _of_rates(problem, acquired)
    yield from _of_records(acquired, delay, aligned)
    yield from _of_skew(acquired, skew)
    yield from _of_gains(acquired, corrected, f"in the first {1e3 * aligned:.3g} ms")
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


def _of_rates(problem: Problem, acquired: Acquired) -> Iterator[str]:
    """Yield the doubt about sensors of the case with another rate than the records."""
    recorded = {sensor.name for sensor in acquired.sensors}
    rates = {sensor.rate for sensor in problem.sensors if sensor.name in recorded}
    rates -= {acquired.rate}
    if rates:
        others = ", ".join(f"{rate:g}" for rate in sorted(rates))
        yield (
            f"the records have {acquired.rate:g} samples per second, and the case specifies "
            f"{others}: it was simulated at the rate of the records"
        )


def _of_records(acquired: Acquired, delay: Delay, aligned: float) -> Iterator[str]:
    """Yield the doubts about each record: its polarity, its correlation, and clipping."""
    for row, sensor in enumerate(acquired.sensors):
        name = quoted(sensor.name)
        if delay.polarity[row] < 0.0:
            yield f"the record {name} has inverted polarity; its sign is changed"
        if delay.correlation[row] < _ALIKE:
            yield (
                f"the first {1e3 * aligned:.3g} ms of {name} and of its simulation differ "
                f"(correlation {delay.correlation[row]:.2f}): the delay may be wrong by a period"
            )
        yield from _clipped(
            f"the record {name}",
            acquired.value[row],
            acquired.recorded[row],
            acquired.onsets[0],
            "its FRAC and residual suffer, and its damping if it is clipped after "
            "the end of the force",
        )


def _of_skew(acquired: Acquired, skew: Floats) -> Iterator[str]:
    """Yield the doubts about records that are later than the others, by `skew` [s]."""
    for sensor, delay in zip(acquired.sensors, skew, strict=True):
        if delay:
            direction = "later" if delay > 0.0 else "earlier"
            yield (
                f"the record {quoted(sensor.name)} comes {abs(delay) * acquired.rate:.3g} samples "
                f"{direction} than the others and its simulation: its channel may not have been "
                "sampled with theirs, or it passed another filter; its FRAC and residual suffer"
            )


def _clipped(
    subject: str, value: Floats, recorded: Floats, onset: int, consequence: str
) -> Iterator[str]:
    count = clipped_count(value, recorded, value[: max(0, onset - LEAD)])
    if count:
        yield (
            f"{subject} is clipped: at least {count} samples lie at an end of its range; "
            f"{consequence}"
        )


def _of_gains(acquired: Acquired, delay: Delay, early: str) -> Iterator[str]:
    """Yield the doubts about records that are larger or smaller than their simulations.

    Else they are like them. `early`: when.
    """
    gain = np.abs(delay.gain)
    log_gain = np.log(np.maximum(gain, 1e-300))
    doubtful = (delay.correlation > _GAIN_ALIKE) & (np.abs(log_gain) > _GAIN)
    if doubtful.all() and np.ptp(np.log(gain)) < _GAIN:
        # all by the same factor: an error that they have in common
        if len(gain) > 1:
            subject = "all records are"
            sensitivities = "the sensitivities"
        else:
            subject = "the record is"
            sensitivities = "the sensitivity"
        if acquired.force is None:
            source = "the impact and the contact of the case"
        else:
            source = "the calibration of the force"
        yield (
            f"{subject} {np.exp(np.mean(np.log(gain))):.3g} times the simulation {early}: check "
            f"{source}, {sensitivities}, and mass and damping of the plate"
        )
        return
    for row in np.flatnonzero(doubtful):
        yield (
            f"the record {quoted(acquired.sensors[row].name)} is {gain[row]:.3g} times its "
            f"simulation {early}: check its sensitivity and position, and the damping of the case"
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
        subject = "the only record has"
        if len(delay.polarity) > 1:
            subject = "all records have"
        yield f"{subject} inverted polarity: the sign of the force may be wrong"
    samples = delay.time * acquired.rate
    if abs(samples) > _TOGETHER:
        direction = "later" if samples > 0.0 else "earlier"
        yield (
            f"the records come {abs(samples):.3g} samples {direction} than computed from the "
            "force: the channels may not have been sampled simultaneously, or passed different "
            "filters"
        )
    if len(acquired.pulses) > len(acquired.onsets):
        yield (
            f"double hit of the hammer: there are {len(acquired.pulses)} pulses of force in "
            f"{len(acquired.onsets)} hits"
        )


def _of_excitation(acquired: Acquired, excited: Excited) -> Iterator[str]:
    """Yield where the force excites little."""
    band = excited.compared
    ends = excited.ends
    if ends is None:
        return
    if acquired.force is None:
        force = "the contact force of the case"
        harder = "a smaller or harder sphere"
    else:
        force = "the force"
        harder = "a harder tip"
    fallen = f"the spectrum of {force} has fallen by 20 dB at {ends:.4g} Hz"
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
    elif acquired.force is not None:  # what is divided by it is noise
        yield f"{fallen}; use {harder}, or a band that ends there"
