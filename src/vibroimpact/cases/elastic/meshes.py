"""Meshes of the elastic bodies of a case, generated or read.

There are checks that contact, sensors and supports lie on them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.cases.fields.item_labels import item_label
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.geometry import check_mesh, mass_properties
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.structure import Structure
from vibroimpact.structures.finite_elements.surface import Side, Spot, place_of, surface_motion
from vibroimpact.structures.recipe import ImportedMesh
from vibroimpact.structures.support_force import support_at
from vibroimpact.structures.supports.constraints import Constraints

if TYPE_CHECKING:
    from vibroimpact.bodies.elastic import ElasticBody
    from vibroimpact.cases.sections.schema import CaseTable


def meshes_of(case: CaseTable) -> dict[str, Mesh]:
    """Return the mesh of each elastic body of a case by name; no matrices are assembled.

    Raises
    ------
    InputError
        If one can't be made or read, or the contact point, a sensor or a support does not lie on
        it; with its key.
    """
    meshes = {}
    for name, body in elastic_bodies(case).items():
        try:
            mesh = body.recipe.shape.mesh(body.recipe.supports)
            if isinstance(body.recipe.shape, ImportedMesh):  # generated meshes are valid
                check_mesh(mesh)
        except InputError as error:
            raise InputError(error.message, f"{name}.{error.key}".rstrip(".")) from None
        _check_spot(mesh, body.contact, body.side, _contact_key(case, name))
        names = [{"name": sensor} for sensor in body.sensors]
        for number, (spot, face) in enumerate(body.sensors.values()):
            _check_spot(mesh, spot, face, f"{item_label('sensors', names, number)}.position")
        for sensor, listener in body.heard.items():
            try:
                place_of(mesh, listener.spot, listener.side)
            except InputError as error:
                raise InputError(error.message, _position_key(sensor)) from None
        if name == "plate":
            _check_supports(case, body, mesh)
        meshes[name] = mesh
    return meshes


def _contact_key(case: CaseTable, name: str) -> str:
    """Return the key of a case by which the contact point of a body is given."""
    mesh = getattr(getattr(case, name), "mesh", None)
    if getattr(mesh, "contact", None):
        return f"{name}.mesh.contact"
    if name == "plate":
        return "drop.position"
    return f"{name}.mesh"


def _position_key(sensor: str) -> str:
    """Return the key of the position of a sensor, by its name."""
    return f"{item_label('sensors', [{'name': sensor}], 0)}.position"


def _check_spot(mesh: Mesh, spot: Spot, side: Side, key: str) -> None:
    """Check that a point lies on a side of a mesh."""
    try:
        surface_motion(mesh, np.array([place_of(mesh, spot, side)]), side)
    except InputError as error:
        raise InputError(error.message, key) from None


def _check_supports(case: CaseTable, body: ElasticBody, mesh: Mesh) -> None:
    """Check that each support finds degrees of freedom to constrain that no other does.

    Each force sensor must find a support.
    """
    constraints = Constraints(_massless(case, mesh))
    if isinstance(case.plate.supports, tuple):
        _hold(case.plate.supports, constraints)
    for name, (spot, _) in body.pressed.items():
        try:
            support_at(constraints.structure, body.recipe.supports, spot)
        except InputError as error:
            raise InputError(error.message, _position_key(name)) from None


def _massless(case: CaseTable, mesh: Mesh) -> Structure:
    """Return the structure of a plate without its matrices.

    Constraints depend on the mesh and its mass properties only, so zero matrices and unit density
    serve.
    """
    dofs = mesh.dofs_per_node * len(mesh.nodes)
    zero = csr_array((dofs, dofs))
    thickness = 0.0
    if case.plate.size is not None and mesh.is_flat:
        thickness = case.plate.size[2]
    properties = mass_properties(mesh, 1.0, thickness or 1.0)
    return Structure(mesh, zero, zero, properties, thickness)


def _hold(tables: tuple[Any, ...], constraints: Constraints) -> None:
    """Add the supports of tables to constraints; errors name the table."""
    kinds = [{"type": table.type} for table in tables]
    for number, table in enumerate(tables):
        for support in table.supports():
            try:
                support.hold(constraints)
            except InputError as error:
                key = item_label("plate.supports", kinds, number)
                raise InputError(error.message, key) from None
