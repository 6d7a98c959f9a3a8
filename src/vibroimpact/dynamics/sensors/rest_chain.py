r"""A measuring chain while a sphere is at rest on the plate, in closed form: both move as one
linear system about their equilibrium.

With the coupled oscillators c of sphere and plate and their mode shapes S (rows: the sphere, scaled
by the root of its mass, then the modes of the plate), the modes of the plate move by :math:`q = q_0
+ S c`, and the contact force follows from the acceleration of the sphere,

.. math:: F = m g - m \ddot s = m g - \sqrt m \sum_j S_{0j}\,\ddot c_j .

On a plate that is shaken the steady motion of both joins, with an undamped oscillator for each
driven coordinate, whose shapes are transfer functions too. The motion of a point and the outputs of
a chain are therefore transfer functions at the poles of these oscillators (`pole_pairs`), plus a
constant. The pairs of poles of the instruments also perform a free motion of their own from their
previous state; as it differs from point to point, they are repeated for each output.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.measuring_chain import (
    MeasuringChain,
    at_port,
    point_receptance,
    section_outputs,
)
from vibroimpact.dynamics.sensors.pole_pairs import PolePairs, Section
from vibroimpact.dynamics.sensors.pulses import Pulses, gauss_rule
from vibroimpact.dynamics.vibrating.oscillators import Oscillators, joined
from vibroimpact.dynamics.vibrating.rest_motion import FreeOscillations, RestMotion

_FAST = 16.0
"""Oscillations faster than this multiple of the system's highest frequency act as one
impulse, with an error of one over its square.
"""
_TURN = 10.0
"""Radians, or time constants, per panel of Gauss's rule."""


@dataclass(frozen=True)
class RestChain:
    """Oscillators in free motion, and their weights in the outputs.

    `oscillators`: the coupled oscillators, then the pairs of poles of the instruments for each
    output. `outputs`: weights (2, S, n). `initial`: displacements and velocities when the sphere
    comes to rest, (2, n). `constant`: contribution of the weight to each output (S,).
    """

    oscillators: Oscillators
    outputs: Floats
    initial: Floats
    constant: Floats


def rest_chain(
    chain: MeasuringChain, port: int, rest: RestMotion, instrument_state: Floats
) -> RestChain:
    """Return a measuring chain as free oscillators, while a sphere is at rest on the plate.

    Parameters
    ----------
    chain : MeasuringChain
        From the contact force to the outputs.
    port : int
        Where the sphere rests.
    rest : RestMotion
        Motion of sphere and plate.
    instrument_state : array, shape (2, pairs of poles)
        State of the instruments' pairs of poles at the beginning.
    """
    equilibrium, motion = rest.equilibrium, rest.oscillations
    poles, ground, compliance = _poles(motion), equilibrium.system.ground, chain.compliance[port]
    # (2, S, oscillators)
    moved = (
        chain.shapes @ motion.shapes[:, ground]
        - compliance[:, None] * _force(rest, motion)[:, None]
    )
    static = chain.shapes @ equilibrium.state.displacement[ground] - compliance * equilibrium.weight
    here = chain.instrument_of(port)
    instrument = at_port(chain.instrument.pick(here), port)
    sections = list(
        zip((instrument.angular_frequency**2).tolist(), instrument.damping.tolist(), strict=True)
    )
    passed = poles.low_pass(sections)
    outputs = [
        np.stack(
            [
                poles.product(one, poles.product(poles.power(order), passed))
                for one, order in zip(moved.swapaxes(0, 1), chain.orders, strict=True)
            ],
            1,
        )
    ]
    places = [motion.start]
    for number, section in enumerate(sections):
        driven = poles.product(moved, poles.inverse(poles.quadratic(*section))[:, None])
        now = np.stack(
            [
                _value(driven, motion.start),
                _value(poles.product(driven, poles.power(1)[:, None]), motion.start),
            ]
        )
        now[0] += static / section[0]
        places.append(
            _driven_section_states(
                chain, port, section, rest, instrument_state[:, here][:, [number]]
            )
            - now
        )
        outputs.append(section_outputs(number, sections, chain.orders) * np.eye(len(static)))
    constant = np.where(np.asarray(chain.orders) == 0, static, 0.0)
    own = [instrument.pick(np.full(len(static), number)) for number in range(len(sections))]
    # what earlier contacts left in the instruments dies away
    for other in (one for one in range(len(chain.direct)) if one != port):
        there = chain.instrument_of(other)
        own.append(at_port(chain.instrument.pick(there), other))
        places.append(instrument_state[:, there])
        outputs.append(chain.outputs[:, :, chain.modes :][:, :, there])
    oscillators = joined([motion.oscillators, *own])
    return RestChain(
        oscillators, np.concatenate(outputs, axis=-1), np.concatenate(places, axis=1), constant
    )


