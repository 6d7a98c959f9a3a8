"""Test-analysis correlation of measured frequency responses with those of a case."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Bools, Complex, Floats
from vibroimpact.cases.schema import CaseTable
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.signals.decay.responses import common_lines, modes_in_responses
from vibroimpact.signals.frac import frac
from vibroimpact.signals.frequency_response import DegreeOfFreedom, FrequencyResponse
from vibroimpact.test_analysis.mode_pairs import pairs_of
from vibroimpact.test_analysis.octaves import frac_of_octaves, octaves_of
from vibroimpact.test_analysis.responses.computed import computed_responses
from vibroimpact.test_analysis.responses.doubts import doubts_about
from vibroimpact.test_analysis.responses.matching import UP, Matched, matched, unit_of
from vibroimpact.test_analysis.responses.result import ResponseCorrelation
from vibroimpact.test_analysis.shared_differences import shared_differences
from vibroimpact.test_analysis.simulated import plate_problem

_OPPOSITE = -0.5
"""Correlation coefficient below which a response is upside down."""
_FEWEST = 8
"""Least number of frequencies in the band."""


def correlate_responses(
    case: CaseTable,
    responses: Sequence[FrequencyResponse],
    *,
    reference: str | None = None,
    band: tuple[float, float] | None = None,
    progress: Callable[[float], None] | None = None,
) -> ResponseCorrelation:
    """Compare measured frequency responses with those of a case: amplitudes, phases, FRAC, and the
    modes of both.

    Parameters
    ----------
    case : Case
        The plate with its supports and damping, the sensors, named after the responses, and the
        place of the impact, where the force acts.
    responses : sequence of FrequencyResponse
        The measured responses, at the same frequencies.
    reference : str, optional
        Name in the file of the place that is that of the case's impact; by default the only one
        where a force acts, or else the only one where motion was measured, which is the same by
        reciprocity.
    band : tuple of two floats, optional
        The band of frequencies [Hz]; by default from half the lowest mode of the plate to its
        highest, as far as it was measured.
    progress : callable, optional
        Called with the fraction done while modes are computed.

    Raises
    ------
    InputError
        If the plate is rigid or moves, the impact is oblique, no sensor has a response, a direction
        or a unit is another, frequencies differ, or there are too few in the band.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> plate = {
    ...     "size": [0.3, 0.3, 0.02],
    ...     "material": "steel",
    ...     "model": "elastic",
    ...     "modes": 10,
    ...     "supports": "clamped",
    ...     "damping": 0.01,
    ... }
    >>> case = vi.read_case(
    ...     {
    ...         "sphere": {"radius": 0.02, "material": "steel"},
    ...         "plate": plate,
    ...         "drop": {"speed": 1.0, "position": [0.02, 0.01]},
    ...         "contact": {"law": "hertz"},
    ...         "sensors": [{"name": "a", "position": [0.1, 0.03]}],
    ...     }
    ... )
    >>> measured = vi.responses_of_case(case, np.arange(500.0, 4000.0, 2.0))
    >>> found = vi.correlate_responses(case, measured)
    >>> pair = found.modes[0]
    >>> abs(pair.frequency_difference) < 1e-6, round(pair.measured.damping_ratio.value, 5)
    (True, 0.01)
    """
    problem = plate_problem(case, progress)
    match = matched(problem.sensors, responses, reference)
    frequency, value = common_lines(match.responses)
    used = _band(problem, frequency, band)
    inside = (frequency >= used[0]) & (frequency <= used[1])
    if inside.sum() < _FEWEST:
        there = {0: "there is no frequency", 1: "there is one frequency"}.get(
            int(inside.sum()), f"there are {inside.sum()} frequencies"
        )
        words = (
            f"{there} from {used[0]:.5g} to {used[1]:.5g} Hz, and the responses are from "
            f"{frequency[0]:.5g} to {frequency[-1]:.5g} Hz"
        )
        remedy = (
            "measure at more frequencies"
            if band is None
            else "state a wider band, or measure at more frequencies"
        )
        raise InputError(f"{words}; {_FEWEST} are needed: {remedy}")
    found = modes_in_responses(match.responses, used)
    pairs = pairs_of(problem, match.sensors, found, used)
    differences = shared_differences(pairs)
    units = tuple(
        one.unit or unit_of(sensor)
        for sensor, one in zip(match.sensors, match.responses, strict=True)
    )
    stated = np.array(match.signs)[:, None]
    as_scaled = differences.scaled(problem)
    plates = (problem, as_scaled, differences.damped(as_scaled))
    simulated, scaled, damped = (
        stated * computed_responses(plate, match.sensors, units, frequency[inside])
        for plate in plates
    )
    polarity = _polarity(value[:, inside], damped, match)
    measured = polarity[:, None] * value[:, inside]
    octaves = octaves_of(used)
    compared = ResponseCorrelation(
        case=case,
        sensors=match.sensors,
        units=units,
        reference=match.reference,
        reciprocal=match.reciprocal,
        band=used,
        polarity=polarity if match.sense_known else polarity * _majority(polarity),
        frequency=frequency[inside],
        measured_response=measured,
        simulated_response=simulated,
        coherence=_coherence(match, inside),
        octaves=octaves,
        frac=frac(measured, simulated),
        octave_frac=frac_of_octaves(octaves, frequency[inside], measured, simulated),
        scaled_frac=frac(measured, scaled),
        damped_frac=frac(measured, damped),
        modes=pairs,
        doubts=(),
    )
    return replace(
        compared,
        doubts=tuple(
            doubts_about(compared, problem, match, differences, _norms(measured) / _norms(damped))
        ),
    )


def responses_of_case(
    case: CaseTable, frequency: object, progress: Callable[[float], None] | None = None
) -> tuple[FrequencyResponse, ...]:
    """Return the frequency responses of the sensors of a case to a force upwards at the place of
    its impact.

    Parameters
    ----------
    case : Case
        The case.
    frequency : array, shape (n,)
        Frequencies [Hz], rising, above 0.
    progress : callable, optional
        Called with the fraction done while modes are computed.

    Raises
    ------
    InputError
        If the plate is rigid or moves, the impact is oblique, there are no sensors or a microphone,
        or frequencies do not rise.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> plate = {
    ...     "size": [0.3, 0.3, 0.02],
    ...     "material": "steel",
    ...     "model": "elastic",
    ...     "modes": 10,
    ...     "supports": "clamped",
    ...     "damping": 0.01,
    ... }
    >>> case = vi.read_case(
    ...     {
    ...         "sphere": {"radius": 0.02, "material": "steel"},
    ...         "plate": plate,
    ...         "drop": {"speed": 1.0, "position": [0.02, 0.01]},
    ...         "contact": {"law": "hertz"},
    ...         "sensors": [{"name": "a", "position": [0.1, 0.03]}],
    ...     }
    ... )
    >>> (response,) = vi.responses_of_case(case, [200.0, 400.0, 800.0])
    >>> response.unit, len(response.value)
    ('m/s2/N', 3)
    """
    problem = plate_problem(case, progress)
    lines = np.asarray(frequency, dtype=float)
    units = tuple(unit_of(sensor) for sensor in problem.sensors)
    told = [
        FrequencyResponse(
            DegreeOfFreedom((sensor.name,)),
            DegreeOfFreedom(("impact",), UP),
            lines,
            np.ones(lines.shape, dtype=complex),
            unit,
        )
        for sensor, unit in zip(problem.sensors, units, strict=True)
    ]
    match = matched(problem.sensors, told, None)
    values = computed_responses(problem, match.sensors, units, lines)
    return tuple(replace(one, value=value) for one, value in zip(told, values, strict=True))


def _band(
    problem: Problem, frequency: Floats, band: tuple[float, float] | None
) -> tuple[float, float]:
    """Return the band of frequencies that is compared.

    Raises
    ------
    InputError
        If it reaches beyond what was measured, or the plate has no mode there.
    """
    modes = problem.plate.modes
    assert modes is not None  # `plate_problem` has seen to it
    first, last = float(frequency[0]), float(frequency[-1])
    if band is not None:
        if not (first <= band[0] < band[1] <= last):
            raise InputError(
                f"a band from {band[0]:g} to {band[1]:g} Hz is not allowed; it must rise, "
                f"within the {first:g} to {last:g} Hz measured"
            )
        return band
    lowest, highest = float(modes.frequencies[0]), float(modes.frequencies[-1])
    if lowest >= last:
        raise InputError(
            f"the lowest mode of the plate has {lowest:.5g} Hz, and the responses end at "
            f"{last:.5g} Hz; measure up to higher frequencies"
        )
    return max(0.5 * lowest, first), min(max(highest, 1.5 * lowest), last)


def _polarity(measured: Complex, simulated: Complex, match: Matched) -> Floats:
    """Return 1, or -1 for responses that are upside down: where it is not stated how the
    force is positive, as the clearest one is.
    """
    alike = np.real(np.sum(measured * simulated.conj(), axis=1))
    alike /= np.linalg.norm(measured, axis=1) * np.linalg.norm(simulated, axis=1)
    usual = 1.0
    if not match.sense_known and alike[np.argmax(np.abs(alike))] < _OPPOSITE:
        usual = -1.0
    return np.where(usual * alike < _OPPOSITE, -usual, usual)


def _majority(polarity: Floats) -> float:
    return 1.0 if polarity.sum() >= 0.0 else -1.0


def _norms(response: Complex) -> Floats:
    return np.asarray(np.linalg.norm(response, axis=1))


def _coherence(match: Matched, inside: Bools) -> Floats | None:
    """Return the coherences in the band, NaN of a response without; None if none has any."""
    if all(one.coherence is None for one in match.responses):
        return None
    untold = np.full(int(inside.sum()), np.nan)
    return np.stack(
        [untold if one.coherence is None else one.coherence[inside] for one in match.responses]
    )
