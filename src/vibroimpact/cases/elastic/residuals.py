"""How the points of a plate that are watched move with the modes that were left out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from vibroimpact.cases.elastic.modes import BodyModes
from vibroimpact.structures.modal_model import ModalBasis
from vibroimpact.structures.surface import Side, place_of
from vibroimpact.structures.transfer_compliance import Point, transfer_compliances, transfer_key

_FACES = 2
"""At how many of both points, of the contact and of those watched, the modal shapes are those of the face of a plate."""


def with_residuals(body: BodyModes, basis: ModalBasis, tell: Callable[[str], None] | None = None) -> ModalBasis:
    """Return the modes of a plate with what they lack of the static compliance between the contact and the points that are watched.

    Parameters
    ----------
    body : BodyModes
        The plate.
    basis : ModalBasis
        Its modes as the contact sees them.
    tell : callable, optional
        Called with a sentence if something is wrong with the store.
    """
    if not body.body.watched:
        return basis
    whole = transfer_compliances(body.body.recipe, *_force(body), _points(body), _FACES, tell)
    weights = basis.contact / basis.angular_frequencies**2
    return replace(
        basis, residuals={name: found - weights @ basis.points[name] for name, found in zip(body.body.watched, whole, strict=True)}
    )


def residual_key(body: BodyModes) -> str:
    """Return the key under which the store has what `with_residuals` needs of a plate."""
    return transfer_key(body.body.recipe, *_force(body), _points(body), _FACES)


def _force(body: BodyModes) -> tuple[tuple[float, float], Side]:
    return place_of(body.model.mesh, body.body.contact, body.body.side), body.body.side


def _points(body: BodyModes) -> list[Point]:
    return [(place_of(body.model.mesh, spot, face), face) for spot, face in body.body.watched.values()]
