"""The interface of contact solvers of rigid bodies, and the one that uses the core."""

from __future__ import annotations

from typing import Protocol

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.contact import Contact
from vibroimpact.dynamics.impact_conditions import ImpactConditions
from vibroimpact.dynamics.oblique.oblique_motion import friction_steps
from vibroimpact.dynamics.problem import Problem


class SolvesContact(Protocol):
    """A solver of one contact of some drops of a run."""

    def __call__(
        self, conditions: ImpactConditions, drops: Drops
    ) -> tuple[Contact, Floats, Floats]:
        """Return the contact, its largest force [N], and the time of that since first touch [s].

        `drops` are indices in the run.
        """
        ...


def solver_for(problem: Problem) -> SolvesContact:
    """Return the solver of contacts of rigid bodies for the drops of a problem."""
    steps = 0 if problem.oblique is None else friction_steps(problem.tolerance)

    def solve(conditions: ImpactConditions, drops: Drops) -> tuple[Contact, Floats, Floats]:
        # a law without a force does not load the compiler
        from vibroimpact.dynamics.rigid.line_contact import follow_contacts

        return follow_contacts(conditions, problem.tolerance, steps)

    return solve
