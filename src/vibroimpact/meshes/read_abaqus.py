"""Reading of Abaqus input files."""

from __future__ import annotations

import re
from dataclasses import replace
from os import PathLike
from pathlib import Path

from vibroimpact.errors import did_you_mean
from vibroimpact.meshes.abaqus_assembly import SPAN, flattened, is_assembly
from vibroimpact.meshes.abaqus_blocks import Block, abaqus_include, blocks, real_or_zero
from vibroimpact.meshes.abaqus_links import AbaqusLinks
from vibroimpact.meshes.abaqus_materials import AbaqusMaterials
from vibroimpact.meshes.left_out import remarks_of
from vibroimpact.meshes.node_order import ABAQUS
from vibroimpact.meshes.parsed_mesh import Parts
from vibroimpact.meshes.selection import Selection
from vibroimpact.meshes.text_files import (
    TextLine,
    parse_integer,
    read_lines_with_includes,
)
from vibroimpact.quoting import quoted
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS
from vibroimpact.structures.finite_elements.mesh import Mesh

_KINDS = {
    "4": "tet4",
    "5": "pyramid5",
    "6": "wedge6",
    "8": "hex8",
    "10": "tet10",
    "13": "pyramid13",
    "15": "wedge15",
    "20": "hex20",
    "27": "hex27",
}
_SOLID = re.compile(r"C3D(\d+)[A-Z]*")
_OTHER_SOLID = re.compile(r"E?C3D|SC[68]|CSS8|CCL\d|Q3D")
_MAKES_MESH = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYMMETRIC MODEL GENERATION"}
_INPUTS = {"INCLUDE", "NODE", "ELEMENT", "NSET", "ELSET"}
_QUIET = {
    "HEADING",
    "INCLUDE",
    "PART",
    "END PART",
    "ASSEMBLY",
    "END ASSEMBLY",
    "INSTANCE",
    "END INSTANCE",
}


def read_abaqus(path: str | PathLike[str]) -> Mesh:
    """Read the solid elements of an Abaqus input file.

    It may be flat, or have an assembly of instances of parts.

    The mesh consists of C3D4, C3D5, C3D6, C3D8, C3D10, C3D13, C3D15, C3D20 and C3D27 elements of
    every formulation, and the sets of *NSET, *ELSET, *NODE and *ELEMENT. The materials of *SOLID
    SECTION are in `Mesh.stated`. Other keywords, and elements that are not solid, are counted in
    `Mesh.skipped`. Equations, couplings, rigid bodies and tied surfaces are in `Mesh.joints`.

    Parameters
    ----------
    path : path
        The file; included files are read too.

    Raises
    ------
    InputError
        If it is not such a file, or has unsupported solid elements.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> nodes = "*NODE\\n1,0,0,0\\n2,1,0,0\\n3,0,1,0\\n4,0,0,1\\n"
    >>> deck = nodes + "*ELEMENT,TYPE=C3D4,ELSET=all\\n1,1,2,3,4\\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "tet.inp")
    ...     _ = file.write_text(deck)
    ...     mesh = read_abaqus(file)
    >>> mesh.blocks[0].kind, list(mesh.element_sets)
    ('tet4', ['all'])
    """
    reader = _Reader(Path(path))
    file_blocks = list(blocks(read_lines_with_includes(Path(path), abaqus_include)))
    if is_assembly(file_blocks):
        reader.parts.span = SPAN
        for block in flattened(file_blocks):
            reader.take(block)
    else:
        for block in file_blocks:
            reader.take(block)
    return reader.mesh()


