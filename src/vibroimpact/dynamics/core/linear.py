"""Linear algebra of a dozen unknowns."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled


@compiled(lambda t: t.void(t.matrix, t.matrix))
def solve_in_place(matrix: Floats, right: Floats) -> None:
    """Solve linear equations by elimination with partial pivoting; both arguments are overwritten,
    `right` by the solutions.

    Parameters
    ----------
    matrix : array, shape (n, n)
        The matrix; NaN comes out where it is singular.
    right : array, shape (n, r)
        The right-hand sides.
    """
    size = len(matrix)
    columns = right.shape[1]
    # of contacts in a row each is joined to its neighbours alone, and most of the matrix is zero:
    # a row has nothing from its extent on
    extent = np.empty(size, np.int64)
    for row in range(size):
        extent[row] = size
        while extent[row] > row + 1 and matrix[row, extent[row] - 1] == 0.0:
            extent[row] -= 1
    for step in range(size):
        pivot = step
        for row in range(step + 1, size):
            if abs(matrix[row, step]) > abs(matrix[pivot, step]):
                pivot = row
        if pivot != step:
            longer = max(extent[step], extent[pivot])
            for column in range(step, longer):
                matrix[step, column], matrix[pivot, column] = (
                    matrix[pivot, column],
                    matrix[step, column],
                )
            for column in range(columns):
                right[step, column], right[pivot, column] = (
                    right[pivot, column],
                    right[step, column],
                )
            extent[step], extent[pivot] = extent[pivot], extent[step]
        inverse = 1.0 / matrix[step, step]
        for row in range(step + 1, size):
            factor = matrix[row, step] * inverse
            if factor != 0.0:
                extent[row] = max(extent[row], extent[step])
                for column in range(step + 1, extent[step]):
                    matrix[row, column] -= factor * matrix[step, column]
                for column in range(columns):
                    right[row, column] -= factor * right[step, column]
    for row in range(size - 1, -1, -1):
        inverse = 1.0 / matrix[row, row]
        for column in range(columns):
            value = right[row, column]
            for later in range(row + 1, extent[row]):
                value -= matrix[row, later] * right[later, column]
            right[row, column] = value * inverse


@compiled(lambda t: t.vector(t.vector, t.matrix, t.vector))
def less_product(values: Floats, matrix: Floats, vector: Floats) -> Floats:
    """Return values less the product of a matrix and a vector."""
    left = np.empty(len(values))
    for row in range(len(values)):
        total = 0.0
        for column in range(len(vector)):
            total += matrix[row, column] * vector[column]
        left[row] = values[row] - total
    return left


@compiled(lambda t: t.void(t.vector, t.vector))
def write_all(values: Floats, written: Floats) -> None:
    """Write values over all of an array of the same length.

    Assignment to a slice takes a second to compile.
    """
    for number in range(len(written)):
        values[number] = written[number]


@compiled(lambda t: t.void(t.matrix, t.integer, t.vector))
def write_row(matrix: Floats, row: int, values: Floats) -> None:
    """Write values into the first columns of a row."""
    for column in range(len(values)):
        matrix[row, column] = values[column]


@compiled(lambda t: t.void(t.cube, t.integer, t.matrix))
def write_layer(cube: Floats, layer: int, values: Floats) -> None:
    """Write the values of a matrix into a layer of a cube."""
    for row in range(values.shape[0]):
        for column in range(values.shape[1]):
            cube[layer, row, column] = values[row, column]


@compiled(lambda t: t.real(t.vector))
def largest_of(values: Floats) -> float:
    """Return the largest value."""
    largest = -np.inf
    for value in values:
        largest = max(largest, value)
    return largest


@compiled(lambda t: t.real(t.vector))
def least_of(values: Floats) -> float:
    """Return the least value; NaN if one is."""
    least = np.inf
    for value in values:
        if not value >= least:
            least = value
        if value != value:
            break
    return least


@compiled(lambda t: t.real(t.vector))
def largest_magnitude_of(values: Floats) -> float:
    """Return the largest magnitude of values; infinite if one is no number."""
    largest = 0.0
    for value in values:
        if not abs(value) <= largest:
            largest = abs(value) if abs(value) < np.inf else np.inf
    return largest


@compiled(lambda t: t.vector(t.matrix, t.vector))
def product(matrix: Floats, vector: Floats) -> Floats:
    """Return the product of a matrix and a vector."""
    found = np.empty(len(matrix))
    for row in range(len(matrix)):
        total = 0.0
        for column in range(len(vector)):
            total += matrix[row, column] * vector[column]
        found[row] = total
    return found
