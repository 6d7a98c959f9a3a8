"""The case file, version 1: every key, its unit and its range."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, StrictBool, model_validator

from vibroimpact.bodies.ball import INERTIA_RATIOS
from vibroimpact.calibration.section import CalibrateSection
from vibroimpact.cases.fields.air import AirField
from vibroimpact.cases.fields.contact import ContactSection, read_contact
from vibroimpact.cases.fields.damping import DampingField
from vibroimpact.cases.fields.elastic_body import (
    BroughtMeshTable,
    FrequencyField,
    MethodField,
    ModesField,
    PlateMeshField,
    SphereMeshField,
    check_ball,
    check_elastic,
    check_plate,
    check_sphere_below,
)
from vibroimpact.cases.fields.instruments import (
    INSTRUMENTS,
    AccelerometerTable,
    AmplifierTable,
    ConverterTable,
    ForceTable,
    GeophoneTable,
    MicrophoneTable,
    StrainGaugeTable,
    read_in_unit,
)
from vibroimpact.cases.fields.material import MaterialField
from vibroimpact.cases.fields.plate_motion import MotionTable
from vibroimpact.cases.fields.quantities import Quantity, UncertainQuantity
from vibroimpact.cases.fields.section import Section, check_alternatives
from vibroimpact.cases.fields.size_limits import MOST_ITEMS, Name, at_most
from vibroimpact.cases.fields.supports import SupportsField
from vibroimpact.cases.wrong_units.lengths import likely_lengths
from vibroimpact.dynamics.air import AIR_DENSITY
from vibroimpact.dynamics.problem import MOST_IMPACTS, STANDARD_GRAVITY
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.force_sensor import ForceSensor
from vibroimpact.dynamics.sensors.instruments.instrument import MOTIONS, Instrument
from vibroimpact.dynamics.sensors.instruments.microphone import Microphone
from vibroimpact.dynamics.sensors.instruments.strain_gauge import StrainGauge
from vibroimpact.dynamics.sensors.sensor import FILTERS, Sensor
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.materials import RIGID
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range
from vibroimpact.studies.section import SweepSection

_RIGHT_ANGLE = 0.5 * math.pi


class SphereSection(Section):
    """The body that falls."""

    radius: Annotated[float, UncertainQuantity("m", "radius", Range(above=0))]
    material: MaterialField
    mass: (
        Annotated[
            float,
            Quantity(
                "kg",
                "mass of a ball that is hollow or filled; by default that of a solid one",
                Range(above=0),
            ),
        ]
        | None
    ) = None
    inertia: Annotated[
        Any, Quantity("kg m^2", "moment of inertia", Range(above=0), words=tuple(INERTIA_RATIOS))
    ] = Field(
        None,
        description='moment of inertia about an axis through the centre [kg m^2], "solid" '
        "(default) or "
        '"hollow"',
    )
    model: Literal["rigid", "elastic"] = Field(
        "rigid", description="rigid, or elastic with vibration modes"
    )
    modes: ModesField | None = Field(None, description="number of modes, from the lowest")
    max_frequency: FrequencyField | None = None
    damping: DampingField = None
    mesh: SphereMeshField = None
    reduction: MethodField | None = Field(
        None, description="model reduction of the finite elements; modal by default"
    )
    attachment_mode: StrictBool = Field(
        False, description="add a residual attachment mode at the contact point"
    )

    @model_validator(mode="before")
    @classmethod
    def _check_size(cls, table: Any) -> Any:
        if isinstance(table, Mapping) and "diameter" in table:
            raise InputError("give radius, half the diameter, in its place", "diameter")
        return table

    @model_validator(mode="after")
    def _check_body(self) -> SphereSection:
        if self.material is RIGID:
            lack = "no modulus, and the sphere needs one"
            if self.mass is None:
                lack = "no density, and the sphere needs a mass"
            raise InputError(f'"rigid" has {lack}; only the plate can be rigid', "material")
        check_ball(self)
        check_elastic(self)
        return self


class PlateSection(Section):
    """What the sphere falls on: a plate, or another sphere; held fixed, or free."""

    material: MaterialField
    radius: (
        Annotated[float, Quantity("m", "radius of a sphere in place of the plate", Range(above=0))]
        | None
    ) = None
    size: (
        tuple[
            Annotated[float, Quantity("m", "length", Range(above=0))],
            Annotated[float, Quantity("m", "width", Range(above=0))],
            Annotated[float, Quantity("m", "thickness", Range(above=0))],
        ]
        | None
    ) = Field(None, description="length (x), width (y) and thickness (z) [m]")
    model: Literal["rigid", "elastic"] = Field(
        "rigid", description="rigid, or elastic with vibration modes"
    )
    element: Literal["plate", "solid"] | None = Field(
        None,
        description="type of the finite elements of an elastic plate; plate elements by default",
    )
    modes: ModesField | None = Field(None, description="number of modes, from the lowest")
    max_frequency: FrequencyField | None = None
    damping: DampingField = None
    supports: SupportsField = None
    inclination: (
        Annotated[
            float,
            Quantity(
                "rad",
                "inclination about y, with a component of gravity along +x",
                Range(above=-_RIGHT_ANGLE, below=_RIGHT_ANGLE),
            ),
        ]
        | None
    ) = None
    motion: MotionTable | None = Field(
        None, description="motion of the supports; at rest by default"
    )
    mesh: PlateMeshField = None
    reduction: MethodField | None = Field(
        None, description="model reduction of the finite elements; modal by default"
    )
    attachment_mode: StrictBool = Field(
        False, description="add a residual attachment mode at the contact point"
    )

    @model_validator(mode="before")
    @classmethod
    def _check_sides(cls, table: Any) -> Any:
        for side in ("thickness", "length", "width"):
            if isinstance(table, Mapping) and side in table:
                raise InputError(
                    'give size = ["600 mm", "400 mm", "10 mm"] (length, width, thickness), or with '
                    f"--set plate.size.{side}",
                    side,
                )
        return table

    @model_validator(mode="after")
    def _check_body(self) -> PlateSection:
        check_elastic(self)
        check_plate(self)
        return self


class DropSection(Section):
    """How the sphere comes down: from a height, or with a speed or velocity at first touch."""

    height: (
        Annotated[
            float,
            UncertainQuantity(
                "m",
                "initial height of the sphere's centre above the plate's upper surface, at "
                "rest unless velocity is given",
                Range(above=0),
            ),
        ]
        | None
    ) = None
    speed: (
        Annotated[
            float,
            UncertainQuantity(
                "m/s", "speed at first touch, at which the run then begins", Range(above=0)
            ),
        ]
        | None
    ) = None
    angle: (
        Annotated[
            float,
            Quantity(
                "rad",
                "angle of the speed from the plate's normal, towards +x",
                Range(above=-_RIGHT_ANGLE, below=_RIGHT_ANGLE),
            ),
        ]
        | None
    ) = None
    velocity: (
        tuple[
            Annotated[float, Quantity("m/s", "x")],
            Annotated[float, Quantity("m/s", "y")],
            Annotated[float, Quantity("m/s", "z")],
        ]
        | None
    ) = Field(
        None,
        description="velocity along x, y and the normal z, upwards, at the start: at the "
        "height, or at first touch [m/s]",
    )
    spin: (
        tuple[
            Annotated[float, Quantity("rad/s", "x")],
            Annotated[float, Quantity("rad/s", "y")],
            Annotated[float, Quantity("rad/s", "z")],
        ]
        | None
    ) = Field(None, description="angular velocity about x, y and z at the start [rad/s]")
    position: tuple[Annotated[float, Quantity("m", "x")], Annotated[float, Quantity("m", "y")]] = (
        Field((0.0, 0.0), description="x and y on the plate, from its centre [m]")
    )
    gravity: Annotated[
        float, UncertainQuantity("m/s^2", "acceleration of gravity", Range(at_least=0))
    ] = STANDARD_GRAVITY
    air: AirField = None
    same_spot: StrictBool = Field(
        True,
        description="whether all impacts are at the same spot, with the dent of previous ones, or "
        "on undeformed surfaces",
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> DropSection:
        if self.velocity is None:
            check_alternatives(self, "height", "speed", needed=True)
        elif self.speed is not None:
            raise InputError("give either speed or velocity; both are given")
        elif self.height is None and self.velocity[2] >= 0.0:
            raise InputError(
                f"its z is {self.velocity[2]:g} m/s, which does not lead to the plate; at first "
                "touch it is negative, or give the height at which the drop starts",
                "velocity",
            )
        if self.angle is not None and self.speed is None:
            stated = " and ".join(
                key for key in ("height", "velocity") if getattr(self, key) is not None
            )
            raise InputError(
                f"an angle needs the speed at first touch; give speed in place of {stated}, "
                "or leave this out",
                "angle",
            )
        return self


def _read_impacts(value: Any) -> Any:
    """Return a valid number of impacts, "all" or None."""
    if value is None or value == "all" or (type(value) is int and 1 <= value <= MOST_IMPACTS):
        return value
    raise InputError(
        f"{quoted(value)} is not allowed; it must be a whole number from 1 to "
        f'{MOST_IMPACTS}, or "all" to continue until rest'
    )


_MEASURED_BY = {"strain": "strain-gauge", "pressure": "microphone", "force": "force"}
"""Instruments by the quantity that no other measures."""

_WITH_PROPERTIES = ("geophone", "microphone")
"""Instruments that need a table."""

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


class SensorSection(Section):
    """A sensor at a point of the plate, or a microphone in the air."""

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
    instrument: Annotated[
        Literal["accelerometer", "geophone", "strain-gauge", "microphone", "force"] | None,
        _one_of(INSTRUMENTS),
    ] = Field(
        None,
        description="type of the instrument; by default that of the table that is given, or "
        "else an ideal sensor of the motion",
    )
    quantity: (
        Literal[
            "acceleration", "velocity", "displacement", "voltage", "strain", "pressure", "force"
        ]
        | None
    ) = Field(
        None,
        description="measured quantity: acceleration by default, or the output of the instrument",
    )
    direction: Literal["x", "y", "z"] | tuple[_Part, _Part, _Part] = Field(
        "z",
        description='direction of measurement: "x", "y", "z" (upwards), or numbers along x, y and '
        "z; of "
        'a strain gauge "x" by default',
    )
    rate: Annotated[float, Quantity("Hz", "sampling rate", Range(above=0))] = 50e3
    filter: Annotated[Literal["sigma-delta", "butterworth", "none"], _one_of(FILTERS)] = Field(
        "sigma-delta", description="anti-alias filter"
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
    accelerometer: AccelerometerTable | None = Field(
        None, description="resonance, range, noise, resolution and sensitivity of an accelerometer"
    )
    geophone: GeophoneTable | None = Field(
        None, description="natural frequency, sensitivity, damping and low-pass of a geophone"
    )
    strain_gauge: StrainGaugeTable | None = Field(None, description="sensitivity of a strain gauge")
    force: ForceTable | None = Field(
        None,
        description="sensitivity of a force sensor between the plate and the support at the "
        "position",
    )
    microphone: MicrophoneTable | None = Field(
        None, description="distance and sensitivity of a microphone, and its air"
    )
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
        instrument = self._instrument()
        if isinstance(instrument, StrainGauge):
            self._lay_in_face()
        if isinstance(instrument, Microphone) and self.direction not in ("z", (0.0, 0.0, 1.0)):
            raise InputError(
                "a microphone is omnidirectional; leave out the direction", "direction"
            )
        if instrument is None and self.quantity not in (None, *MOTIONS):
            likely = _MEASURED_BY.get(str(self.quantity), "geophone")
            example = f'instrument = "{likely}"'
            if likely in _WITH_PROPERTIES:  # which their table gives
                example = f"{likely} = {{ ... }}"
            raise InputError(
                f"{self.quantity} is the output of an instrument; name one, such as {example}",
                "quantity",
            )
        if instrument is not None and self.quantity not in (None, instrument.quantity):
            raise InputError(
                f"{INSTRUMENTS[str(self.instrument)]} measures {instrument.quantity}; leave out "
                f"quantity, or the {self.instrument}",
                "quantity",
            )
        sensor = self.sensor()  # raises if the filter does not take a corner frequency
        self.__dict__["quantity"] = sensor.quantity
        for name, table in (("amplifier", self.amplifier), ("converter", self.converter)):
            if table is not None:
                try:
                    read_in_unit(table, sensor.unit.replace("2", "^2"))
                except InputError as error:
                    raise InputError(error.message, f"{name}.{error.key}") from None
        return self

    def _lay_in_face(self) -> None:
        """Let a strain gauge lie along x where its direction is not given.

        Raises
        ------
        InputError
            If its direction leaves the face.
        """
        if "direction" not in self.model_fields_set:
            self.__dict__["direction"] = "x"
        elif self.direction == "z" or (not isinstance(self.direction, str) and self.direction[2]):
            raise InputError(
                'a strain gauge lies in the face; give a direction along it, such as "x" or '
                "[1, 1, 0]",
                "direction",
            )

    def _instrument(self) -> Instrument | None:
        """Return the instrument, which its table names where the key does not.

        None if the motion is read as it is.
        """
        tables = {name: getattr(self, name.replace("-", "_")) for name in INSTRUMENTS}
        stated = [name for name, table in tables.items() if table is not None]
        name: str | None = self.instrument or next(iter(stated), None)
        if name is None:
            return None
        self._check_one_instrument(name, stated)
        self.__dict__["instrument"] = name
        table = tables[name]
        if table is not None:
            instrument: Instrument = table.instrument()
            return instrument
        if name in _WITH_PROPERTIES:
            raise InputError(
                f"{INSTRUMENTS[name]} has properties; give them in a table {name} = {{ ... }}", name
            )
        ideal: dict[str, Instrument] = {
            "accelerometer": Accelerometer(),
            "strain-gauge": StrainGauge(),
            "force": ForceSensor(),
        }
        return ideal[name]

    def _check_one_instrument(self, name: str, stated: list[str]) -> None:
        """Raise InputError if a table is that of another instrument than the one of a name.

        `stated` are the instruments whose tables there are.
        """
        other = next((other for other in stated if other != name), None)
        if other is None:
            return
        remedy = f', or take instrument = "{other}"'
        if name in stated:
            table = name.replace("-", "_")
            remedy = f", or the table {table}" if self.instrument is None else ""
        raise InputError(
            f"its instrument is {INSTRUMENTS[name]}; leave out this table{remedy}",
            other.replace("-", "_"),
        )

    def sensor(self) -> Sensor:
        """Return the sensor, with its direction as a unit vector."""
        direction = self.direction
        if isinstance(direction, str):
            direction = _DIRECTIONS[direction]
        x, y, z = (component / math.hypot(*direction) for component in direction)
        instrument = self._instrument()
        quantity = self.quantity or ("acceleration" if instrument is None else instrument.quantity)
        return Sensor(
            self.name,
            quantity,
            (x, y, z),
            self.rate,
            instrument,
            self.filter,
            self.corner,
            amplifier=None if self.amplifier is None else self.amplifier.amplifier(),
            converter=None if self.converter is None else self.converter.converter(),
        )


class RunSection(Section):
    """When to stop, and how exact to be."""

    impacts: Annotated[int | Literal["all"] | None, BeforeValidator(_read_impacts)] = Field(
        None,
        description='number of impacts after which the run ends; "all": until rest; by default 5, '
        "or all if a duration or a motion ends it",
    )
    duration: (
        Annotated[float, Quantity("s", "time at which the run ends", Range(above=0))] | None
    ) = None
    rest_speed: (
        Annotated[
            float,
            Quantity(
                "m/s", "separation speed below which the sphere is at rest", Range(at_least=0)
            ),
        ]
        | None
    ) = None
    tolerance: Annotated[
        float,
        Quantity(
            "",
            "relative error allowed in the state at the end of a contact",
            Range(at_least=1e-13, at_most=1e-6),
        ),
    ] = 1e-9


SECTIONS: dict[str, type[Section]] = {
    "sphere": SphereSection,
    "plate": PlateSection,
    "drop": DropSection,
    "run": RunSection,
}
"""The sections of a case that are there once and have fixed keys."""


def _whole_number(value: Any) -> Any:
    if isinstance(value, bool):  # true equals 1 in Python
        raise InputError(f"{quoted(value)} is no version; write 1")
    return value


class CaseTable(Section):
    """A case as a file has it: its sections, validated, in SI."""

    schema_version: Annotated[Literal[1], BeforeValidator(_whole_number)] = Field(
        1, description="version of this format"
    )
    name: Name = Field("", description="title of the case")
    sphere: SphereSection
    plate: PlateSection
    drop: DropSection
    contact: Annotated[ContactSection, BeforeValidator(read_contact)]
    run: RunSection = RunSection()
    sensors: Annotated[tuple[SensorSection, ...], at_most(MOST_ITEMS, "sensors")] = Field(
        (), description="sensors on the plate"
    )
    calibrate: CalibrateSection | None = Field(
        None, description="settings of `vibroimpact calibrate`"
    )
    sweep: SweepSection | None = Field(None, description="settings of `vibroimpact sweep`")

    @model_validator(mode="after")
    def _check_consistency(self) -> Self:
        """Check values of different sections against each other."""
        self._check_height()
        if self.plate.radius is not None:
            check_sphere_below(self)
        self._check_position()
        uses = Counter(sensor.name for sensor in self.sensors)
        for name, count in uses.items():
            if count > 1:
                raise InputError(
                    f"two sensors are called {quoted(name)}; each needs a name of its own",
                    "sensors",
                )
        # a microphone is in the air of the case unless it states its own
        for sensor in self.sensors:
            if sensor.microphone is not None and sensor.microphone.air_density is None:
                sensor.microphone.__dict__["air_density"] = (
                    AIR_DENSITY if self.drop.air is None else self.drop.air.density
                )
        return self

    def _check_height(self) -> None:
        """Raise InputError if the sphere does not fall from its height."""
        height = self.drop.height
        if height is None:
            return
        radius = self.sphere.radius
        if height <= radius:
            hint = likely_lengths([radius], [min(height, 3.0)]).replace(
                "Write", "Write sphere.radius ="
            )
            raise InputError(
                f"{height:g} m does not lift the sphere off the surface; it is the height "
                f"of its centre, so it must be greater than the radius, {radius:g} m{hint}",
                "drop.height",
            )
        if self.drop.gravity == 0:
            remedy = "leave out drop.height"
            if self.drop.velocity is None:
                remedy = "give drop.speed instead of drop.height"
            raise InputError(f"without gravity a sphere does not fall; {remedy}", "drop.gravity")

    def _check_position(self) -> None:
        """Raise InputError if the sphere falls beside the plate.

        The extent of an imported mesh is not known before it is read.
        """
        size = self.plate.size
        if not size or isinstance(self.plate.mesh, BroughtMeshTable):
            return
        half = [0.5 * length for length in size[:2]]
        x, y = self.drop.position
        if abs(x) > half[0] or abs(y) > half[1]:
            raise InputError(
                f"({x:g}, {y:g}) m lies outside the plate, which reaches to ({half[0]:g}, "
                f"{half[1]:g}) m{likely_lengths(self.drop.position, half)}",
                "drop.position",
            )
