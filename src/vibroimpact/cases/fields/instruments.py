"""The tables of a sensor's instrument and of the electronics behind it."""

from __future__ import annotations

import inspect
from dataclasses import MISSING, dataclass, fields
from dataclasses import Field as DataclassField
from typing import Annotated, Any

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, create_model
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from vibroimpact.cases.fields.quantities import Quantity, read_quantity
from vibroimpact.cases.fields.section import Section
from vibroimpact.dynamics.sensors.instruments.electronics import Amplifier, Converter
from vibroimpact.dynamics.sensors.instruments.instrument import InstrumentInCase
from vibroimpact.dynamics.sensors.instruments.registry import instruments
from vibroimpact.errors import InputError
from vibroimpact.ranges import Range
from vibroimpact.registry import class_named

Seed = Annotated[int, Field(ge=0, strict=True)]


def _table_of(kind: type[InstrumentInCase]) -> type[Section]:
    """Return the section of a case for the table of an instrument."""
    title = "".join(word.capitalize() for word in kind.name.split("-"))
    description = (inspect.getdoc(kind) or "").split("\n\n")[0]
    keys: dict[str, Any] = {item.name: _field_of(item) for item in fields(kind)}
    return create_model(
        f"{title}Table", __base__=Section, __module__=__name__, __doc__=description, **keys
    )


def _field_of(item: DataclassField[Any]) -> tuple[Any, Any]:
    """Return annotation and default of a property of an instrument, as pydantic takes them."""
    meaning = item.metadata["meaning"]
    allowed = item.metadata["range"]
    if item.name == "seed":
        return Seed, Field(item.default, description=meaning)
    annotation = Annotated[float, Quantity(item.metadata["unit"], meaning, allowed)]
    if item.default is MISSING:
        return annotation, ...
    if item.default is None:
        return annotation | None, None
    return annotation, item.default


TABLES = {kind.key(): _table_of(kind) for kind in instruments().values()}
"""The sections of the tables of instruments, by the keys of these in a sensor."""


def __getattr__(name: str) -> type[Section]:
    return class_named(TABLES, name, __name__)  # as a pickled case asks for them


def instrument_fields() -> dict[str, tuple[Any, Any]]:
    """Return the fields of a sensor for the tables of instruments, those on the plate first."""
    kinds = sorted(instruments().values(), key=lambda kind: kind.subject == "sound")
    return {
        kind.key(): (TABLES[kind.key()] | None, Field(None, description=kind.properties))
        for kind in kinds
    }


@dataclass(frozen=True)
class _OfSignal:
    """Annotation of a quantity in the unit of the sensor's signal, which only the sensor
    knows: `read_in_unit` reads it.
    """

    meaning: str
    allowed: Range

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.any_schema()

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        phrase = f"{self.meaning} [the unit of the sensor's output]; a string carries its own unit"
        return {"type": ["number", "string"], "description": phrase}


class AmplifierTable(Section):
    """An amplifier behind the instrument: gain, and noise and hum at its input."""

    gain: Annotated[float, Quantity("", "gain: output over input", Range(above=0))] = Amplifier.gain
    noise: Annotated[
        float, _OfSignal("standard deviation of white noise at its input", Range(at_least=0))
    ] = Amplifier.noise
    hum: Annotated[
        float,
        _OfSignal(
            "amplitude of the mains hum at its input, with a random phase", Range(at_least=0)
        ),
    ] = Amplifier.hum
    mains: Annotated[float, Quantity("Hz", "mains frequency", Range(above=0))] = Amplifier.mains
    seed: Seed = Field(0, description="of the noise and of the hum's phase")

    def amplifier(self) -> Amplifier:
        """Return the amplifier."""
        return Amplifier(**self.model_dump())


class ConverterTable(Section):
    """An analogue-to-digital converter, which clips and rounds."""

    range: Annotated[float, _OfSignal("range: largest magnitude of its input", Range(above=0))]
    bits: Annotated[int, Field(ge=1, le=32, strict=True)] | None = Field(
        None, description="its width; unrounded by default"
    )

    def converter(self) -> Converter:
        """Return the converter."""
        return Converter(**self.model_dump())


def quantity_in_unit(info: FieldInfo, unit: str) -> Quantity | None:
    """Return the quantity of a field in the unit of the signal; None if it is not one."""
    return next(
        (
            Quantity(unit, kind.meaning, kind.allowed)
            for kind in info.metadata
            if isinstance(kind, _OfSignal)
        ),
        None,
    )


def read_in_unit(table: Section, unit: str) -> None:
    """Read the quantities of a table that are in the unit of the signal, in place.

    Raises
    ------
    InputError
        With the key of one that can't be read, or lies outside its range.
    """
    for name, info in type(table).model_fields.items():
        for kind in info.metadata:
            if isinstance(kind, _OfSignal):
                try:
                    table.__dict__[name] = read_quantity(table.__dict__[name], unit, kind.allowed)
                except InputError as error:
                    raise InputError(error.message, name) from None
