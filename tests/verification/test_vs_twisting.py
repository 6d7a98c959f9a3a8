"""Spheres that slide and spin about the normal, against quadrature of Hertz's pressure
and SciPy's integration of their motion.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.twisting import Twisting, moment_share
from vibroimpact.dynamics.motion.along import Sphere, State
from vibroimpact.dynamics.oblique.lying import lie
from vibroimpact.structures.modal_model import ModalBasis

AGAINST = Against(
    "quadrature over the Hertz pressure, and SciPy's DOP853",
    "own independent computation",
    "oblique impact and friction",
    "friction force and moment of a sliding and twisting contact, in the test",
)


# the spheres of alumina of Kharaz, Gorham and Salman, on glass
RADIUS, MODULUS, SHEAR = 2.5e-3, 62.95e9, 54.08e9
MASS = 4.0 / 3.0 * np.pi * RADIUS**3 * 4000.0
INERTIA = 0.4 * MASS * RADIUS**2
STIFFNESS = 4.0 / 3.0 * MODULUS * RADIUS**0.5
FULL = 3.0 * np.pi / 16.0


def friction(name: str = "mdr", coefficient: float = 0.092, softer: float = 1.0) -> Any:
    pair = {
        "effective_modulus": MODULUS / softer,
        "effective_shear_modulus": SHEAR / softer,
        "effective_radius": RADIUS,
    }
    return vi.friction.find_friction_law(name)(coefficient=coefficient, **pair)


def part_of(law: Any, force: Floats, used: Floats, slip: Floats, spin: Floats) -> Floats:
    """Return the part of the moment of full twisting of contacts under normal forces [N] and the
    friction forces `used` [N].
    """
    twisting = Twisting(law.coefficient, float(law.contact_radius(np.ones(1))[0]))
    return np.array(
        [
            moment_share(twisting, *numbers)
            for numbers in zip(
                *(values.tolist() for values in (force, used, slip, spin)), strict=True
            )
        ]
    )


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(60)


def over_pressure(ratio: float, angles: int = 200) -> tuple[float, float]:
    """Return friction over mu F, and moment over mu F a, by quadrature of Hertz's
    pressure; ratio: rate of twisting a over the slip.
    """
    height, weight = 0.5 * (_NODES[:, None] + 1.0), 0.5 * _WEIGHTS[:, None]
    radius, angle = np.sqrt(1.0 - height**2), (np.arange(angles) + 0.5) * 2.0 * np.pi / angles
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    along, across = 1.0 - ratio * y, ratio * x
    pressed = 3.0 * height**2 * weight / angles / np.hypot(along, across)
    return float((along * pressed).sum()), float(((x * across - y * along) * pressed).sum())


def impact(
    law: Any, speed: float, slip: float, spin: float, plate: vi.Body | None = None
) -> vi.Response:
    """Return the impact of a sphere that slides, onto a rigid plate or another one."""
    oblique = vi.Oblique(velocity=(slip, 0.0), spin=(0.0, 0.0, spin), friction=law)
    values: dict[str, Any] = {"speed": speed, "gravity": 0.0, "impacts": 1, "oblique": oblique}
    hertz = (vi.laws.find_contact_law("hertz")(stiffness=STIFFNESS),)
    return vi.simulate(
        vi.Problem(
            sphere=vi.Body(mass=MASS, contact_offset=RADIUS),
            plate=plate or vi.rigid_plate(),
            laws=hertz,
            **values,
        )
    )


def spin_after(mu: float, speed: float, slip: float, spin: float) -> float:
    """Return the spin after an impact in which the sphere slides throughout, by DOP853
    with the moment by quadrature.
    """

    def rates(_: float, state: Floats) -> list[float]:
        depth = max(state[0], 0.0)
        force = STIFFNESS * depth**1.5
        contact = np.sqrt(RADIUS * depth)
        _, moment = over_pressure(contact * state[3] / state[2])
        return [
            state[1],
            -force / MASS,
            -3.5 * mu * force / MASS,
            -mu * force * contact * moment / INERTIA,
        ]

    def parts(_: float, state: Floats) -> float:
        return float(state[0])

    parts.terminal, parts.direction = True, -1.0  # type: ignore[attr-defined]
    settings: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-13, "first_step": 1e-9, "max_step": 1e-6}
    return float(
        solve_ivp(
            rates, (0.0, 1e-3), [0.0, speed, slip, spin], method="DOP853", events=parts, **settings
        ).y[3, -1]
    )


@pytest.mark.parametrize("ratio", [1e-6, 1e-3, 0.03, 0.3, 0.7, 0.9, 1.2, 2.0, 5.0, 50.0])
def test_the_part_that_sliding_leaves(agrees: Agrees, ratio: float) -> None:
    """By quadrature of Hertz's pressure, which is less exact where a point of the contact
    stands still.
    """
    law, force = friction(), np.array([100.0])
    spin = ratio / law.contact_radius(force)
    part = part_of(law, force, 0.092 * force, np.ones(1), spin)
    case, within = (
        "rim velocity below 0.8 of the sliding velocity"
        if ratio < 0.8
        else "rim velocity above 0.8 of the sliding velocity",
        1e-9 if ratio < 0.8 else 2e-4,
    )
    agrees(
        f"sliding and twisting, {case}",
        "friction moment, normalized by μ F a",
        FULL * part,
        over_pressure(ratio)[1],
        relative=within,
    )


def test_the_limits_of_the_part() -> None:
    """All of it without slip, 16/(15 pi) q in fast slip, 1 - 1/q^2 in slow; continuous
    where the rim begins to turn back.
    """
    law, force = friction(), np.full(5, 100.0)
    rim = np.array([1.0, 1e-7, 1e3, 1.0 - 1e-12, 1.0 + 1e-12])
    slip = np.array([0.0, 1.0, 1.0, 1.0, 1.0])
    part = part_of(law, force, 0.092 * force, slip, rim / law.contact_radius(force))
    assert part[:4] == pytest.approx([1.0, 16e-7 / (15.0 * np.pi), 1.0 - 1e-6, 0.375], rel=1e-11)
    assert part[4] == pytest.approx(part[3], rel=1e-10)
    # a contact without friction sticks
    assert part_of(law, force, 0.0 * force, slip, 0.0 * rim).tolist() == [1.0] * 5


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.3, 2.0, 5.0])
def test_a_contact_that_sticks_has_an_upper_bound(ratio: float) -> None:
    """Friction and moment that Hertz's pressure has together lie within the ellipse, by
    no more than a third of the moment.
    """
    sliding_force, moment = over_pressure(ratio)
    law, force = friction(), np.array([100.0])
    bound = part_of(law, force, 0.092 * sliding_force * force, np.ones(1), np.zeros(1))
    assert moment < FULL * float(bound[0]) < 4.0 / 3.0 * moment


@pytest.mark.parametrize("name", ["mdr", "mindlin"])
@pytest.mark.parametrize(
    ("speed", "slip", "spin"),
    [(2.68, 2.76, 100.0), (2.0, 2.0, 1.0), (2.0, 3.0, -2e4), (2.0, 1.4, 2e5)],
)
def test_an_impact_that_slides(
    agrees: Agrees, name: str, speed: float, slip: float, spin: float
) -> None:
    """What twisting takes from the spin, to 2e-3 of it: some hundredths of a percent of
    the spin, not the 17 % of full twisting.
    """
    response = impact(friction(name), speed, slip, spin)
    expected = abs(spin) - spin_after(0.092, speed, slip, abs(spin))
    found = response.impacts["spin_z_after_rad_s"][0]
    assert 0.0 < abs(found) < abs(spin)
    agrees(
        "sliding impacts, rigid plate",
        "decrease of the angular velocity",
        spin - found,
        np.sign(spin) * expected,
        unit="rad/s",
        relative=2e-3,
    )
    assert expected < 1.5e-3 * abs(spin)
    assert abs(response.energy["closure_relative"]) < 1e-12
    without = impact(friction(name), speed, slip, 0.0).impacts
    for column in ("separation_velocity_x_m_s", "spin_y_after_rad_s"):
        assert response.impacts[column][0] == without[column][0]  # friction does not feel twisting


def still() -> vi.Body:
    """Return a plate whose mode hardly moves."""
    mode = ModalBasis(
        np.array([1e3]),
        np.array([0.02]),
        np.array([1e-9]),
        np.zeros((1, 3)),
        mass=4.0,
        along=np.zeros((1, 2)),
    )
    return vi.Body(mass=np.inf, contact_offset=0.0, modes=mode)


@pytest.mark.parametrize("plate", [vi.rigid_plate(), still()])
@pytest.mark.parametrize("spin", [1e5, 1.0])
def test_an_impact_that_twists_alone(agrees: Agrees, plate: vi.Body, spin: float) -> None:
    """Without slip all of the moment acts, and ends with the spin; the integral of F a by
    quadrature over Hertz's impact.
    """
    depth = (1.25 * MASS * 2.0**2 / STIFFNESS) ** 0.4
    part, weight = 0.25 * np.pi * (_NODES + 1.0), 0.25 * np.pi * _WEIGHTS
    # the speed is 2 m/s times the cosine; both halves of the impact are alike
    deep = depth * np.sin(part) ** 0.8
    pressed = 2.0 * (weight * MASS * 2.0 * np.sin(part) * np.sqrt(RADIUS * deep)).sum()
    found = impact(friction(), 2.0, 0.0, spin, plate).impacts["spin_z_after_rad_s"][0]
    exact = max(spin - FULL * 0.092 * pressed / INERTIA, 0.0)
    agrees(
        "impacts with twisting alone",
        "ratio of angular velocity after to before impact",
        found / spin,
        exact / spin,
        absolute=1e-9,
    )


@pytest.mark.parametrize("name", ["mdr", "mindlin"])
@pytest.mark.parametrize("spin", [1.0, -2e4])
def test_an_impact_that_slides_on_modes(agrees: Agrees, name: str, spin: float) -> None:
    """On a plate that hardly moves, as on a rigid one, to 1e-4 of what twisting takes."""
    found = impact(friction(name), 2.0, 3.0, spin, still()).impacts["spin_z_after_rad_s"][0]
    expected = abs(spin) - spin_after(0.092, 2.0, 3.0, abs(spin))
    agrees(
        "sliding impacts, plate with a vibration mode",
        "decrease of the angular velocity",
        spin - found,
        np.sign(spin) * expected,
        unit="rad/s",
        relative=1e-4,
    )


@pytest.mark.parametrize(("slip", "spin"), [(1.0, 30.0), (0.3, -200.0), (0.01, 300.0), (0.0, 5.0)])
def test_a_sphere_that_lies_slides_and_spins(agrees: Agrees, slip: float, spin: float) -> None:
    """The slip falls by 7/2 mu g to nothing; the spin about the normal slowly until then,
    and then by all of the moment of twisting.
    """
    mu, gravity, until = 0.2, 9.81, 0.15
    law, one = friction(coefficient=mu, softer=1e3), np.ones(1)
    ball = Sphere(MASS * one, RADIUS * one, INERTIA * one, np.zeros((2, 1)))
    start = State(np.zeros((2, 1)), np.array([[slip], [0.0]]), np.array([[0.0], [0.0], [spin]]))
    contact = (0.75 * MASS * gravity * RADIUS / (MODULUS / 1e3)) ** (1.0 / 3.0)

    def rates(time: float, state: Floats) -> list[float]:
        left = slip - 3.5 * mu * gravity * time
        moment = FULL if left <= 0.0 else over_pressure(contact * state[0] / left)[1]
        return [-mu * MASS * gravity * contact * moment / INERTIA]

    stop, settings = slip / (3.5 * mu * gravity), {"method": "DOP853", "rtol": 1e-9, "atol": 1e-12}
    before = solve_ivp(
        rates, (0.0, stop), [abs(spin)], max_step=max(stop, 1e-3) / 200.0, **settings
    ).y[0, -1]
    expected = max(before - (until - stop) * mu * MASS * gravity * contact * FULL / INERTIA, 0.0)
    times = np.linspace(0.0, until, 401)
    state, _, _ = lie(ball, start, law, gravity * one, times[None])
    left = np.abs(state.spin[2])
    assert left[0] == abs(spin)
    agrees(
        "sphere on the plate, sliding and spinning about the normal",
        "angular velocity, normalized by its initial value",
        left[-1] / abs(spin),
        expected / abs(spin),
        absolute=3e-6,
    )
    assert (np.diff(left) <= 0.0).all()
    assert (np.diff(sum(ball.kinetic(state))) <= 0.0).all()
