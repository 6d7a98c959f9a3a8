"""What the paper prints: values with their place, unit and digits, and the misprints among its equations."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files
from typing import Any, Literal

from vibroimpact.errors import InputError, did_you_mean

PAPER = '"Study on the Vibroimpact Response of the Particle Elastic Impact on the Metal Plate" (Shock and Vibration)'
"""What is reproduced."""

Relation = Literal["=", "<", ">"]


@dataclass(frozen=True)
class Printed:
    """A value that the paper prints.

    Parameters
    ----------
    name : str
        What it is called here, such as "type1.rebound_height".
    what : str
        What it is, in words.
    text : str
        The number as printed.
    unit : str
        Its unit; "%" where it is printed in per cent.
    place : str
        Where it stands: table, section and paragraph, or equation.
    read : str
        How it was read.
    relation : {"=", "<", ">"}
        Is it the value, or is the value said to be below or above it?
    digits : int, optional
        How many of its digits count, where that can't be seen, as with 200.

    Examples
    --------
    >>> height = printed("type1.rebound_height")
    >>> height.value, height.half, height.unit
    (2.41132, 5e-06, 'm')
    """

    name: str
    what: str
    text: str
    unit: str
    place: str
    read: str
    relation: Relation = "="
    digits: int | None = None

    @property
    def value(self) -> float:
        """The number, in the unit printed."""
        return float(self.text)

    @property
    def half(self) -> float:
        """Half a unit of its last digit: as far as rounding can have moved it."""
        number = Decimal(self.text)
        exponent = int(number.as_tuple().exponent) if self.digits is None else number.adjusted() - self.digits + 1
        return float(Decimal("0.5").scaleb(exponent))


@dataclass(frozen=True)
class Correction:
    """Something that the paper prints wrongly, or leaves out.

    Parameters
    ----------
    place : str
        Where it stands.
    printed : str
        What is printed.
    right : str
        What it must be.
    why : str
        How that is known.
    """

    place: str
    printed: str
    right: str
    why: str


@cache
def _library() -> Mapping[str, Any]:
    return tomllib.loads((files("vibroimpact") / "paper" / "printed.toml").read_text(encoding="utf-8"))


@cache
def printed_values() -> Mapping[str, Printed]:
    """Return every value of the paper that is held here, by its name; of a list `NAME.1`, `NAME.2`, ..."""
    found: dict[str, Printed] = {}
    for entry in _library()["value"]:
        texts = entry["text"]
        for number, text in enumerate([texts] if isinstance(texts, str) else texts, start=1):
            which = "" if isinstance(texts, str) else f".{number}"
            value = Printed(**{**entry, "name": f"{entry['name']}{which}", "what": entry["what"].format(number), "text": text})
            if value.name in found:
                raise ValueError(f"{value.name} is held twice")
            found[value.name] = value
    return found


def printed(name: str) -> Printed:
    """Return a value of the paper.

    Raises
    ------
    InputError
        If there is none of that name.
    """
    values = printed_values()
    if name not in values:
        raise InputError(f'the paper has no value "{name}" here.{did_you_mean(name, values)}')
    return values[name]


@cache
def corrections() -> tuple[Correction, ...]:
    """Return what the paper prints wrongly or leaves out."""
    return tuple(Correction(**entry) for entry in _library()["correction"])
