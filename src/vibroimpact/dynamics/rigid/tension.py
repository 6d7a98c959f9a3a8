"""Tension within a stretch, also between nodes: the force of a law whose tension is cut is zero from there on."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.rigid.stretch import Stretch


def first_tension(encounter: Encounter, stretch: Stretch, *, on_the_way_out: bool = False) -> Floats:
    """Return the x of the first tension in a stretch beyond rounding (b,); infinite where there is none.

    With `on_the_way_out` the stretch ends at next to no indentation, where a law that ends with its force should not have come.
    """
    pulls = _at_nodes(encounter, stretch)
    if on_the_way_out and encounter.law.contact_end == "zero-force":
        delta = encounter.floor + 1e-3 * (stretch.node_delta[-2] - encounter.floor)
        pulls[-2] |= encounter.acceleration(delta, stretch.node_velocity[-1]) > encounter.gravity
    at_node = np.where(pulls.any(axis=0), stretch.rule.nodes[pulls.argmax(axis=0)], np.inf)
    return np.asarray(np.minimum(at_node, _between_nodes(encounter, stretch)))


def tensile_before_end(encounter: Encounter, stretch: Stretch) -> Bools:
    """Return whether the force is tensile before the end of the stretch."""
    return np.asarray(_at_nodes(encounter, stretch)[:-1].any(axis=0) | np.isfinite(_between_nodes(encounter, stretch)))


def _at_nodes(encounter: Encounter, stretch: Stretch) -> Bools:
    return np.asarray(stretch.node_acceleration > encounter.gravity + _rounding(encounter, stretch))


def _between_nodes(encounter: Encounter, stretch: Stretch) -> Floats:
    """Return the x of the first maximum of the tension; its height is that of parabolas through evenly spaced points."""
    rule = stretch.rule
    delta, velocity = np.maximum(rule.dense @ stretch.node_delta, encounter.floor), rule.dense @ stretch.node_velocity
    pull = encounter.acceleration(delta, velocity) - encounter.gravity
    left, middle, right = pull[:-2], pull[1:-1], pull[2:]
    bend = 2.0 * middle - left - right
    with np.errstate(all="ignore"):
        height, shift = middle + 0.125 * (right - left) ** 2 / bend, 0.5 * (right - left) / bend
    pulls = (middle >= left) & (middle >= right) & (bend > 0.0) & (height > _rounding(encounter, stretch))
    index = pulls.argmax(axis=0)
    return np.where(pulls.any(axis=0), (index + 1.0 + shift[index, np.arange(len(index))]) / (len(pull) - 1), np.inf)


def _rounding(encounter: Encounter, stretch: Stretch) -> Floats:
    """Return the rounding error of an acceleration [m/s^2]."""
    return np.asarray(1e-11 * (np.abs(stretch.node_acceleration).max(axis=0) + encounter.approach_speed / stretch.duration))
