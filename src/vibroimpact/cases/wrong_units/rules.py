"""Plausible ranges that depend on the other values of a case."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from vibroimpact.bodies.ball import SOLID, ball_volume
from vibroimpact.cases.wrong_units.hertz_estimate import HertzEstimate
from vibroimpact.cases.wrong_units.plausible import (
    PlausibleRange,
    count_text,
    number_text,
    ratio_text,
)
from vibroimpact.dynamics.fluids.air import AIR_DENSITY

_GRAVITY = 9.8  # m/s^2, for the weight on springs, independent of drop.gravity

_DENSITY = (10.0, 25_000.0)  # kg/m^3: foams; osmium has 22 590
_MODULUS = (2e4, 2e12)  # Pa: gels; diamond has 1.1e12
_HARDEST = 1.5e11  # Pa: diamond has up to 1.2e11
_LIGHTEST = 3.5e8  # largest Young's modulus over density [m^2/s^2]: diamond has 3e8
_SOFTEST = ((1400.0, _MODULUS[0]), (2300.0, 1e6), (4000.0, 1e8), (math.inf, 2e9))
"""Upper end of a range of densities [kg/m^3], and its least Young's modulus [Pa]: gels and rubber;
soils and filled rubber; rock and glass; metals."""


def _nan_outside(value: float, ends: tuple[float, float]) -> float:
    """Return a value, or NaN if it lies outside its range, so that an implausible value
    does not affect the range of another.
    """
    if ends[0] <= value <= ends[1]:
        return value
    return math.nan


def density(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of a density, so high that sound is hardly faster than in diamond."""
    least = _nan_outside(table["youngs_modulus"], _MODULUS) / _LIGHTEST

    def below(value: float) -> str:
        if value < _DENSITY[0]:
            return "is lighter than most foams"
        return "is very light for a material as stiff"

    return PlausibleRange(
        low=float(np.fmax(_DENSITY[0], least)),
        high=_DENSITY[1],
        below=below,
        above="is heavier than any metal",
    )


