r"""Proximity to an edge: the contact is that of a half space, which is too stiff near an edge (quarter space)."""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.conditions import Conditions
from vibroimpact.cases.limit import Limit

_RADII, _THICKNESSES = 10.0, 2.0
"""Least distance of the contact from an edge: for a rigid plate in contact radii, where a half space is 3 to 5 % too stiff; for an elastic
plate in thicknesses, beyond which the local deformation vanishes (it decays as exp(-pi d / h))."""


def softening(contact_radius: Array, distance: Array, poissons_ratio: Array, share: Array) -> Array:
    r"""Return the relative reduction of contact stiffness near a free edge, to first order in contact radius over distance from the edge.

    Under a force F at a distance d from the edge, the indentation of a quarter space exceeds that of a half space by
    :math:`\psi (1 - \nu^2) F / (2 \pi E d)`: :math:`\psi` times that due to the mirror image of the force. Hertz's indentation is
    :math:`3 F / (4 E^* a)`.

    Parameters
    ----------
    contact_radius, distance : float or array
        Contact radius a and distance d of its centre from the edge [m].
    poissons_ratio : float or array
        Poisson's ratio of the plate.
    share : float or array
        Share of the plate in the compliance of the contact.

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
    """Return the distance of the contact from the nearest edge [m]; NaN if the edges of the plate are not known."""
    if drops.size is None or (isinstance(drops.case["plate"].get("mesh"), dict) and "file" in drops.case["plate"]["mesh"]):
        return math.nan
    sides = zip(drops.size[:2], drops.case["drop"]["position"], strict=True)
    return np.minimum(*(0.5 * length - abs(place) for length, place in sides))


def _least_distance(drops: Conditions) -> Array:
    """Return the distance from the edge beyond which the half space holds [m]."""
    return _THICKNESSES * drops.size[2] if drops.model("plate") == "elastic" else _RADII * drops.contact_radius


def _number(drops: Conditions) -> Array:
    distance = _distance(drops)
    return distance if np.all(np.isnan(distance)) else _least_distance(drops) / distance


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
        f"{100.0 * soft:.2g} % where the edge is free; move drop.position to {float(_least_distance(drop)):.3g} m or more from it"
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
