r"""Linear oscillators behind a contact, and their exact motion while nothing touches them.

The bodies that meet may vibrate: in modes, and in a local element of spring and dashpot. The contact knows of
them how far each moves its own point towards more indentation, :math:`\chi_i`. With the approach s of the
rigid sphere (positive downwards) and the contact force F,

.. math:: \delta = s + \sum_i \chi_i q_i + \sum_k r_k,\qquad \ddot s = g - F/m

.. math:: \ddot q_i + 2 \zeta_i \omega_i \dot q_i + \omega_i^2 q_i = -\chi_i F_i,\qquad \dot r_k + \kappa_k r_k = -\mu_k F

An oscillator may lie *inside* the contact: then it is in series with the spring of the contact law alone, :math:`F_i` is
that spring's force, and the dashpot of the law spans it; of the others :math:`F_i = F`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats


@dataclass(frozen=True)
class Oscillators:
    """Oscillators of unit mass, and massless elements of a spring and a dashpot side by side.

    Parameters
    ----------
    angular_frequency, damping_ratio, shape : array, shape (n,)
        [rad/s], > 0; [-]; and chi, by how much each adds to the indentation [kg^-1/2].
    rate, mobility : array, shape (k,)
        Of the massless elements: stiffness over damping [1/s], and one over damping [m/(N s)].
    inside : array of bool, shape (n,)
        Which oscillators lie inside the contact.
    ground : array of bool, shape (n,)
        Which are of the body below: the indentation of the bodies is the approach of the sphere's centre to that one's surface.
    """

    angular_frequency: Floats
    damping_ratio: Floats
    shape: Floats
    rate: Floats
    mobility: Floats
    inside: NDArray[np.bool_]
    ground: NDArray[np.bool_]

    @cached_property
    def damping(self) -> Floats:
        """Twice the damping ratio times the angular frequency [1/s] (n,)."""
        return 2.0 * self.damping_ratio * self.angular_frequency

    @cached_property
    def below(self) -> Floats:
        """The shape of the oscillators of the body below, zero of the others (n,)."""
        return np.where(self.ground, self.shape, 0.0)

    @cached_property
    def outer(self) -> Floats:
        """The shape of the oscillators outside the contact, zero of those inside (n,)."""
        return np.where(self.inside, 0.0, self.shape)

    @cached_property
    def by_side(self) -> Floats:
        """The shapes of the oscillators outside the contact, and of those inside (n, 2)."""
        return np.stack([self.outer, self.shape - self.outer], axis=1)

    @cached_property
    def squares_by_side(self) -> Floats:
        """Their squares (n, 2)."""
        return self.by_side**2

    @cached_property
    def local_compliance(self) -> Floats:
        """Compliance of the springs of the massless elements [m/N] (k,)."""
        return self.mobility / self.rate

    @cached_property
    def compliance(self) -> float:
        """Static compliance of all, seen from the contact [m/N]."""
        return float(((self.shape / self.angular_frequency) ** 2).sum() + self.local_compliance.sum())

    def pick(self, which: NDArray[np.intp]) -> Oscillators:
        """Return some of the oscillators, without the massless elements."""
        nothing = np.zeros(0)
        frequency, ratio, shape = self.angular_frequency[which], self.damping_ratio[which], self.shape[which]
        return Oscillators(frequency, ratio, shape, nothing, nothing, self.inside[which], self.ground[which])

    def transition(self, time: Floats) -> Floats:
        """Return the matrices that take displacement and velocity of each to those of its free motion later, (2, 2, ..., n)."""
        cosine, sine = self.propagators(time)
        return np.array([[cosine, sine], [-(self.angular_frequency**2) * sine, cosine - self.damping * sine]])

    def propagators(self, time: Floats) -> tuple[Floats, Floats]:
        """Return what displacement C and velocity S of one at the start are worth in its displacement later, (..., n).

        Then q = C q0 + S v0, and the rates are C' = -omega^2 S and S' = C - 2 zeta omega S, whatever the damping.
        """
        omega, ratio, t = self.angular_frequency, self.damping_ratio, np.asarray(time)[..., None]
        root = omega * np.sqrt(np.abs(1.0 - ratio * ratio))
        fade, phase = np.exp(-ratio * omega * t), root * t
        sine = fade * np.where(root > 0.0, np.sin(phase) / np.where(root > 0.0, root, 1.0), t)
        cosine = fade * np.cos(phase)
        over = ratio > 1.0
        if over.any():  # the slower exponential apart, so that none overflows
            root, at = root[over], ratio[over] * omega[over]
            slow = np.exp((root - at) * t)
            sine[..., over] = slow * -np.expm1(-2.0 * root * t) / (2.0 * root)
            cosine[..., over] = 0.5 * slow * (1.0 + np.exp(-2.0 * root * t))
        return cosine + ratio * omega * sine, sine

    def energies(self, state: State) -> tuple[Floats, Floats]:
        """Return kinetic and strain energy of each oscillator [J]; states may have leading axes."""
        return 0.5 * state.velocity**2, 0.5 * (self.angular_frequency * state.displacement) ** 2

    def local_energy(self, state: State) -> Floats:
        """Return what the springs of the massless elements hold [J]."""
        return np.asarray(0.5 * (state.local**2 * self.rate / self.mobility).sum(axis=-1))

    def approach(self, state: State) -> Floats:
        """Return the approach of the surfaces [m], negative where there is a gap."""
        return np.asarray(state.approach + state.displacement @ self.shape + state.local.sum(axis=-1))

    def rates(self, state: State) -> Floats:
        """Return the rate of that without contact force [m/s]."""
        return np.asarray(state.speed + state.velocity @ self.shape - state.local @ self.rate)

    def outer_rates(self, state: State) -> Floats:
        """Return the rate that the dashpot of a contact law feels, without contact force [m/s]."""
        return np.asarray(state.speed + state.velocity @ self.outer - state.local @ self.rate)

    def indentation(self, state: State) -> Floats:
        """Return the approach of the sphere's centre to the surface of the body below [m]."""
        return np.asarray(state.approach + state.displacement @ self.below)

    def accelerations(self, state: State, force: Floats) -> Floats:
        """Return the accelerations of the oscillators outside the contact, under contact forces [N] (T,): (T, n)."""
        own = -self.damping * state.velocity - self.angular_frequency**2 * state.displacement
        return np.asarray(own - self.outer * force[:, None])


