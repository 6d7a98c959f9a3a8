"""Test-analysis correlation of measured frequency responses with those of a case."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Bools, Complex, Floats
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.statement.problem import Problem
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
    """Compare measured frequency responses with those of a case.

    Compared are amplitudes, phases, FRAC, and the modes of both.

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
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 10})
    >>> measured = vi.test_analysis.responses_of_case(case, np.arange(50.0, 400.0, 0.5))
    >>> pair = vi.test_analysis.correlate_responses(case, measured).modes[0]
    >>> abs(pair.frequency_difference) < 1e-6, round(pair.measured.damping_ratio.value, 5)
    (True, 0.02)
    """
    problem = plate_problem(case, progress)
    match = matched(problem.sensors, responses, reference)
    all_frequencies, all_values = common_lines(match.responses)
    compared = _band(problem, all_frequencies, band)
    inside = (all_frequencies >= compared[0]) & (all_frequencies <= compared[1])
    _check_lines(all_frequencies, inside, compared, stated=band is not None)
    frequency = all_frequencies[inside]
    modes = modes_in_responses(match.responses, compared)
    pairs = pairs_of(problem, match.sensors, modes, compared)
    differences = shared_differences(pairs)
    units = tuple(
        response.unit or unit_of(sensor)
        for sensor, response in zip(match.sensors, match.responses, strict=True)
    )
    signs = np.array(match.signs)[:, None]

    def computed(plate: Problem) -> Complex:
        return signs * computed_responses(plate, match.sensors, units, frequency)

    scaled_problem = differences.scaled(problem)
    simulated = computed(problem)
    scaled = computed(scaled_problem)
    damped = computed(differences.damped(scaled_problem))
    # of the simulation that is most like the measurement
    polarity = _polarity(all_values[:, inside], damped, match)
    measured = polarity[:, None] * all_values[:, inside]
    # where the sense of the force is not stated, most responses count as upright
    stated_polarity = polarity
    if not match.sense_known:
        stated_polarity = polarity * _majority(polarity)
    octaves = octaves_of(compared)
    correlation = ResponseCorrelation(
        case=case,
        sensors=match.sensors,
        units=units,
        reference=match.reference,
        reciprocal=match.reciprocal,
        band=compared,
        polarity=stated_polarity,
        frequency=frequency,
        measured_response=measured,
        simulated_response=simulated,
        coherence=_coherence(match, inside),
        octaves=octaves,
        frac=frac(measured, simulated),
        octave_frac=frac_of_octaves(octaves, frequency, measured, simulated),
        scaled_frac=frac(measured, scaled),
        damped_frac=frac(measured, damped),
        modes=pairs,
        doubts=(),
    )
    scale = _norms(measured) / _norms(damped)
    doubts = doubts_about(correlation, problem, match, differences, scale)
    return replace(correlation, doubts=tuple(doubts))


def _check_lines(
    frequency: Floats, inside: Bools, band: tuple[float, float], *, stated: bool
) -> None:
    """Check that there are enough frequencies in the band; `stated`: whether the user stated it."""
    count = int(inside.sum())
    if count >= _FEWEST:
        return
    there_are = {0: "there is no frequency", 1: "there is one frequency"}.get(
        count, f"there are {count} frequencies"
    )
    remedy = "measure at more frequencies"
    if stated:
        remedy = f"state a wider band, or {remedy}"
    raise InputError(
        f"{there_are} from {band[0]:.5g} to {band[1]:.5g} Hz, and the responses are from "
        f"{frequency[0]:.5g} to {frequency[-1]:.5g} Hz; {_FEWEST} are needed: {remedy}"
    )


def responses_of_case(
    case: CaseTable, frequency: object, progress: Callable[[float], None] | None = None
) -> tuple[FrequencyResponse, ...]:
    """Compute the frequency response functions of the sensors of a case for a force at its impact.

    The force acts upwards.

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
    >>> case = vi.load_case("signals:coal-gangue", {"plate.modes": 10})
    >>> (response,) = vi.test_analysis.responses_of_case(case, [200.0, 400.0, 800.0])
    >>> response.unit, len(response.value)
    ('m/s2/N', 3)
    """
    problem = plate_problem(case, progress)
    lines = np.asarray(frequency, dtype=float)
    units = tuple(unit_of(sensor) for sensor in problem.sensors)
    # responses of any values check the sensors as measured ones do
    responses = [
        FrequencyResponse(
            DegreeOfFreedom((sensor.name,)),
            DegreeOfFreedom(("impact",), UP),
            lines,
            np.ones(lines.shape, dtype=complex),
            unit,
        )
        for sensor, unit in zip(problem.sensors, units, strict=True)
    ]
    match = matched(problem.sensors, responses, None)
    values = computed_responses(problem, match.sensors, units, lines)
    return tuple(
        replace(response, value=value) for response, value in zip(responses, values, strict=True)
    )


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
    first = float(frequency[0])
    last = float(frequency[-1])
    if band is not None:
        if not (first <= band[0] < band[1] <= last):
            raise InputError(
                f"a band from {band[0]:g} to {band[1]:g} Hz is not allowed; it must rise, "
                f"within the {first:g} to {last:g} Hz measured"
            )
        return band
    lowest = float(modes.frequencies[0])
    highest = float(modes.frequencies[-1])
    if lowest >= last:
        raise InputError(
            f"the lowest mode of the plate has {lowest:.5g} Hz, and the responses end at "
            f"{last:.5g} Hz; measure up to higher frequencies"
        )
    return max(0.5 * lowest, first), min(max(highest, 1.5 * lowest), last)


def _polarity(measured: Complex, simulated: Complex, match: Matched) -> Floats:
    """Return 1, or -1 for responses that are upside down, (S,).

    Where it is not stated how the force is positive, they are compared with the clearest one.
    """
    correlation = np.real(np.sum(measured * simulated.conj(), axis=1))
    correlation /= np.linalg.norm(measured, axis=1) * np.linalg.norm(simulated, axis=1)
    common = 1.0
    if not match.sense_known and correlation[np.argmax(np.abs(correlation))] < _OPPOSITE:
        common = -1.0
    return np.where(common * correlation < _OPPOSITE, -common, common)


def _majority(polarity: Floats) -> float:
    return 1.0 if polarity.sum() >= 0.0 else -1.0


def _norms(response: Complex) -> Floats:
    return np.asarray(np.linalg.norm(response, axis=1))


def _coherence(match: Matched, inside: Bools) -> Floats | None:
    """Return the coherences in the band, NaN of a response without; None if none has any."""
    coherences = [response.coherence for response in match.responses]
    if all(coherence is None for coherence in coherences):
        return None
    in_band = np.full((len(coherences), int(inside.sum())), np.nan)
    for row, coherence in enumerate(coherences):
        if coherence is not None:
            in_band[row] = coherence[inside]
    return in_band
