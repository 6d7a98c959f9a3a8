"""Drops as exporters are told of them, for tests; all bodies rigid."""

from __future__ import annotations

from typing import Any

import vibroimpact as vi
from vibroimpact.bodies.body import Body
from vibroimpact.bodies.rigid_bodies import rigid_plate
from vibroimpact.contact.law import ContactLaw
from vibroimpact.exporting.drop import Drop

ROCK = vi.Material(name="rock", density=1380.0, youngs_modulus=2.26e9, poissons_ratio=0.28)
STEEL = vi.Material(name="steel", density=7850.0, youngs_modulus=2.1e11, poissons_ratio=0.3)
STIFFNESS, RADIUS, MASS = 5.115e8, 0.025, 0.09032


def told(*laws: ContactLaw, **changes: Any) -> Drop:
    """Return the drop of the paper's rock under given laws: three impacts from 0.5 m
    unless changes say otherwise.
    """
    given: dict[str, Any] = {
        "radius": RADIUS,
        "mass": MASS,
        "height": 0.5,
        "gravity": 9.8,
        **changes,
    }
    start: dict[str, Any] = (
        {"height": given["height"]} if not given.get("speed") else {"speed": given["speed"]}
    )
    if given.get("speed"):
        given["height"] = given["radius"]
    impacts = given.pop("number", 3)
    ball = Body(mass=given["mass"], contact_offset=given["radius"])
    start |= {"gravity": given["gravity"], "oblique": given.get("oblique")}
    response = vi.simulate(
        vi.Problem(sphere=ball, plate=rigid_plate(), laws=laws, impacts=impacts, **start)
    )
    facts = {
        "name": "a test",
        "sphere_material": ROCK,
        "plate_material": STEEL,
        "plate_size": (0.52, 0.42, 0.008),
    }
    run = {"laws": laws, "end_time": float(response.end_time[0]), "impacts": response.impacts}
    return Drop(**{**facts, **run, **given})


def told_case(name: str, **changes: Any) -> Drop:
    """Return the drop of a shipped case."""
    problem = vi.load_case(name).to_problem()
    facts = {
        "radius": float(problem.sphere.contact_offset),
        "mass": float(problem.sphere.mass),
        "gravity": float(problem.gravity),
    }
    return told(
        *problem.laws,
        name=name,
        height=float(problem.height),
        number=problem.impacts,
        **{**facts, **changes},
    )
