"""The contact force of a sphere of some size and speed, as the case's contact law has it
on the elastic plate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.pair import resized
from vibroimpact.cases.rigid_problem import rigid_problem
from vibroimpact.cases.schema import CaseTable
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate_together

_NODES = np.polynomial.legendre.leggauss(96)
"""Nodes on [-1, 1] and weights of the quadrature of a force."""
_INSTANTS, _REFINEMENTS = 400, 4
"""Instants at which it is seen where the first of several touches ends, and how often
they are refined.
"""


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
        case, radius, speed = self.case, self.radius, self.speed
        drop = case.drop.model_copy(
            update={"speed": speed, "height": None, "velocity": None, "air": None}
        )
        rigid = rigid_problem(
            case.model_copy(update={"sphere": resized(case.sphere, radius), "drop": drop})
        )
        return replace(
            self.plate,
            sphere=rigid.sphere,
            laws=rigid.laws,
            height=None,
            velocity=0.0,
            speed=speed,
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
    """Return the contact forces of spheres that hit different plates, computed side by side, in
    order.

    A sphere that leaves the plate more slowly than the plate follows it touches again within one
    impact. These touches come and go with the parameters, and the records that are used end before
    the next touch.
    """
    found = []
    for spheres, response in zip(
        several, simulate_together([spheres.problem for spheres in several]), strict=True
    ):
        if isinstance(response, Exception):
            raise response
        found += _forces_in(response, len(spheres.radius))
    return found


def _forces_in(response: Response, number_of_drops: int) -> list[ContactForce]:
    """Return the contact forces of the drops of a response."""
    nodes, weights = _NODES
    found = []
    for number in range(number_of_drops):
        one = response.drop(number)
        duration, peak = (float(one.impacts[name][0]) for name in ("duration_s", "max_force_N"))
        time = 0.5 * duration * (1.0 + nodes)
        value = one.at(time, ["force_N"])["force_N"]
        if (value[:-1] == 0.0)[: np.flatnonzero(value)[-1]].any():
            duration, peak = _first_touch(one, duration)
            time = 0.5 * duration * (1.0 + nodes)
            value = one.at(time, ["force_N"])["force_N"]
        impulse = 0.5 * duration * weights * value
        found.append(ContactForce(time, impulse, value, np.array([peak, impulse.sum(), duration])))
    return found


def _first_touch(response: Response, duration: float) -> tuple[float, float]:
    """Return the duration [s] and the largest force [N] of the first touch of an impact
    that has several.
    """
    begin, end = 0.0, duration
    for _ in range(_REFINEMENTS):  # between the last instant with a force and the first without one
        time = np.linspace(begin, end, _INSTANTS)
        without = 1 + int(np.argmax(response.at(time[1:], ["force_N"])["force_N"] == 0.0))
        begin, end = time[without - 1], time[without]
    return float(begin), float(
        response.at(np.linspace(0.0, begin, _INSTANTS), ["force_N"])["force_N"].max()
    )
