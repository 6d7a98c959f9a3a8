"""Cards of a Nastran file: free, small-field and large-field format, with continuation lines."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from vibroimpact.meshes.text_files import TextLine, parse_integer, parse_real
from vibroimpact.quoting import quoted

_EXPONENT = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[dD]([+-]?\d+)|([+-]\d+))")
_INCLUDE = re.compile(
    r"""\s*INCLUDE\s+(?:'([^']+)'|"([^"]+)"|([^'"$\s]+))\s*(?:\$.*)?""", re.IGNORECASE
)
_FIELDS = 8
_INCREMENT = re.compile(r"\*(?:\(([^()]+)\)|([+-]?[\d.][^()]*))")
_COUNT = re.compile(r"=\(?([1-9]\d{0,5})\)?")


class Card(NamedTuple):
    """A card: its name in capitals, and its data fields, from the second on."""

    line: TextLine
    name: str
    fields: list[str]


def nastran_include(text: str) -> str | None:
    """Return the name of the file that an INCLUDE line of a Nastran file includes; None for other
    lines.

    Examples
    --------
    >>> nastran_include("include 'mesh/plate.bdf'  $ the plate")
    'mesh/plate.bdf'
    """
    found = _INCLUDE.fullmatch(text) if "NCLUDE" in text[:40].upper() else None
    return next(name for name in found.groups() if name) if found else None


def nastran_real(
    text: str, line: TextLine, what: str = "a coordinate", blank: float = 0.0
) -> float:
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
    """Yield the cards of bulk data, up to and including ENDDATA; those that repeat the one before
    them are written out.

    Raises
    ------
    InputError
        If a continuation line has no card before it, its label does not match, or a repetition
        can't be read.
    """
    card, goes_on = None, ""
    repeated = _Repeated()
    for line in lines:
        text = line.text.split("$", 1)[0].rstrip()
        if not text or nastran_include(text) is not None:
            continue
        head, fields, end = _split(text.expandtabs(8))
        if not head or head[0] in "+*":
            if card is None:
                raise line.wrong(
                    "a line goes on without a card before it; a card starts "
                    "with its name, such as GRID"
                )
            if (name := head.lstrip("+*").strip()) and goes_on and name.upper() != goes_on.upper():
                raise line.wrong(
                    f"{quoted(name)} does not go on with the card before it, which asks for "
                    f"{quoted(goes_on)}; it must follow its card"
                )
            card.fields.extend(fields)
        elif head[0] == "=":
            if card is None:
                raise line.wrong(
                    "a card is repeated without one before it; a card starts "
                    "with its name, such as GRID"
                )
            yield card
            made = list(repeated.cards(line, head, text, card))
            yield from made[:-1]
            card = made[-1]
        else:
            if card is not None:
                yield card
            repeated = _Repeated()
            card = Card(line, head.rstrip("*").strip().upper(), fields)
            if card.name == "ENDDATA":
                break
        goes_on = end.lstrip("+*").strip()
    if card is not None:
        yield card


class _Repeated:
    """Cards that repeat the one before them: "=" for an equal field, "==" for all that
    follow, "*(x)" for one that is x larger.
    """

    def __init__(self) -> None:
        self._steps: dict[int, str] = {}

    def cards(self, line: TextLine, head: str, text: str, before: Card) -> Iterator[Card]:
        """Yield the cards of a line that starts with "=", or "=(n)" for n more with the steps of
        the line before it.

        Raises
        ------
        InputError
            If the card before goes over several lines, or the line can't be read.
        """
        if len(before.fields) > _FIELDS:
            raise line.wrong(
                f"a {before.name} of several lines is repeated, which is "
                "not read; write each card out"
            )
        count = _COUNT.fullmatch(head)
        if count is None and head != "=":
            raise line.wrong(
                f'{quoted(head)} is no repetition; it must be "=", or "=(n)" after a line '
                'of "=" and "*(x)"'
            )
        if count is None:
            fields = self._fields(
                line,
                [field.strip() for field in text.split(",")][1:] if "," in text else [],
                before,
            )
            yield Card(line, before.name, fields)
            return
        if not self._steps:
            raise line.wrong(
                f"{quoted(head)} repeats steps, and the line before has none; it must have "
                '"*(x)" in a field'
            )
        fields = before.fields
        for _ in range(parse_integer(count[1], line, "the number of repetitions")):
            fields = [
                _sum(field, self._steps[at], line) if at in self._steps else field
                for at, field in enumerate(fields)
            ]
            yield Card(line, before.name, fields)

    def _fields(self, line: TextLine, given: list[str], before: Card) -> list[str]:
        """Return the fields of a card from those of the one before it, and keep the steps."""
        self._steps = {}
        fields: list[str] = []
        for at, old in enumerate(before.fields):
            text = given[at] if at < len(given) else ""
            if text == "==":
                return fields + before.fields[at:]
            step = _INCREMENT.fullmatch(text)
            if step:
                self._steps[at] = step[1] or step[2]
            fields.append(
                _sum(old, self._steps[at], line) if step else old if text == "=" else text
            )
        return fields


def _sum(text: str, step: str, line: TextLine) -> str:
    """Return the sum of two fields: a whole number if both are, else a real one."""
    if all(re.fullmatch(r"[+-]?\d+", part) for part in (text, step)):
        return str(int(text) + int(step))
    return repr(
        nastran_real(text, line, "a number that can be stepped")
        + nastran_real(step, line, "a step")
    )


def _split(text: str) -> tuple[str, list[str], str]:
    """Return the first field, the data fields, padded to 8 (4 in large-field format), and
    the continuation field.
    """
    if "," in text:
        head, *fields = (field.strip() for field in text.split(","))
        width = 4 if "*" in head else 8
        if len(fields) == width + 1:
            return head, fields[:width], fields[width]
        return head, fields + [""] * (width - len(fields)), ""
    head = text[:8].strip()
    size = 16 if "*" in head else 8
    return (
        head,
        [text[start : start + size].strip() for start in range(8, 72, size)],
        text[72:80].strip(),
    )
