"""A sphere that falls on another, which takes the place of the plate in a case."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.limits.conditions import Conditions, DropSummary
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.exporting.load_drop import load_drop
from vibroimpact.studies.computation.compute_study import compute_study

STEEL, GLASS = "steel-paper", "glass-chung-ooi"


def case_of(plate: dict[str, Any], **sections: dict[str, Any]) -> Any:
    """A ball of 10 mm that comes at 2 m/s without gravity on another, of glass unless
    said otherwise.
    """
    table: dict[str, Any] = {
        "sphere": {"radius": 0.01, "material": STEEL},
        "plate": {"material": GLASS, **plate},
        "drop": {"speed": 2.0, "gravity": 0.0},
        "contact": {"law": "hunt-crossley", "restitution": 0.8},
        "run": {"impacts": 1, "tolerance": 1e-12},
    }
    return vi.case_of(
        {name: {**table.get(name, {}), **sections.get(name, {})} for name in {**table, **sections}}
    )


def mass_of(radius: float, material: str) -> float:
    return 4.0 / 3.0 * np.pi * radius**3 * float(vi.find_material(material).density)


def test_a_sphere_that_is_held_has_the_stiffness_of_two_curvatures() -> None:
    pair = contact_pair(case_of({"radius": 0.03}))
    assert pair.effective_radius == pytest.approx(0.0075)
    assert pair.effective_mass == pytest.approx(mass_of(0.01, STEEL))
    flat = vi.simulate(case_of({}))
    law = flat.problem.laws[0]
    held, softer = (
        vi.simulate(case_of({"radius": 0.03})),
        vi.simulate(case_of({}, contact={"stiffness": float(law.stiffness) * 0.75**0.5})),
    )
    for column in ("max_force_N", "duration_s", "separation_speed_m_s"):
        assert held.impacts[column] == pytest.approx(softer.impacts[column], rel=1e-12)
    assert vi.simulate(case_of({"radius": 1e9})).impacts["max_force_N"] == pytest.approx(
        flat.impacts["max_force_N"], rel=1e-8
    )


@pytest.mark.parametrize("below", [0.003, 0.01, 0.08])
@pytest.mark.parametrize(
    "law",
    [
        {"law": "hunt-crossley", "restitution": 0.8},
        {"law": "thornton", "yield_pressure": 1e9},
        {"law": "hertz"},
    ],
)
def test_a_free_one_is_the_reduced_mass(below: float, law: dict[str, Any]) -> None:
    plate = {"radius": below, "supports": "free"}
    response = vi.simulate(_with_law(plate, law))
    one, other = mass_of(0.01, STEEL), mass_of(below, GLASS)
    reduced = one * other / (one + other)
    ball = vi.Body(mass=reduced, contact_offset=0.01)
    alone = vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=response.problem.laws,
        speed=2.0,
        gravity=0.0,
        impacts=1,
        tolerance=1e-12,
    )
    wall = vi.simulate(alone)
    for column in (
        "max_force_N",
        "duration_s",
        "separation_speed_m_s",
        "max_indentation_m",
        "energy_lost_J",
    ):
        assert response.impacts[column] == pytest.approx(wall.impacts[column], rel=1e-9, abs=1e-15)
    end = response.at(response.end_time)
    momentum = one * end["velocity_m_s"] + other * end["plate_velocity_m_s"]
    assert momentum == pytest.approx([-2.0 * one], rel=1e-13)
    assert float(response.energy["closure_relative"]) <= 1e-12


def _with_law(plate: dict[str, Any], law: dict[str, Any]) -> Any:
    table = {
        "sphere": {"radius": 0.01, "material": STEEL},
        "plate": {"material": GLASS, **plate},
        "drop": {"speed": 2.0, "gravity": 0.0},
        "contact": law,
        "run": {"impacts": 1, "tolerance": 1e-12},
    }
    return vi.case_of(table)


def test_a_heavy_one_stays_where_it_is() -> None:
    held, heavy = (
        vi.simulate(case_of({"radius": 5.0})),
        vi.simulate(case_of({"radius": 5.0, "supports": "free"})),
    )
    assert heavy.impacts["max_force_N"] == pytest.approx(held.impacts["max_force_N"], rel=1e-7)


def test_two_that_stick_fly_on_together() -> None:
    case = {
        "sphere": {"radius": 1e-5, "material": GLASS},
        "plate": {"radius": 1e-5, "material": GLASS, "supports": "free"},
        "drop": {"speed": 0.005, "gravity": 0.0},
        "contact": {"law": "jkr", "work_of_adhesion": 0.1},
    }
    response = vi.simulate(vi.case_of(case))
    assert response.outcomes == (vi.Outcome.STUCK,)
    mass = mass_of(1e-5, GLASS)
    for entry in ("kinetic_J", "plate_kinetic_J"):  # at half of the speed, each
        assert float(response.energy[entry]) == pytest.approx(0.5 * mass * 0.0025**2, rel=1e-9)


def test_doubts_know_both_curvatures() -> None:
    """The peak pressure of two equal spheres is that of a flat under the same force,
    times 2^(2/3).
    """
    case = case_of({"radius": 0.01})
    conditions = Conditions(resolved_case(case), DropSummary(force=1000.0))
    flat = Conditions(resolved_case(case_of({})), DropSummary(force=1000.0))
    assert conditions.peak_pressure == pytest.approx(2.0 ** (2.0 / 3.0) * flat.peak_pressure)
    assert conditions.effective_mass == pytest.approx(mass_of(0.01, STEEL))


def test_the_case_reads_back() -> None:
    for plate in ({"radius": 0.03}, {"radius": 0.03, "supports": "free"}):
        case = case_of(plate)
        again = vi.case_of(resolved_case(case))
        assert again.plate.radius == 0.03
        assert again.plate.supports == plate.get("supports")
        assert contact_pair(again) == contact_pair(case)


@pytest.mark.parametrize("supports", [{}, {"supports": "free"}])
def test_its_radius_can_be_swept(supports: dict[str, str], tmp_path: Path) -> None:
    radii = [0.01, 0.02, 0.04]
    table = {
        **resolved_case(case_of({"radius": 0.02, **supports})),
        "sweep": {"over": {"plate.radius": radii}},
    }
    del table["contact"]["stiffness"]  # which is that of one radius
    found = vi.studies.load_study(
        compute_study(vi.studies.sweep_of(table), tmp_path / "study")
    ).values("max_force_N")
    single = [
        vi.simulate(case_of({"radius": radius, **supports})).impacts["max_force_N"][0]
        for radius in radii
    ]
    assert found.ravel() == pytest.approx(single, rel=1e-9)


def test_it_is_not_exported(tmp_path: Path) -> None:
    folder = vi.simulate(case_of({"radius": 0.02})).save(tmp_path / "run")
    with pytest.raises(
        vi.InputError,
        match=r"plate.radius: only a drop on a flat plate can be exported, and this sphere",
    ):
        load_drop(folder)


def test_two_spheres_have_no_modes() -> None:
    with pytest.raises(
        vi.InputError,
        match=r"plate\.radius: two spheres are rigid but for their contact, and have no modes",
    ):
        vi.compute_modes(case_of({"radius": 0.02}))


@pytest.mark.parametrize(
    ("plate", "sections", "words"),
    [
        (
            {"radius": 0.02, "size": [1.0, 1.0, 0.01]},
            {},
            "plate.size: a sphere takes the place of the plate, and has no size",
        ),
        (
            {"radius": 0.02, "model": "elastic", "supports": "free"},
            {},
            "plate.model: a sphere in the place of the plate is rigid but for",
        ),
        (
            {"radius": 0.02, "supports": "clamped"},
            {},
            'plate.supports: a sphere in the place of the plate is held fixed, or "free"',
        ),
        (
            {"radius": 0.02, "supports": "free"},
            {"drop": {"gravity": 9.8}},
            "plate.supports: under gravity a sphere that is free falls away",
        ),
        (
            {"radius": 0.02},
            {"drop": {"position": [0.001, 0.0]}},
            "drop.position: beside the top of a sphere the impact is oblique",
        ),
        (
            {"radius": 0.02},
            {"sphere": {"model": "elastic"}},
            "sphere.model: two spheres are rigid but for their contact",
        ),
        (
            {"radius": 0.02},
            {"contact": {"finite_sphere": True}},
            "contact.finite_sphere: two spheres are rigid but for their contact",
        ),
        (
            {"radius": 0.02, "supports": "free", "material": "rigid"},
            {},
            'plate.material: "rigid" has no density',
        ),
        ({"radius": -0.02}, {}, "plate.radius: -0.02 is not allowed; it must be greater than 0 m"),
        ({"supports": "free"}, {}, "plate.supports: a rigid body does not take it"),
        (
            {"radius": 0.02, "supports": "free"},
            {"contact": {"law": "newton", "restitution": 0.5}},
            "newton gives no force",
        ),
    ],
)
def test_what_does_not_fit_is_said(
    plate: dict[str, Any], sections: dict[str, Any], words: str
) -> None:
    if sections.get("contact", {}).get("law"):
        with pytest.raises(vi.InputError) as told:
            _with_law(plate, sections["contact"]).to_problem()
    else:
        with pytest.raises(vi.InputError) as told:
            case_of(plate, **sections).to_problem()
    assert words in str(told.value)
