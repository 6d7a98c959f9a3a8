"""`--json` of every command that prints a table: one document, with the numbers of the
data files digit by digit.
"""

from __future__ import annotations

import csv
import html
import inspect
import json
import math
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
import tomli_w

import vibroimpact as vi
from support import COARSE_PLATE, plain_case
from vibroimpact.cli import main
from vibroimpact.cli.shared import app
from vibroimpact.files.json_text import json_text

Printed = Callable[..., Any]

ELASTIC = plain_case(
    plate=COARSE_PLATE,
    drop={"height": 0.1, "position": [0.02, 0.01]},
    sensors=[
        {"name": "a1", "position": [0.1, 0.05], "rate": 20e3, "accelerometer": {"range": 100.0}}
    ],
)


@pytest.fixture
def printed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> Printed:
    """Run a command with --json in an empty folder; return the document, with numbers as
    they are written.
    """
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str, numbers: bool = False) -> Any:
        monkeypatch.setattr("sys.argv", ["vibroimpact", *arguments, "--json"])
        with pytest.raises(SystemExit) as left:
            main()
        written = capsys.readouterr()
        assert not left.value.code, written.err
        assert written.out.isascii()
        return json.loads(written.out) if numbers else as_written(written.out)

    return run


def as_written(text: str) -> Any:
    """JSON with its numbers as the texts that stand there, so that each digit is compared."""
    return json.loads(text, parse_float=str, parse_int=str, parse_constant=pytest.fail)


def summary(folder: str, name: str = "summary.json") -> dict[str, Any]:
    """A JSON file of a folder, without its check sums."""
    table = as_written((Path(folder) / name).read_text(encoding="utf-8"))
    return {key: value for key, value in table.items() if key not in ("sha256", "check_sums")}


def rows(folder: str, name: str) -> list[dict[str, Any]]:
    """The rows of a CSV file of a folder; None in empty cells."""
    with (Path(folder) / name).open(newline="", encoding="utf-8") as file:
        return [
            {column: cell or None for column, cell in row.items()} for row in csv.DictReader(file)
        ]


