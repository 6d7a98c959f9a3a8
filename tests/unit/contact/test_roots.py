"""Roots for whole arrays at once: against SciPy's brentq on random functions, and on
those that are hard.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

from vibroimpact.contact.roots import find_root, solve_monotonic
from vibroimpact.ranges import Range

SHAPES: dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    "line": lambda x, root: x - root,
    "cubic, flat at its root": lambda x, root: (x - root) ** 3,
    "fifth power, flatter": lambda x, root: (x - root) ** 5,
    "square root, steep at its root": lambda x, root: np.sign(x - root) * np.sqrt(np.abs(x - root)),
    "exponential": lambda x, root: np.exp(3.0 * x) - np.exp(3.0 * root),
    "kink": lambda x, root: np.where(x > root, 100.0 * (x - root), x - root),
    "step": lambda x, root: np.where(x > root, 1.0, -1.0),
    "steep arctangent": lambda x, root: np.arctan(1e4 * (x - root)),
    "wave on a slope": lambda x, root: (x - root) + 0.2 * (np.sin(4.0 * x) - np.sin(4.0 * root)),
    "huge": lambda x, root: 1e200 * (x - root),
    "tiny": lambda x, root: 1e-200 * (x - root),
}


def brackets(seed: int, number: int = 50) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    root = random.uniform(-2.0, 2.0, number)
    return root, root - random.uniform(1e-3, 3.0, number), root + random.uniform(1e-3, 3.0, number)


@pytest.mark.parametrize("shape", SHAPES)
def test_as_brentq_finds_it(shape: str) -> None:
    function = SHAPES[shape]
    root, low, high = brackets(len(shape))
    found = find_root(lambda x: function(x, root), low, high)
    ends = np.maximum(np.abs(low), np.abs(high))
    assert np.all(np.abs(found - root) <= 1e-12 * ends)
    if "flat" not in shape:  # on which brentq does not settle
        each = zip(root, low, high, strict=True)
        theirs = [
            brentq(lambda x, r=r: float(function(np.float64(x), r)), a, b, xtol=1e-15, maxiter=1000)
            for r, a, b in each
        ]
        np.testing.assert_allclose(found, theirs, rtol=0.0, atol=1e-12 * float(ends.max()))


@pytest.mark.parametrize("shape", SHAPES)
def test_it_does_not_matter_which_bracket_is_the_larger(shape: str) -> None:
    root, low, high = brackets(3)
    # falls: it is positive at the smaller
    found = find_root(lambda x: -SHAPES[shape](x, root), high, low)
    assert np.all(np.abs(found - root) <= 1e-12 * np.maximum(np.abs(low), np.abs(high)))


def test_the_function_is_positive_where_it_is_found() -> None:
    """Of the two sides of a step, the one that was asked for, and at most two numbers
    from the other.
    """
    root, low, high = brackets(5)
    found = find_root(lambda x: np.where(x > root, 1.0, -1.0), low, high, tolerance=0.0)
    assert np.all(found > root)
    assert np.all(np.nextafter(np.nextafter(found, -np.inf), -np.inf) <= root)


def test_polynomials_at_random() -> None:
    """Sums of odd powers with positive factors, whose only root is known to brentq alone."""
    random = np.random.default_rng(7)
    factors, shift = 10.0 ** random.uniform(-6.0, 6.0, (3, 200)), random.normal(size=200)

    def function(x: np.ndarray, which: object = slice(None)) -> np.ndarray:
        a, b, c = factors[:, which]
        return a * x + b * x**3 + c * x**5 - shift[which]

    low, high = (
        -np.maximum(1.0, np.abs(shift) / factors[0]),
        np.maximum(1.0, np.abs(shift) / factors[0]),
    )
    found = find_root(function, low, high, tolerance=1e-15)
    theirs = [
        brentq(
            lambda x, i=i: float(function(np.float64(x), i)),
            low[i],
            high[i],
            xtol=1e-300,
            rtol=1e-14,
        )
        for i in range(200)
    ]
    np.testing.assert_allclose(found, theirs, rtol=1e-12)


def test_zeros_at_the_ends() -> None:
    """Zero counts as not positive: the other end moves down to it; where zeros are taken
    as such, it is met exactly.
    """
    low, high = np.array([0.0, -1.0]), np.array([1.0, 0.0])

    def ends(x: np.ndarray) -> np.ndarray:
        return np.where(low == 0.0, x, x + 1.0)

    np.testing.assert_allclose(find_root(ends, low, np.array([1.0, 0.0])), [0.0, -1.0], atol=1e-12)
    assert find_root(ends, low, high, close=1e-12).tolist() == [0.0, -1.0]


def test_one_hard_element_does_not_spoil_the_others() -> None:
    calls = []

    def function(x: np.ndarray) -> np.ndarray:
        calls.append(1)
        return np.where(np.arange(100) == 17, (x - 0.3) ** 9, x - 0.7)

    found = find_root(function, np.zeros(100), np.ones(100))
    assert found[17] == pytest.approx(0.3, abs=1e-12)
    np.testing.assert_allclose(np.delete(found, 17), 0.7, rtol=1e-12)
    assert len(calls) < 200


def test_close_is_a_bound_of_the_function() -> None:
    random = np.random.default_rng(1)
    root = random.uniform(0.1, 0.9, 50)
    found = find_root(lambda x: 1e3 * (x**3 - root**3), np.zeros(50), np.ones(50), close=1e-6)
    assert np.all(np.abs(1e3 * (found**3 - root**3)) < 1e-6)


def test_no_more_calls_than_bisection() -> None:
    """However badly a function is behaved: about fifty halvings find a double, and three
    times as many calls are the worst.
    """
    for name, function in SHAPES.items():
        root, low, high = brackets(11)
        calls = []

        def counted(
            x: np.ndarray,
            function: Callable = function,
            calls: list = calls,
            root: np.ndarray = root,
        ) -> np.ndarray:
            calls.append(1)
            return function(x, root)

        find_root(counted, low, high)
        assert len(calls) < 150, name


# --- solve_monotonic
#
#
#
# ---------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("falls", [False, True])
def test_wanted_values_over_many_orders_of_magnitude(seed: int, falls: bool) -> None:
    """Saturating functions whose scale is up to ten decades from where one begins."""
    random = np.random.default_rng(seed)
    scale, start = 10.0 ** random.uniform(-5.0, 5.0, 100), 10.0 ** random.uniform(-5.0, 5.0, 100)
    wanted = random.uniform(0.05, 0.95, 100)
    rise = (lambda x: 1.0 / (1.0 + x / scale)) if falls else (lambda x: x / (x + scale))
    exact = scale * (1.0 / wanted - 1.0) if falls else scale * wanted / (1.0 - wanted)
    found = solve_monotonic(rise, wanted, start, Range(at_least=0), falls=falls)
    np.testing.assert_allclose(found.place, exact, rtol=1e-9)
    assert np.all(found.least <= wanted)
    assert np.all(found.most >= wanted)


def test_what_is_out_of_reach_is_told_and_the_others_are_found() -> None:
    wanted = np.array([0.5, 1.5, -0.1, 0.25])
    found = solve_monotonic(
        lambda x: 1.0 / (1.0 + x), wanted, np.ones(4), Range(at_least=0), falls=True
    )
    assert np.isnan(found.place).tolist() == [False, True, True, False]
    np.testing.assert_allclose(found.place[[0, 3]], [1.0, 3.0], rtol=1e-9)
    assert found.most[1] == 1.0
    assert np.all(found.least >= 0.0)
    nothing = solve_monotonic(
        lambda x: 1.0 / (1.0 + x), np.array([2.0, 3.0]), np.ones(2), Range(at_least=0), falls=True
    )
    assert np.isnan(nothing.place).all()


@pytest.mark.parametrize("allowed", [Range(at_least=0, at_most=1), Range(above=0, at_most=1)])
def test_ends_of_the_range(allowed: Range) -> None:
    """What is wanted at an end that belongs to the range is found there, and nothing
    outside the range is ever tried.
    """

    def inside(x: np.ndarray) -> np.ndarray:
        assert np.all((x >= 0.0) & (x <= 1.0))
        return x * x

    found = solve_monotonic(inside, np.array([0.0, 1.0, 0.25]), np.full(3, 0.3), allowed)
    assert found.place[2] == pytest.approx(0.5, rel=1e-9)
    if allowed.at_most == 1:
        assert found.place[1] == pytest.approx(1.0, rel=1e-9)
    if allowed.at_least == 0:
        assert found.place[0] == pytest.approx(0.0, abs=1e-5)


def test_values_that_can_not_be_computed_are_passed_over() -> None:
    """NaN below 0.1 in some elements, and everywhere in one."""
    bad = np.arange(4) == 2

    def function(x: np.ndarray) -> np.ndarray:
        return np.where(
            bad | ((np.arange(4) > 2) & (x < 0.1)), np.nan, np.log(np.maximum(x, 1e-300))
        )

    found = solve_monotonic(function, np.full(4, 1.0), np.full(4, 0.5), Range(above=0))
    assert np.isnan(found.place).tolist() == [False, False, True, False]
    np.testing.assert_allclose(np.delete(found.place, 2), np.e, rtol=1e-9)


def test_flat_where_it_begins() -> None:
    """A value that only counts beyond a threshold, as a damping that is cut off: flat on
    both sides of a slope.
    """
    found = solve_monotonic(
        lambda x: 1.0 - np.clip(np.log10(x / 1e3), 0.0, 1.0),
        np.array([0.3, 0.9]),
        np.ones(2),
        Range(above=0),
    )
    np.testing.assert_allclose(found.place, [10.0**3.7, 10.0**3.1], rtol=1e-8)


def test_what_has_a_bracket_is_not_taken_to_extremes() -> None:
    """The search for one that is out of reach does not slow down the others."""
    largest = np.zeros(2)

    def function(values: np.ndarray) -> np.ndarray:
        np.maximum(largest, values, out=largest)
        return values / (1.0 + values)

    roots = solve_monotonic(function, np.array([0.9, 1.1]), np.ones(2), Range(at_least=0))
    assert roots.place[0] == pytest.approx(9.0)
    assert np.isnan(roots.place[1])
    assert largest[0] <= 16.0
    assert largest[1] > 1e9
