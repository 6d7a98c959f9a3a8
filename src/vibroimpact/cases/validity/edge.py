r"""Proximity to an edge: the contact is that of a half space, which is too stiff near an
edge (quarter space).
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.conditions import Conditions
from vibroimpact.cases.limit import Limit
from vibroimpact.materials import RIGID

_RADII, _THICKNESSES = 10.0, 2.0
"""Least distance of the contact from an edge: for a rigid plate in contact radii, where a half
space is 3 to 5 % too stiff; for an elastic plate in thicknesses, beyond which the local deformation
vanishes (it decays as exp(-pi d / h))."""

_NEAR = 2.0  # contact radii: a nearer edge softens more than to first order


def softening(contact_radius: Array, distance: Array, poissons_ratio: Array, share: Array) -> Array:
    r"""Return the relative reduction of contact stiffness near a free edge, to first order in
    contact radius over distance from the edge.

    Under a force F at a distance d from the edge, the indentation of a quarter space exceeds that
    of a half space by
    :math:`\psi (1 - \nu^2) F / (2 \pi E d)`: :math:`\psi` times that due to the mirror image of the
    force. Hertz's indentation is
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
    :math:`\psi = 1.35 + 0.3 \nu + 4.2 \nu^2` is fitted to three-dimensional finite elements, within
    4 %. The problem is that of
    Hetenyi, M. (1970). A general solution for the elastic quarter space. Journal of Applied
    Mechanics 37, 70-76.

    Examples
    --------
    >>> round(softening(1e-3, 10e-3, 0.3, 1.0), 3)
    0.039
    """
    image = 1.35 + 0.3 * poissons_ratio + 4.2 * poissons_ratio**2
    return share * image * 2.0 / (3.0 * math.pi) * contact_radius / distance


def _distance(drops: Conditions) -> Array:
    """Return the distance of the contact from the nearest edge [m]; NaN if the edges of
    the plate are not known.
    """
    if drops.size is None or (
        isinstance(drops.case["plate"].get("mesh"), dict) and "file" in drops.case["plate"]["mesh"]
    ):
        return math.nan
    sides = zip(drops.size[:2], _place(drops), strict=True)
    distance = np.minimum(*(0.5 * length - abs(place) for length, place in sides))
    # beyond an edge it falls past the plate
    return np.where(distance >= 0.0, distance, math.nan)[()]


def _place(drops: Conditions) -> tuple[Array, Array]:
    """Return x and y of the first contact [m], to which an oblique drop flies through a vacuum."""
    drop, inclination = drops.case["drop"], drops.case["plate"].get("inclination") or 0.0
    x, y = drop["position"]
    if drop.get("height") is None or not _is_oblique(drops):
        return x, y
    along_x, along_y, up = drop.get("velocity") or (0.0, 0.0, 0.0)
    down = drop["gravity"] * np.cos(inclination)
    time = (up + np.sqrt(up**2 + 2.0 * down * (drop["height"] - drops.radius))) / down
    return x + along_x * time + 0.5 * drop["gravity"] * np.sin(
        inclination
    ) * time**2, y + along_y * time


def _is_oblique(drops: Conditions) -> bool:
    return "velocity" in drops.case["drop"] or "inclination" in drops.case["plate"]


def _least_distance(drops: Conditions) -> Array:
    """Return the distance from the edge beyond which the half space holds [m]; a rigid
    one holds where it is touched.
    """
    if drops.model("plate") == "elastic":
        return _THICKNESSES * drops.size[2]
    return (1.0 if drops.materials["plate"] is RIGID else _RADII) * drops.contact_radius


def _number(drops: Conditions) -> Array:
    distance = _distance(drops)
    return distance if np.all(np.isnan(distance)) else _least_distance(drops) / distance


def _sentence(drop: Conditions, _: float) -> str:
    distance, plate = float(_distance(drop)), drop.materials["plate"]
    patch, least = float(drop.contact_radius), float(_least_distance(drop))
    reach = (
        f"{distance / drop.size[2]:.2g} thicknesses"
        if drop.model("plate") == "elastic"
        else f"{distance / patch:.2g} contact radii"
    )
    why = "it reaches over the edge, and is computed as on a plane"
    if plate is not RIGID:
        soft = float(
            softening(
                patch,
                max(distance, patch),
                plate.poissons_ratio,
                float(drop.modulus / plate.plane_strain_modulus),
            )
        )
        by = "at least" if distance < _NEAR * patch else "about"
        why = (
            f"a half space is too stiff there, by {by} {100.0 * soft:.2g} % where the edge is free"
        )
    remedy = f"choose drop.position so that it keeps {least:.3g} m"
    if least > 0.5 * float(min(drop.size[:2])):
        remedy = f"take a larger plate, on which it keeps {least:.3g} m"
    about = "about " if _is_oblique(drop) else ""
    return (
        f"the first contact is {about}{distance:.3g} m from the edge of the plate, {reach}: "
        f"{why}; {remedy}"
    )


LIMITS = (
    Limit(
        name="plate_edge",
        title="edge of the plate",
        meaning="distance that the contact should keep from the edge of the plate over the one "
        "that it keeps",
        threshold=1.0,
        number=_number,
        sentence=_sentence,
        shown=lambda ratio: (
            f"{1.0 / ratio:.2g} of the distance to keep" if ratio < math.inf else "on the edge"
        ),
    ),
)
