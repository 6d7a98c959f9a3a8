r"""Motion of a sphere that an elastic plate carries for good while its supports move: small
oscillations about a steady motion.

On the linear spring and dashpot :math:`\kappa(\omega) = k + i \omega c` of its contact, the sphere
is one more coordinate of the plate.
What drives the plate changes the approach of the surfaces by :math:`D e^{i \omega t}`; with the
dynamic stiffness
:math:`Z_i = \omega_i^2 - \omega^2 + 2 i \zeta_i \omega_i \omega` of each coordinate,

.. math::

    \hat F = \frac{D}{1/\kappa + \sum_i \chi_i^2/Z_i},\qquad \hat q_i = -\frac{\chi_i}{Z_i} \hat F

Without :math:`1/\kappa` the force is that of a sphere that moves with the surface. What is left of
the motion decays as on a plate at rest,
since all is linear.
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
        return np.asarray(-self._flexibility * self._forces[0])

    @cached_property
    def _flexibility(self) -> Complex:
        """Shapes of the coordinates over their dynamic stiffnesses (n, d)."""
        own, omega = self.still.system, self.driving.angular_frequency
        damped = 2j * (own.damping_ratio * own.angular_frequency)[:, None] * omega
        # at the resonance of a mode without damping
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(
                own.shape[0][:, None] / (own.angular_frequency[:, None] ** 2 - omega**2 + damped)
            )

    @cached_property
    def _forces(self) -> tuple[Complex, Complex]:
        """Phasors of the contact force per unit of each driven coordinate (d,), and those
        on a contact without compliance.
        """
        stiffness, damping = self.still.contact
        yields = self.still.shape @ self._flexibility
        with np.errstate(divide="ignore", invalid="ignore"):
            on_spring = 1.0 / (
                1.0 / (stiffness + 1j * damping * self.driving.angular_frequency) + yields
            )
            return self.driving.shape[0] * on_spring, self.driving.shape[0] / yields

    def phasors(self, state: State) -> Complex:
        """Return the phasors of the driven coordinates in states (..., d)."""
        place, speed = state.displacement[..., self._driven], state.velocity[..., self._driven]
        return np.asarray(speed / self.driving.angular_frequency + 1j * place)

    def steady(self, phasors: Complex) -> tuple[Floats, Floats]:
        """Return displacements and velocities of the other coordinates in the steady
        motion (..., n).
        """
        moved, faster = (
            part @ self.motions.T
            for part in (phasors, 1j * self.driving.angular_frequency * phasors)
        )
        return moved.imag, faster.imag

    def force(self, phasors: Complex) -> Floats:
        """Return the deviation of the contact force from the weight [N] (...)."""
        return np.asarray((phasors @ self._forces[0]).imag)

    def deviation(self, state: State) -> State:
        """Return what differs in a state from the steady motion, without the driven coordinates."""
        (steady, faster), number = self.steady(self.phasors(state)), self.still.system.number
        return State(
            state.displacement[:number] - steady, state.velocity[:number] - faster, state.local
        )

    def carries_for_good(self, state: State, force: float) -> bool:
        """Whether a sphere under a contact force [N] will never leave the plate again.

        The least force of the steady motion must exceed what its own oscillations and those of the
        plate can add, and what the contact yields, which is not linear.
        """
        amplitudes = np.abs(self.phasors(state))
        least = self.still.weight - float(amplitudes @ np.abs(self._forces[0]))
        left = REST_MARGIN * least - float(amplitudes @ np.abs(self._forces[0] - self._forces[1]))
        if not (
            self.still.linear
            and abs(force - self.still.weight - float(self.force(self.phasors(state)))) < left
        ):
            return False
        return self.still.force_bound(self.deviation(state)) < left


def steady_response(equilibrium: ContactEquilibrium) -> SteadyResponse | None:
    """Return the steady motion of a sphere with an elastic plate that is shaken; None for
    others, with friction or a local element.
    """
    system = equilibrium.system
    if (
        not system.driven
        or system.number == 1 + system.driven
        or system.rate.size
        or system.along is not None
    ):
        return None
    own = slice(0, system.number - system.driven)
    names = ("angular_frequency", "damping_ratio", "shape", "load", "inside", "below")
    still = replace(system, **{name: getattr(system, name)[..., own] for name in names}, driven=0)
    return SteadyResponse(equilibrium, ContactEquilibrium(still, equilibrium.local))


@dataclass(frozen=True, eq=False)
class CarriedOscillations(RestMotion):
    """Oscillations of a sphere and the elastic plate that carries it about their steady motion.

    `response`: steady motion. `left`: what oscillates about it. The losses are those of both, in
    the mean over time; the work of the drive is what they leave of the change of energy.
    """

    response: SteadyResponse
    left: RestMotion

    @property
    def oscillations(self) -> FreeOscillations:
        """The motion as that of independent oscillators: those of what is left, then the
        driven coordinates.
        """
        left, response = self.left.oscillations, self.response
        driving, moved = (
            response.driving,
            np.vstack([response.motions, np.eye(response.driving.number)]),
        )
        steady = np.stack([moved.real, moved.imag / driving.angular_frequency])
        apart = np.concatenate(
            [left.shapes, np.zeros((2, driving.number, left.oscillators.number))], axis=1
        )
        phasors = response.phasors(self.start)
        start = np.stack([phasors.imag, driving.angular_frequency * phasors.real])
        return FreeOscillations(
            joined([left.oscillators, replace(driving, shape=driving.shape[0])]),
            np.concatenate([left.start, start], axis=1),
            np.concatenate([apart, steady], axis=2),
        )

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        left, response, omega = (
            self.left.state(time),
            self.response,
            self.response.driving.angular_frequency,
        )
        phasors = response.phasors(self.start) * np.exp(1j * omega * np.asarray(time)[..., None])
        (steady, faster), turned = response.steady(phasors), omega * phasors
        place, speed = left.displacement + steady, left.velocity + faster
        return State(
            np.concatenate([place, phasors.imag], axis=-1),
            np.concatenate([speed, turned.real], axis=-1),
            left.local,
        )

    def force(self, time: Floats) -> Floats:
        """Return the contact force [N] at times since the start [s]."""
        return self.left.force(time) + self.response.force(self.response.phasors(self.state(time)))

    def stored(self, time: Floats) -> Floats:
        """Return the energy stored by the contact [J] at times since the start [s]."""
        return self._stored(self.state(time))

    def _stored(self, state: State) -> Floats:
        still = self.response.still
        deeper = self.equilibrium.system.approach(state)[..., 0] - still.approach
        return np.asarray(still.stored + (still.weight + 0.5 * still.stiffness * deeper) * deeper)

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost since the start [J] at times (T,), (T, n + 1): the last
        coordinate has minus the work of the drive.
        """
        system, own = self.equilibrium.system, self.response.still.system.number
        lost, left = np.zeros((*np.shape(time), system.number + 1)), self.left.lost_by(time)
        lost[..., :own], lost[..., -1] = left[..., :-1], left[..., -1]
        lost[..., [*range(own), -1]] += np.asarray(time)[..., None] * self._powers
        before, now = (
            system.mechanical_energy(state) + self._stored(state)
            for state in (self.start, self.state(time))
        )
        lost[..., -2] = before - now - lost.sum(axis=-1)
        return lost

    @cached_property
    def _powers(self) -> Floats:
        """Mean power lost in the steady motion [W] in each coordinate, and last in the
        contact (n + 1,).
        """
        response, still = self.response, self.response.still
        speeds = response.driving.angular_frequency * np.abs(response.phasors(self.start))
        closing = still.shape @ response.motions + response.driving.shape[0]
        damping = np.append(still.system.damping, still.contact[1])
        return np.asarray(
            0.5
            * damping
            * ((np.abs(np.vstack([response.motions, closing])) * speeds) ** 2).sum(axis=1)
        )


def carry_oscillating(response: SteadyResponse, state: State, stored: float) -> CarriedOscillations:
    """Return the oscillations that replace the contact of a sphere that will not leave the plate,
    from a state on.

    The sphere is placed where the linear spring of its contact holds as much energy as the contact
    did, which stores `stored` [J].
    """
    system, still = response.moving.system, response.still
    deeper = float(system.approach(state)[0]) - still.approach
    held = still.share * stored - still.stored - still.weight * deeper
    on_spring = np.copysign(np.sqrt(2.0 * max(held, 0.0) / still.stiffness), deeper)
    displacement = state.displacement.copy()
    displacement[0] += (on_spring - deeper) * float(system.mass[0]) ** 0.5
    start = replace(state, displacement=displacement)
    left = RestMotion(still, response.deviation(start), np.nan, 0.0)
    return CarriedOscillations(
        response.moving, start, np.nan, (1.0 - still.share) * stored, response, left
    )
