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

_LEFT = 1.3
"""What a fit leaves, over the noise, from which on the model is doubted."""
_PART = 0.05
"""What a fit leaves, over the rms value of the records, from which on it is doubted where
the noise is not known.
"""
_WIDE = 0.25
"""Relative standard deviation from which on a number is not told."""
_CONTRADICTS = 3.0
"""Standard deviations from which on two estimates contradict each other."""
_PASSED = 1.2
"""End of what an anti-alias filter passes, over the end of its band."""
_APART = 3.0
"""Mean distances of modes by which a largest frequency that is asked for lies above what
is needed.
"""
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
    if not plate.model_error:
        words = "these are records of a run with the modes of this case"
        yield (
            f"{words}: the errors of mesh and modes left out, which a plate has, "
            "are not in the intervals"
        )
    highest, passed = float(plate.problem.models["plate"].frequencies[-1]), _PASSED * measured.band
    if plate.model_error and highest < passed:
        words = (
            f"the modes of the plate end at {highest:,.0f} Hz, and the filters of the sensors "
            f"pass frequencies up to {passed:,.0f} Hz"
        )
        # the last mode below a limit lies some mean distances of modes below it
        wanted = passed + _APART * highest / len(plate.problem.models["plate"].frequencies)
        instead = " in place of plate.modes" if plate.case.plate.modes is not None else ""
        more = f'ask for plate.max_frequency = "{math.ceil(wanted / 1e3):d} kHz"{instead}'
        yield f"{words}; the intervals do not contain what the modes above lack; {more}"
    others = ", ".join(
        f"({1e3 * one.place[0]:.1f}, {1e3 * one.place[1]:.1f}) mm" for one in search.candidates[1:]
    )
    if others:
        yield (
            f"a force at {others} explains the records about as well; add a sensor off the "
            "axes of symmetry, or give the place"
        )
    low, high = plate.bounds
    at_edge = np.minimum(sphere.parameters[:2] - low, high - sphere.parameters[:2]) <= _AT_LIMIT * (
        high - low
    )
    if place is None and at_edge.any():
        yield (
            "the place lies at the limit of the search, near the edge of the plate; the true "
            "one may lie beyond it"
        )
    if not sphere.converged:
        yield "the fit of the sphere did not converge; its numbers are those of its last step"
    left = rms_of(sphere.residual, measured.heard)
    ratio, part = float((left / measured.noise).max()), float((left / measured.rms).max())
    if measured.quiet and ratio > _LEFT:
        words = f"the fit leaves {digits(ratio, 2)} times the noise before first touch of a record"
        yield _of_misfit(plate, measured, search, sphere, place, words)
    if not measured.quiet and part > _PART:
        unknown = "the records do not show the noise before first touch"
        words = (
            f"the fit leaves {digits(100.0 * part, 2)} % of the rms value of "
            f"a record, and {unknown}"
        )
        yield _of_misfit(plate, measured, search, sphere, place, words)
    for name, deviation in zip(
        ("radius", "speed"), np.sqrt(np.diag(sphere.covariance))[2:4].tolist(), strict=True
    ):
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
        if number := int(np.count_nonzero(~heard)):
            words = (
                f"the record {quoted(sensor.name)} is clipped: {number} of its "
                "samples lie at its extremes"
            )
            yield f"{words}; they are left out, and what lies beside them is taken as right"
        if polarity < 0.0:
            words = (
                f"the record {quoted(sensor.name)} is inverted: with the opposite sign a force "
                "explains the records much better"
            )
            yield (
                f"{words}; its sign was changed, correct it at the amplifier, in "
                "the file or in the case"
            )


def _of_misfit(
    plate: Plate,
    measured: Measured,
    search: Search,
    sphere: SphereFit,
    place: Place | None,
    words: str,
) -> str:
    """Return the doubt about a fit that leaves much of the records: with what explains
    it, if something of the set-up does.
    """
    found, less = causes(plate, measured, sphere, search.candidates[0], place)
    if found:
        given = "the case" if place is None else "the case or the place that was given"
        explained = (
            f"a set-up that differs from the case leaves {digits(100.0 * less, 2)} "
            f"% of that: {told(found)}"
        )
        return f"{words}: {explained}; correct {given}, or state {remedy(plate, found)}"
    wrong = (
        "the plate, its sensors or the contact"
        if place is None
        else "the plate, its sensors, the contact or the place"
    )
    others = (
        "the records contain a further impact, or noise that is not there before first touch, "
        "or another sphere fits better"
    )
    return f"{words}: either {wrong} is not as stated, or {others}; do not use these numbers"


def contradiction(sphere: SphereFit, force: Force) -> str:
    """Return the doubt about a force from the records alone that contradicts the contact
    that was fitted; empty if it does not.
    """
    deviations = np.sqrt(np.diag(sphere.force_covariance))
    for name, unit, (alone, deviation), fitted, its in (
        ("largest force", "N", force.peak, sphere.force.facts[0], deviations[0]),
        ("impulse", "N s", force.impulse, sphere.force.facts[1], deviations[1]),
    ):
        if abs(alone - fitted) > _CONTRADICTS * math.hypot(deviation, its):
            told = (
                f"{digits(alone, 3)} {unit}, contradicts the {digits(fitted, 3)} {unit} of the "
                "contact that was fitted"
            )
            words = f"the {name} from the records alone, {told}"
            return (
                f"{words}; what is from the records alone is withheld, as it depends most on "
                "errors of the plate and its sensors"
            )
    return ""
