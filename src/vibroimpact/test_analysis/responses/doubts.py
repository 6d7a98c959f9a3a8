"""What is not sure about a correlation of frequency responses, and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.quoting import quoted
from vibroimpact.signals.decay.find import DecayMode
from vibroimpact.signals.frequency_response import FrequencyResponse
from vibroimpact.test_analysis.responses.matching import Matched
from vibroimpact.test_analysis.responses.result import ResponseCorrelation
from vibroimpact.test_analysis.shared_differences import SharedDifferences, doubts_of_differences

COHERENT = 0.9
"""Coherence below which a response is not sure: its standard deviation is then a quarter of it, of
one average.
"""

_MANY = 0.2
"""Fraction of the frequencies with a low coherence from which on it is reported; antiresonances
have some.
"""

_ALIKE = 0.9
_GAIN = 0.05
"""FRAC from which on a scale is that of a sensitivity, and the relative error of it that is
reported.
"""

_LARGE_GAIN = 0.5
"""Relative error of the size of other responses that is reported."""

_LINES = 3
"""Steps of the frequencies in a half-power bandwidth below which its damping is not resolved."""

_NAMED = 4
"""Number of names in a sentence."""


def doubts_about(
    correlation: ResponseCorrelation,
    problem: Problem,
    match: Matched,
    differences: SharedDifferences,
    scale: Floats,
) -> Iterator[str]:
    """Yield the doubts about a correlation, one sentence each without its full stop.

    Parameters
    ----------
    correlation : ResponseCorrelation
        The correlation.
    problem : Problem
        The problem of the case.
    match : Matched
        The responses.
    differences : SharedDifferences
        What the measured modes have in common that the case has not.
    scale : array, shape (S,)
        Measured over simulated size, without these differences.
    """
    yield from doubts_of_files(match.responses)
    if match.left_out:
        subject = "response has"
        verb = "is"
        if match.left_out > 1:
            subject = "responses have"
            verb = "are"
        yield (
            f"{match.left_out} {subject} no sensor of that name and direction in the case, and "
            f"{verb} not compared"
        )
    if match.reciprocal:
        yield (
            "the hammer was at the sensors, and the motion was measured at "
            f"{quoted(match.reference)}: taken as equal, by reciprocity"
        )
    for sensor, polarity in zip(correlation.sensors, correlation.polarity, strict=True):
        if polarity < 0.0:
            yield f"the response {quoted(sensor.name)} has inverted polarity; its sign is changed"
    yield from doubts_of_differences(
        differences, correlation.frac, correlation.scaled_frac, correlation.damped_frac
    )
    for row, sensor in enumerate(correlation.sensors):
        tolerance = _LARGE_GAIN
        if correlation.damped_frac[row] > _ALIKE:
            tolerance = _GAIN
        if abs(scale[row] - 1.0) > tolerance:
            yield (
                f"the response {quoted(sensor.name)} has {scale[row]:.3g} times the simulated "
                "magnitude: check the sensitivity, and mass and damping of the plate"
            )
    yield from _of_coherence(correlation)
    yield from doubts_of_resolution(
        [pair.measured for pair in correlation.modes if pair.measured is not None],
        correlation.frequency,
    )
    assert problem.plate.modes is not None
    highest = float(problem.plate.modes.frequencies[-1])
    if highest < correlation.band[1]:
        yield (
            f"the modes of the case end at {highest:.5g} Hz, and the band at "
            f"{correlation.band[1]:.5g} Hz: ask for more modes"
        )


def doubts_of_files(responses: Sequence[FrequencyResponse]) -> Iterator[str]:
    """Yield the doubts about measured responses, each once for all that share it."""
    names_of: dict[tuple[str, str], list[str]] = {}
    for response in responses:
        for doubt in response.doubts:
            names_of.setdefault((response.source, doubt), []).append(quoted(response.name))
    for (source, doubt), names in names_of.items():
        yield f"{source or 'the file'}, {_few(names)}: {doubt}"


def _few(names: Sequence[str]) -> str:
    """Return the first names, and that there are more."""
    listed = ", ".join(names[:_NAMED])
    if len(names) > _NAMED:
        return f"{listed} and more"
    return listed


def _of_coherence(correlation: ResponseCorrelation) -> Iterator[str]:
    """Yield where a response is not coherent with the force."""
    if correlation.coherence is None:
        return
    mode_frequencies = [
        pair.measured.frequency.value for pair in correlation.modes if pair.measured is not None
    ]
    mode_lines = [
        int(np.argmin(np.abs(correlation.frequency - frequency))) for frequency in mode_frequencies
    ]
    for sensor, coherence in zip(correlation.sensors, correlation.coherence, strict=True):
        where = []
        low = [
            f"{correlation.frequency[line]:.4g}"
            for line in mode_lines
            if coherence[line] < COHERENT
        ]
        if low:
            ending = "s" if len(low) > 1 else ""
            where.append(f"at the mode{ending} of {_few(low)} Hz")
        fraction = float((coherence < COHERENT).mean())
        if fraction > _MANY:
            where.append(f"at {100.0 * fraction:.2g} % of the frequencies")
        if where:
            yield (
                f"the coherence of {quoted(sensor.name)} is below {COHERENT} "
                f"{' and '.join(where)}: noise, leakage, a second hit, or a nonlinearity; "
                "magnitude and damping are uncertain there"
            )


def doubts_of_resolution(modes: Sequence[DecayMode], frequency: Floats) -> Iterator[str]:
    """Yield modes that are narrower than what the frequencies resolve."""
    step = float(np.median(np.diff(frequency)))
    narrow = [
        f"{mode.frequency.value:.4g}"
        for mode in modes
        if 2.0 * mode.damping_ratio.value * mode.frequency.value < _LINES * step
    ]
    if narrow:
        if len(narrow) > 1:
            bandwidths = f"bandwidths of the modes of {_few(narrow)} Hz are"
        else:
            bandwidths = f"bandwidth of the mode of {narrow[0]} Hz is"
        yield (
            f"the half-power {bandwidths} below {_LINES} steps of the frequencies, {step:.3g} Hz "
            "each: a window or a record that was cut off makes damping look larger; measure longer"
        )
