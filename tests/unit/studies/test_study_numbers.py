"""How results spread, how their ranks follow those of a key, and how far they move along
an axis of a grid.
"""

from __future__ import annotations

import numpy as np
import pytest

from vibroimpact.studies.report.percentiles import spread_of
from vibroimpact.studies.report.sensitivity import one_at_a_time, rank_correlations


def test_spread_is_numpys_and_passes_over_what_is_not_there() -> None:
    values = np.random.default_rng(1).lognormal(size=1001)
    kept = values.copy()
    found = spread_of(np.append(values, [np.nan, np.inf]))
    assert np.array_equal(values, kept)
    assert found.drops == 1001
    assert found.mean == pytest.approx(values.mean(), rel=1e-12)
    assert found.standard_deviation == pytest.approx(values.std(ddof=1), rel=1e-12)
    assert found.percentiles == pytest.approx(np.percentile(values, [5, 25, 50, 75, 95]), rel=1e-12)
    assert spread_of(np.array([np.nan])).drops == 0
    assert not spread_of(np.full(5, 0.1)).varies


def test_ranks_know_order_alone() -> None:
    drops = np.random.default_rng(2).uniform(1.0, 2.0, (2, 500))
    found = rank_correlations(drops, np.append(np.exp(-9.0 * drops[0, :-1]), np.nan))
    assert found[0] == pytest.approx(-1.0)
    assert abs(found[1]) < 0.15
    assert np.isnan(rank_correlations(drops, np.ones(500))).all()


def test_one_at_a_time_is_about_the_middle_of_sorted_levels() -> None:
    levels = np.array([3.0, 1.0, 2.0])
    found = one_at_a_time(
        levels[:, None] * np.array([10.0, 20.0, np.nan]), [np.argsort(levels), np.array([0, 1, 2])]
    )
    assert (found.middle, found.lowest.tolist(), found.highest.tolist()) == (
        40.0,
        [20.0, 20.0],
        [60.0, 40.0],
    )
    assert found.relative.tolist() == [1.0, 0.5]
