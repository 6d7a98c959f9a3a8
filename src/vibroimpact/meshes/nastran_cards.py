"""Cards of a Nastran file: free, small-field and large-field format, with continuation lines."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from vibroimpact.meshes.text_files import TextLine, parse_real
from vibroimpact.shown import shown

_EXPONENT = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[dD]([+-]?\d+)|([+-]\d+))")
_INCLUDE = re.compile(r"""\s*INCLUDE\s+(?:'([^']+)'|"([^"]+)"|([^'"$\s]+))\s*(?:\$.*)?""", re.IGNORECASE)


class Card(NamedTuple):
    """A card: its name in capitals, and its data fields, from the second on."""

    line: TextLine
    name: str
    fields: list[str]


def nastran_include(text: str) -> str | None:
    """Return the name of the file that an INCLUDE line of a Nastran file includes; None for other lines.

    Examples
    --------
    >>> nastran_include("include 'mesh/plate.bdf'  $ the plate")
    'mesh/plate.bdf'
    """
    found = _INCLUDE.fullmatch(text) if "NCLUDE" in text[:40].upper() else None
    return next(name for name in found.groups() if name) if found else None


def nastran_real(text: str, line: TextLine, what: str = "a coordinate", blank: float = 0.0) -> float:
    """Return a real number, whose exponent may have a D or no letter; a blank field is `blank`.

    Examples
    --------
    >>> nastran_real("1.5-3", None), nastran_real("1.D+3", None), nastran_real("", None)
    (0.0015, 1000.0, 0.0)
    """
    if not text:
        return blank
    found = _EXPONENT.fullmatch(text)
    return float(f"{found[1]}e{found[2] or found[3]}") if found else parse_real(text, line, what)


def cards(lines: Iterable[TextLine]) -> Iterator[Card]:
    """Yield the cards of bulk data, up to and including ENDDATA.

    Raises
    ------
    InputError
        If a continuation line has no card before it, or its label does not match.
    """
    card, goes_on = None, ""
    for line in lines:
        text = line.text.split("$", 1)[0].rstrip()
        if not text or nastran_include(text) is not None:
            continue
        head, fields, end = _split(text.expandtabs(8))
        if not head or head[0] in "+*":
            if card is None:
                raise line.wrong("a line goes on without a card before it; a card starts with its name, such as GRID")
            if (name := head.lstrip("+*").strip()) and goes_on and name != goes_on:
                raise line.wrong(
                    f"{shown(name)} does not go on with the card before it, which asks for {shown(goes_on)}; it must follow its card"
                )
            card.fields.extend(fields)
        else:
            if card is not None:
                yield card
            card = Card(line, head.rstrip("*").strip().upper(), fields)
            if card.name == "ENDDATA":
                break
            if card.name.startswith("="):
                raise line.wrong('the card "=" repeats the one before it, which is not read; write each card out')
        goes_on = end.lstrip("+*").strip()
    if card is not None:
        yield card


def _split(text: str) -> tuple[str, list[str], str]:
    """Return the first field, the data fields, padded to 8 (4 in large-field format), and the continuation field."""
    if "," in text:
        head, *fields = (field.strip() for field in text.split(","))
        width = 4 if "*" in head else 8
        if len(fields) == width + 1:
            return head, fields[:width], fields[width]
        return head, fields + [""] * (width - len(fields)), ""
    head = text[:8].strip()
    size = 16 if "*" in head else 8
    return head, [text[start : start + size].strip() for start in range(8, 72, size)], text[72:80].strip()
