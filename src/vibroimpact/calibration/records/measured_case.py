"""Measurements given in the case file: restitutions, rebound heights, or the first impact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.observed.flights import Flights, VacuumFlights, vacuum_height
from vibroimpact.calibration.observed.matchable import MATCHABLE
from vibroimpact.calibration.observed.noise import scaled, standard_deviations
from vibroimpact.calibration.observed.observations import Observations, from_heights, from_table
from vibroimpact.calibration.observed.restitution_limit import (
    RestitutionLimit,
    measured_restitutions,
    restitution_limit,
)
from vibroimpact.calibration.observed.section import ImpactTarget, RestitutionTarget
from vibroimpact.calibration.records.evaluate_measurement import Measurement, speed_at_touch
from vibroimpact.cases.case import Case
from vibroimpact.errors import InputError


def heights_measurement(
    case: Case, heights: Floats, deviation: Floats | None, labels: tuple[str, ...]
) -> Measurement:
    """Return the measurement of successive rebound heights [m] from the first impact on.

    Raises
    ------
    InputError
        If a height is not above the rest position, or (when evaluated) exceeds the height of fall
        by more than noise.
    """
    radius = case.sphere.radius
    _check_above(case, heights, labels)

    def evaluated(flights: Flights | None) -> Observations:
        speed = speed_at_touch(case, flights)
        seen = from_heights(
            heights,
            deviation,
            first_speed=speed,
            radius=radius,
            gravity=case.drop.gravity,
            labels=labels,
            flights=flights,
        )
        _check_heights(seen, case, heights, speed)
        return seen

    return Measurement(evaluated, float(heights.max()) - radius)


def _check_heights(seen: Observations, case: Case, heights: Floats, first_speed: float) -> None:
    """Check that no height [m] exceeds that of the fall before it by more than noise."""
    radius = case.sphere.radius
    gravity = case.drop.gravity
    limit = _limit(seen, case)
    restitutions = measured_restitutions(seen, radius, gravity)
    assert restitutions is not None
    too_high = np.flatnonzero(restitutions > limit.most)
    if not too_high.size:
        return
    impact = int(too_high[0])
    height = heights[impact]
    if impact:
        fall_height = heights[impact - 1]
    else:
        fall_height = case.drop.height or radius + 0.5 * first_speed**2 / gravity
    higher = "too high for"
    if height > fall_height:
        higher = "higher than"
    raise InputError(
        f"{seen.labels[impact]}: {height:g} m is {higher} the {fall_height:g} m from which the "
        "sphere fell, and a restitution of "
        f"{_beyond_noise(restitutions[impact], limit.most[impact], limit.why)}",
        "target",
    )


def first_impact_measurement(case: Case, target: ImpactTarget) -> Measurement:
    """Return the measurement of the first impact of the drop."""
    if target.rebound_height is not None:
        _check_above(case, np.array([target.rebound_height]), ("impact 1",))
    radius = case.sphere.radius

    def evaluated(flights: Flights | None) -> Observations:
        speed = speed_at_touch(case, flights)
        quantities = {name: getattr(target, name) for name in MATCHABLE}
        if target.restitution is not None:
            quantities["separation_speed"] = target.restitution * speed
        if target.rebound_height is not None:
            flight_model = flights or VacuumFlights(case.drop.gravity)
            rise, _ = vacuum_height(flight_model, np.array(target.rebound_height - radius))
            quantities["rebound_height"] = radius + float(rise)
        wanted = {
            name: np.array([value]) for name, value in quantities.items() if value is not None
        }
        deviations = None
        if target.relative_deviation is not None:
            deviations = {name: target.relative_deviation * value for name, value in wanted.items()}
        seen = from_table(np.array([speed]), wanted, deviations, ("impact 1",), of_the_drop=True)
        if target.restitution is not None:
            check_restitutions(seen, case)
        return replace(seen, flights=flights)

    highest = 0.0
    if target.rebound_height is not None:
        highest = target.rebound_height - radius
    return Measurement(evaluated, highest)


def restitution_observations(case: Case, target: RestitutionTarget) -> Observations:
    """Return measured restitutions at several approach speeds."""
    assert isinstance(target.restitution, tuple)
    speeds = np.array(target.approach_speed)
    wanted = {"separation_speed": np.array(target.restitution) * speeds}
    deviations = None
    if target.standard_deviation is not None:
        deviations = {"separation_speed": target.standard_deviation * speeds}
    labels = tuple(f"restitution {number + 1}" for number in range(len(speeds)))
    seen = from_table(speeds, wanted, deviations, labels)
    check_restitutions(seen, case)
    return seen


def check_restitutions(seen: Observations, case: Case) -> None:
    """Check that no restitution exceeds 1 by more than noise.

    Raises
    ------
    InputError
        If one does; the message gives the limit.
    """
    restitutions = measured_restitutions(seen, case.sphere.radius, case.drop.gravity)
    if restitutions is None:
        return
    limit = _limit(seen, case)
    above = np.flatnonzero(restitutions > limit.most)
    if above.size:
        impact = int(above[0])
        restitution = restitutions[impact]
        raise InputError(
            f"{seen.labels[impact]}: restitution is {restitution:.5g}; it is 1 at most, and "
            f"{_beyond_noise(restitution, limit.most[impact], limit.why)}",
            "target",
        )


def _limit(seen: Observations, case: Case) -> RestitutionLimit:
    """Return the restitutions up to which measured ones are attributed to noise."""
    restitutions = measured_restitutions(seen, case.sphere.radius, case.drop.gravity)
    assert restitutions is not None
    if not seen.deviations_known:
        return restitution_limit(seen.speeds, restitutions, None)
    separation = restitutions * seen.speeds
    if "separation_speed" in seen.wanted:
        name = "separation_speed"
        speed_slope = np.ones(len(separation))
    else:
        name = "rebound_height"
        # the derivative of sqrt(2 g h) by h
        speed_slope = case.drop.gravity / np.maximum(separation, 1e-300)
    by_reading = scaled(speed_slope / seen.speeds, seen.noise[name])
    by_approach = scaled(restitutions / seen.speeds, seen.speed_noise)
    deviations = standard_deviations(by_reading - by_approach)
    return restitution_limit(seen.speeds, restitutions, deviations)


def _beyond_noise(value: float, most: float, why: str) -> str:
    """Return that a restitution is more than the most that is attributed to noise.

    Both have as many digits as tell them apart.
    """
    digits = 4
    while digits < 17 and f"{value:.{digits}g}" == f"{most:.{digits}g}":
        digits += 1
    return (
        f"{value:.{digits}g} is more than the {most:.{digits}g} that is attributed to noise "
        f"({why}); check speeds, heights and their units"
    )


def _check_above(case: Case, heights: Floats, labels: tuple[str, ...]) -> None:
    if case.drop.gravity == 0.0:
        raise InputError(
            "without gravity a sphere rises for ever; there is no rebound height", "target"
        )
    low = np.flatnonzero(heights <= case.sphere.radius)
    if low.size:
        raise InputError(
            f"{labels[low[0]]}: {heights[low[0]]:g} m is not above where the sphere lies on the "
            f"plate, with its centre at {case.sphere.radius:g} m",
            "target",
        )
