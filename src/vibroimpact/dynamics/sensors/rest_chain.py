r"""A measuring chain while a sphere lies on the plate, in closed form: both move as one linear system about their equilibrium.

With the coupled oscillators c of sphere and plate, of shapes S (rows: the sphere times the root of its mass, then the modes of the plate),
the plate's modes move by :math:`q = q_0 + S c`, and the contact force is what the motion of the sphere takes,

.. math:: F = m g - m \ddot s = m g - \sqrt m \sum_j S_{0j}\,\ddot c_j .

So the motion of a point, and all that a chain makes of it, is a transfer function seen at the poles of the coupled oscillators
(`pole_pairs`), and a constant. What the pairs of poles of the chain still do of all before is a free motion of their own: as of each point
another, they are taken once for each output.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import reduce

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import Section
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain, of_section, point_at
from vibroimpact.dynamics.sensors.pole_pairs import PolePairs
from vibroimpact.dynamics.sensors.pulses import gauss_rule
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion

_FAST = 16.0
"""Times what a linear system answers to: what swings faster acts on it as one impulse, to the square of one over it."""
_TURN = 10.0
"""Radians, or time constants, in a panel of Gauss's rule."""


@dataclass(frozen=True)
class RestChain:
    """Oscillators that move freely from a place on, and what they are worth in the outputs.

    `of`: the coupled oscillators, then the pairs of poles of the chain for each output. `outputs`: (2, S, n). `place`: displacements and
    velocities as the sphere is laid down, (2, n). `constant`: what the weight adds to each output (S,).
    """

    of: Oscillators
    outputs: Floats
    place: Floats
    constant: Floats


def rest_chain(chain: MeasuringChain, rest: RestMotion, own: Floats) -> RestChain:
    """Return a measuring chain as free oscillators, as it is while a sphere lies on the plate.

    Parameters
    ----------
    chain : MeasuringChain
        From the contact force to the outputs.
    lying : Lying
        How sphere and plate move.
    own : array, shape (2, pairs of poles)
        Where the pairs of poles of the chain itself are as that begins.
    """
    equilibrium, coupled = rest.equilibrium, rest.coupled
    at, shapes, ground = PolePairs(coupled.angular_frequency**2, coupled.damping), equilibrium.modes[1], equilibrium.system.ground
    force = -math.sqrt(equilibrium.system.mass[0]) * shapes[0] * at.power(2)
    moved = chain.shapes @ shapes[ground] * at.power(0)[:, None] - chain.compliance[:, None] * force[:, None]  # (2, S, coupled)
    static = chain.shapes @ equilibrium.state.displacement[ground] - chain.compliance * equilibrium.weight
    poles = chain.own
    sections = list(zip((poles.angular_frequency**2).tolist(), poles.damping.tolist(), strict=True))
    passed = at.low_pass(sections)
    outputs = [
        np.stack(
            [at.product(one, at.product(at.power(order), passed)) for one, order in zip(moved.swapaxes(0, 1), chain.orders, strict=True)], 1
        )
    ]
    places = [rest.start_coupled]
    for number, section in enumerate(sections):
        driven = at.product(moved, at.inverse(at.quadratic(*section))[:, None])
        now = np.stack([_value(driven, rest.start_coupled), _value(at.product(driven, at.power(1)[:, None]), rest.start_coupled)])
        now[0] += static / section[0]
        places.append(_of_points(chain, section, rest, own[:, [number]]) - now)
        outputs.append(of_section(number, sections, chain.orders) * np.eye(len(static)))
    constant = np.where(np.asarray(chain.orders) == 0, static, 0.0)
    of = reduce(_concatenate, [coupled, *(poles.pick(np.full(len(static), number)) for number in range(len(sections)))])
    return RestChain(of, np.concatenate(outputs, axis=-1), np.concatenate(places, axis=1), constant)


