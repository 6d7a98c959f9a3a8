"""The table of what is plausible, key by key: the numbers of a case that a slip of a unit can spoil.

The ranges are far wider than anything in use (rubber to diamond, dust to boulders, foils to slabs), and narrower only where the other
numbers of the case tell more: Hertz's stiffness for a stiffness, critical damping for a damping, the fall for a duration.
"""

from __future__ import annotations

from vibroimpact.cases.slips import rules
from vibroimpact.cases.slips.plausible import Place, about, between

_LENGTHS = ("mm", "cm", "um")
_SPEEDS = ("mm/s", "cm/s")
_TIMES = ("ms", "us")
_FREQUENCIES = ("kHz", "MHz")
_FORCES = ("kN", "MN")
_MODULI = ("GPa", "MPa", "kPa")
_STRENGTHS = ("MPa", "GPa", "kPa")
_STIFFNESSES = ("N/mm", "kN/mm", "kN/m", "MN/m")
_LAW_STIFFNESSES = ("N/mm^n", "kN/mm^n", "kN/m^n", "MN/m^n", "GN/m^n")
_DAMPINGS = ("N s/mm", "kN s/m")
_ACCELERATIONS = ("mm/s^2", "cm/s^2")


def _material(at: str) -> tuple[Place, ...]:
    return (
        Place(f"{at}.density", "kg/m^3", ("g/cm^3", "kg/mm^3", "t/mm^3"), rules.density),
        Place(f"{at}.youngs_modulus", "Pa", _MODULI, rules.modulus),
        *(Place(f"{at}.{name}_strength", "Pa", _STRENGTHS, rules.strength) for name in ("yield", "compressive", "tensile")),
    )


_LARGEST_FORCE = about(lambda facts: facts.force, "Hertz's largest force,", "N")
_REBOUND = between(high=300.0, above="is higher than a tower")

PLACES: tuple[Place, ...] = (
    *_material("sphere.material"),
    *_material("plate.material"),
    *(Place(f"plate.size.{side}", "m", _LENGTHS, between(high=60.0, above="is longer than any plate")) for side in ("length", "width")),
    Place("plate.size.thickness", "m", _LENGTHS, rules.thickness),
    Place("plate.radius", "m", _LENGTHS, rules.radius),
    Place("sphere.radius", "m", _LENGTHS, rules.radius),
    Place("drop.height", "m", _LENGTHS, between(high=300.0, above="is higher than a tower")),
    Place("drop.speed", "m/s", _SPEEDS, between(high=1000.0, above="is faster than a bullet")),
    Place("drop.gravity", "m/s^2", _ACCELERATIONS, rules.gravity),
    Place("contact.stiffness", "N/m^n", _LAW_STIFFNESSES, rules.law_stiffness),
    Place("contact.penalty", "N/m", _STIFFNESSES, rules.law_stiffness),
    Place("contact.damping_max", "N s/m", _DAMPINGS, rules.damping),
    Place("contact.damping", "N s/m", _DAMPINGS, rules.damping),
    Place("contact.full_damping_penetration", "m", ("mm", "um"), rules.full_damping),
    Place("contact.effective_modulus", "Pa", _MODULI, rules.modulus),
    Place("contact.yield_strength", "Pa", _STRENGTHS, rules.strength),
    Place("contact.yield_pressure", "Pa", _STRENGTHS, rules.strength),
    Place("contact.effective_radius", "m", _LENGTHS, about(lambda facts: facts.radius, "the sphere's", "m", factor=100.0, within=5.0)),
    Place("contact.effective_mass", "kg", ("g",), about(lambda facts: facts.mass, "the sphere's", "kg", factor=100.0, within=5.0)),
    Place("contact.work_of_adhesion", "J/m^2", ("mJ/m^2",), between(high=20.0, above="is more than any two surfaces have")),
    Place("contact.dissipation_time", "s", ("us", "ms"), rules.dissipation_time),
    Place("contact.local_stiffness", "N/m", _STIFFNESSES, about(lambda facts: facts.force / facts.depth, "Hertz's", "N/m", factor=3000.0)),
    Place("contact.measured.max_force", "N", _FORCES, _LARGEST_FORCE),
    Place("contact.measured.rebound_height", "m", _LENGTHS, _REBOUND),
    Place("calibrate.target.max_force", "N", _FORCES, _LARGEST_FORCE),
    Place("calibrate.target.duration", "s", _TIMES, about(lambda facts: facts.contact_time, "the duration of Hertz's contact,", "s")),
    Place("calibrate.target.max_indentation", "m", _LENGTHS, about(lambda facts: facts.depth, "Hertz's largest indentation,", "m")),
    Place("calibrate.target.rebound_height", "m", _LENGTHS, _REBOUND),
    Place("calibrate.target.rebound_heights", "m", _LENGTHS, _REBOUND),
    Place("run.duration", "s", _TIMES, rules.duration),
    Place("run.rest_speed", "m/s", _SPEEDS, rules.rest_speed),
    *_material("plate.supports.#.material"),
    Place("plate.supports.#.stiffness", "N/m", _STIFFNESSES, rules.spring),
    Place("plate.supports.#.length", "m", _LENGTHS, between(high=50.0, above="is longer than any column")),
    Place("plate.mesh.element_size", "m", _LENGTHS, rules.part_of_plate(1.0, "is more than the plate is long")),
    Place("plate.mesh.margin", "m", _LENGTHS, rules.part_of_plate(0.5, "is more than half the plate")),
    Place("sphere.max_frequency", "Hz", _FREQUENCIES, rules.periods),
    Place("plate.max_frequency", "Hz", _FREQUENCIES, rules.periods),
    Place("sensors.#.rate", "Hz", _FREQUENCIES, rules.rate),
    Place("sensors.#.corner", "Hz", _FREQUENCIES, rules.corner),
    Place(
        "sensors.#.accelerometer.resonance",
        "Hz",
        _FREQUENCIES,
        between(100.0, 1e8, below="is lower than any accelerometer's", above="is higher than any accelerometer's"),
    ),
    Place("sensors.#.accelerometer.noise", "m/s^2", _ACCELERATIONS, rules.below_range),
    Place("sensors.#.accelerometer.resolution", "m/s^2", _ACCELERATIONS, rules.below_range),
)
"""What is plausible at each key; what others are held to stands before them."""
