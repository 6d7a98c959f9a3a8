"""What every command prints, in terminals of any width and encoding: the same numbers,
whole, and no traceback.
"""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from rich.console import RenderableType
from typer.testing import CliRunner

import vibroimpact as vi
from exported_drops import told_case
from knock_data import write_knocks
from studies import study_table
from support import COARSE_PLATE, one_in, plain_case
from vibroimpact.bayes_error.bound import bound_of
from vibroimpact.calibration.contact_law.calibrate import calibrate
from vibroimpact.cases.elastic.modes import compute_modes
from vibroimpact.cli import app, main
from vibroimpact.cli.case_text import shipped_cases_table
from vibroimpact.cli.doctor import diagnose, diagnosis_rows
from vibroimpact.cli.feature_text import feature_list, table_summary
from vibroimpact.cli.material_text import material_library_table, material_sheet
from vibroimpact.cli.unit_table import unit_conversion, unit_table
from vibroimpact.exporting.export_format import find_export_format
from vibroimpact.exporting.text import export_summary, format_table
from vibroimpact.law_comparison.comparison import compare_laws
from vibroimpact.law_sheets.sheet import law_sheet, law_table
from vibroimpact.paper.report.outline import RenderedPart
from vibroimpact.paper.report.reproduction import Reproduction
from vibroimpact.paper.report_section import Verdict
from vibroimpact.report.console import TerminalConsole
from vibroimpact.report.terminal_report import terminal_report
from vibroimpact.report.terminal_table import facts
from vibroimpact.results.result import result_of
from vibroimpact.runs.case_explained import case_explained
from vibroimpact.studies.computation.compute_study import compute_study
from vibroimpact.studies.planning.explain_sweep import explain_sweep
from vibroimpact.studies.planning.sweep_file import sweep_of

_NUMBER = re.compile(
    r"(?<![\w.])[-\u2212+]?\d+(?:\.\d+)?(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+|e[-+]?\d+)?(?![\w.]*\d)"
)
_WIDTHS = (60, 80, 120, 160)

Printed = dict[str, Callable[[int], RenderableType]]

ELASTIC = plain_case(
    plate=COARSE_PLATE,
    drop={"height": 0.1, "position": [0.02, 0.01]},
    sensors=[
        {"name": "a1", "position": [0.1, 0.05], "rate": 20e3, "accelerometer": {"range": 100.0}},
        {"name": "a2", "position": [0.1, 0.05], "rate": 20e3},
    ],
)


