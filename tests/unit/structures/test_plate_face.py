"""The face of a plate of plate elements: which shapes a ball meets, under which
treatment, and what is said of it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from support import one_in, plain_case
from vibroimpact.bodies.elastic import plate_recipe
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.limits.conditions import DropSummary
from vibroimpact.cases.validity.plate_waves import plate_theory_error
from vibroimpact.dynamics.truncation import time_of_contact
from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.results.result import result_of
from vibroimpact.structures.finite_elements.surface import slope_divergence
from vibroimpact.structures.plate_compliance import plate_theory_average
from vibroimpact.structures.plate_face import face_shapes
from vibroimpact.structures.plate_waves import bending_factor, wave_numbers
from vibroimpact.structures.recipe import PlateOfPlates, Recipe, Reduction, modal_model_of
from vibroimpact.structures.supports.edge import EDGES, Edge

STEEL = Material(7850.0, 210e9, 0.3)
PMMA = {"density": 1190.0, "youngs_modulus": 3.3e9, "poissons_ratio": 0.37}


def model(size: tuple[float, float, float], element: float, condition: Any, modes: int) -> Any:
    edges = tuple(Edge(edge, condition) for edge in EDGES)
    return modal_model_of(
        Recipe(PlateOfPlates(size, element), 7850.0, 210e9, 0.3, edges, Reduction(modes=modes))
    )


def case(plate: dict[str, Any] | None = None, radius: float = 0.01, **more: Any) -> vi.Case:
    given = {
        "size": [0.12, 0.1, 0.01],
        "material": PMMA,
        "model": "elastic",
        "supports": "simply-supported",
        "modes": 20,
        **(plate or {}),
    }
    return vi.case_of(
        plain_case(
            sphere={"radius": radius, "material": "steel-paper"},
            plate=given,
            drop={"speed": 1.0, "position": [0.013, 0.007], "gravity": 0.0},
            contact={"law": "hertz", **more},
            run={"impacts": 1},
        )
    )


@pytest.mark.parametrize(
    "place", [(0.0, 0.0), (0.013, 0.007)], ids=["where elements meet", "inside one"]
)
def test_on_simple_supports_each_mode_is_one_wave(place: tuple[float, float]) -> None:
    size = (0.12, 0.1, 0.01)
    found = model(size, 0.01, "simply-supported", 30)
    point = found.at(np.array([place]))[0][:, 0, 2]
    face = face_shapes(found, STEEL, place, point)
    waves = wave_numbers(found.angular_frequencies, size[2], STEEL)
    # not those within the plane, nor those with a node there
    seen = np.abs(point) > 0.05 * np.abs(point).max()
    assert seen.sum() > 5
    np.testing.assert_allclose(
        face[seen] / point[seen], bending_factor(waves[seen] * size[2], 0.3), rtol=2e-4
    )
    pairs = (
        math.pi * np.hypot(np.arange(1, 9)[:, None] / size[0], np.arange(1, 9) / size[1]).ravel()
    )
    assert np.abs(pairs - waves[seen][:, None]).min(axis=1).max() < 1e-4 * waves[seen].max()


def test_near_a_clamped_edge_it_is_the_average_over_a_disc() -> None:
    """Where waves are long the decaying ones count as the others do: by the same mean of r^2."""
    place, thickness = (0.23, 0.03), 0.01
    found = model((0.5, 0.4, thickness), 0.05, "clamped", 12)
    point = found.at(np.array([place]))[0][:, 0, 2]
    average = plate_theory_average(0.75 * thickness, thickness, 0.3, 5 / 5.7)
    rings, weights = np.polynomial.legendre.leggauss(6)
    radii, angles = np.sqrt(0.5 * (rings + 1.0)), 2.0 * np.pi * (np.arange(12) + 0.5) / 12
    discs = (radii[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)).reshape(
        -1, 2
    )
    weight = np.repeat(0.5 * weights / 12, 12) * average.weights(discs)
    disc = found.at(np.array(place) + average.radius * discs)[0][:, :, 2] @ weight
    np.testing.assert_allclose(
        face_shapes(found, STEEL, place, point) - point,
        disc - point,
        atol=0.04 * np.abs(disc - point).max(),
    )


def test_beside_the_plate() -> None:
    with pytest.raises(InputError, match=r"\(0.3, 0\) m is not on the body"):
        slope_divergence(model((0.12, 0.1, 0.01), 0.03, "clamped", 2).mesh, (0.3, 0.0))


@pytest.mark.slow
def test_which_treatment_has_a_face() -> None:
    """A multibody program has nodes, and Kirchhoff's plate points."""
    face, node = case().to_problem(), case(local_compliance="superposed").to_problem()
    assert face.plate.modes is not None
    assert node.plate.modes is not None
    moving = np.abs(node.plate.modes.contact) > 0.5
    ratio = face.plate.modes.contact[moving] / node.plate.modes.contact[moving]
    assert (ratio < 1.0).all()
    assert "plate_theory_inertia_m_s2_N" not in node.facts
    plate = {"mesh": {"theory": "thin"}}
    thin, nodes = case(plate).to_problem(), case(plate, local_compliance="superposed").to_problem()
    np.testing.assert_array_equal(thin.plate.modes.contact, nodes.plate.modes.contact)  # type: ignore[union-attr]
    assert "plate_theory_inertia_m_s2_N" not in thin.facts


