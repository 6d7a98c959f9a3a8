"""Residual compliance of truncated modes between the contact point and the sensors of a plate."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from vibroimpact.arrays import Floats
from vibroimpact.bodies.elastic import ElasticBody
from vibroimpact.cases.elastic.modes import BodyModes, contact_place
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.modal_model import ModalBasis
from vibroimpact.structures.support_force import support_force_key
from vibroimpact.structures.surface import Side, Spot, place_of
from vibroimpact.structures.transfer_compliance import (
    Point,
    hold_transfers,
    transfer_compliances,
    transfer_key,
)
from vibroimpact.structures.transfer_strain import strain_key, transfer_strains

_FACES = 2
"""Number of points, out of contact and sensor, at which the mode shapes are those at the
face of the plate.
"""


def with_residuals(
    body: BodyModes, basis: ModalBasis, tell: Callable[[str], None] | None = None
) -> ModalBasis:
    """Return the modes of a plate with the residual static compliance between the contact point and
    each sensor.

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
    recipe, (place, side) = body.body.recipe, contact_place(body)
    found: dict[str, Floats] = {}
    if body.body.watched:
        moved = transfer_compliances(
            recipe, place, side, _points(body.model.mesh, body.body.watched), _FACES, tell
        )
        found |= dict(zip(body.body.watched, moved, strict=True))
    if body.body.strained:
        found |= dict(
            zip(
                body.body.strained,
                transfer_strains(
                    recipe, place, side, _points(body.model.mesh, body.body.strained), tell
                ),
                strict=True,
            )
        )
    if body.body.pressed:
        found |= dict(
            zip(body.body.pressed, body.body.support_forces(body.model, tell).static, strict=True)
        )
    weights = basis.contact / basis.angular_frequencies**2
    return replace(
        basis,
        residuals={name: static - weights @ basis.points[name] for name, static in found.items()},
    )


def hold_residuals(body: ElasticBody, mesh: Mesh, places: Sequence[tuple[float, float]]) -> None:
    """Compute the compliances between places of a plate and its sensors of motion
    together, for calls of `with_residuals` that follow.
    """
    if body.watched:
        hold_transfers(body.recipe, places, body.side, _points(mesh, body.watched), _FACES)


def residual_keys(body: BodyModes) -> list[str]:
    """Return the keys of the compliances of `with_residuals` in the mode store."""
    recipe, (place, side), watched, strained = (
        body.body.recipe,
        contact_place(body),
        body.body.watched,
        body.body.strained,
    )
    pressed = [spot for spot, _ in body.body.pressed.values()]
    moved = (
        [transfer_key(recipe, place, side, _points(body.model.mesh, watched), _FACES)]
        if watched
        else []
    )
    pulled = (
        [strain_key(recipe, place, side, _points(body.model.mesh, strained))] if strained else []
    )
    return moved + pulled + ([support_force_key(recipe, place, side, pressed)] if pressed else [])


def _points(mesh: Mesh, sensors: Mapping[str, tuple[Spot, Side]]) -> list[Point]:
    """Return the position and face of each sensor."""
    return [(place_of(mesh, spot, face), face) for spot, face in sensors.values()]
