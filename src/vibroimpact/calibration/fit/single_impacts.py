"""Single impacts at many approach speeds, computed as one batch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.observed.matchable import ALONG_PLATE, MATCHABLE, MatchableQuantity
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.motion.flight_in_fluid import first_flights, speed_of_fall
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.dynamics.statement.outcome import Outcome
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.tabulate import BLOCK, tabulate

_TOLERANCE = 1e-11
"""Relative tolerance of an impact; with a smaller one the impacts are followed one by one."""


def single_impacts(problem: Problem, law: ContactLaw, speeds: Floats) -> dict[str, Floats]:
    """Return the quantities of single impacts by the names of `MATCHABLE`.

    They are separation speed [m/s], largest force [N], largest indentation [m], duration [s] and
    rebound height [m]. Gravity acts during contact, as in a run, and each impact is on undeformed
    surfaces.

    Parameters
    ----------
    problem : Problem
        The bodies.
    law : ContactLaw
        The contact law; array parameters have one value per speed.
    speeds : array, shape (n,)
        Approach speeds [m/s].

    Returns
    -------
    dict of str to array, shape (n,)
        By the names of `MATCHABLE`, the rebound height as in a vacuum, and `next_speed`, the
        approach speed of the next impact in a vacuum [m/s]. Quantities of an impact that could not
        be computed are NaN.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> problem = vi.load_case("paper:type1-theory").to_problem()
    >>> single_impacts(problem, problem.laws[0], np.array([8.826664149]))["separation_speed"].round(
    ...     6
    ... ).tolist()
    [6.838627]
    """
    blocks = []
    for begin in range(0, len(speeds), BLOCK):
        rows = slice(begin, begin + BLOCK)
        blocks.append(_single_impacts(problem, law.take(rows), speeds[rows]))
    if len(blocks) == 1:
        return blocks[0]
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def _single_impacts(problem: Problem, law: ContactLaw, speeds: Floats) -> dict[str, Floats]:
    response = simulate(replace(_one_impact(problem, law, speeds), tolerance=_TOLERANCE))
    outcomes = _first_impacts(response, MATCHABLE)
    offset = problem.sphere.contact_offset
    if problem.liquid is not None and problem.gravity > 0.0:  # the flight of the response is in it
        outcomes["rebound_height"] = (
            offset + 0.5 * outcomes["separation_speed"] ** 2 / problem.gravity
        )
    rise = np.maximum(outcomes["rebound_height"] - offset, 0.0)
    return {**outcomes, "next_speed": np.sqrt(2.0 * problem.gravity * rise)}


def oblique_impacts(
    problem: Problem, law: ContactLaw, speeds: Floats, oblique: Oblique
) -> dict[str, Floats]:
    """Return the quantities of single oblique impacts that friction determines.

    They have the names of `ALONG_PLATE`; the separation speeds [m/s] are there, too.

    Parameters
    ----------
    problem : Problem
        The bodies.
    law : ContactLaw
        The contact law; array parameters have one value per impact.
    speeds : array, shape (n,)
        Approach speeds along the normal [m/s].
    oblique : Oblique
        Velocities along the plate, spins and friction law; arrays have one value per impact.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> problem = vi.load_case("paper:type1-theory").to_problem()
    >>> slippery = Oblique(velocity=(1.0, 0.0))
    >>> oblique_impacts(problem, problem.laws[0], np.array([2.0]), slippery)[
    ...     "tangential_restitution"
    ... ].tolist()
    [1.0]
    """
    impacts = replace(_one_impact(problem, law, speeds), oblique=oblique, same_spot=False)
    quantities = {"separation_speed": MATCHABLE["separation_speed"], **ALONG_PLATE}
    return _first_impacts(tabulate(impacts), quantities)


def _one_impact(problem: Problem, law: ContactLaw, speeds: Floats) -> Problem:
    """Return a batch of drops, one for each approach speed [m/s], that end after one impact."""
    return replace(
        problem,
        laws=(law,),
        height=None,
        speed=np.asarray(speeds, dtype=float),
        air=None,
        impacts=1,
        duration=None,
        rest_speed=0.0,
        sensors=(),
    )


def _first_impacts(
    response: Response, quantities: Mapping[str, MatchableQuantity]
) -> dict[str, Floats]:
    """Return quantities of the first impacts, NaN of those that could not be computed."""
    failed = np.zeros(len(response.outcomes), dtype=bool)
    if Outcome.FAILED in response.outcomes:
        failed[:] = [outcome is Outcome.FAILED for outcome in response.outcomes]
    return {
        name: np.where(failed, np.nan, response.impacts[quantity.column][:, 0])
        for name, quantity in quantities.items()
    }


def first_approach_speed(problem: Problem) -> float:
    """Return the speed at the first touch of a drop [m/s]."""
    if problem.speed is not None:
        return float(problem.speed)
    if problem.fluid is not None:
        return speed_of_fall(problem)
    fall = np.asarray(problem.height) - problem.sphere.contact_offset
    return float(np.sqrt(2.0 * problem.gravity * fall))


def return_speeds(problem: Problem, speeds: Floats) -> Floats:
    """Return the speeds at which spheres come back that leave the plate with `speeds` [m/s].

    They fly through the fluid of the drop.
    """
    if problem.fluid is None:
        return speeds
    _, touch_speeds = first_flights(problem, np.zeros(len(speeds)), speeds).touch(np.zeros(1))
    return touch_speeds


def batched_law(laws: Sequence[ContactLaw], number: int) -> ContactLaw:
    """Return the laws of the first impacts as one law with array parameters.

    The last law holds for all further impacts.

    Examples
    --------
    >>> from vibroimpact.contact.laws.newton import Newton
    >>> batched_law((Newton(restitution=0.7), Newton(restitution=0.6)), 3).restitution.tolist()
    [0.7, 0.6, 0.6]
    """
    if len(laws) == 1:
        return laws[0]
    law_of_impact = [laws[min(impact, len(laws) - 1)] for impact in range(number)]
    return laws[0].changed(
        {
            field.name: np.array([getattr(law, field.name) for law in law_of_impact])
            for field in fields(laws[0])
        }
    )
