r"""The chain from the contact force to the output of a sensor, as one linear system.

It consists of the plate, a mounted resonance and an analogue filter. The plate is at rest before
the first contact, so every sensor records the response to the contact force. The displacement of a
point is

.. math:: u(t) = \sum_i \varphi_i\,q_i(t) - C\,F(t)

with the static compliance C between the contact and that point of the modes that are not kept:
these respond quasi-statically. A derivative of it is taken, and a resonance or a filter of pairs of
poles follows. By partial fractions the chain is a sum over oscillators, those of the plate and one
for each of these pairs, all driven by the contact force, plus terms in the force and its
derivatives.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.instruments.pole_pairs import PolePairs, Section
from vibroimpact.dynamics.vibrating.oscillators import Oscillators

_POLE_DISTANCE = 1e-6
"""Least relative distance between poles: of equal ones no partial fractions exist."""


@dataclass(frozen=True)
class MeasuringChain:
    """A linear system from the contact forces at P ports to S outputs.

    Parameters
    ----------
    oscillators : Oscillators
        The modes of the plate, then the pairs of poles of the instruments for each port, which its
        force alone drives, with shape 1; the shapes have a row a port.
    modes : int
        Number of modes of the plate among them.
    outputs : array, shape (2, S, n)
        Weights of the displacement and the velocity of each in each output.
    direct : array, shape (P, S, 3)
        Weights of minus the force at each port, and of its first and second derivative.
    shapes, compliance, orders
        Arguments of `measuring_chain`.
    """

    oscillators: Oscillators
    modes: int
    outputs: Floats
    direct: Floats
    shapes: Floats
    compliance: Floats
    orders: tuple[int, ...]

    @property
    def pairs(self) -> PolePairs:
        """The poles of all oscillators."""
        return PolePairs(self.oscillators.angular_frequency**2, self.oscillators.damping)

    @property
    def plate(self) -> Oscillators:
        """The modes of the plate."""
        return self.oscillators.pick(np.arange(self.modes))

    @property
    def instrument(self) -> Oscillators:
        """The pairs of poles of the instruments."""
        return self.oscillators.pick(np.arange(self.modes, self.oscillators.number))

    def instrument_of(self, port: int) -> slice:
        """Return the slice of a port's pairs of poles among those of the instruments."""
        number = (self.oscillators.number - self.modes) // len(self.direct)
        return slice(number * port, number * (port + 1))


def measuring_chain(
    plate: Oscillators,
    shapes: Floats,
    compliance: Floats,
    orders: Sequence[int],
    sections: Sequence[Section],
) -> MeasuringChain:
    """Return the chain of sensors with the same resonance and filter.

    Parameters
    ----------
    plate : Oscillators
        The modes of the plate, with a row of shapes a port.
    shapes : array, shape (S, modes)
        Mode shapes at the points of the sensors [kg^-1/2].
    compliance : array, shape (P, S)
        Compliance between each port and these points of the modes left out [m/N].
    orders : sequence of int
        Order of the derivative of the displacement that each sensor takes.
    sections : sequence of pairs of floats
        The poles of the instruments, each pair with a gain of one at frequency zero.
    """
    sections = _separate_poles(sections, plate)
    plate_poles = PolePairs(plate.angular_frequency**2, plate.damping)
    passed = plate_poles.low_pass(sections)
    plate_outputs = np.stack(
        [
            shape * plate_poles.product(plate_poles.power(order), passed)
            for shape, order in zip(shapes, orders, strict=True)
        ]
    )
    outputs_of_sections = [
        _section_weights(number, sections, plate, shapes, compliance, orders)
        for number in range(len(sections))
    ]
    instrument_outputs = np.concatenate(
        [np.zeros((2, len(compliance), len(shapes), 0)), *outputs_of_sections], axis=-1
    )
    # the poles of a port are neighbours
    instrument_outputs = instrument_outputs.swapaxes(1, 2).reshape(2, len(shapes), -1)
    direct = compliance[..., None] * np.array([_whole_part(order, sections) for order in orders])
    if not sections:
        # the acceleration of a mode follows the force at once
        direct[:, :, 0] += np.where(
            np.asarray(orders) == 2, [shapes @ shape for shape in plate.shape], 0.0
        )
    return MeasuringChain(
        oscillators=_with_sections(plate, sections),
        modes=plate.number,
        outputs=np.concatenate([plate_outputs.swapaxes(0, 1), instrument_outputs], axis=-1),
        direct=direct,
        shapes=shapes,
        compliance=compliance,
        orders=tuple(orders),
    )


