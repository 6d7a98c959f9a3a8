"""Exports of runs whose bodies deform, for programs that know rigid bodies alone, against
the same case with rigid bodies.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.adams import Bounce, Motion
from oracles.adams_commands import read_commands
from oracles.adams_dataset import read_dataset, read_solver_commands
from support import one_in
from vibroimpact.calibration.contact_law.file_contents import CALIBRATION, calibration_table
from vibroimpact.cases.build import resolved_case
from vibroimpact.cli import main
from vibroimpact.exporting.export_format import find_export_format
from vibroimpact.exporting.load_drop import drop_of_result
from vibroimpact.results.result import result_of
from written_results import write_result

AGAINST = Against(
    "strict parser of Adams files and SciPy's DOP853, same case with rigid bodies",
    "own independent computation",
    "programs and files",
    "Adams Solver manual, statements and functions; "
    "tests/oracles/adams.py; Adams itself was not run",
)
PEERS = Against(
    "LAMMPS and EXUDYN, simulation of exported elastic cases",
    "other program",
    "programs and files",
    "LAMMPS 22 Jul 2025; EXUDYN 1.13 or newer",
)


ELASTIC: dict[str, Any] = {
    "name": "clamped",
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": {
        "size": ["300 mm", "200 mm", "6 mm"],
        "material": "steel-paper",
        "model": "elastic",
        "modes": 12,
        "damping": "adams-default",
        "supports": "clamped",
        "mesh": {"element_size": "50 mm"},
    },
    "drop": {"height": "1 m", "position": ["20 mm", "10 mm"]},
    "contact": {"law": "adams-impact", "damping_max": [180.0, 120.0, 60.0, 20.0]},
    "run": {"impacts": 4},
}
PROGRAMS = ["adams", "adams-view", "lammps", "yade", "mujoco", "exudyn"]
COMMENTS = {
    ".adm": r"(?m)^!.*",
    ".acf": r"(?m)^!.*",
    ".cmd": r"(?m)^!.*",
    ".in": "#.*",
    ".py": "#.*",
    ".xml": "(?s)<!--.*?-->",
}


def rigid(case: dict[str, Any]) -> dict[str, Any]:
    """The case in which nothing but the contact deforms; of the same name as its export has."""
    made = deepcopy(case) | {"name": f"{case['name']}, rigid"}
    for body in ("sphere", "plate"):
        made[body] = {
            key: value for key, value in made[body].items() if key in ("radius", "size", "material")
        }
    for key in ("local_compliance", "local_stiffness", "local_damping", "finite_sphere"):
        made["contact"].pop(key, None)
    return made


def run(case: dict[str, Any], folder: Path) -> None:
    folder.mkdir()
    write_result(result_of(vi.simulate(vi.case_of(case))), folder)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with the result of an elastic plate, and that of the rigid one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("VIBROIMPACT_STORE", str(tmp_path_factory.mktemp("store")))
        path = tmp_path_factory.mktemp("runs")
        run(ELASTIC, path / "elastic")
        run(rigid(ELASTIC), path / "rigid")
        yield path


@pytest.fixture(scope="module")
def alone(place: Path) -> dict[str, np.ndarray]:
    """The impacts between rigid bodies."""
    return dict(vi.load_result(place / "rigid").impacts)


def stated(files: Iterable[Path]) -> dict[str, list[str]]:
    """What files say to the program, without comments and empty lines."""
    said = {}
    for file in files:
        kept = re.sub(COMMENTS[file.suffix], "", file.read_text())
        said[file.name] = [line.rstrip() for line in kept.splitlines() if line.strip()]
    return said


def exported(folder: Path, to: str, tmp_path: Path) -> dict[str, str]:
    return {
        file.suffix: file.read_text()
        for file in vi.exporting.export_result(folder, to, tmp_path / to)
    }


def moved_by_adams(texts: dict[str, str]) -> list[Bounce]:
    """Move the model that files hold, by their endings."""
    if ".cmd" in texts:
        return Motion(read_commands(texts[".cmd"])).run()
    model = read_dataset(texts[".adm"])
    read_solver_commands(texts[".acf"], model)
    return Motion(model).run()


def test_the_bodies_matter(place: Path, alone: dict[str, np.ndarray]) -> None:
    """The third impact on the elastic plate is as slow as the fourth on the rigid one, or
    slower: no speed tells their dampings apart.
    """
    here = vi.load_result(place / "elastic").impacts["approach_speed_m_s"]
    assert here[2] < alone["approach_speed_m_s"][3] < alone["approach_speed_m_s"][2]


@pytest.mark.parametrize("to", ["adams", "adams-view"])
def test_adams_gives_each_impact_its_own_damping(
    agrees: Agrees, to: str, place: Path, alone: dict[str, np.ndarray], tmp_path: Path
) -> None:
    bounces = moved_by_adams(exported(place / "elastic", to, tmp_path))
    for name, quantity, unit, column in (
        ("approach_speed", "approach speed", "m/s", "approach_speed_m_s"),
        ("separation_speed", "separation speed", "m/s", "separation_speed_m_s"),
        ("largest_force", "maximum contact force", "N", "max_force_N"),
    ):
        theirs = [getattr(bounce, name) for bounce in bounces]
        agrees(
            "different damping coefficient at each impact",
            quantity,
            alone[column],
            theirs,
            unit=unit,
            relative=1e-7,
        )


@pytest.mark.parametrize(
    ("contact", "words"),
    [
        ({"finite_sphere": True}, "whose finite size was corrected here"),
        (
            {
                "local_compliance": "identified",
                "local_stiffness": "2e7 N/m",
                "local_damping": "500 N s/m",
            },
            "local element .* is left out",
        ),
    ],
    ids=["finite sphere", "local element"],
)
@pytest.mark.parametrize("to", ["adams", "exudyn"])
def test_so_it_is_where_the_contact_has_more_than_its_law(
    to: str, contact: dict[str, Any], words: str, tmp_path: Path
) -> None:
    case = rigid(ELASTIC) | {"name": "more"}
    case["contact"] = case["contact"] | contact
    run(case, tmp_path / "more")
    run(rigid(case), tmp_path / "law")
    files = vi.exporting.export_result(tmp_path / "more", to)
    assert stated(files) == stated(vi.exporting.export_result(tmp_path / "law", to))
    text = "".join(file.read_text() for file in files)
    assert re.search(words, " ".join(re.sub("(?m)^[#!]", "", text).split()))


@pytest.mark.parametrize("target", ["rebound", "contact"])
def test_adams_rebounds_as_the_run_or_as_its_contact(
    agrees: Agrees, target: str, place: Path, alone: dict[str, np.ndarray], tmp_path: Path
) -> None:
    """The later impacts of the elastic run begin at other speeds, by the plate's vibration."""
    files = vi.exporting.export_result(place / "elastic", "adams", tmp_path / target, match=target)
    bounces = moved_by_adams({file.suffix: file.read_text() for file in files})
    wanted = alone
    if target == "rebound":
        wanted = dict(vi.load_result(place / "elastic").impacts)
    theirs = [bounce.separation_speed / bounce.approach_speed for bounce in bounces]
    agrees(
        f"IMPACT matched to an elastic simulation: {target}",
        "coefficient of restitution",
        wanted["restitution_achieved"][: len(theirs)],
        theirs,
        absolute=2e-4,
    )
    assert theirs[0] == pytest.approx(wanted["restitution_achieved"][0], rel=1e-6)
    assert len(theirs) == len(wanted["restitution_achieved"])


