"""Spheres that slip and roll on a plate, against closed forms of rigid bodies and against
SciPy's integration of their equations.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.lying_sphere import (
    BEGIN,
    IS_EVENT,
    follow,
    lying_sphere,
    start_of,
)
from vibroimpact.dynamics.core.sphere_records import RubbedSphere, SphereState
from vibroimpact.dynamics.motion.along import Sphere, State
from vibroimpact.dynamics.oblique import lying
from vibroimpact.dynamics.oblique.lying import lie

AGAINST = Against(
    "sliding and rolling of rigid spheres, closed form",
    "closed form",
    "oblique impact and friction",
    "rolling begins at 5/7 of the sliding velocity; inclines; rolling resistance; twisting "
    "friction under Hertz pressure",
)
SCIPY = Against(
    "SciPy's Radau, translation and rotation of a sphere",
    "own independent computation",
    "oblique impact and friction",
    "friction regularized over a sliding velocity of 1e-6 m/s, in the test",
)
MARCHED = Against(
    "small steps of Hertz's force, Mindlin's spring and the rolling moment",
    "own independent computation",
    "oblique impact and friction",
    "semi-implicit Euler with 200,000 steps, in the test",
)


RADIUS, MASS, GRAVITY = 0.02, 0.3, 9.81


def after(
    time: float,
    velocity: Any,
    spin: Any = (0.0, 0.0, 0.0),
    mu: float = 0.1,
    angle: float = 0.0,
    rolling: float = 0.0,
) -> tuple[State, Floats]:
    """Return the state of a sphere on a plate inclined about y, which began at the
    origin, and the friction force.
    """
    one = np.ones(1)
    along = np.array([[GRAVITY * np.sin(angle)], [0.0]])
    ball = Sphere(MASS * one, RADIUS * one, 0.4 * MASS * RADIUS**2 * one, along)
    start = State(
        np.zeros((2, 1)),
        np.array(velocity, dtype=float)[:, None],
        np.array(spin, dtype=float)[:, None],
    )
    law = vi.friction.find_friction_law("coulomb")(coefficient=mu, rolling_coefficient=rolling)
    state, friction, _ = lie(ball, start, law, GRAVITY * np.cos(angle) * one, np.array([[time]]))
    return state, friction


def test_sliding_ends_in_rolling_with_five_sevenths(agrees: Agrees) -> None:
    """After 2 v / (7 mu g) the sphere rolls; until then it has gone 12 v^2 / (49 mu g)."""
    until = 2.0 * 1.4 / (7.0 * 0.1 * GRAVITY)
    state, _ = after(until, (1.4, 0.0))
    agrees(
        "transition from sliding to rolling",
        "velocity",
        state.velocity[:, 0],
        [1.0, 0.0],
        unit="m/s",
        absolute=1e-12,
    )
    way = 12.0 * 1.4**2 / (49.0 * 0.1 * GRAVITY)
    agrees(
        "transition from sliding to rolling",
        "distance to the transition",
        state.position[0, 0],
        way,
        unit="m",
        relative=1e-12,
    )
    later, force = after(until + 2.0, (1.4, 0.0))
    assert later.position[0, 0] == pytest.approx(state.position[0, 0] + 2.0, rel=1e-12)
    assert later.spin[1, 0] == pytest.approx(1.0 / RADIUS, rel=1e-12)
    assert force[0, 0] == 0.0


def test_back_spin_brings_the_sphere_back(agrees: Agrees) -> None:
    """With the spin -5 v / R the slip is six times the velocity, and the sphere rolls
    back with 1 - 6 2/7 of it.
    """
    state, _ = after(10.0, (1.0, 0.0), (0.0, -5.0 / RADIUS, 0.0))
    agrees(
        "sliding with backspin",
        "velocity",
        state.velocity[0, 0],
        1.0 - 6.0 * 2.0 / 7.0,
        unit="m/s",
        relative=1e-12,
    )


@pytest.mark.parametrize("mu", [0.5, 0.12, 0.02])
def test_down_an_incline(agrees: Agrees, mu: float) -> None:
    """It rolls with 5/7 g sin; or slips, where 2/7 tan exceeds the coefficient, with g
    (sin - mu cos).
    """
    angle, time = np.radians(25.0), 1.7
    state, force = after(time, (0.0, 0.0), mu=mu, angle=angle)
    rolls = 2.0 / 7.0 * np.tan(angle) <= mu
    down = GRAVITY * (5.0 / 7.0 * np.sin(angle) if rolls else np.sin(angle) - mu * np.cos(angle))
    agrees(
        "rolling and sliding down an incline",
        "velocity",
        state.velocity[0, 0],
        down * time,
        unit="m/s",
        relative=1e-12,
    )
    agrees(
        "rolling and sliding down an incline",
        "distance",
        state.position[0, 0],
        0.5 * down * time**2,
        unit="m",
        relative=1e-12,
    )
    assert force[0, 0] == pytest.approx(-MASS * (GRAVITY * np.sin(angle) - down), rel=1e-12)
    assert (state.spin[1, 0] * RADIUS == pytest.approx(state.velocity[0, 0])) == rolls


def integrated(
    start: Any, spin: Any, time: float, mu: float, angle: float, rolling: float = 0.0
) -> Floats:
    """Return place, velocity and spin by SciPy's integration of centre and spin, whose
    friction changes over 1e-6 m/s at rest.
    """

    def rates(_: float, state: Floats) -> Floats:
        velocity, turning = state[2:4], state[4:6]
        slip = velocity + RADIUS * np.array([-turning[1], turning[0]])
        pressing = MASS * GRAVITY * np.cos(angle)
        force = -mu * pressing * slip / np.sqrt(slip @ slip + 1e-12)
        moment = (
            -rolling * RADIUS * pressing * turning / np.sqrt(turning @ turning + 1e-12 / RADIUS**2)
        )
        return np.concatenate(
            [
                velocity,
                force / MASS + [GRAVITY * np.sin(angle), 0.0],
                (RADIUS * np.array([force[1], -force[0]]) + moment) / (0.4 * MASS * RADIUS**2),
            ]
        )

    return np.asarray(
        solve_ivp(
            rates, (0.0, time), [0.0, 0.0, *start, *spin], method="Radau", rtol=1e-10, atol=1e-12
        ).y[:, -1]
    )


@pytest.mark.parametrize(("mu", "angle"), [(0.3, 0.2), (0.05, 0.4), (0.2, 0.05)])
def test_across_an_incline_against_an_integration(agrees: Agrees, mu: float, angle: float) -> None:
    """Slip that gravity turns."""
    start, spin, time = np.array([-0.4, 1.0]), np.array([8.0, 30.0]), 0.6
    found = integrated(start, spin, time, mu, angle)
    state, _ = after(time, start, (*spin, 0.0), mu=mu, angle=angle)
    moved = [*state.position[:, 0], *state.velocity[:, 0]]
    agrees(
        "sliding across an incline",
        "position and velocity",
        moved,
        found[:4],
        unit="m, m/s",
        against=SCIPY,
        absolute=2e-6,
    )
    agrees(
        "sliding across an incline",
        "angular velocity",
        state.spin[:2, 0],
        found[4:],
        unit="rad/s",
        against=SCIPY,
        absolute=2e-4,
    )


def resting(**changes: Any) -> vi.Response:
    law = vi.laws.find_contact_law("hunt-crossley")(stiffness=1e8, restitution=0.1)
    values: dict[str, Any] = {
        "laws": (law,),
        "height": 0.05,
        "gravity": GRAVITY,
        "impacts": None,
        "duration": 3.0,
        **changes,
    }
    return vi.simulate(
        vi.Problem(
            sphere=vi.Body(mass=MASS, contact_offset=RADIUS), plate=vi.rigid_plate(), **values
        )
    )


def balanced_history(response: vi.Response) -> dict[str, Floats]:
    """The history of a run, whose energies add up to what was put in, at every time."""
    history = response.history()
    entries = (
        "kinetic_J",
        "potential_J",
        "contact_elastic_J",
        "contact_dissipated_J",
        "rotation_J",
        "friction_J",
        "written_off_at_rest_J",
    )
    np.testing.assert_allclose(
        sum(history[name] for name in entries), response.energy["input_J"], rtol=1e-9
    )
    return history


def test_a_run_goes_on_rolling_until_its_duration() -> None:
    friction = vi.friction.find_friction_law("coulomb")(coefficient=0.2)
    response = resting(
        oblique=vi.Oblique(velocity=(0.7, 0.0), gravity=(0.5, 0.0), friction=friction)
    )
    assert response.end_time[0] == 3.0
    assert response.energy["closure_relative"] < 1e-12
    history = balanced_history(response)
    assert history["velocity_x_m_s"][-1] == pytest.approx(
        RADIUS * history["spin_y_rad_s"][-1], rel=1e-12
    )
    late = response.at(np.array([2.0, 3.0]))
    assert np.diff(late["velocity_x_m_s"])[0] == pytest.approx(5.0 / 7.0 * 0.5, rel=1e-12)
    assert response.status.endswith(
        f" It moves on along the plate, at {late['velocity_x_m_s'][1]:.4g} m/s when the run ends."
    )
    assert history["kinetic_J"][-1] == pytest.approx(float(response.energy["kinetic_J"]), rel=1e-12)


def test_a_sphere_rolls_off_the_edge() -> None:
    friction = vi.friction.find_friction_law("coulomb")(coefficient=0.2)
    response = resting(oblique=vi.Oblique(velocity=(0.7, 0.0), friction=friction, size=(2.0, 1.0)))
    assert response.end_time[0] < 3.0
    assert response.at([float(response.end_time[0])])["position_x_m"][0] == pytest.approx(
        1.0, rel=1e-12
    )


class OnSlope(NamedTuple):
    """A sphere that lies on a slope."""

    ball: Sphere
    start: State
    law: vi.friction.FrictionLaw
    pressing: Floats
    until: float

    def at(self, times: Floats, half: float = np.inf) -> tuple[State, Floats, Floats]:
        """States, friction and times up to the end, or until it leaves the plate."""
        return lie(*self[:4], np.append(times, self.until)[None], (half, half))

    def edge_time(self, half: float) -> float:
        return float(self.at(np.zeros(0), half)[2][0, -1])

    def parts(self) -> Floats:
        sphere = RubbedSphere(*self.ball.rows(self.law)[0])
        start = start_of(sphere, SphereState(*self.start.rows[0]))
        return follow(lying_sphere(sphere, float(self.pressing[0]), start), start, self.until)


def on_slope(
    velocity: Any, spin: Any, mu: float, rolling: float, until: float, angle: float = 0.2
) -> OnSlope:
    one, law = (
        np.ones(1),
        vi.friction.find_friction_law("coulomb")(coefficient=mu, rolling_coefficient=rolling),
    )
    ball = Sphere(
        MASS * one,
        RADIUS * one,
        0.4 * MASS * RADIUS**2 * one,
        np.array([[GRAVITY * np.sin(angle)], [0.0]]),
    )
    start = State(
        np.zeros((2, 1)),
        np.array(velocity, dtype=float)[:, None],
        np.array([*spin, 0.0], dtype=float)[:, None],
    )
    return OnSlope(ball, start, law, GRAVITY * np.cos(angle) * one, until)


def test_a_sphere_that_rolls_over_the_uphill_edge_does_not_come_back() -> None:
    """It leaves where its way up, v t - a t^2 / 2 with a = 5/7 g sin, first reaches the
    edge; later it would lie on the plate again.
    """
    speed, up, edge = 1.0, 5.0 / 7.0 * GRAVITY * np.sin(0.2), 0.3
    rolls = on_slope((-speed, 0.0), (0.0, -speed / RADIUS), 0.5, 0.0, 2.0 * speed / up)
    assert rolls.at(np.zeros(0))[0].position[0, 0] == pytest.approx(0.0, abs=1e-12)
    assert rolls.edge_time(edge) == pytest.approx(
        (speed - np.sqrt(speed**2 - 2.0 * up * edge)) / up, rel=1e-12
    )
    assert rolls.edge_time(0.5 * speed**2 / up * (1.0 + 1e-12)) == rolls.until


@pytest.mark.slow
@pytest.mark.parametrize("rolling", [0.0, 0.1])
def test_the_first_edge_of_spheres_that_turn(rolling: float) -> None:
    """Against the motion at 20,000 times: spheres that slip and roll across a slope, and
    come back from an edge in part.
    """
    random, back = np.random.default_rng(3), 0
    for _ in range(40):
        velocity, spin = random.normal(size=2) * 0.4 - [1.2, 0.0], random.normal(size=2) * 30.0
        moves = on_slope(velocity, spin, float(random.uniform(0.05, 0.4)), rolling, 2.0)
        times = np.linspace(0.0, 2.0, 20001)
        places = np.abs(moves.at(times[:-1])[0].position)
        half = float(random.uniform(0.2, 1.0)) * places[0].max()
        out = (places > half).any(axis=0)
        first = times[out.argmax()] if out.any() else 2.0
        found = moves.edge_time(half)
        assert first - 1e-4 * (1.0 + 1e-9) <= found <= first
        back += bool(out.any() and not out[-1])
    assert back > 3


def test_a_motion_is_the_same_however_far_it_is_followed() -> None:
    for rolling in (0.0, 0.1):
        moves = on_slope((-0.4, 1.0), (8.0, 30.0), 0.3, rolling, 2.0)
        for time in (0.05, 0.2, 0.9, 2.0):
            alone, friction, _ = on_slope((-0.4, 1.0), (8.0, 30.0), 0.3, rolling, time).at(
                np.zeros(0)
            )
            among, frictions, _ = moves.at(np.array([0.0, time]))
            np.testing.assert_allclose(among.position[:, 1], alone.position[:, 0], atol=1e-10)
            np.testing.assert_allclose(among.velocity[:, 1], alone.velocity[:, 0], atol=1e-9)
            np.testing.assert_allclose(frictions[:, 1], friction[:, 0], atol=1e-6)


def test_rolling_resistance_brings_the_sphere_to_rest(agrees: Agrees) -> None:
    """With 5/7 mu_r g, after 7 v / (5 mu_r g) and 7 v^2 / (10 mu_r g); then it stays."""
    rolls = {"velocity": (0.7, 0.0), "spin": (0.0, 0.7 / RADIUS, 0.0), "rolling": 0.02}
    until = 7.0 * 0.7 / (5.0 * 0.02 * GRAVITY)
    half, force = after(0.5 * until, **rolls)
    assert half.velocity[0, 0] == pytest.approx(0.35, rel=1e-12)
    assert half.spin[1, 0] == pytest.approx(0.35 / RADIUS, rel=1e-12)
    assert force[0, 0] == pytest.approx(-5.0 / 7.0 * 0.02 * MASS * GRAVITY, rel=1e-12)
    for time in (until * (1.0 + 1e-15), until + 5.0):
        state, force = after(time, **rolls)
        way = 7.0 * 0.7**2 / (10.0 * 0.02 * GRAVITY)
        agrees(
            "rolling to rest by rolling resistance",
            "distance to rest",
            state.position[0, 0],
            way,
            unit="m",
            relative=1e-12,
        )
        np.testing.assert_allclose(
            [*state.velocity[:, 0], *(RADIUS * state.spin[:, 0])], 0.0, atol=1e-15
        )
        assert force[0, 0] == 0.0


@pytest.mark.parametrize(("angle", "moves"), [(0.0299, False), (0.0301, True), (0.3, True)])
def test_rolling_resistance_holds_the_sphere_on_a_slope(angle: float, moves: bool) -> None:
    """It lies still up to the angle whose tangent is mu_r, and rolls with 5/7 g (sin -
    mu_r cos) above.
    """
    state, force = after(2.0, (0.0, 0.0), mu=0.5, angle=angle, rolling=np.tan(0.03))
    down = 5.0 / 7.0 * GRAVITY * (np.sin(angle) - np.tan(0.03) * np.cos(angle)) if moves else 0.0
    assert state.velocity[0, 0] == pytest.approx(2.0 * down, rel=1e-12, abs=1e-15)
    assert state.spin[1, 0] == pytest.approx(2.0 * down / RADIUS, rel=1e-12, abs=1e-13)
    assert force[0, 0] == pytest.approx(-MASS * (GRAVITY * np.sin(angle) - down), rel=1e-12)


@pytest.mark.parametrize("rolling", [0.05, 0.4])
def test_a_sphere_that_rolls_up_a_slope(agrees: Agrees, rolling: float) -> None:
    """It comes to rest at the top of its way, and stays there or rolls back."""
    angle, speed, later = 0.2, 1.4, 0.3
    up, down = (
        5.0 / 7.0 * GRAVITY * (np.sin(angle) + sign * rolling * np.cos(angle))
        for sign in (1.0, -1.0)
    )
    state, _ = after(
        speed / up + later,
        (-speed, 0.0),
        (0.0, -speed / RADIUS, 0.0),
        mu=0.6,
        angle=angle,
        rolling=rolling,
    )
    assert state.velocity[0, 0] == pytest.approx(max(down, 0.0) * later, rel=1e-12, abs=1e-15)
    place = -0.5 * speed**2 / up + 0.5 * max(down, 0.0) * later**2
    agrees(
        "rolling up an incline, with rolling resistance",
        "position",
        state.position[0, 0],
        place,
        unit="m",
        relative=1e-12,
    )


def test_sliding_with_rolling_resistance_ends_in_rolling() -> None:
    """The moment takes 5/2 mu_r g from the spin that friction gives: it rolls after v /
    (7/2 mu - 5/2 mu_r) g.
    """
    mu, rolling, speed = 0.2, 0.03, 1.4
    until = speed / ((3.5 * mu - 2.5 * rolling) * GRAVITY)
    half, _ = after(0.5 * until, (speed, 0.0), mu=mu, rolling=rolling)
    assert RADIUS * half.spin[1, 0] == pytest.approx(
        2.5 * (mu - rolling) * GRAVITY * 0.5 * until, rel=1e-12
    )
    state, _ = after(until, (speed, 0.0), mu=mu, rolling=rolling)
    assert state.velocity[0, 0] == pytest.approx(speed - mu * GRAVITY * until, rel=1e-12)
    assert RADIUS * state.spin[1, 0] == pytest.approx(state.velocity[0, 0], rel=1e-12)


def test_a_moment_beyond_the_friction_leaves_the_sphere_without_spin() -> None:
    """With mu_r above mu friction cannot turn it: it slides to rest with mu g."""
    state, _ = after(0.3, (1.4, 0.0), mu=0.2, rolling=0.21)
    assert state.velocity[0, 0] == pytest.approx(1.4 - 0.2 * GRAVITY * 0.3, rel=1e-12)
    assert abs(RADIUS * state.spin[1, 0]) < 1e-15
    rests, _ = after(3.0, (1.4, 0.0), mu=0.2, rolling=0.21)
    assert rests.position[0, 0] == pytest.approx(1.4**2 / (2.0 * 0.2 * GRAVITY), rel=1e-12)


@pytest.mark.parametrize(
    ("mu", "rolling", "angle", "velocity", "spin"),
    [
        (0.3, 0.05, 0.0, (0.5, 0.2), (20.0, -30.0)),
        (0.3, 0.05, 0.2, (-0.4, 1.0), (8.0, 30.0)),
        (0.3, 0.25, 0.2, (0.0, 0.6), (-30.0, 0.0)),
        (0.05, 0.3, 0.1, (-0.4, 0.5), (0.0, 0.0)),
        (0.1, 0.02, 0.5, (0.0, 1.0), (-50.0, 0.0)),
        (0.2, 0.1, 0.0, (0.0, 0.0), (40.0, 10.0)),
        (0.1, 0.12, 0.06, (-0.5, 0.3), (60.0, -40.0)),
        (0.2, 0.1, 0.4, (-1.0, 0.0), (0.0, -80.0)),
        (0.0, 0.1, 0.1, (0.0, 0.5), (0.0, 40.0)),
    ],
)
def test_rolling_resistance_against_an_integration(
    agrees: Agrees, mu: float, rolling: float, angle: float, velocity: Any, spin: Any
) -> None:
    """Slip, spin and gravity in all directions, through their zeros."""
    for time in (0.1, 0.7):
        found = integrated(velocity, spin, time, mu, angle, rolling)
        state, _ = after(time, velocity, (*spin, 0.0), mu=mu, angle=angle, rolling=rolling)
        moved, turned = [*state.position[:, 0], *state.velocity[:, 0]], RADIUS * state.spin[:2, 0]
        agrees(
            "sliding and rolling with rolling resistance",
            "position and velocity",
            moved,
            found[:4],
            unit="m, m/s",
            against=SCIPY,
            absolute=5e-6,
        )
        agrees(
            "sliding and rolling with rolling resistance",
            "angular velocity times radius",
            turned,
            found[4:] * RADIUS,
            unit="m/s",
            against=SCIPY,
            absolute=5e-6,
        )


def test_a_run_comes_to_rest_by_rolling_resistance() -> None:
    friction = vi.friction.find_friction_law("coulomb")(coefficient=0.2, rolling_coefficient=0.05)
    response = resting(oblique=vi.Oblique(velocity=(0.7, 0.0), friction=friction))
    assert response.energy["closure_relative"] < 1e-12
    assert response.energy["kinetic_J"] == pytest.approx(0.0, abs=1e-15)
    history = balanced_history(response)
    assert (np.diff(history["friction_J"]) > -1e-12).all()
    assert "It moves on" not in response.status
    lies = response.rest.time[0]
    rolls = history["time_s"] > lies
    speed = float(response.at([lies])["velocity_x_m_s"][0])
    slowed = np.maximum(speed - 5.0 / 7.0 * 0.05 * GRAVITY * (history["time_s"] - lies), 0.0)
    np.testing.assert_allclose(history["velocity_x_m_s"][rolls], slowed[rolls], atol=1e-9)


def test_a_history_is_integrated_once(monkeypatch: pytest.MonkeyPatch) -> None:
    friction = vi.friction.find_friction_law("coulomb")(coefficient=0.3, rolling_coefficient=0.05)
    response = resting(
        oblique=vi.Oblique(
            velocity=(0.3, 0.7), spin=(10.0, 0.0, 0.0), gravity=(0.9, 0.0), friction=friction
        )
    )
    calls, integrate = [], lying.lie_on_plate

    def counted(*parts: Any) -> None:
        calls.append(1)
        integrate(*parts)

    monkeypatch.setattr(lying, "lie_on_plate", counted)
    response.at(np.linspace(float(response.rest.time[0]), 3.0, 500))
    assert 0 < len(calls) < 5


def test_rolling_resistance_decides_whether_it_reaches_the_edge() -> None:
    for rolling, falls in ((0.01, True), (0.05, False)):
        friction = vi.friction.find_friction_law("coulomb")(
            coefficient=0.2, rolling_coefficient=rolling
        )
        response = resting(
            duration=10.0,
            oblique=vi.Oblique(velocity=(0.7, 0.0), friction=friction, size=(1.5, 1.0)),
        )
        assert (response.end_time[0] < 10.0) == falls
        place = response.at([float(response.end_time[0])])["position_x_m"][0]
        assert (place == pytest.approx(0.75, rel=1e-12)) if falls else (place < 0.75)


@pytest.mark.parametrize("friction", ["coulomb", "rigid", "mdr", "mindlin"])
def test_an_impact_resists_rolling(agrees: Agrees, friction: str) -> None:
    """Changes over the impulse J per mass: 5/7 mu_r of all that rolls; mu of what slips, and 5/2
    (mu -+ mu_r) of its spin.

    Under elastic friction a sphere that rolls begins to oscillate along the plate as the moment
    begins, and ends elsewhere.
    """
    pair = {"effective_modulus": 1e9, "effective_shear_modulus": 8e8, "effective_radius": RADIUS}
    mu, rolling = 0.3, 0.04
    law = vi.friction.find_friction_law(friction)(
        coefficient=mu,
        rolling_coefficient=rolling,
        **({} if friction in ("coulomb", "rigid") else pair),
    )
    slower = -5.0 / 7.0 * rolling
    rolls = [(1.0, 1.0, slower, slower)] if friction in ("coulomb", "rigid") else []
    for speed, spin, push, turn in (
        *rolls,
        (30.0, 0.0, -mu, 2.5 * (mu - rolling)),
        (0.0, -30.0, -mu, 2.5 * (mu + rolling)),
    ):
        oblique = vi.Oblique(velocity=(speed, 0.0), spin=(0.0, spin / RADIUS, 0.0), friction=law)
        impacts = resting(
            height=None, speed=2.0, gravity=0.0, impacts=1, duration=None, oblique=oblique
        ).impacts
        impulse = 2.0 + impacts["separation_speed_m_s"][0]
        case, turned = "impact with rolling resistance", RADIUS * impacts["spin_y_after_rad_s"]
        agrees(
            case,
            "tangential velocity after impact",
            impacts["separation_velocity_x_m_s"],
            speed + push * impulse,
            unit="m/s",
            relative=1e-8,
        )
        agrees(
            case,
            "angular velocity times radius after impact",
            turned,
            spin + turn * impulse,
            unit="m/s",
            relative=1e-8,
        )


_BALL = {
    "radius": 0.01,
    "mass": 0.03,
    "modulus": 115e9,
    "shear": 47.5e9,
    "friction": 0.2,
    "rolling": 0.02,
    "speed": 2.0,
}


def marched_with_a_moment(
    velocity: float, turning: float, steps: int = 200_000
) -> tuple[float, float]:
    """Return velocity and angular velocity times radius [m/s] after a Hertzian impact of `_BALL`,
    by small steps of the law as stated.

    A spring of Mindlin's stiffness whose displacement is kept, at most mu F, and a moment of mu_r R
    F against what spins.
    """
    ball = _BALL
    mass, shear, radius = ball["mass"], 2.0 * ball["shear"], ball["radius"]
    hertz = 4.0 / 3.0 * ball["modulus"] * radius**0.5
    deepest = (1.25 * mass * ball["speed"] ** 2 / hertz) ** 0.4
    step = 3.0 * deepest / ball["speed"] / steps
    depth, rate, stretch = 0.0, ball["speed"], 0.0
    while depth >= 0.0:
        force = hertz * depth**1.5
        stretch += (velocity + turning) * step
        stiffness = shear * (radius * depth) ** 0.5
        friction = min(
            max(stiffness * stretch, -ball["friction"] * force), ball["friction"] * force
        )
        stretch = friction / stiffness if stiffness else 0.0
        velocity -= friction / mass * step
        turning -= 2.5 * friction / mass * step
        slower = 2.5 * ball["rolling"] * force / mass * step
        turning = max(abs(turning) - slower, 0.0) * (1.0 if turning > 0.0 else -1.0)
        rate -= force / mass * step
        depth += rate * step
    return velocity, turning


@pytest.mark.parametrize(
    ("velocity", "turning"), [(0.0, -0.5), (1.0, 0.0), (0.01, 0.0), (0.02, 0.03), (-0.3, 0.2)]
)
def test_elastic_friction_and_a_moment_act_together(
    agrees: Agrees, velocity: float, turning: float
) -> None:
    """The moment acted after the contact, as if friction had not known of it: the spin of
    the first case became 21 instead of 29 rad/s.
    """
    ball = _BALL
    law = vi.friction.find_friction_law("mindlin")(
        coefficient=ball["friction"],
        rolling_coefficient=ball["rolling"],
        effective_modulus=ball["modulus"],
        effective_shear_modulus=ball["shear"],
        effective_radius=ball["radius"],
    )
    response = vi.simulate(
        vi.Problem(
            sphere=vi.Body(mass=ball["mass"], contact_offset=ball["radius"]),
            plate=vi.rigid_plate(),
            laws=(
                vi.laws.find_contact_law("hertz")(
                    stiffness=4.0 / 3.0 * ball["modulus"] * ball["radius"] ** 0.5
                ),
            ),
            speed=ball["speed"],
            gravity=0.0,
            impacts=1,
            oblique=vi.Oblique(
                velocity=(velocity, 0.0), spin=(0.0, -turning / ball["radius"], 0.0), friction=law
            ),
        )
    )
    expected = marched_with_a_moment(velocity, turning)
    found = (
        response.impacts["separation_velocity_x_m_s"][0],
        -ball["radius"] * response.impacts["spin_y_after_rad_s"][0],
    )
    bound = 1e-3 * max(abs(velocity), abs(turning))
    for quantity, value, other in zip(
        ("tangential velocity", "angular velocity times radius"), found, expected, strict=True
    ):
        case = "impact under elastic friction with rolling resistance"
        agrees(case, quantity, value, other, unit="m/s", against=MARCHED, absolute=bound)


@pytest.mark.parametrize(
    ("velocity", "spin", "after"),
    [((0.0, 0.0, -2.0), 50.0, (0.0972, 28.8)), ((0.01, 0.0, -2.0), 0.0, (-0.0105, -0.007))],
)
def test_balls_of_the_guide(
    velocity: tuple[float, ...], spin: float, after: tuple[float, float]
) -> None:
    """Velocity along the plate and spin [rad/s] as the guide to oblique drops has
    them.
    """
    friction = {"law": "mindlin", "coefficient": 0.2, "rolling_coefficient": 0.02}
    case = {
        "name": "ball",
        "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"velocity": list(velocity), "spin": [0.0, spin, 0.0]},
        "contact": {"law": "hertz", "friction": friction},
        "run": {"impacts": 1},
    }
    impacts = vi.simulate(vi.case_of(case).to_problem()).impacts
    assert impacts["separation_velocity_x_m_s"][0] == pytest.approx(after[0], abs=1.5e-4)
    assert impacts["spin_y_after_rad_s"][0] == pytest.approx(after[1], abs=0.06)


def test_a_batch_with_resisted_drops_is_its_drops() -> None:
    friction = {
        "coefficient": 0.2,
        "effective_modulus": 115e9,
        "effective_shear_modulus": 47.5e9,
        "effective_radius": 0.01,
    }
    rolling = np.array([0.0, 0.02, 0.0, 0.3])

    def found(coefficient: Any, speed: Any) -> vi.Response:
        law = vi.friction.find_friction_law("mindlin")(rolling_coefficient=coefficient, **friction)
        contact = vi.laws.find_contact_law("hunt-crossley")(stiffness=1.5e10, restitution=0.7)
        ball = vi.Body(mass=0.03, contact_offset=0.01)
        oblique = vi.Oblique(velocity=(speed, 0.1), spin=(0.0, 20.0, 5.0), friction=law)
        return vi.simulate(
            vi.Problem(
                sphere=ball,
                plate=vi.rigid_plate(),
                laws=(contact,),
                speed=2.0,
                impacts=2,
                oblique=oblique,
            )
        )

    speeds = np.array([0.1, 0.2, 1.0, 0.0])
    whole = found(rolling, speeds)
    for drop in range(4):
        alone = found(rolling[drop], speeds[drop])
        for name, values in alone.impacts.items():
            np.testing.assert_allclose(
                whole.drop(drop).impacts[name], values, rtol=1e-12, atol=1e-15
            )
        time = np.linspace(0.0, float(alone.end_time[0]), 50)
        np.testing.assert_allclose(
            whole.drop(drop).at(time)["velocity_x_m_s"],
            alone.at(time)["velocity_x_m_s"],
            rtol=1e-12,
        )


def test_a_contact_with_an_area_resists_twisting(agrees: Agrees) -> None:
    """The spin about the normal of a sphere that lies falls by 5/2 M / (m R^2), M = 3
    pi/16 mu m g a; a point leaves it as it is.
    """
    pair = {"effective_modulus": 1e9, "effective_shear_modulus": 8e8, "effective_radius": RADIUS}
    one, spin = np.ones(1), np.array([0.0, 0.0, 3.0])[:, None]
    ball = Sphere(MASS * one, RADIUS * one, 0.4 * MASS * RADIUS**2 * one, np.zeros((2, 1)))
    start, weight = State(np.zeros((2, 1)), np.zeros((2, 1)), spin), MASS * GRAVITY
    moment = (
        3.0 * np.pi / 16.0 * 0.2 * weight * (3.0 * weight * RADIUS / (4.0 * 1e9)) ** (1.0 / 3.0)
    )
    law = vi.friction.find_friction_law("mdr")(coefficient=0.2, **pair)
    until = 3.0 * 0.4 * MASS * RADIUS**2 / moment
    for time, left in ((0.25 * until, 2.25), (until, 0.0), (3.0 * until, 0.0)):
        state, _, _ = lie(ball, start, law, GRAVITY * one, np.array([[time]]))
        agrees(
            "sphere at rest on the plate, spinning about the normal",
            "angular velocity about the normal",
            state.spin[2, 0],
            left,
            unit="rad/s",
            absolute=1e-12,
        )
    point = vi.friction.find_friction_law("coulomb")(coefficient=0.2)
    state, _, _ = lie(ball, start, point, GRAVITY * one, np.ones((1, 1)))
    assert state.spin[2, 0] == 3.0


@pytest.mark.parametrize("friction", ["coulomb", "mdr"])
@pytest.mark.parametrize(("mu", "tolerance"), [(0.02, 1e-4), (0.1, 1e-4), (0.5, 1e-3)])
def test_gravity_across_the_slip_turns_the_friction_of_an_impact(
    agrees: Agrees, friction: str, mu: float, tolerance: float
) -> None:
    """Against SciPy, whose friction changes over 1e-7 m/s at rest: velocity across over
    what gravity alone would give, 0.98 to 5/7.
    """
    stiffness, gravity, speed, slip = 1.3e8, np.array([0.5, 3.0]), 1.0, 1.0
    pair = {"effective_modulus": 1e9, "effective_shear_modulus": 8e8, "effective_radius": RADIUS}
    law = vi.friction.find_friction_law(friction)(
        coefficient=mu, **({} if friction == "coulomb" else pair)
    )
    oblique = vi.Oblique(velocity=(slip, 0.0), gravity=tuple(gravity), friction=law)
    hertz = (vi.laws.find_contact_law("hertz")(stiffness=stiffness),)
    impacts = resting(
        laws=hertz, height=None, speed=speed, gravity=0.0, impacts=1, duration=None, oblique=oblique
    ).impacts
    duration = float(impacts["duration_s"][0])

    def rates(_: float, state: Floats) -> Floats:
        force = stiffness * max(state[0], 0.0) ** 1.5 / MASS
        point = state[2:4] + state[4:6]
        friction = -mu * force * point / np.sqrt(point @ point + 1e-14)
        return np.concatenate([[state[1], -force], friction + gravity, 2.5 * friction])

    start = [0.0, speed, slip, 0.0, 0.0, 0.0]
    found = solve_ivp(
        rates,
        (0.0, duration),
        start,
        method="Radau",
        rtol=1e-9,
        atol=1e-13,
        max_step=duration / 200.0,
    ).y[:, -1]
    across = np.array(
        [impacts["separation_velocity_y_m_s"][0], RADIUS * impacts["spin_x_after_rad_s"][0]]
    )
    without = gravity[1] * duration
    case = f"impact with gravity transverse to sliding, coefficient of friction {mu}"
    agrees(
        case,
        "transverse velocity and angular velocity times radius, normalized by gravity times "
        "contact duration",
        across / without,
        found[[3, 5]] / without,
        against=SCIPY,
        absolute=tolerance,
    )


def test_a_slip_of_rounding_is_none() -> None:
    """A sphere that impacts have left rolling, up to rounding, across a slope goes on
    rolling: with 5/7 of gravity, and at once.
    """
    one = np.ones(1)
    ball = Sphere(one, 0.02 * one, 0.4 * 0.02**2 * one, np.array([[1.0], [0.0]]))
    velocity = np.array([[1.3], [0.7]])
    spin = np.array([[-0.7 / 0.02], [1.3 / 0.02], [0.0]]) * (1.0 + 1e-15)
    start, law = (
        State(np.zeros((2, 1)), velocity, spin),
        vi.friction.find_friction_law("coulomb")(coefficient=0.3),
    )
    state, _, _ = lie(ball, start, law, 9.81 * one, np.array([[2.0]]))
    assert state.velocity[:, 0] == pytest.approx([1.3 + 2.0 * 5.0 / 7.0, 0.7], rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("rolling", [0.0, 0.01])
@pytest.mark.parametrize("size", [1e-7, 1e-12])
def test_a_slow_slip_across_a_slope_ends_as_a_fast_one(size: float, rolling: float) -> None:
    """The equations know no speed of their own: a slip that is smaller by a factor ends
    earlier by it, in as many steps.
    """
    fast, slow = (
        on_slope((0.3 * part, 0.4 * part), (50.0 * part, -15.0 * part), 0.1, rolling, 3.0).parts()
        for part in (1.0, size)
    )
    begins, expected = (moves[moves[:, IS_EVENT] > 0.0, BEGIN] for moves in (slow, fast))
    assert begins / size == pytest.approx(expected, rel=1e-8)
    assert len(slow) < 5 * len(fast)
