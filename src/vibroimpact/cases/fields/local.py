"""The keys of the [contact] section that combine the local deformation of elastic bodies
with the contact law.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictBool, model_validator

from vibroimpact.cases.fields.liquid import LiquidField
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section
from vibroimpact.errors import InputError
from vibroimpact.ranges import Range


class MeasuredImpact(Section):
    """The largest force and the rebound of one impact, from the drop of the case."""

    max_force: Annotated[float, Quantity("N", "largest contact force", Range(above=0))]
    rebound_height: (
        Annotated[
            float,
            Quantity(
                "m",
                "height of the sphere's centre above the plate at the top of the rebound",
                Range(above=0),
            ),
        ]
        | None
    ) = None
    separation_speed: (
        Annotated[float, Quantity("m/s", "speed after the impact", Range(above=0))] | None
    ) = None
    restitution: (
        Annotated[float, Quantity("", "speed after over speed before", Range(above=0, below=1))]
        | None
    ) = None
    relative_deviation: (
        Annotated[
            float,
            Quantity(
                "",
                "relative standard deviation of the force, and of the rebound",
                Range(above=0, below=1),
            ),
        ]
        | None
    ) = None
    plate: Literal["as here", "rigid"] = Field(
        "as here", description="plate of the measurement: the plate of the case, or a rigid one"
    )

    @model_validator(mode="after")
    def _check_rebound(self) -> MeasuredImpact:
        given = [
            key
            for key in ("rebound_height", "separation_speed", "restitution")
            if getattr(self, key) is not None
        ]
        if len(given) != 1:
            raise InputError(
                "give one of rebound_height, separation_speed and restitution, not "
                f"{' and '.join(given) or 'none'}"
            )
        return self


class LocalSection(Section):
    """What of the [contact] section is not of the law itself."""

    local_compliance: Literal["consistent", "superposed", "identified"] | None = Field(
        None,
        description="treatment of local indentation with elastic bodies; consistent by default",
    )
    local_stiffness: (
        Annotated[
            float, Quantity("N/m", "spring of the local element of identified", Range(above=0))
        ]
        | None
    ) = None
    local_damping: (
        Annotated[
            float, Quantity("N s/m", "dashpot of the local element of identified", Range(above=0))
        ]
        | None
    ) = None
    liquid: LiquidField = None
    finite_sphere: StrictBool = Field(
        False, description="correct Hertz's half space for the finite size of a rigid sphere"
    )
    measured: MeasuredImpact | None = Field(
        None,
        description="measurement from which stiffness and damping of the local element are "
        "identified",
    )

    @model_validator(mode="after")
    def _check_keys(self) -> LocalSection:
        keys = ("local_stiffness", "local_damping", "measured")
        given = [key for key in keys if getattr(self, key) is not None]
        if self.local_compliance != "identified" and given:
            raise InputError('only local_compliance = "identified" takes it', given[0])
        if self.local_compliance == "identified" and given not in (
            ["local_stiffness", "local_damping"],
            ["measured"],
        ):
            raise InputError(
                '"identified" needs either local_stiffness and local_damping, or measured = '
                "{ max_force, rebound_height }, from which they follow",
                "local_compliance",
            )
        if self.local_compliance == "identified" and self.finite_sphere:
            raise InputError(
                'the local element of "identified" represents the whole deformation of the '
                "sphere beyond the law; leave this out",
                "finite_sphere",
            )
        return self
