"""Cases to start from, and other values given on the command line."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import pytest

import vibroimpact as vi
from support import outcome
from vibroimpact.cases.template import _SECTIONS, case_template


@pytest.mark.parametrize("name", ["paper:type1-theory", "paper:type2-identified", "paper:type3"])
def test_a_template_is_its_source_with_comments(name: str) -> None:
    text = case_template(name, "mine")
    assert vi.case_of(tomllib.loads(text)) == vi.load_case(name, {"name": "mine"})


def test_each_key_stands_there_once_used_or_as_a_comment() -> None:
    text = case_template("paper:type3")
    for section, kind in _SECTIONS.items():
        block = re.split(r"^#? ?\[+", text, flags=re.MULTILINE)
        (own, *more) = [part for part in block if part.startswith(f"{section}]")]
        lines = [line for part in (own, *more) for line in part.splitlines()]
        for key in kind.model_fields:
            assert any(re.match(rf"#? ?{key} = ", line) for line in lines), (section, key)


def test_defaults_in_comments_are_those_of_the_case() -> None:
    """Each comment with a value that TOML can read, made part of the case, changes nothing."""
    text = case_template("paper:type1-theory")
    for line in re.findall(r"^# (\w+ = [^.\n]*?)  ", text, flags=re.MULTILINE):
        key = line.split(" = ")[0]
        if key in (
            "exponent",
            "position",
            "gravity",
            "same_spot",
            "tolerance",
            "finite_sphere",
            "attachment_mode",
        ):
            changed = text.replace(f"# {line}", line, 1)
            assert (
                vi.case_of(tomllib.loads(changed)).to_problem().source
                == vi.load_case("paper:type1-theory").to_problem().source
            ), line


def test_new_writes_a_case_that_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert outcome(monkeypatch, capsys, "new", "my rock", "--from", "paper:type1-variable")[0] == 0
    assert vi.load_case("my rock.toml").name == "my rock"
    assert outcome(monkeypatch, capsys, "check", "my rock.toml")[0] == 0
    status, words = outcome(monkeypatch, capsys, "new", "my rock")
    assert status == 2
    assert "my rock.toml exists; take another name, or --force to replace it" in words
    assert outcome(monkeypatch, capsys, "new", "my rock.toml", "--force")[0] == 0
    assert vi.load_case("my rock.toml").contact.law == "lankarani-nikravesh"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["a/b"], '"a/b" is not a file name; give one without folders, such as my-plate'),
        ([".toml"], '".toml" is not a file name'),
        (["mine", "--from", "paper:type4"], "there is no shipped case"),
        (["mine", "--from", "nothing.toml"], "there is no such file"),
    ],
)
def test_wrong_names(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    words: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    status, said = outcome(monkeypatch, capsys, "new", *arguments)
    assert status == 2
    assert words in said
    assert not list(tmp_path.iterdir())


def test_cases_lists_all(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    status, words = outcome(monkeypatch, capsys, "cases")
    assert status == 0
    assert all(name in words for name in vi.shipped_cases())


# --set
# ------------------------------------------------------------------------------------------------


def test_changes_are_those_of_the_file(tmp_path: Path) -> None:
    text = (
        case_template("paper:type1-theory")
        .replace('"25 mm"', '"30 mm"')
        .replace("impacts = 5", "impacts = 2")
    )
    (tmp_path / "case.toml").write_text(text)
    assert vi.load_case(tmp_path / "case.toml") == vi.load_case(
        "paper:type1-theory", {"sphere.radius": "30 mm", "run.impacts": 2}
    )


def test_files_in_changes_are_found_from_where_the_command_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    corners = ("0.,0.,0.", "1.,0.,0.", "0.,1.,0.", "0.,0.,1.")
    grids = "".join(f"GRID,{number},,{corner}\n" for number, corner in enumerate(corners, 1))
    (tmp_path / "ball.bdf").write_text(
        f"BEGIN BULK\n{grids}CTETRA,1,1,1,2,3,4\nPSOLID,1,1\nENDDATA\n"
    )
    section = vi.load_case("paper:type2", {"sphere.mesh": "ball.bdf"}).sphere
    assert section.mesh.file == str(tmp_path / "ball.bdf")


ONE_IMPACT = ("paper:type1-theory", "-o", "out", "--set", "run.impacts=1")
"""The case and the folder of a command, and the first of its changes."""


def test_a_run_takes_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    arguments = ["run", *ONE_IMPACT, "--set", "drop.height=1 m"]
    assert outcome(monkeypatch, capsys, *arguments)[0] == 0
    result = vi.load_result("out")
    assert len(result.impacts["impact"]) == 1
    assert result.case["drop"]["height"] == 1.0


def test_a_calibration_takes_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    arguments = ["calibrate", *ONE_IMPACT, "--set", "calibrate.target={restitution=0.7}"]
    assert outcome(monkeypatch, capsys, *arguments, "--set", "calibrate.model=adams-impact")[0] == 0
    assert len(json.loads((tmp_path / "out" / "calibration.json").read_text())["impacts"]) == 1
    assert vi.simulate(vi.load_case(tmp_path / "out" / "case.toml")).impacts[
        "restitution_achieved"
    ] == pytest.approx([0.7], abs=1e-6)


def test_a_new_case_has_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    settings = [
        "--set",
        "plate.size.thickness=10 mm",
        "--set",
        "drop.height=2 m",
        "--set",
        "contact.law=flores",
    ]
    assert outcome(monkeypatch, capsys, "new", "thick", *settings)[0] == 0
    changes = {
        "name": "thick",
        "plate.size.thickness": "10 mm",
        "drop.height": "2 m",
        "contact.law": "flores",
    }
    assert vi.load_case("thick.toml") == vi.load_case("paper:type1-theory", changes)
    text = (tmp_path / "thick.toml").read_text()
    assert 'size = ["520 mm", "420 mm", "10 mm"]\n' in text
    assert "# speed = " in text


@pytest.mark.parametrize("name", ["check", "run", "modes", "calibrate", "new"])
@pytest.mark.parametrize(
    ("setting", "words"),
    [
        (
            "plate.size.thicknes=10 mm",
            "plate.size: there is no thicknes; it takes length, width, thickness. Did you "
            'mean "thickness"?',
        ),
        ("plat.size=3", 'plat: unknown key "plat"'),
        ("sphere.radius=-1", "sphere.radius: -1 is not allowed; it must be greater than 0 m"),
        (
            "sphere.radius",
            '--set "sphere.radius": give KEY=VALUE, such as plate.size.thickness="10 mm"',
        ),
        ("sphere.radius.x=1", "sphere.radius: "),
        ("drop.speed=3", "drop: give either height or speed; both are given"),
    ],
)
def test_wrong_settings(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    name: str,
    setting: str,
    words: str,
) -> None:
    """Every command that takes them says the same, and writes nothing."""
    monkeypatch.chdir(tmp_path)
    case = ["mine", "--from", "paper:type1-theory"] if name == "new" else ["paper:type1-theory"]
    status, said = outcome(monkeypatch, capsys, name, *case, "--set", setting)
    assert status == 2
    assert words in said
    assert not list(tmp_path.iterdir())
