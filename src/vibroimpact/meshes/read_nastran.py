"""Reading of Nastran bulk data."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.meshes.edge_nodes import OMITTED
from vibroimpact.meshes.left_out import remarks_of
from vibroimpact.meshes.nastran_cards import Card, cards, nastran_include
from vibroimpact.meshes.nastran_coordinates import NastranGrids
from vibroimpact.meshes.nastran_links import NastranLinks
from vibroimpact.meshes.nastran_materials import NastranMaterials
from vibroimpact.meshes.node_order import NASTRAN
from vibroimpact.meshes.parsed_mesh import Parts
from vibroimpact.meshes.selection import Selection
from vibroimpact.meshes.text_files import TextLine, parse_integer, read_lines_with_includes
from vibroimpact.quoting import quoted
from vibroimpact.structures.finite_elements.mesh import Mesh

_KINDS = {
    "CTETRA": {4: "tet4", 10: "tet10"},
    "CPYRAM": {5: "pyramid5", 13: "pyramid13"},
    "CPYRA": {5: "pyramid5", 13: "pyramid13"},
    "CPENTA": {6: "wedge6", 15: "wedge15"},
    "CHEXA": {8: "hex8", 20: "hex20"},
}
_OTHER_SOLIDS = ("CTETRA", "CHEX", "CPENT", "CPYR", "CWEDGE")
_BEGIN = re.compile(r"\s*BEGIN[\s,]+(\w*)", re.IGNORECASE)
_SET = re.compile(r"\s*SET\s+(\d{1,18})\s*=(.*)", re.IGNORECASE)
_SET_NAME = re.compile(r"\$ node set (\d{1,18}): (\S.*)")


def read_nastran(path: str | PathLike[str]) -> Mesh:
    """Read the solid elements of a Nastran file.

    The file is bulk data, with or without executive and case control.

    The mesh consists of CTETRA, CPYRAM, CPENTA, CHEXA and GRID cards, also in coordinate systems of
    CORD1 and CORD2 cards. The elements of property n form the set `PIDn`, the nodes of SPC1 cards
    the set `SPCn`, and those of `SET n` in case control the set `SETn`, or the name in a comment "$
    node set n: name". The materials of PSOLID cards are in `Mesh.stated`, as `MIDn`; elements of a
    fluid are left out. Rigid elements and multipoint constraints are in `Mesh.joints`. Nodes in the
    middle of edges that are left blank are those of neighbours, or new ones halfway. Other cards
    are counted in `Mesh.skipped`.

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
    >>> bulk = "GRID,1\\nGRID,2,,1.\\nGRID,3,,,1.\\nGRID,4,,,,1.\\nCTETRA,1,7,1,2,3,4\\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "tet.bdf")
    ...     _ = file.write_text(bulk)
    ...     mesh = read_nastran(file)
    >>> mesh.blocks[0].kind, list(mesh.element_sets)
    ('tet4', ['PID7'])
    """
    path = Path(path)
    parts = Parts(path, NASTRAN)
    links = NastranLinks()
    lines = list(read_lines_with_includes(path, nastran_include))
    begin = next((index for index, line in enumerate(lines) if _BEGIN.match(line.text)), None)
    if begin is not None:
        _check_begin(lines[begin])
        _read_sets(lines[:begin], parts)
        links.control(lines[:begin])
        lines = lines[begin + 1 :]
    grids = NastranGrids()
    materials = NastranMaterials()
    supports = Counter[str]()
    has_ended = False
    for card in cards(lines):
        has_ended = card.name == "ENDDATA"
        if not has_ended and not materials.take(card) and not links.take(card):
            _read_card(card, parts, grids, supports)
    if begin is not None and not has_ended:
        raise InputError(
            f"{path}: there is a BEGIN BULK but no ENDDATA; the file is cut short, or that "
            "line was left out"
        )
    grids.add_to(parts)
    links.add_to(parts, grids.turned)
    parts.sections = materials.sections(parts.element_sets)
    mesh = parts.mesh()
    return replace(mesh, remarks=(*mesh.remarks, *remarks_of({**mesh.skipped, **supports})))


def _check_begin(line: TextLine) -> None:
    """Raise InputError if a line begins another section than that of bulk data."""
    section = _BEGIN.match(line.text)
    if section and section[1].upper() not in ("", "BULK"):
        raise line.wrong(f'"BEGIN {section[1]}" is not read; the mesh must stand after BEGIN BULK')


def _read_card(card: Card, parts: Parts, grids: NastranGrids, supports: Counter[str]) -> None:
    """Read a card.

    `supports` counts the cards that hold nodes, of which the mesh has sets or nothing.
    """
    line, name, fields = card
    if name == "GRID" and any(fields[6:7]):
        supports["PS of GRID"] += 1
    if grids.take(card):
        return
    if name in _KINDS:
        _read_solid(card, parts)
    elif name.startswith(_OTHER_SOLIDS):
        raise line.wrong(
            f"{quoted(name)} is a solid element that is not read; the elements must be "
            "CTETRA, CPYRAM, CPENTA or CHEXA"
        )
    elif name.startswith("INCLUDE"):
        raise line.wrong(
            "the file to include is not given; its name must be on the line of INCLUDE, in "
            "quotes if it has blanks"
        )
    elif name == "SPC1":
        chosen = _selection([field for field in fields[2:] if field])
        if chosen is None:
            raise line.wrong(
                "the nodes of SPC1 can't be read; they must be numbers, or "
                "a number, THRU and a number"
            )
        number = parse_integer(fields[0], line, "the number of a set")
        parts.node_sets[f"SPC{number}"].update(chosen)
        supports["SPC1"] += 1
    else:
        parts.skipped[name] += 1


def _read_solid(card: Card, parts: Parts) -> None:
    """Read a solid element, of which nodes in the middle of edges may be blank."""
    line, name, fields = card
    number = parse_integer(fields[0], line, "the number of an element")
    nodes = []  # zero where one is left out
    for field in fields[2:]:
        node = 0
        if field:
            node = parse_integer(field, line, "the number of a node")
        nodes.append(node)
    while nodes and nodes[-1] == 0:
        nodes.pop()
    kinds = _KINDS[name]
    corners, with_edges = kinds  # numbers of nodes of first and second order
    if not corners <= len(nodes) <= with_edges or 0 in nodes[:corners]:
        stated = len(nodes) - nodes.count(0)
        raise line.wrong(
            f"{name} {number} has {stated} nodes; it must have {corners} or {with_edges}, and "
            "only nodes on edges may be left blank"
        )
    count = corners if len(nodes) == corners else with_edges
    nodes += [0] * (count - len(nodes))
    parts.add_element(line, kinds[count], number, [node or OMITTED for node in nodes])
    pid = number
    if fields[1]:
        pid = parse_integer(fields[1], line, "the number of a property")
    parts.element_sets[f"PID{pid}"].numbers.add(number)


def _read_sets(lines: Iterable[TextLine], parts: Parts) -> None:
    """Read the sets of case control.

    Sets that are not lists of numbers and ranges are counted as skipped.
    """
    names: dict[str, str] = {}
    texts_of_sets: dict[str, list[str]] = {}
    open_set = ""  # whose list goes on
    for line in lines:
        comment = _SET_NAME.match(line.text)
        if comment:
            names[comment[1]] = comment[2].strip()
        text = line.text.split("$", 1)[0].strip()
        statement = _SET.match(text)
        if statement:
            open_set = statement[1]
            texts_of_sets[open_set] = [statement[2]]
        elif open_set and text:
            texts_of_sets[open_set].append(text)
        if text and not text.endswith(","):
            open_set = ""
    for number, texts in texts_of_sets.items():
        chosen = _selection(" ".join(texts).replace(",", " ").split())
        if chosen is None:
            parts.skipped["SET"] += 1
        else:
            parts.node_sets[names.get(number, f"SET{number}")].update(chosen)


def _whole_number(entry: str) -> int:
    """Return the number of an entry; -1 if it is none, or too large for 64 bits."""
    if entry.isascii() and entry.isdigit() and len(entry) <= 18:
        return int(entry)
    return -1


def _selection(entries: Sequence[str]) -> Selection | None:
    """Return the selection of a list such as "1 5 THRU 10"; None if it has other entries."""
    selection = Selection()
    entries = [entry.upper() for entry in entries]
    numbers = [_whole_number(entry) for entry in entries]
    index = 0
    while index < len(entries):
        number = numbers[index]
        if number < 0:
            return None
        if entries[index + 1 : index + 2] == ["THRU"]:
            if index + 2 >= len(entries) or numbers[index + 2] < number:
                return None
            selection.ranges.add((number, numbers[index + 2], 1))
            index += 3
        else:
            selection.numbers.add(number)
            index += 1
    return selection
