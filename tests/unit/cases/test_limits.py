"""Limits of the theory: each is doubted from its stated threshold on, with a number, and
not below it.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from rich.console import Console

import vibroimpact as vi
from studies import study_table
from support import plain_case
from vibrating import STIFFNESS, drop_on, modes_of
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.limits.conditions import Conditions, DropSummary
from vibroimpact.cases.limits.limit import limits, numbers_of
from vibroimpact.cases.rigid.expected import expected_of
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.report.terminal_report import terminal_report
from vibroimpact.results.result import result_of
from vibroimpact.studies.computation.compute_study import compute_study
from vibroimpact.units.reading import to_si

STEEL = {"density": 7850, "youngs_modulus": 2.1e11, "poissons_ratio": 0.3, "yield_strength": 1e12}
"""One that never yields, so that nothing is said of strength."""
ELASTIC = {
    "size": [0.4, 0.3, 0.005],
    "material": STEEL,
    "model": "elastic",
    "supports": "clamped",
    "modes": 10,
}


def quiet(**changes: Any) -> dict[str, Any]:
    """A drop of which there is nothing to doubt."""
    calm = {"sphere__material": STEEL, "plate__material": STEEL, "drop": {"speed": 0.1}}
    return plain_case(**{**calm, **changes})


def told(case: dict[str, Any], **seen: float) -> list[str]:
    """What is doubted of a case, expected or with what is given."""
    read = vi.case_of(case)
    expected = expected_of(read)
    return doubts(resolved_case(read), DropSummary(**{**vars(expected), **seen}))


def test_there_is_nothing_to_doubt_of_a_calm_drop() -> None:
    assert told(quiet()) == []
    assert result_of(vi.simulate(vi.case_of(quiet()))).doubts == []


def number(case: dict[str, Any], name: str, **seen: float) -> float:
    read = vi.case_of(case)
    return float(
        numbers_of(
            Conditions(resolved_case(read), DropSummary(**{**vars(expected_of(read)), **seen}))
        ).get(name, math.nan)
    )


ROCK = {"density": 2600, "youngs_modulus": 5e10, "poissons_ratio": 0.25}


def viscous(time: float) -> dict[str, Any]:
    return {"contact": {"law": "kuwabara-kono", "dissipation_time": time}}


def fading(depth: str) -> dict[str, Any]:
    return {
        "contact": {"law": "adams-impact", "damping_max": 10.0, "full_damping_penetration": depth}
    }


def near_edge(x: float) -> dict[str, Any]:
    return {"plate__size": [0.1, 0.1, 0.01], "drop": {"speed": 0.1, "position": [x, 0]}}


def small(radius: float) -> dict[str, Any]:
    return {"sphere__radius": radius, "drop": {"speed": 0.05}}


def given_up_to(speed: float) -> dict[str, Any]:
    """A restitution that is given from 0.01 m/s to a speed, and a drop that comes at 1 m/s."""
    restitution = {"speed": [0.01, speed], "value": [0.6, 0.5]}
    return {
        "contact": {"law": "tsuji", "restitution": restitution},
        "drop": {"height": 0.025 + 1.0 / 19.6133},
    }


def in_air(speed: float, **changes: Any) -> dict[str, Any]:
    return {"drop": {"speed": speed, "air": True}, **changes}


def light(density: float) -> dict[str, Any]:
    return in_air(
        2.0, sphere__material={"density": density, "youngs_modulus": 1e7, "poissons_ratio": 0.3}
    )


def in_water(speed: float) -> dict[str, Any]:
    return {
        "drop": {"speed": speed},
        "contact": {"law": "tsuji", "restitution": 0.6, "liquid": True},
    }


@pytest.mark.parametrize(
    ("name", "threshold", "below", "beyond", "words"),
    [
        (
            "air_drag",
            0.01,
            {"drop": {"height": 17.0}},
            {"drop": {"height": 19.0}},
            ["slower", "vacuum", "drop.air", "drop.speed = "],
        ),
        (
            "finite_sphere",
            0.02,
            {"drop": {"speed": 4.0}},
            {"drop": {"speed": 5.0}},
            ["too small", "finite_sphere = true"],
        ),
        ("relaxation", 0.1, viscous(2.6e-5), viscous(2.9e-5), ["first order", "shorter time"]),
        ("adhesion", 0.01, small(2e-5), small(1e-5), ["J/m^2", "stick below", '"jkr"']),
        (
            "plate_edge",
            1.0,
            near_edge(0.045),
            near_edge(0.0453),
            ["half space is too stiff", "choose drop.position"],
        ),
        ("full_damping", 1.0, fading("9 um"), fading("10 um"), ["never acts in full", "calibrate"]),
        # Reynolds number 1.2 v 2 R / 1.81e-5 in air, 998 v 2 R / 1e-3 in water, of a radius of 25
        # mm
        (
            "drag_coefficient",
            1.0,
            in_air(90.0),
            in_air(91.0),
            ["Reynolds number", "drop.air.drag_coefficient"],
        ),
        ("drag_coefficient", 1.0, in_water(5.9), in_water(6.1), ["Reynolds number", "uncertain"]),
        # 1 - (rho - 1.2) / (rho + 0.6) of a density rho
        (
            "air_buoyancy",
            0.01,
            light(180.0),
            light(179.0),
            ["buoyancy", "contact.liquid = { density = 1.2, viscosity = 1.81e-05 }"],
        ),
        (
            "mach",
            0.3,
            in_air(102.0),
            in_air(104.0),
            ["speed of sound", "take the rebounds for uncertain"],
        ),
        (
            "speeds_given",
            1.05,
            given_up_to(0.96),
            given_up_to(0.95),
            ["is given for approach speeds", "the nearest one holds"],
        ),
    ],
)
def test_a_limit_is_doubted_from_its_threshold_on(
    name: str, threshold: float, below: dict[str, Any], beyond: dict[str, Any], words: list[str]
) -> None:
    assert limits()[name].threshold == threshold
    assert not any(words[0] in doubt for doubt in told(quiet(**below)))
    assert number(quiet(**below), name) < threshold < number(quiet(**beyond), name)
    (doubt,) = (doubt for doubt in told(quiet(**beyond)) if words[0] in doubt)
    assert all(part in doubt for part in words)
    assert any(letter.isdigit() for letter in doubt)


def test_a_stiffness_of_another_exponent_is_doubted() -> None:
    """Hertz's number of N/m^1.5 was taken as one of N/m^1.8 without a word."""
    words = "which no theory gives"
    for law in (
        {"law": "hertz"},
        {"law": "hertz", "exponent": 1.5},
        {"law": "hertz", "exponent": 1.8, "stiffness": 1e10},
    ):
        assert not any(words in doubt for doubt in told(quiet(contact=law)))
    (doubt,) = (
        doubt for doubt in told(quiet(contact={"law": "hertz", "exponent": 1.8})) if words in doubt
    )
    assert "in N/m^1.8" in doubt
    assert number(
        quiet(contact={"law": "hertz", "exponent": 1.8}), "stiffness_of_exponent"
    ) == pytest.approx(0.3)


