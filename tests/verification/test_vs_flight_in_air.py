"""Drops through air against closed forms, and against SciPy's integration of Newton's
second law.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from bounces_compared import agrees_on_bounces
from oracles.bouncing_in_air import DENSITY, VISCOSITY, bounces, clift_gauvin
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of

AGAINST = Against(
    "flight with constant drag coefficient and with Stokes drag, closed form",
    "closed form",
    "flight, bounces and shaken plates",
    "vertical motion with quadratic drag; exponential decay of velocity under Stokes drag",
)
SCIPY = Against(
    "numerical integration of flights through air (SciPy)",
    "own independent computation",
    "flight, bounces and shaken plates",
    "Newton's second law with the drag coefficient of Clift and Gauvin 1970, tolerance "
    "1e-13; tests/oracles/bouncing_in_air.py",
)


GRAVITY = 9.80665
LIGHT = {"density": 1100.0, "youngs_modulus": 5e6, "poissons_ratio": 0.48}


def drop(
    radius: float, density: float, air: vi.Air, oblique: vi.Oblique | None = None, **how: object
) -> vi.Problem:
    """Spheres that rebound with 0.8 of their speed, without friction."""
    ball = vi.Body(
        mass=4.0 / 3.0 * np.pi * np.asarray(radius) ** 3 * density, contact_offset=radius
    )
    law = vi.laws.find_contact_law("newton")(restitution=0.8)
    return vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(law,),
        air=air,
        oblique=oblique,
        **{"gravity": GRAVITY, **how},
    )


@pytest.mark.parametrize(
    ("radius", "density"), [(0.025, 1380.0), (0.02, 84.0), (0.002, 1250.0), (0.0005, 2600.0)]
)
def test_a_constant_drag_coefficient(agrees: Agrees, radius: float, density: float) -> None:
    """Falls and rises with drag by the square of the speed: tanh, arctan and logarithms,
    to 1e-12, over 0.01 to 8 terminal falls.
    """
    coefficient = 0.44
    terminal = np.sqrt(8.0 / 3.0 * density / 1.2 * GRAVITY * radius / coefficient)
    height = np.array([0.01, 0.1, 1.0, 4.0, 8.0]) * terminal**2 / GRAVITY
    found = vi.tabulate(
        drop(
            radius, density, vi.Air(drag_coefficient=coefficient), height=height + radius, impacts=2
        )
    ).impacts
    fall = GRAVITY * height / terminal**2
    first = terminal * np.sqrt(-np.expm1(-2.0 * fall))
    case = "four spheres, fall heights 0.01 to 8 times v²/g (v: terminal velocity)"
    agrees(
        case, "approach speed", found["approach_speed_m_s"][:, 0], first, unit="m/s", relative=1e-12
    )
    agrees(
        case,
        "duration of the fall",
        found["time_s"][:, 0],
        terminal / GRAVITY * np.arccosh(np.exp(fall)),
        unit="s",
        relative=1e-11,
    )
    start = 0.8 * first / terminal
    rise = 0.5 * np.log1p(start**2)
    agrees(
        case,
        "rebound height",
        found["rebound_height_m"][:, 0] - radius,
        terminal**2 / GRAVITY * rise,
        unit="m",
        relative=1e-12,
    )
    again = terminal * np.sqrt(-np.expm1(-2.0 * rise))
    agrees(
        case,
        "approach speed of the second impact",
        found["approach_speed_m_s"][:, 1],
        again,
        unit="m/s",
        relative=1e-12,
    )
    lasted = terminal / GRAVITY * (np.arctan(start) + np.arccosh(np.exp(rise)))
    agrees(
        case,
        "duration of the second flight",
        found["time_s"][:, 1] - found["time_s"][:, 0],
        lasted,
        unit="s",
        relative=1e-11,
    )


@pytest.mark.parametrize(
    ("radius", "density", "height"),
    [(1e-4, 2600.0, 40.0), (2e-5, 2600.0, 4.0), (0.02, 84.0, 4000.0)],
)
def test_terminal_velocity(agrees: Agrees, radius: float, density: float, height: float) -> None:
    """It is that at which drag is the weight, and takes the rest of the fall, of up to
    3,000 time constants.
    """
    response = vi.simulate(drop(radius, density, vi.Air(), height=height, impacts=1))
    speed = float(response.impacts["approach_speed_m_s"][0])
    drag = (
        0.375
        * DENSITY
        / density
        * clift_gauvin(DENSITY * speed * 2.0 * radius / VISCOSITY)
        * speed**2
        / radius
    )
    agrees(
        "terminal velocity, three spheres",
        "drag deceleration, against gravity",
        drag,
        GRAVITY,
        unit="m/s²",
        relative=1e-12,
    )
    middle = response.at(np.array([0.5, 0.75]) * response.impacts["time_s"][0])
    np.testing.assert_allclose(middle["velocity_m_s"], -speed, rtol=1e-12)
    np.testing.assert_allclose(middle["acceleration_m_s2"], 0.0, atol=1e-11 * GRAVITY)
    assert response.energy["closure_relative"] < 1e-12


def test_stokes_drag_along_the_plate(agrees: Agrees) -> None:
    """Without gravity a grain that creeps keeps exp(-t / tau) of its velocity, with tau =
    2 rho R^2 / (9 eta).
    """
    radius, density, speed = 1e-5, 2600.0, 1e-6
    constant = 2.0 * density * radius**2 / (9.0 * VISCOSITY)
    along = vi.Oblique(velocity=(speed, 0.0), spin=(0.0, 0.0, 3.0))
    stated = drop(
        radius,
        density,
        vi.Air(),
        along,
        speed=1e-8,
        gravity=0.0,
        impacts=None,
        duration=60.0 * constant,
    )
    times = constant * np.array([0.1, 1.0, 3.0, 20.0])
    found = vi.simulate(stated).at(times)
    left = np.exp(-times / constant)
    agrees(
        "sphere of 10 μm radius under Stokes drag",
        "tangential velocity",
        found["velocity_x_m_s"],
        speed * left,
        unit="m/s",
        relative=3e-5,
    )
    agrees(
        "sphere of 10 μm radius under Stokes drag",
        "position along the plate",
        found["position_x_m"],
        speed * constant * (1.0 - left),
        unit="m",
        relative=1e-5,
    )
    assert np.all(found["spin_z_rad_s"] == 3.0)


def test_bounces(agrees: Agrees) -> None:
    radius, density, height = 0.013, LIGHT["density"], 1.0
    seen = bounces(radius, density, height, lambda speed: 0.8, 4)
    found = vi.simulate(drop(radius, density, vi.Air(), height=height, impacts=4)).impacts
    heights = found["rebound_height_m"][: len(seen.tops)]
    agrees_on_bounces(agrees, "four bounces", found, heights, seen, SCIPY)


@pytest.mark.parametrize("coefficient", [None, 0.44])
@pytest.mark.parametrize(
    ("radius", "density", "along", "pull"),
    [
        (0.02, 84.0, (8.0, -3.0), (0.0, 0.0)),
        (0.025, 1380.0, (3.0, 0.0), (3.0, 1.0)),
        (0.002, 1250.0, (1e-4, 0.0), (0.0, 0.0)),
    ],
)
def test_oblique_flights_on_an_inclined_plate(
    agrees: Agrees,
    radius: float,
    density: float,
    along: tuple[float, float],
    pull: tuple[float, float],
    coefficient: float | None,
) -> None:
    """Three impacts of a sphere that starts upwards: SciPy at 1e-13, each flight to its
    top and down, ended by Newton's method.
    """
    air = vi.Air(drag_coefficient=coefficient)
    oblique = vi.Oblique(velocity=along, gravity=pull)
    response = vi.simulate(drop(radius, density, air, oblique, height=0.5, velocity=6.0, impacts=3))

    def slope(_: float, state: np.ndarray) -> np.ndarray:
        speed = max(float(np.linalg.norm(state[3:6])), 1e-200)
        drag = (
            clift_gauvin(max(DENSITY * speed * 2.0 * radius / VISCOSITY, 1e-12))
            if coefficient is None
            else coefficient
        )
        rate = 0.375 * DENSITY / density * drag * speed / radius
        return np.concatenate(
            [state[3:6], [*pull, -GRAVITY] - rate * state[3:6], [rate * speed**2]]
        )

    def followed(state: np.ndarray, what: int) -> tuple[float, np.ndarray]:
        """Follow the motion until a component of the state falls to zero; return the time
        and the state.
        """

        def event(_: float, state: np.ndarray) -> float:
            return float(state[what])

        event.terminal, event.direction = True, -1.0
        accurate = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-16}
        time = float(solve_ivp(slope, (0.0, 100.0), state, events=event, **accurate).t[-1])
        for _ in range(3):
            end = solve_ivp(slope, (0.0, time), state, **accurate).y[:, -1]
            time -= float(end[what] / slope(0.0, end)[what])
        return time, solve_ivp(slope, (0.0, time), state, **accurate).y[:, -1]

    state, now = np.array([0.0, 0.0, 0.5 - radius, *along, 6.0, 0.0]), 0.0
    case = "oblique flights over an inclined plate, three impacts"
    names = ("position_x_m", "position_y_m", "approach_velocity_x_m_s", "approach_velocity_y_m_s")
    for impact in range(3):
        row = {name: float(values[impact]) for name, values in response.impacts.items()}
        for what in (5, 2):
            lasted, state = followed(state, what)
            now += lasted
            if what == 5 and impact:
                height = response.impacts["rebound_height_m"][impact - 1]
                agrees(
                    case,
                    "rebound height",
                    height,
                    radius + state[2],
                    unit="m",
                    against=SCIPY,
                    relative=1e-11,
                )
        agrees(case, "time of impact", row["time_s"], now, unit="s", against=SCIPY, relative=1e-11)
        agrees(
            case,
            "approach speed",
            row["approach_speed_m_s"],
            -state[5],
            unit="m/s",
            against=SCIPY,
            relative=1e-11,
        )
        np.testing.assert_allclose(
            [row[name] for name in names], [*state[:2], *state[3:5]], rtol=1e-10, atol=1e-12
        )
        taken = float(response.problem.sphere.mass) * state[6]
        agrees(
            case,
            "energy dissipated by air drag",
            row["air_lost_J"],
            taken,
            unit="J",
            against=SCIPY,
            relative=1e-10,
        )
        state[5], state[6] = -0.8 * state[5], 0.0
    assert response.energy["closure_relative"] < 1e-13


def test_calibration_and_simulation_fly_through_the_same_air() -> None:
    """Rebound heights of a simulated drop give back its restitution, by `drop.air` alone,
    also in thick air.
    """
    table = plain_case(
        sphere={"radius": 0.013, "material": LIGHT},
        drop={"height": 1.0, "air": {"density": 3.0}},
        contact={"law": "newton", "restitution": 0.8},
        run={"impacts": 4},
    )
    heights = vi.simulate(vi.case_of(table)).impacts["rebound_height_m"].tolist()
    found = calibrate_case(
        calibration_of(
            {**table, "calibrate": {"target": {"rebound_heights": heights}, "degree": 0}}
        )
    )
    np.testing.assert_allclose(found.values, 0.8, rtol=1e-6)
    with pytest.raises(vi.InputError, match=r"drop\.air"):
        calibrate_case(
            calibration_of(
                {**table, "calibrate": {"target": {"rebound_heights": heights}, "air": False}}
            )
        )


def test_a_law_is_matched_along_a_drop_through_air() -> None:
    """The impacts of a calibrated drop are those of its target, which has the same air."""
    table = plain_case(
        sphere={"radius": 0.013, "material": LIGHT},
        drop={"height": 1.0, "air": True},
        run={"impacts": 4},
    )
    table["contact"] = {"law": "hunt-crossley", "restitution": 0.8}
    found = calibrate_case(
        calibration_of(
            {**table, "calibrate": {"target": {"restitution": 0.7}, "model": "hunt-crossley"}}
        )
    )
    newton = vi.simulate(
        vi.case_of({**table, "contact": {"law": "newton", "restitution": 0.7}})
    ).impacts
    for name in ("time_s", "approach_speed_m_s"):
        np.testing.assert_allclose(found.drops["target"][name], newton[name], rtol=1e-12)
    np.testing.assert_allclose(
        found.drops["variable"]["approach_speed_m_s"], newton["approach_speed_m_s"], rtol=3e-4
    )
    np.testing.assert_allclose(
        found.drops["function"]["approach_speed_m_s"], newton["approach_speed_m_s"], rtol=3e-4
    )
