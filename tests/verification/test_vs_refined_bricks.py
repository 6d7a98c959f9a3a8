"""Default meshes of small plates against bricks refined at edges and rims: within 0.5 %, or what is said of a mode says that it is not.

The plates are thick for their size, so that edges and rims matter more than on most. What is left in the refined bricks is
extrapolated from one split of their rims to the next: each leaves about a quarter.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from vibroimpact.bodies.elastic import plate_recipe
from vibroimpact.materials import Material
from vibroimpact.structures.modes import Elastic
from vibroimpact.structures.recipe import PlateOfSolids, Reduction, computed_model
from vibroimpact.structures.structure import solid_structure
from vibroimpact.structures.supports.bar import Bar
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.patch import Patch, RectangularPatch
from vibroimpact.structures.supports.support import Support, held_by

STEEL = Material(7850.0, 210e9, 0.3)
PMMA = Material(1180.0, 3.3e9, 0.38)
SIZE = (0.13, 0.1, 0.005)
MODES = 8
SUPPORTS: dict[str, tuple[Support, ...]] = {
    "free": (),
    "cantilever": (Edge("x-min", "clamped"),),
    "clamped": tuple(Edge(edge, "clamped") for edge in EDGES),
    "patch": (Patch(0.0, 0.0, 0.012),),
    "square": (RectangularPatch(0.0, 0.0, 0.024, 0.024),),
    "bar": (Bar(0.0, 0.0, 0.012, 0.05, STEEL),),
}


def refined(material: Material, supports: tuple[Support, ...], splits: int) -> np.ndarray:
    shape = PlateOfSolids(SIZE, SIZE[0] / 16, layers=2, splits=splits, lower_splits=splits if supports and supports[0].discs else 0)
    if any(any(support.rims) for support in supports):
        shape = PlateOfSolids(SIZE, SIZE[0] / 16, layers=2, splits=splits, lower_splits=splits)
    held = held_by(solid_structure(shape.mesh(supports), material), supports)
    found = Elastic(held.stiffness, held.mass, held.rigid, held.order).modes(MODES).angular_frequencies / (2 * np.pi)
    return np.asarray(found)


@pytest.mark.parametrize(
    ("name", "material", "element"),
    [
        pytest.param(name, material, element, marks=() if quick else pytest.mark.slow, id=f"{name}-{said}-{element}")
        for name in SUPPORTS
        for material, said in ((STEEL, "steel"), (PMMA, "pmma"))
        for element in ("plate", "solid")
        for quick in [name == "cantilever" and material is STEEL and element == "plate"]
    ],
)
@pytest.mark.slow
def test_default_meshes(name: str, material: Material, element: Literal["plate", "solid"]) -> None:
    supports = SUPPORTS[name]
    coarse, fine = (refined(material, supports, splits) for splits in (1, 2))
    expected = fine - (coarse - fine) / 3.0
    model = computed_model(plate_recipe(SIZE, material, Reduction(modes=MODES), supports, element))
    off = np.abs(model.frequencies / expected - 1.0)
    assert np.all(off[model.frequency_errors < 0.004] < 0.005)
    assert np.all(off < 2.0 * model.frequency_errors + 0.001)  # what the bricks themselves may be off
