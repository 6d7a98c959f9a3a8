"""The collocation rules: exactness and maps."""

from __future__ import annotations

import numpy as np
import pytest

from vibroimpact.dynamics.motion.collocation import collocation_rule


@pytest.mark.parametrize("time_map", ["touch", "inside", "release"])
@pytest.mark.parametrize("root", [2, 4])
def test_rule_integrates_powers_of_its_own_time(time_map: str, root: int) -> None:
    rule = collocation_rule(12, time_map, root)
    x = np.linspace(0.0, 1.0, 7)
    np.testing.assert_allclose(rule.unmap_time(rule.map_time(x)), x, atol=1e-7)
    np.testing.assert_allclose(
        rule.integrate(x, 2.0 * rule.time), rule.map_time(x) ** 2, atol=1e-13
    )
    np.testing.assert_allclose((rule.integral @ np.ones(12)), rule.time, atol=1e-14)
    np.testing.assert_allclose(rule.interpolate(x, rule.nodes**3), x**3, atol=1e-12)
    points = np.concatenate([[0.0], rule.nodes])
    np.testing.assert_allclose(rule.weights(x).T @ points**3, x**3, atol=1e-12)
