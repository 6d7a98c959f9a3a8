"""Drops whose runs have ended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.bounce import Bounce, BouncesOfDrops
from vibroimpact.dynamics.motion.rest import Rest
from vibroimpact.dynamics.statement.outcome import Outcome
from vibroimpact.dynamics.statement.problem import Problem


@dataclass(frozen=True, eq=False)
class EndedRun:
    """The impacts of one drop or of B drops, their energies, and how they ended.

    The members are those of `Response`; all arrays are those of a batch.
    """

    problem: Problem
    impacts: dict[str, Floats]
    energy: dict[str, Floats]
    outcomes: tuple[Outcome, ...]
    end_time: Floats
    rest: Rest
    bounces: Sequence[Bounce] | BouncesOfDrops | None