@pytest.fixture(scope="module")
def commands(tmp_path_factory: pytest.TempPathFactory, variable: vi.Response) -> Printed:
    """What each command prints, by its name, for a terminal of a width."""
    folder = tmp_path_factory.mktemp("terminals")
    elastic, rigid = vi.case_of(ELASTIC), result_of(variable)
    rung = result_of(vi.simulate(elastic))
    modes = compute_modes(elastic)
    compared = compare_laws(
        vi.load_case("paper:type1-theory"), ["hunt-crossley", "flores", "newton", "jankowski"]
    )
    case = vi.load_case("paper:type1-constant")
    calibrated = calibrate(case, vi.load_case("paper:type1-theory"))
    sweep = sweep_of(study_table())
    study = vi.studies.load_study(compute_study(sweep, folder / "study"))
    population = vi.studies.load_sweep("signals:coal-gangue", 400)
    drop = told_case("paper:type1-variable")
    signals = [
        vi.signals.Record(name, signal.value, signal.sensor.rate, signal.sensor.unit)
        for name, signal in rung.signals.items()
    ]
    table = vi.signals.record_table(
        [*signals, vi.signals.Record("silence", [0.0] * 100, 20e3, "V")]
    )
    knocks = write_knocks(folder / "knocks", rocks=8, falls=6)
    recognition = vi.recognition.recognise(knocks, folds=2, seeds=1)
    recognised = vi.recognition.apply_recogniser(recognition.recogniser, knocks)
    return {
        "run": lambda width: terminal_report(rigid.report),
        "run, elastic": lambda width: terminal_report(rung.report),
        "check": lambda _: case_explained(elastic),
        "check, study": lambda _: explain_sweep(sweep),
        "compare": lambda _: terminal_report(compared.report),
        "calibrate": lambda _: terminal_report(calibrated.report),
        "modes": lambda _: terminal_report(modes.report),
        "sweep": lambda _: terminal_report(study.report),
        "dataset": lambda _: explain_sweep(population),
        "bound": lambda _: terminal_report(bound_of(population).report),
        "export": lambda _: format_table(),
        "export, done": lambda _: export_summary(
            drop, find_export_format("lammps"), [folder / "drop.in"]
        ),
        "features": lambda _: table_summary(table),
        "features --list": lambda _: feature_list(),
        "recognise": lambda _: terminal_report(recognition.report),
        "recognise, applied": lambda _: terminal_report(recognised.report),
        "cases": lambda _: shipped_cases_table(),
        "laws": law_table,
        "laws NAME": lambda _: law_sheet("jackson-green-marghitu"),
        "materials": lambda _: material_library_table(),
        "materials NAME": lambda _: material_sheet("granite"),
        "units": lambda _: unit_table(5.115e8, "N/m^1.5"),
        "units --to": lambda _: unit_conversion(3.0, "N/µm", "N/m"),
        "doctor": lambda _: facts(
            [row for row in diagnosis_rows(diagnose()) if row[0] not in CHANGING]
        ),
    }


CHANGING = ("memory free", "compiled code", "store of modes")
"""Rows of `doctor` that differ from one run to the next."""

NAMES = (
    "run",
    "run, elastic",
    "check",
    "check, study",
    "compare",
    "calibrate",
    "modes",
    "sweep",
    "dataset",
    "bound",
    "export",
    "export, done",
    "features",
    "features --list",
    "recognise",
    "recognise, applied",
    "cases",
    "laws",
    "laws NAME",
    "materials",
    "materials NAME",
    "units",
    "units --to",
    "doctor",
)


def shown(what: RenderableType, width: int, encoding: str = "utf-8") -> list[str]:
    """Return the lines of what is printed to a terminal."""
    file = io.TextIOWrapper(io.BytesIO(), encoding=encoding, errors="strict", newline="\n")
    TerminalConsole(width=width, file=file).print(what)
    file.flush()
    return file.buffer.getvalue().decode(encoding).splitlines()


@pytest.mark.slow
def test_every_command_is_here(commands: Printed) -> None:
    from vibroimpact.cli.shared import app

    silent = {
        "demo",
        "identify",
        "correlate",
        "report",
        "figures",
        "new",
        "serve",
        "schema",
        "reproduce",
    }  # as run; facts; one line each; JSON; below
    there = {re.split("[, ]", name)[0] for name in NAMES} | silent
    assert {one.callback.__name__ for one in app.registered_commands if one.callback} <= there
    assert set(NAMES) == commands.keys()


@pytest.mark.parametrize("name", NAMES)
def test_a_narrow_terminal_shows_no_number_that_a_wide_one_does_not(
    commands: Printed, name: str
) -> None:
    whole = set(_NUMBER.findall(" ".join(shown(commands[name](240), 240))))
    for width in _WIDTHS:
        lines = shown(commands[name](width), width)
        assert max(map(len, lines)) <= width
        assert not any("\u2026" in line for line in lines)
        assert set(_NUMBER.findall(" ".join(" ".join(lines).split()))) <= whole, width


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
@pytest.mark.parametrize("name", NAMES)
def test_every_command_is_readable_in_every_encoding(
    commands: Printed, name: str, encoding: str
) -> None:
    for width in (60, 160):
        lines = shown(commands[name](width), width, encoding)
        asked = "\n".join(shown(commands[name](width), width)).count("?")
        assert "\n".join(lines).count("?") == asked
        assert "\\u" not in "\n".join(lines)
        assert max(map(len, lines)) <= width