def test_a_deep_contact_is_doubted_with_its_strain() -> None:
    case = quiet()
    assert not any("strains" in doubt for doubt in told(case, depth=0.29**2 * 0.025))
    (doubt,) = (doubt for doubt in told(case, depth=0.31**2 * 0.025) if "strains" in doubt)
    assert "0.31 of the sphere's" in doubt


def test_a_deep_contact_of_two_spheres_is_one_of_their_effective_radius() -> None:
    case = quiet(plate__radius=0.025)
    (doubt,) = (doubt for doubt in told(case, depth=0.31**2 * 0.0125) if "strains" in doubt)
    assert "0.31 of the effective radius of both spheres" in doubt


@pytest.mark.parametrize(
    ("drop", "plate"),
    [
        ({"height": 5.0}, {}),
        ({"height": 5.0}, {"inclination": 0.8}),
        ({"height": 5.0, "velocity": [0, 0, 5.0]}, {}),
        ({"height": 5.0, "velocity": [0, 0, -5.0]}, {}),
        ({"height": 1.0, "velocity": [0, 0, -15.0]}, {}),
    ],
)
def test_the_loss_by_drag_is_that_of_a_fall_in_air(
    drop: dict[str, Any], plate: dict[str, Any]
) -> None:
    def touches(**flight: Any) -> float:
        case = quiet(
            sphere__radius=0.002,
            drop={**drop, **flight},
            plate={"material": STEEL, **plate},
            run={"impacts": 1},
        )
        return float(vi.simulate(vi.case_of(case)).impacts["approach_speed_m_s"][0])

    case = quiet(sphere__radius=0.002, drop=drop, plate={"material": STEEL, **plate})
    assert number(case, "air_drag") == pytest.approx(1.0 - touches(air=True) / touches(), rel=0.03)
    (doubt,) = (doubt for doubt in told(case) if "in air the first touch" in doubt)
    assert ("or drop.speed = " in doubt) == ("velocity" not in drop and not plate)


