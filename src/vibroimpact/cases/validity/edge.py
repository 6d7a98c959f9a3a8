r"""Proximity to an edge.

The contact is that of a half space, which is too stiff near an edge (quarter space).
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.cases.limits.conditions import Conditions
from vibroimpact.cases.limits.limit import Effects, Limit, of_force_and_duration
from vibroimpact.materials import RIGID

_RADII = 10.0
"""Least distance from an edge, in contact radii: a half space is 3 to 5 % too stiff there."""

_THICKNESSES = 2.0
"""Least distance from an edge of an elastic plate, in thicknesses.

Beyond, the local deformation vanishes: it decays as exp(-pi d / h).
"""

_NEAR = 2.0  # contact radii: a nearer edge softens more than to first order


def softening(contact_radius: Array, distance: Array, poissons_ratio: Array, share: Array) -> Array:
    r"""Return the relative reduction of contact stiffness near a free edge.

    It is to first order in contact radius over distance from the edge.

    Under a force F at a distance d from the edge, the indentation of a quarter space exceeds that
    of a half space by :math:`\psi (1 - \nu^2) F / (2 \pi E d)`: :math:`\psi` times that due to the
    mirror image of the force. Hertz's indentation is :math:`3 F / (4 E^* a)`.

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
    4 %. The problem is that of Hetenyi, M. (1970). A general solution for the elastic quarter
    space. Journal of Applied Mechanics 37, 70-76.

    Examples
    --------
    >>> round(softening(1e-3, 10e-3, 0.3, 1.0), 3)
    0.039
    """
    image = 1.35 + 0.3 * poissons_ratio + 4.2 * poissons_ratio**2
    return share * image * 2.0 / (3.0 * math.pi) * contact_radius / distance


def _distance(drops: Conditions) -> Array:
    """Return the distance of the contact from the nearest edge [m].

    NaN if the edges of the plate are not known.
    """
    mesh = drops.case["plate"].get("mesh")
    if drops.size is None or (isinstance(mesh, dict) and "file" in mesh):
        return math.nan
    length, width = drops.size[:2]
    x, y = _first_contact(drops)
    distance = np.minimum(0.5 * length - abs(x), 0.5 * width - abs(y))
    # beyond an edge it falls past the plate
    return np.where(distance >= 0.0, distance, math.nan)[()]


def _first_contact(drops: Conditions) -> tuple[Array, Array]:
    """Return x and y of the first contact [m], to which an oblique drop flies through a vacuum."""
    drop = drops.case["drop"]
    x, y = drop["position"]
    if drop.get("height") is None or not _is_oblique(drops):
        return x, y
    inclination = drops.case["plate"].get("inclination") or 0.0
    gravity_down = drop["gravity"] * np.cos(inclination)
    velocity_x, velocity_y, velocity_up = drop.get("velocity") or (0.0, 0.0, 0.0)
    fall = drop["height"] - drops.radius
    time = (velocity_up + np.sqrt(velocity_up**2 + 2.0 * gravity_down * fall)) / gravity_down
    x_of_contact = x + velocity_x * time + 0.5 * drop["gravity"] * np.sin(inclination) * time**2
    return x_of_contact, y + velocity_y * time


def _is_oblique(drops: Conditions) -> bool:
    return "velocity" in drops.case["drop"] or "inclination" in drops.case["plate"]


def _least_distance(drops: Conditions) -> Array:
    """Return the distance from the edge beyond which the half space holds [m].

    A rigid one holds where it is touched.
    """
    if drops.model("plate") == "elastic":
        return _THICKNESSES * drops.size[2]
    radii = 1.0 if drops.materials["plate"] is RIGID else _RADII
    return radii * drops.contact_radius


def _number(drops: Conditions) -> Array:
    distance = _distance(drops)
    if np.all(np.isnan(distance)):
        return distance
    return _least_distance(drops) / distance


def _sentence(drop: Conditions, _: float) -> str:
    distance = float(_distance(drop))
    contact_radius = float(drop.contact_radius)
    if drop.model("plate") == "elastic":
        relative = f"{distance / drop.size[2]:.2g} thicknesses"
    else:
        relative = f"{distance / contact_radius:.2g} contact radii"
    least = float(_least_distance(drop))
    remedy = f"choose drop.position so that it keeps {least:.3g} m"
    if least > 0.5 * float(min(drop.size[:2])):
        remedy = f"take a larger plate, on which it keeps {least:.3g} m"
    about = "about " if _is_oblique(drop) else ""
    return (
        f"the first contact is {about}{distance:.3g} m from the edge of the plate, {relative}: "
        f"{_in_words(drop, distance, contact_radius)}; {remedy}"
    )


def _effects(drop: Conditions, _: float) -> Effects:
    """Return what the edge does to the contact, whose force goes with the power 0.4 of the
    stiffness.
    """
    if drop.materials["plate"] is RIGID:
        return {}
    return of_force_and_duration(0.4 * _reduction(drop))


def _reduction(drop: Conditions) -> float:
    """Return by which part of its stiffness the contact is softer, near an edge that is free."""
    plate = drop.materials["plate"]
    share = float(drop.modulus / plate.plane_strain_modulus)
    contact_radius = float(drop.contact_radius)
    distance = max(float(_distance(drop)), contact_radius)
    return float(softening(contact_radius, distance, plate.poissons_ratio, share))


def _in_words(drop: Conditions, distance: float, contact_radius: float) -> str:
    """Return in words what the edge does to the contact."""
    if drop.materials["plate"] is RIGID:
        return "it reaches over the edge, and is computed as on a plane"
    reduction = _reduction(drop)
    by = "at least" if distance < _NEAR * contact_radius else "about"
    return (
        f"a half space is too stiff there, by {by} {100.0 * reduction:.2g} % where the edge is free"
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
        effects=_effects,
        shown=lambda ratio: (
            f"{1.0 / ratio:.2g} of the distance to keep" if ratio < math.inf else "on the edge"
        ),
    ),
)
