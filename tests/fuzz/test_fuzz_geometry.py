"""Damaged STEP files: Gmsh may stop, crash or never end, in a process of its own; what is
left of it is a sentence.
"""

from __future__ import annotations

import random
import subprocess
import sys
from pathlib import Path

import pytest

import vibroimpact as vi
from hostile_runs import failures, number, seed
from vibroimpact.meshes.geometry import mesh_geometry
from vibroimpact.meshes.mesh_file import load_mesh

pytest.importorskip("gmsh", exc_type=ImportError)

_BOX = """
import gmsh, sys
gmsh.initialize()
gmsh.model.occ.addBox(0, 0, 0, 300, 200, 10)
gmsh.model.occ.synchronize()
gmsh.write(sys.argv[1])
"""


@pytest.fixture(scope="module")
def step(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    file = tmp_path_factory.mktemp("geometry") / "box.step"
    subprocess.run([sys.executable, "-c", _BOX, str(file)], check=True, stdout=subprocess.DEVNULL)
    return file.read_bytes()


def damaged(data: bytes, choose: random.Random) -> bytes:
    """A file with some faults: bytes, lines, numbers and references changed."""
    for _ in range(choose.randint(1, 6)):
        lines = data.split(b"\n")
        at, line = choose.randrange(len(data)), choose.randrange(len(lines))
        kind = choose.randrange(5)
        if kind == 0:
            data = data[:at] + bytes([choose.randrange(256)]) + data[at + 1 :]
        elif kind == 1:
            data = b"\n".join([*lines[:line], *lines[line + 1 :]])
        elif kind == 2:
            data = data[: at + len(data) // 4]
        elif kind == 3:
            hostile = choose.choice(
                [
                    b"#1",
                    b"#0",
                    b"#999999",
                    b"1e300",
                    b"$",
                    b"'" + b"\x1b[31m" * 99,
                    b"(" * 20_000,
                    b"\0",
                    b"nan",
                ]
            )
            data = data[:at] + hostile + data[at:]
        else:
            data = data.replace(
                str(choose.choice([300, 200, 10])).encode(),
                choose.choice([b"0", b"1e12", b"-5", b"1e-9"]),
            )
    return data


def read_of(folder: Path, data: bytes) -> None:
    file = folder / "box.step"
    file.write_bytes(data)
    assert load_mesh(file, size=0.1).number_of_elements > 0


def test_a_truncated_geometry(step: bytes, tmp_path: Path) -> None:
    told = failures(lambda data: read_of(tmp_path, data), [step[: len(step) // 2]])
    assert not told, told


@pytest.mark.slow
def test_damaged_geometries(step: bytes, tmp_path: Path) -> None:
    told = failures(
        lambda data: read_of(tmp_path, data),
        [step, *(damaged(step, random.Random(seed(one))) for one in range(number(30)))],
    )
    assert not told, told


def test_a_geometry_that_takes_too_long(
    step: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("vibroimpact.meshes.geometry.MOST_SECONDS", 0.06)
    file = tmp_path / "box.step"
    file.write_bytes(step)
    with pytest.raises(
        vi.InputError,
        match=r"Gmsh did not end within 0.001 minutes and was stopped; give a larger element "
        r"size, or mesh",
    ):
        mesh_geometry(file)
