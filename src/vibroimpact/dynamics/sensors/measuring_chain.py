r"""From the contact force to what a sensor puts out: the plate, a mounted resonance and an analogue filter as one linear system.

The plate hangs still until it is hit, so that all that a sensor sees is the answer to the contact force. The displacement of a point is

.. math:: u(t) = \sum_i \varphi_i\,q_i(t) - C\,F(t)

with C the static compliance between the contact and that point which the modes kept do not carry: those left out are quasi-static. Of
that a derivative is taken, and a resonance or a filter of pairs of poles follows. The whole is a sum over oscillators, those of the plate
and one for each of these pairs, all driven by the same force (partial fractions), and of what goes with the force itself and its
derivatives.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import Section
from vibroimpact.dynamics.sensors.pole_pairs import PolePairs
from vibroimpact.dynamics.vibrating.oscillators import Oscillators

_APART = 1e-6
"""Relative distance that is kept between poles: of equal ones no partial fractions exist."""


@dataclass(frozen=True)
class MeasuringChain:
    r"""A linear system from the contact force to S outputs.

    Parameters
    ----------
    of : Oscillators
        The modes of the plate, then the pairs of poles of what follows, driven by the force with shape 1.
    modes : int
        How many of them are the plate's.
    outputs : array, shape (2, S, n)
        What the displacement and the velocity of each are worth in each output.
    direct : array, shape (S, 3)
        What minus the force, and its first and second derivative, are worth besides.
    shapes, compliance, orders
        Of what it was made, as `measuring_chain` takes them.
    """

    of: Oscillators
    modes: int
    outputs: Floats
    direct: Floats
    shapes: Floats
    compliance: Floats
    orders: tuple[int, ...]

    @property
    def pairs(self) -> PolePairs:
        """The poles of all oscillators."""
        return PolePairs(self.of.angular_frequency**2, self.of.damping)

    @property
    def plate(self) -> Oscillators:
        """The modes of the plate."""
        return self.of.pick(np.arange(self.modes))

    @property
    def own(self) -> Oscillators:
        """The pairs of poles of what follows."""
        return self.of.pick(np.arange(self.modes, len(self.of.shape)))


def measuring_chain(
    plate: Oscillators, shapes: Floats, compliance: Floats, orders: Sequence[int], sections: Sequence[Section]
) -> MeasuringChain:
    """Return the chain of sensors that have the same resonance and filter.

    Parameters
    ----------
    plate : Oscillators
        The modes of the plate.
    shapes : array, shape (S, modes)
        How the points watched move in them [kg^-1/2].
    compliance : array, shape (S,)
        Between the contact and these points, of the modes left out [m/N].
    orders : sequence of int
        Which derivative of the displacement each sensor takes.
    sections : sequence of pairs of floats
        The poles of what follows, each pair with a gain of one at frequency zero.
    """
    sections = _apart(sections, plate)
    at_modes = PolePairs(plate.angular_frequency**2, plate.damping)
    passed = at_modes.low_pass(sections)
    outputs = np.stack([shape * at_modes.product(at_modes.power(order), passed) for shape, order in zip(shapes, orders, strict=True)])
    direct = np.zeros((len(shapes), 3))
    if not sections:
        direct[np.arange(len(shapes)), orders] = compliance
        direct[:, 0] += np.where(np.asarray(orders) == 2, shapes @ plate.shape, 0.0)
    elif len(sections) == 1:
        direct[:, 0] = np.where(np.asarray(orders) == 2, sections[0][0] * compliance, 0.0)
    own = [_of_section(number, sections, plate, shapes, compliance, orders) for number in range(len(sections))]
    return MeasuringChain(
        _with_sections(plate, sections),
        len(plate.shape),
        np.concatenate([outputs, *own], axis=-1).transpose(1, 0, 2),
        direct,
        shapes,
        compliance,
        tuple(orders),
    )


def of_section(number: int, sections: Sequence[Section], orders: Sequence[int]) -> Floats:
    """Return what one pair of poles, driven by the motion of a point, is worth in the outputs, at these poles, (2, S, 1)."""
    stiffness, damping = sections[number]
    at = PolePairs(np.array([stiffness]), np.array([damping]))
    passed = stiffness * at.low_pass([*sections[:number], *sections[number + 1 :]])
    return np.stack([at.product(at.power(order), passed) for order in orders], axis=1)


def point_at(section: Section, plate: Oscillators, shapes: Floats, compliance: Floats) -> Floats:
    """Return how points move under minus a force, beside what the modes do, at the poles of a section, (2, S, 1)."""
    stiffness, damping = section
    receptance = np.stack([plate.angular_frequency**2 - stiffness, plate.damping - damping])
    receptance = PolePairs(np.full_like(plate.shape, stiffness), np.full_like(plate.shape, damping)).inverse(receptance) * plate.shape
    seen = receptance @ shapes.T  # (2, S)
    seen[0] += compliance
    return np.asarray(seen[..., None])


def _of_section(
    number: int, sections: Sequence[Section], plate: Oscillators, shapes: Floats, compliance: Floats, orders: Sequence[int]
) -> Floats:
    """Return what the motion of one pair of poles is worth in each output, (S, 2, 1)."""
    stiffness, damping = sections[number]
    at = PolePairs(np.array([stiffness]), np.array([damping]))
    seen = at.product(of_section(number, sections, orders), point_at(sections[number], plate, shapes, compliance))
    return seen.transpose(1, 0, 2)


def _apart(sections: Sequence[Section], plate: Oscillators) -> list[Section]:
    """Return pairs of poles that lie a little apart from those of the plate and from each other."""
    found: list[Section] = []
    for stiffness, damping in sections:
        while True:
            others = PolePairs(
                np.append(plate.angular_frequency**2, [one for one, _ in found]), np.append(plate.damping, [one for _, one in found])
            )
            near, slope = np.abs(others.quadratic(stiffness, damping)) < _APART * np.array([[stiffness], [math.sqrt(stiffness)]])
            if not (near & slope).any():
                break
            stiffness *= 1.0 + 3.0 * _APART
        found.append((stiffness, damping))
    return found


def _with_sections(plate: Oscillators, sections: Sequence[Section]) -> Oscillators:
    """Return the oscillators of the plate and those of pairs of poles."""
    if not sections:
        return plate
    omega = np.sqrt([stiffness for stiffness, _ in sections])
    ratio = np.array([damping for _, damping in sections]) / (2.0 * omega)
    return Oscillators(
        np.append(plate.angular_frequency, omega), np.append(plate.damping_ratio, ratio), np.append(plate.shape, np.ones(len(sections)))
    )