def test_a_ball_that_is_too_light_for_drag_alone_is_sent_into_air_as_a_liquid() -> None:
    foam = {"density": 30, "youngs_modulus": 1e7, "poissons_ratio": 0.3}
    (doubt,) = (
        doubt
        for doubt in told(quiet(sphere__material=foam, drop={"height": 1.0}))
        if "in air the first touch" in doubt
    )
    liquid = {"density": 1.2, "viscosity": 1.81e-05}
    assert (
        "give contact.liquid = { density = 1.2, viscosity = 1.81e-05 } with a law that "
        "takes a restitution" in doubt
    )
    with pytest.raises(vi.InputError, match=r"drop\.air\.density"):
        vi.case_of(quiet(sphere__material=foam, drop={"height": 1.0, "air": True}))
    vi.case_of(
        quiet(sphere__material=foam, contact={"law": "tsuji", "restitution": 0.6, "liquid": liquid})
    )


def test_no_law_that_a_liquid_refuses_is_proposed_in_one() -> None:
    wet = {"contact": {"law": "tsuji", "restitution": 0.6, "liquid": True}}
    assert not any("adhesion" in doubt for doubt in told(quiet(**{**small(1e-5), **wet})))
    soft = {**STEEL, "yield_strength": 1e7}
    (doubt,) = (doubt for doubt in told(quiet(sphere__material=soft, **wet)) if "yields" in doubt)
    assert "meyer" not in doubt


def test_a_flight_along_the_plate_is_as_fast_as_one_to_it() -> None:
    assert number(quiet(**in_air(104.0)), "mach") == pytest.approx(104.0 / 343.2)
    oblique = {"drop": {"speed": 104.0, "angle": "60 deg", "air": True}}
    assert number(quiet(**oblique), "mach") == pytest.approx(104.0 / 343.2)
    thrown = {"drop": {"velocity": [0.6 * 104.0, 0.0, -0.8 * 104.0], "air": True}}
    assert number(quiet(**thrown), "mach") == pytest.approx(104.0 / 343.2)


def test_an_edge_is_as_near_as_an_oblique_drop_flies_to_it() -> None:
    size = {"plate__size": [1.0, 1.0, 0.01]}
    case = quiet(drop={"height": 0.5, "position": [0.43, 0.0], "velocity": [0.2, 0.0, 0.0]}, **size)
    landed = float(vi.simulate(vi.case_of(case)).impacts["position_x_m"][0])
    (doubt,) = (doubt for doubt in told(case) if "from the edge" in doubt)
    assert f"the first contact is about {0.5 - landed:.3g} m from the edge of the plate" in doubt
    assert not any(
        "from the edge" in doubt
        for doubt in told(quiet(drop={**case["drop"], "velocity": [-0.2, 0.0, 0.0]}, **size))
    )


