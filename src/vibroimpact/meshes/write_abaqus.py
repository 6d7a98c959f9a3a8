"""Writing of Abaqus input files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from os import PathLike

import numpy as np

from vibroimpact.files.atomic_write import write_text_file
from vibroimpact.files.plain_names import one_line
from vibroimpact.materials import Material
from vibroimpact.meshes.deck_mesh import DeckMesh, check_shell_thickness, deck_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh

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
_ENTRIES_OF_LINE = 16  # at most


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
    >>> from vibroimpact.structures.finite_elements.mesh import ElementBlock
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[3, 0, 1, 2]])),))
    >>> with TemporaryDirectory() as folder:
    ...     write_abaqus(tet, Path(folder, "tet.inp"))
    ...     print(Path(folder, "tet.inp").read_text().splitlines()[-1])
    1, 4, 1, 2, 3
    """
    deck = deck_mesh(mesh, material)
    check_shell_thickness(thickness)
    lines = ["*NODE"]
    for number, (x, y, z) in enumerate(deck.points.tolist(), 1):
        lines.append(f"{number}, {x!r}, {y!r}, {z!r}")
    lines += _element_lines(deck)
    for keyword, sets in (("NSET", deck.node_sets), ("ELSET", deck.element_sets)):
        for name, members in sets.items():
            lines += [f"*{keyword}, {keyword}={_quoted(name)}", *_data_lines(members.tolist())]
    for equation in deck.equations:
        lines += ["*EQUATION", str(len(equation))]
        lines += [f"{node}, {axis}, {coefficient!r}" for node, axis, coefficient in equation]
    names = _material_names(deck)
    lines += _material_lines(deck, names)
    lines += _section_lines(deck, names, thickness)
    write_text_file(path, "\n".join([*lines, ""]))


def _element_lines(deck: DeckMesh) -> Iterator[str]:
    number = 0
    for shape, connectivity in deck.blocks:
        yield f"*ELEMENT, TYPE={_TYPES[shape]}"
        for nodes in connectivity.tolist():
            number += 1
            yield from _data_lines([number, *nodes])


def _material_names(deck: DeckMesh) -> dict[int, str]:
    """Return the label of each material by its number, each once."""
    names: dict[int, str] = {}
    for number, material in deck.materials.items():
        name = _quoted(material.name or "material")
        if name in names.values():
            name = f"material-{number + 1}"
        names[number] = name
    return names


def _material_lines(deck: DeckMesh, names: dict[int, str]) -> Iterator[str]:
    for number, material in deck.materials.items():
        yield f"*MATERIAL, NAME={names[number]}"
        yield "*DENSITY"
        yield repr(float(material.density))
        yield "*ELASTIC"
        yield f"{float(material.youngs_modulus)!r}, {float(material.poissons_ratio)!r}"


def _section_lines(deck: DeckMesh, names: dict[int, str], thickness: float | None) -> Iterator[str]:
    """Yield the sections: the elements of a family, solids or shells, and of a material.

    Elements without a material have no section, nor have shells without a thickness.
    """
    sections: dict[tuple[str, int], list[int]] = {}
    number = 0
    for shape, connectivity in deck.blocks:
        family = "SHELLS" if shape == "quad8" else "SOLIDS"
        for _ in range(len(connectivity)):
            material = int(deck.element_materials[number])
            number += 1
            sections.setdefault((family, material), []).append(number)
    for (family, material), elements in sections.items():
        if material not in names or (family == "SHELLS" and thickness is None):
            continue
        label = family
        if material >= 0:
            label = f"{family}-{material + 1}"
        yield f"*ELSET, ELSET={label}, GENERATE"
        # runs of consecutive numbers
        for run in np.split(elements, np.flatnonzero(np.diff(elements) != 1) + 1):
            yield f"{run[0]}, {run[-1]}, 1"
        yield f"*{family[:-1]} SECTION, ELSET={label}, MATERIAL={names[material]}"
        if family == "SHELLS" and thickness is not None:
            yield repr(float(thickness))


def _data_lines(numbers: Sequence[int]) -> Iterator[str]:
    """Yield the data lines of a list of numbers; a comma at the end of one says that it goes on."""
    for start in range(0, len(numbers), _ENTRIES_OF_LINE):
        stop = start + _ENTRIES_OF_LINE
        end = "," if stop < len(numbers) else ""
        yield ", ".join(map(str, numbers[start:stop])) + end


def _quoted(name: str) -> str:
    """Return a name as an Abaqus label, quoted unless it is plain.

    A plain label consists of letters, digits, "_" and "-", and begins with a letter.
    """
    label = one_line(name.replace('"', "'"))  # at most 80 characters, the limit of Abaqus
    letters = label.replace("_", "").replace("-", "")
    is_plain = label.isascii() and letters.isalnum() and label[0].isalpha()
    return label if is_plain else f'"{label}"'
