r"""Edges: the contact is that of a half space, and next to an edge a quarter of the space is missing."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.conditions import Conditions
from vibroimpact.cases.limit import Limit

_RADII, _THICKNESSES = 10.0, 2.0
"""How far the contact keeps from an edge: of a rigid plate in contact radii, where a half space is 3 to 5 % too stiff; of an elastic plate
in thicknesses, beyond which nothing of the local deformation is left (it falls as exp(-pi d / h))."""


def softening(contact_radius: Array, distance: Array, poissons_ratio: Array, share: Array) -> Array:
    r"""Return by which part a contact is softer near a free edge, to first order in its radius over its distance from the edge.

    What the quarter space gives way beyond the half space is, under a force F at a distance d from the edge,
    :math:`\psi (1 - \nu^2) F / (2 \pi E d)`: :math:`\psi` times what the mirror image of the force would add. Hertz's indentation is
    :math:`3 F / (4 E^* a)`.

    Parameters
    ----------
    contact_radius, distance : float or array
        Contact radius a and distance d of its centre from the edge [m].
    poissons_ratio : float or array
        Of the plate.
    share : float or array
        The plate's part of the compliance of the contact.

    Notes
    -----
    :math:`\psi = 1.35 + 0.3 \nu + 4.2 \nu^2` is fitted to three-dimensional finite elements, within 4 %. The problem is that of
    Hetenyi, M. (1970). A general solution for the elastic quarter space. Journal of Applied Mechanics 37, 70-76.

    Examples
    --------
    >>> round(softening(1e-3, 10e-3, 0.3, 1.0), 3)
    0.039
    """
    image = 1.35 + 0.3 * poissons_ratio + 4.2 * poissons_ratio**2
    return share * image * 2.0 / (3.0 * math.pi) * contact_radius / distance


def _distance(drops: Conditions) -> Array:
    """Return how far the contact is from the nearest edge [m]; NaN where the plate's edges are not known."""
    if drops.size is None or (isinstance(drops.case["plate"].get("mesh"), dict) and "file" in drops.case["plate"]["mesh"]):
        return math.nan
    sides = zip(drops.size[:2], drops.case["drop"]["position"], strict=True)
    return np.minimum(*(0.5 * length - abs(place) for length, place in sides))


def _kept(drops: Conditions) -> Array:
    return _THICKNESSES * drops.size[2] if drops.model("plate") == "elastic" else _RADII * drops.contact_radius


def _number(drops: Conditions) -> Array:
    distance = _distance(drops)
    return distance if np.all(np.isnan(distance)) else _kept(drops) / distance


def _sentence(drop: Conditions, _: float) -> str:
    distance, plate = float(_distance(drop)), drop.materials["plate"]
    share = float(drop.modulus / plate.plane_strain_modulus)
    soft = float(softening(drop.contact_radius, max(distance, float(drop.contact_radius)), plate.poissons_ratio, share))
    if drop.model("plate") == "elastic":
        reach = f"{distance / drop.size[2]:.2g} thicknesses"
    else:
        reach = f"{distance / float(drop.contact_radius):.2g} contact radii"
    return (
        f"the contact is {distance:.3g} m from the edge of the plate, {reach}: a half space is too stiff there, by about "
        f"{100.0 * soft:.2g} % where the edge is free; move drop.position {float(_kept(drop)):.2g} m or more away from the edge"
    )


LIMITS = (
    Limit(
        name="plate_edge",
        title="edge of the plate",
        meaning="distance that the contact should keep from the edge of the plate over the one that it keeps",
        threshold=1.0,
        number=_number,
        sentence=_sentence,
        shown=lambda ratio: f"{1.0 / ratio:.2g} of the distance to keep" if ratio < math.inf else "on the edge",
    ),
)
