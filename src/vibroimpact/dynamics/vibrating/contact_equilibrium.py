r"""Equilibrium of a sphere under its weight on bodies that vibrate, small oscillations about it,
and criteria of rest.

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
from vibroimpact.contact.law import CompliantLaw
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
    """Return the least energy of a state with an approach of the surfaces [m] at which
    the contact stores `stored` [J].
    """
    weight = weight_on(system)
    return stored - weight * approach - 0.5 * float(system.compliance[0]) * weight * weight


def separates_slower_than(
    system: LinearSystem, law: CompliantLaw, state: State, speed: float
) -> bool:
    """Whether a sphere apart from the surface can nowhere reach a separation speed any more, for
    lack of energy.

    Parameters
    ----------
    system : LinearSystem
        The sphere and the bodies that vibrate.
    law : CompliantLaw
        The law of the next contact.
    state : State
        The current state.
    speed : float
        Speed of the sphere relative to a surface at rest [m/s].
    """
    least = least_energy(system, float(law.touch_level), 0.0)
    return float(system.mechanical_energy(state)) < least + 0.5 * float(system.mass[0]) * speed**2


def near_equilibrium(system: LinearSystem, state: State, force: float, indentation: float) -> bool:
    """Whether a riding sphere may be at rest, by a necessary condition that needs no eigenvalues.

    The force must be close to the weight, and the speed low: the force decelerates and accelerates
    the sphere at no lower an angular frequency than that from the trace of the flexibility, on a
    contact with about the stiffness of force over indentation.
    """
    weight, mass = weight_on(system), float(system.mass[0])
    most = REST_MARGIN * weight
    if not weight or abs(force - weight) > most:
        return False
    on_springs = mass * (abs(indentation) / weight / REST_MARGIN + float(system.compliance[0]))
    slowest = float((on_springs + system.flexibility.sum()) ** -0.5)
    return mass * abs(float(system.rigid_motion(state)[1][0])) * slowest < most


def rides_for_good(equilibrium: ContactEquilibrium, state: State, force: float) -> bool:
    """Whether a sphere on a rigid plate that is shaken will never leave it again.

    The least force that carries it, its mass times gravity less the greatest downward acceleration
    of the plate, must exceed what is left of its own oscillation on the contact: the difference of
    the force [N] from that of a sphere that moves with the plate, and the amplitude of the force
    that the speed between them can still cause.
    """
    system = equilibrium.system
    if system.number > 1 + system.driven or system.rate.size or system.along is not None:
        # other coordinates oscillate too (`carried_oscillations`), or it moves along the plate
        return False
    driven, mass = slice(1, None), float(system.mass[0])
    speeds = np.hypot(
        state.velocity[driven], system.angular_frequency[driven] * state.displacement[driven]
    )
    greatest = float((np.abs(system.shape[0, driven]) * system.angular_frequency[driven]) @ speeds)
    carried = equilibrium.weight + mass * float(system.driven_motion(state)[2])
    left = abs(force - carried) + np.sqrt(equilibrium.contact[0] * mass) * abs(
        float(system.rates(state)[0])
    )
    return bool(left < REST_MARGIN * (equilibrium.weight - mass * greatest))


@dataclass(frozen=True, eq=False)
class ContactEquilibrium:
    """Equilibrium of a sphere on bodies that vibrate, and small oscillations about it as one linear
    system.

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
        """Ratio of the force without motion to the static force: less than one where a
        law pushes less in restitution.
        """
        static, dissipative = (
            float(part[0])
            for part in self.local.forces_at_indentation(
                static_indentation(self.local.law, np.array([self.weight])), np.zeros(1)
            )
        )
        return 1.0 + dissipative / static if dissipative else 1.0

    @cached_property
    def sag(self) -> float:
        """Indentation of the law under the weight [m]."""
        return float(static_indentation(self.local.law, np.array([self.weight / self.share]))[0])

    @cached_property
    def approach(self) -> float:
        """Approach of the surfaces at equilibrium, with the compliance in series with the
        law [m].
        """
        return float(self.local.approach_at(np.array([self.sag]))[0])

    @cached_property
    def stored(self) -> float:
        """Energy stored in the contact at equilibrium that it gives back [J]."""
        return self.share * float(self.local.energy_at_indentation(np.array([self.sag]))[0])

    @cached_property
    def contact(self) -> tuple[float, float]:
        """Stiffness [N/m] and damping [N s/m] of the contact at equilibrium."""
        sag, slow = (
            np.array([self.sag]),
            np.array([1e-3 * np.sqrt(self.system.gravity[0] * abs(self.sag)) + 1e-12]),
        )
        stiffness = self.share * self.local.stiffness_at(self.sag)
        towards, away = (self.local.forces_at_indentation(sag, rate)[1] for rate in (slow, -slow))
        return max(stiffness, _NONE), max(float((towards - away)[0] / (2.0 * slow[0])), 0.0)

    @cached_property
    def stiffness(self) -> float:
        """Stiffness of the contact in series with the massless elements [N/m]."""
        return 1.0 / (1.0 / self.contact[0] + float(self.system.local_compliance.sum()))

    @cached_property
    def state(self) -> State:
        """State at equilibrium."""
        system, weight = self.system, self.weight
        displacement, local = (
            -weight * system.shape[0] * system.flexibility,
            -weight * system.local_compliance,
        )
        apart = self.approach - displacement @ system.shape[0] - local.sum()
        rigid = system.rigid_shape[0]
        return State(
            displacement + rigid * apart * float(system.mass[0]), np.zeros_like(displacement), local
        )

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
        """Angular frequencies [rad/s] and mode shapes (n, n), a column per mode, of all
        coordinates coupled by the contact spring.
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
        """Return the largest possible deviation of the contact force from the weight [N]
        from a state on, for any phases of the modes.
        """
        (omega, shapes), (place, speed) = self.modes, self.deviation(state)
        amplitude = np.hypot(shapes.T @ place, (shapes.T @ speed) / omega)
        lag = state.local + self.system.local_compliance * (
            self.weight + self.stiffness * float(self.shape @ place)
        )
        return float(
            self.stiffness * np.abs(self.shape @ shapes) @ amplitude
            + self.contact[0] * np.abs(lag).sum()
        )

    def cannot_separate(self, state: State) -> bool:
        """Whether the bound of the force excludes that the sphere separates."""
        return self.force_bound(state) < REST_MARGIN * self.weight

    def excess(self, state: State, stored: float) -> float:
        """Return the energy of sphere, oscillators and contact, which stores `stored`
        [J], above their equilibrium [J].
        """
        energy = float(self.system.mechanical_energy(state) - self.system.common_energy(state))
        return energy + self.share * stored - least_energy(self.system, self.approach, self.stored)


def coupled_oscillators(equilibrium: ContactEquilibrium) -> tuple[Oscillators, Floats]:
    """Return the coupled modes of sphere and bodies as independent oscillators, and the
    distribution of the energy that each loses.

    Each coupled mode has its own damping; the coupling of modes by damping is neglected. The
    distribution is (n, n + 1): a row per coupled mode, with the part lost in each coordinate, and
    last in the contact.
    """
    (omega, shapes), system, damping = equilibrium.modes, equilibrium.system, equilibrium.contact[1]
    # the dashpots of the massless elements follow the force that their springs carry
    if system.rate.size:
        damping = (
            equilibrium.stiffness / equilibrium.contact[0]
        ) ** 2 * damping + equilibrium.stiffness**2 * (
            system.local_compliance**2 / system.mobility
        ).sum()
    lost = np.concatenate(
        [shapes**2 * system.damping[:, None], damping * (equilibrium.shape @ shapes)[None] ** 2]
    )
    total_loss = lost.sum(axis=0)
    coupled = Oscillators(omega, 0.5 * total_loss / omega, equilibrium.shape @ shapes)
    return coupled, np.where(
        total_loss > 0.0, lost / np.where(total_loss > 0.0, total_loss, 1.0), 0.0
    ).T
