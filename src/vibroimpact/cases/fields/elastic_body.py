"""The fields of the [sphere] and [plate] sections that describe an elastic body.

They are mesh, modes and reduction, with their checks.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, StrictBool, model_validator

from vibroimpact.bodies.ball import mean_density
from vibroimpact.bodies.rigid_bodies import rigid_sphere
from vibroimpact.cases.fields.json_schema import JsonSchema
from vibroimpact.cases.fields.material import MaterialField, material_table
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.cases.fields.section import Section, check_alternatives, read_table
from vibroimpact.cases.fields.size_limits import FileName
from vibroimpact.errors import InputError
from vibroimpact.files.reading import with_path
from vibroimpact.materials import RIGID
from vibroimpact.meshes.mesh_digest import mesh_digest
from vibroimpact.quoting import quoted
from vibroimpact.ranges import Range

# not imported at run time, as a case with rigid bodies does not need scipy.sparse
if TYPE_CHECKING:
    from vibroimpact.structures.finite_elements.mesh import Mesh
    from vibroimpact.structures.finite_elements.surface import Side, Spot
    from vibroimpact.structures.recipe import ImportedMesh, Place, Reduction

MOST_MODES = 20_000
_PARTS = "parts"  # kind of the entries of the store with the number of parts of a file
DEFAULT_ACCURACY = 0.01
"""Accuracy of the largest force and of signals for which modes are chosen."""

_Size = Annotated[float, Quantity("m", "largest side of an element", Range(above=0))]
_Count = Annotated[int, Field(ge=1, strict=True)]
ElementKind = Literal["hex8", "hex20", "hex27", "tet4", "tet10"]


def _one_unit(value: Any) -> Any:
    """Return one of a unit that is given without a number: "1 mm" for "mm"."""
    if isinstance(value, str) and value.strip().isalpha():
        return f"1 {value}"
    return value


class BroughtMeshTable(Section):
    """A mesh, or a geometry, from a file."""

    file: FileName = Field(
        description="Nastran (.bdf, .dat, .nas, .fem), Abaqus (.inp), Gmsh (.msh), or with the "
        "extra mesh STEP (.step, .stp), BREP (.brep)"
    )
    unit: Annotated[
        float, Quantity("m", "unit of its coordinates", Range(above=0)), BeforeValidator(_one_unit)
    ] = 1.0
    element_size: _Size | None = None
    contact: str | None = Field(None, description="a named set, whose centre is the contact point")
    materials: dict[FileName, MaterialField] | None = Field(
        None,
        description="materials in place of those of the file, by the name of a material or an "
        "element set of the file",
    )

    @model_validator(mode="after")
    def _none_is_rigid(self) -> BroughtMeshTable:
        for name, material in (self.materials or {}).items():
            if material.name == RIGID.name:
                raise InputError(
                    '"rigid" does not deform; an elastic body needs materials with a modulus',
                    f"materials.{name}",
                )
        return self

    def brought(self, contact: Spot, side: Side) -> ImportedMesh:
        """Return the mesh, which is read when it is first used.

        It is identified by the checksum of its file and of those it includes.

        Of a file with several parts that are not joined it is the part at the contact, and
        identified by its nodes too.

        Parameters
        ----------
        contact : spot
            x and y [m], the name of a set, or None for the highest or lowest node.
        side : str
            Side of the contact: "upper" or "lower".

        Raises
        ------
        InputError
            If the file can't be read, or the contact point is not on one of several parts.
        """
        from vibroimpact.structures.recipe import ImportedMesh

        try:
            content = mesh_digest(self.file)
        except InputError as error:
            raise with_path(self.file, error, "mesh") from None
        of_elements = {
            name: material_table(material) for name, material in (self.materials or {}).items()
        }
        digest = json.dumps(
            [content, Path(self.file).suffix.lower(), self.unit, self.element_size, of_elements]
        )
        read = partial(self.read, (contact, side))
        if self._number_of_parts(digest) > 1:
            digest += hashlib.sha256(read().nodes.tobytes()).hexdigest()
        return ImportedMesh(digest, read)

    def _number_of_parts(self, digest: str) -> int:
        """Return the number of parts of the file that are not joined.

        It is that of the store if it is there.
        """
        from vibroimpact.meshes.mesh_file import mesh_of_file
        from vibroimpact.structures.finite_elements.parts import number_of_parts
        from vibroimpact.structures.store import hold_entry, key_of, load_entry, save_entry

        key = key_of(["parts of a mesh", digest])
        part_count, _ = load_entry(key, _PARTS, lambda entry: int(entry[_PARTS].item()))
        if part_count is None:
            part_count = number_of_parts(
                self._with_keys(lambda: mesh_of_file(self.file, self.unit, self.element_size))
            )
            entry = {_PARTS: np.array(part_count)}
            hold_entry(key, _PARTS, entry)
            save_entry(key, _PARTS, entry)
        return part_count

    def table(self) -> dict[str, Any]:
        """Return the table as it is written in a resolved case file."""
        table = self.model_dump(exclude_none=True, exclude={"materials"})
        if self.materials:
            table["materials"] = {
                name: material_table(material) for name, material in self.materials.items()
            }
        return table

    def read(self, contact: tuple[Spot, Side] | None = None) -> Mesh:
        """Read the mesh, with coordinates in metres.

        Of several parts that are not joined it is the one at the contact, or all.
        """
        from vibroimpact.meshes.mesh_file import load_mesh

        return self._with_keys(
            lambda: load_mesh(self.file, self.unit, self.element_size, self.materials, contact)
        )

    @staticmethod
    def _with_keys(read: Callable[[], Mesh]) -> Mesh:
        """Return what is read; errors have the key of the case."""
        try:
            return read()
        except InputError as error:
            key = {
                "size": "mesh.element_size",
                "unit_in_metres": "mesh.unit",
                "materials": "mesh.materials",
            }.get(error.key, "mesh")
            raise InputError(error.message, key) from None


class SphereMeshTable(Section):
    """The mesh of a sphere made here."""

    elements_across: Annotated[int, Field(ge=4, multiple_of=2, strict=True)] | None = Field(
        None, description="elements from pole to pole, even and at least 4"
    )
    kind: ElementKind = Field("hex27", description="kind of element")
    grading: Annotated[
        float,
        Quantity("", "refinement factor of the elements at the contact point", Range(at_least=1)),
    ] = 1.0


class PlateMeshTable(Section):
    """The mesh of a plate made here."""

    element_size: _Size | None = None
    elements: _Count | None = Field(
        None,
        description="approximate number of elements, instead of element_size; only of element = "
        '"solid"',
    )
    layers: _Count | None = Field(
        None, description='elements through the thickness; only of element = "solid"'
    )
    kind: ElementKind | None = Field(None, description='kind of element; only of element = "solid"')
    splits: Annotated[int, Field(ge=0, le=6, strict=True)] | None = Field(
        None,
        description="number of refinements of elements along edges and at the rims of patches; "
        "only of "
        'element = "solid"',
    )
    lower_splits: Annotated[int, Field(ge=0, le=6, strict=True)] | None = Field(
        None,
        description="number of times that the lowest layer is split at a quarter of its height; "
        "only of "
        'element = "solid"',
    )
    margin: (
        Annotated[
            float,
            Quantity("m", "width of elements along edges and straight rims", Range(at_least=0)),
        ]
        | None
    ) = Field(None, description='only of element = "plate"; 0 for none')
    theory: Literal["thick", "thin"] | None = Field(
        None, description='of plates; only of element = "plate"'
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> PlateMeshTable:
        check_alternatives(self, "element_size", "elements", needed=False)
        return self


def _mesh_field(kind: type[Section]) -> Any:
    """Return the type of a mesh field.

    It takes a file name, a table with a file, or a table of the given kind for a generated mesh.
    """

    def read(value: Any) -> Any:
        if isinstance(value, Section) or value is None:
            return value
        if isinstance(value, str):
            return read_table(BroughtMeshTable, {"file": value})
        if isinstance(value, dict):
            if "file" in value:
                return read_table(BroughtMeshTable, value)
            return read_table(kind, value)
        raise InputError(f"{quoted(value)} is neither the name of a file nor a table")

    def json_schema() -> dict[str, Any]:
        return {
            "anyOf": [
                {"type": "string"},
                BroughtMeshTable.model_json_schema(),
                kind.model_json_schema(),
            ]
        }

    return Annotated[
        Any,
        BeforeValidator(read),
        JsonSchema("a mesh file, or settings of the mesh generator", json_schema),
    ]


SphereMeshField = _mesh_field(SphereMeshTable)
PlateMeshField = _mesh_field(PlateMeshTable)


def _read_modes(value: Any) -> Any:
    """Return a valid number of modes, "auto" or None."""
    if value is None or value == "auto" or (type(value) is int and 1 <= value <= MOST_MODES):
        return value
    raise InputError(
        f"{quoted(value)} is not allowed; it must be a whole number from 1 to {MOST_MODES}, or "
        '"auto" for as many as the accuracy needs'
    )


ModesField = Annotated[
    Annotated[int, Field(ge=1, le=MOST_MODES)] | Literal["auto"] | None,
    BeforeValidator(_read_modes),
    Field(
        description='number of modes, from the lowest; "auto" (default): enough for the accuracy'
    ),
]
AccuracyField = Annotated[
    float,
    Quantity(
        "",
        "accuracy of the largest force and of the signals of sensors for which modes are chosen",
        Range(above=0, at_most=0.5),
    ),
]
FrequencyField = Annotated[float, Quantity("Hz", "all modes up to this frequency", Range(above=0))]
ReductionField = Annotated[
    Literal["modal", "craig-bampton"] | None,
    Field(description="model reduction of the finite elements; modal by default"),
]
AttachmentField = Annotated[
    StrictBool, Field(description="add a residual attachment mode at the contact point")
]

_ROUNDED = 1e-3
"""Relative difference of a mass or a moment of inertia from a solid sphere's that is rounding."""

