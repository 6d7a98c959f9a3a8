"""The tables of a sensor's instrument and of the electronics behind it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from vibroimpact.cases.fields.quantities import Quantity, read_quantity
from vibroimpact.cases.fields.section import Section
from vibroimpact.dynamics.air import AIR_DENSITY
from vibroimpact.dynamics.sensors.electronics import Amplifier, Converter
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.force_sensor import ForceSensor
from vibroimpact.dynamics.sensors.instruments.geophone import Geophone
from vibroimpact.dynamics.sensors.instruments.instrument import Instrument
from vibroimpact.dynamics.sensors.instruments.microphone import Microphone
from vibroimpact.dynamics.sensors.instruments.strain_gauge import StrainGauge
from vibroimpact.errors import InputError
from vibroimpact.ranges import Range

INSTRUMENTS = {
    "accelerometer": "an accelerometer",
    "geophone": "a geophone",
    "strain-gauge": "a strain gauge",
    "microphone": "a microphone",
    "force": "a force sensor",
}
"""What instruments are called in a case, where the key of their table has "_" for "-",
and in a sentence.
"""

AT_REST = ("force", "microphone")
"""Instruments for plates whose supports are at rest."""
SPEED_OF_SOUND = 343.2  # m/s, of dry air at 20 C: sqrt(1.4 * 287.05 J/(kg K) * 293.15 K)
# m: the paths of sound to a closer point would take long to integrate, and no microphone is as
# small
_NEAREST = 1e-3

Seed = Annotated[int, Field(ge=0, strict=True)]


class AccelerometerTable(Section):
    """What an accelerometer adds to the acceleration of its base: its resonance, then its
    range; its noise and its steps.
    """

    resonance: (
        Annotated[float, Quantity("Hz", "mounted resonance frequency", Range(above=0))] | None
    ) = None
    damping_ratio: Annotated[
        float, Quantity("", "damping ratio of the resonance", Range(above=0))
    ] = 0.02
    range: (
        Annotated[
            float,
            Quantity("m/s^2", "measuring range: largest magnitude of its output", Range(above=0)),
        ]
        | None
    ) = None
    noise: Annotated[
        float,
        Quantity("m/s^2", "standard deviation of the noise in its samples", Range(at_least=0)),
    ] = 0.0
    resolution: (
        Annotated[float, Quantity("m/s^2", "resolution: step of its output", Range(above=0))] | None
    ) = None
    seed: Seed = Field(0, description="of the noise")
    sensitivity: (
        Annotated[
            float,
            Quantity(
                "V s^2/m", "voltage over acceleration; its output is then a voltage", Range(above=0)
            ),
        ]
        | None
    ) = None

    def instrument(self) -> Instrument:
        """Return the accelerometer."""
        return Accelerometer(**self.model_dump())


class GeophoneTable(Section):
    """A geophone: the voltage of a coil on a spring."""

    natural_frequency: Annotated[
        float, Quantity("Hz", "natural frequency of the coil on its spring", Range(above=0))
    ]
    sensitivity: Annotated[
        float,
        Quantity("V s/m", "voltage over velocity, far above the natural frequency", Range(above=0)),
    ]
    damping_ratio: Annotated[
        float, Quantity("", "damping ratio of the coil, with its shunt", Range(above=0))
    ] = 0.6
    low_pass: (
        Annotated[
            float,
            Quantity("Hz", "corner frequency of a second-order low-pass after it", Range(above=0)),
        ]
        | None
    ) = None

    def instrument(self) -> Instrument:
        """Return the geophone."""
        return Geophone(**self.model_dump())


class StrainGaugeTable(Section):
    """A strain gauge on a face of the plate, along a direction in it."""

    sensitivity: (
        Annotated[
            float,
            Quantity("V", "voltage over strain; its output is then a voltage", Range(above=0)),
        ]
        | None
    ) = None

    def instrument(self) -> Instrument:
        """Return the strain gauge."""
        return StrainGauge(**self.model_dump())


class MicrophoneTable(Section):
    """A microphone in the air beyond a face of the plate."""

    distance: Annotated[
        float, Quantity("m", "distance from the plane of the face", Range(at_least=_NEAREST))
    ]
    sensitivity: (
        Annotated[
            float,
            Quantity(
                "V/Pa", "voltage over sound pressure; its output is then a voltage", Range(above=0)
            ),
        ]
        | None
    ) = None
    air_density: (
        Annotated[
            float,
            Quantity(
                "kg/m^3",
                "density of the air; by default that of `drop.air`, or that at 20 C",
                Range(above=0),
            ),
        ]
        | None
    ) = None
    speed_of_sound: Annotated[
        float, Quantity("m/s", "speed of sound in the air; by default that at 20 C", Range(above=0))
    ] = SPEED_OF_SOUND

    def instrument(self) -> Instrument:
        """Return the microphone."""
        return Microphone(self.sensitivity, self.air_density or AIR_DENSITY)


class ForceTable(Section):
    """A force sensor between the plate and the support at its position."""

    sensitivity: (
        Annotated[
            float,
            Quantity("V/N", "voltage over force; its output is then a voltage", Range(above=0)),
        ]
        | None
    ) = None

    def instrument(self) -> Instrument:
        """Return the force sensor."""
        return ForceSensor(**self.model_dump())


@dataclass(frozen=True)
class _OfSignal:
    """Annotation of a quantity in the unit of the sensor's signal, which only the sensor
    knows: `in_unit` reads it.
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
        words = f"{self.meaning} [the unit of the sensor's output]; a string carries its own unit"
        return {"type": ["number", "string"], "description": words}


class AmplifierTable(Section):
    """An amplifier behind the instrument: gain, and noise and hum at its input."""

    gain: Annotated[float, Quantity("", "gain: output over input", Range(above=0))] = 1.0
    noise: Annotated[
        float, _OfSignal("standard deviation of white noise at its input", Range(at_least=0))
    ] = 0.0
    hum: Annotated[
        float,
        _OfSignal(
            "amplitude of the mains hum at its input, with a random phase", Range(at_least=0)
        ),
    ] = 0.0
    mains: Annotated[float, Quantity("Hz", "mains frequency", Range(above=0))] = 50.0
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
