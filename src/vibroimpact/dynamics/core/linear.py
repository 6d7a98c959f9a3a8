"""Linear algebra of a dozen unknowns."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import compiled


@compiled(lambda t: t.void(t.matrix, t.matrix))
def solve_in_place(matrix: Floats, right: Floats) -> None:
    """Solve linear equations by elimination with partial pivoting; both arguments are overwritten, `right` by the solutions.

    Parameters
    ----------
    matrix : array, shape (n, n)
        The matrix; NaN comes out where it is singular.
    right : array, shape (n, r)
        The right-hand sides.
    """
    size = len(matrix)
    columns = right.shape[1]
    for step in range(size):
        pivot = step
        for row in range(step + 1, size):
            if abs(matrix[row, step]) > abs(matrix[pivot, step]):
                pivot = row
        if pivot != step:
            for column in range(step, size):
                matrix[step, column], matrix[pivot, column] = matrix[pivot, column], matrix[step, column]
            for column in range(columns):
                right[step, column], right[pivot, column] = right[pivot, column], right[step, column]
        inverse = 1.0 / matrix[step, step]
        for row in range(step + 1, size):
            factor = matrix[row, step] * inverse
            if factor != 0.0:
                for column in range(step + 1, size):
                    matrix[row, column] -= factor * matrix[step, column]
                for column in range(columns):
                    right[row, column] -= factor * right[step, column]
    for row in range(size - 1, -1, -1):
        inverse = 1.0 / matrix[row, row]
        for column in range(columns):
            value = right[row, column]
            for later in range(row + 1, size):
                value -= matrix[row, later] * right[later, column]
            right[row, column] = value * inverse


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
