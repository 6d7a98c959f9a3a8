"""Assemblies of several instances in an Abaqus input file, written out as one flat mesh."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.meshes.abaqus_blocks import Block, real_or_zero
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
    rotation: Floats
    shift: Floats

    def renamed(self, text: str, line: TextLine) -> str:
        """Return the number or name in the flat mesh."""
        if text.isdigit():
            return self.number(text, line)
        return f"{self.name}.{text}"

    def number(self, text: str, line: TextLine) -> str:
        """Return the number in the flat mesh."""
        number = parse_integer(text, line, "the number of a node or element")
        if number >= SPAN:
            raise line.wrong(
                f"the number {number} is too large for a part of an assembly; "
                f"it must be below {SPAN:,}"
            )
        return str(self.offset + number)


def is_assembly(file_blocks: Sequence[Block]) -> bool:
    """Whether blocks are those of an assembly that must be written out.

    It has several parts or instances, one that is moved, or links of its own nodes.
    """
    instances = [block for block in file_blocks if block.keyword == "INSTANCE"]
    coordinates = (
        parse_real(text, line)
        for block in instances
        for line in block.data
        for text in line.text.split(",")
        if text.strip()
    )
    return (
        len(instances) > 1
        or sum(block.keyword == "PART" for block in file_blocks) > 1
        or _has_links(file_blocks)
        or any(coordinates)
    )


def _has_links(file_blocks: Sequence[Block]) -> bool:
    """Whether an assembly links nodes: outside of instances, it has numbers of its own."""
    is_outside = False
    for block in file_blocks:
        if block.keyword in ("ASSEMBLY", "END INSTANCE"):
            is_outside = True
        elif block.keyword in ("INSTANCE", "END ASSEMBLY"):
            is_outside = False
        elif is_outside and block.keyword in _LINKS:
            return True
    return False


def flattened(file_blocks: Iterable[Block]) -> Iterator[Block]:
    """Yield the blocks of an assembly as those of one mesh.

    Every instance has its own numbers. Sets and surfaces of an instance get its name and a point
    before theirs, and all its elements are the set of its name.

    Parameters
    ----------
    file_blocks : iterable of Block
        The blocks of the file.

    Raises
    ------
    InputError
        If a part or instance is unknown or given twice, has no end, or a number can't be read.
    """
    parts: dict[str, list[Block]] = {}
    instances: dict[str, _Instance] = {}
    # the assembly itself: its nodes are reference points
    assembly = _Instance("", 0, np.eye(3), np.zeros(3))
    part: list[Block] | None = None  # that is being read
    instance: _Instance | None = None
    opened: dict[str, TextLine] = {}
    last_part: TextLine | None = None
    for block in file_blocks:
        keyword = block.keyword
        _follow_nesting(block, opened)
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
            instance = _new_instance(block, instances)
            for block_of_part in _blocks_of_part(block, parts):
                yield _moved(block_of_part, instance)
            yield _all_elements(block.line, instance)
        elif keyword == "END INSTANCE":
            instance = None
        elif instance is not None:
            yield _moved(block, instance)
        elif keyword in ("ASSEMBLY", "END ASSEMBLY"):
            pass
        elif "ASSEMBLY" in opened:
            yield _of_assembly(block, instances, assembly)
        else:
            yield block
    if opened:
        keyword, line = opened.popitem()
        raise line.wrong(
            f"*{keyword} has no *END {keyword}; the file is cut short, or that line was left out"
        )
    if last_part is not None and not instances:
        raise last_part.wrong(
            "the parts of the file are in no assembly; each must be placed by an *INSTANCE"
        )


def _follow_nesting(block: Block, opened: dict[str, TextLine]) -> None:
    """Note that a part, an assembly or an instance begins or ends.

    Raises
    ------
    InputError
        If one begins before the one before it has ended.
    """
    keyword = block.keyword
    if keyword in ("PART", "ASSEMBLY", "INSTANCE"):
        if keyword in opened:
            raise opened[keyword].wrong(f"*{keyword} has no *END {keyword} before the next one")
        opened[keyword] = block.line
    elif keyword in ("END PART", "END ASSEMBLY", "END INSTANCE"):
        opened.pop(keyword.removeprefix("END "), None)


def _key(block: Block, parameter: str) -> str:
    return block.parameters.get(parameter, "").upper()


def _blocks_of_part(block: Block, parts: dict[str, list[Block]]) -> list[Block]:
    """Return the blocks of the part of an instance."""
    name = _key(block, "PART")
    if name not in parts:
        raise block.line.wrong(
            f"the instance is of the part {quoted(block.parameters.get('PART', ''))}, which "
            "is not in the file before it"
        )
    return parts[name]


def _new_instance(block: Block, instances: dict[str, _Instance]) -> _Instance:
    """Return an instance, and keep it with the others.

    Raises
    ------
    InputError
        If it has no name of its own, there are too many, or its motion can't be read.
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
    rotation, shift = _motion(block)
    instance = _Instance(name, SPAN * (len(instances) + 1), rotation, shift)
    instances[name.upper()] = instance
    return instance


