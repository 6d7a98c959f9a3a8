"""How far frequencies may be off: what is said of each, where it is written, and what is
doubted.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.bodies.elastic import plate_recipe
from vibroimpact.materials import Material
from vibroimpact.structures.frequency_error import main_cause, mesh_errors
from vibroimpact.structures.plate_waves import _lamb, bending_error
from vibroimpact.structures.recipe import (
    PlateOfSolids,
    Recipe,
    Reduction,
    SphereOfSolids,
    computed_model,
)
from vibroimpact.structures.store import load_model, save_model
from vibroimpact.structures.supports.edge import EDGES, Edge

STEEL = Material(7850.0, 210e9, 0.3)
SIZE = (0.5, 0.4, 0.01)
CLAMPED = tuple(Edge(edge, "clamped") for edge in EDGES)
SIMPLY_SUPPORTED = tuple(Edge(edge, "simply-supported") for edge in EDGES)


def test_extrapolation() -> None:
    """Of frequencies that are off by 1 % and 4 %, what is left is 1 %, to first order."""
    np.testing.assert_allclose(
        mesh_errors(np.array([101.0]), np.array([104.0]), 4.0), 0.01, rtol=0.02
    )


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
def test_lambs_wave(nu: float) -> None:
    """Of long waves Kirchhoff's, of short ones Rayleigh's surface wave: c_R / c_T is a
    root of his cubic.
    """
    kirchhoff = 0.05**2 / np.sqrt(6 * (1 - nu))
    long, short = (float(_lamb(np.array([wave]), nu)[0][0]) for wave in (0.05, 40.0))
    assert long == pytest.approx(kirchhoff, rel=2e-3)
    ratio = 0.5 * (1 - 2 * nu) / (1 - nu)
    roots = np.roots([1.0, -8.0, 24.0 - 16.0 * ratio, -16.0 * (1 - ratio)])
    rayleigh = np.sqrt(
        min(root.real for root in roots if abs(root.imag) < 1e-9 and 0 < root.real < 1)
    )
    assert short == pytest.approx(40.0 * rayleigh, rel=1e-4)


def test_error_of_the_theory_grows_with_thickness_over_wavelength() -> None:
    """0.006 % at a tenth of the wave, 0.03 % at a sixth."""
    for part, error in ((1 / 10, 6.0e-5), (1 / 6.2832, 2.8e-4)):
        assert abs(float(bending_error(np.array([2 * np.pi * part]), 0.3)[0])) == pytest.approx(
            error, rel=0.1
        )


def test_cause_is_that_of_the_worst_mode() -> None:
    assert main_cause({"a": np.array([0.3, 0.1]), "b": np.array([0.1, 0.5])}) == "b"
    assert main_cause({}) == ""


@pytest.mark.slow
def test_what_is_said_of_a_sphere_is_how_far_it_is_off() -> None:
    """Twenty modes of the default mesh against the roots of Lamb's equations, omega R /
    c_T, for a Poisson's ratio of 0.28.
    """
    # the speed of shear is 1
    model = computed_model(
        Recipe(SphereOfSolids(1.0), 1.0, 2.0 * 1.28, 0.28, (), Reduction(modes=20))
    )
    exact = np.repeat([2.501133, 2.643768, 3.488696, 3.864700], [5, 5, 3, 7])
    found = model.angular_frequencies
    near = np.array([np.abs(found - root).argmin() for root in np.unique(exact)])
    off = found[near] / np.unique(exact) - 1.0
    ratio = off / model.frequency_errors[near]
    assert np.all(ratio < 2.0)
    assert np.all(ratio > 0.3)


@pytest.mark.parametrize("thickness", [5e-4, pytest.param(4e-3, marks=pytest.mark.slow)])
def test_a_thin_plate_is_told_the_error_of_its_theory_once_and_none_of_its_mesh(
    thickness: float,
) -> None:
    """Kirchhoff's frequencies are those of the closed form to 2e-5; what is told is their
    difference to the plate with shear.
    """
    size = (0.3, 0.2, thickness)
    thick, thin = (
        computed_model(
            plate_recipe(size, STEEL, Reduction(modes=4), SIMPLY_SUPPORTED, theory=theory)
        )
        for theory in ("thick", "thin")
    )
    rigidity = (
        STEEL.youngs_modulus * thickness**2 / 12.0 / (1.0 - STEEL.poissons_ratio**2) / STEEL.density
    )
    squares = sorted(
        (m / size[0]) ** 2 + (n / size[1]) ** 2 for m in range(1, 6) for n in range(1, 6)
    )[:4]
    np.testing.assert_allclose(
        thin.frequencies, 0.5 * np.pi * np.sqrt(rigidity) * np.array(squares), rtol=2e-5
    )
    apart = thin.frequencies / thick.frequencies - 1.0
    np.testing.assert_allclose(thin.frequency_errors, apart, atol=3e-4)
    assert thin.facts["frequencies are off most for"] == "the theory of plates"


def test_the_error_of_plate_theory_vanishes_with_the_square_of_the_thickness() -> None:
    """Of a foil whose waves are a thousand times as long as it is thick rounding told 1.2 %."""
    waves = np.array([1e-4, 1e-3, 1e-2])
    for thin in (True, False):
        np.testing.assert_allclose(
            bending_error(waves, 0.3, thin)[:2] / waves[:2] ** 2,
            bending_error(waves, 0.3, thin)[2] / 1e-4,
            rtol=1e-9,
        )
        assert np.abs(bending_error(waves, 0.3, thin)).max() < 2e-5


@pytest.mark.slow
def test_what_is_said_of_a_clamped_plate_is_how_far_it_is_off() -> None:
    """Plate elements beside bricks, half of them as large as the default and refined at
    the edges: within what both say, and 0.5 %.
    """
    plate = computed_model(plate_recipe(SIZE, STEEL, Reduction(modes=8), CLAMPED))
    solid = computed_model(
        Recipe(
            PlateOfSolids(SIZE, 0.016, layers=2, splits=2, lower_splits=0),
            *_numbers(),
            CLAMPED,
            Reduction(modes=8),
        )
    )
    apart = np.abs(plate.frequencies / solid.frequencies - 1.0)
    assert apart.max() < 0.005
    assert np.all(apart < 1.2 * (plate.frequency_errors + solid.frequency_errors))


def _numbers() -> tuple[float, float, float]:
    return STEEL.density, STEEL.youngs_modulus, STEEL.poissons_ratio


def test_modes_that_stand_for_statics_have_no_error() -> None:
    place = (((0.0, 0.0), "upper"),)
    for reduction in (
        Reduction(modes=6, attachment=place),
        Reduction(modes=6, method="craig-bampton", interface=place),
    ):
        model = computed_model(plate_recipe(SIZE, STEEL, reduction, CLAMPED, element_size=0.1))
        assert len(model.frequencies) > 6
        assert np.isfinite(model.frequency_errors[:6]).all()
        assert np.isnan(model.frequency_errors[6:]).all()


def test_what_a_reduction_leaves_out_is_seen() -> None:
    """Six modes with the middle of a plate held tell less of its sixth than the whole
    plate does.
    """
    place = (((0.0, 0.0), "upper"),)
    whole = computed_model(
        plate_recipe(SIZE, STEEL, Reduction(modes=6), CLAMPED, element_size=0.08)
    )
    reduced = computed_model(
        plate_recipe(
            SIZE,
            STEEL,
            Reduction(modes=6, method="craig-bampton", interface=place),
            CLAMPED,
            element_size=0.08,
        )
    )
    off = reduced.frequencies[:6] / whole.frequencies - 1.0
    more = reduced.frequency_errors[:6] - whole.frequency_errors
    assert off.max() > 0.01
    np.testing.assert_allclose(more, off, rtol=0.1, atol=3e-4)


def test_they_are_kept() -> None:
    model = computed_model(Recipe(SphereOfSolids(1.0, 4), *_numbers(), (), Reduction(modes=3)))
    assert save_model("errors", model) == ""
    found, _ = load_model("errors")
    assert found is not None
    np.testing.assert_array_equal(found.frequency_errors, model.frequency_errors)
    np.testing.assert_array_equal(
        found.scaled(2.0, 3.0, 4.0).frequency_errors, model.frequency_errors
    )


def case(**plate: object) -> vi.Case:
    return vi.case_of(
        {
            "sphere": {"radius": "25 mm", "material": "rock-paper"},
            "plate": {
                "size": list(SIZE),
                "material": "steel-paper",
                "model": "elastic",
                "modes": 12,
                "supports": "clamped",
            }
            | plate,
            "drop": {"speed": 1.0},
            "contact": {"law": "hertz"},
        }
    )


@pytest.mark.slow
def test_they_are_written(tmp_path: Path) -> None:
    asked = case(mesh={"element_size": 0.1})
    modes = vi.compute_modes(asked)
    modes.save(tmp_path / "out")
    with (tmp_path / "out" / "modes.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    found = [float(row["frequency_error"]) for row in rows]
    assert found == modes["plate"].model.frequency_errors.tolist()
    assert (
        json.loads((tmp_path / "out" / "summary.json").read_text())["modes"]["plate"][
            "frequency_errors"
        ]
        == found
    )


@pytest.mark.parametrize(
    ("changed", "remedy"),
    [
        ({"mesh": {"element_size": 0.25}}, "mesh.element_size"),
        ({"size": [0.5, 0.4, 0.1]}, 'element = "solid"'),
        ({"element": "solid", "mesh": {"element_size": 0.1, "splits": 0}}, "mesh.splits = 1"),
    ],
)
def test_a_frequency_far_off_is_doubted(changed: dict[str, object], remedy: str) -> None:
    body = vi.compute_modes(case(**changed))["plate"]
    (doubt,) = (doubt for doubt in body.doubts if "frequencies" in doubt)
    errors = body.model.frequency_errors
    assert (
        f"the frequencies of {(errors > 0.005).sum()} of the 12 modes of the plate may be "
        "off by more than 0.5 %" in doubt
    )
    assert f"{100 * errors.max():.2g} %" in doubt
    assert remedy in doubt


def test_default_meshes_are_not_doubted() -> None:
    assert vi.compute_modes(case())["plate"].doubts == ()
