"""Whatever is named in place of a file: it is read or refused with a sentence, and never
waited for.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import vibroimpact as vi
from hostile_runs import attack
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibration_of
from vibroimpact.files.reading import FileKind, beginning, input_file_digest, read_bytes, read_text
from vibroimpact.measurements.table_file import read_table_file
from vibroimpact.meshes.mesh_file import load_mesh
from vibroimpact.meshes.text_files import MESH

KIND = FileKind("a note is a text file", 1_000_000, "write less")


def elastic(mesh: str) -> dict:
    return plain_case(
        plate={
            "material": "steel",
            "model": "elastic",
            "mesh": mesh,
            "supports": "free",
            "modes": 2,
        }
    )


def calibrated(target: str) -> object:
    return vi.calibration.calibrate_case(
        calibration_of(plain_case(contact={"law": "adams-impact"}, calibrate={"target": target}))
    )


READERS: dict[str, tuple[str, Callable[[str], object]]] = {
    "case": (".toml", vi.load_case),
    "table": (".csv", lambda name: read_table_file(name, {"time": "s"})),
    "nastran": (".bdf", load_mesh),
    "abaqus": (".inp", load_mesh),
    "gmsh": (".msh", load_mesh),
    "geometry": (".step", load_mesh),
    "mesh of a case": (".inp", lambda name: vi.compute_modes(vi.case_of(elastic(name)))),
    "target": (".csv", calibrated),
}


@contextmanager
def told(reader: str, path: str) -> Iterator[str]:
    """Give what a reader says of a path, within a limit of time and memory."""
    (outcome,) = attack(READERS[reader][1], [path])
    assert outcome.kind == "refused", outcome
    yield outcome.text


@pytest.mark.parametrize("reader", READERS)
def test_what_is_no_file_is_refused(reader: str, tmp_path: Path) -> None:
    ending = READERS[reader][0]
    pipe, folder, zero, nothing = (
        tmp_path / f"{name}{ending}" for name in ("pipe", "folder", "zero", "nothing")
    )
    os.mkfifo(pipe)
    folder.mkdir()
    zero.symlink_to("/dev/zero")
    for path, words in (
        (pipe, "this is a pipe"),
        (folder, "this is a directory"),
        (zero, "this is a device"),
        (nothing, "no such file"),
    ):
        with told(reader, str(path)) as message:
            assert f"{path}: " in message
            assert words in message


@pytest.mark.parametrize("reader", READERS)
def test_names_that_no_file_can_have(reader: str, tmp_path: Path) -> None:
    ending = READERS[reader][0]
    for name, words in (
        ("a\0b", "no file can have such a name"),
        ("a\ud800b", "no file can have such a name"),
        ("a" * 300, "too long"),
    ):
        with told(reader, f"{tmp_path}/{name}{ending}") as message:
            assert words in message


@pytest.mark.parametrize("reader", READERS)
def test_a_file_that_is_too_large_is_not_read(reader: str, tmp_path: Path) -> None:
    file = tmp_path / f"large{READERS[reader][0]}"
    with file.open("wb") as out:
        out.truncate(3_000_000_000)  # of which the disk holds nothing
    with told(reader, str(file)) as message:
        assert "the file is larger than" in message


def test_a_large_file_of_zeros_is_not_read_whole(tmp_path: Path) -> None:
    file = tmp_path / "zeros.bdf"
    with file.open("wb") as out:
        out.truncate(1_900_000_000)
    with told("nastran", str(file)) as message:
        assert (
            "this is not a text file; a mesh is a file of nodes and elements, in plain text"
            in message
        )


def test_a_socket_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # the name of a socket is short
    with socket.socket(socket.AF_UNIX) as one:
        one.bind("socket")
        with pytest.raises(vi.InputError, match="this is a socket; a note is a text file"):
            read_bytes("socket", KIND)


def test_a_file_that_grows_while_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "growing"
    file.write_bytes(b"a" * 10)
    # as if it had been small when it was looked at
    monkeypatch.setattr("vibroimpact.files.reading._check", lambda *_: None)
    with pytest.raises(vi.InputError, match="the file is larger than 9e-06 MB; write less"):
        read_bytes(file, KIND._replace(largest=9))
    assert read_bytes(file, KIND._replace(largest=10)) == b"a" * 10


def test_texts(tmp_path: Path) -> None:
    file = tmp_path / "text"
    for data, text in ((b"\xef\xbb\xbfa\xc3\xa4", "a\u00e4"), (b"", ""), (b"a\r\n", "a\r\n")):
        file.write_bytes(data)
        assert read_text(file, KIND) == text
    assert beginning(file, KIND, 1) == b"a"
    for data, words in (
        (b"a\xff", "the file is not UTF-8 text; a note is a text file"),
        (b"a\0", "this is not a text file; a note is a text file"),
        ("a".encode("utf-16"), "the file is not UTF-8 text but UTF-16; save it as UTF-8"),
    ):
        file.write_bytes(data)
        with pytest.raises(vi.InputError, match=words):
            read_text(file, KIND)


def test_digests(tmp_path: Path) -> None:
    file = tmp_path / "data"
    file.write_bytes(b"abc")  # of which FIPS 180-2, appendix B.1, gives the digest
    assert (
        input_file_digest(file, MESH)
        == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    )
