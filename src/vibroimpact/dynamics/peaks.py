"""The largest contact force of an impact, from the located extremum."""

from __future__ import annotations

import numpy as np

from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.contact_phase import Contact
from vibroimpact.dynamics.stretch import Encounter, Stretch


def force_peak(contact: Contact, encounter: Encounter) -> tuple[Floats, Floats]:
    """Return the largest contact force [N] of each drop and when it is reached, since first touch [s]."""
    stretches = [(piece, piece.motion) for piece in contact.pieces if isinstance(piece.motion, Stretch)]  # a glide is free of force
    coarse = np.full(len(encounter.mass), np.inf)
    for piece, motion in stretches:
        coarse[piece.drops] = np.minimum(coarse[piece.drops], motion.node_acceleration.min(axis=0))
    largest, when = np.zeros(len(encounter.mass)), np.zeros(len(encounter.mass))
    for piece, motion in stretches:
        drops = piece.drops
        if not (motion.node_acceleration.min(axis=0) < 0.8 * coarse[drops]).any() and len(stretches) > 1:
            continue  # far from the peak
        least, x = _least_acceleration(motion, encounter.take(drops))
        force = encounter.mass[drops] * (encounter.gravity[drops] - least)
        better = force > largest[drops]
        largest[drops[better]] = force[better]
        when[drops[better]] = (piece.start + motion.duration * motion.rule.map_time(x))[better]
    return largest, when


def _least_acceleration(stretch: Stretch, encounter: Encounter) -> tuple[Floats, Floats]:
    """Return the least acceleration in a stretch, of each drop, and its x."""
    rule, values = stretch.rule, stretch.node_acceleration
    grid = rule.dense @ values
    grid[0] = encounter.acceleration(stretch.delta, stretch.velocity)  # x = 0 is not a node
    index = grid.argmin(axis=0)
    column, last, spacing = np.arange(len(index)), len(grid) - 1, 1.0 / (len(grid) - 1)
    least, at = grid[index, column], index * spacing
    inside = (index > 0) & (index < last)
    if not inside.any():
        return least, at
    centre = np.clip(index, 1, last - 1)
    at = np.where(inside, centre * spacing + _vertex(grid[centre - 1, column], grid[centre, column], grid[centre + 1, column], spacing), at)
    left, middle, right = (rule.at_points(at + side * spacing / 16.0, values) for side in (-1.0, 0.0, 1.0))
    finer = np.clip(at + _vertex(left, middle, right, spacing / 16.0), 0.0, 1.0)
    at = np.where(inside, finer, at)
    return np.where(inside, rule.at_points(at, values), least), at


def _vertex(left: Floats, middle: Floats, right: Floats, spacing: float) -> Floats:
    """Return how far from the middle the vertex lies of the parabola through three points."""
    with np.errstate(all="ignore"):
        shift = 0.5 * spacing * (left - right) / (left - 2.0 * middle + right)
    return np.where(np.abs(shift) <= spacing, shift, 0.0)
