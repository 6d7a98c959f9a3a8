"""Writing of Nastran bulk data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from os import PathLike

import numpy as np

from vibroimpact.arrays import Integers
from vibroimpact.files.atomic_write import write_text_file
from vibroimpact.files.plain_names import one_line
from vibroimpact.materials import Material
from vibroimpact.meshes.deck_mesh import check_shell_thickness, deck_mesh
from vibroimpact.meshes.node_order import NASTRAN, from_ours
from vibroimpact.structures.mesh import Mesh

_CARDS = {
    "tet4": "CTETRA",
    "tet10": "CTETRA",
    "wedge6": "CPENTA",
    "wedge15": "CPENTA",
    "pyramid5": "CPYRAM",
    "pyramid13": "CPYRAM",
    "hex8": "CHEXA",
    "hex20": "CHEXA",
    "quad8": "CQUAD8",
}
_JOINTS = 1
"""Set of the multipoint constraints."""
_SOLIDS, _SHELLS, _OWN = 1, 2, 3
"""Property of solids of the body's material, of shells, and the first one of solids with
materials of their own.
"""


def write_nastran(
    mesh: Mesh,
    path: str | PathLike[str],
    material: Material | None = None,
    title: str = "",
    thickness: float | None = None,
) -> None:
    """Write a mesh as Nastran bulk data in metres, kilograms and seconds.

    27-node bricks become 20-node CHEXA, 14-node pyramids 13-node CPYRAM, each plate element four
    CQUAD8. Solids have property 1, shells property 2, and solids with materials of their own the
    properties from 3 on, which have the numbers of the materials. Node sets become SETs of case
    control, named in comments; element sets are omitted. Joints become MPC.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    path : path
        The file; an existing one is replaced.
    material : Material, optional
        Material of the elements that have none of their own, written as MAT1, with PSOLID.
    title : str, optional
        The title of the analysis.
    thickness : float, optional
        Thickness of the shells [m]; with it PSHELL is written.

    Raises
    ------
    InputError
        If the mesh is empty, the material rigid, or the file can't be written.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from vibroimpact.structures.mesh import ElementBlock
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[3, 0, 1, 2]])),))
    >>> with TemporaryDirectory() as folder:
    ...     write_nastran(tet, Path(folder, "tet.bdf"))
    ...     print(Path(folder, "tet.bdf").read_text().splitlines()[-2])
    CTETRA         1       1       4       1       2       3
    """
    export = deck_mesh(mesh, material)
    check_shell_thickness(thickness)
    rows = ["CEND"]
    if title:
        rows.append(f"TITLE = {_one_line(title)[:60]}")
    for number, (name, nodes) in enumerate(export.node_sets.items(), 1):
        rows += [f"$ node set {number}: {_one_line(name)}", *_set(number, nodes)]
    if export.equations:
        rows.append(f"MPC = {_JOINTS}")
    rows.append("BEGIN BULK")
    shapes = {shape for shape, _ in export.blocks}
    for number, one in export.materials.items():
        own = _SOLIDS if number < 0 else _OWN + number
        youngs, poisson, density = (
            nastran_number(value) for value in (one.youngs_modulus, one.poissons_ratio, one.density)
        )
        rows += [f"MAT1*   {own:16d}{youngs:>16}{'':16}{poisson:>16}", f"*       {density:>16}"]
        if shapes - {"quad8"}:
            rows.append(f"PSOLID  {own:8d}{own:8d}")
    if thickness is not None and "quad8" in shapes:
        rows += [
            f"PSHELL* {_SHELLS:16d}{1:16d}{nastran_number(thickness):>16}{1:16d}",
            f"*       {'':16}{1:16d}",
        ]
    for number, point in enumerate(export.points.tolist(), 1):
        x, y, z = map(nastran_number, point)
        rows += [f"GRID*   {number:16d}{'':16}{x:>16}{y:>16}", f"*       {z:>16}"]
    number = 0
    for shape, nodes in export.blocks:
        theirs = nodes[:, from_ours(shape, NASTRAN[shape])] if shape in NASTRAN else nodes
        for members in theirs.tolist():
            own = int(export.element_materials[number])
            number += 1
            rows += _card(
                _CARDS[shape],
                [
                    number,
                    _SHELLS if shape == "quad8" else _SOLIDS if own < 0 else _OWN + own,
                    *members,
                ],
            )
    for equation in export.equations:
        rows += _constraint(equation)
    write_text_file(path, "\n".join([*rows, "ENDDATA", ""]))


def nastran_number(value: float) -> str:
    """Return a number with a decimal point in at most 16 characters, with as many digits as fit.

    Examples
    --------
    >>> (
    ...     nastran_number(0.1),
    ...     nastran_number(-1 / 3),
    ...     nastran_number(-1.2345678901234567e-12),
    ...     nastran_number(2e11),
    ... )
    ('.1', '-.33333333333333', '-1.2345678901-12', '200000000000.')
    """
    # try the shortest text that gives the same number first: 0.1 rather than 0.10000000000000001
    form = "e" if abs(value) < 1e-3 else "g"
    for text in (repr(value), *(f"{value:.{digits}{form}}" for digits in range(15, 8, -1))):
        mantissa, _, exponent = text.partition("e")
        sign, mantissa = ("-", mantissa[1:]) if mantissa[0] == "-" else ("", mantissa)
        if "." not in mantissa:
            mantissa += "."
        elif mantissa.endswith(".0"):
            mantissa = mantissa[:-1]
        if mantissa.startswith("0.") and mantissa != "0.":
            mantissa = mantissa[1:]
        short = sign + mantissa + (f"{int(exponent):+d}" if exponent else "")
        if len(short) <= 16:
            return short
    raise AssertionError(f"{value} needs more than 16 characters")


def _card(name: str, numbers: Sequence[int]) -> Iterator[str]:
    for start in range(0, len(numbers), 8):
        yield f"{name if start == 0 else '+':8}" + "".join(
            f"{number:8d}" for number in numbers[start : start + 8]
        )


def _constraint(equation: Sequence[tuple[int, int, float]]) -> Iterator[str]:
    """Yield the lines of a multipoint constraint in large fields, two terms to each pair
    of lines.
    """
    for start in range(0, len(equation), 2):
        terms = [
            f"{node:16d}{axis:16d}{nastran_number(value):>16}"
            for node, axis, value in equation[start : start + 2]
        ]
        yield f"MPC*    {_JOINTS:16d}{terms[0]}" if start == 0 else f"*       {'':16}{terms[0]}"
        yield f"*       {terms[1]}" if len(terms) > 1 else "*"


def _set(number: int, nodes: Integers) -> Iterator[str]:
    """Yield the lines of a SET of case control; runs of consecutive numbers are written
    as ranges (THRU).
    """
    runs = np.split(nodes, np.flatnonzero(np.diff(nodes) != 1) + 1)
    items = [
        f"{run[0]} THRU {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs
    ]
    for start in range(0, len(items), 3):
        last = start + 3 >= len(items)
        yield (
            (f"SET {number} = " if start == 0 else "    ")
            + ", ".join(items[start : start + 3])
            + ("" if last else ",")
        )


def _one_line(text: str) -> str:
    return " ".join(one_line(text).replace("$", " ").split())
