r"""The implicit Euler method for one impact, with steps that do not resolve the contact.

A demonstration of numerical dissipation, not a method to compute impacts. For the modal oscillators
of `LinearSystem`, a step h gives, with primes for values at its end,

.. math:: v' = v + h (g - F'/m),\qquad s' = s + h v'

.. math::

    \dot q_i' = \frac{\dot q_i - h \omega_i^2 q_i - h \chi_i F'}{1 + 2 \zeta_i \omega_i h +
    \omega_i^2 h^2},\qquad
          q_i' = q_i + h \dot q_i'

so that the indentation at the end of the step is linear in the force, and one scalar equation for
F' remains. The method is stable for any step because it dissipates energy: in each step the kinetic
energy of the changes of the velocities, and the strain energy of the changes of the elongations.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.single_impacts import first_approach_speed
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.roots import find_root
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import centre_of, slices_of, system_of
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
"""Quantities recorded at their largest magnitude: plate motions of its centre of mass,
`beyond_touch_m` the sphere's fall after touch.
"""

ENERGY_SHARES = (
    "kinetic_J",
    "potential_J",
    "vibration_J",
    "contact_dissipated_J",
    "modal_damping_J",
    "integrator_J",
)
"""Shares of the energy at separation: motion and height of the sphere, vibration of all
modes, losses by damping and by the method.
"""

_MAX_STEPS = 20_000


def unresolved_impact(problem: Problem, step: float, phases: Floats) -> dict[str, Floats]:
    """Return the first impact of a drop by the implicit Euler method with a fixed step, for several
    phases of the touch in a step.

    The force is clipped at zero, as in Adams. The run ends at separation; with an elastic plate,
    not before half a period of its lowest mode.

    Parameters
    ----------
    problem : Problem
        One drop of the superposed model: all modes in series with the full contact law.
    step : float
        Step length [s], > 0.
    phases : array, shape (P,)
        Fraction of the step in which the surfaces meet that remains after the touch, in (0, 1].

    Returns
    -------
    dict of str to array
        The `PEAKS`, separation_speed_m_s and rebound_height_m, and the `ENERGY_SHARES`; each of
        shape (P,).

    Raises
    ------
    InputError
        If the problem is not of the superposed model.
    ComputationError
        If the sphere does not leave the plate within 20,000 steps.
    """
    method = _implicit_euler(problem, step)
    least_duration = _half_period(problem)
    # all phases advance in one batch
    state = method.start(phases)
    losses = np.zeros((3, len(phases)))
    peaks = {name: np.zeros(len(phases)) for name in PEAKS}
    at_separation = {
        name: np.full(len(phases), np.nan) for name in ("separation_speed_m_s", *ENERGY_SHARES)
    }
    separated = np.zeros(len(phases), dtype=bool)
    for number in range(1, _MAX_STEPS + 1):
        previous = state
        state, force = method.advance(previous)
        losses = losses + method.losses(previous, state, force)
        for name, value in _peak_quantities(problem, method, previous, state, force).items():
            peaks[name] = np.maximum(peaks[name], np.abs(value))
        _, sinking_speed = centre_of(state, method.mass)
        receding = (method.approach(state) < 0.0) & (sinking_speed < 0.0)
        for name, value in _separation_quantities(method, state, losses).items():
            at_separation[name] = np.where(receding & ~separated, value, at_separation[name])
        separated = receding  # a sphere that comes back is recorded anew at its next separation
        if separated.all() and number * step >= least_duration:
            rebound_height = method.rebound_height(problem, at_separation["separation_speed_m_s"])
            return {**peaks, **at_separation, "rebound_height_m": rebound_height}
    raise ComputationError(
        f"within {_MAX_STEPS} steps of {step:g} s the sphere does not leave the plate, or "
        "half a period of its lowest mode does not pass; take a longer step"
    )


def _half_period(problem: Problem) -> float:
    """Return half a period of the lowest mode of the plate [s]; 0 for a rigid one."""
    plate = problem.plate.modes
    if plate is None:
        return 0.0
    return np.pi / float(plate.angular_frequencies.min())


def _peak_quantities(
    problem: Problem, method: _ImplicitEuler, previous: State, state: State, force: Floats
) -> dict[str, Floats]:
    """Return the current values of the `PEAKS`, each of shape (P,)."""
    # the slices pick the modes of each body among the oscillators
    _, on_sphere, on_plate = slices_of(problem)
    plate = problem.plate.modes
    centre_weights = np.zeros(0)
    if plate is not None:
        # the momentum of each mode along z, over the mass: its part in the motion of the centre
        centre_weights = plate.participation[:, 2] / plate.mass
    acceleration = (state.velocity - previous.velocity) / method.step
    kinetic, strain = method.system.energies(state)
    fall, _ = centre_of(state, method.mass)
    return {
        "max_force_N": force,
        "sphere_strain_J": strain[:, on_sphere].sum(axis=1),
        "plate_kinetic_J": kinetic[:, on_plate].sum(axis=1),
        "plate_strain_J": strain[:, on_plate].sum(axis=1),
        "plate_displacement_m": state.displacement[:, on_plate] @ centre_weights,
        "plate_velocity_m_s": state.velocity[:, on_plate] @ centre_weights,
        "plate_acceleration_m_s2": acceleration[:, on_plate] @ centre_weights,
        "beyond_touch_m": np.maximum(fall, 0.0),
    }


def _separation_quantities(
    method: _ImplicitEuler, state: State, losses: Floats
) -> dict[str, Floats]:
    """Return the current separation speed [m/s] and `ENERGY_SHARES`, each of shape (P,)."""
    fall, sinking_speed = centre_of(state, method.mass)
    kinetic, strain = method.system.energies(state)
    contact_damping, modal_damping, integrator = losses
    return {
        "separation_speed_m_s": -sinking_speed,
        "kinetic_J": 0.5 * method.mass * sinking_speed**2,
        "potential_J": -method.mass * method.gravity * fall,
        # all oscillators but the first, which is the sphere as a whole
        "vibration_J": (kinetic + strain)[:, 1:].sum(axis=1),
        "contact_dissipated_J": contact_damping,
        "modal_damping_J": modal_damping,
        "integrator_J": integrator,
    }


@dataclass(frozen=True)
class _ImplicitEuler:
    """The coefficients of the implicit Euler method that are constant over the steps of
    an impact [SI].
    """

    system: LinearSystem
    law: CompliantLaw
    mass: float
    gravity: float
    touch_speed: float
    step: float

    @cached_property
    def velocity_factor(self) -> Floats:
        """Factor of each oscillator velocity over a step, 1/(1 + 2 zeta omega h + omega^2 h^2)."""
        damping = self.step * self.system.damping
        stiffness = (self.step * self.system.angular_frequency) ** 2
        return np.asarray(1.0 / (1.0 + damping + stiffness))

    @cached_property
    def step_compliance(self) -> float:
        """Decrease of the indentation at the end of a step per unit of force [m/N]."""
        return float(self.step**2 * (self.system.shape**2 * self.velocity_factor).sum())

    def start(self, phases: Floats) -> State:
        """Return the states at the start of the step in which the surfaces meet: free
        flight without vibration.
        """
        time_to_touch = (1.0 - phases) * self.step
        approach = -time_to_touch * (self.touch_speed - 0.5 * self.gravity * time_to_touch)
        speed = self.touch_speed - self.gravity * time_to_touch
        # the first oscillator is the sphere as a whole
        displacement = np.zeros((len(phases), self.system.number))
        displacement[:, 0] = self.mass**0.5 * approach
        velocity = np.zeros((len(phases), self.system.number))
        velocity[:, 0] = self.mass**0.5 * speed
        return State(displacement, velocity, np.zeros((len(phases), 0)))

    def approach(self, state: State) -> Floats:
        """Return the indentation [m]."""
        return self.system.approach(state)[:, 0]

    def advance(self, state: State) -> tuple[State, Floats]:
        """Return the states and the contact forces at the end of a step."""
        system = self.system
        step = self.step
        acceleration = system.load - system.angular_frequency**2 * state.displacement
        free_velocity = self.velocity_factor * (state.velocity + step * acceleration)
        free_approach = self.approach(self._moved(state, free_velocity))
        force = self._force(free_approach, self.approach(state))
        braking = step * force[:, None] * (self.velocity_factor * system.shape)
        return self._moved(state, free_velocity - braking), force

    def _moved(self, state: State, velocity: Floats) -> State:
        """Return the state at the end of a step, from the velocities there."""
        return State(state.displacement + self.step * velocity, velocity, state.local)

    def _force(self, free_end: Floats, start: Floats) -> Floats:
        """Return the forces at the end of a step, from the force-free indentations there
        and the indentations at its start.
        """

        def excess(force: Floats) -> Floats:
            end = free_end - self.step_compliance * force
            static, dissipative = self.law.forces(
                np.maximum(end, 0.0), (end - start) / self.step, self.touch_speed
            )
            clipped = np.maximum(static + dissipative, 0.0)
            return np.asarray(force - np.where(end > 0.0, clipped, 0.0))

        touching = free_end > 0.0
        if not touching.any():
            return np.zeros_like(free_end)
        # at the largest force the surfaces just part; where they do not touch, any bracket will do
        largest = np.where(touching, free_end / self.step_compliance, 1.0)
        force = find_root(excess, np.zeros_like(free_end), largest)
        return np.where(touching, force, 0.0)

    def losses(self, before: State, after: State, force: Floats) -> Floats:
        """Return the energy dissipated in a step by contact damping, by modal damping and
        by the method [J], (3, P).
        """
        start = self.approach(before)
        end = self.approach(after)
        increase = end - start
        approach_speed = increase / self.step
        static, _ = self.law.forces(np.maximum(end, 0.0), approach_speed, self.touch_speed)
        contact_damping = (force - static) * increase
        modal_damping = self.step * (self.system.damping * after.velocity**2).sum(axis=1)

        # what the method loses: kinetic energy of the changes of velocities, strain energy of the
        # changes of elongations, and work of the static force beyond the elastic energy stored
        speed_change = after.velocity - before.velocity
        of_velocities = 0.5 * (speed_change**2).sum(axis=1)
        elongation = after.displacement - before.displacement
        of_elongations = 0.5 * ((self.system.angular_frequency * elongation) ** 2).sum(axis=1)
        stored_before = self.law.elastic_energy(np.maximum(start, 0.0))
        stored_after = self.law.elastic_energy(np.maximum(end, 0.0))
        of_contact = static * increase - (stored_after - stored_before)
        by_method = of_velocities + of_elongations + of_contact
        return np.array([contact_damping, modal_damping, by_method])

    def rebound_height(self, problem: Problem, speed: Floats) -> Floats:
        """Return the rebound height of the sphere's centre [m] from its separation speed."""
        with np.errstate(divide="ignore"):
            return np.asarray(problem.sphere.contact_offset + speed**2 / (2.0 * self.gravity))


def _implicit_euler(problem: Problem, step: float) -> _ImplicitEuler:
    """Return the method for a problem; InputError unless it is one drop of the superposed
    model under a compliant law without memory.
    """
    law = problem.law_of(0)
    is_superposed = not (
        problem.local_element
        or problem.quasi_static
        or (problem.sphere_inside and problem.sphere.modes is not None)
    )
    is_one_drop = problem.shape == ()
    if not (is_one_drop and is_superposed and isinstance(law, CompliantLaw)) or law.memories():
        raise InputError(
            "the implicit Euler method is for one drop of the superposed model, under a "
            "compliant law without memory"
        )
    mass = float(problem.sphere.mass)
    gravity = float(problem.gravity)
    system = system_of(problem, mass, gravity)
    return _ImplicitEuler(system, law, mass, gravity, first_approach_speed(problem), step)