ELASTIC_KEYS = (
    "modes",
    "max_frequency",
    "accuracy",
    "damping",
    "supports",
    "mesh",
    "reduction",
    "attachment_mode",
    "element",
)
"""Keys of a body that a rigid one does not take."""


def check_elastic(section: Any) -> None:
    """Check the keys of a body against each other and against its model, rigid or elastic.

    Raises
    ------
    InputError
        With the invalid key.
    """
    if section.model == "rigid":
        for key in ELASTIC_KEYS:
            value = getattr(section, key, None)
            if value in (None, False):
                continue
            # a sphere in the place of the plate
            if hasattr(section, "supports") and section.radius is not None:
                if key != "supports":
                    raise InputError(
                        "a sphere in the place of the plate is rigid but for its contact; "
                        f"leave out {key}",
                        key,
                    )
                if value == "free":
                    continue  # a sphere below that moves freely
                raise InputError('a sphere in the place of the plate is held fixed, or "free"', key)
            raise InputError(
                f'a rigid body does not take it; add model = "elastic", or leave out {key}', key
            )
        return
    check_alternatives(section, "modes", "max_frequency", needed=False, key="modes")
    states_modes = section.modes not in (None, "auto") or section.max_frequency is not None
    if section.accuracy is not None and states_modes:
        raise InputError(
            'the modes are stated, and accuracy is for modes = "auto"; leave out one of them',
            "accuracy",
        )
    if section.reduction == "craig-bampton" and section.attachment_mode:
        raise InputError(
            "the constraint modes of craig-bampton contain it already; leave it out",
            "attachment_mode",
        )
    if section.material.name == "rigid":
        raise InputError(
            '"rigid" does not deform; an elastic body needs a material with a modulus', "material"
        )


