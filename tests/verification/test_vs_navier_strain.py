"""Strain gauges on a simply supported plate against closed forms: Navier's series of a static
force, the shapes of its modes, and Kirchhoff's modes to 600 kHz at two million samples a second."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.measuring_chain import RATE, Floats, SimplySupported, driven, rms, sampled
from support import one_in, supported_plate
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.instruments.strain_gauge import StrainGauge
from vibroimpact.structures.recipe import (
    PlateOfPlates,
    PlateOfSolids,
    Recipe,
    Reduction,
    modal_model_of,
)
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.transfer_strain import computed_strains

AGAINST = Against(
    "Kirchhoff plate, modal strains and Navier series",
    "closed form",
    "sensors and signals",
    "Navier series; modes to 600 kHz, sampled at 2 MHz, tests/oracles/measuring_chain.py",
)


SIZE, DENSITY, MODULUS, POISSON, RATIO = (0.18, 0.15, 0.006), 7850.0, 210e9, 0.3, 0.002
SPOT, GAUGE = (-0.011, -0.0147), (0.04, 0.02)
EDGES_HELD = tuple(Edge(edge, "simply-supported") for edge in EDGES)


def curvatures(plate: SimplySupported, x: float, y: float) -> Floats:
    """Strains along x and y and of shear on the upper face of Kirchhoff's plate in each
    mode, (3, modes).
    """
    (length, width, thickness), k, q = (
        plate.size,
        plate.m * np.pi / plate.size[0],
        plate.n * np.pi / plate.size[1],
    )
    height, across, up = 2.0 / np.sqrt(plate.mass), k * (x + 0.5 * length), q * (y + 0.5 * width)
    flat = np.sin(across) * np.sin(up)
    return (
        0.5
        * thickness
        * height
        * np.stack([k**2 * flat, q**2 * flat, -2.0 * k * q * np.cos(across) * np.cos(up)])
    )


def matching(
    plate: SimplySupported, omega: Floats, spot: Floats, exact: Floats
) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of bending modes of finite elements, which also stretch the plate, and of those of
    the closed form that they are.

    They agree in frequency, and in the magnitude of the deflection at a place."""
    bends = np.flatnonzero(np.abs(spot) > 1e-6 * np.abs(spot).max())
    near = np.flatnonzero(plate.omega < 1.02 * omega[-1])
    cost = 100.0 * np.abs(np.log(omega[bends, None] / plate.omega[near])) + np.abs(
        np.abs(spot[bends, None] / exact[near]) - 1.0
    )
    mine, theirs = linear_sum_assignment(cost)
    assert len(mine) == len(bends) > 5
    np.testing.assert_allclose(omega[bends[mine]], plate.omega[near[theirs]], rtol=0.01)
    return bends[mine], near[theirs]


@pytest.mark.slow
@pytest.mark.parametrize("side", ["upper", "lower"])
def test_modes(agrees: Agrees, side: Any) -> None:
    recipe = Recipe(
        PlateOfPlates(SIZE, 0.01, theory="thin"),
        DENSITY,
        MODULUS,
        POISSON,
        EDGES_HELD,
        Reduction(modes=20),
    )
    plate = SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 60e3)
    model = modal_model_of(recipe)
    mine, theirs = matching(
        plate, model.angular_frequencies, model.at(np.array([GAUGE]))[0][:, 0, 2], plate.at(*GAUGE)
    )
    exact = curvatures(plate, *GAUGE)[:, theirs] * (1.0 if side == "upper" else -1.0)
    shapes, strains = model.at(np.array([GAUGE]))[0][mine, 0, 2], model.strains(GAUGE, side)[mine]
    signs = np.sign(shapes * plate.at(*GAUGE)[theirs])
    agrees(
        "mode shapes, both faces",
        "modal strains, two normal strains and shear strain",
        strains * signs[:, None],
        exact.T,
        unit="1/(m kg^½)",
        of_the_largest=2e-3,
    )


