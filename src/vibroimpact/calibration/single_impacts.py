"""Single impacts at many approach speeds, computed as one batch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.matchable import MATCHABLE
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate

_TOLERANCE = 1e-12


def single_impacts(problem: Problem, law: ContactLaw, speeds: Floats) -> dict[str, Floats]:
    """Return separation speed [m/s], largest force [N], largest indentation [m], duration [s] and rebound height [m] of single impacts.

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
        By the names of `MATCHABLE`, and `next_speed`, the approach speed of the next impact in a vacuum [m/s]. Quantities of an impact
        that could not be computed are NaN.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> problem = vi.load_case("paper:type1-theory").to_problem()
    >>> single_impacts(problem, problem.laws[0], np.array([8.826664149]))["separation_speed"].round(6).tolist()
    [6.838627]
    """
    begun = replace(problem, laws=(law,), height=None, speed=np.asarray(speeds, dtype=float), tolerance=_TOLERANCE)
    response = simulate(replace(begun, impacts=1, duration=None, rest_speed=0.0, sensors=()))
    failed = np.array([outcome is Outcome.FAILED for outcome in response.outcomes])
    found = {name: np.where(failed, np.nan, response.impacts[column][:, 0]) for name, (column, *_) in MATCHABLE.items()}
    rise = np.maximum(response.impacts["rebound_height_m"][:, 0] - problem.sphere.contact_offset, 0.0)
    return {**found, "next_speed": np.sqrt(2.0 * problem.gravity * rise)}


def first_approach_speed(problem: Problem) -> float:
    """Return the speed at the first touch of a drop [m/s]."""
    if problem.speed is not None:
        return float(problem.speed)
    return float(np.sqrt(2.0 * problem.gravity * (np.asarray(problem.height) - problem.sphere.contact_offset)))


def batched_law(laws: Sequence[ContactLaw], number: int) -> ContactLaw:
    """Return the laws of the first impacts as one law with array parameters; the last law holds for all further impacts.

    Examples
    --------
    >>> from vibroimpact.contact.laws.newton import Newton
    >>> batched_law((Newton(restitution=0.7), Newton(restitution=0.6)), 3).restitution.tolist()
    [0.7, 0.6, 0.6]
    """
    if len(laws) == 1:
        return laws[0]
    each = [laws[min(impact, len(laws) - 1)] for impact in range(number)]
    return laws[0].changed({item.name: np.array([getattr(law, item.name) for law in each]) for item in fields(laws[0])})
