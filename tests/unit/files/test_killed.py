"""Every command killed at its file operations leaves the old result or the new one, and
the next command finds no litter.
"""

from __future__ import annotations

import errno
import os
import shutil
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import pytest
import tomli_w

import vibroimpact as vi
from failing_system_calls import Ended, can_trace, traced
from support import one_in, plain_case
from vibroimpact.cli import main
from vibroimpact.structures.recipe import _MODELS
from vibroimpact.structures.store import _clear_once

pytestmark = pytest.mark.skipif(not can_trace(), reason="no process can be watched here")

BOUNCE = plain_case(contact={"law": "newton", "restitution": 0.5}, run={"impacts": 1})
ELASTIC = plain_case(
    sphere__radius="10 mm",
    plate={
        "material": "steel",
        "model": "elastic",
        "size": ["60 mm", "40 mm", "6 mm"],
        "modes": 3,
        "supports": "clamped",
    },
    run={"impacts": 1},
)
STUDY = {
    **BOUNCE,
    "sweep": {"over": {"drop.height": ["1 m", "2 m", "3 m"], "contact.restitution": [0.4, 0.6]}},
}
CALIBRATION = plain_case(
    contact={"law": "adams-impact", "damping_max": 100.0},
    run={"impacts": 1},
    calibrate={"target": {"restitution": 0.6}},
)
UNSTEADY = {"ledger.sqlite"}  # which has the time at which a chunk was done

EVERY = int(os.environ.get("VIBROIMPACT_EVERY", "96"))
"""Which of the file operations the slow tests try: each (1), each second, ...; of the
last ones eight times as many.
"""

_LAST = 40

Tree = dict[str, bytes]


def tree(folder: Path) -> Tree:
    """Return the files of a folder, or the file, by their names."""
    if folder.is_file():
        return {"": folder.read_bytes()}
    return {
        str(one.relative_to(folder)): one.read_bytes()
        for one in folder.rglob("*")
        if one.is_file() and one.name not in UNSTEADY
    }


def command(*arguments: object) -> None:
    """Run the command line in this process, whatever its status."""
    with suppress(SystemExit):
        command_status(*arguments)


class Clock(datetime):
    """A clock that stands, so that two runs of one case are the same."""

    @classmethod
    def now(cls, tz: object = None) -> datetime:
        return datetime(2024, 1, 1)


@dataclass(frozen=True)
class Scene:
    """A command, what there is before it, and what meets its folder next."""

    arguments: tuple[object, ...]
    before: Callable[[Path], None] = lambda folder: None
    next: tuple[object, ...] = ()
    target: str = "out"
    begins_at_once: bool = False
    """Does a begun study, or reproduction, take the place of what was there? The next
    command ends it.
    """


def older(folder: Path) -> None:
    vi.simulate(vi.case_of({**BOUNCE, "drop": {"height": 1.0}})).save(folder / "out")


def with_an_older_report(folder: Path) -> None:
    vi.simulate(vi.case_of(BOUNCE)).save(folder / "out")
    (folder / "out" / "report.html").write_text("older")


def with_older_figures(folder: Path) -> None:
    vi.simulate(vi.case_of(BOUNCE)).save(folder / "out")
    (folder / "out" / "figures").mkdir()
    for file in ("position.png", "velocity.png"):
        (folder / "out" / "figures" / file).write_text("older")


def exported(folder: Path) -> None:
    vi.simulate(vi.case_of(BOUNCE)).save(folder / "drop")
    (folder / "out").mkdir()
    (folder / "out" / "impacts.csv").write_text("older")
    (folder / "out" / "notes.txt").write_text("mine")


def a_drop(folder: Path) -> None:
    vi.simulate(vi.case_of(BOUNCE)).save(folder / "drop")


def a_picture(folder: Path) -> None:
    (folder / "out.png").write_bytes(b"older")


def a_study(folder: Path) -> None:
    vi.studies.run_sweep(
        vi.studies.sweep_of({**BOUNCE, "sweep": {"over": {"drop.height": ["1 m", "4 m"]}}}),
        folder / "out",
    )


