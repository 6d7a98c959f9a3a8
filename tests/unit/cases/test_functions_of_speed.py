"""A parameter of the contact law as a function of the approach speed: a table or a
polynomial, evaluated at that of each impact.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.cases.build import problem_of, resolved_case
from vibroimpact.cases.case import case_schema
from vibroimpact.cases.rigid.rigid_problem import in_liquid
from vibroimpact.cli import main
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.formats import exudyn, lammps
from vibroimpact.exporting.load_drop import drop_of_result
from vibroimpact.exporting.rigid_drop import as_rigid
from vibroimpact.law_comparison.comparison import compare_laws
from vibroimpact.results.result import result_of
from vibroimpact.runs.case_document import case_document

SPEEDS, VALUES = [1.0, 2.5, 6.0], [0.92, 0.85, 0.7]
TABLE = {"speed": SPEEDS, "value": VALUES}
POLYNOMIAL = {"polynomial": [0.95, -0.04, 0.001], "from": 0.2, "to": 12.0}
FUNCTIONS = {"table": TABLE, "polynomial": POLYNOMIAL}
ELASTIC = {
    "size": [0.3, 0.3, 0.01],
    "material": "steel",
    "model": "elastic",
    "modes": 20,
    "damping": 0.02,
    "supports": "clamped",
}
SHAKEN = {"material": "steel", "model": "rigid", "motion": {"amplitude": 1e-4, "frequency": 40.0}}
SETTINGS: dict[str, dict[str, Any]] = {
    "rigid": {},
    "in air": {"drop": {"height": 1.5, "air": True}},
    "elastic plate": {"plate": ELASTIC, "drop": {"height": 0.6, "position": [0.02, 0.01]}},
    "shaken": {"plate": SHAKEN},
    "oblique": {
        "plate": {"size": [2.0, 2.0, 0.02], "material": "steel"},
        "drop": {"speed": 4.0, "angle": 0.5},
    },
    "in water": {"drop": {"speed": 4.0}},
}


def value_at(function: dict[str, Any], speed: np.ndarray) -> np.ndarray:
    """Return the value of a function as NumPy has it."""
    if "polynomial" in function:
        return np.polyval(
            function["polynomial"][::-1], np.clip(speed, function["from"], function["to"])
        )
    return np.interp(speed, function["speed"], function["value"])


def case_of(setting: str, contact: dict[str, Any], **changes: Any) -> vi.Case:
    parts = {"run": {"impacts": 4}, **SETTINGS[setting], **changes}
    more = (
        {"friction": {"law": "mdr", "coefficient": 0.2}}
        if setting == "oblique"
        else {"liquid": True}
        if setting == "in water"
        else {}
    )
    return vi.case_of(plain_case(contact={**contact, **more}, **parts))


def test_newtons_is_the_recursion() -> None:
    """Each separation speed is e(v) v, and in a vacuum the next approach speed."""
    found = vi.simulate(
        case_of(
            "rigid",
            {"law": "newton", "restitution": TABLE},
            drop={"speed": 7.0},
            run={"impacts": 20},
        )
    ).impacts
    speed = 7.0
    for approach, separation in zip(
        found["approach_speed_m_s"], found["separation_speed_m_s"], strict=True
    ):
        assert approach == pytest.approx(speed, rel=1e-9)
        speed *= float(np.interp(speed, SPEEDS, VALUES))
        assert separation == pytest.approx(speed, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("function", FUNCTIONS.values(), ids=FUNCTIONS)
@pytest.mark.parametrize("setting", SETTINGS)
def test_it_is_the_list_of_its_values(setting: str, function: dict[str, Any]) -> None:
    """A run with the values of the function at its own approach speeds, one per impact,
    is the same run.
    """
    by_speed = vi.simulate(case_of(setting, {"law": "tsuji", "restitution": function})).impacts
    values = value_at(function, by_speed["approach_speed_m_s"])
    listed = vi.simulate(case_of(setting, {"law": "tsuji", "restitution": values.tolist()})).impacts
    for name in (
        "time_s",
        "approach_speed_m_s",
        "separation_speed_m_s",
        "max_force_N",
        "restitution_asked",
    ):
        np.testing.assert_allclose(by_speed[name], listed[name], rtol=1e-10, err_msg=name)
    assert np.ptp(values) > 1e-3


def test_another_parameter_and_the_default_rest() -> None:
    damping = {"polynomial": [139.4, 5.86, -0.1456], "from": 1.0, "to": 9.0}
    case = vi.load_case("paper:type1-constant", {"contact.damping_max": damping})
    found = vi.simulate(case).impacts
    values = value_at(damping, found["approach_speed_m_s"])
    listed = vi.simulate(
        vi.load_case("paper:type1-constant", {"contact.damping_max": values.tolist()})
    ).impacts
    np.testing.assert_allclose(
        found["separation_speed_m_s"], listed["separation_speed_m_s"], rtol=1e-10
    )
    to_rest = case_of("rigid", {"law": "tsuji", "restitution": TABLE}, run={"impacts": "all"})
    assert "rest" in result_of(vi.simulate(to_rest)).status


def test_many_drops_at_once_are_each_alone() -> None:
    speeds = np.array([0.5, 2.0, 3.0, 8.0])
    problem = problem_of(case_of("rigid", {"law": "flores", "restitution": TABLE}))
    one = [
        vi.simulate(replace(problem, speed=float(speed), height=None)).impacts[
            "separation_speed_m_s"
        ]
        for speed in speeds
    ]
    many = vi.tabulate(replace(problem, speed=speeds, height=None)).impacts["separation_speed_m_s"]
    np.testing.assert_allclose(many, one, rtol=1e-8)


def test_a_study_takes_it(tmp_path: Path) -> None:
    table, heights = (
        plain_case(contact={"law": "tsuji", "restitution": TABLE}, run={"impacts": 2}),
        [0.3, 0.6, 30.0],
    )
    sweep = vi.studies.sweep_of({**table, "sweep": {"over": {"drop.height": heights}}})
    study = vi.studies.load_study(vi.studies.run_sweep(sweep, tmp_path / "study"))
    alone = [
        vi.simulate(vi.case_of({**table, "drop": {"height": height}})).impacts[
            "restitution_achieved"
        ]
        for height in heights
    ]
    np.testing.assert_allclose(study.values("restitution_achieved"), alone, rtol=1e-8)
    assert (study.values("limit_speeds_given") > 1.05).tolist() == [False, False, True]


@pytest.mark.slow
@pytest.mark.parametrize("function", FUNCTIONS.values(), ids=FUNCTIONS)
def test_written_and_read_again(function: dict[str, Any], tmp_path: Path) -> None:
    case = case_of("rigid", {"law": "tsuji", "restitution": function})
    vi.simulate(case).save(tmp_path / "run")
    again = vi.load_case(tmp_path / "run" / "case.toml")
    assert again.contact.parameters["restitution"] == case.contact.parameters["restitution"]
    np.testing.assert_array_equal(
        vi.simulate(again).impacts["time_s"], vi.simulate(case).impacts["time_s"]
    )
    jsonschema.validate(json.loads(json.dumps(resolved_case(case))), case_schema())
    page = (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    assert ("linear between 3 speeds" if "speed" in function else "v from 0.2 to 12 m/s") in page


def test_speeds_with_units_and_on_the_command_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    found = case_of(
        "rigid",
        {"law": "newton", "restitution": {"speed": ["500 mm/s", "2 m/s"], "value": [0.9, 0.8]}},
    )
    assert found.contact.parameters["restitution"] == vi.laws.SpeedTable((0.5, 2.0), (0.9, 0.8))
    changed = '{ polynomial = [0.9, -0.02], from = "1 m/s", to = "12 m/s" }'
    monkeypatch.setattr(
        "sys.argv",
        ["vibroimpact", "check", "paper:type1-theory", "--set", f"contact.restitution={changed}"],
    )
    with pytest.raises(SystemExit) as left:
        main()
    printed = " ".join(capsys.readouterr().out.split())
    assert not left.value.code
    assert "restitution 0.9 - 0.02 v^1, v from 1 to 12 m/s" in printed


def test_what_is_expected_is_that_of_the_first_speed() -> None:
    for setting in ("rigid", "in air"):
        case = case_of(setting, {"law": "newton", "restitution": TABLE})
        first = float(vi.simulate(case).impacts["restitution_achieved"][0])
        assert case_document(case)["first_impact"]["restitution_achieved"] == pytest.approx(
            first, rel=1e-6
        )
        assert in_liquid(case, problem_of(case).laws[0]).restitution == pytest.approx(
            first, rel=1e-6
        )


@pytest.mark.parametrize(
    ("function", "words"),
    [
        ({"speed": [1, 2], "value": [0.9]}, "speed has 2 numbers and value 1"),
        ({"speed": [2, 1], "value": [0.9, 0.8]}, "1 m/s comes after 2 m/s; the speeds must rise"),
        ({"speed": [1, 1], "value": [0.9, 0.8]}, "the speeds must rise"),
        ({"speed": [1, 2], "value": [0.9, 1.2]}, "at most 1"),
        ({"speed": [0, 2], "value": [0.9, 0.8]}, "greater than 0"),
        ({"speed": [], "value": []}, "it must be a list of numbers"),
        ({"speed": [1, 2]}, "value is missing; a function of the approach speed is"),
        ({"speeds": [1, 2], "value": [0.9, 0.8]}, 'unknown key "speeds"'),
        ({"polynomial": [0.9, -0.1]}, "from is missing"),
        ({"polynomial": [0.9, -0.1], "from": 1, "to": 20}, "between 1 and 20 m/s it comes to -1.1"),
        ({"polynomial": [0.5, 2.0, -2.0], "from": 0, "to": 1}, "between 0 and 1 m/s it comes to 1"),
        ({"polynomial": [0.9], "from": 3, "to": 1}, "to must be greater than from"),
        ({"polynomial": ["0.9 m"], "from": 1, "to": 2}, "a plain number is wanted"),
    ],
)
def test_what_is_refused(function: dict[str, Any], words: str) -> None:
    limit = {"law": "tsuji", "restitution": function}
    # the vertex of the parabola, 1, is allowed; a little more is not
    if words.endswith("it comes to 1"):
        limit["restitution"] = {**function, "polynomial": [0.51, 2.0, -2.0]}
    with pytest.raises(vi.InputError, match=r"contact\.restitution") as refused:
        case_of("rigid", limit)
    assert words in str(refused.value)


@pytest.mark.parametrize(
    ("key", "why"), [("stiffness", "it follows from the bodies"), ("exponent", "it is an exponent")]
)
def test_what_follows_from_the_bodies_is_no_function(key: str, why: str) -> None:
    with pytest.raises(vi.InputError, match=f"contact.{key}: {why}"):
        case_of(
            "rigid",
            {"law": "flores", "restitution": 0.7, key: {"speed": [1, 2], "value": [1.5, 1.5]}},
        )


def test_speeds_beyond_the_function_are_doubted() -> None:
    def doubts(speed: float, **run: Any) -> str:
        case = case_of(
            "rigid", {"law": "newton", "restitution": TABLE}, drop={"speed": speed}, **run
        )
        return " ".join(result_of(vi.simulate(case)).doubts)

    assert "given for approach speeds" not in doubts(6.2, run={"impacts": 4})
    assert "from 1 to 6 m/s, and the first impact comes at" in doubts(6.4, run={"impacts": 1})
    assert "beyond the ends the value at the nearest one holds" in doubts(1.1, run={"impacts": 4})


def exported(setting: str) -> tuple[Drop, dict[str, np.ndarray]]:
    case = case_of(setting, {"law": "tsuji", "restitution": TABLE})
    drop = as_rigid(drop_of_result(result_of(vi.simulate(case)), case))
    return drop, drop.impacts


@pytest.mark.parametrize("setting", ["rigid", "elastic plate"])
def test_exports_have_the_value_of_each_impact(setting: str) -> None:
    drop, impacts = exported(setting)
    given = [float(law.restitution) for law in drop.laws]  # type: ignore[attr-defined]
    np.testing.assert_allclose(
        given, np.interp(impacts["approach_speed_m_s"], SPEEDS, VALUES), rtol=1e-12
    )
    text = next(iter(exudyn.FORMAT.write(drop).values())).decode()
    assert f'"restitution": {given}' in text
    assert lammps.FORMAT.write(drop)


def test_as_a_target_and_as_a_law_that_is_compared() -> None:
    """IMPACT is calibrated to e(v) as it is to the restitutions of the impacts."""
    contact = {"law": "newton", "restitution": TABLE}
    found = calibrate_case(
        calibration_of(plain_case(contact=contact, run={"impacts": 3}, calibrate={"degree": 1}))
    )
    assert found.parameter == "damping_max"
    achieved = found.observations.wanted["separation_speed"] / found.observations.speeds
    np.testing.assert_allclose(
        achieved, np.interp(found.observations.speeds, SPEEDS, VALUES), rtol=1e-6
    )
    compared = compare_laws(
        vi.case_of(plain_case(contact=contact, run={"impacts": 2})), ["newton", "tsuji"]
    )
    np.testing.assert_allclose(
        compared.results["tsuji"].impacts["restitution_asked"],
        np.interp(compared.results["tsuji"].impacts["approach_speed_m_s"], SPEEDS, VALUES),
        rtol=1e-12,
    )


def test_a_function_is_no_start_of_a_calibration() -> None:
    table = plain_case(
        contact={"law": "tsuji", "restitution": TABLE}, calibrate={"target": {"restitution": 0.7}}
    )
    with pytest.raises(
        vi.InputError, match=r"contact\.restitution: a calibration begins from numbers"
    ):
        calibrate_case(calibration_of(table))


def test_what_a_calibration_fits_is_run_as_a_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The printed line, pasted into the case, gives the rebounds of the fitted function."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(
        "sys.argv", ["vibroimpact", "calibrate", "paper:calibration", "-o", "found"]
    )
    with pytest.raises(SystemExit):
        main()
    line = next(
        line for line in capsys.readouterr().out.splitlines() if line.startswith("In a case: ")
    )
    table = json.loads(Path("found/calibration.json").read_text())
    case = vi.load_case("found/case.toml", {"contact.damping_max": table["by_speed"]})
    assert line.startswith("In a case: damping_max = { polynomial = [")
    found = vi.simulate(case).impacts
    fitted = np.polyval(table["fit"]["coefficients"][::-1], found["approach_speed_m_s"])
    listed = vi.simulate(
        vi.load_case("found/case.toml", {"contact.damping_max": fitted.tolist()})
    ).impacts
    np.testing.assert_allclose(
        found["separation_speed_m_s"], listed["separation_speed_m_s"], rtol=1e-4
    )


def test_the_fit_of_a_table_is_run_as_a_case(tmp_path: Path) -> None:
    (path := tmp_path / "ev.csv").write_text(
        "speed [m/s],e\n1,0.9\n2,0.85\n4,0.74\n6,0.65\n", encoding="utf-8"
    )
    read = vi.calibration.load_restitutions(path)
    assert read.function is not None
    case = case_of(
        "rigid", {"law": "newton", "restitution": read.function.table()}, drop={"speed": 5.0}
    )
    found = vi.simulate(case).impacts
    np.testing.assert_allclose(
        found["restitution_achieved"], read.laws[1](found["approach_speed_m_s"]), rtol=1e-12
    )
