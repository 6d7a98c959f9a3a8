"""Single impacts at many approach speeds, computed as one batch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.matchable import ALONG_PLATE, MATCHABLE, MatchableQuantity
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.flight_in_fluid import flights_of, speed_of_fall
from vibroimpact.dynamics.oblique.statement import Oblique
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.tabulate import tabulate

_TOLERANCE = 1e-11  # with a smaller one the impacts are followed one by one
AT_ONCE = 4000
"""Impacts that are computed together: more take memory and no less time."""


def single_impacts(problem: Problem, law: ContactLaw, speeds: Floats) -> dict[str, Floats]:
    """Return separation speed [m/s], largest force [N], largest indentation [m], duration [s] and
    rebound height [m] of single impacts.

    Gravity acts during contact, as in a run, and each impact is on undeformed surfaces.

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
    some = [slice(begin, begin + AT_ONCE) for begin in range(0, len(speeds), AT_ONCE)]
    each = [_single_impacts(problem, law.take(rows), speeds[rows]) for rows in some]
    return (
        each[0]
        if len(each) == 1
        else {name: np.concatenate([found[name] for found in each]) for name in each[0]}
    )


def _single_impacts(problem: Problem, law: ContactLaw, speeds: Floats) -> dict[str, Floats]:
    response = simulate(replace(_one_impact(problem, law, speeds), tolerance=_TOLERANCE))
    found = _first_impacts(response, MATCHABLE)
    if problem.liquid is not None and problem.gravity > 0.0:  # the flight of the response is in it
        found["rebound_height"] = (
            problem.sphere.contact_offset + 0.5 * found["separation_speed"] ** 2 / problem.gravity
        )
    rise = np.maximum(found["rebound_height"] - problem.sphere.contact_offset, 0.0)
    return {**found, "next_speed": np.sqrt(2.0 * problem.gravity * rise)}


def oblique_impacts(
    problem: Problem, law: ContactLaw, speeds: Floats, oblique: Oblique
) -> dict[str, Floats]:
    """Return what friction determines of single oblique impacts, by the names of `ALONG_PLATE`, and
    their separation speeds [m/s].

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
    response = tabulate(
        replace(_one_impact(problem, law, speeds), oblique=oblique, same_spot=False)
    )
    return _first_impacts(
        response, {"separation_speed": MATCHABLE["separation_speed"], **ALONG_PLATE}
    )


def _one_impact(problem: Problem, law: ContactLaw, speeds: Floats) -> Problem:
    begun = replace(
        problem, laws=(law,), height=None, speed=np.asarray(speeds, dtype=float), air=None
    )
    return replace(begun, impacts=1, duration=None, rest_speed=0.0, sensors=())


def _first_impacts(
    response: Response, quantities: Mapping[str, MatchableQuantity]
) -> dict[str, Floats]:
    """Return quantities of the first impacts, NaN of those that could not be computed."""
    failed = np.array([outcome is Outcome.FAILED for outcome in response.outcomes])
    return {
        name: np.where(failed, np.nan, response.impacts[column][:, 0])
        for name, (column, *_) in quantities.items()
    }


def first_approach_speed(problem: Problem) -> float:
    """Return the speed at the first touch of a drop [m/s]."""
    if problem.speed is not None:
        return float(problem.speed)
    if problem.fluid is not None:
        return speed_of_fall(problem)
    return float(
        np.sqrt(
            2.0 * problem.gravity * (np.asarray(problem.height) - problem.sphere.contact_offset)
        )
    )


def return_speeds(problem: Problem, speeds: Floats) -> Floats:
    """Return the speeds at which spheres come back that leave the plate with given ones
    [m/s], through what a drop flies through.
    """
    if problem.fluid is None:
        return speeds
    return flights_of(problem, np.zeros(len(speeds)), speeds).touch(np.zeros(1))[1]


def batched_law(laws: Sequence[ContactLaw], number: int) -> ContactLaw:
    """Return the laws of the first impacts as one law with array parameters; the last law holds for
    all further impacts.

    Examples
    --------
    >>> from vibroimpact.contact.laws.newton import Newton
    >>> batched_law((Newton(restitution=0.7), Newton(restitution=0.6)), 3).restitution.tolist()
    [0.7, 0.6, 0.6]
    """
    if len(laws) == 1:
        return laws[0]
    each = [laws[min(impact, len(laws) - 1)] for impact in range(number)]
    return laws[0].changed(
        {item.name: np.array([getattr(law, item.name) for law in each]) for item in fields(laws[0])}
    )