SCENES = {
    "run": Scene(("run", "bounce.toml", "-o", "out"), next=("run", "bounce.toml", "-o", "out")),
    "run --force": Scene(
        ("run", "bounce.toml", "-o", "out", "--force"),
        older,
        ("export", "out", "--to", "csv", "-o", "elsewhere"),
    ),
    "report": Scene(
        ("report", "out"), with_an_older_report, ("export", "out", "--to", "csv", "-o", "elsewhere")
    ),
    "figures": Scene(
        ("figures", "out"), with_older_figures, ("export", "out", "--to", "csv", "-o", "elsewhere")
    ),
    "export": Scene(
        ("export", "drop", "--to", "csv", "-o", "out"),
        a_drop,
        ("export", "drop", "--to", "csv", "-o", "out"),
    ),
    "export --force": Scene(
        ("export", "drop", "--to", "csv", "-o", "out", "--force"),
        exported,
        ("export", "drop", "--to", "csv", "-o", "out"),
    ),
    "export FILE": Scene(
        ("export", "drop", "--to", "mat", "-o", "out.mat"),
        a_drop,
        ("export", "drop", "--to", "mat", "-o", "out.mat"),
        "out.mat",
    ),
    "laws": Scene(
        ("laws", "hertz", "-o", "out.png", "--force"),
        a_picture,
        ("laws", "hertz", "-o", "out.png", "--force"),
        "out.png",
    ),
    "compare": Scene(
        ("compare", "bounce.toml", "--laws", "newton", "-o", "out"),
        next=("run", "bounce.toml", "-o", "out"),
    ),
    "calibrate": Scene(
        ("calibrate", "calibration.toml", "-o", "out"), next=("run", "bounce.toml", "-o", "out")
    ),
    "modes": Scene(
        ("modes", "elastic.toml", "-o", "out"), next=("modes", "elastic.toml", "-o", "out")
    ),
    "sweep": Scene(
        ("sweep", "study.toml", "-o", "out", "--processes", "1"),
        next=("sweep", "study.toml", "-o", "out", "--resume"),
        begins_at_once=True,
    ),
    "sweep --resume": Scene(
        ("sweep", "study.toml", "-o", "out", "--resume", "--processes", "1"),
        next=("sweep", "study.toml", "-o", "out", "--resume"),
        begins_at_once=True,
    ),
    "sweep --force": Scene(
        ("sweep", "study.toml", "-o", "out", "--force", "--processes", "1"),
        a_study,
        ("sweep", "study.toml", "-o", "out", "--force", "--processes", "1"),
        begins_at_once=True,
    ),
    "reproduce": Scene(
        ("reproduce", "-o", "out", "--only", "table1,corrections"),
        next=("reproduce", "-o", "out", "--only", "table1,corrections"),
        begins_at_once=True,
    ),
    "demo": Scene(
        ("demo", "-o", "out", "--force"), older, ("export", "out", "--to", "csv", "-o", "elsewhere")
    ),
}


class Stage:
    """A place where a command is run again and again, from the same beginning."""

    def __init__(self, scene: Scene, place: Path) -> None:
        self.scene, self.place, self.start = scene, place / "here", place / "start"
        self.start.mkdir()
        for name, case in (
            ("bounce", BOUNCE),
            ("elastic", ELASTIC),
            ("study", STUDY),
            ("calibration", CALIBRATION),
        ):
            (self.start / f"{name}.toml").write_text(tomli_w.dumps(case))
        scene.before(self.start)
        self.told = place
        self.old = self.found(self.start)
        self.names = {path.name for path in self.start.iterdir()} | {scene.target, "store"}
        self.reset()
        command(*scene.arguments)  # in this process too, so that all is imported before it forks
        self.new = self.found(self.place)
        assert self.new
        assert self.new != self.old

    def found(self, place: Path) -> Tree:
        return tree(place / self.scene.target)

    def reset(self) -> None:

        shutil.rmtree(self.place, ignore_errors=True)
        shutil.copytree(self.start, self.place)
        os.chdir(self.place)

    def run(self, **how: int) -> Ended:
        self.reset()
        return traced(lambda: command_status(*self.scene.arguments), self.told, **how)

    def check_after_a_kill(self, last: str) -> None:
        """Look at what there is: the old result or the new one, and after the next
        command no more than that.
        """
        found = self.found(self.place)
        whole = found in (self.old, self.new)
        mixed = all(
            data in (self.old.get(name), self.new.get(name))
            for name, data in found.items()
            if ".vibroimpact" not in name
        )
        may_mix = mixed and self.scene.arguments[0] in ("report", "figures", "export")
        assert whole or self.scene.begins_at_once or may_mix, (last, sorted(found))
        command(*self.scene.next)
        again = self.found(self.place)
        assert again in (
            (self.new,) if self.scene.begins_at_once or not self.old else (self.old, self.new)
        ) or (self.scene.next[0] == "run" and "summary.json" in again), (last, sorted(again))
        names = {path.name for path in self.place.iterdir()} - {"elsewhere"}
        assert names <= self.names, (last, names)
        assert not list(self.place.rglob("*-journal")), last
        assert not list(self.place.rglob(".*")), last


