r"""One impact in steps that are too long: what the implicit Euler method gives where it does not resolve the contact.

A demonstration of what an unresolved run gives, and no way to compute an impact. With the oscillators behind the contact as in
`dynamics.system`, a step h gives, all primed at its end,

.. math:: v' = v + h (g - F'/m),\qquad s' = s + h v'

.. math:: \dot q_i' = \frac{\dot q_i - h \omega_i^2 q_i - h \chi_i F'}{1 + 2 \zeta_i \omega_i h + \omega_i^2 h^2},\qquad
          q_i' = q_i + h \dot q_i'

so that each newton takes a known amount off the indentation, and one equation for the force F' is left. The method is stable with any
step because it loses energy: in each step, what the changes of the velocities and of the springs' lengths would hold by themselves.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.single_impacts import first_approach_speed
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.roots import find_root
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.vibrating.bodies import centre_of, slices_of, system_of
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.errors import ComputationError, InputError

PEAKS = (
    "max_force_N",
    "sphere_strain_J",
    "plate_kinetic_J",
    "plate_strain_J",
    "plate_displacement_m",
    "plate_velocity_m_s",
    "plate_acceleration_m_s2",
    "beyond_touch_m",
)
"""What is found at its largest: magnitudes, three of the plate's centre of mass; and how far the sphere's centre falls after touch."""

SPENT = ("kinetic_J", "potential_J", "vibration_J", "contact_dissipated_J", "modal_damping_J", "integrator_J")
"""Where the energy of the touch is at separation: in the sphere's motion and height, in all modes; lost in damping and by the method."""

_MOST_STEPS = 20_000


def unresolved_impact(problem: Problem, step: float, phases: Floats) -> dict[str, Floats]:
    """Return what the first impact of a drop comes to in steps of one length, for several places of the touch in a step.

    The force is clipped at zero, as Adams does it. The run goes on to separation, and where the plate vibrates for at least half
    a period of its lowest mode.

    Parameters
    ----------
    problem : Problem
        One drop of the superposed model: all modes in series with the whole of the law.
    step : float
        Length of a step [s], > 0.
    phases : array, shape (P,)
        What part of the step in which the surfaces meet is left after that, above 0 up to 1.

    Returns
    -------
    dict of str to array
        The `PEAKS`; separation_speed_m_s and rebound_height_m; and the shares of energy named by `SPENT`. Each (P,).

    Raises
    ------
    InputError
        If the problem is of another model.
    ComputationError
        If the sphere does not leave the plate within 20,000 steps.
    """
    (way, plate), (_, on_sphere, on_plate) = (_method(problem, step), problem.plate.modes), slices_of(problem)
    whole = plate.participation[:, 2] / plate.mass if plate is not None else np.zeros(0)
    followed = np.pi / float(plate.angular_frequencies.min()) if plate is not None else 0.0
    state, lost = way.start(phases), np.zeros((3, len(phases)))
    peaks = {name: np.zeros(len(phases)) for name in PEAKS}
    parted = {name: np.full(len(phases), np.nan) for name in ("separation_speed_m_s", *SPENT)}
    apart = np.zeros(len(phases), dtype=bool)
    for number in range(1, _MOST_STEPS + 1):
        before, (state, force) = state, way.advance(state)
        lost = lost + way.lost(before, state, force)
        kinetic, strain = way.of.energies(state)
        of_bodies = (strain[:, on_sphere].sum(axis=1), kinetic[:, on_plate].sum(axis=1), strain[:, on_plate].sum(axis=1))
        acceleration = (state.velocity - before.velocity) / step
        depth, sinking = centre_of(state, way.mass)
        of_centre = (part[:, on_plate] @ whole for part in (state.displacement, state.velocity, acceleration))
        for name, value in zip(PEAKS, (force, *of_bodies, *of_centre, np.maximum(depth, 0.0)), strict=True):
            peaks[name] = np.maximum(peaks[name], np.abs(value))
        leaves = (way.approach(state) < 0.0) & (sinking < 0.0)
        of_sphere = 0.5 * way.mass * sinking**2, -way.mass * way.gravity * depth
        now = (-sinking, *of_sphere, (kinetic + strain)[:, 1:].sum(axis=1), *lost)
        for name, value in zip(parted, now, strict=True):
            parted[name] = np.where(leaves & ~apart, value, parted[name])
        apart = leaves
        if apart.all() and number * step >= followed:
            return {**peaks, **parted, "rebound_height_m": way.top(problem, parted["separation_speed_m_s"])}
    raise ComputationError(f"the sphere does not leave the plate within {_MOST_STEPS} steps of {step:g} s")