def _whole_part(order: int, sections: Sequence[Section]) -> Floats:
    """Return the polynomial in s of a derivative behind pairs of poles, (3,).

    It is what the derivative has beside partial fractions, lowest power first.
    """
    polynomial = math.prod(stiffness for stiffness, _ in sections) * np.eye(order + 1)[0]
    for stiffness, damping in sections:
        polynomial, _ = np.polydiv(polynomial, [1.0, damping, stiffness])
    return np.asarray(np.pad(polynomial[::-1], (0, 3 - len(polynomial))))


def at_port(plate: Oscillators, port: int) -> Oscillators:
    """Return the modes of the plate with the shapes at one port."""
    return Oscillators(plate.angular_frequency, plate.damping_ratio, plate.shape[port])


def section_outputs(number: int, sections: Sequence[Section], orders: Sequence[int]) -> Floats:
    """Return the outputs of one pair of poles driven by the motion of a point, (2, S, 1).

    They are elements at these poles.
    """
    stiffness, damping = sections[number]
    poles = PolePairs(np.array([stiffness]), np.array([damping]))
    passed = stiffness * poles.low_pass([*sections[:number], *sections[number + 1 :]])
    return np.stack([poles.product(poles.power(order), passed) for order in orders], axis=1)


def point_receptance(
    section: Section, plate: Oscillators, shapes: Floats, compliance: Floats
) -> Floats:
    """Return the receptance of points to minus the force at the poles of a section, (2, S, 1).

    It is (2, P, S, 1) of shapes with P rows. `compliance` is that of the modes left out, (S,) or
    (P, S).
    """
    stiffness, damping = section
    section_poles = PolePairs(np.full(plate.number, stiffness), np.full(plate.number, damping))
    dynamic_stiffness = np.stack([plate.angular_frequency**2 - stiffness, plate.damping - damping])
    of_modes = section_poles.inverse(dynamic_stiffness)
    receptance = np.stack([(element * plate.shape) @ shapes.T for element in of_modes])
    receptance[0] += compliance
    return np.asarray(receptance[..., None])


def _section_weights(
    number: int,
    sections: Sequence[Section],
    plate: Oscillators,
    shapes: Floats,
    compliance: Floats,
    orders: Sequence[int],
) -> Floats:
    """Return the weights in each output of one pair of poles driven at each port, (2, P, S, 1)."""
    stiffness, damping = sections[number]
    poles = PolePairs(np.array([stiffness]), np.array([damping]))
    return poles.product(
        section_outputs(number, sections, orders),
        point_receptance(sections[number], plate, shapes, compliance),
    )


def _separate_poles(sections: Sequence[Section], plate: Oscillators) -> list[Section]:
    """Return pairs of poles that coincide neither with those of the plate nor with each other.

    They are shifted slightly where they do.
    """
    separate: list[Section] = []
    for stiffness, damping in sections:
        others = PolePairs(
            np.append(plate.angular_frequency**2, [section[0] for section in separate]),
            np.append(plate.damping, [section[1] for section in separate]),
        )
        while True:
            scale = np.array([[stiffness], [math.sqrt(stiffness)]])
            near = np.abs(others.quadratic(stiffness, damping)) < _POLE_DISTANCE * scale
            if not near.all(axis=0).any():
                break
            stiffness *= 1.0 + 3.0 * _POLE_DISTANCE
        separate.append((stiffness, damping))
    return separate


def _with_sections(plate: Oscillators, sections: Sequence[Section]) -> Oscillators:
    """Return the oscillators of the plate and those of pairs of poles."""
    if not sections:
        return plate
    omega = np.sqrt([stiffness for stiffness, _ in sections])
    ratio = np.array([damping for _, damping in sections]) / (2.0 * omega)
    ports = len(plate.shape)
    driven_shapes = np.repeat(np.eye(ports), len(sections), axis=1)
    return Oscillators(
        np.append(plate.angular_frequency, np.tile(omega, ports)),
        np.append(plate.damping_ratio, np.tile(ratio, ports)),
        np.concatenate([plate.shape, driven_shapes], axis=1),
    )


def next_octave(plate: Oscillators, shapes: Floats) -> tuple[Oscillators, Floats]:
    """Return a model of the modes left out of the next octave, and their shapes at S points.

    `shapes`: those of the modes kept, (S, modes). The next octave is modelled on the last one kept,
    at twice the frequencies; twice as many are assumed, as for the bending of a plate.
    """
    last_octave = np.flatnonzero(plate.angular_frequency > 0.5 * plate.angular_frequency.max())
    modes = plate.pick(last_octave)
    return (
        replace(modes, angular_frequency=2.0 * modes.angular_frequency),
        2.0 * shapes[:, last_octave],
    )
