"""Gauss rules with which the core collocates a phase of a contact, and grids of normal motions."""

from __future__ import annotations

import math
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
# last coefficients of G over the tolerance, so that the largest force, between nodes, is as exact
# as the end
_OF_RATE = 3e3
# last coefficients over the tolerance of a phase that ends within a segment, where the error is of
# their order
_INSIDE = 300.0
# of a contact: three segments of compression, six of restitution, and as many glides
_MOST_PARTS = 15


@cache
def phase_rules(root: int, tolerance: float) -> PhaseRules:
    """Return the rules for laws whose force is smooth in a root of the indentation.

    `tolerance`: relative error allowed of the approach speed.
    """
    number = len(_COUNTS)
    width = max(_COUNTS) + 1
    vectors = np.zeros((number, records.KINDS, records.VECTORS, width))
    matrices = np.zeros((number, records.KINDS, 2, width, width))
    onward = np.zeros((number, width, width))
    coarser_spectrum: Floats | None = None
    for rule, count in enumerate(_COUNTS):
        z, weights = legendre.leggauss(count)
        spectrum = _spectrum(z)
        if coarser_spectrum is not None:
            # interpolation from the nodes of the rule before
            coarser = len(coarser_spectrum)
            interpolation = legendre.legvander(z, coarser - 1) @ coarser_spectrum
            onward[rule, :coarser, :count] = interpolation.T
        coarser_spectrum = spectrum
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


def _spectrum(z: Floats) -> Floats:
    """Return the matrix from values at points in [-1, 1] to Legendre coefficients."""
    matrix: Floats = np.asarray(np.linalg.inv(legendre.legvander(z, len(z) - 1)), dtype=np.float64)
    return matrix


def normal_grid(steps: int) -> NormalGrid:
    """Return the grid of normal motions with some steps in each segment, with arrays of its own.

    `steps` are 0 where no normal motions are asked for.
    """
    derivatives, values, integrals = _grid_matrices(steps)
    nodes, points = values.shape[1:]
    most_points = _MOST_PARTS * (MORE_STEPS * steps + 1)
    return NormalGrid(
        steps=steps,
        derivatives=derivatives,
        values=values,
        integrals=integrals,
        own=np.zeros((2, nodes, points)),
        room=np.zeros((normal_records.GRID_ROWS, max(nodes, points))),
        motion=np.zeros((normal_records.MOTION_ROWS, most_points)),
        parameter=np.zeros(most_points),
        points=np.zeros(1, dtype=np.int64),
    )


@cache
def _grid_matrices(steps: int) -> tuple[Floats, Floats, Floats]:
    """Return the matrices of a `NormalGrid`: derivatives, values and integrals."""
    number = len(_COUNTS)
    width = max(_COUNTS) + 1
    points = math.ceil((MORE_STEPS * steps + 1) / 8) * 8  # they fill vectors of eight
    derivatives = np.zeros((number, width, width))
    values = np.zeros((2 * number, width, points))
    integrals = np.zeros((2 * number, width, points))
    steps_of_grids = (steps, MORE_STEPS * steps) if steps else ()
    for rule, count in enumerate(_COUNTS):
        z, _ = legendre.leggauss(count)
        spectrum = _spectrum(z)
        # with the far end, where the integral ends
        spectrum_with_end = _spectrum(np.append(z, 1.0))
        slopes = 2.0 * legendre.legder(spectrum, axis=0)  # z = 2 y - 1, so that d/dy = 2 d/dz
        of_slopes = legendre.legvander(z, count - 2)
        derivatives[rule, :count, :count] = (of_slopes @ slopes).T
        for finer, grid_steps in enumerate(steps_of_grids):
            y = np.array([graded(point / grid_steps) for point in range(grid_steps + 1)])
            polynomials = legendre.legvander(2.0 * y - 1.0, count)
            of_values = polynomials[:, :count]
            grid = 2 * rule + finer
            number_of_points = len(y)
            values[grid, :count, :number_of_points] = (of_values @ spectrum).T
            integrals[grid, : count + 1, :number_of_points] = (polynomials @ spectrum_with_end).T
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
    touches = kind in (records.TURNING_AT_TOUCH, records.AT_TOUCH, records.AT_TOUCH_INWARD)
    inward = kind in (records.AT_TOUCH_INWARD, records.BETWEEN_INWARD)
    power = root if touches else 1
    count = len(nodes)
    # the nodes, and the end of the segment at which the motion is not known
    far_end = 0.0 if inward else 1.0
    points = np.append(nodes, far_end)
    factor = nodes if turns else np.ones(count)  # f

    vectors[records.PLACE, : count + 1] = points
    distances = 4.0 * (points[:, None] - points)
    vectors[records.BARYCENTRIC, : count + 1] = 1.0 / np.prod(distances + np.eye(count + 1), axis=1)
    vectors[records.FACTOR] = 1.0
    vectors[records.FACTOR, :count] = factor
    vectors[records.PER_FACTOR] = 1.0
    vectors[records.PER_FACTOR, :count] = 1.0 / factor
    # the shape s of the indentation, (1 - y^2)^p, and its slope over f
    vectors[records.SHAPE, :count] = (1.0 - nodes**2) ** power
    known_end = 1.0 if inward else 0.0  # the y at which the motion is known
    vectors[records.SHAPE, count:] = known_end
    vectors[records.FALL, :count] = -2.0 * nodes / factor * power * (1.0 - nodes**2) ** (power - 1)
    vectors[records.WEIGHT, :count] = weights
    vectors[records.LAST, :count] = spectrum[-1]
    vectors[records.BEFORE_LAST, :count] = spectrum[-2]

    integral = _integrals(spectrum, points, known_end)
    to_square = integral
    if turns:
        times_y: Floats = np.stack(
            [legendre.legmul(column, [0.5, 0.5]) for column in spectrum.T], axis=1
        )
        to_square = _integrals(times_y, points, 0.0) / (points**2)[:, None]
    matrices[0, :count, : count + 1] = to_square.T
    matrices[1, :count, : count + 1] = integral.T


def _integrals(series: Floats, points: Floats, start: float) -> Floats:
    """Return the integrals of Legendre series in 2 y - 1, the columns, from `start` to points."""
    integral = legendre.legint(series, lbnd=2.0 * start - 1.0, axis=0)
    polynomials = legendre.legvander(2.0 * points - 1.0, len(integral) - 1)
    return np.asarray(polynomials @ integral / 2.0)
