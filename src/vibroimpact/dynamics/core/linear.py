"""Linear algebra of a dozen unknowns."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Cube, Matrix, Vector
from vibroimpact.compiled import compiled


@compiled
def solve_in_place(matrix: Matrix, right: Matrix) -> None:
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


@compiled
def less_product(values: Vector, matrix: Matrix, vector: Vector) -> Vector:
    """Return values less the product of a matrix and a vector."""
    left = np.empty(len(values))
    for row in range(len(values)):
        total = 0.0
        for column in range(len(vector)):
            total += matrix[row, column] * vector[column]
        left[row] = values[row] - total
    return left


@compiled
def write_all(values: Vector, written: Vector) -> None:
    """Write values over all of an array of the same length.

    Assignment to a slice takes a second to compile.
    """
    for number in range(len(written)):
        values[number] = written[number]


@compiled
def write_row(matrix: Matrix, row: int, values: Vector) -> None:
    """Write values into the first columns of a row."""
    for column in range(len(values)):
        matrix[row, column] = values[column]


@compiled
def write_layer(cube: Cube, layer: int, values: Matrix) -> None:
    """Write the values of a matrix into a layer of a cube."""
    for row in range(values.shape[0]):
        for column in range(values.shape[1]):
            cube[layer, row, column] = values[row, column]


@compiled
def largest_of(values: Vector) -> float:
    """Return the largest value."""
    largest = -np.inf
    for value in values:
        largest = max(largest, value)
    return largest


@compiled
def least_of(values: Vector) -> float:
    """Return the least value; NaN if one is."""
    least = np.inf
    for value in values:
        if not value >= least:
            least = value
        if value != value:
            break
    return least


@compiled
def largest_magnitude_of(values: Vector) -> float:
    """Return the largest magnitude of values; infinite if one is no number."""
    largest = 0.0
    for value in values:
        if not abs(value) <= largest:
            largest = abs(value) if abs(value) < np.inf else np.inf
    return largest


@compiled
def product(matrix: Matrix, vector: Vector) -> Vector:
    """Return the product of a matrix and a vector."""
    found = np.empty(len(matrix))
    for row in range(len(matrix)):
        total = 0.0
        for column in range(len(vector)):
            total += matrix[row, column] * vector[column]
        found[row] = total
    return found
