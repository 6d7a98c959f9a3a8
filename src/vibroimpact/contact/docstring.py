"""Docstrings of contact laws: their numpydoc sections, of which Parameters is made from
the declared fields.
"""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Mapping
from typing import Any


def docstring_sections(docstring: str) -> dict[str, str]:
    """Return the numpydoc sections of a docstring by heading; the text before the first heading has
    the key "".

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
    """Return a docstring with a Parameters section made from the fields of the law; as it
    is if it has one, or there are no fields.
    """
    sections = docstring_sections(docstring)
    if "Parameters" in sections or not items:
        return docstring
    entries = [
        _entry(name, item)
        for name, item in sorted(items.items(), key=lambda pair: bool(pair[1].metadata["memory"]))
    ]
    summary = sections.pop("")
    parts = {"Parameters": "\n".join(entries), **sections}
    return (
        "\n\n".join(
            [
                summary,
                *(f"{heading}\n{'-' * len(heading)}\n{text}" for heading, text in parts.items()),
            ]
        )
        + "\n"
    )


def _is_underline(line: str) -> bool:
    return len(line) >= 3 and set(line) == {"-"}


def _entry(name: str, item: dataclasses.Field[Any]) -> str:
    """Return the numpydoc entry of a parameter or a state: its detail, unit, range and default."""
    metadata = item.metadata
    default = (
        ""
        if item.default is dataclasses.MISSING
        else ", optional"
        if item.default is None
        else f", default {item.default:g}"
    )
    facts = [
        f"In {metadata['unit']}" if metadata["unit"] else "Dimensionless",
        metadata["range"].words,
    ]
    lines = [
        f"{'State: ' if metadata['memory'] else ''}{metadata['detail']}",
        ", ".join(filter(None, facts)) + ".",
    ]
    return "\n".join([f"{name} : float or array{default}", *(f"    {line}" for line in lines)])
