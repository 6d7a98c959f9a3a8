"""Simulation of drops with their histories."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from vibroimpact.dynamics.follow import follow
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.statement.outcome import Outcome
from vibroimpact.dynamics.statement.problem import StatesProblem
from vibroimpact.errors import ComputationError, InputError


def simulate(problem: StatesProblem, progress: Callable[[float], None] | None = None) -> Response:
    """Simulate a sphere that falls and bounces until a stop criterion ends the run.

    Flight is exact. A contact is solved by Gauss collocation of whole phases, speed over
    indentation, or, where that does not come out to the tolerance, in steps of order 8, in a
    variable in which the force is smooth; histories are read in such steps. Bodies that have modes
    vibrate: between contacts exactly, and the next touch is the first meeting with the surface as
    it moves.

    Parameters
    ----------
    problem : Problem or Case
        What falls on what, how, and when to stop.
    progress : callable, optional
        Called after each impact with the fraction done, in [0, 1].

    Returns
    -------
    Response
        Impacts, histories, energy and a status sentence. In a batch a drop that failed says so in
        its outcome, and the others go on.

    Raises
    ------
    ComputationError
        If a single drop can't be computed, or its energy ledger does not close to 1e-6.

    Examples
    --------
    >>> from vibroimpact.bodies.body import Body
    >>> from vibroimpact.bodies.rigid_bodies import rigid_plate
    >>> from vibroimpact.contact.laws.newton import Newton
    >>> from vibroimpact.dynamics.statement.problem import Problem
    >>> problem = Problem(
    ...     sphere=Body(mass=1.0, contact_offset=0.1),
    ...     plate=rigid_plate(),
    ...     laws=(Newton(restitution=0.5),),
    ...     height=1.1,
    ...     impacts=3,
    ... )
    >>> simulate(problem).impacts["rebound_height_m"].round(6).tolist()
    [0.35, 0.1625, 0.115625]
    """
    if not hasattr(problem, "to_problem"):
        raise InputError(
            f"simulate takes a Problem, or a case as vi.load_case(...) reads it, not {problem!r}"
        )
    stated = problem.to_problem()
    response = follow(stated, progress, keeps_bounces=True)
    if stated.shape == ():
        response = response.squeezed()
    if response.problem.shape == () and response.outcomes[0] is Outcome.FAILED:
        raise ComputationError(response.status)
    return response


def simulate_together(problems: Sequence[StatesProblem]) -> list[Response | Exception]:
    """Return the responses of several drops, or of several batches.

    Parameters
    ----------
    problems : sequence of Problem or Case
        Of single drops or of batches, whatever their bodies.

    Returns
    -------
    list of Response or Exception
        The exception in place of the response where a drop failed; the others are not affected.
    """
    return [_response_or_error(problem) for problem in problems]


def _response_or_error(problem: StatesProblem) -> Response | Exception:
    try:
        return simulate(problem)
    except Exception as error:
        return error