def in_all_columns(found: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of a document with the columns of all of them, as a CSV file has them; without
    the words for an empty text.
    """
    columns = dict.fromkeys(column for row in found for column in row)
    return [
        {column: row.get(column) if row.get(column) != "" else None for column in columns}
        for row in found
    ]


def case_file(table: Mapping[str, Any], name: str) -> str:
    Path(name).write_text(tomli_w.dumps(table), encoding="utf-8")
    return name


def test_every_command_that_prints_a_table_has_it() -> None:
    takes = {
        one.callback.__name__: "as_json" in inspect.signature(one.callback).parameters
        for one in app.registered_commands
        if one.callback
    }
    # one line each; JSON
    assert {name for name, there in takes.items() if not there} == {
        "report",
        "figures",
        "new",
        "serve",
        "schema",
    }


def test_features_are_their_table(printed: Printed) -> None:
    lines = [
        f"{place / 1e4!r},{math.exp(-place / 40.0) * math.sin(place / 3.0)!r}"
        for place in range(300)
    ]
    Path("tap.csv").write_text("\n".join(["time_s,geophone_V", *lines]), encoding="utf-8")
    document = printed("features", "tap.csv", "-o", "table.csv")
    assert in_all_columns(document["signals"]) == rows(".", "table.csv")
    assert list(printed("features", "--list")["features"]) == list(vi.signals.signal_features())


def test_a_run_is_its_summary(printed: Printed) -> None:
    document = printed("run", case_file(ELASTIC, "plate.toml"), "-o", "out")
    assert document.pop("folder") == "out"
    assert document == summary("out")
    assert in_all_columns(document["impacts"]) == rows("out", "impacts.csv")
    assert document["sensors"]["a1"]["rate_Hz"] == "20000.0"


def test_the_demo_is_a_run(printed: Printed) -> None:
    document = printed("demo")
    assert document["impacts"][0]["restitution_asked"] is None  # NaN
    assert {"folder": "vibroimpact-demo", **summary("vibroimpact-demo")} == document


def test_a_case_explained_is_the_case_that_is_run(printed: Printed) -> None:
    file = case_file(plain_case(), "case.toml")
    document, run = (
        printed(*command, file, numbers=True) for command in (("check",), ("run", "-o", "out"))
    )
    assert document["case"] == tomllib.loads(Path("out/case.toml").read_text(encoding="utf-8"))
    first, impact = document["first_impact"], run["impacts"][0]
    assert first["approach_speed_m_s"] == pytest.approx(impact["approach_speed_m_s"], rel=1e-12)
    assert first["restitution_asked"] == impact["restitution_asked"]
    # which knows gravity
    assert first["restitution_achieved"] == pytest.approx(impact["restitution_achieved"], rel=1e-3)
    assert document["without_losses"]["max_force_N"] > impact["max_force_N"]
    assert (len(document["doubts"]), document["meshes"], document["costs"]) == (2, {}, [])
    case = vi.load_case(file, {"contact.restitution": first["restitution_to_ask"]})
    assert vi.simulate(case).impacts["restitution_achieved"][0] == pytest.approx(
        first["restitution_asked"], abs=1e-3
    )


def test_a_case_with_modes_tells_of_its_meshes(printed: Printed) -> None:
    (mesh,) = printed("check", case_file(ELASTIC, "plate.toml"), numbers=True)["meshes"].values()
    modes = printed("modes", "plate.toml", numbers=True)["modes"]["plate"]["mesh"]
    assert (mesh["elements"], str(mesh["nodes"])) == (modes["elements"], modes["nodes"])
    # of which the clamped edges are held
    assert mesh["degrees_of_freedom"] == 5 * mesh["nodes"] > int(modes["degrees of freedom"])
    assert printed("check", "plate.toml")["meshes"]["plate"]["modes_computed"] is True


def test_a_study_is_explained_with_the_keys_of_its_file(printed: Printed) -> None:
    over = {
        "sphere.radius": {"from": "5 mm", "to": "50 mm", "number": 3, "scale": "log"},
        "contact.restitution": [0.5, 0.7],
        "drop.height": {
            "distribution": "normal",
            "mean": "2 m",
            "standard_deviation": "10 cm",
            "at_least": "1 m",
            "number": 4,
        },
        "plate.material.density": {
            "distribution": "uniform",
            "from": 7000,
            "to": 8000,
            "number": 2,
        },
    }
    study = printed(
        "check", case_file(plain_case(sweep={"over": over}), "study.toml"), numbers=True
    )["study"]
    assert (study["design"], study["drops"], study["keep"]) == ("grid", 48, ["peaks", "impacts"])
    assert study["over"]["sphere.radius"] == {
        "unit": "m",
        "from": 0.005,
        "to": 0.05,
        "number": 3,
        "scale": "log",
    }
    assert study["over"]["contact.restitution"]["values"] == [0.5, 0.7]
    drawn = study["over"]["drop.height"]
    assert (drawn["mean"], drawn["standard_deviation"], drawn["at_least"], drawn["at_most"]) == (
        2.0,
        0.1,
        1.0,
        None,
    )
    assert study["over"]["plate.material.density"]["distribution"] == "uniform"


def test_modes_are_those_of_the_tables(printed: Printed) -> None:
    document = printed("modes", case_file(ELASTIC, "plate.toml"), "-o", "out")
    assert document.pop("folder") == "out"
    tables = [(body.pop("modes"), body.pop("points")) for body in document["modes"].values()]
    assert document == summary("out")
    assert in_all_columns([row for modes, _ in tables for row in modes]) == rows("out", "modes.csv")
    assert in_all_columns([row for _, points in tables for row in points]) == rows(
        "out", "points.csv"
    )


def test_a_bound_is_its_summary_and_its_rows(printed: Printed) -> None:
    document = printed("bound", "signals:coal-gangue", "--samples", "500", "-o", "out")
    assert document.pop("folder") == "out"
    assert document == summary("out")
    assert in_all_columns(document["bound"]) == rows("out", "bound.csv")


def test_a_comparison_is_its_summary_and_its_cases(printed: Printed) -> None:
    document = printed(
        "compare",
        "paper:type1-theory",
        "--laws",
        "flores,newton",
        "--achieving",
        "0.7",
        "-o",
        "out",
    )
    assert document.pop("folder") == "out"
    for name, law in document["laws"].items():
        parse = tomllib.loads(
            (Path("out/cases") / f"{name}.toml").read_text(encoding="utf-8"), parse_float=str
        )
        assert law.pop("case")["contact"] == {
            key: as_text(value) for key, value in parse["contact"].items()
        }
    assert document == summary("out")
    table = [
        {"law": name, **row} for name, law in document["laws"].items() for row in law["impacts"]
    ]
    assert in_all_columns(table) == rows("out", "comparison.csv")


def as_text(value: Any) -> Any:
    """A value of a TOML file as `as_written` returns it."""
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


def test_a_calibration_is_its_file_and_its_comparison(printed: Printed) -> None:
    document = printed("calibrate", "paper:calibration", "-o", "out")
    assert document.pop("folder") == "out"
    answer = document.pop("answer")
    assert [row["value"] for row in answer] == [row["value"] for row in document["matched"]]
    assert in_all_columns(document.pop("comparison")) == rows("out", "comparison.csv")
    assert document == summary("out", "calibration.json")
    assert in_all_columns(document["matched"]) == rows("out", "matched.csv")


def test_a_study_is_its_tables(printed: Printed) -> None:
    over = {"drop.height": [0.5, 1.0, 2.0], "contact.restitution": [0.5, 0.6, 0.7]}
    file = case_file(plain_case(sweep={"over": over}), "study.toml")
    document = printed("sweep", file, "-o", "out", "--processes", "1")
    assert document["folder"] == "out"
    assert {name: document[name] for name in ("name", "version")} == {
        name: summary("out")[name] for name in ("name", "version")
    }
    assert document["study"] == {**summary("out")["study"], "failed": "0"}
    assert in_all_columns(document["percentiles"]) == rows("out", "percentiles.csv")
    assert in_all_columns(document["sensitivity"]) == rows("out", "sensitivity.csv")
    study = vi.studies.load_study("out")
    assert [
        (one["limit"], int(one["drops"]), float(one["number"])) for one in document["limits"]
    ] == [(one.limit, one.drops, one.number) for one in study.doubts]
    assert len(document["doubts"]) >= len(study.doubts) > 0


def test_a_reproduction_is_its_values(printed: Printed) -> None:
    document = printed("reproduce", "-o", "out", "--only", "section3.1")
    assert (document["folder"], document["version"]) == ("out", summary("out")["version"])
    assert in_all_columns(document["values"]) == rows("out", "values.csv")
    counted = {
        verdict: sum(row["verdict"] == verdict for row in document["values"])
        for verdict in document["verdicts"]["all"]
    }
    assert {
        verdict: int(number) for verdict, number in document["verdicts"]["all"].items()
    } == counted
    by_kind = document["kinds"].values()
    assert {verdict: sum(int(by[verdict]) for by in by_kind) for verdict in counted} == counted


def test_cases_are_those_that_can_be_loaded(printed: Printed) -> None:
    cases = printed("cases")["cases"]
    assert {name: case["name"] for name, case in cases.items()} == vi.shipped_cases()
    assert cases["paper:sweep"]["command"] == "sweep"
    assert cases["signals:coal-gangue"]["command"] == "dataset"


def test_laws_give_the_numbers_of_their_parameters(printed: Printed) -> None:
    laws = printed("laws", numbers=True)["laws"]
    assert list(laws) == list(vi.laws.contact_laws())
    assert laws["flores"] == printed("laws", "flores", numbers=True)
    for name, law in vi.laws.contact_laws().items():
        parameters = {one["name"]: one for one in (*laws[name]["parameters"], *laws[name]["state"])}
        assert parameters.keys() == {item.name for item in fields(law)}
        for item in fields(law):
            if isinstance(item.default, float):
                assert parameters[item.name]["default"] == item.default
        assert "`" not in str(laws[name]["body"])


def test_a_picture_of_a_law_is_told_of_elsewhere(printed: Printed) -> None:
    assert printed("laws", "flores", "-o", "flores.png")["name"] == "flores"
    assert Path("flores.png").is_file()


def test_materials_are_those_of_the_library(printed: Printed) -> None:
    materials = printed("materials", numbers=True)["materials"]
    assert list(materials) == list(vi.materials.material_library())
    steel = printed("materials", "steel", numbers=True)
    assert steel == materials["steel"]
    assert vi.Material(**steel) == vi.find_material("steel")
    assert printed("materials", "rigid")["youngs_modulus"] is None  # infinite


def test_units_are_whole_numbers_of_the_machine(printed: Printed) -> None:
    document = printed("units", "5.115e8", "N/m^1.5", "--to", "N/mm^1.5", numbers=True)
    number = vi.units.convert_units(5.115e8, "N/m^1.5", "N/mm^1.5")
    assert document == {
        "number": 5.115e8,
        "unit": "N/m^1.5",
        "converted": [{"number": number, "unit": "N/mm^1.5"}],
    }
    systems = printed("units", "-5", "N/m", numbers=True)["converted"]
    assert [one["number"] for one in systems[:2]] == [
        -5.0,
        vi.units.convert_units(-5.0, "N/m", "N/mm"),
    ]


def test_doubts_are_those_of_the_run(printed: Printed) -> None:
    """What is calibrated and what is exported exceeds the limits that a run of the same
    case exceeds.
    """
    steel = {
        "sphere": {"radius": 0.02, "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"height": 0.5},
        "run": {"impacts": 1},
    }
    target = {"target": {"rebound_heights": [0.337]}}
    Path("ball.toml").write_text(
        tomli_w.dumps({**steel, "contact": {"law": "adams-impact"}, "calibrate": target})
    )
    calibrated = printed("calibrate", "ball.toml", "-o", "ball")["doubts"]
    run = printed("run", "ball/case.toml", "-o", "run")["doubts"]
    assert sum("the plate (steel) yields, and so does" in doubt for doubt in run) == 1
    assert calibrated[: len(run)] == run
    for folder in ("ball", "run"):
        assert printed("export", folder, "--to", "adams")["doubts"] == run
        assert printed("export", folder, "--to", "lammps")["doubts"] == run
    page = html.unescape(Path("ball/report.html").read_text(encoding="utf-8"))
    assert all(doubt in page for doubt in run)


def test_exports_name_their_files(printed: Printed) -> None:
    from vibroimpact.exporting.export_format import export_formats

    assert (
        printed("export")["formats"].keys()
        == printed("export", "--formats")["formats"].keys()
        == export_formats().keys()
    )
    printed("run", "paper:type1-theory", "-o", "theory")
    document = printed("export", "theory", "--to", "csv")
    assert document["format"] == "csv"
    assert sorted(map(Path, document["files"])) == sorted(Path("theory-csv").iterdir())
    assert "adams_dialog" not in document
    printed("calibrate", "paper:calibration", "-o", "out")
    assert len(printed("export", "out", "--to", "adams")["adams_dialog"]) == 5


def test_the_installation_is_tested(printed: Printed) -> None:
    document = printed("doctor", numbers=True)
    assert document["version"] == vi.__version__
    assert document["packages"]["numpy"].count(".") >= 1
    assert 0.0 <= document["first_rebound_error"] < 1e-7


@pytest.mark.parametrize(
    "arguments",
    [("check", "nothing.toml"), ("materials", "granit"), ("laws", "herz"), ("units", "5", "foo")],
    ids=" ".join,
)
def test_an_error_is_text(
    arguments: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["vibroimpact", *arguments, "--json"])
    with pytest.raises(SystemExit) as left:
        main()
    written = capsys.readouterr()
    assert (left.value.code, written.out) == (2, "")
    assert written.err.startswith("vibroimpact: ")


def test_numbers_that_are_not_finite_are_null_at_any_depth() -> None:
    text = json_text(
        {"a": math.nan, "b": [math.inf, {"c": (-math.inf, 1.0)}], "d\x7f\x1b\udcff": "\x7f"}
    )
    assert text.isascii()
    assert text.replace("\n", "").isprintable()
    assert json.loads(text) == {
        "a": None,
        "b": [None, {"c": [None, 1.0]}],
        "d\x7f\x1b\udcff": "\x7f",
    }
