"""What all sections of a case are: frozen, and closed to unknown keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from vibroimpact.cases.fields.explain import fault_messages
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.shown import shown


class Section(BaseModel):
    """A table of a case."""

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True)


Table = TypeVar("Table", bound=Section)


def read_table(kind: type[Table], value: Mapping[str, Any]) -> Table:
    """Read a table that is one of several possible; an unknown key is named with those that this one takes.

    Raises
    ------
    InputError
        With the first key that is wrong.
    """
    known = [info.alias or name for name, info in kind.model_fields.items() if name != "type"]
    for key in value:
        if key not in known and key not in kind.model_fields:
            raise InputError(f"unknown key {shown(key)}; it takes {', '.join(known)}.{did_you_mean(key, known)}", key)
    try:
        return kind.model_validate(dict(value))
    except ValidationError as error:
        path, message = next(fault_messages(error, lambda where: kind if not where else None))
        raise InputError(message.replace("this section is missing", "this key is missing"), path) from None
