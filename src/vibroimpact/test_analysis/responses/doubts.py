"""What is not sure about a correlation of frequency responses, and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.quoting import quoted
from vibroimpact.signals.decay.find import DecayMode
from vibroimpact.signals.frequency_response import FrequencyResponse
from vibroimpact.test_analysis.responses.matching import Matched
from vibroimpact.test_analysis.responses.result import ResponseCorrelation
from vibroimpact.test_analysis.shared_differences import SharedDifferences, doubts_of_differences

COHERENT = 0.9
"""Coherence below which a response is not sure: its standard deviation is then a quarter
of it, of one average.
"""
_MANY = 0.2
"""Part of the frequencies with a low coherence from which on it is said; antiresonances
have some.
"""
_ALIKE, _GAIN = 0.9, 0.05
"""FRAC from which on a scale is that of a sensitivity, and the relative error of it that
is said.
"""
_LARGE_GAIN = 0.5
"""Relative error of the size of a response that is said of others."""
_LINES = 3
"""Steps of the frequencies in a half-power bandwidth below which its damping is not resolved."""
_NAMED = 4


def doubts_about(
    found: ResponseCorrelation,
    problem: Problem,
    match: Matched,
    differences: SharedDifferences,
    scale: Floats,
) -> Iterator[str]:
    """Yield the doubts about a correlation, one sentence each without its full stop.

    Parameters
    ----------
    found : ResponseCorrelation
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
        number, have = match.left_out, "responses have" if match.left_out > 1 else "response has"
        yield (
            f"{number} {have} no sensor of that name and direction in the case, and "
            f"{'are' if number > 1 else 'is'} not compared"
        )
    if match.reciprocal:
        yield (
            "the hammer was at the sensors, and the motion was measured at "
            f"{quoted(match.reference)}: taken as equal, by reciprocity"
        )
    for name, sign in zip((sensor.name for sensor in found.sensors), found.polarity, strict=True):
        if sign < 0.0:
            yield f"the response {quoted(name)} has inverted polarity; its sign is changed"
    yield from doubts_of_differences(differences, found.frac, found.scaled_frac, found.damped_frac)
    for name, size, of in zip(
        (sensor.name for sensor in found.sensors), scale, found.damped_frac, strict=True
    ):
        if abs(size - 1.0) > (_GAIN if of > _ALIKE else _LARGE_GAIN):
            words = f"the response {quoted(name)} has {size:.3g} times the simulated magnitude"
            yield f"{words}: check the sensitivity, and mass and damping of the plate"
    yield from _of_coherence(found)
    yield from doubts_of_resolution(
        [pair.measured for pair in found.modes if pair.measured is not None], found.frequency
    )
    assert problem.plate.modes is not None
    highest = float(problem.plate.modes.frequencies[-1])
    if highest < found.band[1]:
        yield (
            f"the modes of the case end at {highest:.5g} Hz, and the band at "
            f"{found.band[1]:.5g} Hz: ask for more modes"
        )


def doubts_of_files(responses: Sequence[FrequencyResponse]) -> Iterator[str]:
    """Yield the doubts about measured responses, each once for all that share it."""
    shared: dict[tuple[str, str], list[str]] = {}
    for one in responses:
        for doubt in one.doubts:
            shared.setdefault((one.source, doubt), []).append(quoted(one.name))
    for (source, doubt), names in shared.items():
        yield f"{source or 'the file'}, {_few(names)}: {doubt}"


def _few(names: Sequence[str]) -> str:
    return f"{', '.join(names[:_NAMED])}{' and more' if len(names) > _NAMED else ''}"


def _of_coherence(found: ResponseCorrelation) -> Iterator[str]:
    """Yield where a response is not coherent with the force."""
    if found.coherence is None:
        return
    places = [pair.measured.frequency.value for pair in found.modes if pair.measured is not None]
    nearest = [int(np.argmin(np.abs(found.frequency - place))) for place in places]
    for sensor, coherence in zip(found.sensors, found.coherence, strict=True):
        part = float((coherence < COHERENT).mean())
        low = [f"{found.frequency[line]:.4g}" for line in nearest if coherence[line] < COHERENT]
        at = f"at the mode{'s' if len(low) > 1 else ''} of {_few(low)} Hz" if low else ""
        many = f"at {100.0 * part:.2g} % of the frequencies" if part > _MANY else ""
        if at or many:
            words = (
                f"the coherence of {quoted(sensor.name)} is below {COHERENT} "
                f"{' and '.join(filter(None, (at, many)))}"
            )
            yield (
                f"{words}: noise, leakage, a second hit, or a nonlinearity; magnitude and "
                "damping are uncertain there"
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
        places = (
            f"bandwidths of the modes of {_few(narrow)} Hz are"
            if len(narrow) > 1
            else f"bandwidth of the mode of {narrow[0]} Hz is"
        )
        words = (
            f"the half-power {places} below {_LINES} steps of the frequencies, {step:.3g} Hz each"
        )
        yield (
            f"{words}: a window or a record that was cut off makes "
            "damping look larger; measure longer"
        )
