"""What the page on elastic bodies says of frequencies."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from stated_numbers import says
from vibroimpact.bodies.elastic import plate_recipe
from vibroimpact.cases.elastic import modes
from vibroimpact.materials import find_material
from vibroimpact.meshes import tied_surfaces
from vibroimpact.meshes.geometry import GEOMETRY, MOST_SECONDS
from vibroimpact.meshes.text_files import MESH
from vibroimpact.structures import static_compliance, store
from vibroimpact.structures.finite_elements import stated_materials
from vibroimpact.structures.plate_waves import bending_error, stretching_error, wave_numbers
from vibroimpact.structures.recipe import (
    PlateOfPlates,
    Recipe,
    Reduction,
    SphereOfSolids,
    computed_model,
)
from vibroimpact.structures.supports.patch import Patch

PAGE = "docs/elastic-bodies.md"
SIZE = (0.52, 0.42, 0.008)  # of the paper's plate [m]


def patches(radius: float) -> tuple[Patch, ...]:
    return tuple(Patch(x, y, radius) for x in (-0.2292, 0.2292) for y in (-0.18, 0.18))


def test_error_of_plate_theory() -> None:
    """Of Mindlin's bending wave, at wavelengths of so many thicknesses."""
    ratio = 0.3
    errors = [
        100.0 * abs(float(bending_error(np.array([2.0 * np.pi / thicknesses]), ratio)[0]))
        for thicknesses in (6.0, 4.0, 2.0)
    ]
    says(PAGE, "thick theory, Poisson's ratio {}: bending", ratio)
    says(
        PAGE, "bending, {} % at wavelengths of six thicknesses, {} % at four, {} % at two", *errors
    )
    steel, thickness = find_material("steel-paper"), 0.008
    stretched = []
    for thicknesses in (6.0, 2.0):
        wave = 2.0 * np.pi / (thicknesses * thickness)
        omega = float(
            brentq(
                lambda at, wave=wave: (
                    float(wave_numbers(np.array([at]), thickness, steel)[0]) - wave
                ),
                1e3,
                1e8,
            )
        )
        stretched.append(100.0 * float(stretching_error(np.array([omega]), thickness, steel)[0]))
    says(
        PAGE,
        "stretching, {} to {} times that at the same frequencies",
        stretched[0] / errors[0],
        stretched[1] / errors[2],
    )


def test_limits() -> None:
    says(
        PAGE,
        "A mass that differs by more than {} % from that of the case",
        100.0 * modes._WEIGHT_OFF,
    )
    says(PAGE, "A mesh may have at most {} GB", MESH.largest / 1e9)
    says(
        PAGE, "a geometry at most {} MB and {} minutes", GEOMETRY.largest / 1e6, MOST_SECONDS / 60.0
    )
    says(PAGE, "when it exceeds {} GB", store._LARGEST / 1e9)
    says(
        PAGE,
        "by default {} % of the mean length of edges of the second surface",
        100.0 * tied_surfaces._REACH,
    )


def test_materials_of_a_mesh_file() -> None:
    density, modulus = stated_materials._SAME_DENSITY, stated_materials._SAME_MODULUS
    says(
        PAGE, "beyond {} % of the density and {} % of the modulus", 100.0 * density, 100.0 * modulus
    )
    says(PAGE, "within {} thicknesses, the static compliance", static_compliance._RADIUS)


@pytest.mark.slow
def test_the_default_sphere() -> None:
    """Against the roots of Lamb's equations for a Poisson's ratio of 0.28: T2, S2, S1 and
    T3, omega R / c_T.
    """
    # the speed of shear is 1
    model = computed_model(
        Recipe(SphereOfSolids(1.0, 8), 1.0, 2.0 * 1.28, 0.28, (), Reduction(modes=20))
    )
    exact = np.repeat([2.501133, 2.643768, 3.488696], [5, 5, 3])
    errors = model.angular_frequencies[:13] / exact - 1.0
    says(
        PAGE,
        "the lowest thirteen modes are accurate to {} % with eight elements across",
        100.0 * float(np.abs(errors).max()),
    )


@pytest.mark.slow
def test_the_papers_plate() -> None:
    steel = find_material("steel-paper")

    def first(**mesh: object) -> float:
        return float(
            computed_model(
                plate_recipe(SIZE, steel, Reduction(modes=2), patches(0.02), "solid", **mesh)
            ).frequencies[0]
        )

    says(
        PAGE,
        "the first frequency of the paper's plate is {} Hz with bricks that are not "
        "refined, {} Hz by default",
        first(splits=0, lower_splits=0),
        first(),
    )
    numbers = (steel.density, steel.youngs_modulus, steel.poissons_ratio)
    smaller = computed_model(
        Recipe(PlateOfPlates(SIZE, element_size=0.04), *numbers, patches(0.01), Reduction(modes=2))
    )
    says(PAGE, "has a far larger effect: {} Hz with {} mm", smaller.frequencies[0], 10.0)
