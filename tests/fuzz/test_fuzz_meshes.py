"""Damaged mesh files: each is read or refused with a sentence, quickly; and what is read
goes on to its modes, or is refused there.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import vibroimpact as vi
from hostile_runs import failures, number, seed
from support import free_plate, plain_case
from vibroimpact.meshes.mesh_file import load_mesh
from vibroimpact.runs.case_explained import case_explained

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
LINKED_NASTRAN = """\
CEND
MPC = 3
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,0.,1.,0.
GRID,4,,0.,0.,1.
GRID,11,,0.,0.,0.
GRID,12,,1.,0.,0.
GRID,13,,0.,1.,0.
GRID,14,,0.,0.,-1.
GRID,20,,.2,.2,0.
CTETRA,5,7,1,2,3,4,,
,0
CTETRA,6,7,11,12,13,14
RBE2,7,20,123456,1,11,2
RBE3,8,,12,123,1.,123,2,1
RBAR,9,3,13,123456,,,123
RBE1,10,1,123456
,UM,11,12
RROD,11,4,3
MPC,3,13,1,1.,3,1,-.5
,,1,1,-.5
ENDDATA
"""
LINKED_ABAQUS = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
11, 0., 0., 0.
12, 1., 0., 0.
13, 0., 1., 0.
14, 0., 0., -1.
20, .2, .2, 0.
*ELEMENT, TYPE=C3D4, ELSET=A
5, 1, 2, 3, 4
*ELEMENT, TYPE=C3D4, ELSET=B
6, 11, 13, 12, 14
*SURFACE, NAME=SA
A, S1
*SURFACE, NAME=SB
B,
*TIE, NAME=T, POSITION TOLERANCE=0.1
SA, SB
*EQUATION
3
1, 1, 1., 11, 1, -.5
2, 1, -.5
*MPC
LINK, 4, 14
TIE, 3, 13
*COUPLING, REF NODE=20, SURFACE=SA, CONSTRAINT NAME=C
*KINEMATIC
1, 3
*COUPLING, REF NODE=20, SURFACE=SB, CONSTRAINT NAME=D
*DISTRIBUTING
*NSET, NSET=R
1, 2
*RIGID BODY, NSET=R, REF NODE=20
"""
PLACED_ABAQUS = """\
*PART, NAME=P
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
*ELEMENT, TYPE=C3D4, ELSET=A
5, 1, 2, 3, 4
*NSET, NSET=N, GENERATE
1, 3, 1
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=I, PART=P
*END INSTANCE
*INSTANCE, NAME=J, PART=P
1., 0., 0.
0., 0., 0., 1., 0., 0., 180.
*END INSTANCE
*NODE
1, 0., 0., 3.
*NSET, NSET=RP
1
*ELSET, ELSET=B, INSTANCE=J
A
*SURFACE, NAME=S
I.A, S1
*SURFACE, NAME=T
B, S1
*TIE, NAME=T, POSITION TOLERANCE=2
S, T
*EQUATION
2
I.4, 1, 1., J.4, 1, 1.
*COUPLING, CONSTRAINT NAME=C, REF NODE=RP, SURFACE=S
*KINEMATIC
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
SEEDS = {
    ".bdf": [NASTRAN, LINKED_NASTRAN],
    ".inp": [ABAQUS, LINKED_ABAQUS, PLACED_ABAQUS],
    ".msh": [GMSH_2, GMSH_4, GMSH_40],
}
HOSTILE = [
    "1000000000000", "999999999999999999999999", "-1", "0", "1e999", "nan", "inf", "-inf", "1_0", "1.5-3", "1.D+400", "0x10",
    "\u0663", "\x00", "\xff", "\ufeff", "\u2028", "\x0b", "\x1c", "\t", " " * 300, '"', "'", "$", ",", ",,,,,,,,,,,,", "*", "**",
    "=", "+", "-", ";", "\n", "\r", "$Nodes", "$EndNodes", "$Elements", "$EndElements", "$End", "$", "4.1 1 8",
    "3 1 4 1000000000000000", "THRU", "1,THRU,999999999999999999", "SET 1 = 1 THRU 1000000000000", "SET 2 = ALL",
    "SPC1,1,1,1,THRU,1000000000000", "BEGIN BULK", "ENDDATA", "INCLUDE 'mesh.bdf'", "INCLUDE '/'", "INCLUDE ''",
    "INCLUDE '" + "a" * 5000 + "'", "CPENTA,1,1,1,2,3,4,5,6", "CHEXA,1,1,1,2,3,4,5,6,7,8", "GRID*", "=,*1,=",
    "*INCLUDE, INPUT=mesh.inp", "*NODE, INPUT=/dev/null", "*NODE", "*NODE, SYSTEM=C", "*ELEMENT, TYPE=C3D6",
    "*ELEMENT, TYPE=C3D20", "*ELEMENT", "*NSET", "*NSET, NSET=x, GENERATE\n1, 999999999999999999, 1", "*ELSET, ELSET=A\nA, A",
    "RBE2,1,1,123,1,THRU,1000000", "RBE3,1,,1,123,1.-300,123,2,3", "MPC,3,1,1,1.+200,2,1,-1.", "*EQUATION\n1000000000000",
    "*TIE, NAME=X\nSB, SA", "*SURFACE, NAME=SA, TYPE=NODE\n1", "*TRANSFORM, NSET=R",
    "*PART", "*INSTANCE", "*NGEN", "*ASSEMBLY", "NSET=", "TYPE=", "\x1b[31m", "1e-300", "1e14", "1.0000000001", "9" * 400, "(" * 5000,
    " " * 90_000, "a" * 90_000, "a," * 30_000, '"' * 30_000, "*NODE, " + "INPUT " * 5000, "$Entities", "$PhysicalNames", "\u00b2",
    "*NSET, NSET=" + "a" * 40_000, "*ELSET, ELSET=b\n" + "a" * 40_000, "1, 10, 1\n" * 3000, "SET 9 = " + "1," * 20_000,
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
            changed[choose.randrange(len(changed))] = choose.choice(
                [choose.randrange(256), choose.choice(b"0123456789 ,.-+*$\n\t")]
            )
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


def _on_lines(
    change: Callable[[list[bytes], int, int], None],
) -> Callable[[bytes, random.Random], bytes]:
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
    for text in SEEDS[suffix]:
        file = tmp_path / f"mesh{suffix}"
        file.write_text(text)
        assert load_mesh(file).number_of_elements == (1 if suffix == ".msh" else 2)


class Given(NamedTuple):
    """One damaged file."""

    suffix: str
    data: bytes


def at_work(folder: Path) -> Callable[[Given], None]:
    """Return what is done with a damaged file: read it, and look at the mesh; then take
    it as the plate of a case, down to its modes.
    """

    def work(given: Given) -> None:
        file = folder / f"mesh{given.suffix}"
        file.write_bytes(given.data)
        mesh = load_mesh(file)
        assert np.isfinite(mesh.nodes).all()
        assert all(block.connectivity.max() < len(mesh.nodes) for block in mesh.blocks)
        assert all(members.max() < len(mesh.nodes) for members in mesh.node_sets.values())
        assert all(
            members.max() < mesh.number_of_elements for members in mesh.element_sets.values()
        )
        plate = free_plate(file)
        case = vi.case_of(plain_case(plate=plate, drop={"speed": 1.0, "position": [0.2, 0.2]}))
        case_explained(case)
        vi.compute_modes(case)

    return work


@pytest.mark.parametrize("suffix", SEEDS)
def test_damaged_meshes(suffix: str, tmp_path: Path) -> None:
    """A reader returns a mesh or raises InputError, quickly, whatever the file holds; and
    so does what a case makes of the mesh.
    """
    chosen = [random.Random(f"{suffix} {seed(one)}") for one in range(number(100))]
    told = failures(
        at_work(tmp_path),
        [Given(suffix, damaged(choose.choice(SEEDS[suffix]), choose)) for choose in chosen],
    )
    assert not told, told
