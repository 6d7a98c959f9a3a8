r"""Equilibrium of a sphere on bodies that vibrate, oscillations about it, and criteria of rest.

At equilibrium the contact carries the weight m g, and the bodies have deflected by :math:`C m g`,
with the static compliance
:math:`C = \sum_i \chi_i^2 / \omega_i^2 + \sum_k 1/k_k` of oscillators and massless elements. Of all
states with a given approach y of the
surfaces, the one of least energy is at rest and has

.. math:: E(y) = U(y) - m g y - \tfrac12 C (m g)^2

with the energy U stored by the contact. Surfaces therefore separate only if the energy is at least
E at the approach of release: an **energy barrier**, which holds for any law, any damping and any
motion. It is of little use where much energy is in modes that hardly move the contact, as of a
plate on springs of 3 Hz; there the **bound of the force** is sharper. Small oscillations about the
equilibrium are those of one linear system, the sphere on the spring of its contact and all
oscillators; the energy of each of its modes bounds its contribution to the contact force.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.oscillators import Oscillators

REST_MARGIN = 0.5
"""Largest variation of the force at rest, relative to the weight. So near to the weight the spring
of a contact is nearly linear (that of Hertz's law keeps 0.79 to 1.14 of its stiffness), with a
reserve for the coupling of modes by damping.
"""

_NONE = 1e-300
"""Stands for zero stiffness [N/m], as of Hertz's law without weight."""


def weight_on(system: LinearSystem) -> float:
    """Return the weight on the contact of a system with one contact [N]."""
    return float(system.mass[0] * system.gravity[0])


def least_energy(system: LinearSystem, approach: float, stored: float) -> float:
    """Return the least energy of a state with an approach of the surfaces [m].

    The contact stores `stored` [J] at that approach. See E(y) of the module.
    """
    weight = weight_on(system)
    return stored - weight * approach - 0.5 * float(system.compliance[0]) * weight * weight


def near_equilibrium(system: LinearSystem, state: State, force: float, indentation: float) -> bool:
    """Whether a riding sphere may be at rest, by a condition that needs no eigenvalues.

    The condition is necessary. The force must be close to the weight, and the speed low: the force
    decelerates and accelerates the sphere at no lower an angular frequency than that from the trace
    of the flexibility, on a contact with about the stiffness of force over indentation.
    """
    weight = weight_on(system)
    mass = float(system.mass[0])
    largest_deviation = REST_MARGIN * weight
    if not weight or abs(force - weight) > largest_deviation:
        return False
    contact_compliance = abs(indentation) / weight / REST_MARGIN
    # trace of the flexibility: the sum of 1/omega^2 of all modes, at least that of the lowest
    trace = mass * (contact_compliance + float(system.compliance[0])) + system.flexibility.sum()
    lowest_frequency = float(trace**-0.5)
    speed = abs(float(system.rigid_motion(state)[1][0]))
    return mass * speed * lowest_frequency < largest_deviation


def rides_for_good(equilibrium: ContactEquilibrium, state: State, force: float) -> bool:
    """Whether a sphere on a rigid plate that is shaken will never leave it again.

    The least force that carries it, its mass times gravity less the greatest downward acceleration
    of the plate, must exceed what remains of its own oscillation on the contact: the difference of
    the force [N] from that of a sphere that moves with the plate, and the amplitude of the force
    that the speed between them can still cause.
    """
    system = equilibrium.system
    if system.number > 1 + system.driven or system.rate.size or system.along is not None:
        # other coordinates oscillate too (`carried_oscillations`), or it moves along the plate
        return False
    driven = slice(1, None)
    mass = float(system.mass[0])
    omega = system.angular_frequency[driven]
    speed_amplitudes = np.hypot(state.velocity[driven], omega * state.displacement[driven])
    greatest_acceleration = float((np.abs(system.shape[0, driven]) * omega) @ speed_amplitudes)
    _, _, acceleration = system.driven_motion(state)
    carrying_force = equilibrium.weight + mass * float(acceleration)
    stiffness, _ = equilibrium.contact
    # a speed v on a spring causes a force of amplitude v sqrt(k m)
    impedance = np.sqrt(stiffness * mass)
    speed = abs(float(system.rates(state)[0]))
    oscillation = abs(force - carrying_force) + impedance * speed
    least_carrying_force = equilibrium.weight - mass * greatest_acceleration
    return bool(oscillation < REST_MARGIN * least_carrying_force)


@dataclass(frozen=True, eq=False)
class ContactEquilibrium:
    """Equilibrium of a sphere on bodies that vibrate, and small oscillations about it.

    Parameters
    ----------
    system : LinearSystem
        The sphere, whose weight is greater than 0 and which is the first coordinate, and the bodies
        that vibrate.
    local : LocalContact
        The contact that carries the weight.
    """

    system: LinearSystem
    local: LocalContact

    @property
    def weight(self) -> float:
        """Weight of the sphere [N]."""
        return weight_on(self.system)

    @cached_property
    def share(self) -> float:
        """Ratio of the force without motion to the static force [-].

        It is less than one where a law pushes less in restitution.
        """
        indentation = static_indentation(self.local.law, np.array([self.weight]))
        static, dissipative = self.local.forces_at_indentation(indentation, np.zeros(1))
        at_rest = float(dissipative[0])
        if not at_rest:  # the static force may be zero then, as without weight
            return 1.0
        return 1.0 + at_rest / float(static[0])

    @cached_property
    def sag(self) -> float:
        """Indentation of the law under the weight [m]."""
        return float(static_indentation(self.local.law, np.array([self.weight / self.share]))[0])

    @cached_property
    def approach(self) -> float:
        """Approach of the surfaces at equilibrium [m], with the compliance in series."""
        return float(self.local.approach_at(np.array([self.sag]))[0])

    @cached_property
    def stored(self) -> float:
        """Energy stored in the contact at equilibrium that it gives back [J]."""
        return self.share * float(self.local.energy_at_indentation(np.array([self.sag]))[0])

    @cached_property
    def contact(self) -> tuple[float, float]:
        """Stiffness [N/m] and damping [N s/m] of the contact at equilibrium."""
        sag = np.array([self.sag])
        stiffness = self.share * self.local.stiffness_at(self.sag)
        # central difference of the dissipative force, at a speed far below those of oscillations
        speed = np.sqrt(self.system.gravity[0] * abs(self.sag))
        rate = np.array([1e-3 * speed + 1e-12])
        _, approaching = self.local.forces_at_indentation(sag, rate)
        _, separating = self.local.forces_at_indentation(sag, -rate)
        damping = float((approaching - separating)[0] / (2.0 * rate[0]))
        return max(stiffness, _NONE), max(damping, 0.0)

    @cached_property
    def stiffness(self) -> float:
        """Stiffness of the contact in series with the massless elements [N/m]."""
        return 1.0 / (1.0 / self.contact[0] + float(self.system.local_compliance.sum()))

    @cached_property
    def state(self) -> State:
        """State at equilibrium."""
        system = self.system
        # static deflection of the modes and of the massless elements under the weight
        deflection = -self.weight * system.shape[0] * system.flexibility
        local = -self.weight * system.local_compliance
        # the rigid motions add what is missing in the approach
        rigid_approach = self.approach - deflection @ system.shape[0] - local.sum()
        rigid = system.rigid_shape[0] * rigid_approach * float(system.mass[0])
        return State(deflection + rigid, np.zeros_like(deflection), local)

    @property
    def linear(self) -> bool:
        """Whether there is a weight, and a finite stiffness of the contact under it."""
        return bool(self.system.gravity[0] > 0.0 and _NONE < self.contact[0] < np.inf)

    @property
    def shape(self) -> Floats:
        """Derivative of the approach by each coordinate [kg^-1/2] (n,)."""
        return np.asarray(self.system.shape[0])

    @cached_property
    def modes(self) -> tuple[Floats, Floats]:
        """Angular frequencies [rad/s] and mode shapes (n, n) with the contact spring.

        There is a column per mode; the spring couples all coordinates.
        """
        stiffness = np.diag(self.system.angular_frequency**2) + self.stiffness * np.outer(
            self.shape, self.shape
        )
        squares, shapes = np.linalg.eigh(stiffness)
        return np.sqrt(np.maximum(squares, _NONE)), shapes

    def deviation(self, state: State) -> tuple[Floats, Floats]:
        """Return the displacements from equilibrium [kg^1/2 m], and their rates (n,)."""
        return state.displacement - self.state.displacement, state.velocity.copy()

    def force_bound(self, state: State) -> float:
        """Return the bound of the deviation of the contact force from the weight [N].

        It holds from a state on, for any phases of the modes.
        """
        # the amplitudes of all modes add up at worst
        omega, mode_shapes = self.modes
        displacement, velocity = self.deviation(state)
        modal_displacement = mode_shapes.T @ displacement
        modal_velocity = mode_shapes.T @ velocity
        amplitudes = np.hypot(modal_displacement, modal_velocity / omega)
        # deviation of the massless elements from the deformation under the current force
        spring_force = self.weight + self.stiffness * float(self.shape @ displacement)
        lag = state.local + self.system.local_compliance * spring_force
        by_modes = self.stiffness * np.abs(self.shape @ mode_shapes) @ amplitudes
        by_elements = self.contact[0] * np.abs(lag).sum()
        return float(by_modes + by_elements)

    def cannot_separate(self, state: State) -> bool:
        """Whether the bound of the force excludes that the sphere separates."""
        return self.force_bound(state) < REST_MARGIN * self.weight

    def excess(self, state: State, stored: float) -> float:
        """Return the energy of sphere, oscillators and contact above their equilibrium [J].

        The contact stores `stored` [J].
        """
        energy = float(self.system.mechanical_energy(state) - self.system.common_energy(state))
        return energy + self.share * stored - least_energy(self.system, self.approach, self.stored)


def coupled_oscillators(equilibrium: ContactEquilibrium) -> tuple[Oscillators, Floats]:
    """Return the coupled modes of sphere and bodies as independent oscillators, and their losses.

    Each coupled mode has its own damping; the coupling of modes by damping is neglected. The losses
    are the distribution of the energy that each loses, (n, n + 1): a row per coupled mode, with the
    part lost in each coordinate, and last in the contact.
    """
    omega, shapes = equilibrium.modes
    system = equilibrium.system
    contact_stiffness, damping = equilibrium.contact
    contact_shape = equilibrium.shape @ shapes
    # the dashpots of the massless elements follow the force that their springs carry
    if system.rate.size:
        stiffness = equilibrium.stiffness
        in_elements = (system.local_compliance**2 / system.mobility).sum()
        damping = (stiffness / contact_stiffness) ** 2 * damping + stiffness**2 * in_elements
    # damping of each coupled mode by each coordinate, and by the contact
    modal_damping = np.concatenate(
        [shapes**2 * system.damping[:, None], damping * contact_shape[None] ** 2]
    )
    total = modal_damping.sum(axis=0)
    # d = 2 zeta omega
    coupled = Oscillators(omega, 0.5 * total / omega, contact_shape)
    damped = total > 0.0
    distribution = np.where(damped, modal_damping / np.where(damped, total, 1.0), 0.0)
    return coupled, distribution.T
