"""A study as a TOML file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import tomli_w


def study_toml(table: Mapping[str, Any]) -> str:
    """Return a study as a TOML file holds it, what it sweeps in its order: it is that of the dimensions.

    Parameters
    ----------
    table : mapping
        The case with its [sweep] section.
    """
    rest = {**table, "sweep": {key: value for key, value in table["sweep"].items() if key != "over"}}
    lines = [f"{json.dumps(key)} = {_inline(value)}" for key, value in table["sweep"]["over"].items()]
    return "\n".join([tomli_w.dumps(rest).rstrip(), "", "[sweep.over]", *lines, ""])


def _inline(value: Any) -> str:
    """Return a value on one line; the writer of TOML would move tables behind what is none."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(key)} = {_inline(one)}" for key, one in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").rstrip()
