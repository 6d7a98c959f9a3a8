"""Assemblies of several instances in an Abaqus input file, written out as one flat mesh."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.meshes.abaqus_blocks import Block
from vibroimpact.meshes.text_files import TextLine, parse_integer, parse_real
from vibroimpact.quoting import quoted

SPAN = 1_000_000_000_000
"""Numbers of nodes and elements that each instance has for itself."""

_MOST_INSTANCES = 100_000
_SET_NAMES = ("NSET", "ELSET", "TIE NSET", "PIN NSET", "SURFACE", "REF NODE")
_NUMBERED = {"ELEMENT", "NSET", "ELSET", "SURFACE", "MPC", "EQUATION", "KINEMATIC COUPLING"}
_LINKS = {"COUPLING", "EQUATION", "KINEMATIC COUPLING", "MPC", "RIGID BODY"}
_TERMS = 3  # entries of a term of an equation

Renamed = Callable[[str, TextLine], str]
"""From the number or name of a node, element or set to that in the flat mesh."""


@dataclass(frozen=True)
class _Instance:
    """A part that is placed: its name, the first of its numbers, and the motion that places it."""

    name: str
    offset: int
    turn: Floats
    shift: Floats

    def renamed(self, text: str, line: TextLine) -> str:
        return self.number(text, line) if text.isdigit() else f"{self.name}.{text}"

    def number(self, text: str, line: TextLine) -> str:
        """Return the number in the flat mesh."""
        number = parse_integer(text, line, "the number of a node or element")
        if number >= SPAN:
            raise line.wrong(
                f"the number {number} is too large for a part of an assembly; "
                f"it must be below {SPAN:,}"
            )
        return str(self.offset + number)


def is_assembly(found: Sequence[Block]) -> bool:
    """Whether blocks are those of an assembly of several parts or instances, of one that
    is moved, or with links of its own nodes.
    """
    instances = [block for block in found if block.keyword == "INSTANCE"]
    moves = (
        parse_real(text, line)
        for block in instances
        for line in block.data
        for text in line.text.split(",")
        if text.strip()
    )
    return (
        len(instances) > 1
        or sum(block.keyword == "PART" for block in found) > 1
        or _has_links(found)
        or any(moves)
    )


def _has_links(found: Sequence[Block]) -> bool:
    """Whether an assembly links nodes: outside of instances, it has numbers of its own."""
    outside = False
    for block in found:
        if block.keyword in ("ASSEMBLY", "END INSTANCE"):
            outside = True
        elif block.keyword in ("INSTANCE", "END ASSEMBLY"):
            outside = False
        elif outside and block.keyword in _LINKS:
            return True
    return False


def flattened(found: Iterable[Block]) -> Iterator[Block]:
    """Yield the blocks of an assembly as those of one mesh in which every instance has its own
    numbers.

    Sets and surfaces of an instance get its name and a point before theirs, and all its elements
    are the set of its name.

    Parameters
    ----------
    found : iterable of Block
        The blocks of the file.

    Raises
    ------
    InputError
        If a part or instance is unknown or given twice, has no end, or a number can't be read.
    """
    parts: dict[str, list[Block]] = {}
    instances: dict[str, _Instance] = {}
    # the assembly itself: its nodes are reference points
    own = _Instance("", 0, np.eye(3), np.zeros(3))
    part: list[Block] | None = None
    placed: _Instance | None = None
    opened: dict[str, TextLine] = {}
    last_part: TextLine | None = None
    for block in found:
        keyword = block.keyword
        if keyword in ("PART", "ASSEMBLY", "INSTANCE"):
            if keyword in opened:
                raise opened[keyword].wrong(f"*{keyword} has no *END {keyword} before the next one")
            opened[keyword] = block.line
        elif keyword in ("END PART", "END ASSEMBLY", "END INSTANCE"):
            opened.pop(keyword.removeprefix("END "), None)
        if keyword == "PART":
            last_part = block.line
            if _key(block, "NAME") in parts:
                raise block.line.wrong(
                    f"a part of the name {quoted(block.parameters.get('NAME', ''))} was "
                    "given before; each needs its own"
                )
            part = parts[_key(block, "NAME")] = []
        elif keyword == "END PART":
            part = None
        elif part is not None:
            part.append(block)
        elif keyword == "INSTANCE":
            placed = _placed(block, instances)
            yield from (_moved(one, placed) for one in _blocks_of(block, parts))
            yield _all_elements(block.line, placed)
        elif keyword == "END INSTANCE":
            placed = None
        elif placed is not None:
            yield _moved(block, placed)
        elif keyword not in ("ASSEMBLY", "END ASSEMBLY"):
            yield _of_assembly(block, instances, own) if "ASSEMBLY" in opened else block
    if opened:
        keyword, line = opened.popitem()
        raise line.wrong(
            f"*{keyword} has no *END {keyword}; the file is cut short, or that line was left out"
        )
    if last_part is not None and not instances:
        raise last_part.wrong(
            "the parts of the file are in no assembly; each must be placed by an *INSTANCE"
        )


def _key(block: Block, parameter: str) -> str:
    return block.parameters.get(parameter, "").upper()


def _blocks_of(block: Block, parts: dict[str, list[Block]]) -> list[Block]:
    """Return the blocks of the part of an instance."""
    name = _key(block, "PART")
    if name not in parts:
        raise block.line.wrong(
            f"the instance is of the part {quoted(block.parameters.get('PART', ''))}, which "
            "is not in the file before it"
        )
    return parts[name]


def _placed(block: Block, instances: dict[str, _Instance]) -> _Instance:
    """Return an instance: shifted by its first line, then turned about the axis between
    two points by the angle of its second line.
    """
    name = block.parameters.get("NAME", "")
    if not name or name.upper() in instances:
        raise block.line.wrong(
            f"the instance has no name of its own, but {quoted(name)}; every instance must have one"
        )
    if len(instances) >= _MOST_INSTANCES:
        raise block.line.wrong(
            f"the assembly has more than {_MOST_INSTANCES:,} instances; leave out those "
            "that are not needed"
        )
    shift, turn = np.zeros(3), np.eye(3)
    numbers = [
        [
            parse_real(text, line) if text.strip() else 0.0
            for text in line.text.rstrip(" ,").split(",")
        ]
        for line in block.data
    ]
    for line, values in zip(block.data, numbers, strict=True):
        if not all(math.isfinite(value) for value in values):
            raise line.wrong("the place of the instance is not finite; it must be")
    if numbers:
        shift[: min(3, len(numbers[0]))] = numbers[0][:3]
    if len(numbers) > 1:
        if len(numbers[1]) != 7:
            raise block.data[1].wrong(
                f"the turn of the instance has {len(numbers[1])} numbers; it must have two "
                "points and an angle, 7 in all"
            )
        first, second, angle = (
            np.array(numbers[1][:3]),
            np.array(numbers[1][3:6]),
            math.radians(numbers[1][6]),
        )
        size = float(np.linalg.norm(second - first))
        if not size > 0.0:
            raise block.data[1].wrong(
                "the two points of the axis of the turn are the same; they must lie apart"
            )
        x, y, z = (second - first) / size
        across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        turn = np.eye(3) + math.sin(angle) * across + (1.0 - math.cos(angle)) * across @ across
        shift = turn @ (shift - first) + first
    instances[name.upper()] = found = _Instance(name, SPAN * (len(instances) + 1), turn, shift)
    return found


def _moved(block: Block, instance: _Instance) -> Block:
    """Return a block of a part as that of an instance of it."""
    at_nodes = block.keyword == "NODE"
    lines = (
        [_moved_node(line, instance) for line in block.data]
        if at_nodes
        else _renamed_lines(block, instance.renamed)
    )
    return Block(
        block.line,
        block.keyword,
        _renamed_parameters(block, lambda name: instance.renamed(name, block.line)),
        lines,
    )


def _moved_node(line: TextLine, instance: _Instance) -> TextLine:
    texts = line.text.split(",")
    at = np.array(
        [parse_real(text, line) if text.strip() else 0.0 for text in [*texts[1:4], "", "", ""][:3]]
    )
    # what is not finite is refused where the node is read
    with np.errstate(invalid="ignore", over="ignore"):
        x, y, z = (instance.turn @ at + instance.shift).tolist()
    return line._replace(text=f"{instance.number(texts[0].strip(), line)}, {x!r}, {y!r}, {z!r}")


def _of_assembly(block: Block, instances: dict[str, _Instance], own: _Instance) -> Block:
    """Return a block of the assembly, in which members of instances have the name of
    theirs before them, or in a parameter.
    """
    of = block.parameters.get("INSTANCE")
    if of is not None and of.upper() not in instances:
        raise block.line.wrong(
            f"there is no instance {quoted(of)} before this line; it must be one of the assembly"
        )
    home = own if of is None else instances[of.upper()]

    def renamed(text: str, line: TextLine) -> str:
        instance, _, rest = text.partition(".")
        if rest and instance.upper() in instances:
            return instances[instance.upper()].renamed(rest, line)
        return text if home is own and not text.isdigit() else home.renamed(text, line)

    parameters = {key: value for key, value in block.parameters.items() if key != "INSTANCE"}
    if "REF NODE" in parameters:
        parameters["REF NODE"] = renamed(parameters["REF NODE"], block.line)
    return Block(block.line, block.keyword, parameters, _renamed_lines(block, renamed))


def _renamed_parameters(block: Block, renamed: Callable[[str], str]) -> dict[str, str]:
    keys = (*_SET_NAMES, "NAME") if block.keyword == "SURFACE" else _SET_NAMES
    return {
        key: renamed(value) if key in keys and value else value
        for key, value in block.parameters.items()
    }


def _renamed_lines(block: Block, renamed: Renamed) -> list[TextLine]:
    """Return the data of a block with other numbers and names of nodes, elements and sets."""
    if block.keyword not in _NUMBERED:
        return (
            [_renamed_line(line, renamed, 0, None) for line in block.data]
            if block.keyword == "TIE"
            else block.data
        )
    if block.keyword == "EQUATION":
        return [
            line if "," not in line.text.rstrip(" ,") else _renamed_line(line, renamed, 0, _TERMS)
            for line in block.data
        ]
    if block.keyword in ("SURFACE", "KINEMATIC COUPLING"):
        return [_renamed_line(line, renamed, 0, len(line.text)) for line in block.data]
    if "GENERATE" in block.parameters:
        return [line._replace(text=",".join(_generated(line, renamed))) for line in block.data]
    return [
        _renamed_line(line, renamed, 1 if block.keyword == "MPC" else 0, None)
        for line in block.data
    ]


def _renamed_line(line: TextLine, renamed: Renamed, first: int, step: int | None) -> TextLine:
    """Return a line with every entry from `first` on renamed, or every one at a distance
    of `step`.
    """
    texts = [text.strip() for text in line.text.split(",")]
    chosen = set(range(first, len(texts), step or 1))
    return line._replace(
        text=", ".join(
            renamed(text.strip('"'), line) if text and at in chosen else text
            for at, text in enumerate(texts)
        )
    )


def _generated(line: TextLine, renamed: Renamed) -> Iterator[str]:
    """Yield the entries of a range: first, last, step; a last one beyond the numbers of
    an instance is its last.
    """
    for at, text in enumerate(part.strip() for part in line.text.split(",")):
        if at == 1 and text.isdigit() and len(text) <= 18:
            text = str(min(int(text), SPAN - 1))
        yield renamed(text, line) if at < 2 and text.isdigit() else text


def _all_elements(line: TextLine, instance: _Instance) -> Block:
    """Return the set of all elements of an instance."""
    text = f"{instance.offset}, {instance.offset + SPAN - 1}, 1"
    return Block(
        line, "ELSET", {"ELSET": instance.name, "GENERATE": ""}, [line._replace(text=text)]
    )