def _poles(motion: FreeOscillations) -> PolePairs:
    return PolePairs(motion.oscillators.angular_frequency**2, motion.oscillators.damping)


def _force(rest: RestMotion, motion: FreeOscillations) -> Floats:
    """Return the elements of the deviation of the contact force from the weight [N], (2, n)."""
    poles = _poles(motion)
    return np.asarray(
        -math.sqrt(rest.equilibrium.system.mass[0])
        * poles.product(motion.shapes[:, 0], poles.power(2))
    )


def _driven_section_states(
    chain: MeasuringChain, port: int, section: Section, rest: RestMotion, instrument_state: Floats
) -> Floats:
    """Return the states of a pair of poles driven by the motion of each point, (2, S),
    from its state under minus the force, (2, 1).
    """
    plate, ground = at_port(chain.plate, port), rest.equilibrium.system.ground
    modes = np.stack([rest.start.displacement[ground], rest.start.velocity[ground]])
    found = []
    at_modes, poles = (
        PolePairs(plate.angular_frequency**2, plate.damping),
        PolePairs(np.array([section[0]]), np.array([section[1]])),
    )
    by_modes, by_own = (
        at_modes.inverse(at_modes.quadratic(*section)),
        point_receptance(section, plate, chain.shapes, chain.compliance[port]),
    )
    for order in (0, 1):
        of_modes = chain.shapes @ _terms(at_modes.product(by_modes, at_modes.power(order)), modes)
        found.append(
            of_modes + _value(poles.product(by_own, poles.power(order)[:, None]), instrument_state)
        )
    return np.stack(found)


def _terms(element: Floats, place: Floats) -> Floats:
    """Return a q + b q' of each oscillator, (..., n)."""
    return np.asarray(element[0] * place[0] + element[1] * place[1])


def _value(element: Floats, place: Floats) -> Floats:
    """Return the sums of a q + b q' over the oscillators, (...)."""
    return np.asarray(_terms(element, place).sum(axis=-1))


def rest_pulses(rest: RestMotion, fastest: float, length: float) -> Pulses:
    """Return times since rest began [s] and impulses [N s] that are equivalent to the contact force
    for a smooth linear system.

    Parameters
    ----------
    rest : RestMotion
        Motion of sphere and plate.
    fastest : float
        Highest angular frequency to which the system responds [rad/s].
    length : float
        Duration [s].
    """
    motion = rest.oscillations
    oscillators, poles, force = motion.oscillators, _poles(motion), _force(rest, motion)
    fast = (oscillators.damping_ratio < 1.0) & (oscillators.angular_frequency > _FAST * fastest)
    # total impulse of oscillations that decay or average out
    at_once = -_value(
        poles.product(force, poles.inverse(poles.power(1)))[:, fast], motion.start[:, fast]
    )
    slow = oscillators.pick(~fast)
    times, weights = _graded_rule(length, fastest, slow)
    later, (place, speed) = slow.transition(times), motion.start[:, ~fast]
    pushed = rest.equilibrium.weight + _value(
        force[:, None, ~fast], later[:, 0] * place + later[:, 1] * speed
    )
    return np.append(0.0, times), np.append(at_once, weights * pushed)


def _graded_rule(length: float, fastest: float, oscillators: Oscillators) -> tuple[Floats, Floats]:
    """Return nodes [s] and weights [s] of Gauss's rule up to a time, with panels for the
    oscillations, graded towards 0 for fast decays.
    """
    swinging = oscillators.angular_frequency[oscillators.damping_ratio < 1.0].max(initial=0.0)
    panel = length / math.ceil(max(1.0, (fastest + swinging) * length / _TURN))
    dying = float(
        (2.0 * oscillators.damping_ratio * oscillators.angular_frequency).max(initial=0.0)
    )
    halvings = math.ceil(math.log2(max(1.0, dying * panel / _TURN)))
    ends = np.concatenate(
        [
            [0.0],
            panel * 0.5 ** np.arange(halvings, 0, -1),
            panel * np.arange(1, round(length / panel) + 1),
        ]
    )
    x, weights = gauss_rule(_TURN)
    spans = np.diff(ends)[:, None]
    return (ends[:-1, None] + spans * x).ravel(), (spans * weights).ravel()
