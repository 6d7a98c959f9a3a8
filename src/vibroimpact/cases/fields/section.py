"""The base class of the sections of a case, and the validation of their tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, Self, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from vibroimpact.cases.fields.fault_messages import InvalidTable, fault_messages
from vibroimpact.cases.fields.known_keys import keys_of
from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted

Value = TypeVar("Value")


class Section(BaseModel):
    """A table of a case."""  # the docstrings of sections are the descriptions in the JSON schema

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with some keys changed; its `derived` values are computed anew."""
        copy = super().model_copy(update=update, deep=deep)
        for name in vars(copy).keys() - type(self).model_fields.keys():
            del copy.__dict__[name]
        return copy


Of = TypeVar("Of", bound=Section)


def derived(function: Callable[[Of], Value]) -> Callable[[Of], Value]:
    """Decorate a function of a section so that its value is computed once and kept with the
    section, which is frozen.

    Examples
    --------
    >>> class Bar(Section):
    ...     length: float
    >>> @derived
    ... def area(bar: Bar) -> float:
    ...     print("computed")
    ...     return 2.0 * bar.length
    >>> bar = Bar(length=3.0)
    >>> area(bar), area(bar)
    computed
    (6.0, 6.0)
    """
    name = f"{function.__module__}.{function.__qualname__}"

    @wraps(function)
    def kept(section: Of) -> Value:
        values = section.__dict__
        if name not in values:
            values[name] = function(section)
        value: Value = values[name]
        return value

    return kept


Table = TypeVar("Table", bound=Section)


def read_inner_table(kind: type[Table], value: Mapping[str, Any]) -> Table:
    """Return a validated table of the given kind, while the section that it is in is validated,
    which reports all its faults.

    Raises
    ------
    InvalidTable
        With all its faults.
    """
    try:
        return kind.model_validate(value)
    except ValidationError as error:
        raise InvalidTable(kind, error) from None


def read_table(kind: type[Table], value: Mapping[str, Any]) -> Table:
    """Return a validated table of the given kind, for fields that accept several kinds of tables.

    Parameters
    ----------
    kind : type of Section
        The kind of table.
    value : mapping
        The table.

    Raises
    ------
    InputError
        For the first invalid key; the message for an unknown key lists the keys of this kind.
    """
    known = keys_of(kind)
    for key in value:
        if key not in known and key != "type":
            raise InputError(
                f"unknown key {quoted(key)}; it takes {choices(known, key, 'schema')}", key
            )
    try:
        return kind.model_validate(dict(value))
    except ValidationError as error:
        path, message = next(fault_messages(error, kind))
        raise InputError(message, path) from None


def check_alternatives(
    table: Section, first: str, other: str, *, needed: bool, key: str = ""
) -> None:
    """Check that at most one of two alternative keys of a table is given, and, if `needed`, that
    one is.

    Raises
    ------
    InputError
        With `key`, if both are given, or none of those needed.
    """
    given = [name for name in (first, other) if getattr(table, name) is not None]
    if len(given) == 2 or (needed and not given):
        fault = "both are" if given else "neither is"
        raise InputError(f"give either {first} or {other}; {fault} given", key)
