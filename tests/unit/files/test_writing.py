"""Files and folders written whole or not at all, and what dead processes have left of them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import vibroimpact as vi
from vibroimpact.files.atomic_write import (
    atomic_file,
    atomic_folder,
    write_file,
    write_into,
)
from vibroimpact.files.recover import recover
from vibroimpact.files.working_files import COMPLETE, NEW, OLD, inner_path, working_path


def nothing() -> None:
    pass


def make(folder: Path, text: str) -> None:
    with atomic_folder(folder, nothing) as working:
        (working / "a.txt").write_text(text)


def leaves(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): path.read_text()
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_a_folder_takes_the_place_of_another(tmp_path: Path) -> None:
    for text in ("one", "two"):
        make(tmp_path / "out", text)
        assert leaves(tmp_path) == {"out/a.txt": text}


def test_two_renames_that_fail_half_way_are_undone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make(tmp_path / "out", "old")
    rename, calls = Path.rename, []

    def second_fails(self: Path, target: Path) -> Path:
        calls.append(target)
        if len(calls) == 2:
            raise OSError(5, "Input/output error")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", second_fails)
    with pytest.raises(OSError, match="Input/output"):
        make(tmp_path / "out", "new")
    assert leaves(tmp_path) == {"out/a.txt": "old"}


def test_a_folder_that_made_way_gets_its_name_back_and_what_was_half_written_goes(
    tmp_path: Path,
) -> None:
    target = tmp_path / "out"
    for kind in (OLD, NEW):
        path = working_path(target, kind)
        path.mkdir()
        (path / "a.txt").write_text(kind)
    recover(target)
    assert leaves(tmp_path) == {"out/a.txt": OLD}
    path = working_path(target, OLD)  # of a process that died before it cleared it
    path.mkdir()
    recover(target)
    assert [one.name for one in tmp_path.iterdir()] == ["out"]


def test_what_a_living_process_writes_is_not_touched(tmp_path: Path) -> None:
    code = f"""
import sys
from pathlib import Path
from vibroimpact.files.atomic_write import atomic_folder
from vibroimpact.files.atomic_write import atomic_file
with atomic_folder(Path({str(tmp_path / "out")!r}), lambda: None) as a, atomic_file(Path({str(tmp_path / "file")!r})) as b:
    print("ready", flush=True)
    sys.stdin.read()
"""
    with subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as living:
        assert living.stdout is not None
        assert living.stdout.readline() == "ready\n"
        recover(tmp_path / "out")
        recover(tmp_path / "file")
        assert len(list(tmp_path.iterdir())) == 2
        living.kill()
        living.wait()
    recover(tmp_path / "out")
    recover(tmp_path / "file")
    assert not list(tmp_path.iterdir())


def test_no_file_of_another_kind_is_taken_for_left_over(tmp_path: Path) -> None:
    names = [
        ".out.backup",
        ".out.old.abcdefgh",
        ".vibroimpact",
        ".vibroimpact-notes.new",
        ".report.mine",
        f"{working_path(Path('out'), NEW)}x",
    ]
    (tmp_path / "out").mkdir()
    for place in (tmp_path, tmp_path / "out"):
        for name in [*names, working_path(Path("another"), NEW).name]:
            (place / name).mkdir()
    before = sorted(tmp_path.rglob("*"))
    recover(tmp_path / "out")
    assert sorted(tmp_path.rglob("*")) == before


def test_files_go_into_a_folder_all_or_none(tmp_path: Path) -> None:
    for name in ("a.txt", "old.txt", "mine"):
        (tmp_path / name).write_text("before")

    def write(working: Path) -> None:
        (working / "a.txt").write_text("new")
        (working / "sub").mkdir()
        (working / "sub" / "b.txt").write_text("new")

    def fails(working: Path) -> None:
        write(working)
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space"):
        write_into(tmp_path, fails, ("*.txt",))
    assert leaves(tmp_path) == {"a.txt": "before", "old.txt": "before", "mine": "before"}
    write_into(tmp_path, write, ("*.txt",))
    assert leaves(tmp_path) == {"a.txt": "new", "sub/b.txt": "new", "mine": "before"}


def test_files_that_were_whole_reach_their_places_after_a_death(tmp_path: Path) -> None:
    (tmp_path / "old.txt").write_text("before")
    whole = inner_path(tmp_path, COMPLETE)
    (whole / "put" / "sub").mkdir(parents=True)
    (whole / "gone").mkdir()
    (whole / "put" / "sub" / "b.txt").write_text("new")
    (whole / "gone" / "old.txt").touch()
    recover(tmp_path)
    assert leaves(tmp_path) == {"sub/b.txt": "new"}
    assert not list(tmp_path.glob(".*"))


def test_nothing_leaves_a_folder_by_its_links(tmp_path: Path) -> None:
    folder, home = tmp_path / "received", tmp_path / "home"
    home.mkdir()
    (home / "profile").write_text("mine")
    for part in ("put", "gone"):
        whole = inner_path(folder, COMPLETE)
        (whole / part / "figures").mkdir(parents=True)
        (whole / part / "figures" / "profile").write_text("theirs")
    (folder / "figures").symlink_to(home)
    recover(folder)
    assert leaves(home) == {"profile": "mine"}
    assert not list(folder.glob(".*"))


def test_a_file_is_replaced_whole_or_not_at_all(tmp_path: Path) -> None:
    write_file(tmp_path / "a", b"one")
    (tmp_path / "link").symlink_to("a")
    write_file(tmp_path / "link", [b"t", b"wo"], durable=True)
    assert leaves(tmp_path) == {"a": "two", "link": "two"}
    assert (tmp_path / "link").is_symlink()

    def interrupted() -> None:
        with atomic_file(tmp_path / "a") as working:
            working.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert leaves(tmp_path) == {"a": "two", "link": "two"}
    with pytest.raises(OSError, match="No such file") as failed:
        write_file(tmp_path / "none" / "a", b"")
    assert failed.value.filename == str(tmp_path / "none" / "a")


def test_a_long_name_and_the_rights_of_the_user_are_kept(tmp_path: Path) -> None:
    name = "n" * 250
    before = os.umask(0o027)
    try:
        make(tmp_path / name, "x")
        write_file(tmp_path / "file", b"")
    finally:
        os.umask(before)
    assert (tmp_path / name).stat().st_mode & 0o777 == 0o750
    assert (tmp_path / "file").stat().st_mode & 0o777 == 0o640


def test_no_folder_is_left_where_nothing_could_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a run, its figures and its export, and of a folder that was there already."""
    folder = vi.simulate(vi.load_case("paper:type1-theory")).save(tmp_path / "drop")
    (tmp_path / "mine").mkdir()
    response = vi.simulate(vi.load_case("paper:type1-theory"))

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    monkeypatch.setattr(Path, "write_text", full)
    monkeypatch.setattr(Path, "open", full)
    writes = [
        lambda place: vi.save_figures(folder, ["png"], place),
        lambda place: response.save(place),
        lambda place: vi.exporting.export_result(folder, "csv", place),
    ]
    for number, write in enumerate(writes):
        with pytest.raises((OSError, vi.InputError), match="No space left on device"):
            write(tmp_path / f"{number}" / "a" / "b")
    with pytest.raises((OSError, vi.InputError), match="No space left on device"):
        vi.save_figures(folder, ["png"], tmp_path / "mine")
    assert sorted(one.name for one in tmp_path.iterdir()) == ["drop", "mine"]
    assert list((tmp_path / "mine").iterdir()) == []
