"""Indices of sensitivity against functions whose indices are known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from agreement import Against, Agrees
from vibroimpact.studies.designs.saltelli import plan
from vibroimpact.studies.planning.axes import Spaced
from vibroimpact.studies.planning.design import Asked
from vibroimpact.studies.report.sensitivity import sobol_indices

AGAINST = Against(
    "functions with known Sobol indices",
    "closed form",
    "calibration, identification and studies",
    "Ishigami and Homma 1990; sums and products of uniform variables",
)


POINTS = 8192


def drawn(axes: int, low: float, high: float) -> np.ndarray:
    columns = plan(
        Asked({str(place): Spaced(low, high, 2) for place in range(axes)}, POINTS, 7)
    ).columns
    return np.array([np.asarray(values, dtype=float) for values in columns.values()])


def ishigami(x: np.ndarray) -> np.ndarray:
    return np.sin(x[0]) + 7.0 * np.sin(x[1]) ** 2 + 0.1 * x[2] ** 4 * np.sin(x[0])


def closed_form_of_ishigami() -> tuple[np.ndarray, np.ndarray]:
    """Ishigami and Homma (1990), with a = 7 and b = 0.1: the variances of the parts of
    the function.
    """
    a, b = 7.0, 0.1
    first = 0.5 * (1.0 + b * np.pi**4 / 5.0) ** 2
    second = a**2 / 8.0
    together = b**2 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)  # of the first with the third
    whole = first + second + together
    return np.array([first, second, 0.0]) / whole, np.array(
        [first + together, second, together]
    ) / whole


def test_ishigami(agrees: Agrees) -> None:
    found = sobol_indices(ishigami(drawn(3, -np.pi, np.pi)), 3)
    assert found is not None
    first, total = closed_form_of_ishigami()
    agrees(
        "Ishigami function, 8192 samples",
        "first-order Sobol indices",
        found.first,
        first,
        absolute=0.01,
    )
    agrees(
        "Ishigami function, 8192 samples",
        "total-effect Sobol indices",
        found.total,
        total,
        absolute=0.01,
    )
    # the interval holds the truth, and is not so wide as to say nothing
    assert np.all(np.abs(found.first - first) <= found.first_error)
    assert np.all(np.abs(found.total - total) <= found.total_error)
    assert found.first_error.max() < 0.04
    assert found.total_error.max() < 0.05


def test_sum_of_axes_has_the_indices_of_its_variances(agrees: Agrees) -> None:
    x = drawn(4, 0.0, 1.0)
    weights = np.array([1.0, 2.0, 3.0, 0.0])
    found = sobol_indices(weights @ x, 4)
    assert found is not None
    expected = weights**2 / np.sum(weights**2)
    agrees(
        "weighted sum of uniform variables",
        "first-order Sobol indices",
        found.first,
        expected,
        absolute=2e-3,
    )
    agrees(
        "weighted sum of uniform variables",
        "total-effect Sobol indices",
        found.total,
        expected,
        absolute=2e-3,
    )


def test_product_of_two_axes_matters_only_together(agrees: Agrees) -> None:
    x = drawn(2, -1.0, 1.0)
    found = sobol_indices(x[0] * x[1], 2)  # neither does anything by itself
    assert found is not None
    agrees(
        "product of two uniform variables",
        "first-order Sobol indices",
        found.first,
        [0.0, 0.0],
        absolute=0.02,
    )
    agrees(
        "product of two uniform variables",
        "total-effect Sobol indices",
        found.total,
        [1.0, 1.0],
        absolute=0.02,
    )


@pytest.mark.slow
def test_width_of_the_interval_is_the_scatter_over_independent_draws() -> None:
    estimates, errors = [], []
    for draw in range(60):
        blocks = np.random.default_rng(draw).uniform(-np.pi, np.pi, (2, 3, 512))
        mixed = [np.where(np.arange(3)[:, None] == axis, blocks[1], blocks[0]) for axis in range(3)]
        found = sobol_indices(
            np.concatenate([ishigami(points) for points in (*blocks, *mixed)]), 3, seed=draw
        )
        assert found is not None
        estimates.append(found.total)
        errors.append(found.total_error)
    scatter = 1.96 * np.std(estimates, axis=0, ddof=1)
    # 60 draws know their scatter to a tenth
    assert np.mean(errors, axis=0) == pytest.approx(scatter, rel=0.25)


def test_points_left_out_leave_the_indices_of_the_others() -> None:
    values = ishigami(drawn(3, -np.pi, np.pi))
    whole = sobol_indices(values, 3)
    missing = values.reshape(5, -1).copy()
    missing[0, 10:60] = np.nan
    missing[3, 100:200] = np.nan
    found = sobol_indices(missing.ravel(), 3)
    assert whole is not None
    assert found is not None
    assert (found.points, found.left_out) == (POINTS - 150, 150)
    complete = np.isfinite(missing).all(axis=0)
    a, b, *mixed = missing[:, complete]
    variance = np.var(np.concatenate([a, b]))
    assert found.first == pytest.approx(
        [np.mean((b - np.mean([a, b])) * (one - a)) / variance for one in mixed], rel=1e-9
    )
    assert found.total == pytest.approx(
        [0.5 * np.mean((one - a) ** 2) / variance for one in mixed], rel=1e-9
    )
    missing[1, : POINTS // 19] = np.nan
    assert sobol_indices(missing.ravel(), 3) is None


def test_what_does_not_vary_has_no_indices() -> None:
    assert sobol_indices(np.full(4 * 64, 0.7), 2) is None
