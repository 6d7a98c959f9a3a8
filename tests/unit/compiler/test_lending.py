"""Named tuples that compiled functions lend each other: read, kept, returned, and from Python."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from vibroimpact.arrays import Matrix, Vector
from vibroimpact.compiled import Lent, compiled, why_not_compiled

needs_compiler = pytest.mark.skipif(bool(why_not_compiled()), reason=why_not_compiled())


class Inner(NamedTuple):
    """Two numbers and an array."""

    values: Vector
    is_marked: bool
    number: int


class Outer(NamedTuple):
    """A tuple in a tuple, beside an array and numbers; booleans are shorter than the rest."""

    is_first: bool
    is_second: bool
    inner: Inner
    matrix: Matrix
    factor: float


@compiled
def weighted(inner: Inner, factor: float) -> float:
    total = 0.0
    for number in range(len(inner.values)):
        total += factor * inner.values[number]
    return total + inner.number + (100.0 if inner.is_marked else 0.0)


@compiled
def with_more(outer: Outer, keeps: bool) -> Outer:
    if keeps:
        return outer  # a tuple that was lent
    more = Inner(outer.inner.values + 1.0, not outer.inner.is_marked, outer.inner.number + 1)
    return Outer(not outer.is_first, outer.is_second, more, outer.matrix, outer.factor)


@compiled
def around(inner: Inner, outer: Outer) -> Outer:
    return Outer(True, False, inner, outer.matrix, outer.factor)  # one that was lent is a member


@compiled
def told(outer: Lent[Outer], inner: Inner, steps: int) -> Vector:
    now = with_more(outer, False)
    for step in range(steps):  # either lent or its own
        now = with_more(now, step % 2 == 0)
        if step == 3:
            inner = now.inner
    last = around(inner, now)
    return np.array(
        [
            weighted(outer.inner, outer.factor),
            weighted(now.inner, now.factor),
            weighted(inner, 2.0),
            weighted(last.inner, last.factor),
            outer.matrix[1, 0] + now.matrix[0, 1],
            1.0 * outer.is_first + 2.0 * outer.is_second + 4.0 * now.is_first,
        ]
    )


@compiled
def doubled(outer: Lent[Outer]) -> None:
    for number in range(len(outer.inner.values)):
        outer.inner.values[number] *= 2.0


def an_outer():
    inner = Inner(np.array([1.0, 2.0, 4.0]), True, 7)
    return Outer(False, True, inner, np.array([[1.0, 2.0], [3.0, 4.0]]), 0.5)


@needs_compiler
@pytest.mark.parametrize("steps", [0, 1, 4, 5])
def test_tuples_that_are_lent_are_read_kept_and_returned(steps):
    inner = Inner(np.array([5.0]), False, 2)
    expected = told.py_func(an_outer(), inner, steps)
    np.testing.assert_array_equal(told(an_outer(), inner, steps), expected)


@needs_compiler
def test_arrays_of_a_tuple_that_python_lends_are_written():
    outer = an_outer()
    doubled(outer)
    assert outer.inner.values.tolist() == [2.0, 4.0, 8.0]


@needs_compiler
@pytest.mark.parametrize(
    "matrix",
    [
        np.ones((2, 2), dtype=np.int64),
        np.ones(4),
        np.ones((2, 4))[:, ::2],
        np.ones((2, 2)).T * [[1]],
    ],
    ids=["whole numbers", "one dimension", "with gaps", "by columns"],
)
def test_other_arrays_are_refused(matrix):
    outer = an_outer()._replace(matrix=np.asfortranarray(matrix) if matrix.ndim == 2 else matrix)
    with pytest.raises(TypeError, match="matrix cannot be an array"):
        doubled(outer)


class Weights(NamedTuple):
    """Numbers that nobody changes."""

    values: Vector

    @property
    def is_constant(self) -> bool:
        return True


@compiled
def weighted_sum(weights: Lent[Weights], outer: Lent[Outer]) -> float:
    return float(weights.values @ outer.inner.values)


@needs_compiler
def test_constants_are_packed_once_and_kept() -> None:
    for factor in (1.0, 2.0):
        weights = Weights(factor * np.ones(3))
        for _ in range(3):
            assert weighted_sum(weights, an_outer()) == 7.0 * factor
        del weights
    constant, other = weighted_sum.compiled._packings  # type: ignore[attr-defined]
    assert len(constant._packed_for_good) == 2
    assert not other._packed_for_good
