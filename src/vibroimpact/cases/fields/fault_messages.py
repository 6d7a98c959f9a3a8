"""Error messages made from pydantic's validation errors: the key, what is wrong, and what
is allowed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.known_keys import field_at, keys_of, parts_of, section_at
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.errors import choices, did_you_mean, listed
from vibroimpact.quoting import quoted

_NO_SUCH_TYPE = ("string_type", "tuple_type", "list_type", "literal_error", "bool_type")
"""Errors of an alternative that takes another type of value."""

_WHOLE = (
    "int_type",
    "int_parsing",
    "int_parsing_size",
    "int_from_float",
    "greater_than_equal",
    "less_than_equal",
    "multiple_of",
)
"""Errors of whole numbers."""

_BOUNDS = ("ge", "le", "multiple_of")
"""Bounds of whole numbers, as pydantic calls them."""


class InvalidTable(ValueError):
    """The validation errors of a table in another one, raised while that is validated,
    and the section that the table should be.
    """

    def __init__(self, section: type[BaseModel], error: ValidationError) -> None:
        super().__init__(str(error))
        self.section = section
        self.error = error


def fault_messages(
    error: ValidationError, section: type[BaseModel], *, of_case: bool = False
) -> Iterator[tuple[str, str]]:
    """Yield the dotted key path and the message of each validation error of a section, or
    of a whole case.
    """
    faults = [_Fault(fault, section, of_case=of_case) for fault in error.errors()]
    misspelt = [
        (fault.path[:-1], fault.path[-1]) for fault in faults if fault.kind == "extra_forbidden"
    ]
    for fault in _by_value(faults):
        if fault.kind == "missing" and any(
            above == fault.path[:-1] and did_you_mean(key, [fault.path[-1]])
            for above, key in misspelt
        ):
            continue  # the unknown key is reported, with the one that was meant
        yield from fault.messages()


class _Fault:
    """A validation error: where it is, its kind, and the value that is wrong."""

    def __init__(self, fault: Any, section: type[BaseModel], *, of_case: bool) -> None:
        self.loc = tuple(str(part) for part in fault["loc"])
        self.path = tuple(part for part in self.loc if not _is_branch(part))
        self.kind: str = fault["type"]
        self.value: Any = fault["input"]
        self.context: dict[str, Any] = fault.get("ctx", {})
        self.section = section
        self.of_case = of_case

    @property
    def branch(self) -> int:
        """Number of the part of the location that names an alternative of a union; that
        of the parts if there is none.
        """
        return next(
            (number for number, part in enumerate(self.loc) if _is_branch(part)), len(self.loc)
        )

    @property
    def about(self) -> str:
        """What the field takes, in its own words; "" if it has none."""
        field = field_at(self.section, self.path)
        if field is None:
            return ""
        if field.description:
            return field.description
        return next(
            (_words(part) for part in parts_of(field) if isinstance(part, (Quantity, JsonSchema))),
            "",
        )

    @property
    def wanted(self) -> str:
        """What the value must be."""
        if self.kind == "literal_error":
            return str(self.context["expected"]).replace("'", '"')
        if self.kind == "string_type":
            return "a text in quotes"
        if self.kind in ("bool_type", "bool_parsing"):
            return "true or false"
        if self.kind in ("tuple_type", "list_type"):
            # the description of the field says of what
            return f"a list: {self.about}" if self.about else "a list"
        if self.kind in _WHOLE:
            field = field_at(self.section, self.path)
            if field is None:
                return _whole_number(())
            return _whole_number(parts_of(field))
        return self.about or "a value of another type"

    def messages(self) -> Iterator[tuple[str, str]]:
        """Yield the key path and the message; several of a table in the table."""
        path = ".".join(self.path)
        cause = self.context.get("error")
        if isinstance(cause, InvalidTable):
            prefix = f"{path}." if path else ""
            for key, text in fault_messages(cause.error, cause.section):
                yield prefix + key, text
        elif self.kind == "value_error":
            keys = [*self.path, getattr(cause, "key", "")]
            yield ".".join(key for key in keys if key), getattr(cause, "message", str(cause))
        elif self.kind == "missing" and self.path[-1].isdigit():
            yield ".".join(self.path[:-1]), f"there are too few values{_takes(self.about)}"
        else:
            yield path, self._message()

    def _message(self) -> str:
        given = quoted(self.value)
        if self.kind == "extra_forbidden":
            return self._unknown_key()
        if self.kind == "missing":
            what = "section" if self.of_case and len(self.path) == 1 else "key"
            return f"this {what} is missing{_which_is(self.about)}"
        if self.kind == "string_too_short":
            return f"the text is empty{_which_is(self.about)}"
        if self.kind in ("model_type", "model_attributes_type", "dict_type"):
            inside = section_at(self.section, self.path)
            taken = self.about
            if inside is not None:
                taken = listed(keys_of(inside))
            return f"{given} is not a table{_takes(taken)}"
        if self.kind in ("tuple_type", "list_type") and section_at(self.section, self.path):
            if isinstance(self.value, dict):
                is_one = "this is one table, and it must be"
            else:
                is_one = f"{given} is not allowed; it must be"
            return f"{is_one} a list of tables; write [[{'.'.join(self.path)}]] above each"
        if self.kind in ("tuple_type", "list_type"):
            return f"{given} is not a list{_takes(self.about)}"
        if self.kind in ("too_long", "too_short"):
            return f"{given} does not have the right number of values{_takes(self.about)}"
        if self.kind == "no_alternative":
            return f"{given} is not allowed; it takes {self.context['expected']}"
        if self.kind == "string_type" and isinstance(self.value, (bool, int, float)):
            return f"{given} is not a text; put it in quotes"
        fault = f"{given} is not allowed; it must be {self.wanted}"
        hint = ""
        if isinstance(self.value, str):
            # what must be one of several texts has them in quotes
            hint = did_you_mean(self.value, re.findall(r'"([^"]*)"', self.wanted))
        return f"{fault}.{hint}" if hint else fault

    def _unknown_key(self) -> str:
        above = self.path[:-1]
        key = self.path[-1]
        section = section_at(self.section, above)
        known = [] if section is None else keys_of(section)
        name = ".".join(part for part in above if not part.isdigit())
        place = "a case" if self.of_case else "it"
        if name and self.of_case:
            place = f"[[{name}]]" if above[-1].isdigit() else f"[{name}]"
        return f"unknown key {quoted(key)}; {place} takes {choices(known, key, 'schema')}"


def _by_value(faults: Sequence[_Fault]) -> Iterator[_Fault]:
    """Yield the faults, of a value with several alternatives only those of the one that
    was meant, or one in place of all.
    """
    done = set()
    for fault in faults:
        if fault.branch == len(fault.loc):
            yield fault
            continue
        place = fault.loc[: fault.branch]
        if place in done:
            continue
        done.add(place)
        yield from _meant(
            [
                sibling
                for sibling in faults
                if sibling.branch == fault.branch and sibling.loc[: fault.branch] == place
            ]
        )


def _meant(faults: Sequence[_Fault]) -> Sequence[_Fault]:
    """Return the faults of the alternative that suits the type of the value; if none
    does, one that names all.
    """
    inside = [fault for fault in faults if len(fault.loc) > fault.branch + 1]
    if inside:
        return inside
    of_value = [fault for fault in faults if fault.kind not in _NO_SUCH_TYPE]
    if of_value:
        return of_value[:1]
    first = faults[0]
    if len(faults) > 1:
        wanted = first.about or ", or ".join(dict.fromkeys(fault.wanted for fault in faults))
        first.kind = "no_alternative"
        first.context = {"expected": wanted}
    return [first]


def _is_branch(part: str) -> bool:
    """Return whether a part of a location is the label that pydantic gives to an
    alternative of a union, or to the key of a table.
    """
    return (
        part.startswith(("literal[", "constrained-", "function-", "tuple[", "nullable"))
        or part == "[key]"
    )


def _which_is(about: str) -> str:
    return f": {about}" if about else ""


def _takes(about: str) -> str:
    return f"; it takes {about}" if about else ""


def _words(annotation: Quantity | JsonSchema) -> str:
    if isinstance(annotation, JsonSchema):
        return annotation.description
    if annotation.unit:
        return f"{annotation.meaning} [{annotation.unit}]"
    return annotation.meaning


def _whole_number(parts: Iterable[Any]) -> str:
    """Return the whole numbers that a field takes, in words, from the parts of its annotation."""
    bounds = {
        bound: value
        for part in parts
        for bound in _BOUNDS
        if (value := getattr(part, bound, None)) is not None
    }
    least, most, multiple = (bounds.get(bound) for bound in _BOUNDS)
    kind = "a whole number" if multiple is None else f"a multiple of {multiple}"
    if least is None:
        return kind
    if most is None:
        return f"{kind}, at least {least}"
    return f"{kind} from {least} to {most}"
