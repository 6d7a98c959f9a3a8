"""What an identification could not tell, and why."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from vibroimpact.identification.causes import causes, remedy, told
from vibroimpact.identification.force import Force
from vibroimpact.identification.measured import Measured, rms_of
from vibroimpact.identification.plate import Place, Plate
from vibroimpact.identification.pulses import Search
from vibroimpact.identification.sphere import SphereFit
from vibroimpact.quoting import quoted
from vibroimpact.units.display import digits

_MISFIT_OVER_NOISE = 1.3
"""What a fit leaves, over the noise, from which on the model is doubted."""
_MISFIT_OVER_RMS = 0.05
"""The same over the rms value of the records, where the noise is not known."""
_WIDE = 0.25
"""Relative standard deviation from which on a number is not determined."""
_CONTRADICTS = 3.0
"""Standard deviations from which on two estimates contradict each other."""
_PASSED = 1.2
"""End of what an anti-alias filter passes, over the end of its band."""
_APART = 3.0
"""Mean distances of modes by which the largest frequency that is asked for is too high."""
_AT_LIMIT = 5e-4
"""Distance from the limit of the search, over its length, at which a place lies there."""


def doubts_about(
    plate: Plate, measured: Measured, search: Search, sphere: SphereFit, place: Place | None
) -> Iterator[str]:
    """Yield the doubts about an identification, one sentence each without its full stop.

    Parameters
    ----------
    plate, measured, search, sphere
        As those of an `Identification`.
    place : tuple of two floats, optional
        The place, if it was given.
    """
    yield from _of_records(measured)
    yield from _of_modes(plate, measured)
    yield from _of_place(plate, search, sphere, place)
    if not sphere.converged:
        yield "the fit of the sphere did not converge; its numbers are those of its last step"
    yield from _of_misfit(plate, measured, search, sphere, place)
    deviations = np.sqrt(np.diag(sphere.covariance)).tolist()
    for name, deviation in (("radius", deviations[2]), ("speed", deviations[3])):
        if deviation > _WIDE:
            yield (
                f"the records do not determine the {name}: its standard deviation is "
                f"{digits(100.0 * deviation, 2)} %"
            )


def _of_records(measured: Measured) -> Iterator[str]:
    """Yield what is wrong with the records and was corrected."""
    for sensor, heard, polarity in zip(
        measured.sensors, measured.heard, measured.polarity.tolist(), strict=True
    ):
        clipped = int(np.count_nonzero(~heard))
        if clipped:
            yield (
                f"the record {quoted(sensor.name)} is clipped: {clipped} of its samples lie at its "
                "extremes; they are left out, and what lies beside them is taken as right"
            )
        if polarity < 0.0:
            yield (
                f"the record {quoted(sensor.name)} is inverted: with the opposite sign a force "
                "explains the records much better; its sign was changed, correct it at the "
                "amplifier, in the file or in the case"
            )


def _of_modes(plate: Plate, measured: Measured) -> Iterator[str]:
    """Yield what the modes of the plate do not tell."""
    if not plate.model_error:
        yield (
            "these are records of a run with the modes of this case: the errors of mesh and modes "
            "left out, which a plate has, are not in the intervals"
        )
        return
    frequencies = plate.problem.models["plate"].frequencies
    highest = float(frequencies[-1])
    passed = _PASSED * measured.band
    if highest >= passed:
        return
    # the last mode below a limit lies some mean distances of modes below it
    wanted = passed + _APART * highest / len(frequencies)
    instead = ""
    if plate.case.plate.modes is not None:
        instead = " in place of plate.modes"
    yield (
        f"the modes of the plate end at {highest:,.0f} Hz, and the filters of the sensors pass "
        f"frequencies up to {passed:,.0f} Hz; the intervals do not contain what the modes above "
        f'lack; ask for plate.max_frequency = "{math.ceil(wanted / 1e3):d} kHz"{instead}'
    )


def _of_place(
    plate: Plate, search: Search, sphere: SphereFit, place: Place | None
) -> Iterator[str]:
    """Yield where else the force may have been."""
    others = ", ".join(
        f"({1e3 * candidate.place[0]:.1f}, {1e3 * candidate.place[1]:.1f}) mm"
        for candidate in search.candidates[1:]
    )
    if others:
        yield (
            f"a force at {others} explains the records about as well; add a sensor off the "
            "axes of symmetry, or state the position of the impact"
        )
    low, high = plate.bounds
    fitted = sphere.parameters[:2]
    at_limit = np.minimum(fitted - low, high - fitted) <= _AT_LIMIT * (high - low)
    if place is None and at_limit.any():
        yield (
            "the position found is at the limit of the search, near the edge of the plate; the "
            "true one may lie beyond it"
        )


def _of_misfit(
    plate: Plate, measured: Measured, search: Search, sphere: SphereFit, place: Place | None
) -> Iterator[str]:
    """Yield the doubt about a fit that leaves much of the records."""
    residual = rms_of(sphere.residual, measured.heard)
    over_noise = float((residual / measured.noise).max())
    over_rms = float((residual / measured.rms).max())
    if measured.quiet and over_noise > _MISFIT_OVER_NOISE:
        misfit = (
            f"the fit leaves {digits(over_noise, 2)} times the noise before first touch of a record"
        )
    elif not measured.quiet and over_rms > _MISFIT_OVER_RMS:
        misfit = (
            f"the fit leaves {digits(100.0 * over_rms, 2)} % of the rms value of "
            "a record, and the records do not show the noise before first touch"
        )
    else:
        return
    explaining, share = causes(plate, measured, sphere, search.candidates[0], place)
    if explaining:
        source = "the case"
        if place is not None:
            source = "the case or the position that was given"
        yield (
            f"{misfit}: a set-up that differs from the case leaves {digits(100.0 * share, 2)} "
            f"% of that: {told(explaining)}; correct {source}, or state "
            f"{remedy(plate, explaining)}"
        )
        return
    if place is None:
        stated = "the plate, its sensors or the contact"
    else:
        stated = "the plate, its sensors, the contact or the position"
    yield (
        f"{misfit}: either {stated} is not as stated, or the records contain a further impact, or "
        "noise that is not there before first touch, or another sphere fits better; do not use "
        "these numbers"
    )


def contradiction(sphere: SphereFit, force: Force) -> str:
    """Return the doubt about a force from the records alone; empty if there is none.

    It is doubted where it contradicts the contact that was fitted.
    """
    fitted_peak, fitted_impulse, _ = sphere.force.facts
    peak_deviation, impulse_deviation, _ = np.sqrt(np.diag(sphere.force_covariance))
    comparisons = (
        ("largest force", "N", force.peak, (fitted_peak, peak_deviation)),
        ("impulse", "N s", force.impulse, (fitted_impulse, impulse_deviation)),
    )
    for name, unit, (alone, alone_deviation), (fitted, fitted_deviation) in comparisons:
        if abs(alone - fitted) > _CONTRADICTS * math.hypot(alone_deviation, fitted_deviation):
            return (
                f"the {name} from the records alone, {digits(alone, 3)} {unit}, contradicts the "
                f"{digits(fitted, 3)} {unit} of the contact that was fitted; what is from the "
                "records alone is withheld, as it depends most on errors of the plate and its "
                "sensors"
            )
    return ""