@pytest.mark.parametrize("to", one_in(2, PROGRAMS))
def test_the_program_is_told_of_rigid_bodies_and_people_are_too(
    to: str,
    place: Path,
    alone: dict[str, np.ndarray],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The same as of the case with rigid bodies, number for number; file and command say
    so, with both restitutions.
    """
    here = vi.load_result(place / "elastic").impacts["restitution_achieved"]
    words = (
        "The plate is written as rigid",
        "the same case between rigid bodies",
        "Restitution from impact to impact: "
        f"{', '.join(f'{e:.3f}' for e in alone['restitution_achieved'])} as written, "
        f"{', '.join(f'{e:.3f}' for e in here)} in the run.",
        'calibrate the case with model = "rigid"',
    )
    monkeypatch.setattr(
        "sys.argv",
        ["vibroimpact", "export", str(place / "elastic"), "--to", to, "-o", str(tmp_path / "out")],
    )
    with pytest.raises(SystemExit) as left:
        main()
    assert not left.value.code
    printed = " ".join(capsys.readouterr().out.split())
    assert re.search(r"Tested: .*between rigid bodies", printed)
    files = list((tmp_path / "out").iterdir())
    assert stated(files) == stated(
        vi.exporting.export_result(place / "rigid", to, tmp_path / "rigid")
    )
    (text,) = (file.read_text() for file in files if file.suffix != ".acf")
    for said in (printed, " ".join(re.sub(r"^[#!]", "", text, flags=re.MULTILINE).split())):
        assert all(one in said for one in words), said


@pytest.mark.slow
def test_the_remedy_that_is_named_rebounds_as_the_run(
    agrees: Agrees, place: Path, tmp_path: Path
) -> None:
    """Calibrated to the impacts of the run, rigid bodies have its restitution."""
    case = rigid(ELASTIC)
    case["contact"]["damping_max"] = 180.0
    case["calibrate"] = {"target": str(place / "elastic" / "impacts.csv"), "degree": 3}
    wanted = vi.calibration.calibration_of(case)
    found = vi.calibration.calibrate_case(wanted)
    (tmp_path / "found").mkdir()  # what an export reads of a calibration, without its figures
    (tmp_path / "found" / CALIBRATION).write_text(json.dumps(calibration_table(found)))
    (tmp_path / "found" / "case.toml").write_text(
        tomli_w.dumps(resolved_case(found.calibrated_case))
    )
    bounces = moved_by_adams(exported(tmp_path / "found", "adams", tmp_path))
    here = vi.load_result(place / "elastic").impacts
    theirs = [bounce.separation_speed / bounce.approach_speed for bounce in bounces]
    agrees(
        "rigid bodies calibrated to an elastic simulation",
        "coefficient of restitution",
        here["restitution_achieved"],
        theirs,
        absolute=2e-4,
    )


@pytest.mark.slow
@pytest.mark.parametrize("model", ["rigid", "elastic"])
@pytest.mark.parametrize("to", one_in(2, ["adams", "adams-view"]))
def test_a_function_is_taken_at_the_speeds_of_rigid_bodies(
    agrees: Agrees, to: str, model: str, place: Path
) -> None:
    """Adams evaluates it as it runs; others are given its values at impacts, which must
    be those that Adams' run has.
    """
    case = vi.case_of(ELASTIC if model == "elastic" else rigid(ELASTIC))
    function = ("damping_max", vi.laws.SpeedFunction((40.0, 30.0), 1.0, 5.0))
    format = find_export_format(to)
    drop = format.prepare(drop_of_result(vi.load_result(place / model), case, function))
    bounces = moved_by_adams(
        {Path(name).suffix: text.decode() for name, text in format.write(drop).items()}
    )
    assert len(bounces) == 4
    case, theirs = (
        "damping as a function of the approach speed",
        [(bounce.approach_speed, bounce.largest_force) for bounce in bounces],
    )
    agrees(
        case,
        "approach speed",
        drop.impacts["approach_speed_m_s"],
        [speed for speed, _ in theirs],
        unit="m/s",
        relative=1e-7,
    )
    agrees(
        case,
        "maximum contact force",
        drop.impacts["max_force_N"],
        [force for _, force in theirs],
        unit="N",
        relative=1e-7,
    )


@pytest.mark.peers
@pytest.mark.parametrize(("to", "tolerance"), [("lammps", 3e-4), ("exudyn", 1e-6)])
def test_the_program_itself(
    agrees: Agrees,
    to: str,
    tolerance: float,
    place: Path,
    alone: dict[str, np.ndarray],
    tmp_path: Path,
) -> None:
    pytest.importorskip(to, exc_type=ImportError)
    (file,) = vi.exporting.export_result(place / "elastic", to, tmp_path / to)
    command = (
        [str(Path(sys.executable).parent / "lmp"), "-log", "none", "-in"]
        if to == "lammps"
        else [sys.executable]
    )
    done = subprocess.run(
        [*command, file.name],
        cwd=file.parent,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    found = [float(value) for value in re.findall(r"impact \d+: .*restitution (\S+),", done.stdout)]
    agrees(
        f"elastic case, exported with rigid bodies to {to}",
        "coefficient of restitution",
        alone["restitution_achieved"],
        found,
        against=PEERS,
        relative=tolerance,
    )
