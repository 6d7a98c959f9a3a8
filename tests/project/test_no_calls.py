"""Nothing leaves the machine: every command runs under a guard on sockets, and leaves its
own cache alone in the home.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import urllib.request
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
import typer.main

import vibroimpact as vi
from hammer_test import PLATE, RATE, TABLE, hammered
from network_guard import Guard
from studies import coal_on_steel
from support import plain_case
from trained_models import CLASSIFIERS
from vibroimpact.cli import app
from vibroimpact.recognition.onnx_runtime import SWITCH
from vibroimpact.structures.store import PLACE

RUN_ALL = """
import json, os, sys
from vibroimpact.cli import main

for words in json.loads(sys.argv[1]):
    sys.argv = ["vibroimpact", *words]
    try:
        main()
    except SystemExit as left:
        if left.code:
            raise SystemExit(f"{words}: {left.code}")
"""

QUICK: tuple[tuple[str, ...], ...] = (
    ("recognise", "data", "--model", CLASSIFIERS[1], "-o", "applied"),
    ("doctor",),
    ("run", "rigid.toml", "-o", "rigid"),
    ("features", "run", "-o", "features.csv"),
    ("materials",),
)
"""Commands that take no time: among them the one that loads onnxruntime."""

ALL: tuple[tuple[str, ...], ...] = (
    # first, since onnxruntime calls half a minute later
    ("recognise", "data", "-o", "recognised", "--folds", "2", "--seeds", "1"),
    *QUICK,
    ("demo",),
    ("check", "elastic.toml"),
    ("run", "elastic.toml", "-o", "elastic"),
    ("modes", "elastic.toml", "-o", "modes"),
    ("report", "rigid"),
    ("figures", "rigid", "--format", "svg"),
    ("compare", "rigid.toml", "--laws", "tsuji,flores", "-o", "compared"),
    ("calibrate", "calibrated.toml", "-o", "calibrated"),
    ("sweep", "study.toml", "-o", "study", "--processes", "2"),
    ("sweep", "study.toml", "-o", "cluster", "--scheduler", "local", "--processes", "1"),
    ("dataset", "population.toml", "-o", "falls", "--processes", "1"),
    ("bound", "falls", "-o", "bound"),
    ("run", "three.toml", "-o", "three"),
    ("identify", "three.toml", "three", "-o", "identified", "--place", "20 mm, 10 mm"),
    (
        "correlate",
        "elastic.toml",
        "tap.csv",
        "--hammer",
        "hammer",
        "-o",
        "correlated",
        "--band",
        "300 Hz, 1.7 kHz",
    ),
    *(("export", "rigid", "--to", name) for name in ("parquet", "uff58", "adams")),
    ("reproduce", "-o", "paper", "--only", "table1"),
    ("cases",),
    ("new", "own.toml", "--from", "paper:type1-theory"),
    ("units", "5.115e8", "N/m^1.5"),
    ("laws",),
    ("schema",),
    ("serve",),  # in a process of its own, which is ended
)

OWN = (".cache/vibroimpact/", ".cache/matplotlib/")
"""What may be written in the home: this program's store of modes, and matplotlib's list
of the fonts of the machine.
"""


@pytest.fixture
def guard(tmp_path: Path) -> Guard:
    return Guard(tmp_path)


@pytest.fixture
def folder(tmp_path: Path, tiny_models: Path) -> Path:
    """Small inputs of all commands."""
    work = tmp_path / "work"
    work.mkdir()
    for name in ("data", *CLASSIFIERS[1:2]):
        (work / name).symlink_to(tiny_models / name)
    over = {"drop.height": ["1 m", "2 m"], "contact.restitution": [0.5, 0.7]}
    tables: dict[str, dict[str, Any]] = {
        "rigid": plain_case(),
        "elastic": TABLE,
        "three": {
            **TABLE,
            "sphere": coal_on_steel()["sphere"],
            "plate": {**PLATE, "modes": 30},
            "sensors": _sensors(),
        },
        "calibrated": plain_case(
            contact={"law": "adams-impact", "damping_max": 100.0},
            calibrate={"target": {"restitution": 0.6}},
        ),
        "study": {**plain_case(), "sweep": {"over": over}},
        "population": _population(),
    }
    for name, table in tables.items():
        (work / f"{name}.toml").write_text(tomli_w.dumps(table))
    force, value = hammered((0.02,), 0.2)
    columns = np.column_stack([np.arange(len(force)) / RATE, force, value.T / 9.80665])
    np.savetxt(
        work / "tap.csv",
        columns,
        delimiter=",",
        header="time [s],hammer [N],a1 [g],a2 [g]",
        comments="",
    )
    vi.simulate(vi.case_of(TABLE)).save(work / "run")
    return work


def _sensors() -> list[dict[str, Any]]:
    places = {"a": [0.12, 0.08], "b": [-0.1, 0.06], "c": [0.0, -0.1]}
    return [{"name": name, "position": place, "rate": 25.6e3} for name, place in places.items()]


def _population() -> dict[str, Any]:
    over = {"contact.restitution": {"from": 0.4, "to": 0.6}}
    sweep = {
        "design": "population",
        "samples": 8,
        "keep": ["signals"],
        "falls_per_rock": 2,
        "rocks_per_plate": 4,
        "window": {"before": "1 ms", "length": "10 ms"},
        "over": {"drop.height": {"from": "0.8 m", "to": "1 m"}},
        "classes": {"coal": {"over": over}, "gangue": {"over": over}},
    }
    base = plain_case(
        **coal_on_steel(), contact={"law": "tsuji", "restitution": 0.5}, run={"duration": "0.5 s"}
    )
    return {
        **base,
        "sensors": [{"name": "a1", "position": [0.05, 0.05], "rate": "20 kHz"}],
        "sweep": sweep,
    }


def check_silence(guard: Guard) -> None:
    assert guard.calls == []
    assert {name for name in guard.written() if not name.startswith(OWN)} == set()


def test_the_guard_sees_calls(guard: Guard, tmp_path: Path) -> None:
    """Those of Python, of compiled code, and of processes that are started."""
    python = (
        "import socket, contextlib\nwith contextlib.suppress(OSError): "
        "socket.getaddrinfo('example.invalid', 80)"
    )
    guard.run(python, folder=tmp_path)
    assert "socket.getaddrinfo 'example.invalid'" in guard.calls[0]
    if guard.sees_compiled_code:
        compiled = (
            "import ctypes; assert ctypes.CDLL(None).getaddrinfo(b'compiled.invalid', None, "
            "None, ctypes.byref(ctypes.c_void_p()))"
        )
        guard.run(
            f"import subprocess, sys; subprocess.run([sys.executable, '-c', {compiled!r}], "
            "check=True)",
            folder=tmp_path,
        )
        assert "getaddrinfo compiled.invalid by compiled code" in guard.calls


@pytest.mark.slow
def test_quick_commands_call_nobody(guard: Guard, folder: Path) -> None:
    told = guard.run(RUN_ALL, json.dumps(QUICK), folder=folder)
    assert "none is sent" in told
    check_silence(guard)


@pytest.mark.slow
def test_no_command_calls_anybody(guard: Guard, folder: Path) -> None:
    guard.run(RUN_ALL, json.dumps([words for words in ALL if words[0] != "serve"]), folder=folder)
    command = [
        sys.executable,
        "-m",
        "vibroimpact",
        "serve",
        "--port",
        "0",
        "--no-browser",
        "rigid.toml",
    ]
    with subprocess.Popen(
        command,
        env=guard.environment,
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as server:
        assert server.stdout is not None
        address = server.stdout.readline().split()[5].split("#")[0].rstrip(";")
        with urllib.request.urlopen(address) as page:
            assert page.status == 200
        server.terminate()
    check_silence(guard)


def test_all_commands_are_among_them() -> None:
    commands = typer.main.get_command(app)
    assert {words[0] for words in ALL} == set(commands.commands)  # type: ignore[attr-defined]


def test_onnxruntime_is_imported_by_one_module_alone() -> None:
    package = Path(vi.__file__).parent
    named = [
        file
        for file in package.rglob("*.py")
        if "import onnxruntime" in file.read_text(encoding="utf-8")
    ]
    assert [file.name for file in named] == ["onnx_runtime.py"]


def test_onnxruntime_is_silent_also_where_the_environment_says_otherwise(
    guard: Guard, tmp_path: Path
) -> None:
    guard.environment[SWITCH] = "0"
    told = guard.run(
        "import os\nfrom vibroimpact.recognition.onnx_runtime import silent_onnxruntime\n"
        "silent_onnxruntime()\n"
        f"print(os.environ[{SWITCH!r}], {PLACE!r} in os.environ)",
        folder=tmp_path,
    )
    assert told.split() == ["1", "False"]
    assert os.environ.get(SWITCH, "1") == "1"
    check_silence(guard)
