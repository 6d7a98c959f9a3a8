"""Writing of Nastran bulk data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from os import PathLike

import numpy as np

from vibroimpact.arrays import Integers
from vibroimpact.files.atomic_write import write_text_file
from vibroimpact.files.plain_names import one_line
from vibroimpact.materials import Material
from vibroimpact.meshes.deck_mesh import DeckMesh, check_shell_thickness, deck_mesh
from vibroimpact.meshes.node_order import NASTRAN, from_ours
from vibroimpact.structures.finite_elements.mesh import Mesh

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
_JOINTS = 1  # set of the multipoint constraints
# numbers of properties
_SOLIDS = 1  # of the material of the body
_SHELLS = 2
_FIRST_OF_MATERIALS = 3  # of solids with materials of their own
_FIELDS_OF_LINE = 8


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
    >>> from vibroimpact.structures.finite_elements.mesh import ElementBlock
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[3, 0, 1, 2]])),))
    >>> with TemporaryDirectory() as folder:
    ...     write_nastran(tet, Path(folder, "tet.bdf"))
    ...     print(Path(folder, "tet.bdf").read_text().splitlines()[-2])
    CTETRA         1       1       4       1       2       3
    """
    deck = deck_mesh(mesh, material)
    check_shell_thickness(thickness)
    lines = ["CEND"]
    if title:
        lines.append(f"TITLE = {_one_line(title)[:60]}")
    for number, (name, nodes) in enumerate(deck.node_sets.items(), 1):
        lines += [f"$ node set {number}: {_one_line(name)}", *_set(number, nodes)]
    if deck.equations:
        lines.append(f"MPC = {_JOINTS}")
    lines.append("BEGIN BULK")
    lines += _property_cards(deck, thickness)
    for number, point in enumerate(deck.points.tolist(), 1):
        x, y, z = map(nastran_number, point)
        lines += [f"GRID*   {number:16d}{'':16}{x:>16}{y:>16}", f"*       {z:>16}"]
    lines += _element_cards(deck)
    for equation in deck.equations:
        lines += _constraint(equation)
    write_text_file(path, "\n".join([*lines, "ENDDATA", ""]))


def _property_of_solids(material: int) -> int:
    """Return the number of the property of solids of a material, and of this material."""
    if material < 0:
        return _SOLIDS
    return _FIRST_OF_MATERIALS + material


def _property_cards(deck: DeckMesh, thickness: float | None) -> Iterator[str]:
    """Yield the lines of the materials, and of the properties that use them."""
    shapes = {shape for shape, _ in deck.blocks}
    for number, material in deck.materials.items():
        own_number = _property_of_solids(number)
        modulus = nastran_number(material.youngs_modulus)
        ratio = nastran_number(material.poissons_ratio)
        density = nastran_number(material.density)
        yield f"MAT1*   {own_number:16d}{modulus:>16}{'':16}{ratio:>16}"
        yield f"*       {density:>16}"
        if shapes - {"quad8"}:
            yield f"PSOLID  {own_number:8d}{own_number:8d}"
    if thickness is not None and "quad8" in shapes:
        yield f"PSHELL* {_SHELLS:16d}{1:16d}{nastran_number(thickness):>16}{1:16d}"
        yield f"*       {'':16}{1:16d}"


def _element_cards(deck: DeckMesh) -> Iterator[str]:
    number = 0
    for shape, connectivity in deck.blocks:
        if shape in NASTRAN:
            connectivity = connectivity[:, from_ours(shape, NASTRAN[shape])]
        for nodes in connectivity.tolist():
            material = int(deck.element_materials[number])
            number += 1
            own_property = _property_of_solids(material)
            if shape == "quad8":
                own_property = _SHELLS
            yield from _card(_CARDS[shape], [number, own_property, *nodes])


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
    presentation = "e" if abs(value) < 1e-3 else "g"
    candidates = [repr(value), *(f"{value:.{digits}{presentation}}" for digits in range(15, 8, -1))]
    for candidate in candidates:
        text = _in_nastran_style(candidate)
        if len(text) <= 16:
            return text
    raise AssertionError(f"{value} needs more than 16 characters")


def _in_nastran_style(text: str) -> str:
    """Return the text of a number with a point, no superfluous zeros, and no letter e."""
    mantissa, _, exponent = text.partition("e")
    sign = ""
    if mantissa[0] == "-":
        sign = "-"
        mantissa = mantissa[1:]
    if "." not in mantissa:
        mantissa += "."
    elif mantissa.endswith(".0"):
        mantissa = mantissa[:-1]
    if mantissa.startswith("0.") and mantissa != "0.":
        mantissa = mantissa[1:]
    if exponent:
        mantissa += f"{int(exponent):+d}"
    return sign + mantissa


def _card(name: str, numbers: Sequence[int]) -> Iterator[str]:
    """Yield the lines of a card in small fields."""
    for start in range(0, len(numbers), _FIELDS_OF_LINE):
        label = name if start == 0 else "+"
        fields = [f"{number:8d}" for number in numbers[start : start + _FIELDS_OF_LINE]]
        yield f"{label:8}" + "".join(fields)


def _constraint(equation: Sequence[tuple[int, int, float]]) -> Iterator[str]:
    """Yield the lines of a multipoint constraint in large fields, two terms to a pair of lines."""
    # sum of A_i u_i = 0: node, component and coefficient of each term
    for start in range(0, len(equation), 2):
        terms = [
            f"{node:16d}{axis:16d}{nastran_number(coefficient):>16}"
            for node, axis, coefficient in equation[start : start + 2]
        ]
        if start == 0:
            yield f"MPC*    {_JOINTS:16d}{terms[0]}"
        else:
            yield f"*       {'':16}{terms[0]}"
        yield f"*       {terms[1]}" if len(terms) > 1 else "*"


def _set(number: int, nodes: Integers) -> Iterator[str]:
    """Yield the lines of a SET of case control.

    Runs of more than two consecutive numbers are written as ranges (THRU).
    """
    runs = np.split(nodes, np.flatnonzero(np.diff(nodes) != 1) + 1)
    items = []
    for run in runs:
        item = ", ".join(map(str, run))
        if len(run) > 2:
            item = f"{run[0]} THRU {run[-1]}"
        items.append(item)
    for start in range(0, len(items), 3):
        label = f"SET {number} = " if start == 0 else "    "
        end = "" if start + 3 >= len(items) else ","
        yield label + ", ".join(items[start : start + 3]) + end


def _one_line(text: str) -> str:
    return " ".join(one_line(text).replace("$", " ").split())
