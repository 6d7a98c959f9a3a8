"""Values printed in the paper, with place, unit and significant digits, and corrections
of its misprints (`printed.toml`).
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files
from typing import Any, Literal

from vibroimpact.errors import InputError, did_you_mean

PAPER = (
    '"Study on the Vibroimpact Response of the Particle Elastic Impact on the Metal Plate" '
    "(Shock and Vibration)"
)
"""Title and journal of the paper; its authors, year and DOI were not at hand."""

Relation = Literal["=", "<", ">"]

Role = Literal["result", "inferred", "input"]


@dataclass(frozen=True)
class PrintedValue:
    """A value printed in the paper.

    Parameters
    ----------
    name : str
        Identifier, such as "type1.rebound_height".
    what : str
        Description of the quantity.
    text : str
        The number as printed.
    unit : str
        Unit; "%" where it is printed in per cent.
    place : str
        Location in the paper: table, section and paragraph, or equation.
    read : str
        How the number was read.
    relation : {"=", "<", ">"}
        Whether the paper states the value itself, an upper bound or a lower bound.
    digits : int, optional
        Number of significant digits, where the text does not show it, as with 200.
    role : {"result", "inferred", "input"}
        What the number is here: a result of the paper; one from which the restitution or the
        full-damping penetration was inferred, or that penetration itself; or an input of the paper.

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
    role: Role = "result"

    @property
    def value(self) -> float:
        """The number in the printed unit."""
        return float(self.text)

    @property
    def half(self) -> float:
        """Half a unit of the last significant digit: the largest rounding error."""
        number = Decimal(self.text)
        if self.digits is None:
            exponent = int(number.as_tuple().exponent)
        else:
            exponent = number.adjusted() - self.digits + 1
        return float(Decimal("0.5").scaleb(exponent))


@dataclass(frozen=True)
class Correction:
    """A misprint or an omission of the paper.

    Parameters
    ----------
    place : str
        Location in the paper.
    printed : str
        The text as printed.
    right : str
        The corrected text.
    why : str
        Justification of the correction.
    """

    place: str
    printed: str
    right: str
    why: str


@cache
def _library() -> Mapping[str, Any]:
    return tomllib.loads(
        (files("vibroimpact") / "paper" / "printed.toml").read_text(encoding="utf-8")
    )


@cache
def printed_values() -> Mapping[str, PrintedValue]:
    """Return all values of `printed.toml` by name; the items of a list are named
    `NAME.1`, `NAME.2`, ...
    """
    values: dict[str, PrintedValue] = {}
    for entry in _library()["value"]:
        texts = entry["text"]
        is_single = isinstance(texts, str)
        if is_single:
            texts = [texts]
        for number, text in enumerate(texts, start=1):
            which = "" if is_single else f".{number}"
            value = PrintedValue(
                **{
                    **entry,
                    "name": f"{entry['name']}{which}",
                    "what": entry["what"].format(number),
                    "text": text,
                }
            )
            if value.name in values:
                raise ValueError(f"{value.name} is held twice")
            values[value.name] = value
    return values


def printed(name: str) -> PrintedValue:
    """Return a printed value by name.

    Raises
    ------
    InputError
        If there is no value of that name.
    """
    values = printed_values()
    if name not in values:
        raise InputError(f'the paper has no value "{name}" here.{did_you_mean(name, values)}')
    return values[name]


@cache
def corrections() -> tuple[Correction, ...]:
    """Return the misprints and omissions of the paper."""
    return tuple(Correction(**entry) for entry in _library()["correction"])
