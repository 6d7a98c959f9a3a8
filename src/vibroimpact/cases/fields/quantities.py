"""Quantity fields: a number in SI, or a string with a unit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, get_args

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range
from vibroimpact.units.quantity_text import number_and_unit
from vibroimpact.units.reading import to_si
from vibroimpact.units.written import Written, has_deviation, read_written, without_deviation

SMALLEST = 1e-50
"""Smallest magnitude of a nonzero quantity in SI, whose square does not underflow."""

LARGEST = 1e50
"""Largest magnitude of a quantity in SI, whose square does not overflow."""


def read_quantity(value: Any, unit: str, allowed: Range) -> float:
    """Return the value of a quantity in SI after checking its range.

    Raises
    ------
    InputError
        If it can't be read, or lies outside its range.

    Examples
    --------
    >>> read_quantity("25 mm", "m", Range(above=0))
    0.025
    """
    if has_deviation(value):
        keys = "drop.height, drop.speed, drop.gravity, sphere.radius and material.density"
        raise InputError(
            f"{quoted(value, 80)}: a standard deviation, for the intervals of a calibration, may "
            f'stand at {keys} alone; write "{without_deviation(value)}"'
        )
    try:
        number = to_si(value, unit)
    except InputError:
        _check_remedy(value, unit, allowed)
        raise
    _check(number, value, unit, allowed)
    return number


def _check_remedy(value: Any, unit: str, allowed: Range) -> None:
    """Check the number of a text that lacks its unit, or has one where none belongs.

    Only one in range is worth being written otherwise.
    """
    parts = number_and_unit(value) if isinstance(value, str) else None
    if parts is not None and not (unit and parts[1]):
        number = parts[0] / 100.0 if parts[1] == "%" else parts[0]
        _check(number, value, unit, allowed)


def _check(number: float, value: Any, unit: str, allowed: Range) -> None:
    """Check that a number can be computed with, and is in its range."""
    if number and not SMALLEST <= abs(number) <= LARGEST:
        limits = f"from {SMALLEST:g} to {LARGEST:g} {unit}".rstrip()
        raise InputError(
            f"{quoted(value)} is beyond what can be computed; a magnitude that "
            f"is not 0 lies {limits}"
        )
    allowed.check(number, unit, quoted(value, 80))


@dataclass(frozen=True)
class Quantity:
    """Annotation of a quantity field with its SI unit, meaning and range.

    From it pydantic validates the field and makes its JSON schema. `words` may stand in place of a
    value, and are left as they are.
    """

    unit: str
    meaning: str
    allowed: Range = Range()
    words: tuple[str, ...] = ()

    def read(self, value: Any) -> Any:
        """Return a value in SI, or one of the words.

        Raises
        ------
        InputError
            If it can't be read, or lies outside its range.

        Examples
        --------
        >>> mass = Quantity("kg", "mass", Range(above=0), words=("light",))
        >>> mass.read("2.7 g"), mass.read("light")
        (0.0027, 'light')
        """
        if not (self.words and isinstance(value, str) and value.strip()[:1].isalpha()):
            return read_quantity(value, self.unit, self.allowed)
        if value not in self.words:
            known = " or ".join(f'"{word}"' for word in self.words)
            raise InputError(
                f"{quoted(value)} is not allowed; it must be {known}, or a {self.meaning} with "
                f"its unit [{self.unit}].{did_you_mean(value, self.words)}"
            )
        return value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        number = quantity_schema(self.unit, self.meaning)
        if not self.words:
            return number
        return {
            "anyOf": [{"enum": list(self.words)}, number],
            "description": number["description"],
        }


@dataclass(frozen=True)
class UncertainQuantity(Quantity):
    """Annotation of a quantity with which a measurement is evaluated.

    A text may have a standard deviation, "0.6 m +- 5 mm".
    """

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(
            lambda value: read_uncertain(value, self.unit, self.allowed)
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return quantity_schema(
            self.unit,
            f"{self.meaning}; for a calibration its standard deviation may be added, as in "
            '"... +- 1 %"',
        )


def read_uncertain(value: Any, unit: str, allowed: Range) -> Written:
    """Return the value of a quantity in SI after checking its range, with its standard deviation.

    Raises
    ------
    InputError
        If it can't be read, or lies outside its range.

    Examples
    --------
    >>> read_uncertain("0.6 m +- 5 mm", "m", Range(above=0)).deviation
    0.005
    """
    if isinstance(value, Written):
        return value
    nominal = value
    if has_deviation(value):
        nominal = without_deviation(value)
    read_quantity(nominal, unit, allowed)  # for its range
    return read_written(value, unit)


def quantity_schema(unit: str, description: str) -> dict[str, Any]:
    """Return the JSON schema of a quantity."""
    if not unit:
        return {"type": "number", "description": description}
    gravity = ""
    if unit in ("m/s^2", "V s^2/m"):
        gravity = ', in which "g" is standard gravity, 9.80665 m/s^2'
    return {
        "type": ["number", "string"],
        "description": f"{description} [{unit}]; a string carries its own unit{gravity}",
    }


def quantity_of(info: FieldInfo) -> Quantity | None:
    """Return the quantity of a field of a section; None if it is not one."""
    return quantity_among((info.annotation, *info.metadata))


def quantity_among(annotations: tuple[Any, ...]) -> Quantity | None:
    """Return the first quantity among annotations or nested in them."""
    for annotation in annotations:
        if isinstance(annotation, Quantity):
            return annotation
        inner = (*get_args(annotation), *getattr(annotation, "__metadata__", ()))
        quantity = quantity_among(inner)
        if quantity is not None:
            return quantity
    return None
