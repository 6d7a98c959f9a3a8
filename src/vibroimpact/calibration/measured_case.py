"""Measurements given in the case file: restitutions, rebound heights, or quantities of
the first impact.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.evaluate_measurement import Measurement, speed_at_touch
from vibroimpact.calibration.flights import Flights, VacuumFlights, vacuum_height
from vibroimpact.calibration.matchable import MATCHABLE
from vibroimpact.calibration.noise import scaled, standard_deviations
from vibroimpact.calibration.observations import Observations, from_heights, from_table
from vibroimpact.calibration.restitution_limit import (
    RestitutionLimit,
    measured_restitutions,
    restitution_limit,
)
from vibroimpact.calibration.section import ImpactTarget, RestitutionTarget
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
        speed, gravity = speed_at_touch(case, flights), case.drop.gravity
        seen = from_heights(
            heights,
            deviation,
            first_speed=speed,
            radius=radius,
            gravity=gravity,
            labels=labels,
            flights=flights,
        )
        limit, values = _limit(seen, case), measured_restitutions(seen, radius, gravity)
        assert values is not None
        higher = np.flatnonzero(values > limit.most)
        if higher.size:
            at = int(higher[0])
            start = case.drop.height or radius + 0.5 * speed**2 / gravity
            fallen = heights[at - 1] if at else start
            higher_than = "higher than" if heights[at] > fallen else "too high for"
            what = f"{heights[at]:g} m is {higher_than} the {fallen:g} m from which the sphere fell"
            words = (
                f"{what}, and a restitution of "
                f"{_beyond_noise(values[at], limit.most[at], limit.why)}"
            )
            raise InputError(f"{labels[at]}: {words}", "target")
        return seen

    return Measurement(evaluated, float(heights.max()) - radius)


def first_impact_measurement(case: Case, target: ImpactTarget) -> Measurement:
    """Return the measurement of the first impact of the drop."""
    if target.rebound_height is not None:
        _check_above(case, np.array([target.rebound_height]), ("impact 1",))
    radius, part = case.sphere.radius, target.relative_deviation

    def evaluated(flights: Flights | None) -> Observations:
        speed, found = (
            speed_at_touch(case, flights),
            {name: getattr(target, name) for name in MATCHABLE},
        )
        if target.restitution is not None:
            found["separation_speed"] = target.restitution * speed
        if target.rebound_height is not None:
            rise = vacuum_height(
                flights or VacuumFlights(case.drop.gravity),
                np.array(target.rebound_height - radius),
            )[0]
            found["rebound_height"] = radius + float(rise)
        wanted = {name: np.array([value]) for name, value in found.items() if value is not None}
        deviations = (
            None if part is None else {name: part * value for name, value in wanted.items()}
        )
        seen = from_table(np.array([speed]), wanted, deviations, ("impact 1",), of_the_drop=True)
        if target.restitution is not None:
            check_restitutions(seen, case)
        return replace(seen, flights=flights)

    return Measurement(
        evaluated, 0.0 if target.rebound_height is None else target.rebound_height - radius
    )


def restitution_observations(case: Case, target: RestitutionTarget) -> Observations:
    """Return measured restitutions at several approach speeds."""
    assert isinstance(target.restitution, tuple)
    speeds, values = np.array(target.approach_speed), np.array(target.restitution)
    deviations = (
        None
        if target.standard_deviation is None
        else {"separation_speed": target.standard_deviation * speeds}
    )
    labels = tuple(f"restitution {number + 1}" for number in range(len(speeds)))
    seen = from_table(speeds, {"separation_speed": values * speeds}, deviations, labels)
    check_restitutions(seen, case)
    return seen


def check_restitutions(seen: Observations, case: Case) -> None:
    """Check that no restitution exceeds 1 by more than noise.

    Raises
    ------
    InputError
        If one does; the message gives the limit.
    """
    values = measured_restitutions(seen, case.sphere.radius, case.drop.gravity)
    if values is None:
        return
    limit = _limit(seen, case)
    over = np.flatnonzero(values > limit.most)
    if over.size:
        at = int(over[0])
        words = (
            f"restitution is {values[at]:.5g}; it is 1 at most, and "
            f"{_beyond_noise(values[at], limit.most[at], limit.why)}"
        )
        raise InputError(f"{seen.labels[at]}: {words}", "target")


def _limit(seen: Observations, case: Case) -> RestitutionLimit:
    values, deviations = measured_restitutions(seen, case.sphere.radius, case.drop.gravity), None
    assert values is not None
    if seen.deviations_known:
        name = "separation_speed" if "separation_speed" in seen.wanted else "rebound_height"
        left = values * seen.speeds
        by_reading = (
            np.ones(len(left))
            if name == "separation_speed"
            else case.drop.gravity / np.maximum(left, 1e-300)
        )
        noise = scaled(by_reading / seen.speeds, seen.noise[name]) - scaled(
            values / seen.speeds, seen.speed_noise
        )
        deviations = standard_deviations(noise)
    return restitution_limit(seen.speeds, values, deviations)


def _beyond_noise(value: float, most: float, why: str) -> str:
    """Return that a restitution is more than the most that is attributed to noise, in as
    many digits as tell them apart.
    """
    digits = next(
        (number for number in range(4, 17) if f"{value:.{number}g}" != f"{most:.{number}g}"), 17
    )
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
        what = (
            f"{heights[low[0]]:g} m is not above where the sphere lies on the plate, with its "
            f"centre at {case.sphere.radius:g} m"
        )
        raise InputError(f"{labels[low[0]]}: {what}", "target")
