r"""Motion of a sphere that a shaken elastic plate carries for good: small oscillations.

They are those about a steady motion. On the linear spring and dashpot
:math:`\kappa(\omega) = k + i \omega c` of its contact, the sphere is one more coordinate of the
plate. What drives the plate changes the approach of the surfaces by :math:`D e^{i \omega t}`; with
the dynamic stiffness :math:`Z_i = \omega_i^2 - \omega^2 + 2 i \zeta_i \omega_i \omega` of each
coordinate,

.. math::

    \hat F = \frac{D}{1/\kappa + \sum_i \chi_i^2/Z_i},\qquad \hat q_i = -\frac{\chi_i}{Z_i} \hat F

Without :math:`1/\kappa` the force is that of a sphere that moves with the surface. Deviations from
the steady motion decay as on a plate at rest, since all is linear.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.dynamics.vibrating.contact_equilibrium import REST_MARGIN, ContactEquilibrium
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.oscillators import Oscillators, joined
from vibroimpact.dynamics.vibrating.rest_motion import FreeOscillations, RestMotion


@dataclass(frozen=True, eq=False)
class SteadyResponse:
    """Steady motion of a sphere and the bodies that carry it, of which some coordinates are driven.

    `moving`: their equilibrium, whose system has the driven coordinates. `still`: that of the
    others where these are at rest.
    """

    moving: ContactEquilibrium
    still: ContactEquilibrium

    @property
    def driving(self) -> Oscillators:
        """The driven coordinates."""
        return self.moving.system.pick(self._driven)

    @property
    def _driven(self) -> slice:
        return slice(self.still.system.number, None)

    @cached_property
    def motions(self) -> Complex:
        """Phasors of the coordinates per unit of each driven one (n, d)."""
        return np.asarray(-self._receptances * self._force_phasors)

    @cached_property
    def _receptances(self) -> Complex:
        """Shapes of the coordinates over their dynamic stiffnesses, chi_i / Z_i (n, d)."""
        own = self.still.system
        omega = self.driving.angular_frequency
        damping = 2j * (own.damping_ratio * own.angular_frequency)[:, None] * omega
        # at the resonance of a mode without damping
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(
                own.shape[0][:, None] / (own.angular_frequency[:, None] ** 2 - omega**2 + damping)
            )

    @cached_property
    def _compliance(self) -> Complex:
        """Dynamic compliance of sphere and plate at the contact, sum of chi_i^2 / Z_i (d,)."""
        return np.asarray(self.still.shape @ self._receptances)

    @cached_property
    def _force_phasors(self) -> Complex:
        """Phasors of the contact force per unit of each driven coordinate (d,)."""
        stiffness, damping = self.still.contact
        # spring and dashpot of the contact in series with the compliance of both bodies
        contact_stiffness = stiffness + 1j * damping * self.driving.angular_frequency
        compliance = self._compliance
        with np.errstate(divide="ignore", invalid="ignore"):
            force_per_approach = 1.0 / (1.0 / contact_stiffness + compliance)
            return np.asarray(self.driving.shape[0] * force_per_approach)

    @cached_property
    def _rigid_contact_force_phasors(self) -> Complex:
        """Phasors of the force as in `_force_phasors` on a contact without compliance (d,)."""
        compliance = self._compliance
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(self.driving.shape[0] / compliance)

    def phasors(self, state: State) -> Complex:
        """Return the phasors of the driven coordinates in states (..., d)."""
        displacement = state.displacement[..., self._driven]
        velocity = state.velocity[..., self._driven]
        return np.asarray(velocity / self.driving.angular_frequency + 1j * displacement)

    def steady(self, phasors: Complex) -> tuple[Floats, Floats]:
        """Return displacements and velocities of the other coordinates (..., n)."""
        velocity_phasors = 1j * self.driving.angular_frequency * phasors
        displacements = phasors @ self.motions.T
        velocities = velocity_phasors @ self.motions.T
        return displacements.imag, velocities.imag

    def force(self, phasors: Complex) -> Floats:
        """Return the deviation of the contact force from the weight [N] (...)."""
        return np.asarray((phasors @ self._force_phasors).imag)

    def deviation(self, state: State) -> State:
        """Return the deviation of a state from the steady motion, without driven coordinates."""
        displacement, velocity = self.steady(self.phasors(state))
        number = self.still.system.number
        return State(
            state.displacement[:number] - displacement,
            state.velocity[:number] - velocity,
            state.local,
        )

    def carries_for_good(self, state: State, force: float) -> bool:
        """Whether a sphere under a contact force [N] will never leave the plate again.

        The least force of the steady motion must exceed what its own oscillations and those of the
        plate can add, and the effect of the compliance of the contact, which is not linear.
        """
        if not self.still.linear:
            return False
        phasors = self.phasors(state)
        amplitudes = np.abs(phasors)
        least_force = self.still.weight - float(amplitudes @ np.abs(self._force_phasors))
        effect_of_compliance = float(
            amplitudes @ np.abs(self._force_phasors - self._rigid_contact_force_phasors)
        )
        margin = REST_MARGIN * least_force - effect_of_compliance
        # of the force from that of the steady motion
        deviation = abs(force - self.still.weight - float(self.force(phasors)))
        # the bound over all later times takes the coupled modes, and comes last
        return deviation < margin and self.still.force_bound(self.deviation(state)) < margin


def steady_response(equilibrium: ContactEquilibrium) -> SteadyResponse | None:
    """Return the steady motion of a sphere on a shaken elastic plate.

    It is None on other plates, with friction, and with a local element.
    """
    system = equilibrium.system
    elastic = system.number > 1 + system.driven
    if not (system.driven and elastic) or system.rate.size or system.along is not None:
        return None
    own = slice(0, system.number - system.driven)
    still = replace(
        system,
        angular_frequency=system.angular_frequency[own],
        damping_ratio=system.damping_ratio[own],
        shape=system.shape[..., own],
        load=system.load[own],
        inside=system.inside[own],
        below=system.below[..., own],
        driven=0,
    )
    return SteadyResponse(equilibrium, ContactEquilibrium(still, equilibrium.local))


@dataclass(frozen=True, eq=False)
class CarriedOscillations(RestMotion):
    """Oscillations of a sphere and the elastic plate that carries it about their steady motion.

    `response`: steady motion. `transient`: oscillations about it. The losses are those of both, in
    the mean over time; the work of the drive follows from the energy balance.
    """

    response: SteadyResponse
    transient: RestMotion

    @property
    def oscillations(self) -> FreeOscillations:
        """The motion as that of independent oscillators.

        They are those of the transient, then the driven coordinates.
        """
        transient = self.transient.oscillations
        response = self.response
        driving = response.driving
        omega = driving.angular_frequency
        # Im(C exp(i omega t)) = Re(C) q + Im(C) / omega q', of a driven coordinate q
        moved = np.vstack([response.motions, np.eye(driving.number)])
        steady_shapes = np.stack([moved.real, moved.imag / omega])
        # the transient does not move the driven coordinates
        unmoved = np.zeros((2, driving.number, transient.oscillators.number))
        transient_shapes = np.concatenate([transient.shapes, unmoved], axis=1)
        phasors = response.phasors(self.start)
        driven_start = np.stack([phasors.imag, omega * phasors.real])
        return FreeOscillations(
            joined([transient.oscillators, replace(driving, shape=driving.shape[0])]),
            np.concatenate([transient.start, driven_start], axis=1),
            np.concatenate([transient_shapes, steady_shapes], axis=2),
        )

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        transient = self.transient.state(time)
        response = self.response
        omega = response.driving.angular_frequency
        phasors = response.phasors(self.start) * np.exp(1j * omega * np.asarray(time)[..., None])
        displacement, velocity = response.steady(phasors)
        driven_velocity = (omega * phasors).real
        return State(
            np.concatenate([transient.displacement + displacement, phasors.imag], axis=-1),
            np.concatenate([transient.velocity + velocity, driven_velocity], axis=-1),
            transient.local,
        )

    def force(self, time: Floats) -> Floats:
        """Return the contact force [N] at times since the start [s]."""
        steady_force = self.response.force(self.response.phasors(self.state(time)))
        return self.transient.force(time) + steady_force

    def stored(self, time: Floats) -> Floats:
        """Return the energy stored by the contact [J] at times since the start [s]."""
        return self._stored(self.state(time))

    def _stored(self, state: State) -> Floats:
        """Return the energy in the linear spring of the contact [J] in states (...)."""
        still = self.response.still
        approach = self.equilibrium.system.approach(state)[..., 0]
        deviation = approach - still.approach
        return np.asarray(
            still.stored + (still.weight + 0.5 * still.stiffness * deviation) * deviation
        )

    def _energy(self, state: State) -> Floats:
        """Return the mechanical energy with that of the contact [J] in states (...)."""
        return np.asarray(self.equilibrium.system.mechanical_energy(state) + self._stored(state))

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost since the start [J] at times (T,), (T, n + 1).

        The last coordinate has minus the work of the drive, and the last column the contact.
        """
        own = self.response.still.system.number
        lost = np.zeros((*np.shape(time), self.equilibrium.system.number + 1))
        transient = self.transient.lost_by(time)
        lost[..., :own] = transient[..., :-1]
        lost[..., -1] = transient[..., -1]
        lost[..., [*range(own), -1]] += np.asarray(time)[..., None] * self._mean_powers
        initial_energy = self._energy(self.start)
        # the drive closes the balance of energy
        lost[..., -2] = initial_energy - self._energy(self.state(time)) - lost.sum(axis=-1)
        return lost

    @cached_property
    def _mean_powers(self) -> Floats:
        """Mean power lost in the steady motion [W] (n + 1,): per coordinate, and in the contact."""
        response = self.response
        still = response.still
        driven_speeds = response.driving.angular_frequency * np.abs(response.phasors(self.start))
        approach = still.shape @ response.motions + response.driving.shape[0]
        damping = np.append(still.system.damping, still.contact[1])
        speeds = np.abs(np.vstack([response.motions, approach])) * driven_speeds
        # mean of the square of a harmonic motion: half that of its amplitude
        return np.asarray(0.5 * damping * (speeds**2).sum(axis=1))


def carry_oscillating(response: SteadyResponse, state: State, stored: float) -> CarriedOscillations:
    """Return the oscillations that replace the contact of a sphere that stays on the plate.

    The sphere is placed where the linear spring of its contact holds as much energy as the contact
    did in the given state, which stores `stored` [J].
    """
    system = response.moving.system
    still = response.still
    deviation = float(system.approach(state)[0]) - still.approach
    # 1/2 k u^2 of the deviation u from equilibrium, in which the contact also carries the weight
    strain_energy = still.share * stored - still.stored - still.weight * deviation
    spring_deviation = np.copysign(
        np.sqrt(2.0 * max(strain_energy, 0.0) / still.stiffness), deviation
    )
    displacement = state.displacement.copy()
    displacement[0] += (spring_deviation - deviation) * float(system.mass[0]) ** 0.5
    start = replace(state, displacement=displacement)
    transient = RestMotion(still, response.deviation(start), np.nan, 0.0)
    written_off = (1.0 - still.share) * stored
    return CarriedOscillations(response.moving, start, np.nan, written_off, response, transient)
