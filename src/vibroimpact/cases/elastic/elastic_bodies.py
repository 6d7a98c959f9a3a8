"""Elastic bodies of a case: their meshes, supports, reduction and damping."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

from vibroimpact.bodies.elastic import ElasticBody, plate_recipe, recipe_of, sphere_recipe
from vibroimpact.cases.elastic.chosen_modes import with_chosen_modes
from vibroimpact.cases.fields.damping import damping_of, damping_table
from vibroimpact.cases.fields.elastic_body import (
    BroughtMeshTable,
    PlateMeshTable,
    reduction_of,
)
from vibroimpact.cases.fields.section import derived
from vibroimpact.cases.fields.supports import supports_of, supports_table
from vibroimpact.cases.rigid.rigid_problem import elastic_names
from vibroimpact.dynamics.sensors.antialias import FINENESS
from vibroimpact.dynamics.sensors.instruments.microphone import MicrophoneInCase
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.rectangle import rectangle_blocks
from vibroimpact.structures.finite_elements.surface import Spot
from vibroimpact.structures.recipe import ImportedMesh, Recipe, Reduction, mesh_features
from vibroimpact.structures.sound_paths import Listener
from vibroimpact.structures.supports.support import Support

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable

# default: no splitting, so that the number of elements is that of the case
_UNSPLIT = {"splits": 0, "lower_splits": 0}


@derived
def elastic_bodies(case: CaseTable) -> dict[str, ElasticBody]:
    """Return the elastic bodies of a case by name.

    Raises
    ------
    InputError
        If one can't be made; with its key.
    """
    return {name: _body(case, name) for name in elastic_names(case)}


def _body(case: CaseTable, name: Literal["sphere", "plate"]) -> ElasticBody:
    """Return an elastic body; errors carry the name of the body in their key."""
    try:
        if name == "sphere":
            return _sphere(case)
        return _plate(case)
    except InputError as error:
        raise InputError(error.message, f"{name}.{error.key}".rstrip(".")) from None


def elastic_table(case: CaseTable, name: Literal["sphere", "plate"]) -> dict[str, Any]:
    """Return the resolved keys of an elastic body.

    They are mesh, reduction, modes, damping, and supports of a plate.
    """
    section = getattr(case, name)
    body = elastic_bodies(case)[name]
    shape = body.recipe.shape
    reduction = body.recipe.reduction
    damping = body.damping if section.damping is None else section.damping
    table: dict[str, Any] = {"reduction": reduction.method, "damping": damping_table(damping)}
    if reduction.modes:
        table["modes"] = reduction.modes
    else:
        table["max_frequency"] = reduction.max_frequency
    if isinstance(shape, ImportedMesh):
        table["mesh"] = section.mesh.table()
    else:
        table["mesh"] = {
            key: value for key, value in vars(shape).items() if key not in ("radius", "size")
        }
    if name == "plate":
        table["supports"] = supports_table(section.supports)
        if not isinstance(shape, ImportedMesh):
            table["element"] = section.element or "plate"
    return table


def _sphere(case: CaseTable) -> ElasticBody:
    """Return the sphere of a case as an elastic body."""
    sphere = case.sphere
    mesh = sphere.mesh
    contact = None
    if isinstance(mesh, BroughtMeshTable):
        contact = mesh.contact
    reduction = reduction_of(sphere, (contact, "lower"))
    recipe_with: Callable[[Reduction], Recipe]
    if isinstance(mesh, BroughtMeshTable):
        brought = mesh.brought(contact, "lower")
        recipe_with = partial(recipe_of, brought, sphere.material)
    else:
        options = mesh.model_dump(exclude_none=True) if mesh else {}
        recipe_with = partial(sphere_recipe, sphere.radius, sphere.material, **options)
    recipe = with_chosen_modes(case, "sphere", recipe_with, reduction, contact)
    damping = damping_of(sphere.damping, sphere.material.loss_factor)
    return ElasticBody(recipe, "lower", contact, damping)


def _plate(case: CaseTable) -> ElasticBody:
    """Return the plate of a case as an elastic body, with its sensors by what they measure."""
    plate = case.plate
    contact: Spot = case.drop.position
    if isinstance(plate.mesh, BroughtMeshTable) and plate.mesh.contact:
        contact = plate.mesh.contact
    watched = {}
    strained = {}
    pressed = {}
    for sensor in case.sensors:
        if sensor.subject == "strain":
            strained[sensor.name] = (sensor.position, sensor.face)
        elif sensor.subject == "support":
            pressed[sensor.name] = (sensor.position, sensor.face)
        elif sensor.subject == "motion":
            watched[sensor.name] = (sensor.position, sensor.face)
    return ElasticBody(
        _plate_recipe(case, contact),
        "upper",
        contact,
        damping_of(plate.damping, plate.material.loss_factor),
        watched,
        strained,
        _heard(case),
        pressed,
    )


def _heard(case: CaseTable) -> dict[str, Listener]:
    """Return where the microphones are, by the names of their sensors."""
    listeners = {}
    for sensor in case.sensors:
        microphone = sensor.instrument_in_case()
        if isinstance(microphone, MicrophoneInCase):
            listeners[sensor.name] = Listener(
                sensor.position,
                sensor.face,
                microphone.distance,
                microphone.speed_of_sound,
                1.0 / (FINENESS * sensor.rate),
            )
    return listeners


def _plate_recipe(case: CaseTable, contact: Spot) -> Recipe:
    """Return the recipe of the modes of a plate."""
    plate = case.plate
    mesh = plate.mesh
    reduction = reduction_of(plate, (contact, "upper"))
    supports = supports_of(plate.supports)
    recipe_with: Callable[[Reduction], Recipe]
    if isinstance(mesh, BroughtMeshTable):
        brought = mesh.brought(contact, "upper")
        recipe_with = partial(recipe_of, brought, plate.material, supports=supports)
        return with_chosen_modes(case, "plate", recipe_with, reduction, contact)
    assert plate.size is not None  # validated by the section
    options: dict[str, Any] = {}
    if isinstance(mesh, PlateMeshTable):
        if mesh.elements:
            options = _mesh_options(plate.size, mesh.elements, mesh.layers, supports)
        options |= mesh.model_dump(exclude_none=True, exclude={"elements"})
    element = plate.element or "plate"
    recipe_with = partial(
        plate_recipe, plate.size, plate.material, supports=supports, element=element, **options
    )
    return with_chosen_modes(case, "plate", recipe_with, reduction, contact)


def _mesh_options(
    size: tuple[float, float, float],
    elements: int,
    layers: int | None,
    supports: tuple[Support, ...],
) -> dict[str, Any]:
    """Return the element size and the number of layers of a plate with about so many elements.

    Elements are nearly cubic if `layers` is None.
    """
    if not layers:
        elements_per_length = (elements / math.prod(size)) ** (1.0 / 3.0)
        layers = max(1, round(size[2] * elements_per_length))
    side = math.sqrt(size[0] * size[1] * layers / elements)
    errors: dict[float, float] = {}  # of the number of elements, by their size
    # the count scales as 1 / side^2, except for elements around patches and rounding
    for _ in range(8):
        blocks = rectangle_blocks(size[:2], side, 1, *mesh_features(supports))
        # a block has a row and a column of nodes more than of elements
        per_layer = sum((block.shape[0] - 1) * (block.shape[1] - 1) for block in blocks)
        count = layers * per_layer
        errors[side] = abs(count - elements)
        side *= math.sqrt(count / elements)
    element_size = min(errors, key=lambda size: errors[size])
    return {"element_size": element_size, "layers": layers, **_UNSPLIT}