def _of_points(chain: MeasuringChain, section: Section, rest: RestMotion, own: Floats) -> Floats:
    """Return where a pair of poles driven by the motion of each point is, (2, S), from where it is under minus the force, (2, 1)."""
    plate, ground = chain.plate, rest.equilibrium.system.ground
    modes = np.stack([rest.start.displacement[ground], rest.start.velocity[ground]])
    found = []
    at_modes, at = PolePairs(plate.angular_frequency**2, plate.damping), PolePairs(np.array([section[0]]), np.array([section[1]]))
    by_modes, by_own = at_modes.inverse(at_modes.quadratic(*section)), point_at(section, plate, chain.shapes, chain.compliance)
    for order in (0, 1):
        of_modes = chain.shapes @ _terms(at_modes.product(by_modes, at_modes.power(order)), modes)
        found.append(of_modes + _value(at.product(by_own, at.power(order)[:, None]), own))
    return np.stack(found)


def _terms(element: Floats, place: Floats) -> Floats:
    """Return a q + b q' of each oscillator, (..., n)."""
    return np.asarray(element[0] * place[0] + element[1] * place[1])


def _value(element: Floats, place: Floats) -> Floats:
    """Return their sum, (...)."""
    return np.asarray(_terms(element, place).sum(axis=-1))


def rest_pulses(rest: RestMotion, fastest: float, length: float) -> tuple[Floats, Floats]:
    """Return times since the sphere was laid down [s] and impulses [N s] that act on a smooth linear system as the force does.

    Parameters
    ----------
    lying : Lying
        How sphere and plate move.
    fastest : float
        The highest angular frequency that the system answers to [rad/s].
    length : float
        Up to when it matters [s].
    """
    equilibrium, of, (place, speed) = rest.equilibrium, rest.coupled, rest.start_coupled
    share = -math.sqrt(equilibrium.system.mass[0]) * equilibrium.modes[1][0]  # of an acceleration in the force
    fast = (of.damping_ratio < 1.0) & (of.angular_frequency > _FAST * fastest)
    at_once = -float(share[fast] @ speed[fast])  # the whole impulse of a swing that dies, or averages, away
    slow, share = of.pick(~fast), share[~fast]
    times, weights = _graded_rule(length, fastest, slow)
    cosine, sine = slow.propagators(times)
    stiffness, displacement, velocity = slow.angular_frequency**2, place[~fast], speed[~fast]
    place = cosine * displacement + sine * velocity
    speed = -stiffness * sine * displacement + (cosine - slow.damping * sine) * velocity
    force = equilibrium.weight - (stiffness * place + slow.damping * speed) @ share
    return np.append(0.0, times), np.append(at_once, weights * force)


def _graded_rule(length: float, fastest: float, of: Oscillators) -> tuple[Floats, Floats]:
    """Return nodes [s] and weights [s] of Gauss's rule up to a time: panels for the waves, ever shorter towards 0 for what dies at once."""
    swinging = of.angular_frequency[of.damping_ratio < 1.0].max(initial=0.0)
    panel = length / math.ceil(max(1.0, (fastest + swinging) * length / _TURN))
    dying = float((2.0 * of.damping_ratio * of.angular_frequency).max(initial=0.0))
    halvings = math.ceil(math.log2(max(1.0, dying * panel / _TURN)))
    ends = np.concatenate([[0.0], panel * 0.5 ** np.arange(halvings, 0, -1), panel * np.arange(1, round(length / panel) + 1)])
    x, weights = gauss_rule(_TURN)
    spans = np.diff(ends)[:, None]
    return (ends[:-1, None] + spans * x).ravel(), (spans * weights).ravel()


def _concatenate(one: Oscillators, other: Oscillators) -> Oscillators:
    """Return oscillators side by side."""
    return Oscillators(*(np.concatenate(pair) for pair in zip(_fields(one), _fields(other), strict=True)))


def _fields(of: Oscillators) -> tuple[Floats, Floats, Floats]:
    return of.angular_frequency, of.damping_ratio, of.shape
