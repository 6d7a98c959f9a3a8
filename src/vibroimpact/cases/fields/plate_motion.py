"""The [plate.motion] table: a harmonic motion of the plate's supports, or a file with one."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, StrictBool, model_validator

from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section
from vibroimpact.cases.fields.size_limits import FileName
from vibroimpact.errors import InputError
from vibroimpact.ranges import Range


class MotionTable(Section):
    """How the supports of the plate move: harmonically, or as a file tells."""

    amplitude: (
        Annotated[float, Quantity("m", "amplitude of the motion", Range(at_least=0))] | None
    ) = None
    frequency: (
        Annotated[float, Quantity("Hz", "frequency of the motion", Range(above=0))] | None
    ) = None
    phase: Annotated[
        float,
        Quantity(
            "rad", "phase at the start; at 0 the plate passes its mean position along `direction`"
        ),
    ] = 0.0
    file: FileName | None = Field(
        None,
        description="CSV file of the motion over time: time, and displacement or acceleration, "
        "with their units",
    )
    columns: str | None = Field(
        None,
        description="columns of the file in place of its header, in order, such as "
        '"time=s,-,displacement=mm", with - for one left out',
    )
    repeat: StrictBool = Field(
        False, description="whether the file has one period of the motion, which repeats"
    )
    direction: tuple[
        Annotated[float, Quantity("", "x")],
        Annotated[float, Quantity("", "y")],
        Annotated[float, Quantity("", "z")],
    ] = Field(
        (0.0, 0.0, 1.0),
        description="direction of the motion along x, y and the normal z, of any length but 0",
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> MotionTable:
        needed = ("amplitude", "frequency")
        missing = [name for name in needed if getattr(self, name) is None]
        harmonic = [name for name in needed if name not in missing]
        if "phase" in self.model_fields_set:
            harmonic.append("phase")
        if self.file is not None and harmonic:
            raise InputError(
                f"give either a file or a harmonic motion; leave out {' and '.join(harmonic)}, "
                "or leave out this",
                "file",
            )
        if self.file is None and self.repeat:
            raise InputError(
                "only the motion of a file is repeated, and a harmonic motion repeats by "
                "itself; leave this out",
                "repeat",
            )
        if self.file is None and missing:
            raise InputError(f"this key needs {' and '.join(missing)}, or file in place of both")
        if self.file is None and self.columns is not None:
            raise InputError("only a file has columns; leave this out", "columns")
        if not any(self.direction):
            raise InputError(
                "a direction of length 0 is none; give one along x, y and z, such as [0, 0, 1]",
                "direction",
            )
        return self
