"""What Newton's method starts from where nothing is known: an undamped, sinusoidal motion."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.collocation import Rule
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.rigid.stretch import Aim


def time_scale(encounter: Encounter, delta: Floats, velocity: Floats, aim: Aim, level: Floats) -> Floats:
    """Return how long the motion would take from an indentation [m] and its rate [m/s] to the end of a stretch [s]."""
    above, depth, end = delta - encounter.floor, encounter.depth - encounter.floor, level - encounter.floor
    if aim == "turn":
        begin = np.arcsin(np.minimum(above / depth, 0.999))
        speed = np.sqrt(velocity**2 + encounter.gravity * (depth - above))
        return np.asarray((0.5 * np.pi - begin) * depth * np.cos(begin) / speed)
    stored = encounter.law.elastic_energy(delta) - encounter.law.elastic_energy(encounter.floor)
    turn, speed = np.arccos(np.clip(end / above, 0.0, 1.0)), np.sqrt(2.0 * stored / encounter.mass)
    return np.where(velocity == 0.0, turn * above / np.where(stored > 0.0, speed, encounter.speed_scale), (end - above) / velocity)


def first_guess(encounter: Encounter, rule: Rule, delta: Floats, velocity: Floats, duration: Floats, aim: Aim, level: Floats) -> Floats:
    """Return the accelerations at the nodes of a stretch of that duration [m/s^2]."""
    above, depth, end = delta - encounter.floor, encounter.depth - encounter.floor, level - encounter.floor
    fraction = rule.time[:, None]
    if aim == "turn":
        begin = np.arcsin(np.minimum(above / depth, 0.999))
        angle = begin + fraction * (0.5 * np.pi - begin)
        path, speed = depth * np.sin(angle), velocity / np.cos(begin) * np.cos(angle)
    else:
        resting, turn = velocity == 0.0, np.arccos(np.clip(end / above, 0.0, 1.0))
        path = np.where(resting, above * np.cos(turn * fraction), above + (end - above) * fraction)
        speed = np.where(resting, -0.9 * above * turn / duration * np.sin(turn * fraction), velocity)
    return encounter.acceleration(encounter.floor + np.maximum(path, 0.0), speed)