@pytest.mark.slow
@pytest.mark.parametrize(
    "more",
    one_in(
        2,
        [{"reduction": "craig-bampton"}, {"attachment_mode": True}],
        lambda more: next(iter(more)),
    ),
)
def test_other_bases_meet_the_same_face(more: dict[str, Any]) -> None:
    """Modes that stand for the statics are no waves, which matters little."""
    plain, other = (vi.simulate(case({"modes": 30, **changes})).impacts for changes in ({}, more))
    for name in ("max_force_N", "restitution_achieved"):
        assert other[name][0] == pytest.approx(plain[name][0], rel=5e-3)


def test_a_contact_too_short_for_plate_elements_is_doubted_with_a_number() -> None:
    """0.54 % of steel, 0.5 mm, on 10 mm of PMMA is what the other waves of the exact
    solution do; half the ball, about twice of it.
    """
    short = result_of(vi.simulate(case(radius=0.0005)))
    estimate = plate_theory_error(short.deformation, short.impacts)
    assert 0.5 * 0.0054 < estimate < 1.5 * 0.0054
    shorter = result_of(vi.simulate(case(radius=0.00025))).doubts
    (doubt,) = (
        text
        for text in shorter
        if "waves through the thickness of the plate, which plate elements do not have" in text
    )
    assert 'take plate.element = "solid"' in doubt
    assert (
        doubts({}, DropSummary(plate_theory=0.004, duration=1e-5))
        == doubts({}, DropSummary())
        == []
    )


def test_bricks_lack_nothing_of_that() -> None:
    response = vi.simulate(case({"element": "solid", "mesh": {"element_size": 0.02}, "modes": 5}))
    assert math.isnan(plate_theory_error(response.problem.facts, response.impacts))


@pytest.mark.slow
def test_how_far_plate_theory_is_off_in_frequency_is_said() -> None:
    (thick,) = vi.compute_modes(case({"modes": 20, "size": [0.12, 0.1, 0.03]}))["plate"].doubts
    assert "due to the theory of plates" in thick
    assert 'take plate.element = "solid"' in thick
    (thin,) = vi.compute_modes(case({"modes": 20, "mesh": {"theory": "thin"}}))["plate"].doubts
    assert 'take plate.mesh.theory = "thick"' in thin


def test_the_time_of_a_visit_of_several_contacts() -> None:
    row = {
        "duration_s": [1e-2],
        "max_indentation_m": [1e-5],
        "approach_speed_m_s": [1.0],
        "contacts": [1],
    }
    assert time_of_contact(row) == 1e-2
    assert time_of_contact({**row, "contacts": [3]}) == pytest.approx(2.9433e-5, rel=1e-5)


def test_bricks_lie_in_as_many_layers_as_their_waves_want() -> None:
    layers = [
        plate_recipe(
            (0.5, 0.4, 0.01), STEEL, Reduction(max_frequency=highest), element="solid"
        ).shape.layers  # type: ignore[attr-defined]
        for highest in (100.0, 40e3, 100e3)
    ]
    assert layers == [1, 3, 3]
    assert (
        plate_recipe(
            (0.5, 0.4, 0.01), STEEL, Reduction(modes=5), element="solid", layers=1
        ).shape.layers
        == 1
    )  # type: ignore[attr-defined]