def command_status(*arguments: object) -> None:
    """Run the command line in this process as if it were a new one, which remembers nothing."""
    _clear_once.cache_clear()
    _MODELS.clear()
    sys.argv = ["vibroimpact", *map(str, arguments)]
    main()


@pytest.fixture
def stage(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Stage:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("VIBROIMPACT_STORE", "store")
    monkeypatch.setattr("vibroimpact.results.result.datetime", Clock)
    monkeypatch.setattr("time.process_time", lambda: 0.0)  # which a page tells of the modes
    monkeypatch.setattr("sys.argv", list(sys.argv))
    return Stage(SCENES[request.param], tmp_path)


def moments(operations: int) -> list[int]:
    """Return the operations that are tried, counted from 1."""
    last = range(operations, max(0, operations - _LAST), -max(1, EVERY // 8))
    return sorted({*last, *range(operations, 0, -EVERY)})


def try_each(
    stage: Stage, chosen: Callable[[int], list[int]], attempt: Callable[[int, str], None]
) -> None:
    """Attempt something at chosen operations of a command; fail with all that went wrong,
    and of how many.
    """
    whole = stage.run()
    assert whole.status == 0, whole.told
    assert stage.found(stage.place) == stage.new
    tried, wrong = chosen(whole.operations), []
    for moment in tried:
        try:
            attempt(moment, f"operation {moment} of {whole.operations}")
        except AssertionError as error:
            wrong.append(str(error))
    counts = f"{whole.operations} operations, {len(tried)} tried, {len(wrong)} wrong"
    print(counts)
    assert not wrong, "\n".join([counts, *wrong])


def kill_at(stage: Stage, chosen: Callable[[int], list[int]]) -> None:
    def kill(moment: int, which: str) -> None:
        ended = stage.run(kill=moment)
        assert ended.status is None, f"it ended before it was killed at {which}"
        stage.check_after_a_kill(f"killed before {which}, {ended.last}")

    try_each(stage, chosen, kill)


@pytest.mark.parametrize("stage", one_in(3, ["run --force", "report", "laws"]), indirect=True)
def test_a_command_that_is_killed_leaves_the_old_result_or_the_new_one(stage: Stage) -> None:
    kill_at(stage, lambda number: [max(1, number - 12), number - 1])


@pytest.mark.slow
@pytest.mark.parametrize("stage", SCENES, indirect=True)
def test_a_command_that_is_killed_at_any_file_operation_leaves_the_old_result_or_the_new_one(
    stage: Stage,
) -> None:
    kill_at(stage, moments)


@pytest.mark.slow
@pytest.mark.parametrize(
    "error",
    [
        pytest.param(errno.ENOSPC, id="full disk"),
        pytest.param(errno.EACCES, id="no permission", marks=pytest.mark.whole),
    ],
)
@pytest.mark.parametrize("stage", SCENES, indirect=True)
def test_a_command_whose_file_operation_fails_says_so_once_and_leaves_the_old_result(
    stage: Stage, error: int
) -> None:
    def fails(moment: int, which: str) -> None:
        ended = stage.run(fail=moment, error=error)
        where = f"{which} failed, {ended.last}: {ended.status}, {ended.told}"
        assert ended.status in (0, 1, 2), where
        assert "Traceback" not in ended.told, where
        if ended.status:
            assert sum("vibroimpact: " in line for line in ended.told.splitlines()) == 1, where
        stage.check_after_a_kill(where)

    try_each(stage, moments, fails)
