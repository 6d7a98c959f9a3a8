"""Residual compliance of truncated modes between the contact point and the sensors of a plate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from vibroimpact.cases.elastic.modes import BodyModes, contact_place
from vibroimpact.structures.modal_model import ModalBasis
from vibroimpact.structures.surface import place_of
from vibroimpact.structures.transfer_compliance import Point, transfer_compliances, transfer_key

_FACES = 2
"""Number of points, out of contact and sensor, at which the mode shapes are those at the face of the plate."""


def with_residuals(body: BodyModes, basis: ModalBasis, tell: Callable[[str], None] | None = None) -> ModalBasis:
    """Return the modes of a plate with the residual static compliance between the contact point and each sensor.

    Parameters
    ----------
    body : BodyModes
        The plate.
    basis : ModalBasis
        Its modes at the contact point and the sensors.
    tell : callable, optional
        Called with a warning if the mode store is faulty.
    """
    if not body.body.watched:
        return basis
    compliances = transfer_compliances(body.body.recipe, *contact_place(body), _points(body), _FACES, tell)
    weights = basis.contact / basis.angular_frequencies**2
    return replace(
        basis, residuals={name: found - weights @ basis.points[name] for name, found in zip(body.body.watched, compliances, strict=True)}
    )


def residual_key(body: BodyModes) -> str:
    """Return the key of the compliances of `with_residuals` in the mode store."""
    return transfer_key(body.body.recipe, *contact_place(body), _points(body), _FACES)


def _points(body: BodyModes) -> list[Point]:
    """Return the position and face of each sensor."""
    return [(place_of(body.model.mesh, spot, face), face) for spot, face in body.body.watched.values()]
