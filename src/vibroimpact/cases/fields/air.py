"""The key `drop.air`: what the sphere falls through."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, model_validator

from vibroimpact.cases.fields.fluid import read_fluid
from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section
from vibroimpact.dynamics.fluids.air import AIR_DENSITY, AIR_VISCOSITY, Air
from vibroimpact.errors import InputError
from vibroimpact.ranges import Range


class AirTable(Section):
    """Air at rest, whose drag slows the sphere down in flight."""

    density: Annotated[float, Quantity("kg/m^3", "density of the air", Range(above=0))] = (
        AIR_DENSITY
    )
    viscosity: (
        Annotated[
            float, Quantity("Pa*s", "viscosity of the air; by default that at 20 C", Range(above=0))
        ]
        | None
    ) = None
    drag_coefficient: (
        Annotated[
            float,
            Quantity(
                "",
                "constant drag coefficient, in place of that of the Reynolds number",
                Range(above=0),
            ),
        ]
        | None
    ) = None

    @model_validator(mode="before")
    @classmethod
    def _viscosity_or_coefficient(cls, table: Any) -> Any:
        if isinstance(table, dict) and {"viscosity", "drag_coefficient"} <= table.keys():
            raise InputError(
                "a constant drag coefficient does not depend on the viscosity; "
                "leave one of them out",
                "drag_coefficient",
            )
        if isinstance(table, dict) and "drag_coefficient" not in table:
            return {"viscosity": AIR_VISCOSITY, **table}
        return table

    def air(self) -> Air:
        """Return the air."""
        return Air(**self.model_dump(exclude_none=True))


AirField = Annotated[
    AirTable | None,
    BeforeValidator(lambda value: read_fluid(AirTable, value)),
    JsonSchema(
        "drag of the air in flight: true for air at 20 C and sea level, or its numbers; "
        "none by default",
        lambda: {"anyOf": [{"type": "boolean"}, AirTable.model_json_schema()]},
    ),
]
