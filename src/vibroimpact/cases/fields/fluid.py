"""What the keys `drop.air` and `contact.liquid` have in common: true for the usual fluid,
false for none, or a table of its numbers.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

from vibroimpact.cases.fields.section import Section, read_table
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted

Table = TypeVar("Table", bound=Section)

_UNITS = {"density": " kg/m3", "viscosity": " Pa s", "drag_coefficient": ""}


def read_fluid(kind: type[Table], value: Any) -> Table | None:
    """Return the table of a fluid; None if there is none.

    Raises
    ------
    InputError
        If the value is neither true or false nor a valid table.
    """
    if value is None or isinstance(value, kind):
        return value
    if isinstance(value, bool):
        return read_table(kind, {}) if value else None
    if isinstance(value, dict):
        return read_table(kind, value)
    raise InputError(
        f"{quoted(value)} is not allowed; it must be true, false, or a table with any of "
        f"{', '.join(kind.model_fields)}"
    )


def fluid_words(table: Mapping[str, Any]) -> str:
    """Return what a resolved table of a fluid holds, in words."""
    return ", ".join(
        f"{name.replace('_', ' ')} {float(value):.4g}{_UNITS[name]}"
        for name, value in table.items()
    )