@dataclass(frozen=True)
class State:
    """Where everything is: arrays may have leading axes of times.

    `approach` [m] and `speed` [m/s] of the sphere's centre, downwards; `displacement` and `velocity` of the
    oscillators (..., n), of unit mass; `local`, of the massless elements (..., k) [m].
    """

    approach: Floats
    speed: Floats
    displacement: Floats
    velocity: Floats
    local: Floats


@dataclass(frozen=True)
class FreeMotion:
    """Motion without contact force, in closed form, from a state on.

    `gravity` acts on the sphere alone: oscillators are counted from where they rest under their own weight.
    """

    oscillators: Oscillators
    start: State
    gravity: float

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        of, start, time = self.oscillators, self.start, np.asarray(time, dtype=float)
        cosine, sine = of.propagators(time)
        displacement = cosine * start.displacement + sine * start.velocity
        velocity = -(of.angular_frequency**2) * sine * start.displacement
        velocity += (cosine - of.damping * sine) * start.velocity
        return State(
            start.approach + time * (start.speed + 0.5 * self.gravity * time),
            start.speed + self.gravity * time,
            displacement,
            velocity,
            start.local * np.exp(-of.rate * time[..., None]),
        )

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since the start [J], (..., n + 1): in each oscillator; last, in the massless elements."""
        return self.lost_at(self.state(time))

    def lost_at(self, state: State) -> Floats:
        """Return the same of states that the motion comes to."""
        of = self.oscillators
        oscillators = sum(of.energies(self.start)) - sum(of.energies(state))
        massless = of.local_energy(self.start) - of.local_energy(state)
        return np.concatenate([oscillators, massless[..., None]], axis=-1)

    def motion(self, time: Floats) -> tuple[Floats, Floats]:
        """Return the approach of the surfaces [m], negative where there is a gap, and its rate [m/s] at times since the start [s]."""
        state = self.state(time)
        return self.oscillators.approach(state), self.oscillators.rates(state)
