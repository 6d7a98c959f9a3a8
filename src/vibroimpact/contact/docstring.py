"""Docstrings of contact laws: their numpydoc sections.

The section Parameters is made from the declared fields.
"""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Mapping
from typing import Any


def docstring_sections(docstring: str) -> dict[str, str]:
    """Return the numpydoc sections of a docstring by heading.

    The text before the first heading has the key "".

    Examples
    --------
    >>> docstring_sections("A law.\\n\\nNotes\\n-----\\nIt never pulls.")
    {'': 'A law.', 'Notes': 'It never pulls.'}
    """
    lines = inspect.cleandoc(docstring).splitlines()
    sections: dict[str, list[str]] = {"": []}
    for line, following in zip(lines, [*lines[1:], ""], strict=True):
        if _is_underline(following):
            sections[line] = []
        elif not _is_underline(line):
            sections[list(sections)[-1]].append(line)
    return {heading: "\n".join(text).strip("\n") for heading, text in sections.items()}


def with_parameters(docstring: str, items: Mapping[str, dataclasses.Field[Any]]) -> str:
    """Return a docstring with a Parameters section made from the fields of the law.

    It is returned as it is if it has one, or if there are no fields.
    """
    sections = docstring_sections(docstring)
    if "Parameters" in sections or not items:
        return docstring
    parameters = [_entry(name, item) for name, item in items.items() if not _is_state(item)]
    states = [_entry(name, item) for name, item in items.items() if _is_state(item)]
    summary = sections.pop("")
    blocks = [summary, _section("Parameters", "\n".join([*parameters, *states]))]
    blocks += [_section(heading, text) for heading, text in sections.items()]
    return "\n\n".join(blocks) + "\n"


def _section(heading: str, text: str) -> str:
    """Return a numpydoc section with its underlined heading."""
    return f"{heading}\n{'-' * len(heading)}\n{text}"


def _is_state(item: dataclasses.Field[Any]) -> bool:
    return bool(item.metadata["memory"])


def _is_underline(line: str) -> bool:
    return len(line) >= 3 and set(line) == {"-"}


def _entry(name: str, item: dataclasses.Field[Any]) -> str:
    """Return the numpydoc entry of a parameter or a state: its detail, unit, range and default."""
    metadata = item.metadata
    if item.default is dataclasses.MISSING:
        default = ""
    elif item.default is None:
        default = ", optional"
    else:
        default = f", default {item.default:g}"
    label = "State: " if metadata["memory"] else ""
    values = "Dimensionless"
    if metadata["unit"]:
        values = f"In {metadata['unit']}"
    allowed = metadata["range"].words
    if allowed:
        values += f", {allowed}"
    return "\n".join(
        [
            f"{name} : float or array{default}",
            f"    {label}{metadata['detail']}",
            f"    {values}.",
        ]
    )
