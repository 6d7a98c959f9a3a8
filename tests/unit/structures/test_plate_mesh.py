"""What plate elements lack of the compliance at the contact, what is told of it, and what
is doubted.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.bodies.elastic import plate_recipe
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.limits.conditions import DropSummary
from vibroimpact.cases.validity.plate_mesh import PLATE_MESH_COMPLIANCE, plate_mesh_error
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.results.result import result_of
from vibroimpact.results.summary import summary_of
from vibroimpact.runs.deformation import deformation_rows
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
from vibroimpact.structures.mesh_compliance import mesh_compliance
from vibroimpact.structures.recipe import Reduction
from vibroimpact.structures.static_compliance import computed_compliance
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.support import Support

STEEL = Material(7850.0, 210e9, 0.3)
SIZE, PLACE = (0.06, 0.05, 0.001), (0.0015, 0.0055)
SUPPORTS: dict[str, tuple[Support, ...]] = {
    "free": (),
    "simply-supported": tuple(Edge(edge, "simply-supported") for edge in EDGES),
}


def case(
    size: tuple[float, float, float] = SIZE, local: str = "consistent", **plate: Any
) -> vi.Case:
    table = {
        "size": list(size),
        "material": "steel",
        "model": "elastic",
        "supports": "simply-supported",
        "modes": 8,
        "damping": 0.01,
    }
    return vi.case_of(
        {
            "sphere": {"radius": 0.002, "material": "steel"},
            "plate": {**table, **plate},
            "drop": {"speed": 1.0, "position": list(PLACE), "gravity": 0.0},
            "contact": {"law": "hertz", "local_compliance": local},
            "run": {"impacts": 1},
        }
    )


@pytest.mark.parametrize("theory", ["thick", "thin"])
@pytest.mark.parametrize("supports", SUPPORTS)
def test_it_is_what_smaller_elements_add(supports: str, theory: str) -> None:
    """Of elements of nine thicknesses, beside elements of three: within 5 %. Of supports
    within the plate nothing is asked.
    """
    coarse, fine = (
        plate_recipe(
            SIZE, STEEL, Reduction(modes=4), SUPPORTS[supports], element_size=size, theory=theory
        )
        for size in (0.009, 0.003)
    )
    lacking = [
        mesh_compliance(recipe.shape.mesh(recipe.supports), STEEL, SIZE[2], PLACE, theory == "thin")
        for recipe in (coarse, fine)
    ]
    added = computed_compliance(fine, PLACE) - computed_compliance(coarse, PLACE)
    assert lacking[0] - lacking[1] == pytest.approx(added, rel=0.05)
    assert lacking[1] < 0.1 * lacking[0]


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.004, -0.003), (0.008, 0.008)])
def test_elements_as_large_as_the_thickness_lack_nothing(place: tuple[float, float]) -> None:
    """Beside 1.2 / E h, which is about what a plate deforms through its thickness."""
    found = mesh_compliance(plate_mesh((0.16, 0.16), 0.01), STEEL, 0.01, place)
    assert 0.0 <= found < 1e-3 / (STEEL.youngs_modulus * 0.01)


def test_it_is_the_same_turned_and_mirrored() -> None:
    mesh = plate_mesh((0.16, 0.16), 0.04)
    places = [(0.013, 0.004), (-0.013, 0.004), (0.004, -0.013)]
    found = [mesh_compliance(mesh, STEEL, 0.004, place) for place in places]
    np.testing.assert_allclose(found, found[0], rtol=1e-6)


def test_beside_the_plate() -> None:
    with pytest.raises(InputError, match=r"\(0.3, 0\) m is not on the body"):
        mesh_compliance(plate_mesh((0.16, 0.16), 0.04), STEEL, 0.004, (0.3, 0.0))


def test_the_error_of_the_force_is_that_of_a_spring_in_series() -> None:
    """A spring beside Hertz's law, in closed form: E = 2/5 F d + C F^2 / 2 is that of the
    ball, with and without 1 % more of C.
    """
    stiffness, energy, series = 1e9, 1e-2, 2e-8

    def force(compliance: float) -> float:
        low, high = 0.0, 1e6
        for _ in range(200):
            middle = 0.5 * (low + high)
            stored = (
                0.4 * middle * (middle / stiffness) ** (2.0 / 3.0) + 0.5 * compliance * middle**2
            )
            low, high = (middle, high) if stored < energy else (low, middle)
        return low

    more = 0.01 * series
    law = Hertz(stiffness=stiffness)
    depth = (force(series) / law.stiffness) ** (2.0 / 3.0)
    facts = {PLATE_MESH_COMPLIANCE: more, "series_compliance_m_N": series}
    impacts = {"impact": [1], "max_force_N": [force(series)], "max_indentation_m": [depth]}
    assert plate_mesh_error(facts, impacts) == pytest.approx(
        force(series) / force(series + more) - 1.0, rel=0.02
    )


def test_only_plate_elements_with_their_statics_have_it() -> None:
    assert PLATE_MESH_COMPLIANCE in case(modes=4).to_problem().facts
    assert PLATE_MESH_COMPLIANCE not in case(local="superposed", modes=4).to_problem().facts
    bricks = case(element="solid", mesh={"element_size": 0.02}, modes=4).to_problem().facts
    assert math.isnan(plate_mesh_error(bricks, {"impact": [1]}))


@pytest.mark.slow
def test_it_is_told_and_doubted_and_the_remedy_is_one(tmp_path: Path) -> None:
    result = result_of(vi.simulate(case()))
    error = plate_mesh_error(result.deformation, result.impacts)
    assert error > 0.01
    assert summary_of(result)["deformation"][PLATE_MESH_COMPLIANCE] > 0.0
    words = "Estimated error of the largest force due to the mesh of the plate"
    (told,) = (value for row, value in deformation_rows(result) if row == words)
    assert told == f"{100.0 * error:.2g}\u00a0%"
    (doubt,) = (
        text
        for text in result.doubts
        if "elements of the plate are large for its thickness" in text
    )
    assert f"about {100.0 * error:.1f} % too large" in doubt
    size = doubt.split('give plate.mesh.element_size = "')[1].split('"')[0]
    finer = result_of(vi.simulate(case(mesh={"element_size": size})))
    assert 0.0 < plate_mesh_error(finer.deformation, finer.impacts) < 0.005
    assert not any("elements of the plate are large" in text for text in finer.doubts)


def test_a_small_one_is_not_doubted() -> None:
    assert doubts({}, DropSummary(plate_mesh=0.004)) == []
