"""Completion in the shells: what each place of the command line can go on with, by the
protocol of each shell.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import vibroimpact as vi
from vibroimpact.cases.fields.local import LocalSection
from vibroimpact.cli import main
from vibroimpact.cli.completion import VARIABLE, WORDS, complete_case, joined
from vibroimpact.cli.completion_words import completion_words
from vibroimpact.studies.planning.design import designs

LAWS = list(vi.laws.contact_laws())
MATERIALS = list(vi.materials.material_library())


def completed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *words: str
) -> list[str]:
    """What bash is offered after words, of which the last is incomplete."""
    monkeypatch.setenv(VARIABLE, "complete_bash")
    monkeypatch.setenv("COMP_WORDS", "\n".join(("vibroimpact", *words)))
    monkeypatch.setenv("COMP_CWORD", str(len(words)))
    with pytest.raises(SystemExit) as left:
        main()
    written = capsys.readouterr()
    assert (left.value.code, written.err) == (0, "")
    return written.out.split()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["ru"], ["run"]),
        (["run", "--se"], ["--set"]),
        (["run", "paper:type1-t"], ["paper:type1-theory"]),
        (["run", "paper:nothing"], []),
        (
            ["run", "x.toml", "--set", "plate.size.w"],
            ["plate.size.width=", "plate.size.width=VALUE"],
        ),
        (["check", "x.toml", "--set", "drop.position."], ["drop.position.x=", "drop.position.y="]),
        (["modes", "x.toml", "--set", "sphere.mod"], ["sphere.model=", "sphere.modes="]),
        (
            ["calibrate", "x.toml", "--set", "calibrate.speeds.sc"],
            ["calibrate.speeds.scale=linear", "calibrate.speeds.scale=log"],
        ),
        (["new", "mine", "--set", "plate.model="], ["plate.model=rigid", "plate.model=elastic"]),
        (
            ["run", "x.toml", "--set", "sphere.model="],
            ["sphere.model=rigid", "sphere.model=elastic"],
        ),
        (
            ["run", "x.toml", "--set", "sphere.model"],
            ["sphere.model=rigid", "sphere.model=elastic"],
        ),
        (["run", "x.toml", "--set", "run.impacts"], ["run.impacts=", "run.impacts=all"]),
        (["run", "x.toml", "--set", "contact.law=hert"], ["contact.law=hertz"]),
        (["run", "x.toml", "--set", "plate.material=rig"], ["plate.material=rigid"]),
        (["run", "x.toml", "--set", "sphere.material=rig"], []),
        (
            ["check", "x.toml", "--set", "sweep.design="],
            [f"sweep.design={name}" for name in designs()],
        ),
        (["run", "x.toml", "--set", "no.such.key"], []),
        (["sweep", "paper:sw"], ["paper:sweep"]),
        (["new", "mine", "--from", "paper:cal"], ["paper:calibration"]),
        (["laws", ""], LAWS),
        (["laws", "flo"], ["flores"]),
        (["materials", ""], [*MATERIALS, "rigid"]),
        (["export", "folder", "--to", "adams"], ["adams", "adams-view"]),
        (["compare", "x.toml", "--laws", "flores,newton,hert"], ["flores,newton,hertz"]),
        (["compare", "x.toml", "--laws", "hertz,hertz"], []),  # which is there already
        (
            ["compare", "x.toml", "--set", "newton."],
            ["newton.restitution=", "newton.restitution=VALUE"],
        ),
        (["reproduce", "--only", "table1,table"], ["table1,table2"]),
    ],
    ids=lambda value: " ".join(value)[:40],
)
def test_each_place_of_the_command_line(
    words: list[str],
    expected: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert completed(monkeypatch, capsys, *words) == expected


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["run", "paper", ":", "type1-t"], ["type1-theory"]),
        (
            ["sweep", "paper", ":"],
            sorted(
                name.removeprefix("paper:")
                for name in vi.shipped_cases()
                if name.startswith("paper:")
            ),
        ),
        (
            ["run", "paper", ":", "type3", "--set", "plate.size.th"],
            ["plate.size.thickness=", "plate.size.thickness=VALUE"],
        ),
        (["run", "paper", ":", "type3", "--set", "contact.law", "="], LAWS),
        (["run", "paper", ":", "type3", "--set", "contact.law", "=", "flo"], ["flores"]),
        (
            [
                "run",
                "x.toml",
                "--set",
                "drop.height",
                "=",
                '"2 m"',
                "--set",
                "contact.law",
                "=",
                "flo",
            ],
            ["flores"],
        ),
        (["new", "mine", "--from", "=", "paper", ":", "cal"], ["calibration"]),
        (["run", "x.toml", "--set", "=", "contact.law", "=", "flo"], ["flores"]),
        # a quote keeps a word whole
        (["run", "x.toml", "--set", '"contact.law=flo'], ["contact.law=flores"]),
    ],
    ids=lambda value: " ".join(value)[:60],
)
def test_bash_breaks_words_at_colons_and_equals_signs(
    words: list[str],
    expected: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert completed(monkeypatch, capsys, *words) == expected


def test_words_are_joined_only_where_they_were_broken() -> None:
    assert joined(["vibroimpact", "run", "a", "b"], 3) == (["vibroimpact", "run", "a", "b"], 3, "")
    assert joined(["v", "run", "paper", ":", "x", "--set", "a", "=", ""], 8) == (
        ["v", "run", "paper:x", "--set", "a=", ""],
        5,
        "",
    )


@pytest.mark.parametrize(
    ("shell", "line", "expected"),
    [
        ("zsh", "vibroimpact run paper:type1-t", "_arguments '*: :((\"paper\\\\:type1-theory\"))'"),
        ("zsh", "vibroimpact run no-such-case", "_files"),
        (
            "zsh",
            "vibroimpact run x.toml --set contact.law=flo",
            "_arguments '*: :((\"contact.law=flores\"))'",
        ),
        ("fish", "vibroimpact run paper:type1-t", "paper:type1-theory"),
        ("fish", "vibroimpact run x.toml --set contact.law=flo", "contact.law=flores"),
    ],
)
def test_zsh_and_fish(
    shell: str,
    line: str,
    expected: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv(VARIABLE, f"complete_{shell}")
    monkeypatch.setenv("_TYPER_COMPLETE_ARGS", line)
    monkeypatch.setenv("_TYPER_COMPLETE_FISH_ACTION", "get-args")
    with pytest.raises(SystemExit) as left:
        main()
    assert (left.value.code, capsys.readouterr().out) == (0, f"{expected}\n")


def test_files_of_cases(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in (
        "rock.toml",
        "rock.csv",
        ".hidden.toml",
        "my rock.toml",
        "rocks/a.toml",
        "rocks/deep/b.toml",
        "one/only/c.toml",
    ):
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).touch()
    shipped = sorted(vi.shipped_cases())
    assert complete_case("") == [*shipped, "one/", "rock.toml", "rocks/"]
    assert complete_case("roc") == ["rock.toml", "rocks/"]
    assert complete_case("rocks/") == ["rocks/a.toml", "rocks/deep/"]
    assert complete_case("rocks/d") == ["rocks/deep/b.toml"]
    assert complete_case("o") == ["one/only/c.toml"]
    assert complete_case(".h") == [".hidden.toml"]
    assert complete_case(f"{tmp_path}/rock.") == [f"{tmp_path}/rock.toml"]
    assert complete_case("no/such/folder/") == complete_case("rock.toml/") == []


def test_the_file_of_words_is_not_stale() -> None:
    assert json.loads(WORDS.read_text(encoding="utf-8")) == completion_words(), (
        f"{WORDS.name} is stale: make docs"
    )


def test_keys_are_those_that_a_case_takes() -> None:
    keys = completion_words()["keys"]
    assert {
        "sphere.radius",
        "plate.size.thickness",
        "plate.material.density",
        "plate.mesh.file",
        "contact.law",
        "run.impacts",
    } <= keys.keys()
    contact = (
        {item for law in vi.laws.contact_laws().values() for item in law.__dataclass_fields__}
        | LocalSection.model_fields.keys()
        | {"law", "friction"}
    )
    assert {key.split(".")[1] for key in keys if key.startswith("contact.")} <= contact
    # what a mesh and supports take follows from their kind
    others = [
        key
        for key in keys
        if not key.startswith(
            ("contact.", "plate.mesh.", "sphere.mesh.", "plate.supports.", "calibrate.")
        )
    ]
    assert len(others) > 50
    assert [key for key in others if "unknown key" in refusal(key)] == []


def refusal(key: str) -> str:
    """What is said of a word at a key of a case."""
    try:
        vi.load_case("paper:type3", {key: "nothing"})
    except vi.InputError as error:
        return str(error)
    return ""


def test_a_completion_imports_nothing_heavy() -> None:
    """It is quick because it imports nothing heavy; time is for the benchmarks to show."""
    program = (
        "import sys\nfrom vibroimpact.cli import main\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'h5py', 'matplotlib', 'rich', 'pint', 'numba', "
        "'vibroimpact.cases', 'vibroimpact.contact'}\nheavy &= set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    for words in (
        ["run", "paper:ty"],
        ["run", "x", "--set", "contact.law=fl"],
        ["laws", ""],
        ["export", "x", "--to", ""],
    ):
        words = ["vibroimpact", *words]
        surroundings = {
            **os.environ,
            VARIABLE: "complete_bash",
            "COMP_WORDS": "\n".join(words),
            "COMP_CWORD": str(len(words) - 1),
        }
        done = subprocess.run(
            [sys.executable, "-c", program],
            env=surroundings,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.strip()


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A home of its own, in which the shell is named and not looked for."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION", "1")
    return tmp_path


def program(*arguments: str) -> str:
    command = [sys.executable, "-m", "vibroimpact", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True).stdout


@pytest.mark.parametrize(
    ("shell", "file"),
    [
        ("bash", ".bash_completions/vibroimpact.sh"),
        pytest.param("zsh", ".zfunc/_vibroimpact", marks=pytest.mark.slow),
        pytest.param("fish", ".config/fish/completions/vibroimpact.fish", marks=pytest.mark.slow),
    ],
)
def test_what_is_installed_is_what_is_shown(shell: str, file: str, home: Path) -> None:
    """Also by `python -m vibroimpact`, it is the command `vibroimpact` that is completed."""
    script = program("--show-completion", shell)
    assert f"{VARIABLE}=complete_{shell}" in script
    assert "python -m" not in script
    assert str(home) in program("--install-completion", shell)
    assert (home / file).read_text(encoding="utf-8").strip() == script.strip()


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_bash_itself(home: Path) -> None:
    (home / "script.sh").write_text(program("--show-completion", "bash"), encoding="utf-8")
    (home / "vibroimpact").write_text(
        f'#!/bin/sh\nexec "{sys.executable}" -m vibroimpact "$@"\n', encoding="utf-8"
    )
    (home / "vibroimpact").chmod(0o755)
    lines = (
        "source script.sh",
        "COMP_WORDS=(vibroimpact run paper : type3-s)",
        "COMP_CWORD=4",
        "_vibroimpact_completion ./vibroimpact",
        'printf "%s\\n" "${COMPREPLY[@]}"',
    )
    done = subprocess.run(
        ["bash", "--norc", "-c", "\n".join(lines)],
        cwd=home,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (done.stdout, done.stderr) == ("type3-superposed\n", "")
