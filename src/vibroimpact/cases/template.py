"""A case to start from: the text of another one, with the keys that it does not use as comments."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields
from os import PathLike
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from vibroimpact.cases.changed_text import changed_text
from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.local import LocalSection
from vibroimpact.cases.fields.quantities import quantity_of
from vibroimpact.cases.fields.section import Section
from vibroimpact.cases.reader import case_text, load_case, prefix_errors
from vibroimpact.cases.schema import SECTIONS, SensorSection
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
    """Return the text of a new case file: that of another case, with its unused keys as comments.

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
    others = {**({"name": name} if name else {}), **(changes or {})}
    load_case(source, others)  # which must be valid
    text = changed_text(text, others)
    used: dict[str, Any] = tomllib.loads(text)
    blocks = _blocks(text.rstrip().split("\n"))
    for place in range(len(blocks) - 1, -1, -1):
        section = blocks[place][0]
        # the last block of a section
        if section in _SECTIONS and section not in [later for later, _ in blocks[place + 1 :]]:
            blocks[place][1].extend(_comments(section, used[section]))
    for section in _SECTIONS:
        if section not in used:
            header = "[[sensors]]" if section == "sensors" else f"[{section}]"
            blocks.append((section, ["", f"# {header}", *_comments(section, {})]))
    return "\n".join(line for _, lines in blocks for line in lines).rstrip() + "\n"


def _blocks(lines: list[str]) -> list[tuple[str, list[str]]]:
    """Return the lines of a case in blocks, each with the section that its first line
    opens; blank lines belong to the block below.
    """
    blocks: list[tuple[str, list[str]]] = [("", [])]
    for line in lines:
        if found := _HEADER.match(line):
            blank = []
            while blocks[-1][1] and not blocks[-1][1][-1].strip():
                blank.append(blocks[-1][1].pop())
            blocks.append((found[1], blank))
        blocks[-1][1].append(line)
    return blocks


def _comments(section: str, used: Any) -> Iterator[str]:
    """Yield a comment for each key of a section that is not used; of [contact] those of
    its law first.
    """
    taken = set().union(*used) if isinstance(used, list) else set(used)
    if section == "contact" and isinstance(used.get("law"), str):
        for item in fields(find_contact_law(used["law"])):
            if item.name not in taken and not item.metadata["memory"]:
                origin = default_origin(item)
                value = "..." if origin or item.default in (MISSING, None) else f"{item.default:g}"
                unit = unit_of(item, used.get("exponent", 1.5))
                yield _comment(
                    item.name,
                    value,
                    _with_unit(item.metadata["meaning"], unit)
                    + (f"; by default {origin}" if origin else ""),
                )
    for name, info in _SECTIONS[section].model_fields.items():
        if name not in taken:
            yield _comment(name, _value(info), _meaning(info))


def _comment(name: str, value: str, meaning: str) -> str:
    return (
        f"# {name} = {value}".ljust(_WIDTH) + f"   # {meaning}"
        if meaning
        else f"# {name} = {value}"
    )


def _meaning(info: FieldInfo) -> str:
    """Return the meaning of a key, with the unit of a quantity."""
    if info.description:
        return info.description
    if (quantity := quantity_of(info)) is not None:
        return _with_unit(quantity.meaning, quantity.unit)
    return next((one.description for one in info.metadata if isinstance(one, JsonSchema)), "")


def _with_unit(meaning: str, unit: str) -> str:
    return f"{meaning} [{unit}]" if unit else meaning


def _value(info: FieldInfo) -> str:
    """Return the default of a key as TOML; without one the first word that is allowed, or
    a gap to be filled.
    """
    if (
        info.default is not None
        and isinstance(info.default, (bool, int, float, str, tuple))
        and info.default != ()
    ):
        return json.dumps(info.default)
    for option in (info.annotation, *get_args(info.annotation)):
        if get_origin(option) is Literal:
            return json.dumps(get_args(option)[0])
    quantity = quantity_of(info)
    return "..." if quantity is None or not quantity.unit else f'"... {quantity.unit}"'
