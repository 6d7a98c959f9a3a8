"""The key `contact.liquid`: what sphere and plate touch in."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator

from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section, read_table
from vibroimpact.dynamics.liquid import WATER_DENSITY, WATER_VISCOSITY, Liquid
from vibroimpact.errors import InputError
from vibroimpact.ranges import Range
from vibroimpact.shown import shown


class LiquidTable(Section):
    """A liquid at rest, whose film between the surfaces takes from the rebound."""

    density: Annotated[float, Quantity("kg/m^3", "density of the liquid", Range(above=0))] = WATER_DENSITY
    viscosity: Annotated[float, Quantity("Pa*s", "viscosity of the liquid", Range(above=0))] = WATER_VISCOSITY

    def liquid(self) -> Liquid:
        """Return the liquid."""
        return Liquid(**self.model_dump())


def liquid_words(table: Mapping[str, Any]) -> str:
    """Return what a resolved table of a liquid holds, in words."""
    return f"density {float(table['density']):.4g} kg/m3, viscosity {float(table['viscosity']):.4g} Pa s"


def _read_liquid(value: Any) -> LiquidTable | None:
    if value is None or isinstance(value, LiquidTable):
        return value
    if isinstance(value, bool):
        return read_table(LiquidTable, {}) if value else None
    if isinstance(value, dict):
        return read_table(LiquidTable, value)
    raise InputError(f"{shown(value)} is not allowed; it must be true, false, or a table with {', '.join(LiquidTable.model_fields)}")


LiquidField = Annotated[
    LiquidTable | None,
    BeforeValidator(_read_liquid),
    JsonSchema(
        "liquid around the impact, which takes from the rebound: true for water at 20 C, or its numbers; none by default",
        lambda: {"anyOf": [{"type": "boolean"}, LiquidTable.model_json_schema()]},
    ),
]
