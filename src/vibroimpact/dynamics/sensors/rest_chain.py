r"""A measuring chain while a sphere is at rest on the plate, in closed form.

Sphere and plate move as one linear system about their equilibrium. With their coupled oscillators c
and mode shapes S (rows: the sphere, scaled by the root of its mass, then the modes of the plate),
the modes of the plate move by :math:`q = q_0 + S c`, and the contact force follows from the
acceleration of the sphere,

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
from vibroimpact.dynamics.sensors.instruments.pole_pairs import PolePairs, Section
from vibroimpact.dynamics.sensors.measuring_chain import (
    MeasuringChain,
    at_port,
    point_receptance,
    section_outputs,
)
from vibroimpact.dynamics.sensors.pulses import Pulses, gauss_rule
from vibroimpact.dynamics.vibrating.oscillators import Oscillators, joined
from vibroimpact.dynamics.vibrating.rest_motion import FreeOscillations, RestMotion

_FAST = 16.0
"""Multiple of the system's highest frequency beyond which oscillations act as one impulse.

The error is one over its square.
"""
_RADIANS_PER_PANEL = 10.0
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
    equilibrium = rest.equilibrium
    motion = rest.oscillations
    poles = _poles(motion)
    ground = equilibrium.system.ground
    compliance = chain.compliance[port]
    # motion of each point as elements at the poles of the oscillators, (2, S, oscillators), and its
    # static deflection (S,); the modes left out follow the force
    point_motion = (
        chain.shapes @ motion.shapes[:, ground]
        - compliance[:, None] * _force(rest, motion)[:, None]
    )
    static = chain.shapes @ equilibrium.state.displacement[ground] - compliance * equilibrium.weight

    own_poles = chain.instrument_of(port)
    instrument = at_port(chain.instrument.pick(own_poles), port)
    sections = list(
        zip((instrument.angular_frequency**2).tolist(), instrument.damping.tolist(), strict=True)
    )
    passed = poles.low_pass(sections)
    outputs = [
        np.stack(
            [
                poles.product(point_motion[:, sensor], poles.product(poles.power(order), passed))
                for sensor, order in enumerate(chain.orders)
            ],
            1,
        )
    ]
    oscillators = [motion.oscillators]
    initial = [motion.start]
    # the instruments' own free motion: what their state differs from that of the driven motion
    for number, section in enumerate(sections):
        driven = poles.product(point_motion, poles.inverse(poles.quadratic(*section))[:, None])
        driven_rate = poles.product(driven, poles.power(1)[:, None])
        driven_state = np.stack([_value(driven, motion.start), _value(driven_rate, motion.start)])
        driven_state[0] += static / section[0]
        state = _driven_section_states(
            chain, port, section, rest, instrument_state[:, own_poles][:, [number]]
        )
        oscillators.append(instrument.pick(np.full(len(static), number)))
        initial.append(state - driven_state)
        outputs.append(section_outputs(number, sections, chain.orders) * np.eye(len(static)))
    # what earlier contacts at other ports left in the instruments dies away
    for other in range(len(chain.direct)):
        if other == port:
            continue
        other_poles = chain.instrument_of(other)
        oscillators.append(at_port(chain.instrument.pick(other_poles), other))
        initial.append(instrument_state[:, other_poles])
        outputs.append(chain.outputs[:, :, chain.modes :][:, :, other_poles])
    return RestChain(
        oscillators=joined(oscillators),
        outputs=np.concatenate(outputs, axis=-1),
        initial=np.concatenate(initial, axis=1),
        constant=np.where(np.asarray(chain.orders) == 0, static, 0.0),
    )


def _poles(motion: FreeOscillations) -> PolePairs:
    """Return the poles of the oscillators of a motion."""
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
    """Return the states of a pair of poles driven by the motion of each point, (2, S).

    `instrument_state`: its state under minus the force, (2, 1).
    """
    plate = at_port(chain.plate, port)
    ground = rest.equilibrium.system.ground
    plate_state = np.stack([rest.start.displacement[ground], rest.start.velocity[ground]])
    plate_poles = PolePairs(plate.angular_frequency**2, plate.damping)
    section_poles = PolePairs(np.array([section[0]]), np.array([section[1]]))
    # partial fractions of section and point: at the poles of the plate, and at those of the section
    at_plate = plate_poles.inverse(plate_poles.quadratic(*section))
    at_section = point_receptance(section, plate, chain.shapes, chain.compliance[port])
    states = []
    for order in (0, 1):
        by_modes = chain.shapes @ _terms(
            plate_poles.product(at_plate, plate_poles.power(order)), plate_state
        )
        by_section = _value(
            section_poles.product(at_section, section_poles.power(order)[:, None]), instrument_state
        )
        states.append(by_modes + by_section)
    return np.stack(states)


def _terms(element: Floats, state: Floats) -> Floats:
    """Return a q + b q' of each oscillator, (..., n)."""
    a, b = element
    displacement, velocity = state
    return np.asarray(a * displacement + b * velocity)


def _value(element: Floats, state: Floats) -> Floats:
    """Return the sums of a q + b q' over the oscillators, (...)."""
    return np.asarray(_terms(element, state).sum(axis=-1))


def rest_pulses(rest: RestMotion, fastest: float, length: float) -> Pulses:
    """Return times since rest began [s] and impulses [N s] equivalent to the contact force.

    They are so for a smooth linear system.

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
    oscillators = motion.oscillators
    poles = _poles(motion)
    force = _force(rest, motion)
    fast = (oscillators.damping_ratio < 1.0) & (oscillators.angular_frequency > _FAST * fastest)
    # total impulse of oscillations that decay or average out: the integral of their force, by the
    # inverse of the derivative
    integrated = poles.product(force, poles.inverse(poles.power(1)))
    fast_impulse = -_value(integrated[:, fast], motion.start[:, fast])
    slow = oscillators.pick(~fast)
    times, weights = _graded_rule(length, fastest, slow)
    transition = slow.transition(times)
    displacement, velocity = motion.start[:, ~fast]
    slow_state = transition[:, 0] * displacement + transition[:, 1] * velocity
    slow_force = rest.equilibrium.weight + _value(force[:, None, ~fast], slow_state)
    return np.append(0.0, times), np.append(fast_impulse, weights * slow_force)


def _graded_rule(length: float, fastest: float, oscillators: Oscillators) -> tuple[Floats, Floats]:
    """Return nodes and weights of Gauss's rule up to a time [s].

    It has panels for the oscillations, graded towards 0 for fast decays.
    """
    highest = oscillators.angular_frequency[oscillators.damping_ratio < 1.0].max(initial=0.0)
    radians = (fastest + highest) * length
    panel = length / math.ceil(max(1.0, radians / _RADIANS_PER_PANEL))
    fastest_decay = float(
        (2.0 * oscillators.damping_ratio * oscillators.angular_frequency).max(initial=0.0)
    )
    halvings = math.ceil(math.log2(max(1.0, fastest_decay * panel / _RADIANS_PER_PANEL)))
    ends = np.concatenate(
        [
            [0.0],
            panel * 0.5 ** np.arange(halvings, 0, -1),
            panel * np.arange(1, round(length / panel) + 1),
        ]
    )
    x, weights = gauss_rule(_RADIANS_PER_PANEL)
    spans = np.diff(ends)[:, None]
    return (ends[:-1, None] + spans * x).ravel(), (spans * weights).ravel()
