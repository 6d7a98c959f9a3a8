"""Oblique impacts of spheres of alumina on glass that Kharaz, Gorham and Salman measured
(Powder Technol. 120:281, 2001).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

import vibroimpact as vi
from vibroimpact.arrays import Floats
from vibroimpact.calibration.observed.observations import from_table
from vibroimpact.contact.friction.registry import find_friction_law
from vibroimpact.contact.pair import ContactPair, effective_modulus, effective_shear_modulus

ALUMINA = vi.Material(density=4000, youngs_modulus=380e9, poissons_ratio=0.23)
GLASS = vi.Material(density=2500, youngs_modulus=70e9, poissons_ratio=0.25)
RADIUS, SPEED, FRICTION, RESTITUTION = 2.5e-3, 3.85, 0.092, 0.98
ANGLES = np.radians([2.03, 3.93, 9.63, 20.08, 30.22, 39.30, 49.55, 59.84])
MEASURED = np.array([0.794, 0.745, 0.673, 0.596, 0.688, 0.772, 0.847, 0.902])


ALL, STICKING, SLIPPING = slice(None), slice(4), slice(4, None)
"""All impacts, those that stick in part, and those that slip throughout, or nearly so."""


def problem_of(friction: str, **parameters: Any) -> vi.Problem:
    """Return the problem of impacts at the eight angles under a friction law."""
    ball = vi.rigid_sphere(RADIUS, ALUMINA)
    pair = ContactPair(
        effective_modulus(ALUMINA, GLASS),
        RADIUS,
        ball.mass,
        effective_shear_modulus=effective_shear_modulus(ALUMINA, GLASS),
    )
    law = vi.laws.find_contact_law("lankarani-nikravesh").for_pair(pair, restitution=RESTITUTION)
    oblique = vi.Oblique(
        velocity=(SPEED * np.sin(ANGLES), 0.0),
        friction=find_friction_law(friction).for_pair(pair, coefficient=FRICTION, **parameters),
    )
    return vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(law,),
        speed=SPEED * np.cos(ANGLES),
        gravity=0.0,
        impacts=1,
        oblique=oblique,
    )


def tangential_restitution(friction: str, **parameters: Any) -> Floats:
    """Return the tangential restitution at the eight angles under a friction law."""
    found: Floats = vi.tabulate(problem_of(friction, **parameters)).impacts[
        "tangential_restitution"
    ][:, 0]
    return found


def fitted_friction(friction: str, rows: slice, *more: str) -> vi.calibration.FrictionCalibration:
    """Return the coefficient of friction, and more parameters, that fit the measured
    restitutions of some of the angles.
    """
    angles, wanted = ANGLES[rows], {"tangential_restitution": MEASURED[rows]}
    seen = from_table(
        SPEED * np.cos(angles),
        wanted,
        {name: np.ones(len(angles)) for name in wanted},
        tuple("abcdefgh"[: len(angles)]),
    )
    impacts = vi.calibration.ObliqueImpacts(
        replace(seen, deviations_known=False), SPEED * np.sin(angles), np.zeros(len(angles)), wanted
    )
    return vi.calibration.calibrate_friction(
        problem_of(friction).take(0), impacts, ["friction.coefficient", *more]
    )
