"""What of a set-up explains what a fit leaves of the records: tried by a fit in which all
of it is free.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.identification.measured import Measured
from vibroimpact.identification.plate import Place, Plate
from vibroimpact.identification.pulses import Candidate
from vibroimpact.identification.sphere import SphereFit, fit_sphere
from vibroimpact.quoting import quoted
from vibroimpact.units.display import digits

_WIDE = {"sensor_place": 0.01, "gain": 0.1, "thickness": 0.02, "resonance": 0.1}
"""Deviations with which the set-up is free; thickness stands for modulus too, since
frequencies hardly tell them apart.
"""
_LESS = 0.5
"""Part of what the fit leaves, down to which it is left with the set-up free, that is an
explanation.
"""
_SURE = 3.0
"""Standard deviations from which on a difference is named."""
_LEAST = {"sensor_place": 1e-3, "gain": 0.01, "thickness": 5e-4, "resonance": 0.02}
"""Least differences that are named, in the units of `SetupErrors`."""
_NAMED = 3
"""Largest number of differences that are named."""


class Cause(NamedTuple):
    """A difference of the set-up from the case: in words, which of `SetupErrors` states
    it, and its size.
    """

    words: str
    name: str
    size: float


def causes(
    plate: Plate, measured: Measured, sphere: SphereFit, start: Candidate, place: Place | None
) -> tuple[list[Cause], float]:
    """Return what explains what a fit leaves, the largest first, and what is left with it; nothing
    if no set-up does.

    Parameters
    ----------
    plate, measured, start, place
        Those of `fit_sphere`.
    sphere : SphereFit
        Its fit.

    Returns
    -------
    list of Cause
        The differences.
    float
        What is left of the record of which most is left, over that before.
    """
    wide = {name: max(getattr(plate.errors, name), least) for name, least in _WIDE.items()}
    free = fit_sphere(replace(plate, errors=replace(plate.errors, **wide)), measured, start, place)
    # of the worst record, over its noise; those that were explained before do not get better
    less = float((free.noise / measured.noise).max() / (sphere.noise / measured.noise).max())
    if less > _LESS:
        return [], less
    found = _differences(
        free, [sensor.name for sensor in measured.sensors], float(plate.thickness_exponents.mean())
    )
    return sorted(found, key=lambda one: one.size / _LEAST[one.name], reverse=True), less


def remedy(plate: Plate, found: list[Cause]) -> str:
    """Return the options that state differences, and what was stated before."""
    sizes = {
        one.name: max(_up(other.size) for other in found if other.name == one.name) for one in found
    }
    return plate.errors.at_least(sizes).options


def told(found: list[Cause]) -> str:
    """Return the largest differences in words."""
    more = f", and {len(found) - _NAMED} more" if len(found) > _NAMED else ""
    return ", ".join(one.words for one in found[:_NAMED]) + more


def _differences(free: SphereFit, sensors: list[str], exponent: float) -> Iterator[Cause]:
    """Yield how a set-up that was found differs from the case; the thickness to the power
    of an exponent gives frequencies.
    """
    setup, deviations = free.setting.found, free.setting.deviations
    x, y, _, resonance = deviations[2:].reshape(4, -1)
    if len(sensors) > 1:
        # a gain of all is a heavier or faster sphere; the difference from the middle one is told by
        # the records
        middle = int(np.argsort(setup.gain)[len(sensors) // 2])
        of_gain = free.setting.errors[2 + 2 * len(sensors) :][: len(sensors)]
        more, spread = (
            setup.gain - setup.gain[middle],
            np.linalg.norm(of_gain - of_gain[middle], axis=1),
        )
    else:
        more, spread = setup.gain, deviations[4:5]
    along = np.append([exponent, 0.5], np.zeros(len(deviations) - 2))
    stretch = exponent * setup.thickness + 0.5 * setup.modulus
    if abs(stretch) > max(
        _LEAST["thickness"], _SURE * float(np.linalg.norm(along @ free.setting.errors))
    ):
        words = (
            f"the plate's frequencies are on average {_percent(stretch)} than in the case, by "
            "another thickness or modulus"
        )
        yield Cause(words, "thickness", abs(stretch) / exponent)
    for number, name in enumerate(sensors):
        off = float(np.hypot(*setup.moved[number]))
        if off > max(_LEAST["sensor_place"], _SURE * math.hypot(x[number], y[number])):
            yield Cause(
                f"{quoted(name)} lies about {digits(1e3 * off, 2)} mm from its place in the case",
                "sensor_place",
                off,
            )
        if abs(more[number]) > max(_LEAST["gain"], _SURE * float(spread[number])):
            beside = " beside the others" if len(sensors) > 1 else ""
            yield Cause(
                f"{quoted(name)} reads {_percent(float(more[number]))} than it should{beside}",
                "gain",
                abs(float(more[number])),
            )
        off = float(setup.resonance[number])
        if abs(off) > max(_LEAST["resonance"], _SURE * resonance[number]):
            yield Cause(
                f"{quoted(name)} has a mounted resonance {_percent(off)} than in the case",
                "resonance",
                abs(off),
            )


def _percent(part: float) -> str:
    return f"about {digits(100.0 * abs(part), 2)} % {'higher' if part > 0.0 else 'lower'}"


def _up(size: float) -> float:
    """Return a size rounded up to one digit."""
    unit = 10.0 ** math.floor(math.log10(size))
    return round(math.ceil(size / unit - 1e-9) * unit, 12)
