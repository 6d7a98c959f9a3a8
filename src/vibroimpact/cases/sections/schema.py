"""The case file, version 1: every key, its unit and its range."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, StrictBool, model_validator

from vibroimpact.bodies.ball import INERTIA_RATIOS
from vibroimpact.calibration.observed.section import CalibrateSection
from vibroimpact.cases.fields.air import AirField
from vibroimpact.cases.fields.contact import ContactSection, read_contact
from vibroimpact.cases.fields.damping import DampingField
from vibroimpact.cases.fields.elastic_body import (
    AccuracyField,
    AttachmentField,
    BroughtMeshTable,
    FrequencyField,
    ModesField,
    PlateMeshField,
    ReductionField,
    SphereMeshField,
    check_ball,
    check_elastic,
    check_plate,
    check_sphere_below,
)
from vibroimpact.cases.fields.material import MaterialField
from vibroimpact.cases.fields.plate_motion import MotionTable
from vibroimpact.cases.fields.quantities import Quantity, UncertainQuantity
from vibroimpact.cases.fields.section import Section, check_alternatives
from vibroimpact.cases.fields.sensor import SensorSection
from vibroimpact.cases.fields.size_limits import MOST_ITEMS, Name, at_most
from vibroimpact.cases.fields.supports import SupportsField
from vibroimpact.cases.wrong_units.lengths import likely_lengths
from vibroimpact.dynamics.fluids.air import AIR_DENSITY
from vibroimpact.dynamics.statement.problem import MOST_IMPACTS, Problem
from vibroimpact.dynamics.statement.tolerance import TOLERANCES
from vibroimpact.errors import InputError
from vibroimpact.materials import RIGID
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range
from vibroimpact.studies.planning.section import SweepSection

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
    modes: ModesField = None
    max_frequency: FrequencyField | None = None
    accuracy: AccuracyField | None = None
    damping: DampingField = None
    mesh: SphereMeshField = None
    reduction: ReductionField = None
    attachment_mode: AttachmentField = False

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
    modes: ModesField = None
    max_frequency: FrequencyField | None = None
    accuracy: AccuracyField | None = None
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
    reduction: ReductionField = None
    attachment_mode: AttachmentField = False

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
    ] = Problem.gravity
    air: AirField = None
    same_spot: StrictBool = Field(
        Problem.same_spot,
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


class RunSection(Section):
    """When to stop, and how exact to be."""

    impacts: Annotated[int | Literal["all"] | None, BeforeValidator(_read_impacts)] = Field(
        None,
        description='number of impacts after which the run ends; "all": until rest; by default '
        f"{Problem.impacts}, or all if a duration or a motion ends it",
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
            TOLERANCES,
        ),
    ] = Problem.tolerance


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
        self._fill_air()
        return self

    def _fill_air(self) -> None:
        """Let instruments be in the air of the case unless they state its density."""
        density = AIR_DENSITY if self.drop.air is None else self.drop.air.density
        for sensor in self.sensors:
            if sensor.table is None:
                continue
            stated = sensor.table.__dict__  # the table itself does not take another value
            if "air_density" in stated and stated["air_density"] is None:
                stated["air_density"] = density

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
