"""Writing of Abaqus input files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from os import PathLike

import numpy as np

from vibroimpact.files.atomic_write import write_text_file
from vibroimpact.files.plain_names import one_line
from vibroimpact.materials import Material
from vibroimpact.meshes.deck_mesh import check_shell_thickness, deck_mesh
from vibroimpact.structures.mesh import Mesh

_TYPES = {
    "tet4": "C3D4",
    "tet10": "C3D10",
    "wedge6": "C3D6",
    "wedge15": "C3D15",
    "pyramid5": "C3D5",
    "pyramid13": "C3D13",
    "hex8": "C3D8",
    "hex20": "C3D20",
    "quad8": "S8R",
}
_A_LINE = 16
"""Largest number of entries on a line."""


def write_abaqus(
    mesh: Mesh,
    path: str | PathLike[str],
    material: Material | None = None,
    thickness: float | None = None,
) -> None:
    """Write a mesh with its sets as an Abaqus input file in metres, kilograms and seconds.

    27-node bricks become C3D20, which other programs read too, and 14-node pyramids C3D13, which
    Abaqus does not have; each plate element becomes four S8R. Joints become ``*EQUATION``.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    path : path
        The file; an existing one is replaced.
    material : Material, optional
        Material of the elements that have none of their own, written with the section definitions
        that use it.
    thickness : float, optional
        Thickness of the shells [m]; without it the shell section is omitted.

    Raises
    ------
    InputError
        If the mesh is empty, the material rigid, or the file can't be written.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import numpy as np
    >>> from vibroimpact.structures.mesh import ElementBlock
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[3, 0, 1, 2]])),))
    >>> with TemporaryDirectory() as folder:
    ...     write_abaqus(tet, Path(folder, "tet.inp"))
    ...     print(Path(folder, "tet.inp").read_text().splitlines()[-1])
    1, 4, 1, 2, 3
    """
    export = deck_mesh(mesh, material)
    check_shell_thickness(thickness)
    rows = ["*NODE"]
    rows += [
        f"{number}, {x!r}, {y!r}, {z!r}"
        for number, (x, y, z) in enumerate(export.points.tolist(), 1)
    ]
    number = 0
    sections: dict[tuple[str, int], list[int]] = {}  # elements by kind of section and material
    for shape, nodes in export.blocks:
        rows.append(f"*ELEMENT, TYPE={_TYPES[shape]}")
        part = "SHELLS" if shape == "quad8" else "SOLIDS"
        for members in nodes.tolist():
            sections.setdefault((part, int(export.element_materials[number])), []).append(
                number + 1
            )
            number += 1
            rows += _rows([number, *members])
    for keyword, sets in (("NSET", export.node_sets), ("ELSET", export.element_sets)):
        for name, members in sets.items():
            rows += [f"*{keyword}, {keyword}={_quoted(name)}", *_rows(members.tolist())]
    for equation in export.equations:
        rows += ["*EQUATION", str(len(equation))]
        rows += [f"{node}, {axis}, {value!r}" for node, axis, value in equation]
    names: dict[int, str] = {}
    for of, one in export.materials.items():
        names[of] = (
            _quoted(one.name or "material")
            if _quoted(one.name or "material") not in names.values()
            else f"material-{of + 1}"
        )
        rows += [
            f"*MATERIAL, NAME={names[of]}",
            "*DENSITY",
            repr(float(one.density)),
            "*ELASTIC",
            f"{float(one.youngs_modulus)!r}, {float(one.poissons_ratio)!r}",
        ]
    for (part, of), elements in sections.items():
        data = "" if part == "SOLIDS" else None if thickness is None else repr(float(thickness))
        if of in names and data is not None:
            elset = part if of < 0 else f"{part}-{of + 1}"
            runs = np.split(elements, np.flatnonzero(np.diff(elements) != 1) + 1)
            rows += [
                f"*ELSET, ELSET={elset}, GENERATE",
                *(f"{run[0]}, {run[-1]}, 1" for run in runs),
            ]
            rows += [
                f"*{part[:-1]} SECTION, ELSET={elset}, MATERIAL={names[of]}",
                *([data] if data else []),
            ]
    write_text_file(path, "\n".join([*rows, ""]))


def _rows(numbers: Sequence[int]) -> Iterator[str]:
    for start in range(0, len(numbers), _A_LINE):
        goes_on = "," if start + _A_LINE < len(numbers) else ""
        yield ", ".join(map(str, numbers[start : start + _A_LINE])) + goes_on


def _quoted(name: str) -> str:
    """Return a name as an Abaqus label, quoted unless it consists of letters, digits, "_"
    and "-" only.
    """
    label = one_line(name.replace('"', "'"))  # at most 80 characters, the limit of Abaqus
    plain = (
        label.isascii() and label.replace("_", "").replace("-", "").isalnum() and label[0].isalpha()
    )
    return label if plain else f'"{label}"'
