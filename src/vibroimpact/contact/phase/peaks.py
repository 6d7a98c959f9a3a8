"""The largest contact force of an impact, from the located extremum."""

from __future__ import annotations

import numpy as np

from vibroimpact.contact.phase.collocation import Floats
from vibroimpact.contact.phase.contact import Contact
from vibroimpact.contact.phase.encounter import Encounter
from vibroimpact.contact.phase.stretch import Stretch


def force_peak(contact: Contact, encounter: Encounter) -> tuple[Floats, Floats]:
    """Return the largest contact force [N] of each drop and when it is reached, since first touch [s].

    The acceleration is least there. Its interpolant says where to look, and the law, at the motion there, what
    it is: the motion is an integral, so more exact than the interpolant.
    """
    size = len(encounter.mass)
    stretches = [(piece, piece.motion) for piece in contact.pieces if isinstance(piece.motion, Stretch)]  # a glide is free of force
    lows = [np.minimum(_sampled(motion).min(axis=0), motion.node_acceleration.min(axis=0)) for _, motion in stretches]
    lowest = np.full(size, np.inf)
    for (piece, _), low in zip(stretches, lows, strict=True):
        lowest[piece.drops] = np.minimum(lowest[piece.drops], low)
    least, when = np.full(size, np.inf), np.zeros(size)
    for (piece, motion), low in zip(stretches, lows, strict=True):
        drops = piece.drops
        margin = 1e-3 * np.abs(lowest[drops]) + 1e-3 * encounter.gravity[drops]
        here = encounter.under(piece.law).take(drops)
        starts_high = here.acceleration(motion.delta, motion.velocity) if not piece.start.any() else low
        if not (np.minimum(low, starts_high) <= lowest[drops] + margin).any():
            continue  # the peak lies in another stretch
        found, x = _least_acceleration(motion, here)
        better = found < least[drops]
        least[drops[better]] = found[better]
        when[drops[better]] = (piece.start + motion.duration * motion.rule.map_time(x))[better]
    return encounter.mass * (encounter.gravity - np.minimum(least, encounter.gravity)), when


def _sampled(stretch: Stretch) -> Floats:
    """Return the interpolant of the acceleration at evenly spaced x (65, B)."""
    return np.asarray(stretch.rule.dense @ stretch.node_acceleration)


def _least_acceleration(stretch: Stretch, encounter: Encounter) -> tuple[Floats, Floats]:
    """Return the least acceleration in a stretch, of each drop, and its x."""
    rule, values, grid = stretch.rule, stretch.node_acceleration, _sampled(stretch)
    index, column, spacing = grid.argmin(axis=0), np.arange(grid.shape[1]), 1.0 / (len(grid) - 1)
    centre, finer = np.clip(index, 1, len(grid) - 2), spacing / 64.0
    at = centre * spacing + _vertex(grid[centre - 1, column], grid[centre, column], grid[centre + 1, column], spacing)
    at = np.clip(at, finer, 1.0 - finer)
    left, middle, right = _accelerations(stretch, encounter, at + finer * np.array([[-1.0], [0.0], [1.0]]))
    shift = _vertex(left, middle, right, finer)
    lowest = middle + 0.25 * (right - left) * (shift / finer)  # of the parabola, whose error is the cube of its small span

    node = values.argmin(axis=0)  # at the start and the nodes the acceleration is exact
    start = encounter.acceleration(stretch.delta, stretch.velocity)
    candidates = np.stack(
        [start, values[node, column], np.minimum(np.minimum(left, right), np.where(np.abs(shift) < finer, lowest, middle))]
    )
    best = candidates.argmin(axis=0)
    return candidates[best, column], np.stack([np.zeros_like(at), rule.nodes[node], at + shift])[best, column]


def _accelerations(stretch: Stretch, encounter: Encounter, x: Floats) -> Floats:
    """Return the accelerations of each drop at its own few x (k, B)."""
    weights = stretch.rule.weights(x)
    delta = weights[0] * stretch.delta + (weights[1:] * stretch.node_delta[:, None]).sum(axis=0)
    velocity = weights[0] * stretch.velocity + (weights[1:] * stretch.node_velocity[:, None]).sum(axis=0)
    return encounter.acceleration(np.maximum(delta, encounter.floor), velocity)


def _vertex(left: Floats, middle: Floats, right: Floats, spacing: float) -> Floats:
    """Return how far from the middle the vertex lies of the parabola through three points, at most a spacing."""
    with np.errstate(all="ignore"):
        shift = 0.5 * spacing * (left - right) / (left - 2.0 * middle + right)
    return np.where(np.isfinite(shift), np.clip(shift, -spacing, spacing), 0.0)