@dataclass(frozen=True)
class _Method:
    """The implicit Euler method for one impact: what stays the same from step to step, in SI."""

    of: LinearSystem
    law: CompliantLaw
    mass: float
    gravity: float
    touch_speed: float
    step: float

    @cached_property
    def slowed(self) -> Floats:
        """What a step leaves of the velocity of each oscillator."""
        return np.asarray(1.0 / (1.0 + self.step * self.of.damping + (self.step * self.of.angular_frequency) ** 2))

    @cached_property
    def pliancy(self) -> float:
        """By how much a newton opens the contact within a step [m/N]."""
        return float(self.step**2 * (self.of.shape**2 * self.slowed).sum())

    def start(self, phases: Floats) -> State:
        """Return the states before the step in which the surfaces meet: in flight, nothing vibrates."""
        before = (1.0 - phases) * self.step
        approach, speed = -before * (self.touch_speed - 0.5 * self.gravity * before), self.touch_speed - self.gravity * before
        displacement, velocity = (np.zeros((len(phases), self.of.number)) for _ in range(2))
        displacement[:, 0], velocity[:, 0] = self.mass**0.5 * approach, self.mass**0.5 * speed
        return State(displacement, velocity, np.zeros((len(phases), 0)))

    def approach(self, state: State) -> Floats:
        """Return the indentation [m]."""
        return self.of.approach(state)[:, 0]

    def advance(self, state: State) -> tuple[State, Floats]:
        """Return the states after a step, and the forces then."""
        of, step = self.of, self.step
        velocity = self.slowed * (state.velocity + step * (of.load - of.angular_frequency**2 * state.displacement))
        force = self._force(self.approach(self._moved(state, velocity)), self.approach(state))
        return self._moved(state, velocity - step * force[:, None] * (self.slowed * of.shape)), force

    def _moved(self, state: State, velocity: Floats) -> State:
        """Return where a step with these velocities leads."""
        return State(state.displacement + self.step * velocity, velocity, state.local)

    def _force(self, reach: Floats, start: Floats) -> Floats:
        """Return the forces at the end of a step, from the indentations that it would reach without them and those at its start."""

        def excess(force: Floats) -> Floats:
            end = reach - self.pliancy * force
            static, dissipative = self.law.forces(np.maximum(end, 0.0), (end - start) / self.step, self.touch_speed)
            return np.asarray(force - np.where(end > 0.0, np.maximum(static + dissipative, 0.0), 0.0))

        meets = reach > 0.0
        if not meets.any():
            return np.zeros_like(reach)
        return np.where(meets, find_root(excess, np.zeros_like(reach), np.where(meets, reach / self.pliancy, 1.0)), 0.0)

    def lost(self, before: State, after: State, force: Floats) -> Floats:
        """Return what a step loses in the damping of the contact, in that of the modes, and by the method [J] (3, P)."""
        of, law = self.of, self.law
        start, end = self.approach(before), self.approach(after)
        further, (deep, deeper) = end - start, (np.maximum(start, 0.0), np.maximum(end, 0.0))
        static, _ = law.forces(deeper, further / self.step, self.touch_speed)
        in_motion = 0.5 * ((after.velocity - before.velocity) ** 2).sum(axis=1)
        in_springs = 0.5 * ((of.angular_frequency * (after.displacement - before.displacement)) ** 2).sum(axis=1)
        in_contact = static * further - (law.elastic_energy(deeper) - law.elastic_energy(deep))
        of_modes = self.step * (of.damping * after.velocity**2).sum(axis=1)
        return np.array([(force - static) * further, of_modes, in_motion + in_springs + in_contact])

    def top(self, problem: Problem, speed: Floats) -> Floats:
        """Return how high the centre rises from separation [m]."""
        with np.errstate(divide="ignore"):
            return np.asarray(problem.sphere.contact_offset + speed**2 / (2.0 * self.gravity))


def _method(problem: Problem, step: float) -> _Method:
    """Return the method for a problem, if it is of the kind that the method is written for."""
    law = problem.law_of(0)
    more = problem.local_element or problem.quasi_static or (problem.sphere_inside and problem.sphere.modes is not None)
    if problem.shape != () or more or not isinstance(law, CompliantLaw) or law.memories():
        raise InputError("the implicit Euler method is for one drop of the superposed model, under a law with a force and no memory")
    mass, gravity = float(problem.sphere.mass), float(problem.gravity)
    return _Method(system_of(problem, mass, gravity), law, mass, gravity, first_approach_speed(problem), step)