def test_a_rigid_plate_is_doubted_where_the_contact_reaches_over_its_edge() -> None:
    rigid = {"plate__material": "rigid", "plate__size": [0.1, 0.1, 0.01]}
    assert not any(
        "edge" in doubt
        for doubt in told(quiet(drop={"speed": 0.1, "position": [0.049, 0.0]}, **rigid))
    )
    (doubt,) = (
        doubt
        for doubt in told(quiet(drop={"speed": 0.1, "position": [0.04999, 0.0]}, **rigid))
        if "edge" in doubt
    )
    assert "it reaches over the edge" in doubt


def test_a_plate_with_no_place_far_from_its_edges_is_too_small() -> None:
    block = {**ELASTIC, "size": [0.02, 0.02, 0.02]}
    (doubt,) = (doubt for doubt in told(quiet(plate=block)) if "from the edge" in doubt)
    assert doubt.endswith("take a larger plate, on which it keeps 0.04 m")


def test_light_balls_that_fall_on_a_sphere_are_not_sent_into_a_liquid() -> None:
    (doubt,) = (
        doubt for doubt in told(quiet(**light(100.0), plate__radius=0.1)) if "buoyancy" in doubt
    )
    assert doubt.endswith("take the speeds of impacts for too high")


def test_what_a_thin_plate_gives_way_is_no_contact_radius() -> None:
    """Hertz's contact radius at 0.3 N is 0.0007 of the radius; the indentation of a foil
    would stand for 0.4 of it.
    """
    case = quiet(plate=ELASTIC)
    assert not any("strains" in doubt for doubt in told(case, depth=0.4**2 * 0.025, force=0.3))
    assert any("strains" in doubt for doubt in told(case, depth=0.4**2 * 0.025, force=3e8))


def test_a_plate_that_stretches_is_doubted_with_how_much_stiffer_it_is() -> None:
    case = quiet(plate=ELASTIC)
    assert not any("stretches" in doubt for doubt in told(case, deflection=0.00099))
    (doubt,) = (doubt for doubt in told(case, deflection=0.0025) if "stretches" in doubt)
    assert "0.5 of its thickness" in doubt
    assert "about 5 % if its edges may slide" in doubt
    assert "11 % if they are held" in doubt
    assert not any(
        "stretches" in doubt
        for doubt in told(
            quiet(plate={"material": STEEL, "size": [0.4, 0.3, 0.005]}), deflection=0.01
        )
    )


def test_a_run_knows_how_far_its_plate_gives_way_and_a_check_expects_it() -> None:
    case = vi.case_of(quiet(plate=ELASTIC, drop={"speed": 6.0}, run={"impacts": 1}))
    deflection = float(np.abs(vi.simulate(case).history()["plate_deflection_m"]).max())
    assert deflection > 0.2 * 0.005
    assert expected_of(case).deflection == pytest.approx(deflection, rel=0.5)
    (doubt,) = (doubt for doubt in result_of(vi.simulate(case)).doubts if "stretches" in doubt)
    assert f"{deflection / 0.005:.2g} of its thickness" in doubt


def test_near_an_edge_an_elastic_plate_asks_for_two_thicknesses() -> None:
    places = {
        at: quiet(plate=ELASTIC, drop={"speed": 0.1, "position": [0.0, at]}) for at in (0.13, 0.145)
    }
    assert number(places[0.13], "plate_edge") == pytest.approx(0.5)
    (doubt,) = (doubt for doubt in told(places[0.145]) if "edge" in doubt)
    assert "1 thicknesses" in doubt
    with pytest.raises(vi.InputError, match="lies outside the plate"):
        vi.case_of(quiet(plate=ELASTIC, drop={"speed": 0.1, "position": [0.0, 0.16]}))