class _Reader:
    """Parser of keyword blocks into `Parts`; tracks the open part, assembly and instance."""

    def __init__(self, path: Path) -> None:
        self.parts = Parts(path, ABAQUS)
        self.materials = AbaqusMaterials()
        self.links = AbaqusLinks()
        self.names: dict[tuple[str, str], str] = {}
        self.open: dict[str, TextLine] = {}
        self.in_assembly = False

    def take(self, block: Block) -> None:
        """Read a block.

        Raises
        ------
        InputError
            If it can't be read, or changes the mesh in a way that is not read.
        """
        keyword = block.keyword
        _check_readable(block)
        if f"END {keyword}" in _QUIET:
            self.open[keyword] = block.line
        elif keyword.startswith("END "):
            self.open.pop(keyword.removeprefix("END "), None)
        # reference points of an assembly are numbered separately: their numbers may coincide with
        # those of nodes of the part
        if keyword in ("ASSEMBLY", "END INSTANCE"):
            self.in_assembly = True
        elif keyword in ("END ASSEMBLY", "INSTANCE", "PART"):
            self.in_assembly = False
        if keyword == "NODE" and not self.in_assembly:
            self._nodes(block)
        elif keyword == "ELEMENT":
            self._elements(block)
        elif keyword in ("NSET", "ELSET") and (
            not self.in_assembly or "INSTANCE" in block.parameters
        ):
            self._set(block)
        elif (
            not self.materials.take(block) and not self.links.take(block) and keyword not in _QUIET
        ):
            self.parts.skipped[f"*{keyword}"] += 1

    def mesh(self) -> Mesh:
        """Return the mesh of the blocks that were read."""
        if self.open:
            keyword, line = self.open.popitem()
            raise line.wrong(
                f"*{keyword} has no *END {keyword}; the file is cut short, "
                "or that line was left out"
            )
        self.parts.sections = [
            (self._of_section(name, line), material)
            for line, name, material in self.materials.sections()
        ]
        self.links.add_to(self.parts, self._set_of)
        mesh = self.parts.mesh()
        return replace(mesh, remarks=(*mesh.remarks, *remarks_of(mesh.skipped)))

    def _selection(self, kind: str, name: str) -> Selection:
        """Return the set of a name, ignoring case."""
        sets = self.parts.element_sets
        if kind == "NSET":
            sets = self.parts.node_sets
        return sets[self.names.setdefault((kind, name.upper()), name)]

    def _nodes(self, block: Block) -> None:
        """Read nodes, and the set that they form, if it has a name."""
        if block.parameters.get("SYSTEM", "R").upper() != "R":
            raise block.line.wrong(
                "the nodes are in cylindrical or spherical coordinates; only SYSTEM=R is read"
            )
        name = block.parameters.get("NSET")
        chosen = Selection()
        if name:
            chosen = self._selection("NSET", name)
        for line in block.data:
            texts = line.text.split(",")
            if len(texts) < 2:
                raise line.wrong(
                    "a node must have a number and up to three "
                    "coordinates, with commas between them"
                )
            number = parse_integer(texts[0], line, "the number of a node")
            coordinates = [*texts[1:4], "", ""][:3]
            x, y, z = (real_or_zero(text, line) for text in coordinates)
            self.parts.add_node(line, number, (x, y, z))
            chosen.numbers.add(number)

    def _elements(self, block: Block) -> None:
        """Read elements, and the set that they form, if it has a name."""
        element_type = block.parameters.get("TYPE", "").upper()
        solid = _SOLID.fullmatch(element_type)
        if solid is None or solid[1] not in _KINDS or self.in_assembly:
            self._skip_elements(block, element_type)
            return
        kind = _KINDS[solid[1]]
        name = block.parameters.get("ELSET")
        chosen = Selection()
        if name:
            chosen = self._selection("ELSET", name)
        entries = 1 + len(ELEMENT_KINDS[kind].reference)  # number and nodes
        # the entries of an element are collected over its continuation lines
        numbers: list[int] = []
        for line in block.data:
            if not numbers:
                first_line = line
            texts = line.text.split(",")
            goes_on = not texts[-1].strip()
            if goes_on:
                texts.pop()
            numbers += [
                parse_integer(text, line, "the number of an element or node") for text in texts
            ]
            if len(numbers) == entries:
                self.parts.add_element(first_line, kind, numbers[0], numbers[1:])
                chosen.numbers.add(numbers[0])
                numbers = []
            elif not goes_on or len(numbers) > entries:
                element = self.parts.written(numbers[0])
                raise first_line.wrong(
                    f"element {element} has {len(numbers) - 1} nodes; {element_type} must have "
                    f"{entries - 1}"
                )
        if numbers:
            element = self.parts.written(numbers[0])
            raise first_line.wrong(
                f"element {element} has {len(numbers) - 1} nodes and its lines end there; "
                f"{element_type} must have {entries - 1}"
            )

    def _skip_elements(self, block: Block, element_type: str) -> None:
        """Count elements that are not solid as skipped.

        Raises
        ------
        InputError
            If they are solid elements that are not read, or have no type.
        """
        if _OTHER_SOLID.match(element_type):
            solid = _SOLID.fullmatch(element_type)
            if solid is not None and solid[1] in _KINDS:
                raise block.line.wrong(
                    f"{quoted(element_type)} in the assembly is a solid element that is not "
                    "read; it must be in a part or an instance"
                )
            raise block.line.wrong(
                f"{quoted(element_type)} is an element that is not read; solid elements must be "
                "C3D4, C3D5, C3D6, C3D8, C3D10, C3D13, C3D15, C3D20 or C3D27, also with "
                "letters behind, as C3D8R"
            )
        if not element_type:
            raise block.line.wrong("*ELEMENT has no TYPE; it must have one, such as TYPE=C3D10")
        if block.parameters.get("ELSET"):  # which other sets may refer to
            self._selection("ELSET", block.parameters["ELSET"])
        # an element continues on the next line after a trailing comma, so that the other lines
        # count the elements
        ends = sum(not line.text.rstrip().endswith(",") for line in block.data)
        self.parts.skipped[element_type] += max(ends, 1)

    def _set(self, block: Block) -> None:
        """Read a set of nodes or elements: numbers, ranges, or names of other sets."""
        kind = block.keyword
        name = block.parameters.get(kind)
        if not name:
            raise block.line.wrong(f"*{kind} has no name; it must have {kind}=name")
        if kind == "NSET" and "ELSET" in block.parameters:
            self.parts.skipped["*NSET, ELSET="] += 1
            return
        chosen = self._selection(kind, name)
        chosen.unsorted |= "UNSORTED" in block.parameters
        included: set[str] = set()
        for line in block.data:
            texts = [text.strip() for text in line.text.split(",") if text.strip()]
            if "GENERATE" in block.parameters:
                chosen.ranges.add(_range(texts, line))
                continue
            for text in texts:
                # in a set of the assembly, members may be written instance.number
                number = text.rpartition(".")[2]
                if number.isdigit():
                    chosen.numbers.add(parse_integer(number, line, "the number of a member"))
                elif text not in included:
                    included.add(text)
                    self.parts.add_members(line, chosen, self._known(kind, text.strip('"'), line))

    def _set_of(self, kind: str, name: str) -> Selection | None:
        """Return the set of a name, with or without the instance before it.

        None if there is no such set.
        """
        for key in (name.upper(), name.rpartition(".")[2].upper()):
            if (kind, key) in self.names:
                return self._selection(kind, key)
        return None

    def _known(self, kind: str, name: str, line: TextLine) -> Selection:
        """Return the set to which a line refers."""
        selection = self._set_of(kind, name)
        if selection is None:
            raise line.wrong(
                f"{quoted(name)} is neither a number nor a *{kind} before this line; it "
                f"must be one of them.{self._suggestion(kind, name)}"
            )
        return selection

    def _of_section(self, name: str, line: TextLine) -> Selection:
        """Return the elements of a section, whose set may come after it."""
        selection = self._set_of("ELSET", name)
        if selection is None:
            raise line.wrong(
                f"the file has no element set {quoted(name)}, of which the section "
                f"is.{self._suggestion('ELSET', name)}"
            )
        return selection

    def _suggestion(self, kind: str, name: str) -> str:
        """Return a sentence with a set of a similar name; "" if there is none."""
        keys = [key for kind_of_key, key in self.names if kind_of_key == kind and len(key) < 100]
        return did_you_mean(name.upper(), keys[:1000])


