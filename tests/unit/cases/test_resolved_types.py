"""The types of the resolved case are those that the schema gives, and resolved cases have them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import UnionType
from typing import Any, get_args, get_origin, get_type_hints, is_typeddict

import pytest

import vibroimpact as vi
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.sections.resolved_types import TYPES_FILE, resolved_types
from vibroimpact.resolved_case import ResolvedCase, ResolvedSensor


def test_the_file_is_that_of_the_schema() -> None:
    assert TYPES_FILE.read_text(encoding="utf-8") == resolved_types(), (
        "run: python -m vibroimpact.cases.sections.resolved_types"
    )


@pytest.mark.parametrize("name", vi.shipped_cases())
def test_shipped_cases_have_these_types(name: str) -> None:
    check_table(resolved_case(vi.load_case(name)), ResolvedCase)


def test_tables_of_sensors_have_these_types() -> None:
    case = vi.load_case(
        "signals:river-plate",
        {"sensors": [{"name": "a1", "position": [0.0, 0.1], "direction": [0, 1, 0]}]},
    )
    (sensor,) = resolved_case(case)["sensors"]
    check_table(sensor, ResolvedSensor)


def test_a_value_of_another_type_is_seen() -> None:
    with pytest.raises(AssertionError):
        check_table({"name": 3}, ResolvedSensor)
    with pytest.raises(KeyError):
        check_table({"nam": "a1"}, ResolvedSensor)


def check_table(table: Mapping[str, Any], kind: Any) -> None:
    """Raise unless a table has keys and values of its type."""
    types = get_type_hints(kind)
    for key, value in table.items():
        assert is_of(value, types[key]), (key, value)


def is_of(value: Any, kind: Any) -> bool:
    """Return whether a value has a type of a table."""
    origin, arguments = get_origin(kind), get_args(kind)
    if kind is Any:
        return True
    if is_typeddict(kind):
        check_table(value, kind)
        return True
    if origin is UnionType:
        return any(is_of(value, option) for option in arguments)
    if origin is Sequence:
        return isinstance(value, list) and all(is_of(item, arguments[0]) for item in value)
    return isinstance(value, Mapping if origin in (Mapping, dict) else kind)