def strengths(sphere: dict[str, Any], plate: Any, **changes: Any) -> list[str]:
    """What is said of strength where a ball of 25 mm strikes at 10 m/s."""
    found = told(
        quiet(sphere__material=sphere, plate__material=plate, drop={"speed": 10.0}, **changes)
    )
    return [doubt for doubt in found if "peak pressure" in doubt or "rim of the contact" in doubt]


def test_each_body_is_held_to_its_own_strength() -> None:
    """The pressure is Hertz's, in closed form; yield is at 1.6 times the strength, a
    crack where (1 - 2 nu) p / 3 is that in tension.
    """
    mass, modulus = (
        4 / 3 * math.pi * 0.025**3 * 2600,
        1 / ((1 - 0.25**2) / 5e10 + (1 - 0.3**2) / 2.1e11),
    )
    depth = (15 * mass * 10.0**2 / (16 * modulus * math.sqrt(0.025))) ** 0.4
    pressure = 2 * modulus / math.pi * math.sqrt(depth / 0.025)
    for part, plate_yields in ((0.99, True), (1.01, False)):
        plate = {**STEEL, "yield_strength": part * pressure / 1.6}
        found = strengths({**ROCK, "tensile_strength": 1.01 * pressure / 6}, plate)
        assert [doubt.startswith("the plate yields: ") for doubt in found] == [True] * plate_yields
    (cracks,) = strengths(
        {**ROCK, "tensile_strength": 0.99 * pressure / 6, "name": "my rock"}, STEEL
    )
    assert cracks.startswith("the sphere (my rock) cracks: ")
    assert "leaves this out: take the force for an upper bound" in cracks
    assert pressure > 1e9
    assert f"the tension at the rim of the contact, {pressure / 6e6:.3g} MPa" in cracks
    (crushed,) = strengths({**ROCK, "compressive_strength": 0.9 * pressure / 1.6}, STEEL)
    assert crushed.startswith("the sphere is crushed")


def test_a_strength_that_is_not_known_is_said_so() -> None:
    (unknown,) = strengths(
        ROCK, {key: STEEL[key] for key in ("density", "youngs_modulus", "poissons_ratio")}
    )
    assert "whether the sphere and the plate yield or crack" in unknown
    assert "is not known" in unknown
    (unknown,) = strengths(ROCK, "rigid")
    assert "whether the sphere yields or cracks" in unknown
    assert strengths({**ROCK, "tensile_strength": 1e12}, "rigid") == []


def test_laws_that_know_of_it_are_not_doubted() -> None:
    plastic = {"law": "thornton", "yield_pressure": 1e9}
    assert strengths(ROCK, STEEL, contact=plastic) == []
    sticky = quiet(
        sphere__radius=1e-5, drop={"speed": 0.05}, contact={"law": "jkr", "work_of_adhesion": 0.05}
    )
    assert not any("adhesion" in doubt for doubt in told(sticky))
    assert not any(
        "too small" in doubt
        for doubt in told(quiet(drop={"speed": 300.0}, contact={"law": "hertz", "stiffness": 1e8}))
    )


def test_materials_take_strengths_and_refuse_what_is_none() -> None:
    case = vi.case_of(
        quiet(
            sphere__material={
                **ROCK,
                "tensile_strength": "12 MPa",
                "compressive_strength": "140 MPa",
            }
        )
    )
    assert (case.sphere.material.tensile_strength, case.sphere.material.compressive_strength) == (
        12e6,
        140e6,
    )
    assert resolved_case(vi.case_of(resolved_case(case))) == resolved_case(case)
    with pytest.raises(
        vi.InputError,
        match=r"sphere\.material\.tensile_strength: -12 is not allowed; it must be greater than "
        r"0 Pa",
    ):
        vi.case_of(quiet(sphere__material={**ROCK, "tensile_strength": -12}))


