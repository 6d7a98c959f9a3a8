"""Spheres that slip and roll on a plate, against closed forms of rigid bodies and against SciPy's integration of their equations."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from vibroimpact.arrays import Floats
from vibroimpact.dynamics.oblique.rolling import slide_and_roll
from vibroimpact.dynamics.oblique.state import Sphere, State

RADIUS, MASS, GRAVITY = 0.02, 0.3, 9.81


def after(time: float, velocity: Any, spin: Any = (0.0, 0.0, 0.0), mu: float = 0.1, angle: float = 0.0) -> tuple[State, Floats]:
    """Return the state of a sphere on a plate inclined about y, which began at the origin, and the friction force."""
    one = np.ones(1)
    along = np.array([[GRAVITY * np.sin(angle)], [0.0]])
    ball = Sphere(MASS * one, RADIUS * one, 0.4 * MASS * RADIUS**2 * one, along)
    start = State(np.zeros((2, 1)), np.array(velocity, dtype=float)[:, None], np.array(spin, dtype=float)[:, None])
    return slide_and_roll(ball, start, mu, GRAVITY * np.cos(angle) * one, time * one)


def test_sliding_ends_in_rolling_with_five_sevenths() -> None:
    """After 2 v / (7 mu g) the sphere rolls; until then it has gone 12 v^2 / (49 mu g)."""
    until = 2.0 * 1.4 / (7.0 * 0.1 * GRAVITY)
    state, _ = after(until, (1.4, 0.0))
    assert state.velocity[:, 0] == pytest.approx([1.0, 0.0], abs=1e-12)
    assert state.position[0, 0] == pytest.approx(12.0 * 1.4**2 / (49.0 * 0.1 * GRAVITY), rel=1e-12)
    later, force = after(until + 2.0, (1.4, 0.0))
    assert later.position[0, 0] == pytest.approx(state.position[0, 0] + 2.0, rel=1e-12)
    assert later.spin[1, 0] == pytest.approx(1.0 / RADIUS, rel=1e-12)
    assert force[0, 0] == 0.0


def test_back_spin_brings_the_sphere_back() -> None:
    """With the spin -5 v / R the slip is six times the velocity, and the sphere rolls back with 1 - 6 2/7 of it."""
    state, _ = after(10.0, (1.0, 0.0), (0.0, -5.0 / RADIUS, 0.0))
    assert state.velocity[0, 0] == pytest.approx(1.0 - 6.0 * 2.0 / 7.0, rel=1e-12)


@pytest.mark.parametrize("mu", [0.5, 0.12, 0.02])
def test_down_an_incline(mu: float) -> None:
    """It rolls with 5/7 g sin; or slips, where 2/7 tan exceeds the coefficient, with g (sin - mu cos)."""
    angle, time = np.radians(25.0), 1.7
    state, force = after(time, (0.0, 0.0), mu=mu, angle=angle)
    rolls = 2.0 / 7.0 * np.tan(angle) <= mu
    down = GRAVITY * (5.0 / 7.0 * np.sin(angle) if rolls else np.sin(angle) - mu * np.cos(angle))
    assert state.velocity[0, 0] == pytest.approx(down * time, rel=1e-12)
    assert state.position[0, 0] == pytest.approx(0.5 * down * time**2, rel=1e-12)
    assert force[0, 0] == pytest.approx(-MASS * (GRAVITY * np.sin(angle) - down), rel=1e-12)
    assert (state.spin[1, 0] * RADIUS == pytest.approx(state.velocity[0, 0])) == rolls


@pytest.mark.parametrize(("mu", "angle"), [(0.3, 0.2), (0.05, 0.4), (0.2, 0.05)])
def test_across_an_incline_against_an_integration(mu: float, angle: float) -> None:
    """Slip that gravity turns: the equations of centre and spin, integrated by SciPy with friction that changes over 1e-6 m/s at rest."""
    start, spin, time = np.array([-0.4, 1.0]), np.array([8.0, 30.0]), 0.6

    def rates(_: float, state: Floats) -> Floats:
        velocity, turning = state[2:4], state[4:6]
        slip = velocity + RADIUS * np.array([-turning[1], turning[0]])
        force = -mu * MASS * GRAVITY * np.cos(angle) * slip / np.sqrt(slip @ slip + 1e-12)
        return np.concatenate(
            [
                velocity,
                force / MASS + [GRAVITY * np.sin(angle), 0.0],
                RADIUS / (0.4 * MASS * RADIUS**2) * np.array([force[1], -force[0]]),
            ]
        )

    found = solve_ivp(rates, (0.0, time), [0.0, 0.0, *start, *spin], method="Radau", rtol=1e-10, atol=1e-12).y[:, -1]
    state, _ = after(time, start, (*spin, 0.0), mu=mu, angle=angle)
    np.testing.assert_allclose([*state.position[:, 0], *state.velocity[:, 0]], found[:4], atol=2e-6)
    np.testing.assert_allclose(state.spin[:2, 0], found[4:], atol=2e-4)


def resting(**changes: Any) -> vi.Response:
    law = vi.find_contact_law("hunt-crossley")(stiffness=1e8, restitution=0.1)
    values: dict[str, Any] = {"height": 0.05, "gravity": GRAVITY, "impacts": None, "duration": 3.0, **changes}
    return vi.simulate(vi.Problem(sphere=vi.Body(mass=MASS, contact_offset=RADIUS), plate=vi.rigid_plate(), laws=(law,), **values))


def test_a_run_goes_on_rolling_until_its_duration() -> None:
    friction = vi.find_friction_law("coulomb")(coefficient=0.2)
    response = resting(oblique=vi.Oblique(velocity=(0.7, 0.0), gravity=(0.5, 0.0), friction=friction))
    assert response.end_time[0] == 3.0
    assert response.energy["closure_relative"] < 1e-12
    history = response.history()
    entries = ("kinetic_J", "potential_J", "contact_elastic_J", "contact_dissipated_J", "rotation_J", "friction_J", "written_off_at_rest_J")
    np.testing.assert_allclose(sum(history[name] for name in entries), response.energy["input_J"], rtol=1e-9)
    assert history["velocity_x_m_s"][-1] == pytest.approx(RADIUS * history["spin_y_rad_s"][-1], rel=1e-12)
    late = response.at(np.array([2.0, 3.0]))
    assert np.diff(late["velocity_x_m_s"])[0] == pytest.approx(5.0 / 7.0 * 0.5, rel=1e-12)
    assert response.status.endswith(f" It moves on along the plate, at {late['velocity_x_m_s'][1]:.4g} m/s when the run ends.")
    assert history["kinetic_J"][-1] == pytest.approx(float(response.energy["kinetic_J"]), rel=1e-12)


def test_a_sphere_rolls_off_the_edge() -> None:
    friction = vi.find_friction_law("coulomb")(coefficient=0.2)
    response = resting(oblique=vi.Oblique(velocity=(0.7, 0.0), friction=friction, size=(2.0, 1.0)))
    assert response.end_time[0] < 3.0
    assert response.at([float(response.end_time[0])])["position_x_m"][0] == pytest.approx(1.0, rel=1e-12)
