"""A lump that falls on a deck on springs, on a frame that shakes, by scipy's DOP853 (an oracle:
imports nothing of vibroimpact).

The deck has one degree of freedom, or none if it is stiff: z'' = -2 zeta omega (z' - s') - omega^2
(z - s) - F/M, from where it hangs in its springs, on a frame that moves by s(t) = A sin(2 pi f t +
phase). The lump falls with gravity, and is pushed by the viscoelastic contact F = max(0, K (d^1.5 +
1.5 T d^0.5 d')) while d = z - y > 0. The integration stops wherever d passes zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ShakenDeck:
    """Masses [kg], the deck's own frequency [Hz] and damping ratio, the contact's K [N/m^1.5] and T
    [s], and the shaking of the frame.

    A deck of infinite mass moves with the frame. Where nothing pushes the lump, air slows it down
    by `drag` [1/m] times the square of its velocity.
    """

    mass: float
    deck: float
    frequency: float
    damping: float
    stiffness: float
    relaxation: float
    amplitude: float
    shaking: float
    gravity: float = 9.8
    drag: float = 0.0

    def frame(self, time: float) -> tuple[float, float, float]:
        """Displacement, velocity and acceleration of the frame."""
        omega = 2.0 * np.pi * self.shaking
        return (
            self.amplitude * np.sin(omega * time),
            self.amplitude * omega * np.cos(omega * time),
            -self.amplitude * omega**2 * np.sin(omega * time),
        )

    def steady(self) -> tuple[float, float]:
        """Place and velocity of the deck at the start, as it moves without the lump."""
        omega, own = 2.0 * np.pi * self.shaking, 2.0 * np.pi * self.frequency
        if np.isinf(self.deck):
            return self.frame(0.0)[:2]
        transmitted = (own**2 + 2j * self.damping * own * omega) / (
            own**2 - omega**2 + 2j * self.damping * own * omega
        )
        phasor = self.amplitude * transmitted
        return float(phasor.imag), float(omega * phasor.real)

    def push(self, y: Floats) -> float:
        """The contact force in a state (y, y', z, z')."""
        depth, rate = max(y[2] - y[0], 0.0), y[3] - y[1]
        return max(
            float(self.stiffness * (depth**1.5 + 1.5 * self.relaxation * np.sqrt(depth) * rate)),
            0.0,
        )

    def slopes(self, time: float, y: Floats, pushes: bool) -> list[float]:
        """Time derivative of the state."""
        force, (place, speed, acceleration) = (self.push(y) if pushes else 0.0), self.frame(time)
        slowed = 0.0 if force > 0.0 else self.drag * abs(y[1]) * y[1]
        if np.isinf(self.deck):
            return [y[1], force / self.mass - self.gravity - slowed, y[3], acceleration]
        own = 2.0 * np.pi * self.frequency
        pull = (
            -2.0 * self.damping * own * (y[3] - speed) - own**2 * (y[2] - place) - force / self.deck
        )
        return [y[1], force / self.mass - self.gravity - slowed, y[3], pull]

    def follow(
        self, height: float, times: Floats, tolerance: float = 3e-14
    ) -> tuple[Floats, list[float]]:
        """States at times (T, 4) of a lump that starts at rest at a height of its lowest
        point, and when it leaves the deck.
        """
        state, time, end, apart = (
            np.array([height, 0.0, *self.steady()]),
            0.0,
            float(times[-1]),
            True,
        )
        found, left, scale = np.empty((len(times), 4)), [], np.array([1e-6, 1e-3, 1e-6, 1e-3])
        while True:

            def gap(_: float, y: Floats) -> float:
                return float(y[0] - y[2])

            gap.terminal, gap.direction = True, -1.0 if apart else 1.0  # type: ignore[attr-defined]
            step = solve_ivp(
                lambda at, y, free=apart: self.slopes(at, y, not free),
                (time, end),
                state,
                "DOP853",
                events=gap,
                dense_output=True,
                rtol=tolerance,
                atol=tolerance * scale,
                max_step=2e-3,
            )
            here = (times >= time) & (times <= step.t[-1])
            if here.any():
                found[here] = step.sol(times[here]).T
            if step.status != 1:
                return found, left
            time, state, apart = float(step.t[-1]), step.y[:, -1].copy(), not apart
            state[0] = state[2] + (1e-15 if apart else -1e-15)
            left += [time] if apart else []
