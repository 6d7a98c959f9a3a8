"""The falling sphere of a case as a rigid body, and the contact pair.

This is what contact and friction laws take from the bodies.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.bodies.ball import mean_density
from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid_bodies import rigid_sphere
from vibroimpact.cases.fields.section import derived
from vibroimpact.contact.pair import ContactPair, effective_modulus, effective_shear_modulus

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable, SphereSection


@derived
def ball_of(sphere: SphereSection) -> Body:
    """Return the falling sphere of a case as a rigid body.

    It has the mass and the moment of inertia that are given.
    """
    return rigid_sphere(sphere.radius, sphere.material, mass=sphere.mass, inertia=sphere.inertia)


def sphere_density(sphere: SphereSection) -> Array:
    """Return the mass of the falling sphere over its volume [kg/m^3]."""
    return mean_density(ball_of(sphere).mass, sphere.radius)


def resized(sphere: SphereSection, radius: Array) -> SphereSection:
    """Return a sphere of another radius [m], of the same mean density, and as far from solid."""
    changes = {"radius": radius}
    if sphere.mass is not None:
        changes["mass"] = ball_of(sphere).mass * (radius / sphere.radius) ** 3
    # an inertia that is a name, such as that of a shell, goes with any size
    if sphere.inertia is not None and not isinstance(sphere.inertia, str):
        changes["inertia"] = sphere.inertia * (radius / sphere.radius) ** 5
    return sphere.model_copy(update=changes)


@derived
def contact_pair(case: CaseTable) -> ContactPair:
    """Return the contact pair of a case.

    It has effective moduli, radius and mass, and the yield strength of the weaker body.
    """
    sphere = case.sphere
    radius: Array = sphere.radius
    radius_below = case.plate.radius
    if radius_below is not None:
        radius = radius * radius_below / (radius + radius_below)
    mass = ball_of(sphere).mass
    if is_free_sphere(case):
        mass_below = rigid_sphere(radius_below, case.plate.material).mass
        mass = mass * mass_below / (mass + mass_below)
    yield_strength, poissons_ratio = _weaker_material(case)
    return ContactPair(
        effective_modulus=effective_modulus(sphere.material, case.plate.material),
        effective_radius=radius,
        effective_mass=mass,
        yield_strength=yield_strength,
        poissons_ratio=poissons_ratio,
        effective_shear_modulus=effective_shear_modulus(sphere.material, case.plate.material),
    )


def _weaker_material(case: CaseTable) -> tuple[Array | None, Array]:
    """Return the lower yield strength of the two materials [Pa], and Poisson's ratio of this one.

    None and the ratio of the sphere if no yield strength is known.
    """
    strength: Array | None = None
    ratio: Array = case.sphere.material.poissons_ratio
    for material in (case.sphere.material, case.plate.material):
        if material.yield_strength is None:
            continue
        lowest = np.inf if strength is None else strength
        is_weaker = np.less(material.yield_strength, lowest)
        strength = np.where(is_weaker, material.yield_strength, lowest)[()]
        ratio = np.where(is_weaker, material.poissons_ratio, ratio)[()]
    return strength, ratio


def is_free_sphere(case: CaseTable) -> bool:
    """Return whether a free sphere replaces the plate."""
    return case.plate.radius is not None and case.plate.supports == "free"
