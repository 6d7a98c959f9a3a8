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
    """Return the name of the file that an INCLUDE line includes; None for other lines.

    Examples
    --------
    >>> nastran_include("include 'mesh/plate.bdf'  $ the plate")
    'mesh/plate.bdf'
    """
    # most lines are sorted out without the slower pattern
    if "NCLUDE" not in text[:40].upper():
        return None
    statement = _INCLUDE.fullmatch(text)
    if statement is None:
        return None
    return next(name for name in statement.groups() if name)


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
    number = _EXPONENT.fullmatch(text)
    if number is None:
        return parse_real(text, line, what)
    return float(f"{number[1]}e{number[2] or number[3]}")


def cards(lines: Iterable[TextLine]) -> Iterator[Card]:
    """Yield the cards of bulk data, up to and including ENDDATA.

    Those that repeat the one before them are written out.

    Raises
    ------
    InputError
        If a continuation line has no card before it, its label does not match, or a repetition
        can't be read.
    """
    card: Card | None = None
    label = ""  # that the next line must have if it goes on with the card
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
            own_label = head.lstrip("+*").strip()
            if own_label and label and own_label.upper() != label.upper():
                raise line.wrong(
                    f"{quoted(own_label)} does not go on with the card before it, which asks for "
                    f"{quoted(label)}; it must follow its card"
                )
            card.fields.extend(fields)
        elif head[0] == "=":
            if card is None:
                raise line.wrong(
                    "a card is repeated without one before it; a card starts "
                    "with its name, such as GRID"
                )
            yield card
            *copies, card = repeated.cards(line, head, text, card)
            yield from copies
        else:
            if card is not None:
                yield card
            repeated = _Repeated()
            card = Card(line, head.rstrip("*").strip().upper(), fields)
            if card.name == "ENDDATA":
                break
        label = end.lstrip("+*").strip()
    if card is not None:
        yield card


class _Repeated:
    """Cards that repeat the one before them.

    A field is "=" for an equal one, "==" for all that follow, and "*(x)" for one that is x larger.
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
            _, *texts = (field.strip() for field in text.split(","))
            yield Card(line, before.name, self._fields(line, texts, before))
            return
        if not self._steps:
            raise line.wrong(
                f"{quoted(head)} repeats steps, and the line before has none; it must have "
                '"*(x)" in a field'
            )
        fields = before.fields
        for _ in range(parse_integer(count[1], line, "the number of repetitions")):
            fields = list(fields)
            for index, step in self._steps.items():
                fields[index] = _sum(fields[index], step, line)
            yield Card(line, before.name, fields)

    def _fields(self, line: TextLine, texts: list[str], before: Card) -> list[str]:
        """Return the fields of a card from those of the one before it, and keep the steps."""
        self._steps = {}
        fields: list[str] = []
        for index, field_before in enumerate(before.fields):
            text = texts[index] if index < len(texts) else ""
            if text == "==":
                return fields + before.fields[index:]
            increment = _INCREMENT.fullmatch(text)
            if increment:
                self._steps[index] = increment[1] or increment[2]
                fields.append(_sum(field_before, self._steps[index], line))
            elif text == "=":
                fields.append(field_before)
            else:
                fields.append(text)
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
    """Return the first field, the data fields, and the continuation field of a line.

    The data fields of the free format are padded to 8, or 4 in the large-field format.
    """
    if "," in text:
        head, *fields = (field.strip() for field in text.split(","))
        number = 4 if "*" in head else 8
        if len(fields) == number + 1:
            return head, fields[:number], fields[number]
        padding = [""] * (number - len(fields))
        return head, fields + padding, ""
    # columns 1 to 8, 9 to 72 and 73 to 80
    head = text[:8].strip()
    width = 16 if "*" in head else 8
    fields = []
    for start in range(8, 72, width):
        fields.append(text[start : start + width].strip())
    return head, fields, text[72:80].strip()
