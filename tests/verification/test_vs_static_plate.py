"""The static compliance of plates: closed forms, the layer's own solution, and plate
elements against solids.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from agreement import Against, Agrees
from support import one_in
from vibroimpact.structures.recipe import PlateOfPlates, PlateOfSolids, Recipe, Shape
from vibroimpact.structures.static_compliance import computed_compliance
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.patch import Patch

AGAINST = Against(
    "simply supported elastic layer, double Fourier series",
    "closed form",
    "plates, spheres and modes",
    "exact through the thickness, with the images of a half space; Navier series "
    "(Timoshenko and Woinowsky-Krieger, table 23)",
)
ELEMENTS = Against(
    "plate elements and solid elements of this package",
    "consistency",
    "plates, spheres and modes",
    "two element formulations of this package; no external reference",
)


SIDE, NU, MODULUS = 0.5, 0.3, 210e9
SIMPLE = tuple(Edge(edge, "simply-supported") for edge in EDGES)
CLAMPED = tuple(Edge(edge, "clamped") for edge in EDGES)


def recipe(shape: Shape, supports: tuple = SIMPLE) -> Recipe:
    return Recipe(shape, 7850.0, MODULUS, NU, supports)


def rigidity(thickness: float) -> float:
    return MODULUS * thickness**3 / (12 * (1 - NU**2))


def exact(thickness: float, x: float = 0.0, y: float = 0.0) -> float:
    """A simply supported square layer is solved by its half waves, each as in an infinite one; the
    half space has no edges.

    Both under a Gaussian load so narrow (of width b) that neither the images of the half space nor
    the layer see that it is no point.
    """
    numbers = np.arange(1, int(60 * SIDE / thickness / np.pi)) * np.pi / SIDE
    k = np.hypot(*np.meshgrid(numbers, numbers, indexing="ij"))
    half = 0.5 * k * thickness
    layer = np.cosh(half) ** 2 / (np.sinh(2 * half) - 2 * half) + np.sinh(half) ** 2 / (
        np.sinh(2 * half) + 2 * half
    )
    shape = 4 / SIDE**2 * np.outer(*(np.sin(numbers * (at + SIDE / 2)) ** 2 for at in (x, y)))
    b = 0.15 * thickness
    images = (shape / k * np.exp(-((b * k) ** 2))).sum() - 1 / (4 * np.sqrt(np.pi) * b)
    return float(2 * (1 - NU**2) / MODULUS * ((shape / k * (layer - 1)).sum() + images))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("thickness", "place"), [(0.002, (0.17, 0.03)), (0.05, (0.17, 0.03)), (0.05, (0.0, 0.0))]
)
def test_the_thin_theory_is_kirchhoffs(
    agrees: Agrees, thickness: float, place: tuple[float, float]
) -> None:
    """Navier's series, 0.011600 F a^2 / D in the middle (Timoshenko and
    Woinowsky-Krieger, table 23), however thick the plate is.
    """
    numbers = np.arange(1, 2000) * np.pi / SIDE
    sines = [np.sin(numbers * (at + SIDE / 2)) ** 2 for at in place]
    navier = 4 / SIDE**2 * (np.outer(*sines) / (numbers[:, None] ** 2 + numbers**2) ** 2).sum()
    if place == (0.0, 0.0):
        assert navier / SIDE**2 == pytest.approx(0.0116008, rel=1e-5)
    found = computed_compliance(
        recipe(PlateOfPlates((SIDE, SIDE, thickness), SIDE / 20, "thin")), place
    )
    agrees(
        "Kirchhoff theory, thin and thick plates",
        "deflection at the load point per unit force, times D",
        found * rigidity(thickness),
        navier,
        unit="m²",
        relative=1e-3,
    )


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.17, 0.03)])
@pytest.mark.parametrize(
    ("shape", "tolerance"),
    [
        (PlateOfPlates((SIDE, SIDE, 0.05), SIDE / 7), 6e-4),
        (PlateOfSolids((SIDE, SIDE, 0.05), SIDE / 16, 2), 8e-3),
        (PlateOfPlates((SIDE, SIDE, 0.01), SIDE / 11), 2e-3),
    ],
    ids=["thick", "thick of solids", "thin"],
)
def test_simply_supported(
    agrees: Agrees,
    shape: PlateOfPlates | PlateOfSolids,
    tolerance: float,
    place: tuple[float, float],
) -> None:
    case = (
        f"{'solid' if isinstance(shape, PlateOfSolids) else 'plate'} elements, thickness "
        f"1/{SIDE / shape.size[2]:.0f} of the side"
    )
    found = computed_compliance(recipe(shape), place)
    agrees(
        case,
        "structural compliance at the load point",
        found,
        exact(shape.size[2], *place),
        unit="m/N",
        relative=tolerance,
    )


def test_what_thin_theory_would_miss() -> None:
    """The deflection of a point in Kirchhoff's theory, against that of a layer a tenth as
    thick as long.
    """
    assert exact(0.05) * rigidity(0.05) / SIDE**2 == pytest.approx(0.0116, rel=0.03)
    assert exact(0.05) * rigidity(0.05) / SIDE**2 != pytest.approx(0.0116, rel=0.015)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("thickness", "solid", "layers", "of_shear"),
    one_in(2, [(0.01, 0.02, 2, 0.005), (0.05, 0.025, 3, 0.06)]),
)
def test_clamped_plates_of_either_elements(
    agrees: Agrees, thickness: float, solid: float, layers: int, of_shear: float
) -> None:
    """Within 1 %, which the bricks lack at the clamped edge; the thin theory lacks the
    shear that goes with the bending there.
    """
    plates = PlateOfPlates((SIDE, SIDE, thickness), SIDE / 8)
    solids = PlateOfSolids((SIDE, SIDE, thickness), solid, layers)
    thick, thin, bricks = (
        computed_compliance(recipe(shape, CLAMPED), (0.06, -0.04))
        for shape in (plates, replace(plates, theory="thin"), solids)
    )
    agrees(
        "clamped plate, solid elements against plate elements",
        "structural compliance at the load point",
        bricks,
        thick,
        unit="m/N",
        against=ELEMENTS,
        relative=0.01,
    )
    assert thin == pytest.approx(thick * (1 - of_shear), rel=0.01)


@pytest.mark.slow
def test_the_plate_of_the_paper(agrees: Agrees) -> None:
    """On patches, in the middle: both elements agree, if bricks are refined at the rims
    (else they are 2 % stiffer).
    """
    patches = tuple(Patch(x, y, 0.015) for x in (-0.22, 0.22) for y in (-0.17, 0.17))
    size = (0.52, 0.42, 0.008)
    found = [
        computed_compliance(recipe(shape, patches), (0.0, 0.0))
        for shape in (PlateOfPlates(size, 0.07), PlateOfSolids(size, 0.026, splits=2))
    ]
    case = "the paper's plate, solid elements against plate elements"
    agrees(
        case,
        "structural compliance at the load point",
        found[1],
        found[0],
        unit="m/N",
        against=ELEMENTS,
        relative=0.01,
    )
