"""The estimated number of modes below a frequency, compared with that of the finite
elements, counted by the signs of the pivots.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

import vibroimpact as vi
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.materials import Material
from vibroimpact.structures.mode_count import modes_expected
from vibroimpact.structures.recipe import Recipe, Reduction, elastic_system, held_by


def counted(recipe: Recipe, frequency: float) -> int:
    material = Material(recipe.density, recipe.youngs_modulus, recipe.poissons_ratio)
    structure = recipe.shape.structure(recipe.shape.mesh(recipe.supports), material)
    return elastic_system(held_by(structure, recipe.supports)).count_below(
        2.0 * math.pi * frequency
    )


def estimated(recipe: Recipe, frequency: float) -> float:
    return modes_expected(replace(recipe, reduction=Reduction(max_frequency=frequency)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("case", "body", "frequency"),
    [
        ("paper:type2", "sphere", 25e3),
        ("paper:type2", "sphere", 30e3),
        ("paper:type3", "plate", 5e3),
        ("paper:type3", "plate", 20e3),
    ],
)
def test_of_shipped_cases(case: str, body: str, frequency: float) -> None:
    recipe = elastic_bodies(vi.load_case(case))[body].recipe
    number = counted(recipe, frequency)
    assert estimated(recipe, frequency) == pytest.approx(number, abs=5.0 + 0.07 * number)


THIN, THICK = [0.2, 0.15, 0.005], [0.1, 0.08, 0.04]
BRICKS = {"element": "solid", "mesh": {"element_size": 0.016, "layers": 3, "splits": 0}}


@pytest.mark.parametrize(
    ("size", "supports", "more"),
    [
        (THIN, "free", {}),
        (THIN, "simply-supported", {}),
        (THIN, "clamped", {}),
        ([0.2, 0.02, 0.005], "free", {}),
        (THICK, "free", BRICKS),
    ],
    ids=["free", "simply supported", "clamped", "narrow", "thick"],
)
def test_of_plates(size: list[float], supports: str, more: dict[str, Any]) -> None:
    plate = {"size": size, "material": "steel", "model": "elastic", "supports": supports, **more}
    sphere, drop = {"radius": 0.01, "material": "steel"}, {"speed": 1.0, "gravity": 0.0}
    recipe = elastic_bodies(
        vi.case_of({"sphere": sphere, "plate": plate, "drop": drop, "contact": {"law": "hertz"}})
    )["plate"].recipe
    frequency = 60e3 if more else 30e3
    number = counted(recipe, frequency)
    assert number > 20
    assert estimated(recipe, frequency) == pytest.approx(number, abs=2.0 + 0.1 * number)


def test_a_number_of_modes_is_itself() -> None:
    recipe = elastic_bodies(vi.load_case("paper:type2"))["sphere"].recipe
    assert modes_expected(recipe) == recipe.reduction.modes
    assert estimated(recipe, 1.0) == 0.0