def _motion(block: Block) -> tuple[Floats, Floats]:
    """Return the rotation matrix and the shift of an instance.

    Its first line is a shift; its second one two points of an axis, and the angle [degrees] about
    it by which the shifted part is turned.
    """
    numbers = [_numbers(line) for line in block.data]
    for line, numbers_of_line in zip(block.data, numbers, strict=True):
        if not all(math.isfinite(number) for number in numbers_of_line):
            raise line.wrong("the place of the instance is not finite; it must be")
    shift = np.zeros(3)
    if numbers:
        shift[: min(3, len(numbers[0]))] = numbers[0][:3]
    if len(numbers) < 2:
        return np.eye(3), shift
    if len(numbers[1]) != 7:
        raise block.data[1].wrong(
            f"the turn of the instance has {len(numbers[1])} numbers; it must have two "
            "points and an angle, 7 in all"
        )
    first = np.array(numbers[1][:3])
    second = np.array(numbers[1][3:6])
    angle = math.radians(numbers[1][6])
    length = float(np.linalg.norm(second - first))
    if not length > 0.0:
        raise block.data[1].wrong(
            "the two points of the axis of the turn are the same; they must lie apart"
        )
    # Rodrigues' formula, with the matrix of the cross product by the unit vector of the axis
    x, y, z = (second - first) / length
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    # shifted first, then turned about the axis through the first point
    return rotation, rotation @ (shift - first) + first


def _numbers(line: TextLine) -> list[float]:
    """Return the numbers of a data line; zero where an entry is blank."""
    texts = line.text.rstrip(" ,").split(",")
    return [real_or_zero(text, line) for text in texts]


def _moved(block: Block, instance: _Instance) -> Block:
    """Return a block of a part as that of an instance of it."""
    if block.keyword == "NODE":
        lines = [_moved_node(line, instance) for line in block.data]
    else:
        lines = _renamed_lines(block, instance.renamed)
    parameters = _renamed_parameters(block, lambda name: instance.renamed(name, block.line))
    return Block(block.line, block.keyword, parameters, lines)


def _moved_node(line: TextLine, instance: _Instance) -> TextLine:
    """Return the line of a node of a part as that of an instance of it."""
    texts = line.text.split(",")
    coordinates = [*texts[1:4], "", "", ""][:3]
    position = np.array([real_or_zero(text, line) for text in coordinates])
    # what is not finite is refused where the node is read
    with np.errstate(invalid="ignore", over="ignore"):
        x, y, z = (instance.rotation @ position + instance.shift).tolist()
    return line._replace(text=f"{instance.number(texts[0].strip(), line)}, {x!r}, {y!r}, {z!r}")


def _of_assembly(block: Block, instances: dict[str, _Instance], assembly: _Instance) -> Block:
    """Return a block of the assembly as that of the flat mesh.

    Members of instances have the name of theirs before them, or in a parameter.
    """
    name = block.parameters.get("INSTANCE")
    if name is not None and name.upper() not in instances:
        raise block.line.wrong(
            f"there is no instance {quoted(name)} before this line; it must be one of the assembly"
        )
    stated = assembly
    if name is not None:
        stated = instances[name.upper()]

    def renamed(text: str, line: TextLine) -> str:
        first, _, rest = text.partition(".")
        if rest and first.upper() in instances:
            return instances[first.upper()].renamed(rest, line)
        if stated is assembly and not text.isdigit():
            return text
        return stated.renamed(text, line)

    parameters = {key: value for key, value in block.parameters.items() if key != "INSTANCE"}
    if "REF NODE" in parameters:
        parameters["REF NODE"] = renamed(parameters["REF NODE"], block.line)
    return Block(block.line, block.keyword, parameters, _renamed_lines(block, renamed))


def _renamed_parameters(block: Block, renamed: Callable[[str], str]) -> dict[str, str]:
    """Return the parameters of a block with other names of sets."""
    keys = {*_SET_NAMES}
    if block.keyword == "SURFACE":
        keys.add("NAME")
    parameters = dict(block.parameters)
    for key, value in block.parameters.items():
        if key in keys and value:
            parameters[key] = renamed(value)
    return parameters


def _renamed_lines(block: Block, renamed: Renamed) -> list[TextLine]:
    """Return the data of a block with other numbers and names of nodes, elements and sets."""
    keyword = block.keyword
    if keyword == "TIE":
        return [_renamed_line(line, renamed, 0, 1) for line in block.data]
    if keyword not in _NUMBERED:
        return block.data
    if keyword == "EQUATION":
        lines = []
        for line in block.data:
            # a line of one entry is the number of terms; the first entry of a term is a node
            has_terms = "," in line.text.rstrip(" ,")
            lines.append(_renamed_line(line, renamed, 0, _TERMS) if has_terms else line)
        return lines
    if keyword in ("SURFACE", "KINEMATIC COUPLING"):  # the first entry alone
        return [_renamed_line(line, renamed, 0, len(line.text)) for line in block.data]
    if "GENERATE" in block.parameters:
        return [line._replace(text=",".join(_generated(line, renamed))) for line in block.data]
    first = 1 if keyword == "MPC" else 0  # after the kind of the constraint
    return [_renamed_line(line, renamed, first, 1) for line in block.data]


def _renamed_line(line: TextLine, renamed: Renamed, first: int, step: int) -> TextLine:
    """Return a line with every entry from `first` on renamed, or every one in `step`."""
    texts = [text.strip() for text in line.text.split(",")]
    for index in range(first, len(texts), step or 1):
        if texts[index]:
            texts[index] = renamed(texts[index].strip('"'), line)
    return line._replace(text=", ".join(texts))


def _generated(line: TextLine, renamed: Renamed) -> Iterator[str]:
    """Yield the entries of a range: first, last, step.

    A last one beyond the numbers of an instance is its last.
    """
    for index, text in enumerate(part.strip() for part in line.text.split(",")):
        if index == 1 and text.isdigit() and len(text) <= 18:
            text = str(min(int(text), SPAN - 1))
        if index < 2 and text.isdigit():
            text = renamed(text, line)
        yield text


def _all_elements(line: TextLine, instance: _Instance) -> Block:
    """Return the set of all elements of an instance."""
    text = f"{instance.offset}, {instance.offset + SPAN - 1}, 1"
    return Block(
        line, "ELSET", {"ELSET": instance.name, "GENERATE": ""}, [line._replace(text=text)]
    )
