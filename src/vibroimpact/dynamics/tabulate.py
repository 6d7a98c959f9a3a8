"""The table of a batch of drops without their histories: what a map, a sweep or a training set asks for."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.energy import why_failed
from vibroimpact.dynamics.lockstep import computed
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.dynamics.phase_plane.contact import contact_solver
from vibroimpact.dynamics.problem import Problem, StatesProblem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.run import Run
from vibroimpact.errors import InputError

_BLOCK = 2000  # drops run at once: enough for arrays to pay, few enough to stay in the cache


@dataclass(frozen=True, eq=False)
class ImpactTable:
    """The impacts of a batch of B drops, their ledgers, and why each ended.

    Attributes
    ----------
    problem : Problem
        What was simulated.
    impacts : dict of str to array, shape (B, impacts)
        One entry a column of `impacts.csv`, NaN where a drop had fewer impacts than others.
    energy : dict of str to array, shape (B,)
        The ledger of each drop at the end [J], what was put in, and the closure; `closure_relative` is without dimension.
    outcomes : tuple of Outcome
        Which rule ended each drop.
    end_time : array, shape (B,)
        When each run ended [s].
    left : array, shape (B,)
        What is left in vibration where a drop came to rest, or rides, on what vibrates [J]; NaN for the others.
    failures : dict of int to str
        Why a drop failed, in a sentence, by its number from 0; empty if none did.

    See Also
    --------
    tabulate : makes one.
    """

    problem: Problem
    impacts: dict[str, Floats]
    energy: dict[str, Floats]
    outcomes: tuple[Outcome, ...]
    end_time: Floats
    left: Floats
    failures: dict[int, str]

    def __len__(self) -> int:
        """Return the number of drops."""
        return len(self.outcomes)

    def __repr__(self) -> str:
        return f"<ImpactTable of {len(self)} drops>"


def tabulate(problem: StatesProblem, progress: Callable[[float], None] | None = None) -> ImpactTable:
    """Let the sphere fall and bounce until a stop rule, and keep the table of impacts alone.

    The numbers are those of `simulate` to the tolerance, for every problem. It keeps no histories, which are read within the
    contacts and need more nodes, and runs a large batch in blocks that stay in the cache.

    Parameters
    ----------
    problem : Problem or Case
        What falls on what, how, and when to stop.
    progress : callable, optional
        Called after each block of drops with the fraction done, in (0, 1].

    Returns
    -------
    ImpactTable
        One drop is a batch of one. A drop that failed says so in its outcome and in `failures`, and the others go on.

    Raises
    ------
    InputError
        If it is not given a problem.

    See Also
    --------
    simulate : keeps the histories too.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.find_contact_law("hunt-crossley")(stiffness=5e8, restitution=[0.5, 0.7, 0.9])
    >>> ball = vi.Body(mass=0.1, contact_offset=0.02)
    >>> table = tabulate(vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=1.0, impacts=2))
    >>> table.impacts["restitution_achieved"].round(4).tolist()
    [[0.6628, 0.6627], [0.7679, 0.7678], [0.909, 0.909]]
    """
    if not hasattr(problem, "to_problem"):
        raise InputError(f"tabulate takes a Problem, or a case as vi.load_case(...) reads it, not {problem!r}")
    stated = problem.to_problem()
    size = math.prod(stated.shape)
    parts = []
    for begin in range(0, size, _BLOCK):
        parts.append(_table_of(stated if size <= _BLOCK else stated.take(slice(begin, begin + _BLOCK))))
        if progress is not None:
            progress(min((begin + _BLOCK) / size, 1.0))
    rows = max(part.impacts["impact"].shape[1] for part in parts)
    ended = tuple(outcome for part in parts for outcome in part.outcomes)
    energy = {name: np.concatenate([part.energy[name] for part in parts]) for name in parts[0].energy}
    return ImpactTable(
        stated,
        {name: np.concatenate([_padded(part.impacts[name], rows) for part in parts]) for name in parts[0].impacts},
        energy,
        ended,
        np.concatenate([part.end_time for part in parts]),
        np.concatenate([part.rest.left for part in parts]),
        {
            drop: why_failed({name: values[drop] for name, values in energy.items()})
            for drop, outcome in enumerate(ended)
            if outcome is Outcome.FAILED
        },
    )


def _table_of(problem: Problem) -> Response:
    """Return the response of a block of drops, with arrays of a batch, and without its history."""
    run = Run(problem, contact_solver(problem.laws[0], problem.tolerance, math.prod(problem.shape)))
    while run.moving.any():
        computed(run.advance())
    return run.batch()


def _padded(column: Floats, rows: int) -> Floats:
    if column.shape[1] == rows:
        return column
    return np.pad(column, ((0, 0), (0, rows - column.shape[1])), constant_values=np.nan)
