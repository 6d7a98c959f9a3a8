"""Residual compliance of truncated modes between the contact point and the sensors of a plate."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from vibroimpact.arrays import Floats
from vibroimpact.bodies.elastic import ElasticBody
from vibroimpact.cases.elastic.modes import BodyModes, contact_place
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.surface import Side, Spot, place_of
from vibroimpact.structures.modal_model import ModalBasis
from vibroimpact.structures.support_force import support_force_key
from vibroimpact.structures.transfer_compliance import (
    Point,
    hold_transfers,
    transfer_compliances,
    transfer_key,
)
from vibroimpact.structures.transfer_strain import strain_key, transfer_strains

_FACES = 2
"""Number of points, of contact and sensor, at which mode shapes are those at the face."""


def with_residuals(
    body: BodyModes, basis: ModalBasis, tell: Callable[[str], None] | None = None
) -> ModalBasis:
    """Return the modes of a plate with residual compliances to its sensors.

    They are the static ones between the contact point and each sensor that the modes lack.

    Parameters
    ----------
    body : BodyModes
        The plate.
    basis : ModalBasis
        Its modes at the contact point and the sensors.
    tell : callable, optional
        Called with a warning if the mode store is faulty.
    """
    if not body.body.sensors:
        return basis
    recipe = body.body.recipe
    place, side = contact_place(body)
    mesh = body.model.mesh
    # static compliances by the name of the sensor, of all modes
    static: dict[str, Floats] = {}
    if body.body.watched:
        points = _points(mesh, body.body.watched)
        compliances = transfer_compliances(recipe, place, side, points, _FACES, tell)
        static |= dict(zip(body.body.watched, compliances, strict=True))
    if body.body.strained:
        points = _points(mesh, body.body.strained)
        strains = transfer_strains(recipe, place, side, points, tell)
        static |= dict(zip(body.body.strained, strains, strict=True))
    if body.body.pressed:
        forces = body.body.support_forces(body.model, tell).static
        static |= dict(zip(body.body.pressed, forces, strict=True))
    weights = basis.contact / basis.angular_frequencies**2
    residuals = {
        name: of_all_modes - weights @ basis.points[name] for name, of_all_modes in static.items()
    }
    return replace(basis, residuals=residuals)


def hold_residuals(body: ElasticBody, mesh: Mesh, places: Sequence[tuple[float, float]]) -> None:
    """Compute the compliances between places of a plate and its sensors of motion together.

    This is for calls of `with_residuals` that follow.
    """
    if body.watched:
        hold_transfers(body.recipe, places, body.side, _points(mesh, body.watched), _FACES)


def residual_keys(body: BodyModes) -> list[str]:
    """Return the keys of the compliances of `with_residuals` in the mode store."""
    recipe = body.body.recipe
    place, side = contact_place(body)
    mesh = body.model.mesh
    keys = []
    if body.body.watched:
        points = _points(mesh, body.body.watched)
        keys.append(transfer_key(recipe, place, side, points, _FACES))
    if body.body.strained:
        keys.append(strain_key(recipe, place, side, _points(mesh, body.body.strained)))
    if body.body.pressed:
        spots = [spot for spot, _ in body.body.pressed.values()]
        keys.append(support_force_key(recipe, place, side, spots))
    return keys


def _points(mesh: Mesh, sensors: Mapping[str, tuple[Spot, Side]]) -> list[Point]:
    """Return the position and face of each sensor."""
    return [(place_of(mesh, spot, face), face) for spot, face in sensors.values()]
