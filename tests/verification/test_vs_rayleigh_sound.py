"""Microphones against closed forms and quadrature of Rayleigh's integral: a piston in a baffle, a
mode of a simply supported plate, and Kirchhoff's modes to 300 kHz at two million samples a
second."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import dblquad
from scipy.special import j1

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.measuring_chain import RATE, Floats, SimplySupported, driven, rms, sampled
from support import supported_plate
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
from vibroimpact.structures.recipe import (
    PlateOfPlates,
    PlateOfSolids,
    Recipe,
    Reduction,
    modal_model_of,
)
from vibroimpact.structures.sound_paths import Listener, SoundPaths, sound_paths
from vibroimpact.structures.supports.edge import EDGES, Edge

AGAINST = Against(
    "Rayleigh integral, baffled circular piston",
    "closed form",
    "sensors and signals",
    "Pierce, Acoustics, 1981, section 5.7",
)
QUADRATURE = Against(
    "Rayleigh integral by numerical quadrature, vibrating plate",
    "own independent computation",
    "sensors and signals",
    "SciPy's dblquad; midpoint rule with modes to 300 kHz, sampled at 2 MHz, "
    "tests/oracles/measuring_chain.py",
)


SPEED, DENSITY_OF_AIR, STEP = 343.2, 1.2, 1.0 / (8 * 50e3)
FREQUENCIES = np.array([100.0, 500.0, 2e3, 5e3, 10e3, 20e3, 25e3])


def disc(radius: float) -> Mesh:
    """A mesh of a disc, drawn from that of a square."""
    square = plate_mesh((2.0, 2.0), 0.25)
    u, v = square.nodes[:, :2].T
    return replace(
        square,
        nodes=radius
        * np.stack([u * np.sqrt(1.0 - 0.5 * v**2), v * np.sqrt(1.0 - 0.5 * u**2), 0.0 * u], axis=1),
    )


def at_frequencies(paths: SoundPaths, frequency: Floats = FREQUENCIES) -> Any:
    """Pressure over the density of air and the modal acceleration, (modes, frequencies)."""
    return paths.weights @ np.exp(-2j * np.pi * np.outer(paths.delays, frequency))


RADIUS = 0.1
PISTON = disc(RADIUS)
RISING = np.tile([0.0, 0.0, 1.0, 0.0, 0.0], len(PISTON.nodes))[None]


@pytest.mark.parametrize("distance", [0.01, 0.1, 0.5])
def test_axis_of_a_piston(agrees: Agrees, distance: float) -> None:
    """p = 2 rho c u sin(k (sqrt(r^2 + a^2) - r) / 2): A. D. Pierce, Acoustics, 1981,
    section 5.7.
    """
    found = (
        2.0
        * np.pi
        * FREQUENCIES
        * np.abs(at_frequencies(sound_paths(PISTON, listener(distance), RISING))[0])
    )
    k = 2.0 * np.pi * FREQUENCIES / SPEED
    exact = 2.0 * SPEED * np.abs(np.sin(0.5 * k * (np.hypot(distance, RADIUS) - distance)))
    agrees(
        "axis of a circular piston, distances 10 to 500 mm",
        "sound pressure over air density and piston velocity, 100 Hz to 25 kHz",
        found,
        exact,
        unit="m/s",
        absolute=5e-5 * 2.0 * SPEED,
    )


@pytest.mark.parametrize("angle", [0.1, 0.6, 1.3])
def test_far_field_of_a_piston(agrees: Agrees, angle: float) -> None:
    """p = rho c u k a^2 / (2 R) * 2 J1(k a sin) / (k a sin)."""
    far, k = 40.0, 2.0 * np.pi * FREQUENCIES / SPEED
    there = listener(far * np.cos(angle), (far * np.sin(angle), 0.0))
    found = (
        2.0 * np.pi * FREQUENCIES * np.abs(at_frequencies(sound_paths(PISTON, there, RISING))[0])
    )
    x, ahead = k * RADIUS * np.sin(angle), SPEED * k * RADIUS**2 / (2.0 * far)
    agrees(
        "far field of a circular piston",
        "directivity, sound pressure over that on the axis",
        found / ahead,
        np.abs(2.0 * j1(x) / x),
        absolute=1e-3,
    )


def listener(
    distance: float, place: tuple[float, float] = (0.0, 0.0), side: Any = "upper"
) -> Listener:
    return Listener(place, side, distance, SPEED, STEP)


SIZE, DENSITY, MODULUS, POISSON, RATIO = (0.18, 0.15, 0.006), 7850.0, 210e9, 0.3, 0.01
SPOT, THERE, DISTANCE = (-0.011, -0.0147), (0.07, 0.12), 0.15
EDGES_HELD = tuple(Edge(edge, "simply-supported") for edge in EDGES)


@pytest.mark.parametrize(
    ("shape", "tolerance"),
    [
        (PlateOfPlates(SIZE, 0.02, theory="thin"), 5e-4),
        pytest.param(PlateOfSolids(SIZE, 0.01, layers=2), 1e-2, marks=pytest.mark.slow),
    ],
    ids=["plates", "solids"],
)
@pytest.mark.parametrize("side", ["upper", "lower"])
def test_mode_of_a_plate(agrees: Agrees, shape: Any, tolerance: float, side: Any) -> None:
    """The lowest three modes of a simply supported plate, at a point beside it, by
    SciPy's quadrature; bricks have shear besides.
    """
    model = modal_model_of(Recipe(shape, DENSITY, MODULUS, POISSON, EDGES_HELD, Reduction(modes=3)))
    plate = SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 20e3)
    order = np.argsort(plate.omega)[:3]
    found = at_frequencies(model.sound(listener(DISTANCE, THERE, side)), np.array([3e3]))[:, 0]
    outwards = 1.0 if side == "upper" else -1.0
    for mode, number in enumerate(order):
        m, n = plate.m[number] * np.pi / SIZE[0], plate.n[number] * np.pi / SIZE[1]

        def kernel(y: float, x: float, m: float = m, n: float = n) -> complex:
            apart = np.sqrt((x - THERE[0]) ** 2 + (y - THERE[1]) ** 2 + DISTANCE**2)
            shape = np.sin(m * (x + 0.5 * SIZE[0])) * np.sin(n * (y + 0.5 * SIZE[1]))
            return complex(shape * np.exp(-6e3j * np.pi * apart / SPEED) / apart)

        limits = (-0.5 * SIZE[0], 0.5 * SIZE[0], -0.5 * SIZE[1], 0.5 * SIZE[1])
        parts = [
            dblquad(lambda y, x, part=part, kernel=kernel: getattr(kernel(y, x), part), *limits)[0]
            for part in ("real", "imag")
        ]
        exact = outwards * 2.0 / np.sqrt(plate.mass) * complex(*parts) / (2.0 * np.pi)
        sign = np.sign(
            model.at(np.array([[0.04, 0.03]]))[0][mode, 0, 2] * plate.at(0.04, 0.03)[number]
        )
        part = abs(sign * found[mode] - exact) / abs(exact)
        agrees(
            f"three modes of a plate, {type(shape).__name__}",
            "relative difference of the sound pressure",
            part,
            0.0,
            against=QUADRATURE,
            absolute=tolerance,
        )


@pytest.fixture(scope="module")
def response() -> vi.Response:
    case = {
        "sphere": {"radius": 5e-3, "material": "steel"},
        "plate": {
            **supported_plate(SIZE, RATIO),
            "max_frequency": 50e3,
            "mesh": {"theory": "thin", "element_size": 0.01},
        },
        "drop": {"speed": 1.0, "position": list(SPOT), "air": {"density": 1.1}},
        "contact": {"law": "hertz"},
        "run": {"duration": 3e-3},
        "sensors": [
            {"name": "above", "position": list(THERE), "microphone": {"distance": DISTANCE}},
            {
                "name": "below",
                "position": list(THERE),
                "face": "lower",
                "microphone": {"distance": DISTANCE, "air_density": 1.2},
            },
            {
                "name": "close",
                "position": list(SPOT),
                "rate": 20e3,
                "microphone": {"distance": 0.01, "sensitivity": "50 mV/Pa"},
            },
        ],
    }
    return vi.simulate(vi.case_of(case))


@pytest.fixture(scope="module")
def accelerations(response: vi.Response) -> tuple[SimplySupported, Floats]:
    """Those of all modes to 300 kHz, at two million samples a second."""
    plate = SimplySupported(SIZE, DENSITY, MODULUS, POISSON, 300e3)
    times = np.arange(round(4e-3 * RATE) + 1) / RATE
    force = response.at(np.minimum(times, 3e-3))["force_N"]
    return plate, driven(plate.omega, RATIO, plate.at(*SPOT), np.eye(len(plate.omega)), force)[
        "acceleration"
    ]


def pressure(
    plate: SimplySupported,
    accelerations: Floats,
    place: tuple[float, float],
    distance: float,
    across: int,
) -> Floats:
    """Rayleigh's integral by the midpoint rule, each delay shared between two samples."""
    ways = [(np.arange(across) + 0.5) / across - 0.5] * 2
    x, y = (
        part.ravel() for part in np.meshgrid(SIZE[0] * ways[0], SIZE[1] * ways[1], indexing="ij")
    )
    apart = np.sqrt((x - place[0]) ** 2 + (y - place[1]) ** 2 + distance**2)
    late, part = np.divmod(apart / SPEED * RATE, 1.0)
    late = late.astype(int)
    total = np.zeros(accelerations.shape[1])
    for mode, acceleration in enumerate(accelerations):
        shape = np.sin(plate.m[mode] * np.pi * (x / SIZE[0] + 0.5)) * np.sin(
            plate.n[mode] * np.pi * (y / SIZE[1] + 0.5)
        )
        amount = (
            DENSITY_OF_AIR
            / (2.0 * np.pi)
            * 2.0
            / np.sqrt(plate.mass)
            * shape
            * SIZE[0]
            * SIZE[1]
            / across**2
            / apart
        )
        paths = np.bincount(late, amount * (1.0 - part), late.max() + 2) + np.bincount(
            late + 1, amount * part, late.max() + 2
        )
        total += np.convolve(acceleration, paths)[: len(total)]
    return total


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "across", "gain"),
    [("close", 300, 0.05 * 1.1 / 1.2), ("above", 150, 1.1 / 1.2), ("below", 150, -1.0)],
)
def test_an_impact(
    agrees: Agrees,
    response: vi.Response,
    accelerations: tuple[SimplySupported, Floats],
    name: str,
    across: int,
    gain: float,
) -> None:
    """Of the modes kept; and what those above change, which is told."""
    found, (plate, all_modes) = response.signals()[name], accelerations
    place, distance = (SPOT, 0.01) if name == "close" else (THERE, DISTANCE)

    def exact(modes: Floats) -> Floats:
        whole = sampled(
            pressure(plate, modes, place, distance, across), found.sensor.rate, "sigma-delta"
        )
        return np.asarray(gain * whole[: len(found.value)])

    kept = plate.omega < 2.0 * np.pi * 50e3
    same = exact(np.where(kept[:, None], all_modes, 0.0))
    agrees(
        "impact, three microphone positions, retained modes",
        "sound pressure signal",
        found.value,
        same,
        against=QUADRATURE,
        rms=1e-3,
    )
    whole = exact(all_modes)
    assert rms(found.value - whole) / rms(whole) < found.uncertainty < 0.03
