"""How much of a run is done, for those who wait for it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.statement.problem import MOST_IMPACTS, Problem


def fraction_done(
    problem: Problem,
    impacts: int,
    time: float,
    first_speed: Floats,
    velocity: Floats,
    rest_speed: Floats,
) -> float:
    """Return the fraction of a run that is done, in [0, 1].

    Parameters
    ----------
    problem : Problem
        What is simulated.
    impacts : int
        How many impacts there were.
    time : float
        Up to which all drops have been followed [s].
    first_speed, velocity, rest_speed : array, shape (b,)
        First approach speeds, velocities upwards after the last impact, and rest speeds of the
        drops that still move [m/s].
    """
    fraction = impacts / (problem.impacts or MOST_IMPACTS)
    if problem.duration is not None:
        fraction = max(fraction, time / problem.duration)
    # up to rest: the logarithm of the speed falls about linearly
    if problem.impacts is None and impacts and not problem.shaken:
        decay = np.log(first_speed / velocity)
        decay_at_rest = np.log(first_speed / rest_speed)
        slowest = np.nanmin(np.clip(decay / decay_at_rest, 0.0, 1.0), initial=1.0)
        fraction = max(fraction, float(slowest))
    return fraction


def of_several(
    progress: Callable[[float], None] | None, number: int, drops: int
) -> Callable[[float], None] | None:
    """Return what tells the fraction done of several drops from that of the one with a number.

    Examples
    --------
    >>> of_several(print, 1, 4)(0.5)
    0.375
    """
    if progress is None:
        return None
    return lambda fraction: progress((number + fraction) / drops)
