"""Rules that end the run of a drop in its flight.

How a contact ends, and whether a sphere is at rest then, is decided at its release.

A rule is a function that returns when it ends the runs of drops [s], infinite where it does not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats, Integers
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.problem import MOST_IMPACTS
from vibroimpact.dynamics.run_state import RunState

StopRule: TypeAlias = Callable[[Drops, Flight, Floats], Floats]
"""Function of drops, their flights, and the times of their next touches [s]."""


class Stops(NamedTuple):
    """Which of some drops (b,) stop in their flights, when [s], and the codes of their outcomes."""

    stopped: Bools
    time: Floats
    outcome: Integers


def stop_rules(run: RunState) -> tuple[tuple[Outcome, StopRule], ...]:
    """Return the rules that can end a run, each with the outcome that it leads to.

    Of two that end it at one time the first counts.
    """
    problem = run.problem
    rules: list[tuple[Outcome, StopRule]] = []
    if problem.duration is not None:
        rules.append((Outcome.DURATION, at_time(problem.duration)))
    if problem.impacts is not None:
        rules.append((Outcome.IMPACTS, after_impacts(run, problem.impacts)))
    else:
        rules.append((Outcome.LIMIT, after_impacts(run, MOST_IMPACTS)))
    if run.oblique is not None:
        rules.append((Outcome.FELL, beside_plate(run.oblique)))
    return tuple(rules)


def at_time(end: float) -> StopRule:
    """Return the rule that ends runs at a time [s], or after a contact that is under way then."""

    def rule(drops: Drops, flight: Flight, touch: Floats) -> Floats:
        return np.maximum(end, flight.start)

    return rule


def after_impacts(run: RunState, number: int) -> StopRule:
    """Return the rule that ends runs after so many impacts.

    It does at the top of the rebound, or where a plate that is shaken touches sooner.
    """

    def rule(drops: Drops, flight: Flight, touch: Floats) -> Floats:
        if len(run.rows) < number:
            return np.full(len(drops), np.inf)
        return np.minimum(flight.apex()[0], touch)

    return rule


def beside_plate(oblique: ObliqueMotion) -> StopRule:
    """Return the rule that ends runs where a sphere beside the plate is level with its surface."""

    def rule(drops: Drops, flight: Flight, touch: Floats) -> Floats:
        return np.where(oblique.beside(drops, flight, touch), touch, np.inf)

    return rule


def first_stops(
    rules: tuple[tuple[Outcome, StopRule], ...], drops: Drops, flight: Flight, touch: Floats
) -> Stops:
    """Return which drops stop before their next touches [s].

    One that no rule ends and that never touches again stops as it leaves.
    """
    time = np.full(len(drops), np.inf)
    outcome = np.full(len(drops), Outcome.LEFT.code)
    for reason, rule in rules:
        end = rule(drops, flight, touch)
        sooner = end < time
        time = np.where(sooner, end, time)
        outcome[sooner] = reason.code
    leaves = np.isinf(touch) & np.isinf(time)
    time = np.where(leaves, flight.start, time)
    return Stops(touch >= time, time, outcome)
