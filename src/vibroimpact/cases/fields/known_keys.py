"""What the sections of a case take, for messages.

There are their keys as a file has them, and the fields and tables at a key path.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo


def keys_of(section: type[BaseModel]) -> list[str]:
    """Return the keys of a section as a file has them.

    The type of a table, by which the section was chosen, is none of them.

    Examples
    --------
    >>> from vibroimpact.calibration.observed.section import SpeedsTable
    >>> keys_of(SpeedsTable)
    ['from', 'to', 'number', 'scale']
    """
    return [info.alias or name for name, info in section.model_fields.items() if name != "type"]


def section_at(section: type[BaseModel], path: Sequence[str]) -> type[BaseModel] | None:
    """Return the section at a key path in another one; None if there is none.

    Examples
    --------
    >>> from vibroimpact.cases.sections.schema import CaseTable
    >>> (
    ...     section_at(CaseTable, ["sensors", "0", "geophone"]).__name__,
    ...     section_at(CaseTable, ["sweep", "classes", "coal"]).__name__,
    ... )
    ('GeophoneTable', 'ClassTable')
    """
    inner: type[BaseModel] | None = section
    has_chosen_keys = False
    for key in path:
        # an item of a list of tables, or a table by a name that the user chose
        if key.isdigit() or has_chosen_keys:
            has_chosen_keys = False
            continue
        field = None if inner is None else field_of(inner, key)
        if field is None:
            return None
        parts = list(parts_of(field))
        sections = (
            part for part in parts if isinstance(part, type) and issubclass(part, BaseModel)
        )
        inner = next(sections, None)
        has_chosen_keys = any(get_origin(part) is dict for part in parts)
    return inner


def field_at(section: type[BaseModel], path: Sequence[str]) -> FieldInfo | None:
    """Return the field at a key path in a section; None if there is none.

    The field of an item of a list is that of the list.
    """
    keys = [key for number, key in enumerate(path) if number < len(path) - 1 or not key.isdigit()]
    above = section_at(section, keys[:-1])
    if above is None or not keys:
        return None
    return field_of(above, keys[-1])


def field_of(section: type[BaseModel], key: str) -> FieldInfo | None:
    """Return the field of a section by its key in a file; None if there is none."""
    for name, info in section.model_fields.items():
        if key == (info.alias or name):
            return info
    return None


def parts_of(field: FieldInfo) -> Iterator[Any]:
    """Yield the types that the annotation of a field is made of, and their annotations."""
    yield from field.metadata
    yield from _parts(field.annotation)


def _parts(annotation: Any) -> Iterator[Any]:
    yield annotation
    for inner in (*get_args(annotation), *getattr(annotation, "__metadata__", ())):
        if isinstance(inner, FieldInfo):
            yield from inner.metadata
        yield from _parts(inner)
