"""Reading of Gmsh mesh files (.msh, ASCII, versions 2, 4.0 and 4.1)."""

from __future__ import annotations

import re
from os import PathLike
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.files.reading import beginning, with_path
from vibroimpact.meshes.gmsh_sections import GmshSection, sections
from vibroimpact.meshes.node_order import GMSH
from vibroimpact.meshes.parsed_mesh import Parts
from vibroimpact.meshes.text_files import MESH, TextLine, parse_integer, parse_real, read_lines
from vibroimpact.quoting import quoted
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.mesh import Mesh

_SOLIDS = {
    4: "tet4",
    11: "tet10",
    6: "wedge6",
    18: "wedge15",
    7: "pyramid5",
    19: "pyramid13",
    14: "pyramid14",
    5: "hex8",
    17: "hex20",
    12: "hex27",
}
_PRISM18 = 13
# elements of points, lines and surfaces: dimension and number of nodes
_SKINS = {15: (0, 1), 1: (1, 2), 8: (1, 3), 2: (2, 3), 9: (2, 6), 3: (2, 4), 16: (2, 8), 10: (2, 9)}
_MOST_GROUPS = 100  # per entity: each of its elements is added to all of them
_BINARY = re.compile(rb"\s*\$MeshFormat\s+[\d.]+\s+1\s")
_VERSIONS = re.compile(r"2(\.\d+)?|4(\.[01]0*)?")


def read_gmsh(path: str | PathLike[str]) -> Mesh:
    """Read the solid elements of an ASCII Gmsh mesh file, version 2, 4.0 or 4.1.

    Physical groups of points, lines and surfaces become node sets, those of volumes element sets;
    an unnamed group n is called `group<n>`.

    Parameters
    ----------
    path : path
        The file.

    Raises
    ------
    InputError
        If it is not such a file, is binary, or has prisms of 18 nodes or elements of higher than
        second order.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> nodes = "$Nodes\\n4\\n1 0 0 0\\n2 1 0 0\\n3 0 1 0\\n4 0 0 1\\n$EndNodes\\n"
    >>> elements = "$Elements\\n1\\n1 4 2 5 1 1 2 3 4\\n$EndElements\\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "tet.msh")
    ...     _ = file.write_text("$MeshFormat\\n2.2 0 8\\n$EndMeshFormat\\n" + nodes + elements)
    ...     mesh = read_gmsh(file)
    >>> mesh.blocks[0].kind, list(mesh.element_sets)
    ('tet4', ['group5'])
    """
    path = Path(path)
    try:
        start = beginning(path, MESH, 200)
    except InputError as error:
        raise with_path(path, error) from None
    if _BINARY.match(start):
        raise InputError(
            f"{path}: this is a binary file; save the mesh as ASCII (in Gmsh the option "
            "Mesh.Binary = 0)"
        )
    reader = _Reader(path)
    names = ("MeshFormat", "PhysicalNames", "Entities", "Nodes", "Elements")
    reader.read(sections(read_lines(path), names, reader.parts.skipped))
    return reader.parts.mesh()


