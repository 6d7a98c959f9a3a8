"""The supports field of a plate: a keyword, a table, or a list of tables.

To add a support, define its table here and list it in `_TABLES`.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, get_args

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.material import MaterialField, material_table
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section, check_alternatives, read_table
from vibroimpact.cases.fields.size_limits import MOST_ITEMS, Name, check_count
from vibroimpact.errors import InputError, choices, did_you_mean
from vibroimpact.materials import RIGID, Material
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

# not imported at run time, as a case with rigid bodies does not need scipy.sparse
if TYPE_CHECKING:
    from vibroimpact.structures.supports.support import Support

EdgeName = Literal["x-min", "x-max", "y-min", "y-max"]
_Length = Annotated[float, Quantity("m", "length", Range(above=0))]
_Position = Annotated[
    tuple[Annotated[float, Quantity("m", "x")], Annotated[float, Quantity("m", "y")]],
    Field(description="two lengths: x and y on the plate, from its centre"),
]
_Radius = Annotated[float, Quantity("m", "radius", Range(above=0))]
_Directions = Literal["x", "y", "z", "xy", "xz", "yz", "xyz"]
_Spacing = Annotated[
    tuple[_Length, _Length], Field(description="two lengths: between centres along x and along y")
]

WORDS = ("free", "clamped", "simply-supported")


class SupportTable(Section):
    """A table of the supports field."""

    what: ClassVar[str]

    def supports(self) -> tuple[Support, ...]:
        """Return the supports that the table describes."""
        raise NotImplementedError


class PatchTable(SupportTable):
    """A rigid patch of the lower side."""

    what = (
        "a rigid patch of the lower side, held fixed: a disc of a radius, or a rectangle of a size"
    )
    type: Literal["patch"]
    position: _Position
    radius: _Radius | None = None
    size: tuple[_Length, _Length] | None = Field(
        None, description="two lengths: along x and along y"
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> PatchTable:
        check_alternatives(self, "radius", "size", needed=True)
        return self

    def supports(self) -> tuple[Support, ...]:
        """Return the patch, circular or rectangular."""
        from vibroimpact.structures.supports.patch import Patch, RectangularPatch

        if self.size is not None:
            return (RectangularPatch(*self.position, *self.size),)
        return (Patch(*self.position, self.radius or 0.0),)


class PatchesTable(SupportTable):
    """Four rigid patches, at the corners of a rectangle."""

    what = (
        "four rigid circular patches of the lower side, at the corners of a rectangle of this "
        "spacing around the centre"
    )
    type: Literal["patches"]
    spacing: _Spacing
    radius: _Radius

    def supports(self) -> tuple[Support, ...]:
        """Return the four patches."""
        from vibroimpact.structures.supports.patch import Patch

        return tuple(Patch(x, y, self.radius) for x, y in _corners(self.spacing))


def _not_rigid(value: Material) -> Material:
    if value is RIGID:
        raise InputError(
            'a bar is elastic, and "rigid" has no modulus; for rigid bars take patches'
        )
    return value


_BarMaterial = Annotated[MaterialField, AfterValidator(_not_rigid)]


def _elastic_part(material: Material) -> Material:
    """Return the properties that determine the modes of a bar.

    So names and sources do not change the key of the mode store.
    """
    return Material(material.density, material.youngs_modulus, material.poissons_ratio)


class BarTable(SupportTable):
    """An elastic column."""

    what = "an elastic round column under the plate, fixed to the ground"
    type: Literal["bar"]
    position: _Position
    radius: _Radius
    length: _Length
    material: _BarMaterial

    def supports(self) -> tuple[Support, ...]:
        """Return the column."""
        from vibroimpact.structures.supports.bar import Bar

        return (Bar(*self.position, self.radius, self.length, _elastic_part(self.material)),)


class BarsTable(SupportTable):
    """Four elastic columns, at the corners of a rectangle."""

    what = (
        "four elastic round columns, at the corners of a rectangle of this "
        "spacing around the centre"
    )
    type: Literal["bars"]
    spacing: _Spacing
    radius: _Radius
    length: _Length
    material: _BarMaterial

    def supports(self) -> tuple[Support, ...]:
        """Return the four columns."""
        from vibroimpact.structures.supports.bar import Bar

        return tuple(
            Bar(x, y, self.radius, self.length, _elastic_part(self.material))
            for x, y in _corners(self.spacing)
        )


class EdgeTable(SupportTable):
    """An edge of the plate."""

    what = "an edge of the plate"
    type: Literal["edge"]
    edge: EdgeName
    condition: Literal["clamped", "simply-supported"]

    def supports(self) -> tuple[Support, ...]:
        """Return the edge."""
        from vibroimpact.structures.supports.edge import Edge

        return (Edge(self.edge, self.condition),)


class PointTable(SupportTable):
    """A pinned point."""

    what = "a point of the lower side, held along some axes"
    type: Literal["point"]
    position: _Position
    directions: _Directions = Field("z", description="the axes along which it is held")

    def supports(self) -> tuple[Support, ...]:
        """Return the point."""
        from vibroimpact.structures.supports.point import Point

        return (Point(*self.position, self.directions),)


class SpringTable(SupportTable):
    """A spring or an elastic pad."""

    what = "a spring under a point, or an elastic pad of a radius"
    type: Literal["spring"]
    position: _Position
    stiffness: Annotated[float, Quantity("N/m", "vertical stiffness", Range(above=0))]
    horizontal_stiffness: Annotated[
        float, Quantity("N/m", "stiffness along x, and along y", Range(at_least=0))
    ] = 0.0
    radius: Annotated[float, Quantity("m", "radius", Range(at_least=0))] = 0.0

    def supports(self) -> tuple[Support, ...]:
        """Return the spring."""
        from vibroimpact.structures.supports.spring import Spring

        return (Spring(*self.position, self.stiffness, self.horizontal_stiffness, self.radius),)


class SetTable(SupportTable):
    """A named set of a mesh that was brought."""

    what = "a named set of nodes or elements of an imported mesh, held fixed along some axes"
    type: Literal["set"]
    name: Name = Field(description="of the set")
    directions: _Directions = Field("xyz", description="the axes along which it is held")

    def supports(self) -> tuple[Support, ...]:
        """Return the set."""
        from vibroimpact.structures.supports.node_set import NodeSet

        return (NodeSet(self.name, self.directions),)


_TABLES: Mapping[str, type[SupportTable]] = {
    get_args(kind.model_fields["type"].annotation)[0]: kind
    for kind in (
        PatchesTable,
        PatchTable,
        BarsTable,
        BarTable,
        EdgeTable,
        PointTable,
        SpringTable,
        SetTable,
    )
}
_ALLOWED = f"{', '.join(WORDS)}, or a table (or a list of tables) with type = {', '.join(_TABLES)}"


def _read_supports(value: Any) -> Any:
    """Return a keyword, or the validated tables as a tuple."""
    if isinstance(value, str):
        if value not in WORDS:
            raise InputError(
                f"{quoted(value)} is not allowed; it must be "
                f"{_ALLOWED}.{did_you_mean(value, WORDS)}"
            )
        return value
    if isinstance(value, dict):
        return (_read_support(value),)
    if isinstance(value, (list, tuple)):
        check_count(len(value), MOST_ITEMS, "supports")
        tables = []
        for number, item in enumerate(value):
            if isinstance(item, SupportTable):
                tables.append(item)
                continue
            try:
                tables.append(_read_support(item))
            except InputError as error:
                key = f"{number}.{error.key}".rstrip(".")
                raise InputError(error.message, key) from None
        return tuple(tables)
    raise InputError(f"{quoted(value)} is not allowed; it must be {_ALLOWED}")


def _read_support(value: Any) -> SupportTable:
    """Return a validated table of the kind that its type names.

    A discriminated union of pydantic would select the kind as well, but not give these messages.
    """
    name = value.get("type") if isinstance(value, dict) else None
    if not isinstance(name, str) or name not in _TABLES:
        if value in WORDS:
            raise InputError(
                f"{quoted(value)} stands alone, without a list: supports = {quoted(value)}"
            )
        fault = "a support is a table with a type"
        if name is not None:
            fault = f"there is no support of type {quoted(name)}"
        raise InputError(f"{fault}; there are {choices(_TABLES, str(name))}")
    return read_table(_TABLES[name], value)


def _json_schema() -> dict[str, Any]:
    tables = [{**kind.model_json_schema(), "description": kind.what} for kind in _TABLES.values()]
    return {
        "anyOf": [{"enum": list(WORDS)}, *tables, {"type": "array", "items": {"anyOf": tables}}]
    }


SupportsField = Annotated[
    Any, BeforeValidator(_read_supports), JsonSchema("supports of the plate", _json_schema)
]


def supports_of(value: str | tuple[SupportTable, ...]) -> tuple[Support, ...]:
    """Return the supports of a validated field; a keyword holds for all four edges."""
    if isinstance(value, str):
        from vibroimpact.structures.supports.edge import Edge

        if value == "free":
            return ()
        return tuple(Edge(edge, value) for edge in get_args(EdgeName))  # type: ignore[arg-type]
    return tuple(support for table in value for support in table.supports())


def _corners(spacing: tuple[float, float]) -> list[tuple[float, float]]:
    """Return the positions [m] of the corners of a rectangle around the centre of the plate."""
    return [(0.5 * x * spacing[0], 0.5 * y * spacing[1]) for x, y in product((-1.0, 1.0), repeat=2)]


def supports_table(value: Any) -> Any:
    """Return supports as they are written in a resolved case file."""
    if not isinstance(value, tuple):
        return value
    tables = []
    for support in value:
        table = support.model_dump(exclude_none=True, exclude={"material"}, mode="json")
        if isinstance(support, (BarTable, BarsTable)):
            table["material"] = material_table(support.material)
        tables.append(table)
    return tables
