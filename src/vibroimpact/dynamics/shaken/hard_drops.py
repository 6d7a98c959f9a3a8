"""Hard spheres on a rigid plate that is shaken, from a problem to the end of their runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vibroimpact.dynamics.motion.along import friction_parts
from vibroimpact.dynamics.motion.bounce import BouncesOfSeveral
from vibroimpact.dynamics.motion.columns import IMPACT_COLUMNS
from vibroimpact.dynamics.motion.ended_run import EndedRun
from vibroimpact.dynamics.motion.energy import close_ledger, ledger_holds
from vibroimpact.dynamics.motion.impact_rows import further_columns, stacked_tables, table_of
from vibroimpact.dynamics.motion.progress import of_several
from vibroimpact.dynamics.motion.rest import Rest
from vibroimpact.dynamics.shaken.hard_drop import HardDrop
from vibroimpact.dynamics.statement.outcome import Outcome
from vibroimpact.dynamics.statement.problem import Problem


def follow(
    problem: Problem, progress: Callable[[float], None] | None, *, keeps_bounces: bool
) -> EndedRun:
    """Follow the drops of a problem to the ends of their runs.

    Parameters
    ----------
    problem : Problem
        Whose law has no force, on a rigid plate that is shaken.
    progress : callable, optional
        Called after each impact with the fraction done, in [0, 1].
    keeps_bounces : bool
        Are flights and impacts kept, from which histories are read?
    """
    drops = []
    alone = problem.alone()
    for number, single in enumerate(alone):
        drop = HardDrop(single)
        drop.follow(of_several(progress, number, len(alone)))
        drops.append(drop)
    return _ended_run(problem, drops, keeps_bounces=keeps_bounces)


def _ended_run(problem: Problem, drops: Sequence[HardDrop], *, keeps_bounces: bool) -> EndedRun:
    """Return drops that have ended."""
    ledgers = [drop.entries() for drop in drops]
    added = np.array([added for _, added in ledgers])
    entries = {name: np.array([entry[name] for entry, _ in ledgers]) for name in ledgers[0][0]}
    energy = close_ledger(np.array([drop.energy_in for drop in drops]), added, entries)
    holds = ledger_holds(energy, added)
    if problem.oblique is not None:
        energy |= friction_parts(entries["friction_J"], np.zeros(len(drops)))
    outcomes = []
    for drop, held in zip(drops, holds.tolist(), strict=True):
        outcome = drop.outcome
        if outcome is None or not held:
            outcome = Outcome.FAILED
        outcomes.append(outcome)
    bounces = None
    if keeps_bounces:
        bounces = BouncesOfSeveral([drop.bounces for drop in drops])
    none = np.zeros(len(drops))
    rest = Rest(
        speed=np.array([drop.rest_speed for drop in drops]),
        time=np.array([drop.rest_time for drop in drops]),
        sag=none,
        stored=none,
        written_off=none,
        left=np.full(len(drops), np.nan),
        lying=(None,) * len(drops),
    )
    columns = [*IMPACT_COLUMNS, *further_columns(problem)]
    return EndedRun(
        problem,
        stacked_tables([table_of(drop.rows, columns) for drop in drops], columns),
        energy,
        tuple(outcomes),
        np.array([drop.end_time for drop in drops]),
        rest,
        bounces,
    )