def elastic_modulus(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of a Young's modulus for the density of the material."""
    weight = _nan_outside(table.get("density", math.nan), _DENSITY)

    def below(value: float) -> str:
        if value < _MODULUS[0]:
            return "is as soft as a gel"
        return "is very soft for a material as heavy"

    def above(value: float) -> str:
        if value > _MODULUS[1]:
            return "is stiffer than diamond"
        return "is very stiff for a material as light"

    return PlausibleRange(
        low=next((least for end, least in _SOFTEST if weight < end), _MODULUS[0]),
        high=float(np.fmin(_MODULUS[1], weight * _LIGHTEST)),
        below=below,
        above=above,
    )


def strength(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of a strength for the stiffness of the material; unbounded above,
    as a huge strength is used to exclude yielding.
    """
    stiff = _nan_outside(
        table.get("youngs_modulus", table.get("effective_modulus", math.nan)), _MODULUS
    )
    return PlausibleRange(
        low=float(np.fmax(1e3, 5e-6 * stiff)),
        below="is very weak for a material as stiff",
    )


def hardness(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of a Vickers hardness for the stiffness of the material.

    A number of the Vickers scale, which is in kgf/mm^2, is recognised.
    """
    stiff = _nan_outside(table.get("youngs_modulus", math.nan), _MODULUS)
    return PlausibleRange(
        low=float(np.fmax(1e3, 1e-5 * stiff)),
        high=_HARDEST,
        below="is very soft for a material as stiff",
        above="is harder than diamond",
        reference=0.01 * stiff,
    )


def plate_thickness(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the thickness of a plate."""
    return _below(5.0, "is very thick for a plate", estimate, "is much more than")


def sphere_radius(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the radius of a sphere."""
    return _below(3.0, "is very large for a sphere", estimate, "is far more than")


def _below(most: float, large: str, estimate: HertzEstimate, more: str) -> PlausibleRange:
    """Return the range of a length up to a largest one [m], and to four times that of the plate.

    `large` says what a length above the first is, `more` how it is beside the plate.
    """

    def above(value: float) -> str:
        if value > most:
            return large
        return f"{more} the plate is long, {estimate.across:g} m"

    return PlausibleRange(high=float(np.fmin(most, 4.0 * estimate.across)), above=above)


def sphere_mass(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the mass of a sphere, hollow or not: from that of the air in
    its place to that of the heaviest metal.
    """
    volume = float(ball_volume(np.asarray(estimate.radius)))
    return PlausibleRange(
        low=AIR_DENSITY * volume,
        high=_DENSITY[1] * volume,
        below="is lighter than the air in its place",
        above=lambda value: (
            f"would be {number_text(value / volume, 2)} kg/m^3, heavier than any metal"
        ),
        remedy="look at its unit, and at the radius",
    )


def sphere_inertia(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the moment of inertia of a sphere; more than that of a thin
    shell is refused elsewhere.
    """
    solid = SOLID * estimate.mass * float(np.square(estimate.radius))
    return PlausibleRange(
        low=0.02 * solid,
        below=lambda value: (
            f"is {count_text(solid / value)} times less than that of a solid ball, "
            f"{number_text(solid, 3)} kg m^2"
        ),
        reference=solid,
        within=2.0,
        remedy="leave it out if the ball is solid, or look at its unit",
    )


def element_size(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the size of the elements of a plate."""
    return PlausibleRange(high=estimate.across, above="is more than the plate is long")


def margin(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the width of the elements along edges; by default it follows
    the thickness, also of a block.
    """
    high = max(0.5 * estimate.across, 2.0 * estimate.size[2])
    return PlausibleRange(
        high=high, above="is more than half the length of the plate, and than twice its thickness"
    )


def support_stiffness(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the stiffness of a spring under a plate; at its lower end the
    plate sags by four times its longer side.
    """
    weight = _GRAVITY * estimate.plate.density * math.prod(estimate.size)
    return PlausibleRange(
        low=weight / (4.0 * estimate.across),
        high=1e13,
        below=lambda value: (
            f"would alone let the plate, which weighs {number_text(weight, 3)} N on earth, "
            f"sag by {number_text(weight / value, 2)} m"
        ),
        above="is very stiff for a support",
    )


def contact_stiffness(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of a contact stiffness around the value that gives Hertz's force at his
    largest indentation.

    Linear springs are often chosen soft to save time steps, so they are doubted only if the
    indentation reaches 0.3 of the radius.
    """
    exponent = estimate.exponent
    # k x^n = k_H x^1.5 at Hertz's largest indentation x
    reference = estimate.stiffness * estimate.depth ** (1.5 - exponent)
    unit = stiffness_unit(exponent)
    if exponent == 1.5:
        phrase = "Hertz's"
        remedy = "leave it out to take Hertz's"
    else:
        depth = number_text(estimate.depth, 2)
        phrase = f"what gives Hertz's force at his largest indentation, {depth} m,"
        remedy = f"something like {number_text(reference, 1)} {unit} is usual"
    low = reference / 2000.0
    if exponent == 1.0:
        # a soft linear spring may be meant, into which the sphere sinks by 0.3 of its radius:
        # m v^2 = k x^2
        softest = estimate.mass * (estimate.speed / (0.3 * estimate.radius)) ** 2
        low = min(reference / 100.0, softest)

    def fault(value: float) -> str:
        ratio = ratio_text(value / reference)
        return f"is {ratio} than {phrase} {number_text(reference, 4)} {unit}"

    return PlausibleRange(
        low=low,
        high=300.0 * reference,
        below=fault,
        above=fault,
        reference=reference,
        remedy=remedy,
    )


def stiffness_unit(exponent: float) -> str:
    """Return the SI unit of a contact stiffness for an exponent of the law."""
    return "N/m" if exponent == 1.0 else f"N/m^{exponent:g}"


def contact_damping(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the damping coefficient of a contact, relative to critical damping."""
    critical = estimate.critical_damping
    said = f"the critical damping of this contact, {number_text(critical, 2)} N s/m"
    return PlausibleRange(
        low=2e-4 * critical,
        high=10.0 * critical,
        below=lambda value: (
            f"is {count_text(critical / value)} times less than {said}, and takes next to nothing"
        ),
        above=lambda value: f"is {count_text(value / critical)} times {said}",
        reference=0.05 * critical,
        within=60.0,
    )


def full_damping_penetration(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the full-damping penetration of the Adams impact law."""
    return PlausibleRange(
        high=float(np.fmax(0.3 * estimate.radius, 10.0 * estimate.depth)),
        above=lambda value: (
            f"is {count_text(value / estimate.depth)} times Hertz's largest indentation, "
            f"{number_text(estimate.depth, 2)} m"
        ),
        reference=0.1 * estimate.depth,
    )


def dissipation_time(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the dissipation time of a viscoelastic contact, relative to the
    contact duration.
    """
    lasts = estimate.contact_time
    return PlausibleRange(
        high=10.0 * lasts,
        above=lambda value: (
            f"is {count_text(value / lasts)} times as long as Hertz's contact, "
            f"{number_text(lasts, 2)} s"
        ),
        reference=0.03 * lasts,
    )


def gravitational_acceleration(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the acceleration of gravity; an implausible value is corrected
    only to that of the earth.
    """
    return PlausibleRange(
        high=300.0, above="is more than that of the sun", reference=9.8, within=1.05
    )


def run_duration(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the duration of a run, which ends after the first contact at
    the earliest.
    """
    touch = estimate.touch
    release = touch + float(np.nan_to_num(estimate.contact_time))
    # a plate that is moved is touched at another time
    earliest = 0.0 if estimate.case["plate"].get("motion") else release
    when = "after" if estimate.in_fluid else "at"

    def below(value: float) -> str:
        if value < touch:
            return f"is over before the sphere touches the plate, {when} {touch:.4g} s"
        return (
            f"is over before the first contact is, which by Hertz's theory ends {when} about "
            f"{release:.6g} s"
        )

    def remedy(value: float) -> str:
        phrase = ""
        if value < earliest:
            phrase = f"give {_rounded_up(earliest)} s or more"
            if estimate.in_fluid:
                phrase += ", as the fluid slows the fall"
        return phrase

    return PlausibleRange(
        low=earliest,
        high=1000.0,
        below=below,
        above="is far longer than a sphere bounces",
        reference=release,
        within=500.0,
        remedy=remedy,
    )


def _rounded_up(value: float) -> str:
    """Return a value with two significant digits that exceeds the given one by at least 2 %."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return f"{math.ceil(1.02 * value / step) * step:.2g}"


def rest_speed(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the rest speed, less than the approach speed of the first impact."""
    speed = "the speed of the first touch"
    if estimate.in_fluid:
        speed = "the speed that the first touch would have in a vacuum"
    return PlausibleRange(
        high=0.9 * estimate.speed,
        above=f"is not well below {speed}, {estimate.speed:.3g} m/s",
    )


def modal_frequency(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the upper frequency of modes, relative to the inverse of the
    contact duration.
    """
    lasts = estimate.contact_time
    contact = f"about {number_text(lasts, 2)} s"
    return PlausibleRange(
        low=0.05 / lasts,
        high=1e5 / lasts,
        below=lambda value: (
            f"has a period of {number_text(1.0 / value, 2)} s, and the contact lasts "
            f"{contact}: it excites much higher frequencies"
        ),
        above=lambda value: f"is far higher than a contact of {contact} excites",
    )


def sampling_rate(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of a sampling rate: for accelerations from one sample in ten
    contacts on, or 1 kHz if that is less; else 10 Hz.
    """
    lasts = estimate.contact_time
    low = 10.0
    if table["quantity"] == "acceleration":
        low = float(np.fmin(1000.0, 0.1 / lasts))
    return PlausibleRange(
        low=low,
        high=1e9,
        below=lambda value: (
            f"takes a sample every {number_text(1.0 / value, 2)} s, and the contact lasts "
            f"about {number_text(lasts, 2)} s"
        ),
        above="is very fast for a converter of such signals",
    )


def filter_corner(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the corner frequency of a filter, relative to the sampling rate."""
    return PlausibleRange(
        low=1e-3 * table["rate"],
        below=f"leaves next to nothing of {table['rate']:g} samples per second",
    )


def below_sensor_range(estimate: HertzEstimate, table: Mapping[str, Any]) -> PlausibleRange:
    """Return the range of the noise or resolution of an accelerometer: less than its
    measuring range.
    """
    return PlausibleRange(
        high=table.get("range", math.nan),
        above=f"is more than its range, {table.get('range', math.nan):g} m/s^2",
    )
