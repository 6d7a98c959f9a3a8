"""Drops from their starts to the ends of their runs, whatever their bodies."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.statement.problem import Problem


def follow(
    problem: Problem, progress: Callable[[float], None] | None, *, keeps_bounces: bool
) -> Response:
    """Return the response of the drops of a problem, with arrays of a batch.

    Parameters
    ----------
    problem : Problem
        What is simulated.
    progress : callable, optional
        Called after each impact with the fraction done, in [0, 1].
    keeps_bounces : bool
        Are flights and contacts kept, from which histories are read?
    """
    # Newton iterates may overflow; results that are not finite are detected and retried
    with np.errstate(all="ignore"):
        # a drop loads only what it needs: the others may take longer than it does
        if problem.vibrates:
            from vibroimpact.dynamics.vibrating.drops import follow as follow_vibrating

            ended = follow_vibrating(problem, progress, keeps_bounces=keeps_bounces)
        elif problem.shaken:
            from vibroimpact.dynamics.shaken.hard_drops import follow as follow_hard

            ended = follow_hard(problem, progress, keeps_bounces=keeps_bounces)
        else:
            from vibroimpact.dynamics.rigid.drops import follow as follow_rigid

            ended = follow_rigid(problem, progress, keeps_bounces=keeps_bounces)
    return Response(**vars(ended))
