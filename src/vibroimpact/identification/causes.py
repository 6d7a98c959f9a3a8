"""What of a set-up explains what a fit leaves of the records.

It is tried by a fit in which all of the set-up is free.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.plate import Place, Plate
from vibroimpact.identification.pulses import Candidate
from vibroimpact.identification.sphere import SphereFit, fit_sphere
from vibroimpact.quoting import quoted
from vibroimpact.units.display import digits

_WIDE = {"sensor_place": 0.01, "gain": 0.1, "thickness": 0.02, "resonance": 0.1}
"""Deviations with which the set-up is free.

Thickness stands for modulus too, since frequencies hardly tell them apart.
"""
_EXPLAINS = 0.5
"""Part of what the fit leaves, down to which a free set-up leaves it, that is an explanation."""
_SURE = 3.0
"""Standard deviations from which on a difference is named."""
_LEAST = {"sensor_place": 1e-3, "gain": 0.01, "thickness": 5e-4, "resonance": 0.02}
"""Least differences that are named, in the units of `SetupErrors`."""
_NAMED = 3
"""Largest number of differences that are named."""


class Cause(NamedTuple):
    """A difference of the set-up from the case.

    Its description in words, which of `SetupErrors` states it, and its size.
    """

    description: str
    name: str
    size: float


def causes(
    plate: Plate, measured: Measured, sphere: SphereFit, start: Candidate, place: Place | None
) -> tuple[list[Cause], float]:
    """Return what explains what a fit leaves, the largest first, and what is left with it.

    If no set-up does, there are none.

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
    uncertain_plate = replace(plate, errors=replace(plate.errors, **wide))
    free = fit_sphere(uncertain_plate, measured, start, place)
    # of the worst record, over its noise; those that were explained before do not get better
    left_free = float((free.noise / measured.noise).max())
    left_before = float((sphere.noise / measured.noise).max())
    share = left_free / left_before
    if share > _EXPLAINS:
        return [], share
    names = [sensor.name for sensor in measured.sensors]
    exponent = float(plate.thickness_exponents.mean())
    differences = list(_stretch(free, exponent))
    for number, name in enumerate(names):
        differences += _sensor_differences(free, number, name)
    # lengths and parts compare by the least of each that counts
    differences.sort(key=lambda cause: cause.size / _LEAST[cause.name], reverse=True)
    return differences, share


def remedy(plate: Plate, causes: list[Cause]) -> str:
    """Return the options that state differences, and what was stated before."""
    sizes: dict[str, float] = {}
    for cause in causes:
        sizes[cause.name] = max(_rounded_up(cause.size), sizes.get(cause.name, 0.0))
    return plate.errors.at_least(sizes).options


def told(causes: list[Cause]) -> str:
    """Return the largest differences in words."""
    phrases = [cause.description for cause in causes[:_NAMED]]
    if len(causes) > _NAMED:
        phrases.append(f"and {len(causes) - _NAMED} more")
    return ", ".join(phrases)


def _stretch(free: SphereFit, exponent: float) -> Iterator[Cause]:
    """Yield how much the frequencies differ, if they do.

    They are proportional to the thickness to the power of the exponent, and to the root of the
    modulus.
    """
    setup = free.setting.found
    stretch = exponent * setup.thickness + 0.5 * setup.modulus
    by_numbers = np.append([exponent, 0.5], np.zeros(len(free.setting.numbers) - 2))
    deviation = float(np.linalg.norm(by_numbers @ free.setting.errors))
    if abs(stretch) > max(_LEAST["thickness"], _SURE * deviation):
        description = (
            f"the plate's frequencies are on average {_percent(stretch)} than in the case, by "
            "another thickness or modulus"
        )
        yield Cause(description, "thickness", abs(stretch) / exponent)


def _sensor_differences(free: SphereFit, number: int, name: str) -> Iterator[Cause]:
    """Yield how a sensor, by its number, differs from the case."""
    setup = free.setting.found
    x, y, _, resonance_deviations = free.setting.deviations[2:].reshape(4, -1)
    distance = float(np.hypot(*setup.moved[number]))
    if distance > max(_LEAST["sensor_place"], _SURE * math.hypot(x[number], y[number])):
        offset = digits(1e3 * distance, 2)
        description = f"{quoted(name)} lies about {offset} mm from its position in the case"
        yield Cause(description, "sensor_place", distance)
    gains, gain_deviations = _gains(free)
    gain = float(gains[number])
    if abs(gain) > max(_LEAST["gain"], _SURE * float(gain_deviations[number])):
        beside = " beside the others" if len(gains) > 1 else ""
        description = f"{quoted(name)} reads {_percent(gain)} than it should{beside}"
        yield Cause(description, "gain", abs(gain))
    resonance = float(setup.resonance[number])
    if abs(resonance) > max(_LEAST["resonance"], _SURE * resonance_deviations[number]):
        higher = _percent(resonance)
        description = f"{quoted(name)} has a mounted resonance {higher} than in the case"
        yield Cause(description, "resonance", abs(resonance))


def _gains(free: SphereFit) -> tuple[Floats, Floats]:
    """Return how much more each sensor reads than it should, and the deviations of that.

    A gain of all is a heavier or faster sphere; the difference from the middle one is told by the
    records.
    """
    gains = free.setting.found.gain
    sensors = len(gains)
    if sensors == 1:
        return gains, free.setting.deviations[4:5]
    middle = int(np.argsort(gains)[sensors // 2])
    errors = free.setting.errors[2 + 2 * sensors :][:sensors]
    return gains - gains[middle], np.linalg.norm(errors - errors[middle], axis=1)


def _percent(part: float) -> str:
    direction = "higher" if part > 0.0 else "lower"
    return f"about {digits(100.0 * abs(part), 2)} % {direction}"


def _rounded_up(size: float) -> float:
    """Return a size rounded up to one digit."""
    unit = 10.0 ** math.floor(math.log10(size))
    # one digit already, a size may be above itself by rounding
    return round(math.ceil(size / unit - 1e-9) * unit, 12)