def test_hardness_is_read_as_a_pressure_and_changes_nothing() -> None:
    plain = vi.case_of(quiet())
    given = [
        vi.case_of(quiet(sphere__material={**ROCK, "hardness": hardness}))
        for hardness in (1e9, "1 GPa", "1000 MPa")
    ]
    assert [case.sphere.material.hardness for case in given] == [1e9, 1e9, 1e9]
    assert resolved_case(given[0])["sphere"]["material"]["hardness"] == 1e9
    assert resolved_case(vi.case_of(resolved_case(given[0]))) == resolved_case(given[0])
    assert told(quiet(sphere__material={**ROCK, "hardness": 1e9})) == told(
        quiet(sphere__material=ROCK)
    )
    assert plain.sphere.material.hardness is None
    with pytest.raises(vi.InputError, match=r"sphere\.material\.hardness: 0 is not allowed"):
        vi.case_of(quiet(sphere__material={**ROCK, "hardness": 0}))


# studies -----------------------------------------------------------------------------------------


def kept(study: vi.studies.Study, name: str) -> np.ndarray:
    return study.values(f"limit_{name}")


def test_a_study_holds_each_drop_to_each_limit_as_a_run_does(tmp_path: Path) -> None:
    over = {
        "sphere.radius": {"from": "1 mm", "to": "50 mm", "number": 3, "scale": "log"},
        "drop.height": ["0.2 m", "4 m"],
    }
    sweep = vi.studies.sweep_of(
        study_table({"over": over}, plate__size=[0.1, 0.1, 0.01], drop__position=[0.0499, 0.0])
    )
    study = vi.studies.load_study(compute_study(sweep, tmp_path / "study"))
    flags = dict(zip(*told_flags(study), strict=True))
    for drop in range(sweep.size):
        result = result_of(vi.simulate(sweep.case_of(drop)))
        place = np.unravel_index(drop, (3, 2))
        beyond = {name for name, mask in flags.items() if study.values("doubts")[place] & mask}
        exceeded = {name: words for name in limits() if (words := sentence(result, name))}
        assert beyond == set(exceeded)
        # of limits that are about the same thing a run tells the worst
        by_group: dict[str, list[str]] = {}
        for name, words in exceeded.items():
            by_group.setdefault(limits()[name].group or name, []).append(words)
        assert all(
            sum(words in result.doubts for words in group) == 1 for group in by_group.values()
        )
        for name, value in numbers_of(Conditions(result.case, result._drop_summary)).items():
            assert kept(study, name)[place] == pytest.approx(float(value), rel=1e-5)


def told_flags(study: vi.studies.Study) -> tuple[list[str], list[int]]:
    with h5py.File(study.path, "r") as file:
        attributes = file["doubts"].attrs
        return str(attributes["flag_meanings"]).split(), attributes["flag_masks"].tolist()


def sentence(result: Any, name: str) -> str:
    conditions = Conditions(result.case, result._drop_summary)
    number = numbers_of(conditions).get(name, math.nan)
    return (
        limits()[name].sentence(conditions, float(number))
        if number > limits()[name].threshold
        else ""
    )


