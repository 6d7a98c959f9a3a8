"""The contact force of a sphere of some size and speed, by the contact law of a case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.rigid.pair import resized
from vibroimpact.cases.rigid.rigid_problem import rigid_problem
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate_together
from vibroimpact.dynamics.statement.problem import Problem

_NODES = np.polynomial.legendre.leggauss(96)
"""Nodes on [-1, 1] and weights of the quadrature of a force."""
_INSTANTS = 400
"""Instants at which it is seen where the first of several touches ends."""
_REFINEMENTS = 4
"""How often these instants are refined."""


@dataclass(frozen=True)
class ContactForce:
    """A contact force.

    Parameters
    ----------
    time, impulse : array, shape (n,)
        Times since first touch [s] and impulses [N s] that stand for it.
    value : array, shape (n,)
        The force at these times [N].
    facts : array, shape (3,)
        Largest force [N], impulse [N s] and duration [s].
    """

    time: Floats
    impulse: Floats
    value: Floats
    facts: Floats


class Spheres(NamedTuple):
    """Spheres that hit a plate at one place.

    `case`: material and mean density of the sphere, contact law. `plate`: its problem with the
    contact at the place. `radius`, `speed`: radius [m] and approach speed [m/s] of each sphere,
    (n,).
    """

    case: CaseTable
    plate: Problem
    radius: Floats
    speed: Floats

    @property
    def problem(self) -> Problem:
        """The problem of their impacts."""
        drop = self.case.drop.model_copy(
            update={"speed": self.speed, "height": None, "velocity": None, "air": None}
        )
        sphere = resized(self.case.sphere, self.radius)
        rigid = rigid_problem(self.case.model_copy(update={"sphere": sphere, "drop": drop}))
        return replace(
            self.plate,
            sphere=rigid.sphere,
            laws=rigid.laws,
            height=None,
            velocity=0.0,
            speed=self.speed,
            air=None,
            sensors=(),
            sensitivity=False,
        )


def contact_forces(
    case: CaseTable, plate: Problem, radius: Floats, speed: Floats
) -> list[ContactForce]:
    """Return the contact forces of spheres, from first touch until they first leave the plate.

    Parameters
    ----------
    case, plate, radius, speed
        Those of `Spheres`.
    """
    return contact_forces_of([Spheres(case, plate, radius, speed)])


def contact_forces_of(several: Sequence[Spheres]) -> list[ContactForce]:
    """Return the contact forces of spheres that hit different plates, in order.

    They are computed side by side. A sphere that leaves the plate more slowly than the plate
    follows it touches again within one impact. These touches come and go with the parameters, and
    the records that are used end before the next touch.
    """
    responses = simulate_together([spheres.problem for spheres in several])
    forces = []
    for spheres, response in zip(several, responses, strict=True):
        if isinstance(response, Exception):
            raise response
        for number in range(len(spheres.radius)):
            forces.append(_contact_force(response.drop(number)))
    return forces


def _contact_force(response: Response) -> ContactForce:
    """Return the contact force of one drop."""
    duration = float(response.impacts["duration_s"][0])
    peak = float(response.impacts["max_force_N"][0])
    time, value = _at_nodes(response, duration)
    # without a force before the last one: there are several touches
    until_last = value[: np.flatnonzero(value)[-1]]
    if (until_last == 0.0).any():
        duration, peak = _first_touch(response, duration)
        time, value = _at_nodes(response, duration)
    _, weights = _NODES
    impulse = 0.5 * duration * weights * value  # Gauss's rule from [-1, 1] to the contact
    return ContactForce(time, impulse, value, np.array([peak, impulse.sum(), duration]))


def _at_nodes(response: Response, duration: float) -> tuple[Floats, Floats]:
    """Return the nodes of the quadrature over a duration [s], and the force there [N]."""
    nodes, _ = _NODES
    time = 0.5 * duration * (1.0 + nodes)
    return time, _force(response, time)


def _force(response: Response, time: Floats) -> Floats:
    return response.at(time, ["force_N"])["force_N"]


def _first_touch(response: Response, duration: float) -> tuple[float, float]:
    """Return the duration [s] and the largest force [N] of the first of several touches."""
    begin = 0.0
    end = duration
    for _ in range(_REFINEMENTS):  # between the last instant with a force and the first without one
        time = np.linspace(begin, end, _INSTANTS)
        first_without = 1 + int(np.argmax(_force(response, time[1:]) == 0.0))
        begin = time[first_without - 1]
        end = time[first_without]
    peak = _force(response, np.linspace(0.0, begin, _INSTANTS)).max()
    return float(begin), float(peak)
