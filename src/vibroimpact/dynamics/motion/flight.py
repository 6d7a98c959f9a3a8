"""Free flight above a plate at rest, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.along import Sphere, State


@dataclass(frozen=True)
class Flight:
    """Flights of B drops; all arrays are (B,).

    `start`: start times [s]. `gap`: height of the sphere's lowest point above the plate then [m],
    >= 0. `velocity`: upward [m/s]. `gravity` [m/s^2].
    """

    start: Floats
    gap: Floats
    velocity: Floats
    gravity: Floats

    def carry(self, sphere: Sphere, state: State, time: Floats) -> State:
        """Return the state along the plate at times [s], from that at the start of the flight."""
        return sphere.fly(state, time - self.start)

    def at(self, time: Floats) -> tuple[Floats, Floats]:
        """Return gap [m] and upward velocity [m/s] at times [s] (..., B)."""
        elapsed = time - self.start
        gap = self.gap + elapsed * (self.velocity - 0.5 * self.gravity * elapsed)
        velocity = self.velocity - self.gravity * elapsed
        return gap, velocity

    def acceleration(self, time: Floats) -> Floats:
        """Return the upward acceleration at times [s] (..., B) [m/s^2]."""
        return np.asarray(0.0 * time - self.gravity)

    def touch(self, level: Floats) -> tuple[Floats, Floats]:
        r"""Return time [s] and approach speed [m/s] of the next touch.

        The time is infinite if there is none.

        .. math:: v = \sqrt{v_0^2 + 2 g h},\qquad t = (v_0 + v)/g = 2 h/(v - v_0)

        with h the gap above `level` [m], at which the surfaces meet: zero, or below it in a dent.
        """
        height = self.gap - level
        speed = np.sqrt(self.velocity**2 + 2.0 * self.gravity * height)
        with np.errstate(divide="ignore", invalid="ignore"):
            rising = (self.velocity + speed) / self.gravity
            falling = 2.0 * height / (speed - self.velocity)  # the same root without cancellation
            falling = np.where(speed > self.velocity, falling, np.inf)
            elapsed = np.where(self.velocity > 0.0, rising, falling)
        never = (self.gravity == 0.0) & (self.velocity >= 0.0)
        return np.where(never, np.inf, self.start + elapsed), speed

    def apex(self) -> tuple[Floats, Floats]:
        """Return time [s] and gap [m] at the top of the flight.

        They are infinite without gravity, if rising.
        """
        rises = self.velocity > 0.0
        with np.errstate(divide="ignore", invalid="ignore"):
            rise_time = np.where(rises, self.velocity / self.gravity, 0.0)
            height = np.where(rises, 0.5 * self.velocity**2 / self.gravity, 0.0)
        return self.start + rise_time, self.gap + height
