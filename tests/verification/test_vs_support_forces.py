"""Force sensors under supports against statics, the balance of momentum, and the closed
form of the edges of a simply supported plate.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.measuring_chain import RATE, Floats, SimplySupported, driven, rms, sampled

AGAINST = Against(
    "static equilibrium, momentum balance, and edge forces of the Kirchhoff plate",
    "closed form",
    "sensors and signals",
    "lever rule; modes to 300 kHz, sampled at 2 MHz, tests/oracles/measuring_chain.py",
)


SIZE, DENSITY, MODULUS, POISSON, RATIO = (0.18, 0.15, 0.006), 7850.0, 210e9, 0.3, 1e-3
SPOT = (-0.011, -0.0147)
THREE = [(-0.07, -0.06), (0.07, -0.06), (0.0, 0.06)]
FOUR = [(0.07 * x, 0.055 * y) for x in (-1, 1) for y in (-1, 1)]
EDGES = [(-0.09, 0.0), (0.09, 0.0), (0.0, -0.075), (0.0, 0.075)]


def drop(
    supports: Any,
    places: list[tuple[float, float]],
    plate: dict[str, Any] | None = None,
    **more: Any,
) -> vi.Response:
    """A steel ball on the plate, with a force sensor under each support."""
    case = {
        "sphere": {"radius": 5e-3, "material": "steel"},
        "plate": {
            "size": list(SIZE),
            "material": "steel",
            "model": "elastic",
            "supports": supports,
            "damping": RATIO,
            **(plate or {"modes": 12}),
        },
        "drop": {"speed": 1.0, "position": list(SPOT)},
        "contact": {"law": "hertz"},
        "run": {"duration": 1e-3},
        "sensors": [
            {"name": f"{number}", "position": list(place), "instrument": "force"}
            for number, place in enumerate(places)
        ],
        **more,
    }
    return vi.simulate(vi.case_of(case))


def lever(place: tuple[float, float]) -> Floats:
    """Shares of three points in a weight at a place."""
    return np.linalg.solve(np.array([[1.0, x, y] for x, y in THREE]).T, np.array([1.0, *place]))


def static(response: vi.Response) -> Floats:
    """Forces of the supports under a unit force downwards, of modes and residuals
    together, (supports, 3).
    """
    modes = response.problem.plate.modes
    assert modes is not None
    weights = modes.contact / modes.angular_frequencies**2
    return -np.array(
        [modes.residuals[name] + weights @ modes.points[name] for name in modes.residuals]
    )


def on_points(**one: Any) -> list[dict[str, Any]]:
    return [{"position": place, **one} for place in THREE]


@pytest.mark.slow
@pytest.mark.parametrize(
    "supports",
    [on_points(type="point"), on_points(type="spring", stiffness=1e6)],
    ids=["points", "springs"],
)
def test_lever_rule(agrees: Agrees, supports: Any) -> None:
    agrees(
        "three point supports, three spring supports",
        "support forces per unit static force",
        static(drop(supports, THREE))[:, 2],
        lever(SPOT),
        absolute=1e-6,
    )


PATCHES = {"type": "patches", "spacing": [0.14, 0.11], "radius": 0.01}
BARS = {"type": "bars", "spacing": [0.14, 0.11], "radius": 0.01, "length": 0.1, "material": "steel"}
PADS = [
    {
        "type": "spring",
        "position": place,
        "stiffness": 1e7,
        "horizontal_stiffness": 1e6,
        "radius": 0.01,
    }
    for place in FOUR
]
SOLID = {"modes": 6, "element": "solid", "mesh": {"element_size": 0.015, "layers": 1}}


@pytest.mark.parametrize(
    ("supports", "places", "plate"),
    [
        (on_points(type="point"), THREE, None),
        (PADS, FOUR, None),
        pytest.param(PATCHES, FOUR, None, marks=pytest.mark.slow),
        pytest.param(BARS, FOUR, None, marks=pytest.mark.slow),
        ("clamped", EDGES, None),
        pytest.param(PATCHES, FOUR, SOLID, marks=pytest.mark.slow),
        pytest.param("clamped", EDGES, SOLID, marks=pytest.mark.slow),
    ],
    ids=["points", "pads", "patches", "bars", "clamped", "solid on patches", "solid clamped"],
)
def test_momentum_of_modes(
    agrees: Agrees, supports: Any, places: list[tuple[float, float]], plate: Any
) -> None:
    """In each mode the supports together change the momentum of the plate, along all
    axes; at rest they carry the whole force.
    """
    response = drop(supports, places, plate)
    modes = response.problem.plate.modes
    assert modes is not None
    exact = -(modes.angular_frequencies[:, None] ** 2) * modes.participation
    found = sum(modes.points[f"{number}"] for number in range(len(places)))
    agrees(
        "point, pad, patch, bar and clamped supports",
        "rate of change of modal momentum",
        found,
        exact,
        of_the_largest=1e-6,
    )
    np.testing.assert_allclose(static(response).sum(axis=0), [0.0, 0.0, 1.0], rtol=0.0, atol=1e-8)


def on_edges(frequency: float) -> vi.Response:
    return drop(
        "simply-supported",
        EDGES,
        {"max_frequency": frequency, "mesh": {"theory": "thin", "element_size": 0.01}},
    )


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return on_edges(50e3)


@pytest.fixture(scope="module")
def forces(response: vi.Response) -> Floats:
    """Forces of the four edges by Kirchhoff's modes to 300 kHz at two million samples a second,
    (edges, samples).

    An edge has the integral of the shear force: Kirchhoff's edge force less half of the two corner
    forces is the same."""
    plate = SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 300e3)
    k, q = plate.m * np.pi / SIZE[0], plate.n * np.pi / SIZE[1]
    pull = (
        -2.0
        / np.sqrt(plate.mass)
        * MODULUS
        * SIZE[2] ** 3
        / (12.0 * (1.0 - POISSON**2))
        * (k**2 + q**2)
    )
    along_x, along_y = (
        pull * k / q * (1.0 - (-1.0) ** plate.n),
        pull * q / k * (1.0 - (-1.0) ** plate.m),
    )
    weights = np.stack(
        [along_x, -along_x * (-1.0) ** plate.m, along_y, -along_y * (-1.0) ** plate.n]
    )
    times = np.arange(round(1.7e-3 * RATE) + 1) / RATE
    force = response.at(np.minimum(times, 1e-3))["force_N"]
    return driven(plate.omega, RATIO, plate.at(*SPOT), weights, force)["displacement"]


def off(found: Floats, force: Floats) -> float:
    exact = sampled(force, 50e3, "sigma-delta")[: len(found)]
    return rms(found - exact) / rms(exact)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(4))
def test_edges(agrees: Agrees, response: vi.Response, forces: Floats, number: int) -> None:
    found = response.signals()[f"{number}"].value
    exact = sampled(forces[number], 50e3, "sigma-delta")[: len(found)]
    agrees(
        "each of four supported edges after an impact",
        "support force signal",
        found,
        exact,
        unit="N",
        rms=0.01,
    )


@pytest.mark.slow
def test_balance_of_momentum(agrees: Agrees, response: vi.Response, forces: Floats) -> None:
    """The supports together give the contact force and the change of the plate's momentum."""
    found = sum(signal.value for signal in response.signals().values())
    exact = sampled(forces.sum(axis=0), 50e3, "sigma-delta")[: len(found)]
    agrees(
        "sum of all supports after an impact",
        "support force signal",
        found,
        exact,
        unit="N",
        rms=0.01,
    )


@pytest.mark.slow
@pytest.mark.parametrize("frequency", [16e3, 30e3])
def test_what_fewer_modes_change_is_told(forces: Floats, frequency: float) -> None:
    for name, signal in on_edges(frequency).signals().items():
        assert 0.25 < signal.uncertainty / off(signal.value, forces[int(name)]) < 4.0


def test_a_ball_that_lies_on_three_points(agrees: Agrees) -> None:
    """After it has come to rest and the plate is still, the supports share its weight by
    the lever rule.
    """
    response = drop(
        on_points(type="point"),
        THREE,
        {"modes": 12, "damping": 0.2},
        drop={"height": 0.0055, "position": list(SPOT)},
        contact={"law": "hunt-crossley", "restitution": 0.3},
        run={"duration": 0.2, "impacts": "all"},
    )
    weight = 4.0 / 3.0 * np.pi * 5e-3**3 * 7850.0 * 9.80665
    found = [signal.value[-1] for signal in response.signals().values()]
    agrees(
        "sphere at rest on a plate with three point supports",
        "support forces, normalized by the weight",
        np.array(found) / weight,
        lever(SPOT),
        absolute=1e-4,
    )
