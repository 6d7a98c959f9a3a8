"""Keyword blocks of an Abaqus input file: keyword line, parameters and data lines."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from vibroimpact.meshes.text_files import TextLine, parse_real

_PARAMETER = re.compile(r'(?:"[^"]*"|[^,])+')
_INCLUDED = re.compile(
    r"\*\s*(?:INCLUDE|NODE|ELEMENT|NSET|ELSET)\s*,.*?\bINPUT\s*=\s*(?:\"([^\"]+)\"|([^,\"]+))",
    re.IGNORECASE,
)


@dataclass
class Block:
    """A keyword in capitals, without its asterisk, with its parameters and data lines.

    The parameters are by name in capitals.
    """

    line: TextLine
    keyword: str
    parameters: dict[str, str]
    data: list[TextLine] = field(default_factory=list)


def abaqus_include(text: str) -> str | None:
    """Return the name of the file that a keyword line reads with INPUT; None if it reads none.

    Examples
    --------
    >>> abaqus_include("*Include, input=mesh/plate.inp")
    'mesh/plate.inp'
    """
    if not text.lstrip().startswith("*"):
        return None
    statement = _INCLUDED.match(text.strip())
    if statement is None:
        return None
    return (statement[1] or statement[2]).strip()


def real_or_zero(text: str, line: TextLine) -> float:
    """Return the number of an entry; zero where it is blank."""
    if not text.strip():
        return 0.0
    return parse_real(text, line)


def blocks(lines: Iterable[TextLine]) -> Iterator[Block]:
    """Yield the keyword blocks of an input file.

    Raises
    ------
    InputError
        If data lines precede the first keyword.
    """
    block: Block | None = None
    goes_on = False  # whether parameters follow on the next line
    for line in lines:
        text = line.text.strip()
        if not text or text.startswith("**"):
            continue
        if text.startswith("*"):
            if block is not None:
                yield block
            keyword, _, rest = text[1:].partition(",")
            block = Block(line, " ".join(keyword.upper().split()), _parameters(rest))
            goes_on = text.endswith(",")
        elif block is None:
            raise line.wrong(
                "there are data before the first keyword; an Abaqus input file starts with "
                "a keyword such as *NODE"
            )
        elif goes_on and text[0].isalpha():
            block.parameters.update(_parameters(text))
            goes_on = text.endswith(",")
        else:
            goes_on = False
            block.data.append(line)
    if block is not None:
        yield block


def _parameters(text: str) -> dict[str, str]:
    """Return the parameters of a keyword line.

    Examples
    --------
    >>> _parameters(' TYPE=C3D8 , elset = "upper, left", GENERATE')
    {'TYPE': 'C3D8', 'ELSET': 'upper, left', 'GENERATE': ''}
    """
    parameters = {}
    for parameter in _PARAMETER.findall(text):
        if parameter.strip():
            key, _, value = parameter.partition("=")
            parameters[key.strip().upper()] = value.strip().strip('"')
    return parameters