def test_a_study_says_how_many_drops_which_and_the_worst(tmp_path: Path) -> None:
    over = {"sphere.radius": ["2 mm", "25 mm", "50 mm"]}
    study = vi.studies.load_study(
        vi.studies.run_sweep(
            vi.studies.sweep_of(study_table({"over": over}, drop__height=4.0)), tmp_path / "study"
        )
    )
    drag = kept(study, "air_drag")
    (found,) = (doubt for doubt in study.doubts if doubt.limit == "air_drag")
    assert (found.drops, found.worst) == (int((drag > 0.01).sum()), 0) == (2, 0)
    assert found.number == pytest.approx(float(drag[0]))
    said = (
        f"air drag: 2 of 3 drops, worst -{100 * drag[0]:.2g} % at drop 0 (sphere.radius 2.000 mm)"
    )
    console = Console(width=200)
    with console.capture() as printed:
        console.print(terminal_report(study.report))
    page = (study.path.parent / "report.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    assert said in printed.get().replace("\u00a0", " ")
    assert said in page
    rows = (study.path.parent / "drops.csv").read_text().splitlines()
    assert rows[0].endswith(",outcome,doubts,reason")
    assert "air_drag finite_sphere strength_not_known" in rows[1]


def test_a_study_of_plates_keeps_how_far_they_give_way(tmp_path: Path) -> None:
    sweep = vi.studies.sweep_of(
        {**quiet(plate=ELASTIC, run={"impacts": 1}), "sweep": {"over": {"drop.speed": [0.1, 6.0]}}}
    )
    study = vi.studies.load_study(compute_study(sweep, tmp_path / "study"))
    (deflection,) = (doubt for doubt in study.doubts if doubt.limit == "plate_deflection")
    assert (deflection.drops, deflection.worst) == (1, 1)
    history = vi.simulate(sweep.case_of(1)).history()["plate_deflection_m"]
    assert deflection.number == pytest.approx(float(np.abs(history).max()) / 0.005, rel=0.05)


# the finite size of a rigid sphere ---------------------------------------------------------------

ELEMENT = {
    "law": "hertz",
    "local_compliance": "identified",
    "local_stiffness": 1e6,
    "local_damping": 1.0,
}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"contact": {"law": "newton", "restitution": 0.5, "finite_sphere": True}},
            "finite_sphere: newton gives no force",
        ),
        (
            {"sphere__model": "elastic", "contact__finite_sphere": True},
            "an elastic sphere deforms in its modes",
        ),
        ({"contact": {**ELEMENT, "finite_sphere": True}}, "represents the whole deformation"),
        ({"contact__finite_sphere": 1}, "it must be true or false"),
    ],
)
def test_a_finite_sphere_is_refused_where_it_is_counted_already(
    changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(vi.InputError, match=words):
        vi.case_of(plain_case(**changes)).to_problem()


def test_a_finite_sphere_can_be_swept_and_leaves_nothing_to_doubt_of_it(tmp_path: Path) -> None:
    sweep = vi.studies.sweep_of(
        study_table({"over": {"contact.finite_sphere": [False, True], "drop.height": [0.5, 1.0]}})
    )
    study = vi.studies.load_study(compute_study(sweep, tmp_path / "study"))
    force = study.values("largest_force_N")
    assert np.all(force[1] > 1.03 * force[0])
    assert np.isnan(kept(study, "finite_sphere")[1]).all()
    assert np.all(kept(study, "finite_sphere")[0] > 0.02)
    single = vi.simulate(sweep.case_of(3)).impacts["max_force_N"]
    np.testing.assert_allclose(study.values("max_force_N", 1, 1), single, rtol=1e-12)


@pytest.mark.slow
def test_too_few_modes_are_doubted_in_studies_and_of_problems_made_in_python(
    tmp_path: Path,
) -> None:
    sweep = vi.studies.sweep_of(
        {**quiet(plate=ELASTIC, run={"impacts": 1}), "sweep": {"over": {"plate.modes": [2, 120]}}}
    )
    study = vi.studies.load_study(compute_study(sweep, tmp_path / "study"))
    (few,) = (doubt for doubt in study.doubts if doubt.limit == "plate_modes")
    assert (few.drops, few.worst) == (1, 0)
    made = replace(sweep.case_of(0).to_problem(), source=None)
    (doubt,) = result_of(vi.simulate(made)).doubts
    assert doubt.startswith("the modes of the plate end at ")


def test_a_visit_of_several_contacts_asks_for_the_modes_of_one() -> None:
    """It is far longer than any of its contacts, and more modes are asked for than there are."""
    law = LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.5)
    response = vi.simulate(
        drop_on(law, modes_of([200.0, 900.0], [5.0, -4.0], 0.03), height=0.2, impacts=1)
    )
    assert response.impacts["contacts"][0] > 1
    (doubt,) = (
        doubt
        for doubt in result_of(response).doubts
        if doubt.startswith("the modes of the plate end at ")
    )
    lasts, asked = re.search(r"contact lasts ([^:]+):.*max_frequency = \"(\S+) kHz", doubt).groups()  # type: ignore[union-attr]
    assert to_si(lasts, "s") < 0.2 * response.impacts["duration_s"][0]
    assert float(asked) > 0.9


