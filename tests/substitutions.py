"""Cases in which one value is of another kind: every place of every seed, and every kind
of value that a file can hold.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator
from datetime import date
from functools import cache
from typing import Any, NamedTuple

from seeds import Table, later_seeds, later_studies, seeds, study_seeds

VALUES: dict[str, Any] = {
    "text": "steel",
    "empty text": "",
    "text with a unit": "25 mm",
    "number as a text": "0.04",
    "infinity as a text": "1e999",
    "number with a comma": "2,5 mm",
    "percentage": "30 %",
    "long text": "x" * 3000,
    "whole number": 3,
    "number": 0.04,
    "negative": -2.5,
    "zero": 0,
    "large": 10**15,
    "huge": 1e300,
    "NaN": float("nan"),
    "infinite": float("inf"),
    "true": True,
    "false": False,
    "list": [1, 2],
    "empty list": [],
    "list of texts": ["x"],
    "list of lists": [[]],
    "table": {"a": 1},
    "empty table": {},
    "table of a law": {"law": "hertz"},
    "distribution": {"distribution": "normal", "mean": 1.0, "standard_deviation": 0.1},
    "list of tables": [{"a": 1}],
    "date": date(2024, 2, 29),
}

Place = tuple[str | int, ...]
"""The keys and numbers of list items that lead to a value."""


MISSPELT_TEXT, MISSPELT_KEY, MISSING = "misspelt text", "misspelt key", "missing"
"""Kinds of changes beside those values."""


class Substitution(NamedTuple):
    """A valid case, and a place in it with another value, or a key with another name, or
    without it.
    """

    where: str
    kind: str
    case: Table
    place: Place

    @property
    def table(self) -> Table:
        """The changed case."""
        if self.kind == MISSPELT_KEY:
            return with_key(self.case, self.place, misspelt(str(self.place[-1])))
        if self.kind == MISSPELT_TEXT:
            return with_value(self.case, self.place, misspelt(value_at(self.case, self.place)))
        if self.kind == MISSING:
            return without(self.case, self.place)
        return with_value(self.case, self.place, VALUES[self.kind])


@cache
def all_substitutions() -> tuple[Substitution, ...]:
    """Return a case for each key, once for each set of sections beside it that read it in
    another way, and each kind of value.
    """
    cases = [*later_seeds(), *later_studies(), *study_seeds(), *seeds()]
    return tuple(
        {
            (found.where, found.kind): found
            for case in reversed(cases)
            for found in _substitutions(case)
        }.values()
    )


def value_at(table: Table, place: Place) -> Any:
    """Return the value at a place."""
    inside: Any = table
    for key in place:
        inside = inside[key]
    return inside


def with_value(table: Table, place: Place, value: Any) -> Table:
    """Return a table with another value at a place."""
    changed = copy.deepcopy(table)
    value_at(changed, place[:-1])[place[-1]] = copy.deepcopy(value)
    return changed


def with_key(table: Table, place: Place, name: str) -> Table:
    """Return a table with another name of the key at a place."""
    changed = copy.deepcopy(table)
    above = value_at(changed, place[:-1])
    above[name] = above.pop(place[-1])
    return changed


def without(table: Table, place: Place) -> Table:
    """Return a table without the key at a place."""
    changed = copy.deepcopy(table)
    del value_at(changed, place[:-1])[place[-1]]
    return changed


def misspelt(text: str) -> str:
    """Return a text with two of its letters exchanged, as fingers do."""
    return f"{text[:1]}{text[2]}{text[1]}{text[3:]}" if len(text) > 2 else f"{text}x"


def _substitutions(case: Table) -> Iterator[Substitution]:
    """Yield the cases that differ from one by one value or key."""
    for place in _places(case):
        old, last = value_at(case, place), place[-1]
        where = ".".join("[]" if isinstance(key, int) else key for key in place)
        beside = (
            "sweep"
            if "sweep" in case
            else "calibrate"
            if "calibrate" in case and place[0] in ("contact", "calibrate")
            else ""
        )
        where = f"{where} {beside}".rstrip()
        kinds = [kind for kind, value in VALUES.items() if repr(old) != repr(value)]
        kinds += [MISSPELT_TEXT] if isinstance(old, str) else []
        kinds += [MISSPELT_KEY, MISSING] if isinstance(last, str) else []
        yield from (Substitution(where, kind, case, place) for kind in kinds)


def _places(inside: Any, above: Place = ()) -> Iterator[Place]:
    """Yield every place in a table."""
    for key in list(inside) if isinstance(inside, dict) else range(len(inside)):
        yield (*above, key)
        if isinstance(inside[key], (dict, list)):
            yield from _places(inside[key], (*above, key))
