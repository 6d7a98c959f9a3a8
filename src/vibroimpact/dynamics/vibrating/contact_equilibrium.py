r"""A sphere that lies on what vibrates: their equilibrium under its weight, and what it takes to leave it.

At equilibrium the contact carries the weight m g, and what is behind it has yielded by :math:`C m g`, with the static
compliance :math:`C = \sum_i \chi_i^2 / \omega_i^2 + \sum_k 1/k_k` of oscillators and massless elements. Of all states with a
given approach y of the surfaces, the one with the least energy is at rest and has

.. math:: E(y) = U(y) - m g y - \tfrac12 C (m g)^2

where U is what the contact holds. So surfaces part only where at least E of the approach of release is left: a **barrier of
energy**, which holds for any law, any damping and any motion. It is strict where much is left that hardly reaches the contact,
as in springs of 3 Hz; there the **bound of the force** says more. Small motions about the equilibrium are those of one linear
system, the sphere on the spring of its contact and all oscillators, with modes of its own, and the energy of each bounds what it
can ever add to the force of the contact.
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

_MARGIN = 0.5
"""Part of the weight by which the force may vary where a sphere stays: so near to the weight the spring of a contact is nearly
linear (that of Hertz's law has 0.79 to 1.14 of its stiffness), and what damping hands from mode to mode finds room."""

_NONE = 1e-300
"""What stands for no stiffness [N/m], as of Hertz's law where there is no weight."""


def weight_on(system: LinearSystem) -> float:
    """Return the weight on the contact of a system that has one [N]."""
    return float(system.mass[0] * system.gravity[0])


def least_energy(system: LinearSystem, approach: float, stored: float) -> float:
    """Return the least energy of a state with an approach of the surfaces [m] at which the contact holds `stored` [J]."""
    weight = weight_on(system)
    return stored - weight * approach - 0.5 * float(system.compliance[0]) * weight * weight


def separates_slower_than(system: LinearSystem, law: CompliantLaw, state: State, speed: float) -> bool:
    """Tell whether a sphere that is apart from the surface can nowhere any more leave it at a speed [m/s], whatever still moves.

    Parameters
    ----------
    system : LinearSystem
        The sphere and what vibrates.
    law : CompliantLaw
        The law of the next contact.
    state : State
        Where everything is.
    speed : float
        Speed of the sphere beside a surface at rest [m/s].
    """
    least = least_energy(system, float(law.touch_level), 0.0)
    return float(system.mechanical_energy(state)) < least + 0.5 * float(system.mass[0]) * speed**2


def near_equilibrium(system: LinearSystem, state: State, force: float, indentation: float) -> bool:
    """Tell whether it is worth asking if a sphere that rides stays, which takes the modes of sphere and oscillators together.

    It is not where the force is far from the weight, nor where the speed is too high: the force takes it away and gives it back, at
    no lower an angular frequency than that by the trace of the flexibility, on a contact about as stiff as force over indentation.
    """
    weight, mass = weight_on(system), float(system.mass[0])
    most = _MARGIN * weight
    if not weight or abs(force - weight) > most:
        return False
    on_springs = mass * (abs(indentation) / weight / _MARGIN + float(system.compliance[0]))
    slowest = float((on_springs + system.flexibility.sum()) ** -0.5)
    return mass * abs(float(system.rigid_motion(state)[1][0])) * slowest < most


@dataclass(frozen=True, eq=False)
class ContactEquilibrium:
    """Small oscillations of a sphere and what it lies on about their equilibrium, as one linear system.

    Parameters
    ----------
    system : LinearSystem
        The sphere, whose weight is greater than 0 and which is the first coordinate, and what vibrates.
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
        """The part of the static force that is there without motion: less than one where a law pushes less on the way out."""
        static, dissipative = (
            float(part[0])
            for part in self.local.forces_at_indentation(static_indentation(self.local.law, np.array([self.weight])), np.zeros(1))
        )
        return 1.0 + dissipative / static if dissipative else 1.0

    @cached_property
    def sag(self) -> float:
        """Indentation of the law under the weight [m]."""
        return float(static_indentation(self.local.law, np.array([self.weight / self.share]))[0])

    @cached_property
    def approach(self) -> float:
        """Approach of the surfaces at equilibrium, with what is in series with the law [m]."""
        return float(self.local.approach_at(np.array([self.sag]))[0])

    @cached_property
    def stored(self) -> float:
        """What the contact holds at equilibrium, and gives back [J]."""
        return self.share * float(self.local.energy_at_indentation(np.array([self.sag]))[0])

    @cached_property
    def contact(self) -> tuple[float, float]:
        """Stiffness [N/m] and damping [N s/m] of the contact at equilibrium."""
        sag, slow = np.array([self.sag]), np.array([1e-3 * np.sqrt(self.system.gravity[0] * abs(self.sag)) + 1e-12])
        now = self.local.linearise(sag, slow)
        stiffness = self.share * float(now.stiffness[0] / now.slope[0])
        towards, away = (self.local.forces_at_indentation(sag, rate)[1] for rate in (slow, -slow))
        return max(stiffness, _NONE), max(float((towards - away)[0] / (2.0 * slow[0])), 0.0)

    @cached_property
    def stiffness(self) -> float:
        """Stiffness of the contact and of the massless elements in series [N/m]."""
        return 1.0 / (1.0 / self.contact[0] + float(self.system.local_compliance.sum()))

    @cached_property
    def state(self) -> State:
        """The state of equilibrium."""
        system, weight = self.system, self.weight
        displacement, local = -weight * system.shape[0] * system.flexibility, -weight * system.local_compliance
        apart = self.approach - displacement @ system.shape[0] - local.sum()
        rigid = system.rigid_shape[0]
        return State(displacement + rigid * apart * float(system.mass[0]), np.zeros_like(displacement), local)

    @property
    def linear(self) -> bool:
        """Does the contact push, on a spring?"""
        return bool(self.system.gravity[0] > 0.0 and _NONE < self.contact[0] < np.inf)

    @property
    def shape(self) -> Floats:
        """By how much each coordinate adds to the approach [kg^-1/2] (n,)."""
        return np.asarray(self.system.shape[0])

    @cached_property
    def modes(self) -> tuple[Floats, Floats]:
        """Angular frequencies [rad/s] and shapes (n, n), a column a mode, of all coordinates together on the spring of the contact."""
        stiffness = np.diag(self.system.angular_frequency**2) + self.stiffness * np.outer(self.shape, self.shape)
        squares, shapes = np.linalg.eigh(stiffness)
        return np.sqrt(np.maximum(squares, _NONE)), shapes

    def deviation(self, state: State) -> tuple[Floats, Floats]:
        """Return how far from equilibrium the coordinates are [kg^1/2 m], and their rates (n,)."""
        return state.displacement - self.state.displacement, state.velocity.copy()

    def force_bound(self, state: State) -> float:
        """Return by how much the force of the contact can ever differ from the weight [N], from a state on, however the modes meet."""
        (omega, shapes), (place, speed) = self.modes, self.deviation(state)
        amplitude = np.hypot(shapes.T @ place, (shapes.T @ speed) / omega)
        lag = state.local + self.system.local_compliance * (self.weight + self.stiffness * float(self.shape @ place))
        return float(self.stiffness * np.abs(self.shape @ shapes) @ amplitude + self.contact[0] * np.abs(lag).sum())

    def cannot_separate(self, state: State) -> bool:
        """Tell whether nothing that still moves can lift the sphere off, by the bound of the force."""
        return self.force_bound(state) < _MARGIN * self.weight

    def excess(self, state: State, stored: float) -> float:
        """Return what sphere, oscillators and contact, which holds `stored` [J], can give back down to their equilibrium [J]."""
        energy = float(self.system.mechanical_energy(state) - self.system.common_energy(state))
        return energy + self.share * stored - least_energy(self.system, self.approach, self.stored)


def coupled_oscillators(equilibrium: ContactEquilibrium) -> tuple[Oscillators, Floats]:
    """Return sphere and modes as oscillators that go on apart from each other, and the parts that take what each loses.

    Damping is that of each coupled mode: what it hands from one to another is left out. The parts are (n, n + 1): a row a coupled
    mode; what each coordinate takes, and, last, the contact.
    """
    (omega, shapes), system, damping = equilibrium.modes, equilibrium.system, equilibrium.contact[1]
    if system.rate.size:  # the dashpots of the massless elements follow the force that their springs carry
        damping = (equilibrium.stiffness / equilibrium.contact[0]) ** 2 * damping + equilibrium.stiffness**2 * (
            system.local_compliance**2 / system.mobility
        ).sum()
    lost = np.concatenate([shapes**2 * system.damping[:, None], damping * (equilibrium.shape @ shapes)[None] ** 2])
    whole = lost.sum(axis=0)
    coupled = Oscillators(omega, 0.5 * whole / omega, equilibrium.shape @ shapes)
    return coupled, np.where(whole > 0.0, lost / np.where(whole > 0.0, whole, 1.0), 0.0).T