def _check_readable(block: Block) -> None:
    """Raise InputError if a block changes the mesh in a way that is not read."""
    keyword = block.keyword
    # an included file that is not recognized must not be ignored silently
    includes = keyword == "INCLUDE" or "INPUT" in block.parameters
    if includes and keyword in _INPUTS and abaqus_include(block.line.text) is None:
        raise block.line.wrong(
            f"the file to include is not given; *{keyword} must have INPUT=file on its first line"
        )
    if keyword in _MAKES_MESH:
        raise block.line.wrong(
            f"*{keyword} makes nodes or elements by a rule, which is not read; write each one out"
        )
    if keyword == "SYSTEM" and block.data:
        raise block.line.wrong(
            "*SYSTEM moves the nodes that follow, which is not read; write their global coordinates"
        )


def _range(texts: list[str], line: TextLine) -> tuple[int, int, int]:
    """Return the first, the last and the step of a range."""
    numbers = [parse_integer(text, line, "the bound of a range") for text in texts]
    is_complete = len(numbers) in (2, 3)
    first, last, step = [*numbers, 1, 1, 1][:3]
    if not is_complete or last < first or step < 1:
        raise line.wrong(
            "GENERATE needs first and last, and may have a step; last must be at least "
            "first, and step at least 1"
        )
    return first, last, step
