"""A case to start from: the text of another one, with unused keys as comments."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, Field, fields
from os import PathLike
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from vibroimpact.cases.changed_text import changed_text
from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.local import LocalSection
from vibroimpact.cases.fields.quantities import quantity_of
from vibroimpact.cases.fields.section import Section
from vibroimpact.cases.fields.sensor import SensorSection
from vibroimpact.cases.reader import case_text, load_case, prefix_errors
from vibroimpact.cases.sections.schema import SECTIONS
from vibroimpact.contact.law import default_origin, unit_of
from vibroimpact.contact.registry import find_contact_law

_SECTIONS: dict[str, type[Section]] = {
    **SECTIONS,
    "contact": LocalSection,
    "sensors": SensorSection,
}
_HEADER = re.compile(r"^\s*\[\[?\s*([\w-]+)\s*[].]")  # of a section or of a table in it
_WIDTH = 40  # columns of a key with its value, before its meaning


def case_template(
    source: str | PathLike[str] = "paper:type1-theory",
    name: str = "",
    changes: Mapping[str, Any] | None = None,
) -> str:
    """Return the text of a new case file.

    It is that of another case, with its unused keys as comments.

    Parameters
    ----------
    source : path or str, default "paper:type1-theory"
        A TOML file, or "paper:NAME".
    name : str, optional
        Name of the new case; by default that of the source.
    changes : mapping, optional
        Other values by dotted key, such as ``{"plate.size.thickness": "10 mm"}``.

    Raises
    ------
    InputError
        If the source can't be read or is not a valid case, with these values.

    Examples
    --------
    >>> text = case_template("paper:type1-theory", "my rock")
    >>> 'name = "my rock"' in text, "# speed = " in text
    (True, True)
    """
    text = prefix_errors(source, lambda: case_text(source))
    others: dict[str, Any] = {}
    if name:
        others["name"] = name
    others |= changes or {}
    load_case(source, others)  # which must be valid
    text = changed_text(text, others)
    table: dict[str, Any] = tomllib.loads(text)
    blocks = _blocks(text.rstrip().split("\n"))
    # below the last block of each section
    last_blocks = dict(blocks)
    for section, lines in last_blocks.items():
        if section in _SECTIONS:
            lines.extend(_comments(section, table[section]))
    for section in _SECTIONS:
        if section not in table:
            header = "[[sensors]]" if section == "sensors" else f"[{section}]"
            blocks.append((section, ["", f"# {header}", *_comments(section, {})]))
    return "\n".join(line for _, lines in blocks for line in lines).rstrip() + "\n"


def _blocks(lines: list[str]) -> list[tuple[str, list[str]]]:
    """Return the lines of a case in blocks, each with the section that its first line opens.

    Blank lines belong to the block below.
    """
    blocks: list[tuple[str, list[str]]] = [("", [])]
    for line in lines:
        header = _HEADER.match(line)
        if header:
            block_above = blocks[-1][1]
            blank_lines = []
            while block_above and not block_above[-1].strip():
                blank_lines.append(block_above.pop())
            blocks.append((header[1], blank_lines))
        blocks[-1][1].append(line)
    return blocks


def _comments(section: str, table: Any) -> Iterator[str]:
    """Yield a comment for each key of a section that its table does not use.

    Of [contact] those of its law are first. The sensors are a list of tables.
    """
    used = set().union(*table) if isinstance(table, list) else set(table)
    if section == "contact" and isinstance(table.get("law"), str):
        for item in fields(find_contact_law(table["law"])):
            if item.name not in used and not item.metadata["memory"]:
                yield _parameter_comment(item, table.get("exponent", 1.5))
    for name, info in _SECTIONS[section].model_fields.items():
        if name not in used:
            yield _comment(name, _value(info), _meaning(info))


def _parameter_comment(item: Field[Any], exponent: Any) -> str:
    """Return a comment for a parameter of a contact law."""
    meaning = _with_unit(item.metadata["meaning"], unit_of(item, exponent))
    origin = default_origin(item)
    if origin:
        return _comment(item.name, "...", f"{meaning}; by default {origin}")
    if item.default is MISSING or item.default is None:
        return _comment(item.name, "...", meaning)
    return _comment(item.name, f"{item.default:g}", meaning)


def _comment(name: str, value: str, meaning: str) -> str:
    """Return a key with a value and its meaning as a comment of TOML."""
    assignment = f"# {name} = {value}"
    if not meaning:
        return assignment
    return f"{assignment.ljust(_WIDTH)}   # {meaning}"


def _meaning(info: FieldInfo) -> str:
    """Return the meaning of a key, with the unit of a quantity."""
    if info.description:
        return info.description
    quantity = quantity_of(info)
    if quantity is not None:
        return _with_unit(quantity.meaning, quantity.unit)
    schemas = (item for item in info.metadata if isinstance(item, JsonSchema))
    return next((schema.description for schema in schemas), "")


def _with_unit(meaning: str, unit: str) -> str:
    return f"{meaning} [{unit}]" if unit else meaning


def _value(info: FieldInfo) -> str:
    """Return the default of a key as TOML.

    Without one it is the first word that is allowed, or a gap to be filled.
    """
    if isinstance(info.default, (bool, int, float, str, tuple)) and info.default != ():
        return json.dumps(info.default)
    for option in (info.annotation, *get_args(info.annotation)):
        if get_origin(option) is Literal:
            return json.dumps(get_args(option)[0])
    quantity = quantity_of(info)
    if quantity is None or not quantity.unit:
        return "..."
    return f'"... {quantity.unit}"'