def test_a_comparison_says_once_what_is_so_under_every_law() -> None:
    found = vi.laws.compare_laws(
        vi.case_of(plain_case(drop__height=4.0)), ["hertz", "flores"], {"restitution": 0.7}
    ).report.warnings
    assert sum("in air" in doubt for doubt in found) == 1
    assert any(doubt.startswith("every law: in air") for doubt in found)
    assert any(doubt.startswith("hertz: Hertz's half space") for doubt in found)


def test_a_plate_that_moves_on_its_springs_does_not_bend() -> None:
    """A thick plate on soft springs gives way by more than its thickness, as a whole:
    nothing stretches.
    """
    springs = [
        {"type": "spring", "position": [x, y], "stiffness": 200.0, "horizontal_stiffness": 1e3}
        for x in ("-0.15 m", "0.15 m")
        for y in ("-0.1 m", "0.1 m")
    ]
    plate = {
        "size": [0.4, 0.3, 0.02],
        "material": STEEL,
        "model": "elastic",
        "supports": springs,
        "modes": 12,
    }
    ball = {"radius": "40 mm", "material": STEEL}
    result = result_of(
        vi.simulate(
            vi.case_of(
                quiet(
                    sphere=ball,
                    plate=plate,
                    drop={"speed": 6.0},
                    run={"impacts": 1, "duration": 0.3},
                )
            )
        )
    )
    assert np.abs(result.history["plate_deflection_m"]).max() > 0.2 * 0.02
    assert result.peaks["plate"]["max_bending_m"] < 0.02 * 0.02
    assert not any("it also stretches" in doubt for doubt in result.doubts)


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "thicknesses"), [(0.2, 0.249), (0.5, 1.074)])
def test_a_heavy_sphere_bends_the_plate_most_long_after_it_touches(
    radius: float, thicknesses: float, tmp_path: Path
) -> None:
    """Its contact lasts ten to forty periods of the plate; a run and a study find the
    largest deflection of the history, and doubt it.
    """
    plate = {
        "size": [0.2, 0.2, 0.01],
        "material": "steel",
        "model": "elastic",
        "supports": "simply-supported",
        "modes": 20,
        "damping": 0.01,
    }
    contact = {"law": "tsuji", "restitution": 0.7}
    table = plain_case(
        sphere={"radius": radius, "material": "steel"},
        plate=plate,
        drop={"speed": 1.0},
        contact=contact,
        run={"impacts": 2},
    )
    response = vi.simulate(vi.case_of(table))
    largest = np.abs(response.history(columns=["plate_deflection_m"])["plate_deflection_m"]).max()
    assert largest == pytest.approx(0.01 * thicknesses, rel=2e-3)
    result = vi.result_of(response)
    assert result.peaks["plate"]["max_bending_m"] == pytest.approx(largest, rel=0.01)
    assert any("the plate deflects by" in doubt for doubt in result.doubts)
    study = vi.studies.load_study(
        vi.studies.run_sweep(
            vi.studies.sweep_of({**table, "sweep": {"over": {"drop.speed": [1.0]}}}),
            tmp_path / "study",
        )
    )
    assert float(study.values("limit_plate_deflection").squeeze()) == pytest.approx(
        thicknesses, rel=0.01
    )
