"""What a problem says of the start, the laws and the end of a run."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import law_addresses
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.dynamics.core import stop_rules
from vibroimpact.dynamics.core.drop_records import StopRules
from vibroimpact.dynamics.core.drops import LEAST_REST_SPEED, default_rest_speed
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.law_coefficients import coefficients_of
from vibroimpact.dynamics.statement.outcome import OUTCOMES, Outcome
from vibroimpact.dynamics.statement.problem import MOST_IMPACTS, Problem

_APART = 4e-15  # of the amplitude of a shaken plate: the rounding error of its place

IS_AT_REST = np.array([outcome.at_rest for outcome in OUTCOMES])
"""Which outcomes are rest, by their codes."""


def laws_of(problem: Problem) -> list[ContactLaw]:
    """Return the laws of the impacts of a problem, of which the last one goes on.

    Where the memory lasts, that of the first law at the start is that of all.
    """
    if not problem.memory_lasts:
        return list(problem.laws)
    memories = problem.laws[0].memories()
    return [law.changed(memories) for law in problem.laws]


def stop_rules_of(problem: Problem) -> StopRules:
    """Return the rules that can end a run; of two that end it at one time the first counts."""
    rules: list[tuple[int, float, Outcome]] = []
    if problem.duration is not None:
        rules.append((stop_rules.AT_TIME, problem.duration, Outcome.DURATION))
    if problem.impacts is not None:
        rules.append((stop_rules.AFTER_IMPACTS, problem.impacts, Outcome.IMPACTS))
    else:
        rules.append((stop_rules.AFTER_IMPACTS, MOST_IMPACTS, Outcome.LIMIT))
    if problem.oblique is not None:
        rules.append((stop_rules.BESIDE_PLATE, 0.0, Outcome.FELL))
    kinds, values, outcomes = zip(*rules, strict=True)
    endings = [outcome.code for outcome in outcomes]
    return StopRules(np.array(kinds), np.array(values, dtype=float), np.array(endings))


def default_rest_speeds(law: ContactLaw, flight: Flight, mass: Floats, gravity: Floats) -> Floats:
    """Return the speeds of separation below which drops without a stated one rest [m/s] (B,).

    Under a law without a force they are 1e-6 of the first approach speed.

    Parameters
    ----------
    law : ContactLaw
        That of the first impact.
    flight : Flight
        The first flights.
    mass, gravity : array, shape (B,)
        Of the spheres [kg], and what accelerates them onto the plate [m/s^2].
    """
    _, speed = flight.touch(np.zeros(1))
    if not isinstance(law, CompliantLaw):
        return LEAST_REST_SPEED * speed
    addresses = law_addresses(type(law))
    with coefficients_of(law, len(mass)) as coefficients:
        speeds = np.empty_like(speed)
        for drop in range(len(speed)):
            speeds[drop] = default_rest_speed(
                addresses, coefficients[drop], mass[drop], gravity[drop], speed[drop]
            )
    return speeds


def start_of(problem: Problem) -> tuple[float, float]:
    """Return the gap [m] and the velocity upwards [m/s] of a single drop at its start."""
    if problem.height is not None:
        return float(problem.height - problem.sphere.contact_offset), float(problem.velocity)
    # at touch: apart by the rounding error of the place of a plate that is shaken
    gap = problem.surface(0.0)[0] + _APART * np.abs(problem.surface_phasors).sum()
    assert problem.speed is not None  # the problem has seen to it
    return float(gap), -float(problem.speed)
