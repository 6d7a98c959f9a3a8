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

    def pick(self, which: Indices | Bools | slice) -> Oscillators:
        """Return a subset of the oscillators."""
        return Oscillators(
            self.angular_frequency[which], self.damping_ratio[which], self.shape[..., which]
        )

    def transition(self, time: Floats) -> Floats:
        """Return the transition matrices of displacement and velocity of each over a free
        motion of some time [s], (2, 2, ..., n).
        """
        cosine, sine = self.propagators(time)
        return np.array(
            [[cosine, sine], [-(self.angular_frequency**2) * sine, cosine - self.damping * sine]]
        )

    def propagators(self, time: Floats) -> tuple[Floats, Floats]:
        """Return the response C to a unit initial displacement and S to a unit initial velocity,
        after times [s] (...): (..., n) each.

        Then q = C q0 + S v0, and the rates are C' = -omega^2 S and S' = C - 2 zeta omega S, for any
        damping ratio.
        """
        omega, ratio, t = self.angular_frequency, self.damping_ratio, np.asarray(time)[..., None]
        root = omega * np.sqrt(np.abs(1.0 - ratio * ratio))
        fade, phase, swings = np.exp(-ratio * omega * t), root * t, root > 0.0
        # sine and cosine take most of the time; without a phase, of rigid motions and critical
        # damping, they are known
        sine = np.sin(phase, where=swings, out=np.zeros_like(phase)) / np.where(swings, root, 1.0)
        sine = fade * np.where(swings, sine, t)
        cosine = fade * np.cos(phase, where=swings, out=np.ones_like(phase))
        over = ratio > 1.0
        if over.any():  # overdamped: factor out the slower exponential, so that none overflows
            root, at = root[over], ratio[over] * omega[over]
            slow = np.exp((root - at) * t)
            sine[..., over] = slow * -np.expm1(-2.0 * root * t) / (2.0 * root)
            cosine[..., over] = 0.5 * slow * (1.0 + np.exp(-2.0 * root * t))
        return cosine + ratio * omega * sine, sine


def joined(parts: Sequence[Oscillators]) -> Oscillators:
    """Return the oscillators of several parts, in order."""
    fields = zip(
        *((part.angular_frequency, part.damping_ratio, part.shape) for part in parts), strict=True
    )
    return Oscillators(*(np.concatenate(values, axis=-1) for values in fields))
