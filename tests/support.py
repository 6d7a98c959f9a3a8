"""Cases for tests."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import pytest


def plain_case(**changes: object) -> dict:
    """A valid case as a mapping; `section__key=value` changes a key, None removes it."""
    case: dict = {
        "name": "a test",
        "sphere": {"radius": 0.025, "material": "rock-paper"},
        "plate": {"material": "steel-paper"},
        "drop": {"height": 0.5},
        "contact": {"law": "lankarani-nikravesh", "restitution": 0.7},
        "run": {"impacts": 3},
    }
    for path, value in changes.items():
        *parents, key = path.split("__")
        table = case
        for parent in parents:
            table = table.setdefault(parent, {})
        if value is None:
            table.pop(key, None)
        else:
            table[key] = value
    return case


def one_in(every: int, values: Iterable[Any], name: Callable[[Any], str] = str) -> list[Any]:
    """Parameters of a test, of which one in so many is tried each time, and the others where there is time for the slow ones."""
    several = [value if isinstance(value, tuple) else (value,) for value in values]
    return [pytest.param(*value, id=name(value[0]), marks=pytest.mark.slow if place % every else ()) for place, value in enumerate(several)]
