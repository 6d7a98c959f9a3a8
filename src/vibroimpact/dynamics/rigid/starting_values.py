"""Starting values of Newton's method: solutions of a run's last contacts, or an undamped, sinusoidal motion."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.dynamics.collocation import Map, Rule
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.rigid.stretch import Aim, WarmStart


class WarmStarts:
    """Dimensionless solutions of the last stretches of a run, one for each kind and drop."""

    def __init__(self, size: int) -> None:
        self.size = size
        self.starts: dict[tuple[Map, Aim], WarmStart] = {}

    def knows(self, kind: tuple[Map, Aim], ids: Drops) -> Bools:
        """Return for which drops there is a solution of this kind."""
        return np.isfinite(self.starts[kind].unknowns[-1, ids]) if kind in self.starts else np.zeros(len(ids), dtype=bool)

    def forget(self, kind: tuple[Map, Aim], ids: Drops) -> None:
        """Discard solutions that belong to a different motion."""
        if kind in self.starts:
            self.starts[kind].unknowns[:, ids] = np.nan

    def keep(self, kind: tuple[Map, Aim], ids: Drops, unknowns: Floats, inverse: Floats | None) -> None:
        """Store a solution."""
        if kind not in self.starts:
            self.starts[kind] = WarmStart(np.full((len(unknowns), self.size), np.nan))
        self.starts[kind].unknowns[:, ids], self.starts[kind].inverse = unknowns, inverse


def time_scale(encounter: Encounter, delta: Floats, velocity: Floats, aim: Aim, level: Floats) -> Floats:
    """Return the estimated duration of a stretch [s], from indentation [m] and rate [m/s] at its start."""
    above, depth, end = delta - encounter.floor, encounter.depth - encounter.floor, level - encounter.floor
    if aim == "turn":
        begin = np.arcsin(np.minimum(above / depth, 0.999))
        speed = np.sqrt(velocity**2 + encounter.gravity * (depth - above))
        return np.asarray((0.5 * np.pi - begin) * depth * np.cos(begin) / speed)
    stored = encounter.law.elastic_energy(delta) - encounter.law.elastic_energy(encounter.floor)
    turn, speed = np.arccos(np.clip(end / above, 0.0, 1.0)), np.sqrt(2.0 * stored / encounter.mass)
    return np.where(velocity == 0.0, turn * above / np.where(stored > 0.0, speed, encounter.speed_scale), (end - above) / velocity)


def first_guess(encounter: Encounter, rule: Rule, delta: Floats, velocity: Floats, duration: Floats, aim: Aim, level: Floats) -> Floats:
    """Return the estimated accelerations at the nodes of a stretch of a given duration [m/s^2]."""
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
