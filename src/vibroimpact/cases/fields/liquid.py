"""The key `contact.liquid`: what sphere and plate are in."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator

from vibroimpact.cases.fields.fluid import read_fluid
from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section
from vibroimpact.dynamics.fluids.liquid import WATER_DENSITY, WATER_VISCOSITY, Liquid
from vibroimpact.ranges import Range


class LiquidTable(Section):
    """A liquid at rest, through which the sphere falls, and whose film between the
    surfaces takes from the rebound.
    """

    density: Annotated[float, Quantity("kg/m^3", "density of the liquid", Range(above=0))] = (
        WATER_DENSITY
    )
    viscosity: Annotated[float, Quantity("Pa*s", "viscosity of the liquid", Range(above=0))] = (
        WATER_VISCOSITY
    )

    def liquid(self) -> Liquid:
        """Return the liquid."""
        return Liquid(**self.model_dump())


LiquidField = Annotated[
    LiquidTable | None,
    BeforeValidator(lambda value: read_fluid(LiquidTable, value)),
    JsonSchema(
        "liquid around sphere and plate, which slows the fall and reduces the rebound: true "
        "for water at 20 C, or its numbers; none by default",
        lambda: {"anyOf": [{"type": "boolean"}, LiquidTable.model_json_schema()]},
    ),
]
