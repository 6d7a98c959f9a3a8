"""Simulation of batches of drops without histories, as for maps, sweeps and training sets."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.follow import follow
from vibroimpact.dynamics.motion.rest import Rest
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.statement.problem import Problem, StatesProblem
from vibroimpact.errors import InputError

BLOCK = 2000
"""Drops that run together: more take memory and no less time."""


def tabulate(
    problem: StatesProblem, progress: Callable[[float], None] | None = None, *, threads: int = 1
) -> Response:
    """Simulate a batch of drops and keep their impact tables, without histories.

    The numbers are those of `simulate` to the tolerance, for every problem. It keeps no histories,
    which are read within the contacts and need more nodes, and runs a large batch in blocks that
    stay in the cache.

    Parameters
    ----------
    problem : Problem or Case
        What falls on what, how, and when to stop.
    progress : callable, optional
        Called after each block of drops with the fraction done, in (0, 1].
    threads : int, default 1
        How many blocks are computed at once; the numbers do not depend on it.

    Returns
    -------
    Response
        Without histories. A drop that failed says so in its outcome and in `failures`, and the
        others go on.

    Raises
    ------
    InputError
        If it is not given a problem, or the number of threads is not positive.

    See Also
    --------
    simulate : keeps the histories too.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.laws.find_contact_law("hunt-crossley")(stiffness=5e8, restitution=[0.5, 0.7, 0.9])
    >>> ball = vi.Body(mass=0.1, contact_offset=0.02)
    >>> table = tabulate(
    ...     vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=1.0, impacts=2)
    ... )
    >>> table.impacts["restitution_achieved"].round(4).tolist()
    [[0.6628, 0.6627], [0.7679, 0.7678], [0.909, 0.909]]
    """
    if not hasattr(problem, "to_problem"):
        raise InputError(
            f"tabulate takes a Problem, or a case as vi.load_case(...) reads it, not {problem!r}"
        )
    if threads < 1:
        raise InputError(f"{threads} is no number of threads; give 1 or more", "threads")
    stated = problem.to_problem()
    size = math.prod(stated.shape)
    block = min(BLOCK, math.ceil(size / threads))
    blocks = [stated]
    if block < size:
        blocks = [stated.take(slice(begin, begin + block)) for begin in range(0, size, block)]
    parts = []
    for part in _tables_of(blocks, threads):
        parts.append(part)
        if progress is not None:
            progress(min(len(parts) * block / size, 1.0))
    table = parts[0]
    if len(parts) > 1:
        table = _joined(stated, parts)
    if stated.shape == ():
        return table.squeezed()
    return table


def _tables_of(blocks: Sequence[Problem], threads: int) -> Iterator[Response]:
    """Yield the responses of blocks of drops in order, some of them computed at once:
    compiled code releases the interpreter's lock.
    """
    if threads == 1:
        yield from map(_table_of, blocks)
        return
    with ThreadPoolExecutor(threads) as pool:
        yield from pool.map(_table_of, blocks)


def _table_of(problem: Problem) -> Response:
    """Return the response of a block of drops, with arrays of a batch, and without its history."""
    return follow(problem, None, keeps_bounces=False)


def _joined(problem: Problem, parts: Sequence[Response]) -> Response:
    """Return the responses to blocks of drops as one."""
    rows = max(part.impacts["impact"].shape[1] for part in parts)
    return Response(
        problem,
        {
            name: np.concatenate([_padded(part.impacts[name], rows) for part in parts])
            for name in parts[0].impacts
        },
        {name: np.concatenate([part.energy[name] for part in parts]) for name in parts[0].energy},
        tuple(outcome for part in parts for outcome in part.outcomes),
        np.concatenate([part.end_time for part in parts]),
        Rest.joined([part.rest for part in parts]),
        None,
    )


def _padded(column: Floats, rows: int) -> Floats:
    if column.shape[1] == rows:
        return column
    return np.pad(column, ((0, 0), (0, rows - column.shape[1])), constant_values=np.nan)
