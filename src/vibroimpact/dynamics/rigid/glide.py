"""Free motion within the indentation, where the force of a law without tension is zero."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.encounter import Encounter

_SAMPLES = 33
_STEPS = 4


@dataclass(frozen=True)
class Glide:
    """Motion under gravity alone of b drops: duration [s], indentation [m] and rate [m/s] at its start.

    `floor`: the indentation at separation [m].
    """

    duration: Floats
    delta: Floats
    velocity: Floats
    gravity: Floats
    floor: Floats

    def at(self, time: Floats) -> tuple[Floats, Floats]:
        """Return indentation [m] and rate [m/s] at times since the start (..., b)."""
        delta = self.delta + time * (self.velocity + 0.5 * self.gravity * time)
        return np.maximum(delta, self.floor), self.velocity + self.gravity * time

    def take(self, drops: Bools) -> Glide:
        """Return the glide of the drops under a mask."""
        return Glide(self.duration[drops], self.delta[drops], self.velocity[drops], self.gravity[drops], self.floor[drops])

    def end(self) -> tuple[Floats, Floats]:
        """Return indentation [m] and rate [m/s] at the end; an indentation at the floor to rounding is set to it."""
        delta, velocity = self.at(self.duration)
        return np.where(delta - self.floor < 1e-14 * (self.delta - self.floor), self.floor, delta), velocity


def glide_until_push(encounter: Encounter, delta: Floats, velocity: Floats) -> tuple[Glide, Bools, Bools]:
    """Return the free motion of drops until the force of the law becomes positive again, or the surfaces separate.

    Returns
    -------
    glide : Glide
        The motion.
    pushes : array of bool, shape (B,)
        Whether it ends because the force becomes positive.
    stays : array of bool, shape (B,)
        Whether gravity turns the motion before separation.
    """
    gravity, above = encounter.gravity, delta - encounter.floor
    inside = velocity * velocity - 2.0 * gravity * above
    stays = inside < 0.0
    with np.errstate(all="ignore"):
        out = 2.0 * above / (np.sqrt(np.maximum(inside, 0.0)) - velocity)
        out = np.where(stays, -velocity / gravity, out)
    path = Glide(out, delta, velocity, gravity, encounter.floor)

    def push(time: Floats) -> Floats:
        elastic, dissipative = encounter.law.forces(*path.at(time), encounter.approach_speed)
        return np.asarray(elastic + dissipative)

    fraction = np.linspace(0.0, 1.0, _SAMPLES)[1:, None]
    times = out * (fraction * (2.0 - fraction))  # dense near the end, where the force is small
    positive = push(times) > 0.0
    positive[-1] = False  # at separation the force is zero to rounding
    pushes = positive.any(axis=0)
    index = positive.argmax(axis=0)
    column = np.arange(len(delta))
    late = times[index, column]
    if (pushes & (index > 0)).any():  # the force is zero there: an error of the time enters the motion with its square
        low, high = times[np.maximum(index - 1, 0), column], late
        aside, late = 1e-6 * (high - low), np.where(index > 0, 0.5 * (low + high), late)
        for _ in range(_STEPS):
            with np.errstate(all="ignore"):
                here, there = push(np.array([late, late + aside]))
                late = np.where(index > 0, np.clip(late - aside * here / (there - here), low, high), late)
    return Glide(np.where(pushes, late, out), delta, velocity, gravity, encounter.floor), np.asarray(pushes), stays & ~pushes
