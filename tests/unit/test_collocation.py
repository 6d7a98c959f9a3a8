"""The collocation rules: exactness, maps, and the order of convergence by regression."""

from __future__ import annotations

import numpy as np
import pytest

from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.dynamics.collocation import collocation_rule
from vibroimpact.dynamics.encounter import encounter_of
from vibroimpact.dynamics.rigid.stretch import WarmStart, acceleration_unit, solve_stretch

ENCOUNTER = encounter_of(LankaraniNikravesh(stiffness=1.0, restitution=0.5), np.ones(1), np.full(1, 1e-3), np.ones(1))
NOTHING = np.zeros(1)


def march(delta: float, velocity: float, duration: float, nodes: int, stretches: int, first_map: str = "inside") -> np.ndarray:
    """Integrate in stretches of equal duration; return indentation and rate at the end."""
    state = np.array([delta]), np.array([velocity])
    for number in range(stretches):
        rule = collocation_rule(nodes, first_map if number == 0 else "inside")
        length = np.full(1, duration / stretches)
        guess = ENCOUNTER.acceleration(np.repeat(state[0][None], nodes, 0), np.repeat(state[1][None], nodes, 0))
        unknowns = np.concatenate([guess / acceleration_unit(ENCOUNTER, state[1], length), np.ones((1, 1))])
        stretch = solve_stretch(ENCOUNTER, rule, *state, length, WarmStart(unknowns), "duration", NOTHING)
        assert stretch.solved.all()
        state = stretch.node_delta[-1], stretch.node_velocity[-1]
    return np.concatenate(state)


@pytest.mark.parametrize("time_map", ["touch", "inside", "release"])
@pytest.mark.parametrize("root", [2, 4])
def test_rule_integrates_powers_of_its_own_time(time_map: str, root: int) -> None:
    rule = collocation_rule(12, time_map, root)
    x = np.linspace(0.0, 1.0, 7)
    np.testing.assert_allclose(rule.unmap_time(rule.map_time(x)), x, atol=1e-7)
    np.testing.assert_allclose(rule.integrate(x, 2.0 * rule.time), rule.map_time(x) ** 2, atol=1e-13)
    np.testing.assert_allclose((rule.integral @ np.ones(12)), rule.time, atol=1e-14)
    np.testing.assert_allclose(rule.interpolate(x, rule.nodes**3), x**3, atol=1e-12)
    points = np.concatenate([[0.0], rule.nodes])
    np.testing.assert_allclose(rule.weights(x).T @ points**3, x**3, atol=1e-12)


@pytest.mark.parametrize("nodes", [2, 3, 4])
def test_order_is_twice_the_nodes_less_one(nodes: int) -> None:
    exact = march(0.5, 0.8, 1.0, 14, 4)
    counts = np.array([4, 6, 8, 12, 16])
    errors = [np.abs(march(0.5, 0.8, 1.0, nodes, count) - exact).max() for count in counts]
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order == pytest.approx(2 * nodes - 1, abs=0.25)


@pytest.mark.parametrize("nodes", [2, 3, 4])
def test_map_gives_back_the_order_lost_at_first_touch(nodes: int) -> None:
    """The error of one stretch from first touch, against the root of its duration: delta^1.5 is not smooth in time."""
    durations = np.array([0.025, 0.05, 0.1, 0.2])
    slopes = {}
    for time_map in ("touch", "inside"):
        errors = [
            np.abs(march(0.0, 1.0, duration, nodes, 1, time_map) - march(0.0, 1.0, duration, 20, 1, "touch")).max()
            for duration in durations
        ]
        slopes[time_map] = np.polyfit(np.log(np.sqrt(durations)), np.log(errors), 1)[0]
    assert slopes["touch"] > 2 * nodes
    assert slopes["inside"] == pytest.approx(5.0, abs=0.15)  # that of a quadrature of t^1.5, whatever the nodes


def test_sixteen_nodes_are_exact_to_rounding() -> None:
    coarse, fine = march(0.0, 1.0, 1.0, 16, 1, "touch"), march(0.0, 1.0, 1.0, 24, 1, "touch")
    np.testing.assert_allclose(coarse, fine, rtol=1e-13)