def check_ball(section: Any) -> None:
    """Check mass and moment of inertia of the sphere.

    Of an elastic one they follow from its material.

    Raises
    ------
    InputError
        With the invalid key.
    """
    radius = section.radius
    material = section.material
    # raises if no ball has that moment of inertia
    ball = rigid_sphere(radius, material, mass=section.mass, inertia=section.inertia)
    if section.model == "rigid":
        return
    solid = rigid_sphere(radius, material, inertia="solid")
    remedy = 'leave it out, or give model = "rigid"'
    if abs(ball.mass - solid.mass) > _ROUNDED * solid.mass:
        raise InputError(
            f"an elastic sphere is solid, {solid.mass:.4g} kg of its material, not "
            f"{ball.mass:.4g} kg; {remedy}, or a material with the density "
            f"{mean_density(ball.mass, radius):.4g} kg/m^3",
            "mass",
        )
    if (
        ball.inertia is not None
        and solid.inertia is not None
        and abs(ball.inertia - solid.inertia) > _ROUNDED * solid.inertia
    ):
        raise InputError(
            f"an elastic sphere is solid, with {solid.inertia:.4g} kg m^2 of its material, not "
            f"{ball.inertia:.4g} kg m^2; {remedy}",
            "inertia",
        )


def check_plate(section: Any) -> None:
    """Check the keys of an elastic plate, or of a sphere that replaces the plate.

    Raises
    ------
    InputError
        With the invalid key.
    """
    if section.radius is not None:
        if section.size is not None:
            raise InputError(
                "a sphere takes the place of the plate, and has no size; leave out size, or radius",
                "size",
            )
        if section.model == "elastic":
            raise InputError(
                "a sphere in the place of the plate is rigid but for its contact; leave out "
                "model, or take a System in Python, whose bodies may all vibrate",
                "model",
            )
        if section.supports is not None and section.material.name == "rigid":
            raise InputError(
                '"rigid" has no density, and a sphere that is free needs a mass', "material"
            )
    if section.model == "rigid":
        return
    # an elastic plate: its size, supports and mesh keys must suit its elements
    mesh = section.mesh
    is_brought = isinstance(mesh, BroughtMeshTable)
    if section.size is None and not is_brought:
        raise InputError(
            "an elastic plate needs its length, width and thickness, or a mesh file", "size"
        )
    if section.supports is None:
        raise InputError(
            'how is the elastic plate held? Give "free", "clamped", "simply-supported", or '
            "tables such as patches",
            "supports",
        )
    if is_brought and section.element == "plate":
        raise InputError(
            "a mesh file has solid elements; leave out element, or the mesh file", "element"
        )
    if isinstance(mesh, PlateMeshTable):
        element = section.element or "plate"
        other = "solid"
        keys_of_other = ["elements", "layers", "kind", "splits", "lower_splits"]
        if element == "solid":
            other = "plate"
            keys_of_other = ["theory", "margin"]
        for key in keys_of_other:
            if getattr(mesh, key) is not None:
                raise InputError(
                    f'element = "{element}" does not take it; leave it out, or give element = '
                    f'"{other}"',
                    f"mesh.{key}",
                )


