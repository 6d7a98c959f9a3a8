"""Equations, couplings, rigid bodies and tied surfaces of an Abaqus input file."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

from vibroimpact.meshes.abaqus_blocks import Block
from vibroimpact.meshes.links import COMPONENTS, Distance, Equation, Mean, Rigid, equation_of
from vibroimpact.meshes.parsed_mesh import Parts
from vibroimpact.meshes.selection import Selection
from vibroimpact.meshes.text_files import TextLine, parse_integer, parse_real
from vibroimpact.meshes.tied_surfaces import MeshSurface, Tie
from vibroimpact.structures.finite_elements.joints import AXES

_ALL = tuple(range(COMPONENTS))
_DISPLACEMENTS = tuple(range(AXES))
_TERMS = 3  # entries of a term of an equation
_KEYWORDS = {
    "EQUATION",
    "MPC",
    "COUPLING",
    "KINEMATIC",
    "DISTRIBUTING",
    "KINEMATIC COUPLING",
    "RIGID BODY",
    "TIE",
    "SURFACE",
    "TRANSFORM",
}
_CYCLIC = ("CYCLIC SYMMETRY", "MULTISTAGE")
_FACES: dict[str, dict[int, tuple[int, ...]]] = {
    "S1": {4: (0, 1, 2), 5: (0, 1, 2, 3), 6: (0, 1, 2), 8: (0, 1, 2, 3)},
    "S2": {4: (0, 3, 1), 5: (0, 1, 4), 6: (3, 4, 5), 8: (4, 5, 6, 7)},
    "S3": {4: (1, 3, 2), 5: (1, 2, 4), 6: (0, 1, 4, 3), 8: (0, 1, 5, 4)},
    "S4": {4: (2, 3, 0), 5: (2, 3, 4), 6: (1, 2, 5, 4), 8: (1, 2, 6, 5)},
    "S5": {5: (3, 0, 4), 6: (2, 0, 3, 5), 8: (2, 3, 7, 6)},
    "S6": {8: (3, 0, 4, 7)},
}
"""Corners of the faces of elements, by their label and the number of corners of the element."""

Known = Callable[[str, str], Selection | None]
"""From "NSET" or "ELSET" and a name or number to its members; None if there is no such set."""


class AbaqusLinks:
    """Collected blocks that link nodes.

    They are read at the end, as the sets that they name may come later.
    """

    def __init__(self) -> None:
        self._blocks: list[Block] = []
        self._surfaces: dict[str, Block] = {}
        self._transforms: list[Block] = []

    def take(self, block: Block) -> bool:
        """Keep a block if it is one of these; return whether it is."""
        if block.keyword not in _KEYWORDS:
            return False
        if block.keyword == "SURFACE":
            self._surfaces[_upper(block.parameters.get("NAME", ""))] = block
        elif block.keyword == "TRANSFORM":
            self._transforms.append(block)
        else:
            self._blocks.append(block)
        return True

    def add_to(self, parts: Parts, known: Known) -> None:
        """Add the links to the parts, and count those that can't be used as skipped.

        Raises
        ------
        InputError
            If a number can't be read.
        """
        reader = _Reader(parts, known, self._surfaces, self._transforms)
        coupling: Block | None = None
        for block, following in itertools.zip_longest(self._blocks, self._blocks[1:]):
            if block.keyword == "COUPLING":
                coupling = block
                # its kind is that of the block after it
                if following is None or following.keyword not in ("KINEMATIC", "DISTRIBUTING"):
                    parts.skipped["*COUPLING"] += 1
                continue
            for keyword in reader.add(block, coupling):
                parts.skipped[f"*{keyword}"] += 1
        if self._transforms:
            parts.skipped["*TRANSFORM"] += len(self._transforms)


class _Reader:
    """Reader of the blocks, which knows the sets and surfaces."""

    def __init__(
        self, parts: Parts, known: Known, surfaces: dict[str, Block], transforms: Sequence[Block]
    ) -> None:
        self.parts = parts
        self.known = known
        self.surfaces = surfaces
        # nodes whose components of motion are along axes of their own
        self.turned = Selection()
        for block in transforms:
            name = block.parameters.get("NSET", "")
            self.turned.update(known("NSET", name) or Selection())

    def add(self, block: Block, coupling: Block | None) -> list[str]:
        """Add the links of a block; return the names of those that can't be used."""
        readers = {
            "EQUATION": self._equations,
            "MPC": self._mpc,
            "TIE": self._tie,
            "RIGID BODY": self._rigid_body,
            "KINEMATIC COUPLING": self._kinematic_coupling,
        }
        if block.keyword in readers:
            return readers[block.keyword](block)
        return self._coupling(block, coupling)

    def _equations(self, block: Block) -> list[str]:
        """Read "n" and n terms, of nodes or sets of nodes, one after the other."""
        if "REMOVE" in block.parameters:
            return ["EQUATION"]
        left_out = []
        lines = [(line, [text.strip() for text in line.text.split(",")]) for line in block.data]
        index = 0
        while index < len(lines):
            line, texts = lines[index]
            count = parse_integer(texts[0], line, "the number of terms")
            index += 1
            entries: list[str] = []
            while index < len(lines) and len(entries) < _TERMS * count:
                texts = lines[index][1]
                if len(texts) > 1:
                    # what follows the last whole term of a line, as after a comma, is no entry
                    texts = texts[: len(texts) - len(texts) % _TERMS]
                entries += texts
                index += 1
            if len(entries) < _TERMS * count:
                raise line.wrong(
                    f"the equation has {len(entries) // _TERMS} of the {count} terms that "
                    "it states; all must follow it"
                )
            equations = self._equation(line, entries[: _TERMS * count])
            if equations is None:
                left_out.append("EQUATION")
            for equation in equations or ():
                self.parts.links.add("*EQUATION", equation)
        return left_out

    def _equation(self, line: TextLine, entries: Sequence[str]) -> list[Equation] | None:
        """Return the equations of terms: several if the terms are of sets.

        None if one can't be used.
        """
        terms = []
        for start in range(0, len(entries), _TERMS):
            nodes = self._in_order(entries[start], line)
            component = parse_integer(entries[start + 1], line, "a component of motion") - 1
            coefficient = parse_real(entries[start + 2], line, "a coefficient")
            if (
                not nodes
                or component not in _ALL
                or not abs(coefficient) < float("inf")
                or any(self._is_turned(node) for node in nodes)
            ):
                return None
            terms.append((nodes, component, coefficient))
        # sets of one size are paired; a single node occurs in each equation
        counts = {len(nodes) for nodes, _, _ in terms} - {1}
        if len(terms) < 2 or len(counts) > 1:
            return None  # of one term it is a support
        equations = []
        for index in range(max(counts, default=1)):
            equation = equation_of(
                line,
                [
                    ((nodes[min(index, len(nodes) - 1)], component), coefficient)
                    for nodes, component, coefficient in terms
                ],
            )
            if equation is None:
                return None
            equations.append(equation)
        return equations

    def _mpc(self, block: Block) -> list[str]:
        """Read multipoint constraints between two nodes, or two sets of paired nodes.

        TIE is of the same motion, PIN of the same displacements, and LINK of a constant distance.
        """
        left_out = []
        for line in block.data:
            entries = [text.strip() for text in line.text.split(",") if text.strip()]
            kind = entries[0].upper() if entries else ""
            sets = [self._in_order(text, line) for text in entries[1:]]
            is_pair = len(sets) == 2 and len(sets[0]) == len(sets[1]) > 0
            if kind not in ("TIE", "PIN", "LINK") or not is_pair:
                left_out.append("MPC")
                continue
            components = _DISPLACEMENTS if kind == "PIN" else _ALL
            for first, second in zip(*sets, strict=True):
                if kind == "LINK":
                    self.parts.links.add("*MPC", Distance(line, (first, second)))
                    continue
                for component in components:
                    terms = [((first, component), 1.0), ((second, component), -1.0)]
                    self.parts.links.add("*MPC", Equation(line, terms))
        return left_out

    def _tie(self, block: Block) -> list[str]:
        """Read pairs of surfaces of which the first follows the second."""
        if any(parameter in block.parameters for parameter in _CYCLIC):
            return ["TIE of cyclic symmetry"]
        if not block.data:
            return ["TIE"]
        left_out = []
        for line in block.data:
            names = [_upper(text) for text in line.text.split(",") if text.strip()]
            surfaces = [self._surface(name) for name in names[:2]]
            if len(surfaces) < 2 or surfaces[0] is None or surfaces[1] is None:
                left_out.append("TIE")
                continue
            text = block.parameters.get("POSITION TOLERANCE")
            reach = None
            if text:
                reach = parse_real(text, block.line, "a position tolerance")
            if reach is not None and not 0.0 <= reach < float("inf"):
                raise block.line.wrong(
                    f"the position tolerance is {reach:g}; it must be 0 or greater, and finite"
                )
            self.parts.ties.append(Tie(line, (names[0], names[1]), surfaces[0], surfaces[1], reach))
        return left_out

    def _rigid_body(self, block: Block) -> list[str]:
        """Read a rigid body: nodes, and those of elements, that follow a reference node."""
        reference = self._reference(block)
        nodes: set[int] = set()
        for key in ("NSET", "TIE NSET", "PIN NSET"):
            nodes.update(self._nodes(block.parameters.get(key, ""), block.line))
        name = block.parameters.get("ELSET")
        elements = self.known("ELSET", name) if name else None
        if elements:
            nodes |= self.parts.nodes_of_elements(elements)
        return self._add_rigid("*RIGID BODY", block.line, reference, sorted(nodes), _DISPLACEMENTS)

    def _kinematic_coupling(self, block: Block) -> list[str]:
        """Read sets of nodes, of which some components follow a reference node."""
        reference = self._reference(block)
        left_out = []
        for line in block.data:
            texts = [text.strip() for text in line.text.split(",")]
            components = _components([texts[1:]], line)
            if not components or _depends_on_axes(block, components):
                left_out.append("KINEMATIC COUPLING")
            else:
                nodes = self._nodes(texts[0], line)
                left_out += self._add_rigid(
                    "*KINEMATIC COUPLING", line, reference, nodes, components
                )
        return left_out

    def _coupling(self, block: Block, coupling: Block | None) -> list[str]:
        """Read *KINEMATIC or *DISTRIBUTING, which belongs to the *COUPLING before it."""
        if coupling is None:
            return [block.keyword]
        surface = self._surface(_upper(coupling.parameters.get("SURFACE", "")))
        if surface is None or "CYCLIC SYMMETRY" in block.parameters:
            return [block.keyword]
        reference = self._reference(coupling)
        nodes = sorted(self.parts.nodes_of_surface(surface))
        lines = [[text.strip() for text in line.text.split(",")] for line in block.data]
        components = _components(lines, block.line)
        if block.keyword == "DISTRIBUTING":  # only rotations can be released
            components = tuple(sorted({*components, *_DISPLACEMENTS}))
        if reference is None or not nodes or not components:
            return [block.keyword]
        if _depends_on_axes(coupling, components):
            return [block.keyword]
        if block.keyword == "KINEMATIC":
            return self._add_rigid("*KINEMATIC", block.line, reference, nodes, components)
        if block.parameters.get("WEIGHTING METHOD", "UNIFORM").upper() != "UNIFORM":
            return [block.keyword]
        members = [(node, 1.0, _DISPLACEMENTS) for node in nodes]
        self.parts.links.add("*DISTRIBUTING", Mean(block.line, reference, components, members))
        return []

    def _add_rigid(
        self,
        name: str,
        line: TextLine,
        reference: int | None,
        nodes: Sequence[int],
        components: Sequence[int],
    ) -> list[str]:
        """Add the motion of nodes with a reference node; return the name if it can't be used."""
        if reference is None or not nodes:
            return [name[1:]]
        is_partial = not set(_DISPLACEMENTS) <= set(components)
        if is_partial and any(self._is_turned(node) for node in nodes):
            return [name[1:]]
        followers = [(node, components) for node in nodes if node != reference]
        self.parts.links.add(name, Rigid(line, [(reference, _ALL), *followers]))
        return []

    def _reference(self, block: Block) -> int | None:
        """Return the reference node, a number or a set of one node; None if it can't be found."""
        text = block.parameters.get("REF NODE", "") or block.parameters.get("REFNODE", "")
        nodes = self._nodes(text, block.line)
        return nodes[0] if len(nodes) == 1 else None

    def _nodes(self, text: str, line: TextLine) -> list[int]:
        """Return the nodes of a set, or the one of a number; none if there is no such set."""
        text = text.strip().strip('"')
        if text.isdigit():
            return [parse_integer(text, line, "the number of a node")]
        selection = self.known("NSET", text) if text else None
        if selection is None:
            return []
        return self.parts.node_numbers(selection)

    def _in_order(self, text: str, line: TextLine) -> list[int]:
        """Return the nodes of a set in the order in which they are paired with others.

        None are returned if that order is not kept.
        """
        selection = self.known("NSET", text.strip().strip('"'))
        nodes = self._nodes(text, line)
        if selection is not None and selection.unsorted and len(nodes) > 1:
            return []
        return nodes

    def _is_turned(self, node: int) -> bool:
        """Whether the components of motion of a node are along axes of its own."""
        return node in self.turned.numbers or any(
            first <= node <= last and (node - first) % step == 0
            for first, last, step in self.turned.ranges
        )

    def _surface(self, name: str) -> MeshSurface | None:
        """Return a surface of faces or nodes; None if it can't be used."""
        block = self.surfaces.get(name) or self.surfaces.get(name.rpartition(".")[2])
        if block is None or "COMBINE" in block.parameters or "CROP" in block.parameters:
            return None
        surface = MeshSurface()
        for line in block.data:
            texts = [text.strip() for text in line.text.split(",")]
            if block.parameters.get("TYPE", "ELEMENT").upper() == "NODE":
                nodes = self._nodes(texts[0], line)
                if not nodes:
                    return None
                surface.nodes.numbers.update(nodes)
                continue
            label = texts[1].upper() if len(texts) > 1 else ""
            elements = self._elements(texts[0], line)
            if elements is None or (label and label not in _FACES):
                return None
            face = _FACES[label] if label else {}
            surface.faces.append((elements, face))
        return surface

    def _elements(self, text: str, line: TextLine) -> Selection | None:
        """Return the elements of a set, or the one of a number; None if there is no such set."""
        if text.isdigit():
            return Selection({parse_integer(text, line, "the number of an element")})
        return self.known("ELSET", text.strip('"'))


def _components(lines: Sequence[Sequence[str]], line: TextLine) -> tuple[int, ...]:
    """Return the components of lines "first, last", from 0; all of them without such a line."""
    components: set[int] = set()
    is_stated = False
    for texts in lines:
        numbers = [parse_integer(text, line, "a component of motion") for text in texts[:2] if text]
        if numbers:
            is_stated = True
            first = numbers[0]
            last = numbers[-1]
            components.update(component for component in _ALL if first <= component + 1 <= last)
    return tuple(sorted(components)) if is_stated else _ALL


def _depends_on_axes(block: Block, components: Sequence[int]) -> bool:
    """Whether components are some displacements along axes that the block turns."""
    return "ORIENTATION" in block.parameters and not set(_DISPLACEMENTS) <= set(components)


def _upper(name: str) -> str:
    """Return a name without quotes, in capitals."""
    return name.strip().strip('"').upper()
