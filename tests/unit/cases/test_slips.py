"""Slips of units: a number in a wrong or forgotten unit is doubted where a case is
checked, with the unit that was likely meant.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import vibroimpact as vi
from studies import study_table
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.wrong_units.detect import slips, swept_slips
from vibroimpact.cases.wrong_units.hertz_estimate import HertzEstimate
from vibroimpact.cli import app
from vibroimpact.results.result import result_of
from vibroimpact.studies.computation.compute_study import compute_study
from vibroimpact.studies.computation.study import load_study
from vibroimpact.studies.planning.sweep_file import sweep_of
from vibroimpact.studies.planning.unit_slips import axis_slips
from vibroimpact.studies.report.tables import doubt_sentences

STEEL = {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
ACRYLIC = {"density": 1190, "youngs_modulus": "3.3 GPa", "poissons_ratio": 0.37}
ADAMS = {"law": "adams-impact", "damping_max": 179.75, "full_damping_penetration": "0.1 mm"}
SPRING = {"law": "linear-spring-dashpot", "stiffness": 1.4e7, "restitution": 0.6}
SIZE = ["520 mm", "420 mm", "8 mm"]
ELASTIC = {
    "size": SIZE,
    "material": "steel",
    "model": "elastic",
    "supports": "clamped",
    "modes": 10,
}


def told(**changes: Any) -> list[str]:
    return slips(resolved_case(vi.case_of(plain_case(**changes))))


def steel(**numbers: Any) -> dict[str, Any]:
    return {"plate__material": {**STEEL, **numbers}}


def elastic(**more: Any) -> dict[str, Any]:
    return {
        "plate": {**ELASTIC, **{key: value for key, value in more.items() if key != "sensors"}},
        **({"sensors": more["sensors"]} if "sensors" in more else {}),
    }


def sensor(**more: Any) -> dict[str, Any]:
    return elastic(
        sensors=[{"name": "far", "position": [0, 0]}, {"name": "a1", "position": [0, 0], **more}]
    )


# what is typed, the key that is doubted, and what is proposed instead
SLIPS: list[tuple[dict[str, Any], str, str]] = [
    (steel(youngs_modulus=210), "plate.material.youngs_modulus", "210 GPa"),
    (steel(youngs_modulus="210 MPa"), "plate.material.youngs_modulus", "210 GPa"),
    (steel(youngs_modulus=210000), "plate.material.youngs_modulus", "210000 MPa"),
    (steel(youngs_modulus="210e9 GPa"), "plate.material.youngs_modulus", "210 GPa"),
    (
        {"sphere__material": {**ACRYLIC, "youngs_modulus": 3300}},
        "sphere.material.youngs_modulus",
        "3300 MPa",
    ),
    (steel(density=7.85), "plate.material.density", "7.85 g/cm^3"),
    (steel(density="7850 g/cm^3"), "plate.material.density", "7850 kg/m^3"),
    (steel(density=7.85e-9), "plate.material.density", "7.85e-9 t/mm^3"),
    (steel(density=19.3), "plate.material.density", "19.3 g/cm^3"),
    (steel(yield_strength=235), "plate.material.yield_strength", "235 MPa"),
    (steel(hardness=130), "plate.material.hardness", "130 kgf/mm^2"),
    (steel(hardness=1.3), "plate.material.hardness", "1.3 GPa"),
    (steel(hardness=1300), "plate.material.hardness", "1300 MPa"),
    ({"sphere__radius": 25, "drop": {"speed": 3}}, "sphere.radius", "25 mm"),
    ({"sphere__radius": "25 m", "drop": {"speed": 3}}, "sphere.radius", "25 mm"),
    ({"sphere__radius": 2.5, "drop": {"speed": 3}, "plate__size": SIZE}, "sphere.radius", "2.5 mm"),
    ({"plate__size": [0.52, 0.42, 10]}, "plate.size.thickness", "10 mm"),
    ({"plate__size": [0.52, 0.42, 3]}, "plate.size.thickness", "3 mm"),
    ({"plate__size": [520, 0.42, 0.008]}, "plate.size.length", "520 mm"),
    ({"drop__height": 4000}, "drop.height", "4000 mm"),
    ({"drop": {"speed": 8800}}, "drop.speed", "8800 mm/s"),
    ({"drop__gravity": 9806.65}, "drop.gravity", "9806.65 mm/s^2"),
    ({"drop__gravity": 981}, "drop.gravity", "981 cm/s^2"),
    ({"contact__stiffness": 16176}, "contact.stiffness", "16176 N/mm^1.5"),
    ({"contact__stiffness": "5.115e8 N/mm^1.5"}, "contact.stiffness", "5.115e8 N/m^1.5"),
    ({"contact__stiffness": 1e5, "contact__exponent": 2.2}, "contact.stiffness", "100000 N/mm^2.2"),
    (
        {"contact": {**SPRING, "stiffness": 1e4}, "drop": {"speed": 8.8}},
        "contact.stiffness",
        "10000 N/mm",
    ),
    ({"contact": {**SPRING, "stiffness": "1.4e7 kN/m"}}, "contact.stiffness", "1.4e7 N/m"),
    ({"contact": {**ADAMS, "damping_max": "180 N s/mm"}}, "contact.damping_max", "180 N s/m"),
    ({"contact": {**ADAMS, "damping_max": 0.18}}, "contact.damping_max", "0.18 N s/mm"),
    (
        {"contact": {**ADAMS, "full_damping_penetration": 0.1}},
        "contact.full_damping_penetration",
        "0.1 mm",
    ),
    (
        {
            "contact": {
                "law": "anagnostopoulos",
                "stiffness": 1e7,
                "restitution": 0.7,
                "effective_mass": 90,
            }
        },
        "contact.effective_mass",
        "90 g",
    ),
    ({"contact": {"law": "jkr", "work_of_adhesion": 50}}, "contact.work_of_adhesion", "50 mJ/m^2"),
    (
        {"contact": {"law": "kuwabara-kono", "dissipation_time": 10}},
        "contact.dissipation_time",
        "10 us",
    ),
    ({"run": {"duration": "1 ms"}}, "run.duration", "1 s"),
    ({"run": {"duration": 5000}}, "run.duration", "5000 ms"),
    ({"run__rest_speed": 10}, "run.rest_speed", "10 mm/s"),
    (
        elastic(supports={"type": "spring", "position": [0, 0], "stiffness": 50}),
        "plate.supports.stiffness",
        "50 N/mm",
    ),
    (elastic(mesh={"element_size": 20}), "plate.mesh.element_size", "20 mm"),
    (elastic(modes=None, max_frequency=60), "plate.max_frequency", "60 kHz"),
    (sensor(rate=50), 'sensors."a1".rate', "50 kHz"),
    (sensor(filter="butterworth", corner=20), 'sensors."a1".corner', "20 kHz"),
    (sensor(accelerometer={"resonance": 30}), 'sensors."a1".accelerometer.resonance', "30 kHz"),
    ({"calibrate": {"target": {"max_force": 3.6}}}, "calibrate.target.max_force", "3.6 kN"),
    (
        {"calibrate": {"target": {"rebound_heights": [2411, 1010]}}},
        "calibrate.target.rebound_heights",
        "2411 mm",
    ),
]


@pytest.mark.parametrize(
    ("changes", "key", "meant"), SLIPS, ids=[f"{key}-{meant}" for _, key, meant in SLIPS]
)
def test_a_slip_is_told_once_with_the_unit_that_was_meant(
    changes: dict[str, Any], key: str, meant: str
) -> None:
    (said,) = told(**changes)  # nothing else is held to what is wrong
    assert said.startswith(f"{key}: ")
    assert said.endswith(f'; was {meant} meant? Write "{meant}"')


@pytest.mark.parametrize(
    ("changes", "key", "meant"), SLIPS, ids=[f"{key}-{meant}" for _, key, meant in SLIPS]
)
def test_what_is_proposed_can_be_written_and_is_not_doubted(
    changes: dict[str, Any], key: str, meant: str
) -> None:
    table = plain_case(**changes)
    inside: Any = table
    *way, last = [part for part in re.split(r'\.?"a1"\.|\.', key) if part]
    for part in way:
        inside = inside[part][-1] if part == "sensors" else inside[part]
    place: Any = ("length", "width", "thickness").index(last) if isinstance(inside, list) else last
    inside[place] = [meant] if isinstance(inside[place], list) else meant
    assert slips(resolved_case(vi.case_of(table))) == []


def test_a_stiffness_is_held_to_that_of_hertz() -> None:
    (said,) = told(contact__stiffness=16176)
    # 4/3 E* sqrt(R) of the paper's pair
    assert "16176 N/m^1.5 is 31,624 times less than Hertz's 5.115e8 N/m^1.5" in said


def test_far_too_stiff_without_a_unit_that_explains_it() -> None:
    (said,) = told(contact__stiffness=5e23)
    assert said.endswith("; leave it out to take Hertz's")


def test_a_run_that_is_over_too_soon_is_told_when_it_should_end() -> None:
    """A sphere of 25 mm that falls from 0.5 m, centre above surface, touches after sqrt(2
    0.475 / 9.80665) s = 0.31125 s.
    """
    assert (
        "is over before the sphere touches the plate, at 0.3112 s; give 0.32 s or more"
        in told(run={"duration": 0.311})[0]
    )
    (said,) = told(run={"duration": 0.3113})
    assert (
        "is over before the first contact is, which by Hertz's theory ends at about 0.311" in said
    )
    assert told(run={"duration": 0.3125}) == []
    assert "give 0.00034 s or more" in told(drop={"speed": 3.0}, run={"duration": 2e-4})[0]
    # half of gravity
    assert (
        "touches the plate, at 0.4402 s"
        in told(plate__inclination="60 deg", run={"duration": 0.4})[0]
    )
    wet = {"contact": {"law": "tsuji", "restitution": 0.7, "liquid": True}}
    assert (
        "touches the plate, after 0.3112 s; give 0.32 s or more, as the fluid slows the fall"
        in told(run={"duration": 0.311}, **wet)[0]
    )
    shaken = {"amplitude": "1 mm", "frequency": "20 Hz"}
    assert told(plate__motion=shaken, run={"duration": 0.3}) == []


def test_one_value_an_impact_is_said_once() -> None:
    (said,) = told(contact={**ADAMS, "damping_max": [0.17975, 0.1728, 166.3]})
    assert "2 of 3 values, such as 0.17975 N s/m, which is" in said


def test_several_sides_are_each_said() -> None:
    assert [said.partition(":")[0] for said in told(plate__size=[520, 420, 8])] == [
        f"plate.size.{side}" for side in ("length", "width", "thickness")
    ]


@pytest.mark.parametrize("key", ["drop.height", "contact.damping_max", "sphere.material.density"])
def test_nothing_is_said_of_zero(key: str) -> None:
    assert (
        swept_slips(resolved_case(vi.case_of(plain_case(contact=ADAMS))), {key: np.array([0.0])})
        == []
    )


def numbers_in(table: Any) -> list[tuple[Any, Any]]:
    """Every number of a case: the table or list that it stands in, and its name there."""
    items = (
        list(table.items())
        if isinstance(table, dict)
        else list(enumerate(table))
        if isinstance(table, list)
        else []
    )
    here = [
        (table, name)
        for name, value in items
        if isinstance(value, float) and name != "poissons_ratio"
    ]
    return here + [one for _, value in items for one in numbers_in(value)]


@pytest.mark.parametrize("value", [5e-324, 1e-200, 1e-30, 1e30, 1e200, 1.7e308])
def test_any_number_can_be_looked_at(value: float) -> None:
    """One number after the other, and all after it, far beyond anything."""
    meter = {"resonance": 3e4, "range": 5000.0, "noise": 1.0, "resolution": 0.1}
    spring = {"type": "spring", "position": [0.1, 0.1], "stiffness": 1e6, "radius": 0.01}
    table = plain_case(
        plate={
            **ELASTIC,
            "size": [0.5, 0.4, 0.008],
            "supports": spring,
            "mesh": {"element_size": 0.05},
        },
        contact={**ADAMS, "damping_max": [180.0, 170.0], "full_damping_penetration": 1e-4},
        sensors=[
            {
                "name": "a1",
                "position": [0.0, 0.0],
                "rate": 5e4,
                "filter": "butterworth",
                "corner": 1e4,
                "accelerometer": meter,
            }
        ],
        run={"duration": 1.0, "rest_speed": 1e-3},
        calibrate={
            "target": {
                "max_force": 100.0,
                "duration": 1e-3,
                "max_indentation": 1e-4,
                "rebound_height": 0.3,
            }
        },
    )
    case = resolved_case(vi.case_of(table))
    places = numbers_in(case)
    assert len(places) > 30
    for inside, name in places:
        before = inside[name]
        inside[name] = value
        assert all(one.isprintable() and len(one) < 400 for one in slips(case))
        inside[name] = before
    for inside, name in places:
        inside[name] = value
        assert all(one.isprintable() and len(one) < 400 for one in slips(case))


def test_swept_values_are_said_once_with_how_many(tmp_path: Path) -> None:
    table = study_table(
        {"over": {"sphere.radius": [0.005, 10.0, 25.0]}},
        drop={"speed": 3.0},
        contact__stiffness=16176,
    )
    study = sweep_of(table)
    (said,) = axis_slips(study)
    assert (
        said == "sphere.radius: 2 of 3 values, such as 10 m, which is very large for a sphere; was "
        '10 mm meant? Write "10 mm"'
    )
    found = doubt_sentences(load_study(compute_study(study, tmp_path / "out")))
    assert [one.partition(":")[0] for one in found[:2]] == ["contact.stiffness", "sphere.radius"]


def test_a_slip_at_the_first_point_is_not_said_twice(tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(
        '[sphere]\nradius = 1\nmaterial = "granite"\n[plate]\nmaterial = '
        '"steel"\n[drop]\nspeed = 1\n[contact]\nlaw = "hertz"\n'
        '[sweep.over]\n"sphere.radius" = [25, 0.05]\n'
    )
    printed = CliRunner().invoke(app, ["check", str(file)]).output
    assert printed.count("was 25 mm meant?") == 1
    swept = CliRunner().invoke(
        app, ["sweep", str(file), "-o", str(tmp_path / "out"), "--processes", "1"]
    )
    assert swept.stderr.count("was 25 mm meant?") == 1  # before all is computed
    assert swept.stdout.count("was 25 mm meant?") == 1  # and with what came of it


def test_results_and_calibrations_tell_it_too() -> None:
    slip = "contact.stiffness: 16176 N/m^1.5 is"
    assert (
        result_of(vi.simulate(vi.case_of(plain_case(contact__stiffness=16176))))
        .doubts[0]
        .startswith(slip)
    )
    table = plain_case(
        contact={"law": "hunt-crossley", "restitution": 0.7, "stiffness": 16176},
        calibrate={"target": {"restitution": 0.7}},
    )
    assert calibrate_case(calibration_of(table)).doubts[0].startswith(slip)


@pytest.mark.parametrize(
    ("drop", "speed", "touch"),
    [
        ({"speed": 2.0}, 2.0, 0.0),
        ({"velocity": [1.0, 0.5, -2.0]}, 2.0, 0.0),
        ({"height": 0.525}, np.sqrt(10.0), np.sqrt(0.1)),
        ({"height": 0.525, "velocity": [1.0, 0.0, 3.0]}, np.sqrt(19.0), 0.3 + np.sqrt(0.19)),
    ],
)
def test_every_way_to_state_a_fall_has_an_estimate(
    drop: dict[str, Any], speed: float, touch: float
) -> None:
    case = plain_case()
    case["drop"] = {**drop, "gravity": 10.0}
    case["sphere"]["radius"] = 0.025
    case["run"] = {"duration": 1.0}
    resolved = resolved_case(vi.case_of(case))
    estimate = HertzEstimate(resolved)
    assert (estimate.speed, estimate.touch) == (pytest.approx(speed), pytest.approx(touch))
    assert slips(resolved) == []


def test_a_value_for_each_impact() -> None:
    """As of a calibration: such a list is compared with what follows from the bodies,
    impact by impact.
    """
    steel = {
        "sphere": {"radius": 0.02, "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"height": 0.05},
        "run": {"impacts": 2},
    }
    for contact in (
        {"law": "thornton", "yield_pressure": [4e8, 5e8]},
        {"law": "hertz", "stiffness": [2e10, 1.9e10]},
    ):
        result = result_of(vi.simulate(vi.case_of({**steel, "contact": contact})))
        assert not any("was " in doubt for doubt in result.doubts)
    twice = [HertzEstimate(result.case).stiffness] * 2
    derived = HertzEstimate(
        {**result.case, "contact": {"law": "hertz", "stiffness": twice}}
    ).derived_parameters
    assert derived == {"stiffness"}


@pytest.mark.parametrize(
    "size", [[0.1, 0.1, 0.045], [0.05, 0.2, 0.1], [2.0, 1.0, 0.001], [0.01, 0.01, 0.009]]
)
@pytest.mark.parametrize("element", ["plate", "solid"])
def test_what_is_chosen_by_default_is_never_doubted(size: list[float], element: str) -> None:
    mesh = {"element": element} if element == "solid" else {}
    found = slips(resolved_case(vi.case_of(plain_case(plate={**ELASTIC, "size": size, **mesh}))))
    assert not [doubt for doubt in found if not doubt.startswith("plate.size")]