def check_sphere_below(case: Any) -> None:
    """Check a case in which a sphere replaces the plate.

    It is a central impact of bodies that deform only in their contact.

    Raises
    ------
    InputError
        With the invalid key.
    """
    local = case.contact.local
    if any(case.drop.position):
        raise InputError(
            "beside the top of a sphere the impact is oblique, and spheres meet head on here; "
            "leave it out",
            "drop.position",
        )
    states_elasticity = {
        "sphere.model": case.sphere.model == "elastic",
        "contact.local_compliance": local.local_compliance is not None,
        "contact.finite_sphere": local.finite_sphere,
    }
    for key, is_stated in states_elasticity.items():
        if is_stated:
            raise InputError("two spheres are rigid but for their contact; leave this out", key)


def reduction_of(section: Any, place: Place) -> Reduction:
    """Return the modal reduction of a body with its contact point at `place`.

    It has neither a number of modes nor a highest frequency where they are to be chosen.
    """
    from vibroimpact.structures.recipe import Reduction

    return Reduction(
        modes=None if section.modes == "auto" else section.modes,
        max_frequency=section.max_frequency,
        method=section.reduction or "modal",
        interface=(place,) if section.reduction == "craig-bampton" else (),
        attachment=(place,) if section.attachment_mode else (),
    )
