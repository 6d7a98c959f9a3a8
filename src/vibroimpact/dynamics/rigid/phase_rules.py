"""The Gauss rules with which the core collocates a phase of a contact, and the grids on
which it writes the normal motion.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core import normal_records
from vibroimpact.dynamics.core import phase_records as records
from vibroimpact.dynamics.core.normal_motion import graded
from vibroimpact.dynamics.core.normal_records import MORE_STEPS, NormalGrid
from vibroimpact.dynamics.core.phase_records import PhaseRules

_COUNTS = (15, 23, 31)  # with the far end they fill vectors of eight
# power of the tolerance: the error at the ends is of the order of the square of the last
# coefficient
_ROUGHNESS = 0.5
# tolerances: last coefficients of G, so that the largest force, between nodes, is as exact as the
# end
_OF_RATE = 3e3
# tolerances: last coefficients of a phase that ends within a segment, where the error is of their
# order
_INSIDE = 300.0
# of a contact: three segments of compression, six of restitution, and as many glides
_MOST_PARTS = 15


@cache
def phase_rules(root: int, tolerance: float) -> PhaseRules:
    """Return the rules for laws whose force is smooth in a root of the indentation, at a
    relative error of the approach speed.
    """
    number, width = len(_COUNTS), max(_COUNTS) + 1
    vectors = np.zeros((number, records.KINDS, records.VECTORS, width))
    matrices = np.zeros((number, records.KINDS, 2, width, width))
    onward = np.zeros((number, width, width))
    before: Floats | None = None
    for rule, count in enumerate(_COUNTS):
        z, weights = legendre.leggauss(count)
        spectrum: Floats = np.asarray(
            np.linalg.inv(legendre.legvander(z, count - 1)), dtype=np.float64
        )
        if before is not None:
            onward[rule, : len(before), :count] = (
                legendre.legvander(z, len(before) - 1) @ before
            ).T
        before = spectrum
        for kind in range(records.KINDS):
            _write_kind(
                kind,
                root,
                0.5 * (z + 1.0),
                0.5 * weights,
                spectrum,
                vectors[rule, kind],
                matrices[rule, kind],
            )
    return PhaseRules(
        tolerance=tolerance,
        roughness=tolerance**_ROUGHNESS,
        roughness_inside=min(tolerance**_ROUGHNESS, _INSIDE * tolerance),
        sharper=max(tolerance ** (_ROUGHNESS - 1.0) / _OF_RATE, 1.0),
        root=root,
        counts=np.array(_COUNTS),
        vectors=vectors.reshape(-1, records.VECTORS, width),
        matrices=matrices.reshape(-1, width, width),
        onward=onward,
    )


def normal_grid(steps: int) -> NormalGrid:
    """Return the grid of normal motions with some steps in each segment, with room of its
    own; 0 where none are asked for.
    """
    derivatives, values, integrals = _grid_matrices(steps)
    nodes, points = values.shape[1:]
    return NormalGrid(
        steps=steps,
        derivatives=derivatives,
        values=values,
        integrals=integrals,
        own=np.zeros((2, nodes, points)),
        room=np.zeros((normal_records.GRID_ROWS, max(nodes, points))),
        motion=np.zeros((normal_records.MOTION_ROWS, _MOST_PARTS * (MORE_STEPS * steps + 1))),
        extent=np.zeros(2, dtype=np.int64),
    )


@cache
def _grid_matrices(steps: int) -> tuple[Floats, Floats, Floats]:
    """Return the matrices of a `NormalGrid`."""
    number, width = len(_COUNTS), max(_COUNTS) + 1
    points = -(-(MORE_STEPS * steps + 1) // 8) * 8
    derivatives = np.zeros((number, width, width))
    values, integrals = np.zeros((2, 2 * number, width, points))
    for rule, count in enumerate(_COUNTS):
        z, _ = legendre.leggauss(count)
        spectrum: Floats = np.asarray(
            np.linalg.inv(legendre.legvander(z, count - 1)), dtype=np.float64
        )
        slopes = 2.0 * legendre.legder(spectrum, axis=0)
        derivatives[rule, :count, :count] = (legendre.legvander(z, count - 2) @ slopes).T
        ends = np.append(z, 1.0)
        of_ends: Floats = np.asarray(
            np.linalg.inv(legendre.legvander(ends, count)), dtype=np.float64
        )
        for finer, number_of_steps in enumerate((steps, MORE_STEPS * steps) if steps else ()):
            y = np.array([graded(point / number_of_steps) for point in range(number_of_steps + 1)])
            at = legendre.legvander(2.0 * y - 1.0, count)
            values[2 * rule + finer, :count, : len(y)] = (at[:, :count] @ spectrum).T
            integrals[2 * rule + finer, : count + 1, : len(y)] = (at @ of_ends).T
    return derivatives, values, integrals


def _write_kind(
    kind: int,
    root: int,
    nodes: Floats,
    weights: Floats,
    spectrum: Floats,
    vectors: Floats,
    matrices: Floats,
) -> None:
    """Write vectors (9, M) and matrices (2, M, M) of a kind of segment.

    `spectrum`: from values at the nodes to Legendre coefficients.
    """
    turns = kind in (records.TURNING_AT_TOUCH, records.TURNING)
    inward = kind in (records.AT_TOUCH_INWARD, records.BETWEEN_INWARD)
    power = (
        root if kind in (records.TURNING_AT_TOUCH, records.AT_TOUCH, records.AT_TOUCH_INWARD) else 1
    )
    count, far = len(nodes), 0.0 if inward else 1.0
    places = np.append(nodes, far)
    factor = nodes if turns else np.ones(count)
    place, barycentric, factors, per_factor, shape, fall, weight, last, before_last = vectors
    place[: count + 1] = places
    barycentric[: count + 1] = 1.0 / np.prod(
        4.0 * (places[:, None] - places) + np.eye(count + 1), axis=1
    )
    factors[:] = per_factor[:] = 1.0
    factors[:count] = factor
    per_factor[:count] = 1.0 / factor
    shape[:count] = (1.0 - nodes**2) ** power
    shape[count:] = 1.0 if inward else 0.0
    fall[:count] = -2.0 * nodes / factor * power * (1.0 - nodes**2) ** (power - 1)
    weight[:count] = weights
    before_last[:count], last[:count] = spectrum[-2:]
    integral = to_square = _integrals(spectrum, places, 1.0 if inward else 0.0)
    if turns:
        times_y: Floats = np.stack(
            [legendre.legmul(column, [0.5, 0.5]) for column in spectrum.T], axis=1
        )
        to_square = _integrals(times_y, places, 0.0) / (places**2)[:, None]
    for matrix, values in zip(matrices, (to_square, integral), strict=True):
        matrix[:count, : count + 1] = values.T


def _integrals(series: Floats, places: Floats, start: float) -> Floats:
    """Return the integrals of Legendre series in 2 y - 1, the columns, from `start` to places."""
    whole = legendre.legint(series, lbnd=2.0 * start - 1.0, axis=0)
    return np.asarray(legendre.legvander(2.0 * places - 1.0, len(whole) - 1) @ whole / 2.0)
