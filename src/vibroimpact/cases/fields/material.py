"""The material field: the name of a material of the library, or its properties."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

from pydantic import BeforeValidator

from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.quantities import Quantity, UncertainQuantity
from vibroimpact.cases.fields.section import Section, read_inner_table
from vibroimpact.cases.fields.size_limits import Name
from vibroimpact.errors import InputError
from vibroimpact.materials import RIGID, Material, find_material
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range


class InlineMaterial(Section):
    """A material given by its numbers."""

    density: Annotated[float, UncertainQuantity("kg/m^3", "density", Range(above=0))]
    youngs_modulus: Annotated[float, Quantity("Pa", "Young's modulus", Range(above=0))]
    poissons_ratio: Annotated[float, Quantity("", "Poisson's ratio", Range(above=-1, below=0.5))]
    yield_strength: Annotated[float, Quantity("Pa", "yield strength", Range(above=0))] | None = None
    compressive_strength: (
        Annotated[
            float, Quantity("Pa", "compressive strength of a brittle material", Range(above=0))
        ]
        | None
    ) = None
    tensile_strength: (
        Annotated[float, Quantity("Pa", "tensile strength of a brittle material", Range(above=0))]
        | None
    ) = None
    hardness: Annotated[float, Quantity("Pa", "Vickers hardness", Range(above=0))] | None = None
    loss_factor: Annotated[float, Quantity("", "loss factor", Range(at_least=0))] | None = None
    name: Name = ""


def _read_material(value: Any) -> Material:
    if isinstance(value, Material):
        return value
    if isinstance(value, str):
        return find_material(value)
    if isinstance(value, dict):
        return Material(**read_inner_table(InlineMaterial, value).model_dump())
    raise InputError(
        f"{quoted(value)} is neither the name of a material nor a table with density, "
        "youngs_modulus and poissons_ratio"
    )


_WORDS = (
    'the name of a material ("vibroimpact materials" lists them), or its numbers; "rigid" for a '
    "plate of infinite modulus"
)
MaterialField = Annotated[
    Material,
    BeforeValidator(_read_material),
    JsonSchema(_WORDS, lambda: {"anyOf": [{"type": "string"}, InlineMaterial.model_json_schema()]}),
]


def material_table(material: Material) -> dict[str, Any] | str:
    """Return a material as it is written in a resolved case file."""
    if material is RIGID:
        return RIGID.name
    return {
        key: value
        for key, value in asdict(material).items()
        if key in InlineMaterial.model_fields and value not in (None, "")
    }