class _Reader:
    """Parser of the sections of a file into `Parts`."""

    def __init__(self, path: Path) -> None:
        self.parts = Parts(path, GMSH)
        self.version = ""
        self.names: dict[tuple[int, int], str] = {}
        self.groups: dict[tuple[int, int], list[int]] = {}
        self.known: dict[tuple[int, ...], int] = {}

    def read(self, file_sections: dict[str, GmshSection]) -> None:
        """Read the sections of a file, by name.

        Raises
        ------
        InputError
            If one is missing or can't be read.
        """
        for name in ("MeshFormat", "Nodes", "Elements"):
            if name not in file_sections:
                raise InputError(
                    f"{self.parts.path}: the file has no ${name}; a mesh file of Gmsh "
                    "must have $MeshFormat, $Nodes and $Elements"
                )
        line, words = file_sections["MeshFormat"].words(1)
        self.version = words[0]
        if not _VERSIONS.fullmatch(self.version):
            raise line.wrong(
                f"the version {quoted(self.version)} is not read; it must be 2, 4.0 or 4.1 "
                "(in Gmsh the option Mesh.MshFileVersion)"
            )
        if "PhysicalNames" in file_sections:
            self._names(file_sections["PhysicalNames"])
        if "Entities" in file_sections and self.version.startswith("4"):
            self._entities(file_sections["Entities"])
        nodes = file_sections["Nodes"]
        elements = file_sections["Elements"]
        if self.version.startswith("2"):
            self._nodes_2(nodes)
            self._elements_2(elements)
        else:
            self._nodes_4(nodes)
            self._elements_4(elements)
        nodes.end()
        elements.end()

    @property
    def is_40(self) -> bool:
        """Whether the file is of version 4.0, in which some entries have another order."""
        return self.version.startswith("4") and not self.version.startswith("4.1")

    def _names(self, section: GmshSection) -> None:
        """Read the names of physical groups, each of a dimension and a number."""
        section.words(1)
        while section.has_more:
            line, words = section.words(3)
            name = " ".join(words[2:]).strip('"')
            dimension, tag = (
                parse_integer(word, line, "the dimension or number of a group")
                for word in words[:2]
            )
            self.names[dimension, tag] = name or f"group{tag}"

    def _entities(self, section: GmshSection) -> None:
        """Record the physical groups of each point, line, surface and volume."""
        first, counts = section.words(4)
        for dimension, text in enumerate(counts[:4]):
            # an entity has its number, the corners of its box, and its groups; of a point, since
            # version 4.1, there is one corner
            corners = 3 if dimension == 0 and not self.is_40 else 6
            entities = parse_integer(text, first, "the number of entities")
            for line, entries in section.take(entities, 2 + corners):
                count = parse_integer(entries[1 + corners], line, "the number of groups")
                if count > _MOST_GROUPS:
                    raise line.wrong(
                        f"the entity belongs to {count} groups; it may belong "
                        f"to at most {_MOST_GROUPS}"
                    )
                groups = [
                    parse_integer(tag.lstrip("-"), line, "the number of a group")
                    for tag in entries[2 + corners : 2 + corners + count]
                ]
                number = parse_integer(entries[0], line, "the number of an entity")
                self.groups[dimension, number] = groups

    def _nodes_2(self, section: GmshSection) -> None:
        """Read the nodes of version 2: a number and coordinates on each line."""
        first, counts = section.words(1)
        count = parse_integer(counts[0], first, "the number of nodes")
        for line, entries in section.take(count, 4):
            self._node(line, entries[0], entries[1:])

    def _nodes_4(self, section: GmshSection) -> None:
        """Read the nodes of version 4: a block for each entity.

        In version 4.1 the numbers of a block come before the coordinates.
        """
        line, entries = section.words(2)
        remaining = parse_integer(entries[1], line, "the number of nodes")
        while section.has_more:
            line, entries = section.words(4)
            count = parse_integer(entries[3], line, "the number of nodes")
            remaining -= count
            if self.is_40:
                for line, entries in section.take(count, 4):
                    self._node(line, entries[0], entries[1:])
            else:
                numbers = [entries[0] for _, entries in section.take(count, 1)]
                for number, (line, entries) in zip(numbers, section.take(count, 3), strict=True):
                    self._node(line, number, entries)
        if remaining:
            raise section.line.wrong(
                "$Nodes holds another number of nodes than it states; the two must agree"
            )

    def _node(self, line: TextLine, number: str, point: list[str]) -> None:
        """Read a node."""
        x, y, z = point[:3]
        self.parts.add_node(
            line,
            parse_integer(number, line, "the number of a node"),
            (parse_real(x, line), parse_real(y, line), parse_real(z, line)),
        )

    def _elements_2(self, section: GmshSection) -> None:
        """Read the elements of version 2: number, type, tags and nodes on each line.

        The first tag is the physical group.
        """
        first, counts = section.words(1)
        elements = parse_integer(counts[0], first, "the number of elements")
        for line, entries in section.take(elements, 4):
            count = parse_integer(entries[2], line, "the number of tags")
            tags = [parse_integer(tag.lstrip("-"), line, "a tag") for tag in entries[3 : 3 + count]]
            gmsh_type = parse_integer(entries[1], line, "a type of element")
            self._element(line, gmsh_type, entries[0], entries[3 + count :], tags[:1])

    def _elements_4(self, section: GmshSection) -> None:
        """Read the elements of version 4: a block of one type for each entity."""
        line, entries = section.words(2)
        remaining = parse_integer(entries[1], line, "the number of elements")
        while section.has_more:
            line, entries = section.words(4)
            dimension, entity, gmsh_type, count = (
                parse_integer(entry, line, "the dimension, entity, type or number of elements")
                for entry in entries[:4]
            )
            if self.is_40:
                dimension, entity = entity, dimension
            remaining -= count
            groups = self.groups.get((dimension, entity), [])
            for line, entries in section.take(count, 2):
                self._element(line, gmsh_type, entries[0], entries[1:], groups)
        if remaining:
            raise section.line.wrong(
                "$Elements holds another number of elements than it states; the two must agree"
            )

    def _element(
        self, line: TextLine, gmsh_type: int, number: str, texts: list[str], groups: list[int]
    ) -> None:
        """Read an element: a solid one, or a point, line or surface of a group of nodes.

        Parameters
        ----------
        line : TextLine
            The line.
        gmsh_type : int
            The type of the element.
        number : str
            Its number.
        texts : list of str
            The numbers of its nodes.
        groups : list of int
            The physical groups to which it belongs.
        """
        if gmsh_type == _PRISM18:
            raise line.wrong(
                "the element is a prism of 18 nodes, which is not read; prisms must "
                "have 6 or 15 nodes"
            )
        if gmsh_type not in _SOLIDS and gmsh_type not in _SKINS:
            raise line.wrong(
                f"the element is of type {gmsh_type}, which is not read; "
                "all must be of first or second order, and solids "
                "tetrahedra, prisms, pyramids or bricks"
            )
        solid = _SOLIDS.get(gmsh_type)
        if solid:
            dimension = 3
            count = len(ELEMENT_KINDS[solid].reference)
        else:
            dimension, count = _SKINS[gmsh_type]
        if len(texts) != count:
            raise line.wrong(
                f"the element has {len(texts)} nodes; its type {gmsh_type} must have {count}"
            )
        nodes = [parse_integer(text, line, "the number of a node") for text in texts]
        names = [self.names.get((dimension, tag), f"group{tag}") for tag in groups if tag]
        if not solid:
            for name in names:
                self.parts.node_sets[name].numbers.update(nodes)
            return
        element = parse_integer(number, line, "the number of an element")
        # version 2 repeats an element of several groups under several numbers
        first_number = element
        if self.version.startswith("2"):
            first_number = self.known.setdefault(tuple(nodes), element)
        for name in names:
            self.parts.element_sets[name].numbers.add(first_number)
        if first_number == element:
            self.parts.add_element(line, solid, element, nodes)
