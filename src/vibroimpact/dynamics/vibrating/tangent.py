r"""How a small difference between two drops goes through a stretch of contact: the linearised equations of motion.

The force at the nodes of a stretch solves equations whose Jacobian is at hand, and all else is linear in it: so a difference of the
state at the start gives that at the end by one more linear solve. Differences are those at equal times.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.linear_equations import solutions, times
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.local import LocalContact, linearised, stacked
from vibroimpact.dynamics.vibrating.receptance import Receptance, Together
from vibroimpact.dynamics.vibrating.solve_stretch import eliminated
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch, motions_of


@dataclass(frozen=True)
class Beside:
    """A second drop beside one that goes through a stretch of contact.

    Parameters
    ----------
    stretch : VibratingStretch
        A stretch of one contact that was solved.
    difference : State
        That of the second drop at its start, to first order.
    asides : sequence of (LocalContact, float)
        Contacts whose laws know something a little differently, as the second drop's does, and how many times their change of force counts.
    """

    stretch: VibratingStretch
    difference: State
    asides: Sequence[tuple[LocalContact, float]]

    @property
    def kind(self) -> tuple[object, ...]:
        """What has to be the same for differences that go through their stretches together."""
        local = self.stretch.contacts[0].local
        return self.stretch.seen.of.kind, self.stretch.rule.time_map, type(local.law), bool(local.series), len(self.asides)

    @property
    def size(self) -> int:
        """How many coordinates the system has."""
        return self.stretch.system.number

    @classmethod
    def solved(cls, problems: Sequence[Self]) -> list[tuple[State, Floats]]:
        """Return what `differences_through` does."""
        return differences_through(problems)


def differences_through(besides: Sequence[Beside]) -> list[tuple[State, Floats]]:
    """Return the differences of second drops at the ends of stretches, and those of their contact forces at the nodes [N] (N,)."""
    stretches, (first, *_) = [beside.stretch for beside in besides], besides
    contacts, at = [stretch.contacts[0] for stretch in stretches], first.stretch.spectrum
    systems = Together([stretch.seen.without_load for stretch in stretches], [beside.difference for beside in besides])
    delta, rates = (np.array([part[1:] for part in parts]) for parts in zip(*((one.delta, one.rate) for one in contacts), strict=True))
    here = Receptance(systems, at, np.array([stretch.length for stretch in stretches]))
    now = linearised([stacked([contact.local for contact in contacts])], delta, rates)
    left = eliminated(now, here)
    missing, changed, known = here.approach.copy(), now.dissipative_by_rate * here.rate, np.zeros_like(here.rate)
    for of_all in zip(*(beside.asides for beside in besides), strict=True):
        other = linearised([stacked([aside for aside, _ in of_all])], delta, rates)
        often = np.array([often for _, often in of_all])[:, None]
        static = often * (other.static - now.static)
        missing -= often * (other.approach - now.approach)
        if here.by_static is not None:
            missing -= times(here.by_static, static)
        changed += static + often * (other.dissipative - now.dissipative)
        known += static
    sunk = left.answer(missing)
    force = solutions(left.jacobian, changed + left.push * sunk)
    static = known + now.stiffness * (sunk - times(left.taken, force))
    motions = motions_of(systems, at, here.length, (here.admittance, here.responses), force[:, None], static[:, None])
    return [(motion.end, one) for motion, one in zip(motions, force, strict=True)]