def test_verdicts_of_the_reproduction_fit() -> None:
    value = {"kind": "fitted model", "printed": "1", "range_low": 0.0, "range_high": 1.0}
    rows = [{**value, "verdict": verdict.value} for verdict in Verdict] * 30
    part = RenderedPart("", "", rows, None)
    report = Reproduction(Path(), {"table1": part, "section5.2": part}).report
    for width in (40, 60):
        lines = shown(terminal_report(report), width)
        assert max(map(len, lines)) <= width
        numbers = _NUMBER.findall(" ".join(lines))
        # the answer of 240 values, by part, by kind, and the 2 of "Type 2"
        assert numbers.count("30") == 2 * 4
        assert numbers.count("60") == 4 + 4 + 4
        assert numbers.count("0") == 4 * 4
        assert {*numbers} == {"0", "30", "60", "240", "2"}


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "utf-8"])
@pytest.mark.parametrize(
    "arguments",
    [
        ("laws",),
        ("laws", "jkr"),
        ("materials", "granite"),
        ("units", "5", "N/µm"),
        ("check", "paper:type2"),
        ("export",),
        ("schema",),
        ("doctor",),
        ("check", "größe.toml"),
        ("units", "5", "µß"),
        ("materials", "粒子"),
    ],
    ids=" ".join,
)
def test_no_command_ends_in_a_traceback(
    arguments: tuple[str, ...], encoding: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    streams = [io.TextIOWrapper(io.BytesIO(), encoding=encoding) for _ in range(2)]
    monkeypatch.setattr("sys.stdout", streams[0])
    monkeypatch.setattr("sys.stderr", streams[1])
    monkeypatch.setattr("sys.argv", ["vibroimpact", *arguments])
    with pytest.raises(SystemExit) as left:
        main()
    for stream in streams:
        stream.flush()
    out, err = (stream.buffer.getvalue().decode(encoding) for stream in streams)
    assert left.value.code in ((2,) if err else (0, None))
    assert "Traceback" not in err
    assert out or err


@pytest.mark.slow
def test_a_run_in_a_terminal_of_another_time(tmp_path: Path) -> None:
    surroundings = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("LC_", "LANG", "PYTHONIOENC", "PYTHONUTF8"))
    }
    surroundings |= {
        "LC_ALL": "C",
        "PYTHONUTF8": "0",
        "PYTHONCOERCECLOCALE": "0",
        "PYTHONWARNDEFAULTENCODING": "1",
    }
    command = [
        sys.executable,
        "-m",
        "vibroimpact",
        "run",
        "paper:type1-variable",
        "-o",
        str(tmp_path / "out"),
    ]
    done = subprocess.run(command, capture_output=True, env=surroundings, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert b"[us]" in done.stdout
    assert b"?" not in done.stdout
    assert b"vibroimpact/" not in done.stderr  # where an EncodingWarning names our own line


@pytest.mark.parametrize(
    "arguments", one_in(2, [(("schema",),), (("units", "5", "N/m"),)], " ".join)
)
def test_a_pipe_that_is_closed_early_ends_quietly(arguments: tuple[str, ...]) -> None:
    command = [sys.executable, "-m", "vibroimpact", *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        assert running.stdout is not None
        assert running.stderr is not None
        running.stdout.close()
        assert running.stderr.read() == b""
        assert running.wait(timeout=300) in (0, 1)


def test_the_list_of_commands_has_whole_sentences() -> None:
    _, commands = CliRunner().invoke(app, ["--help"], terminal_width=80).output.split("Commands:")
    lines = [line for line in commands.splitlines() if line]
    assert len(lines) > 20
    assert [line for line in lines if line.endswith("...") or not line.endswith(".")] == []
