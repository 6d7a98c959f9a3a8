"""The largest contact force of an impact, from the located extremum."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.dynamics.collocation import collocation_rule
from vibroimpact.dynamics.contact import Contact
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.rigid.stretch import Stretch, WarmStart, acceleration_unit, solve_stretch

_PARABOLAS = 8  # two or three suffice
_COARSE = 1e-6  # relative size of the last coefficients above which the interpolant is not accurate enough for the peak
_FINE = 1.0 / 256.0  # half the span of a parabola, as a part of the spacing of the interpolant


def force_peak(contact: Contact, encounter: Encounter) -> tuple[Floats, Floats]:
    """Return the largest contact force of each drop [N] and its time since first touch [s].

    The acceleration is least there. Its interpolant says where to look, and the law, at the motion there, what
    it is: the motion is an integral, so more exact than the interpolant. Where that is not enough, the motion is
    solved anew up to there.
    """
    size = len(encounter.mass)
    stretches = [(piece, piece.motion) for piece in contact.pieces if isinstance(piece.motion, Stretch)]  # in a glide there is no force
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
        coarse = np.flatnonzero((motion.rule.tail(motion.node_acceleration, np.zeros(len(x))) > _COARSE) & (x > 0.0) & (x < 1.0))
        if coarse.size:
            found[coarse] = _solved_until(motion, here, x, coarse)
        better = found < least[drops]
        least[drops[better]] = found[better]
        when[drops[better]] = (piece.start + motion.duration * motion.rule.map_time(x))[better]
    return encounter.mass * (encounter.gravity - np.minimum(least, encounter.gravity)), when


def _sampled(stretch: Stretch) -> Floats:
    """Return the interpolant of the acceleration at evenly spaced x (65, B)."""
    return np.asarray(stretch.rule.dense @ stretch.node_acceleration)


def _least_acceleration(stretch: Stretch, encounter: Encounter) -> tuple[Floats, Floats]:
    """Return the least acceleration of each drop in a stretch [m/s^2], and its x.

    Parabolas through three points home in on it from where the interpolant is least, until its vertex lies between them.
    """
    rule, values, grid = stretch.rule, stretch.node_acceleration, _sampled(stretch)
    column, spacing = np.arange(grid.shape[1]), 1.0 / (len(grid) - 1)
    centre, finer = np.clip(grid.argmin(axis=0), 1, len(grid) - 2), spacing * _FINE
    at = centre * spacing + _vertex(grid[centre - 1, column], grid[centre, column], grid[centre + 1, column], spacing, spacing)
    node = values.argmin(axis=0)  # at the start and the nodes the acceleration is that of the law
    least, x = encounter.acceleration(stretch.delta, stretch.velocity), np.zeros(len(column))
    least, x = _lower(least, x, values[node, column], rule.nodes[node])
    for _ in range(_PARABOLAS):
        at = np.clip(at, np.maximum(centre - 1.0, _FINE) * spacing, np.minimum(centre + 1.0, len(grid) - 1 - _FINE) * spacing)
        left, middle, right = _accelerations(stretch, encounter, at + finer * np.array([[-1.0], [0.0], [1.0]]))
        shift = _vertex(left, middle, right, finer, spacing)
        inside = np.abs(shift) < finer
        lowest = middle + 0.25 * (right - left) * (shift / finer)  # of the parabola, whose error is the cube of its small span
        least, x = _lower(least, x, np.where(inside, lowest, middle), np.where(inside, at + shift, at))
        if inside.all():
            break
        at = at + shift
    return least, x


def _lower(least: Floats, x: Floats, other: Floats, other_x: Floats) -> tuple[Floats, Floats]:
    """Return the lower of two accelerations, and its place."""
    lower = other < least
    return np.where(lower, other, least), np.where(lower, other_x, x)


def _solved_until(stretch: Stretch, encounter: Encounter, x: Floats, drops: Drops) -> Floats:
    """Return the accelerations of some drops at their x in a stretch, by solving a stretch that ends there.

    The end of a stretch is off by the square of what its inside is off by.
    """
    some = np.zeros(len(x), dtype=bool)
    some[drops] = True
    motion, here, part = stretch.take(some), encounter.take(drops), stretch.rule.map_time(x[drops])
    rule = collocation_rule(len(stretch.rule.nodes), "touch" if stretch.rule.time_map == "touch" else "inside", stretch.rule.root)
    duration = part * motion.duration
    guess = _accelerations(motion, here, stretch.rule.unmap_time(rule.time[:, None] * part))
    start = WarmStart(np.concatenate([guess / acceleration_unit(here, motion.velocity, duration), np.ones((1, len(drops)))]))
    ending = solve_stretch(here, rule, motion.delta, motion.velocity, duration, start, "duration", np.zeros(len(drops)))
    return np.asarray(np.where(ending.solved, ending.node_acceleration[-1], _accelerations(motion, here, x[drops][None])[0]))


def _accelerations(stretch: Stretch, encounter: Encounter, x: Floats) -> Floats:
    """Return the interpolated accelerations of each drop at its own places x (k, B)."""
    weights = stretch.rule.weights(x)
    delta = weights[0] * stretch.delta + (weights[1:] * stretch.node_delta[:, None]).sum(axis=0)
    velocity = weights[0] * stretch.velocity + (weights[1:] * stretch.node_velocity[:, None]).sum(axis=0)
    return encounter.acceleration(np.maximum(delta, encounter.floor), velocity)


def _vertex(left: Floats, middle: Floats, right: Floats, spacing: float, most: float) -> Floats:
    """Return the distance of the minimum of a parabola through three points from the middle one, at most `most`."""
    fall, curvature = left - right, left - 2.0 * middle + right
    with np.errstate(all="ignore"):
        shift = 0.5 * spacing * fall / curvature
    return np.where(curvature > 0.0, np.clip(shift, -most, most), most * np.sign(fall))
