"""Hostile case files: each is explained or refused in a few clean lines, within seconds,
and what is quick to run runs.
"""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import pytest

import vibroimpact as vi
from hostile_runs import failures, number, seed
from mutations import case_files
from seeds import write_files
from vibroimpact.calibration.observed.section import check_target
from vibroimpact.cases.build import check_drop
from vibroimpact.cases.reader import load_table, prefix_errors
from vibroimpact.cases.rigid.rigid_problem import deforms
from vibroimpact.report.console import TerminalConsole
from vibroimpact.runs.case_explained import case_explained
from vibroimpact.studies.planning.explain_sweep import explain_sweep


def shown(renderable: object) -> None:
    """Print to a terminal that is none; no character of what a file holds may steer it."""
    written = StringIO()
    TerminalConsole(file=written, width=100).print(renderable)
    bad = {
        character
        for character in written.getvalue()
        if not character.isprintable() and character not in "\n\u00a0"
    }
    assert not bad, f"{bad} would reach the terminal"


def check(data: bytes, folder: Path) -> vi.Case:
    """Do what `vibroimpact check` does with a file, and where it has a calibration, read
    that too.
    """
    file = folder / "case.toml"
    file.write_bytes(data)
    write_files(folder)
    table = prefix_errors(file, lambda: load_table(file))
    if "calibrate" in table:
        vi.calibration.load_calibration(file)
    if "sweep" not in table:
        case = vi.load_case(file)
        prefix_errors(file, lambda: check_drop(case))
        prefix_errors(file, lambda: check_target(case.calibrate))
        shown(prefix_errors(file, lambda: case_explained(case)))
        return case
    study = prefix_errors(file, lambda: vi.studies.sweep_of(table))
    shown(explain_sweep(study))
    shown(prefix_errors(file, lambda: case_explained(study.case, study.axes)))
    return study.case


@pytest.mark.parametrize("few", [60, pytest.param(240, marks=pytest.mark.slow)])
def test_hostile_cases_are_explained_or_refused(few: int, tmp_path: Path) -> None:
    told = failures(lambda data: check(data, tmp_path), list(case_files(number(few), seed(1))))
    assert not told, told


@pytest.mark.parametrize("few", [20, pytest.param(80, marks=pytest.mark.slow)])
def test_hostile_cases_that_are_accepted_run(few: int, tmp_path: Path) -> None:
    def run(data: bytes) -> None:
        case = check(data, tmp_path)
        if not deforms(case):
            vi.simulate(case)

    told = failures(run, list(case_files(number(few), seed(2))))
    assert not told, told