@pytest.mark.parametrize(
    ("shape", "tolerance"),
    [
        (PlateOfPlates(SIZE, 0.015, theory="thin"), 5e-3),
        (PlateOfPlates(SIZE, 0.015, margin=0.009), 5e-3),
        pytest.param(PlateOfSolids(SIZE, 0.006, layers=2), 1e-2, marks=pytest.mark.slow),
    ],
)
def test_navier(agrees: Agrees, shape: Any, tolerance: float) -> None:
    """A force ten thicknesses away, whose strain the series of all modes gives; a layer
    has its shear besides.
    """
    plate = SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 5e6 / 3.0)
    exact = (plate.at(*SPOT) / plate.omega**2 * curvatures(plate, *GAUGE)).sum(axis=1)
    recipe = Recipe(shape, DENSITY, MODULUS, POISSON, EDGES_HELD, Reduction(modes=5))
    (found,) = computed_strains(recipe, SPOT, "upper", [(GAUGE, "upper")])
    case = "solid elements" if isinstance(shape, PlateOfSolids) else "plate elements"
    agrees(
        f"static response ten plate thicknesses from the force, {case}",
        "strains per unit force",
        found,
        exact,
        unit="1/N",
        of_the_largest=tolerance,
    )


def response_with(frequency: float) -> vi.Response:
    gauges = {
        "along x": {},
        "along y": {"direction": "y"},
        "slanting": {"direction": [1, 1, 0]},
        "below": {"face": "lower"},
    }
    case = {
        "sphere": {"radius": 5e-3, "material": "steel"},
        "plate": {
            **supported_plate(SIZE, RATIO),
            "max_frequency": frequency,
            "mesh": {"theory": "thin", "element_size": 0.01},
        },
        "drop": {"speed": 1.0, "position": list(SPOT)},
        "contact": {"law": "hertz"},
        "run": {"duration": 2e-3},
        "sensors": [
            {"name": name, "position": list(GAUGE), "instrument": "strain-gauge", **more}
            for name, more in gauges.items()
        ],
    }
    return vi.simulate(vi.case_of(case))


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return response_with(50e3)


@pytest.fixture(scope="module")
def strains(response: vi.Response) -> dict[str, Floats]:
    """The strain of the point at two million samples a second, of the modes kept and of
    all others to 600 kHz.
    """
    plate, kept = (
        SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 600e3),
        response.problem.plate.modes,
    )
    assert kept is not None
    mine, theirs = matching(plate, kept.angular_frequencies, kept.contact, plate.at(*SPOT))
    omega, contact, points = plate.omega.copy(), plate.at(*SPOT), curvatures(plate, *GAUGE)
    omega[theirs] = kept.angular_frequencies[mine]  # so that none drifts away from the other
    times = np.arange(round(3.7e-3 * RATE) + 1) / RATE
    x, y, shear = driven(
        omega, RATIO, contact, points, response.at(np.minimum(times, 2e-3))["force_N"]
    )["displacement"]
    return {"along x": x, "along y": y, "slanting": 0.5 * (x + y + shear), "below": -x}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["along x", "along y", "slanting", "below"])
@pytest.mark.parametrize("kind", one_in(2, ["sigma-delta", "butterworth"]))
def test_a_drop(
    agrees: Agrees, response: vi.Response, strains: dict[str, Floats], name: str, kind: str
) -> None:
    sensor = next(one for one in response.problem.sensors if one.name == name)
    found = response.signals(
        Sensor(name, "strain", sensor.direction, filter=kind, instrument=StrainGauge())
    )[name]
    exact = sampled(strains[name], 50e3, kind)[: len(found.value)]
    agrees(
        "impact, strain gauges along x, along y, diagonal and on the lower face",
        "strain signal",
        found.value,
        exact,
        rms=0.01,
    )
    assert found.uncertainty < 0.01


@pytest.mark.slow
def test_what_fewer_modes_change_is_told(strains: dict[str, Floats]) -> None:
    """Curvature converges more slowly than deflection: with few modes the error is large,
    and told within a factor of four.
    """
    for frequency in (8e3, 16e3):
        found = response_with(frequency).signals()["along x"]
        exact = sampled(strains["along x"], 50e3, "sigma-delta")[: len(found.value)]
        error = rms(found.value - exact) / rms(exact)
        assert 0.25 < found.uncertainty / error < 4.0
