"""Tangent problem of a stretch of contact: propagation of a small difference of the state by the linearised equations of motion.

The nodal forces of a stretch solve equations whose Jacobian is known, and all other quantities are linear in the forces. A difference of
the state at the start gives that at the end by one more linear solve. Differences are taken at equal times.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.linear_equations import stacked_matvec, stacked_solve
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import LocalContact, linearise_contacts, stack_contacts
from vibroimpact.dynamics.vibrating.receptance import Receptance, StackedSystems
from vibroimpact.dynamics.vibrating.solve_stretches import eliminate_indentations
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch, stretch_motions


@dataclass(frozen=True)
class TangentProblem:
    """Difference between a neighbouring motion and one that has been solved, through a stretch of one contact.

    Parameters
    ----------
    stretch : VibratingStretch
        The solved stretch.
    difference : State
        Difference of the state at its start, to first order.
    variations : sequence of (LocalContact, float)
        Contacts with the law's closing speed or a memory varied, each with the factor by which the change of its force counts.
    """

    stretch: VibratingStretch
    difference: State
    variations: Sequence[tuple[LocalContact, float]]

    @property
    def kind(self) -> tuple[object, ...]:
        """Key that problems must share to be solved together."""
        local = self.stretch.contacts[0].local
        return self.stretch.view.modes.kind, self.stretch.rule.time_map, type(local.law), bool(local.series), len(self.variations)

    @property
    def size(self) -> int:
        """Number of coordinates of the system."""
        return self.stretch.system.number

    @classmethod
    def solve_group(cls, problems: Sequence[Self]) -> list[tuple[State, Floats]]:
        """Return the results of `propagate_differences`."""
        return propagate_differences(problems)


def propagate_differences(problems: Sequence[TangentProblem]) -> list[tuple[State, Floats]]:
    """Return the differences of the state at the ends of stretches, and of the contact forces at their nodes [N] (N,)."""
    stretches, (first, *_) = [problem.stretch for problem in problems], problems
    contacts, basis = [stretch.contacts[0] for stretch in stretches], first.stretch.basis
    systems = StackedSystems([stretch.view.without_load for stretch in stretches], [problem.difference for problem in problems])
    delta, rates = (np.array([part[1:] for part in parts]) for parts in zip(*((one.delta, one.rate) for one in contacts), strict=True))
    receptance = Receptance(systems, basis, np.array([stretch.length for stretch in stretches]))
    law = linearise_contacts([stack_contacts([contact.local for contact in contacts])], delta, rates)
    reduced = eliminate_indentations(law, receptance)
    missing, changed, known = receptance.approach.copy(), law.dissipative_by_rate * receptance.rate, np.zeros_like(receptance.rate)
    # a varied closing speed or memory changes the forces of the law and its approach at fixed indentations and rates
    for of_all in zip(*(problem.variations for problem in problems), strict=True):
        other = linearise_contacts([stack_contacts([varied for varied, _ in of_all])], delta, rates)
        weight = np.array([weight for _, weight in of_all])[:, None]
        static = weight * (other.static - law.static)
        missing -= weight * (other.approach - law.approach)
        if receptance.approach_by_static is not None:
            missing -= stacked_matvec(receptance.approach_by_static, static)
        changed += static + weight * (other.dissipative - law.dissipative)
        known += static
    free_delta = reduced.indentations(missing)
    force = stacked_solve(reduced.jacobian, changed + reduced.force_by_delta * free_delta)
    static = known + law.stiffness * (free_delta - stacked_matvec(reduced.by_force, force))
    motions = stretch_motions(
        systems, basis, receptance.length, (receptance.admittance, receptance.responses), force[:, None], static[:, None]
    )
    return [(motion.end, one) for motion, one in zip(motions, force, strict=True)]
