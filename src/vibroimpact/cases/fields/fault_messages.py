"""Error messages made from pydantic's validation errors: the key, what is wrong, and what is allowed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from pydantic import BaseModel, ValidationError

from vibroimpact.errors import did_you_mean
from vibroimpact.shown import shown

SectionAt = Callable[[tuple[str, ...]], type[BaseModel] | None]
"""Returns the section class at a key path of a case; None if there is none."""


def fault_messages(error: ValidationError, section_at: SectionAt) -> Iterator[tuple[str, str]]:
    """Yield the dotted key path and the message of each validation error."""
    faults = error.errors()
    for fault in faults:
        where = tuple(str(part) for part in fault["loc"] if not _is_branch(str(part)))
        if _of_a_text(fault["loc"]) and fault["type"] == "string_type" and isinstance(fault["input"], (list, tuple)):
            continue  # the field may also be a list, and the error of that alternative is reported
        path = ".".join(where)
        kind, context = fault["type"], fault.get("ctx", {})
        cause, given = context.get("error"), shown(fault["input"])
        if kind == "extra_forbidden":
            section = section_at(where[:-1])
            known = list(section.model_fields) if section else []
            above = ".".join(part for part in where[:-1] if not part.isdigit())
            place = "a case" if not above else f"[[{above}]]" if where[-2].isdigit() else f"[{above}]"
            yield path, f"unknown key {shown(where[-1])}; {place} takes {', '.join(known)}.{did_you_mean(where[-1], known)}"
        elif kind == "missing" and _is_misspelt(fault["loc"], [one["loc"] for one in faults if one["type"] == "extra_forbidden"]):
            continue  # the unknown key is reported, with the one that was meant
        elif kind == "missing" and where[-1].isdigit():
            yield ".".join(where[:-1]), f"there are too few values; it takes {_about(where[:-1], section_at).removeprefix(': ')}"
        elif kind == "missing":
            yield path, f"this {'section' if len(where) == 1 else 'key'} is missing{_about(where, section_at)}"
        elif kind == "value_error" and isinstance(cause, ValidationError):
            yield from ((f"{path}.{inner}" if path else inner, message) for inner, message in fault_messages(cause, section_at))
        elif kind == "value_error":
            key = getattr(cause, "key", "")
            yield ".".join(part for part in (path, key) if part), getattr(cause, "message", str(cause))
        elif kind == "literal_error":
            yield path, f"{given} is not allowed; it must be {context['expected']}"
        elif kind == "string_type":
            yield path, f"{given} is not a text; put it in quotes"
        elif kind == "string_too_short":
            yield path, f"the text is empty{_about(where, section_at)}"
        elif kind == "bool_type":
            yield path, f"{given} is not allowed; it must be true or false"
        elif kind in ("model_type", "dict_type"):
            said = given.lower() if isinstance(fault["input"], bool) else given  # as TOML spells it
            section = section_at(where)
            yield path, f"{said} is not a table" + (f"; it takes {', '.join(section.model_fields)}" if section else "")
        elif kind in ("tuple_type", "list_type") and isinstance(fault["input"], Mapping):
            yield path, f"this is one table, and it must be a list of tables; write [[{path}]] above each"
        elif kind in ("tuple_type", "too_long", "too_short"):
            about = _about(where, section_at).removeprefix(": ")
            yield path, f"{given} does not have the right number of values" + (f"; it takes {about}" if about else "")
        else:
            yield path, f"{given} is not allowed; {fault['msg'].replace('Input should', 'it must')}"


def _is_misspelt(missing: tuple[int | str, ...], unknown: list[tuple[int | str, ...]]) -> bool:
    """Return whether one of the unknown keys is close to a missing one of the same table."""
    return any(one[:-1] == missing[:-1] and did_you_mean(str(one[-1]), [str(missing[-1])]) for one in unknown)


def _of_a_text(loc: tuple[int | str, ...]) -> bool:
    """Return whether the last part of a location is the string alternative of a union, plain or with a validator."""
    return bool(loc) and (loc[-1] == "str" or str(loc[-1]).endswith(", str]"))


def _is_branch(part: str) -> bool:
    """Return whether a part of a location is the label that pydantic gives to an alternative of a union."""
    return part.startswith(("literal[", "constrained-", "function-", "tuple[", "nullable"))


def _about(where: tuple[str, ...], section_at: SectionAt) -> str:
    """Return ": " and the description of a field; "" if it has none."""
    section = section_at(where[:-1])
    field = section.model_fields.get(where[-1]) if section else None
    text = (field.description or "") if field else ""
    return f": {text}" if text else ""
