"""Linear oscillators of unit mass under a force, and their free motion in closed form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices


@dataclass(frozen=True)
class Oscillators:
    """Oscillators of unit mass.

    Parameters
    ----------
    angular_frequency, damping_ratio : array, shape (n,)
        [rad/s] and [-]; both zero for a rigid motion.
    shape : array, shape (..., n)
        Displacement per unit coordinate where a force acts [kg^-1/2]; one row per force.
    """

    angular_frequency: Floats
    damping_ratio: Floats
    shape: Floats

    @property
    def number(self) -> int:
        """Number of oscillators."""
        return len(self.angular_frequency)

    @cached_property
    def damping(self) -> Floats:
        """Twice the damping ratio times the angular frequency [1/s] (n,)."""
        return 2.0 * self.damping_ratio * self.angular_frequency

    def pick(self, selection: Indices | Bools | slice) -> Oscillators:
        """Return a subset of the oscillators."""
        return Oscillators(
            self.angular_frequency[selection],
            self.damping_ratio[selection],
            self.shape[..., selection],
        )

    def transition(self, time: Floats) -> Floats:
        """Return the transition matrices of free motion over times [s] (...): (2, 2, ..., n).

        They take displacement and velocity at the start to those at the time, per oscillator.
        """
        cosine, sine = self.propagators(time)
        cosine_rate = -(self.angular_frequency**2) * sine
        sine_rate = cosine - self.damping * sine
        return np.array([[cosine, sine], [cosine_rate, sine_rate]])

    def propagators(self, time: Floats) -> tuple[Floats, Floats]:
        """Return responses C and S to a unit initial displacement and velocity, (..., n) each.

        They are given after times [s] (...). Then q = C q0 + S v0, and the rates are
        C' = -omega^2 S and S' = C - 2 zeta omega S, for any damping ratio.
        """
        omega = self.angular_frequency
        zeta = self.damping_ratio
        t = np.asarray(time)[..., None]
        # damped angular frequency; of an overdamped oscillator its hyperbolic counterpart
        damped_omega = omega * np.sqrt(np.abs(1.0 - zeta * zeta))
        decay = np.exp(-zeta * omega * t)
        phase = damped_omega * t
        oscillates = damped_omega > 0.0
        # sine and cosine take most of the time; they are known where the phase is always zero, for
        # rigid motions and critical damping
        sine_of_phase = np.sin(phase, where=oscillates, out=np.zeros_like(phase))
        sine = sine_of_phase / np.where(oscillates, damped_omega, 1.0)
        # of which the limit for a frequency of zero is the time
        sine = decay * np.where(oscillates, sine, t)
        cosine = decay * np.cos(phase, where=oscillates, out=np.ones_like(phase))
        overdamped = zeta > 1.0
        if overdamped.any():
            # sinh and cosh with the slower of their exponentials factored out, so that none
            # overflows
            rate = damped_omega[overdamped]
            slow_decay = np.exp((rate - zeta[overdamped] * omega[overdamped]) * t)
            faster = -2.0 * rate * t
            sine[..., overdamped] = slow_decay * -np.expm1(faster) / (2.0 * rate)
            cosine[..., overdamped] = 0.5 * slow_decay * (1.0 + np.exp(faster))
        return cosine + zeta * omega * sine, sine


def joined(groups: Sequence[Oscillators]) -> Oscillators:
    """Return the oscillators of several groups, in order."""
    return Oscillators(
        np.concatenate([group.angular_frequency for group in groups], axis=-1),
        np.concatenate([group.damping_ratio for group in groups], axis=-1),
        np.concatenate([group.shape for group in groups], axis=-1),
    )
