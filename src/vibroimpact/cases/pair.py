"""The falling sphere of a case as a rigid body, and the contact pair: what contact and
friction laws take from the bodies.
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
    from vibroimpact.cases.schema import CaseTable, SphereSection


@derived
def ball_of(sphere: SphereSection) -> Body:
    """Return the falling sphere of a case as a rigid body, with the mass and the moment
    of inertia that are given.
    """
    return rigid_sphere(sphere.radius, sphere.material, mass=sphere.mass, inertia=sphere.inertia)


def sphere_density(sphere: SphereSection) -> Array:
    """Return the mass of the falling sphere over its volume [kg/m^3]."""
    return mean_density(ball_of(sphere).mass, sphere.radius)


def resized(sphere: SphereSection, radius: Array) -> SphereSection:
    """Return a sphere of another radius [m], of the same mean density, and as far from solid."""
    ball, changed = ball_of(sphere), {"radius": radius}
    if sphere.mass is not None:
        changed["mass"] = ball.mass * (radius / sphere.radius) ** 3
    if sphere.inertia is not None and not isinstance(sphere.inertia, str):
        changed["inertia"] = sphere.inertia * (radius / sphere.radius) ** 5
    return sphere.model_copy(update=changed)


@derived
def contact_pair(case: CaseTable) -> ContactPair:
    """Return the contact pair of a case: effective modulus, radius and mass, and the
    yield strength of the weaker body.
    """
    modulus, below = effective_modulus(case.sphere.material, case.plate.material), case.plate.radius
    mass, radius = ball_of(case.sphere).mass, case.sphere.radius
    if below is not None:
        radius = radius * below / (radius + below)
    if is_free_sphere(case):
        mass_below = rigid_sphere(below, case.plate.material).mass
        mass = mass * mass_below / (mass + mass_below)
    strength: Array | None = None
    ratio: Array = case.sphere.material.poissons_ratio
    for material in (case.sphere.material, case.plate.material):
        if material.yield_strength is None:
            continue
        weaker = np.less(material.yield_strength, np.inf if strength is None else strength)
        strength = np.where(
            weaker, material.yield_strength, np.inf if strength is None else strength
        )[()]
        ratio = np.where(weaker, material.poissons_ratio, ratio)[()]
    return ContactPair(
        modulus,
        radius,
        mass,
        strength,
        ratio,
        effective_shear_modulus(case.sphere.material, case.plate.material),
    )


def is_free_sphere(case: CaseTable) -> bool:
    """Return whether a free sphere replaces the plate."""
    return case.plate.radius is not None and case.plate.supports == "free"
