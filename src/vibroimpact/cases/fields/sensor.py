"""A sensor of a case: its place, its instrument, and how it is sampled."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field, create_model, model_validator

from vibroimpact.cases.fields.instruments import (
    AmplifierTable,
    ConverterTable,
    instrument_fields,
    read_in_unit,
)
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section
from vibroimpact.cases.fields.size_limits import Name
from vibroimpact.dynamics.sensors.instruments.instrument import (
    MOTIONS,
    InstrumentInCase,
    Subject,
)
from vibroimpact.dynamics.sensors.instruments.instrument import Quantity as MeasuredQuantity
from vibroimpact.dynamics.sensors.instruments.registry import instruments
from vibroimpact.dynamics.sensors.instruments.sensor import DEFAULT_FILTER, FILTERS, Filter, Sensor
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

_DIRECTIONS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def _one_of(names: Collection[str]) -> BeforeValidator:
    """Return the check of a name, whose message has the likely one.

    A value that is no string is left to the type check of the field.
    """

    def read(value: Any) -> Any:
        if not isinstance(value, str) or value in names:
            return value
        known = ", ".join(f'"{name}"' for name in names)
        raise InputError(
            f"{quoted(value)} is not allowed; it must be one of "
            f"{known}.{did_you_mean(value, names)}"
        )

    return BeforeValidator(read)


_Part = Annotated[float, Quantity("", "part of a direction")]


if TYPE_CHECKING:
    InstrumentName = str
else:
    InstrumentName = Literal[tuple(instruments())]


class _SampledPoint(Section):
    """What a sensor has whatever its instrument: its place, and how it is sampled."""

    name: Name = Field(min_length=1, description="name of the sensor in tables and figures")
    position: (
        tuple[Annotated[float, Quantity("m", "x")], Annotated[float, Quantity("m", "y")]] | Name
    ) = Field(
        description="x and y on the plate, from its centre [m]; or the name of a set of an "
        "imported mesh"
    )
    face: Literal["upper", "lower"] = Field(
        "upper", description="the face of the plate that it is on, or that a microphone measures"
    )
    instrument: Annotated[InstrumentName | None, _one_of(instruments())] = Field(
        None,
        description="type of the instrument; by default that of the table that is given, or "
        "else an ideal sensor of the motion",
    )
    quantity: MeasuredQuantity | None = Field(
        None,
        description="measured quantity: acceleration by default, or the output of the instrument",
    )
    direction: Literal["x", "y", "z"] | tuple[_Part, _Part, _Part] = Field(
        "z",
        description='direction of measurement: "x", "y", "z" (upwards), or numbers along x, y and '
        "z; of "
        'a strain gauge "x" by default',
    )
    rate: Annotated[float, Quantity("Hz", "sampling rate", Range(above=0))] = Sensor.rate
    filter: Annotated[Filter, _one_of(FILTERS)] = Field(
        DEFAULT_FILTER, description="anti-alias filter"
    )
    corner: (
        Annotated[
            float,
            Quantity(
                "Hz",
                "corner frequency of a Butterworth filter; 0.4 of the rate by default",
                Range(above=0),
            ),
        ]
        | None
    ) = None


if TYPE_CHECKING:
    _WithTables = _SampledPoint  # the tables of instruments are reached by `table`
else:
    _WithTables = create_model("_WithTables", __base__=_SampledPoint, **instrument_fields())


class SensorSection(_WithTables):
    """A sensor at a point of the plate, or a microphone in the air."""

    amplifier: AmplifierTable | None = Field(
        None, description="gain, noise and mains hum of the amplifier"
    )
    converter: ConverterTable | None = Field(
        None, description="range and bits of the analogue-to-digital converter"
    )

    @model_validator(mode="after")
    def _check_sensor(self) -> SensorSection:
        if not isinstance(self.direction, str) and not any(self.direction):
            raise InputError(
                "it has no length; give x, y and z of the direction, such as [1, 0, 0]", "direction"
            )
        self._name_instrument()
        stated = self.instrument_in_case()
        if stated is None:
            self._check_motion()
        else:
            self._check_direction(stated)
            self._check_quantity(stated)
        sensor = self.sensor()  # raises if the filter does not take a corner frequency
        self.__dict__["quantity"] = sensor.quantity
        for name, table in (("amplifier", self.amplifier), ("converter", self.converter)):
            if table is not None:
                try:
                    read_in_unit(table, sensor.unit.replace("2", "^2"))
                except InputError as error:
                    raise InputError(error.message, f"{name}.{error.key}") from None
        return self

    def _name_instrument(self) -> None:
        """Name the instrument whose table is given, where the key `instrument` does not.

        Raises
        ------
        InputError
            If a table is that of another instrument than the one named, or the instrument has
            properties without which it is not known.
        """
        with_table = [
            kind for kind in instruments().values() if getattr(self, kind.key()) is not None
        ]
        kind = self._kind or next(iter(with_table), None)
        if kind is None:
            return
        self._check_one_instrument(kind, with_table)
        self.__dict__["instrument"] = kind.name
        if kind.needs_table() and kind not in with_table:
            raise InputError(
                f"{kind.noun} has properties; give them in a table {kind.name} = {{ ... }}",
                kind.name,
            )

    def _check_one_instrument(
        self, kind: type[InstrumentInCase], with_table: list[type[InstrumentInCase]]
    ) -> None:
        """Raise InputError if there is a table of another instrument than the one of this sensor.

        `with_table` are the instruments whose tables there are.
        """
        second_kind = next((stated for stated in with_table if stated is not kind), None)
        if second_kind is None:
            return
        if kind not in with_table:
            remedy = f', or take instrument = "{second_kind.name}"'
        elif self.instrument is None:
            remedy = f", or the table {kind.key()}"
        else:
            remedy = ""
        raise InputError(
            f"its instrument is {kind.noun}; leave out this table{remedy}", second_kind.key()
        )

    def _check_motion(self) -> None:
        """Check that the quantity is one of a motion, which needs no instrument.

        Raises
        ------
        InputError
            If it is the output of an instrument; the message names one.
        """
        if self.quantity in (None, *MOTIONS):
            return
        likely = next(kind for kind in instruments().values() if kind.measures == self.quantity)
        example = f'instrument = "{likely.name}"'
        if likely.needs_table():
            example = f"{likely.name} = {{ ... }}"
        raise InputError(
            f"{self.quantity} is the output of an instrument; name one, such as {example}",
            "quantity",
        )

    def _check_direction(self, stated: InstrumentInCase) -> None:
        """Let what measures strain lie along x where its direction is not given.

        Raises
        ------
        InputError
            If its direction leaves the face, or what measures sound has one.
        """
        if stated.subject == "sound" and self.direction not in ("z", (0.0, 0.0, 1.0)):
            raise InputError(
                f"{stated.noun} is omnidirectional; leave out the direction", "direction"
            )
        if stated.subject != "strain":
            return
        if "direction" not in self.model_fields_set:
            self.__dict__["direction"] = "x"
        elif self.direction == "z" or (not isinstance(self.direction, str) and self.direction[2]):
            raise InputError(
                f'{stated.noun} lies in the face; give a direction along it, such as "x" or '
                "[1, 1, 0]",
                "direction",
            )

    def _check_quantity(self, stated: InstrumentInCase) -> None:
        """Raise InputError if the instrument measures another quantity."""
        measured = stated.instrument().quantity
        if self.quantity not in (None, measured):
            raise InputError(
                f"{stated.noun} measures {measured}; leave out quantity, or the {stated.name}",
                "quantity",
            )

    @property
    def _kind(self) -> type[InstrumentInCase] | None:
        if self.instrument is None:
            return None
        return instruments()[self.instrument]

    @property
    def table(self) -> Section | None:
        """The table of its instrument; None if it has none."""
        table: Section | None = None
        if self._kind is not None:
            table = getattr(self, self._kind.key())
        return table

    def instrument_in_case(self) -> InstrumentInCase | None:
        """Return what the case says of its instrument; None if the motion is read as it is."""
        kind = self._kind
        if kind is None:
            return None
        if self.table is None:
            return kind()
        return kind(**self.table.model_dump())

    @property
    def subject(self) -> Subject:
        """What it is sensitive to."""
        return "motion" if self._kind is None else self._kind.subject

    def sensor(self) -> Sensor:
        """Return the sensor, with its direction as a unit vector."""
        direction = self.direction
        if isinstance(direction, str):
            direction = _DIRECTIONS[direction]
        x, y, z = (component / math.hypot(*direction) for component in direction)
        quantity: MeasuredQuantity = "acceleration"
        instrument = amplifier = converter = None
        stated = self.instrument_in_case()
        if stated is not None:
            instrument = stated.instrument()
            quantity = instrument.quantity
        if self.amplifier is not None:
            amplifier = self.amplifier.amplifier()
        if self.converter is not None:
            converter = self.converter.converter()
        return Sensor(
            self.name,
            self.quantity or quantity,
            (x, y, z),
            self.rate,
            instrument,
            self.filter,
            self.corner,
            amplifier=amplifier,
            converter=converter,
        )
