"""Damaged mesh files: a reader returns a mesh or raises InputError, and does so quickly, whatever the file holds."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from vibroimpact.errors import InputError
from vibroimpact.exchange.mesh_file import read_mesh

NASTRAN = """\
SOL 103
CEND
SET 1 = 1,2,THRU,
  4, 10
BEGIN BULK
PSOLID,7,1
GRID,1,,0.,0.,0.
GRID           2       01.      0.      0.-0
GRID*   3                               0.              1.D+0
*       0.
GRID,4,0,0.,0.,1.
GRID,10,0,5.-1,0.,0.
CTETRA,5,7,1,2,3,4
CTETRA         6       7       1      10       3       4
+
CQUAD4,9,7,1,2,3,4
SPC1,3,123,1,THRU,3
ENDDATA
"""
ABAQUS = """\
*HEADING
 a test
*PART, NAME=P
*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
10, 0.5, 0., 0.
** elements
*ELEMENT, TYPE=C3D4, ELSET=A
5, 1, 2,
3, 4
6, 1, 10, 3, 4
*ELEMENT, TYPE=S4R
7, 1, 2, 3, 4
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=P-1, PART=P
*END INSTANCE
*NSET, NSET=some, INSTANCE=P-1, GENERATE
1, 3, 2
*NSET, NSET="both, of", INSTANCE=P-1
some, 4
*ELSET, ELSET=B, INSTANCE=P-1
A, 6
*END ASSEMBLY
"""
GMSH_2 = """\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 2 "top"
3 1 "body"
$EndPhysicalNames
$Nodes
4
1 0 0 1
2 0 0 0
7 0 1 0
4 1 0 0
$EndNodes
$Elements
3
1 2 2 2 6 1 2 7
2 4 2 1 1 2 4 7 1
3 4 2 3 1 2 4 7 1
$EndElements
"""
GMSH_4 = """\
$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 2 "top"
$EndPhysicalNames
$Entities
1 0 1 1
1 0 0 1 0
6 0 0 0 1 1 1 1 2 0
1 0 0 0 1 1 1 1 1 1 6
$EndEntities
$Nodes
1 4 1 7
3 1 0 4
1
2
7
4
0 0 1
0 0 0
0 1 0
1 0 0
$EndNodes
$Elements
2 2 1 2
2 6 2 1
1 1 2 7
3 1 4 1
2 2 4 7 1
$EndElements
$Periodic
0
$EndPeriodic
"""
GMSH_40 = """\
$MeshFormat
4 0 8
$EndMeshFormat
$Entities
0 0 0 1
1 0 0 0 1 1 1 1 1 0
$EndEntities
$Nodes
1 4
1 3 0 4
1 0 0 1
2 0 0 0
7 0 1 0
4 1 0 0
$EndNodes
$Elements
1 1
1 3 4 1
2 2 4 7 1
$EndElements
"""
SEEDS = {".bdf": [NASTRAN], ".inp": [ABAQUS], ".msh": [GMSH_2, GMSH_4, GMSH_40]}
HOSTILE = [
    "1000000000000", "999999999999999999999999", "-1", "0", "1e999", "nan", "inf", "-inf", "1_0", "1.5-3", "1.D+400", "0x10",
    "\u0663", "\x00", "\xff", "\ufeff", "\u2028", "\x0b", "\x1c", "\t", " " * 300, '"', "'", "$", ",", ",,,,,,,,,,,,", "*", "**",
    "=", "+", "-", ";", "\n", "\r", "$Nodes", "$EndNodes", "$Elements", "$EndElements", "$End", "$", "4.1 1 8",
    "3 1 4 1000000000000000", "THRU", "1,THRU,999999999999999999", "SET 1 = 1 THRU 1000000000000", "SET 2 = ALL",
    "SPC1,1,1,1,THRU,1000000000000", "BEGIN BULK", "ENDDATA", "INCLUDE 'mesh.bdf'", "INCLUDE '/'", "INCLUDE ''",
    "INCLUDE '" + "a" * 5000 + "'", "CPENTA,1,1,1,2,3,4,5,6", "CHEXA,1,1,1,2,3,4,5,6,7,8", "GRID*", "=,*1,=",
    "*INCLUDE, INPUT=mesh.inp", "*NODE, INPUT=/dev/null", "*NODE", "*NODE, SYSTEM=C", "*ELEMENT, TYPE=C3D6",
    "*ELEMENT, TYPE=C3D20", "*ELEMENT", "*NSET", "*NSET, NSET=x, GENERATE\n1, 999999999999999999, 1", "*ELSET, ELSET=A\nA, A",
    "*PART", "*INSTANCE", "*NGEN", "*ASSEMBLY", "NSET=", "TYPE=",
]  # fmt: skip


def damaged(text: str, choose: random.Random) -> bytes:
    """A file with a few faults of the kinds that editors, disks and people make."""
    data = text.encode("utf-8", errors="surrogatepass")
    for _ in range(choose.randint(1, 4)):
        data = choose.choice(DAMAGES)(data, choose)
    return data


def _edit_bytes(data: bytes, choose: random.Random) -> bytes:
    changed = bytearray(data)
    for _ in range(choose.randint(1, 5)):
        if changed:
            changed[choose.randrange(len(changed))] = choose.choice([choose.randrange(256), choose.choice(b"0123456789 ,.-+*$\n\t")])
    return bytes(changed)


def _cut(data: bytes, choose: random.Random) -> bytes:
    start = choose.randrange(len(data) + 1)
    return data[:start] + data[start + choose.randint(0, 40) :]


def _truncate(data: bytes, choose: random.Random) -> bytes:
    return data[: choose.randrange(len(data) + 1)]


def _insert(data: bytes, choose: random.Random) -> bytes:
    at, token = choose.randrange(len(data) + 1), choose.choice(HOSTILE)
    separator = choose.choice(["", " ", ",", "\n"])
    return data[:at] + f"{separator}{token}{separator}".encode() + data[at:]


def _replace_word(data: bytes, choose: random.Random) -> bytes:
    words = data.split(b" ")
    words[choose.randrange(len(words))] = choose.choice(HOSTILE).encode()
    return b" ".join(words)


def _on_lines(change: Callable[[list[bytes], int, int], None]) -> Callable[[bytes, random.Random], bytes]:
    def damage(data: bytes, choose: random.Random) -> bytes:
        lines = data.split(b"\n")
        change(lines, choose.randrange(len(lines)), choose.randrange(len(lines)))
        return b"\n".join(lines)

    return damage


def _swap(lines: list[bytes], one: int, other: int) -> None:
    lines[one], lines[other] = lines[other], lines[one]


DAMAGES: list[Callable[[bytes, random.Random], bytes]] = [
    _edit_bytes, _cut, _truncate, _insert, _insert, _replace_word,
    _on_lines(_swap),
    _on_lines(lambda lines, one, other: lines.insert(one, lines[other])),
    _on_lines(lambda lines, one, _: lines.__delitem__(one)),
]  # fmt: skip


@pytest.mark.parametrize("suffix", SEEDS)
def test_seeds_are_good(suffix: str, tmp_path: Path) -> None:
    for seed in SEEDS[suffix]:
        file = tmp_path / f"mesh{suffix}"
        file.write_text(seed)
        assert read_mesh(file).number_of_elements == (1 if suffix == ".msh" else 2)


@pytest.mark.parametrize("suffix", SEEDS)
@settings(max_examples=400, deadline=2000, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(number=st.integers(0, 2**32))
def test_damaged_files(suffix: str, number: int, tmp_path: Path) -> None:
    choose = random.Random(number)
    file = tmp_path / f"mesh{suffix}"
    file.write_bytes(damaged(choose.choice(SEEDS[suffix]), choose))
    try:
        mesh, message = read_mesh(file), ""
    except InputError as error:
        mesh, message = None, str(error)
    if mesh is None:
        assert message.startswith(str(file))
        assert "\n" not in message
    else:
        assert np.isfinite(mesh.nodes).all()
        assert all(block.connectivity.max() < len(mesh.nodes) for block in mesh.blocks)
        assert all(members.max() < len(mesh.nodes) for members in mesh.node_sets.values())
        assert all(members.max() < mesh.number_of_elements for members in mesh.element_sets.values())
