"""The static compliance between where a plate is met and where it is watched against the elasticity
of a layer, in double Fourier series.

A load cos-shaped along both axes moves the faces of a layer by A + S and A - S (I. N. Sneddon,
Fourier Transforms, 1951, section 46); a simply supported plate is a periodic layer of such loads.
The series is summed to waves of a fiftieth of the thickness."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.three_dimensional_plate import Elastic, thickness_modes
from vibroimpact.cases.elastic.coupling import coupling_of
from vibroimpact.structures.finite_elements.surface import Side
from vibroimpact.structures.recipe import PlateOfPlates, PlateOfSolids, Recipe
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.transfer_compliance import computed_transfer, transfer_compliances

AGAINST = Against(
    "elastic layer, double Fourier series",
    "closed form",
    "plates, spheres and modes",
    "Sneddon, Fourier Transforms, 1951, section 46",
)
BRICKS = Against(
    "plate elements and solid elements of this package",
    "consistency",
    "plates, spheres and modes",
    "two element formulations of this package; no external reference",
)


LENGTH, WIDTH, THICKNESS, MODULUS, POISSON = 0.3, 0.25, 0.006, 210e9, 0.3
SPOT = (-0.01, -0.015)
HELD = tuple(Edge(edge, "simply-supported") for edge in EDGES)


def place(thicknesses: float) -> tuple[float, float]:
    return SPOT[0] + 0.8 * thicknesses * THICKNESS, SPOT[1] + 0.6 * thicknesses * THICKNESS


@cache
def kernel(theory: str) -> np.ndarray:
    """The displacement of a face under a load cos-shaped along both axes, for each of its waves."""
    k = np.hypot(
        np.pi * np.arange(1, 1500)[:, None] / LENGTH, np.pi * np.arange(1, 1500)[None] / WIDTH
    )
    y, strain = np.minimum(k * THICKNESS, 60.0), MODULUS / (1.0 - POISSON**2)
    less = np.where(y < 0.05, y**3 / 6.0 * (1.0 + y**2 / 20.0), np.sinh(y) - y)
    bending, squeezing = (
        (1.0 + np.cosh(y)) / (2.0 * less),
        (np.cosh(y) - 1.0) / (2.0 * (np.sinh(y) + y)),
    )
    if theory == "plate":
        shear = 5.0 / (6.0 - POISSON) * MODULUS / (2.0 * (1.0 + POISSON)) * THICKNESS
        return np.asarray(12.0 / (strain * THICKNESS**3 * k**4) + 1.0 / (shear * k**2))
    return np.asarray(
        2.0
        / (strain * k)
        * (bending - squeezing if theory == "lower" else bending + squeezing - 1.0)
    )


def series(point: tuple[float, float], theory: str) -> float:
    """The displacement of a point under a unit force on the upper face, as a double sine series."""
    m, n = (np.pi * np.arange(1, 1500) / side for side in (LENGTH, WIDTH))
    along = np.sin(m * (SPOT[0] + 0.5 * LENGTH)) * np.sin(m * (point[0] + 0.5 * LENGTH))
    across = np.sin(n * (SPOT[1] + 0.5 * WIDTH)) * np.sin(n * (point[1] + 0.5 * WIDTH))
    found = 4.0 / (LENGTH * WIDTH) * float(along @ kernel(theory) @ across)
    apart = float(np.hypot(point[0] - SPOT[0], point[1] - SPOT[1]))
    return found + ((1.0 - POISSON**2) / (np.pi * MODULUS * apart) if theory == "upper" else 0.0)


def test_the_faces_of_a_plate(agrees: Agrees) -> None:
    """Plate elements of seven thicknesses, with what a layer has beyond plate theory."""
    recipe = Recipe(
        PlateOfPlates((LENGTH, WIDTH, THICKNESS), 0.0405), 7850.0, MODULUS, POISSON, HELD
    )
    lower: list[tuple[float, Side]] = [(apart, "lower") for apart in (0.0, 0.5, 1.0, 2.0, 5.0)]
    # without bound at the force
    upper: list[tuple[float, Side]] = [(apart, "upper") for apart in (0.5, 1.0, 2.0, 5.0)]
    points = [(place(apart), face) for apart, face in (*lower, *upper)]
    found = computed_transfer(recipe, SPOT, "upper", points, faces=2)[:, 2]
    exact = [series(point, face) for point, face in points]
    agrees(
        "both faces, 0 to 5 plate thicknesses from the force",
        "static compliance",
        found,
        exact,
        unit="m/N",
        relative=0.002,
    )


@pytest.mark.slow
def test_modes_and_what_they_lack(agrees: Agrees) -> None:
    """As a case has them: what the modes left out give is of the face too, and is what
    modes of the exact layer above those kept have.
    """
    case = {
        "sphere": {"radius": 5e-3, "material": "steel"},
        "plate": {
            "size": [LENGTH, WIDTH, THICKNESS],
            "material": "steel",
            "model": "elastic",
            "supports": "simply-supported",
        },
        "drop": {"speed": 1.0, "position": list(SPOT)},
        "contact": {"law": "hertz"},
        "sensors": [
            {"name": str(apart), "position": list(place(apart)), "face": "lower"}
            for apart in (0.0, 2.0, 5.0)
        ],
    }
    case["plate"] |= {"modes": 80}  # type: ignore[operator]
    basis = coupling_of(vi.case_of(case)).modes["plate"]
    for apart in (0.0, 2.0, 5.0):
        carried = float(
            (basis.contact * basis.points[str(apart)][:, 2] / basis.angular_frequencies**2).sum()
        )
        whole = carried + basis.residuals[str(apart)][2]
        agrees(
            "modal sum with residual compliance",
            "static compliance",
            whole,
            series(place(apart), "lower"),
            unit="m/N",
            relative=0.002,
        )
        waves = np.hypot(
            np.pi * np.arange(1, 40)[:, None] / LENGTH, np.pi * np.arange(1, 40)[None] / WIDTH
        )
        omega, face = thickness_modes(
            waves.ravel(), THICKNESS, Elastic(7850.0, MODULUS, POISSON), even=False
        )
        kept = np.argsort(omega[:, 0])[:80]
        sines = [
            np.sin(waves_of(LENGTH) * (x + 0.5 * LENGTH))[:, None]
            * np.sin(waves_of(WIDTH) * (y + 0.5 * WIDTH))
            for x, y in (SPOT, place(apart))
        ]
        shapes = 4.0 / (LENGTH * WIDTH) * (sines[0] * sines[1]).ravel() * face[:, 0] ** 2
        assert carried == pytest.approx((shapes / omega[:, 0] ** 2)[kept].sum(), rel=0.002)


def waves_of(side: float) -> np.ndarray:
    return np.pi * np.arange(1, 40) / side


@pytest.mark.parametrize("apart", [2.0, 5.0])
def test_plate_theory(agrees: Agrees, apart: float) -> None:
    """What goes together with modes of plate theory, whose points are of its middle plane."""
    recipe = Recipe(
        PlateOfPlates((LENGTH, WIDTH, THICKNESS), 0.0405), 7850.0, MODULUS, POISSON, HELD
    )
    found = computed_transfer(recipe, SPOT, "upper", [(place(apart), "upper")])[0, 2]
    agrees(
        "plate theory, 2 and 5 plate thicknesses from the force",
        "static compliance",
        found,
        series(place(apart), "plate"),
        unit="m/N",
        relative=5e-4,
    )


def test_bricks(agrees: Agrees) -> None:
    """Far from the force, where it does not matter how elements see it; their edges are
    held at the lower side alone.
    """
    size = (0.06, 0.06, 0.006)
    recipes = [
        Recipe(shape, 7850.0, MODULUS, POISSON, tuple(Edge(edge, "clamped") for edge in EDGES))
        for shape in (PlateOfSolids(size, 0.004, 2), PlateOfPlates(size, 0.01))
    ]
    point = ((0.012, 0.009), "upper")
    solid, plate = (
        computed_transfer(recipe, (0.0, 0.0), "upper", [point], faces=2)[0] for recipe in recipes
    )
    agrees(
        "solid elements against plate elements",
        "static compliance",
        solid[2],
        plate[2],
        unit="m/N",
        against=BRICKS,
        relative=0.02,
    )
    np.testing.assert_allclose(solid[:2], plate[:2], rtol=0.03)  # the face slides as it tilts


def test_the_store_has_it(tmp_path: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VIBROIMPACT_STORE", str(tmp_path))
    recipe = Recipe(
        PlateOfPlates((LENGTH, WIDTH, THICKNESS), 0.0405), 7850.0, MODULUS, POISSON, HELD
    )
    points: list[tuple[tuple[float, float], Side]] = [(place(2.0), "upper"), (place(3.0), "lower")]
    first = transfer_compliances(recipe, SPOT, "upper", points)
    monkeypatch.setattr("vibroimpact.structures.transfer_compliance.computed_transfer", None)
    np.testing.assert_array_equal(transfer_compliances(recipe, SPOT, "upper", points), first)
    with pytest.raises(TypeError):
        transfer_compliances(recipe, SPOT, "upper", points[:1])
