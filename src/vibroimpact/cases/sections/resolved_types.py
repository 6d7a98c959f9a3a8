"""The types of the resolved case, made from the sections of a case.

They are in a file of their own, which what is below the schema imports.
`python -m vibroimpact.cases.sections.resolved_types` writes it again, and `make docs` does;
a test finds it stale.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from pathlib import Path
from types import NoneType
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.sensor import SensorSection
from vibroimpact.cases.sections.schema import SECTIONS, CaseTable
from vibroimpact.resolved_case import ResolvedCase

TYPES_FILE = Path(inspect.getfile(ResolvedCase))

_HEADING = '''"""Types of the resolved case: the tables of `case.toml`, in SI, with all defaults.

A problem carries the resolved case that it was made from, and a result the one that its folder
holds. Numbers may be arrays, with one value per drop of a batch. Keys that do not apply to a case
are absent.

`vibroimpact.cases.sections.resolved_types` writes this file from the schema.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypedDict

from vibroimpact.arrays import Array
'''

_CONTACT = "dict[str, Any]"
"""Type of the [contact] section, whose keys are those of the laws."""


def resolved_types() -> str:
    """Return the text of the file with the types.

    Examples
    --------
    >>> "class ResolvedDrop(TypedDict, total=False):" in resolved_types()
    True
    """
    names = {name: f"Resolved{name.capitalize()}" for name in SECTIONS}
    tables = [_table(names[name], section, {}) for name, section in SECTIONS.items()]
    tables.append(_table("ResolvedSensor", SensorSection, {}))
    of_sections = {**names, "contact": _CONTACT, "sensors": "Sequence[ResolvedSensor]"}
    tables.append(_table("ResolvedCase", CaseTable, of_sections))
    return "\n\n".join([_HEADING, *tables])


def _table(name: str, section: type[BaseModel], stated: dict[str, str]) -> str:
    """Return the type of the table of a section; `stated` types stand for those of its fields."""
    lines = [f"class {name}(TypedDict, total=False):", f'    """{inspect.getdoc(section)}"""', ""]
    for key, info in section.model_fields.items():
        lines.append(f"    {key}: {stated.get(key) or _type_of(info)}")
    return "\n".join(lines) + "\n"


def _type_of(info: FieldInfo) -> str:
    """Return the type that the value of a field has in a resolved case."""
    if any(isinstance(item, Quantity) for item in info.metadata):
        return "Array"
    return " | ".join(dict.fromkeys(_types(info.annotation)))


def _types(annotation: Any) -> Iterator[str]:
    """Yield the type of each alternative of an annotation; keys without a value are absent."""
    origin = get_origin(annotation)
    arguments = get_args(annotation)
    if annotation is NoneType:
        return
    if annotation in (bool, int, float, str):
        yield annotation.__name__
    elif origin is Literal:
        yield type(arguments[0]).__name__
    elif origin is tuple:
        yield "Sequence[Array]"
    elif isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield "Mapping[str, Any]"
    elif any(isinstance(item, Quantity) for item in arguments):
        yield "Array"
    elif hasattr(annotation, "__metadata__"):
        yield from _types(arguments[0])
    elif arguments:
        for option in arguments:
            yield from _types(option)
    else:
        yield "Any"  # such as a material: a table, or the name of one


if __name__ == "__main__":
    TYPES_FILE.write_text(resolved_types(), encoding="utf-8")
