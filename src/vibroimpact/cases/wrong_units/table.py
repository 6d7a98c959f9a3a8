"""The table of the keys that are checked for slips of units, with their plausible ranges.

The ranges are far wider than those in use (rubber to diamond, dust to boulders, foils to slabs),
and narrower only where other values of the case give an estimate: Hertz's stiffness for a
stiffness, critical damping for a damping, the fall for a duration.
"""

from __future__ import annotations

from vibroimpact.cases.wrong_units import rules
from vibroimpact.cases.wrong_units.plausible import CheckedKey, between, near

_LENGTHS = ("mm", "cm", "um")
_SPEEDS = ("mm/s", "cm/s")
_TIMES = ("ms", "us")
_FREQUENCIES = ("kHz", "MHz")
_FORCES = ("kN", "MN")
_MODULI = ("GPa", "MPa", "kPa")
_STRENGTHS = ("MPa", "GPa", "kPa")
_HARDNESSES = ("kgf/mm^2", "GPa", "MPa")
_STIFFNESSES = ("N/mm", "kN/mm", "kN/m", "MN/m")
_LAW_STIFFNESSES = ("N/mm^n", "kN/mm^n", "kN/m^n", "MN/m^n", "GN/m^n")
_DAMPINGS = ("N s/mm", "kN s/m")
_ACCELERATIONS = ("mm/s^2", "cm/s^2")


def _material(at: str) -> tuple[CheckedKey, ...]:
    """Return the checked keys of the material at a key."""
    return (
        CheckedKey(f"{at}.density", "kg/m^3", ("g/cm^3", "kg/mm^3", "t/mm^3"), rules.density),
        CheckedKey(f"{at}.youngs_modulus", "Pa", _MODULI, rules.elastic_modulus),
        *(
            CheckedKey(f"{at}.{name}_strength", "Pa", _STRENGTHS, rules.strength)
            for name in ("yield", "compressive", "tensile")
        ),
        CheckedKey(f"{at}.hardness", "Pa", _HARDNESSES, rules.hardness),
    )


_LARGEST_FORCE = near(lambda estimate: estimate.force, "Hertz's largest force,", "N")
_REBOUND = between(high=300.0, above="is very high")

CHECKED_KEYS: tuple[CheckedKey, ...] = (
    *_material("sphere.material"),
    *_material("plate.material"),
    *(
        CheckedKey(
            f"plate.size.{side}",
            "m",
            _LENGTHS,
            between(high=60.0, above="is very long for a plate"),
        )
        for side in ("length", "width")
    ),
    CheckedKey("plate.size.thickness", "m", _LENGTHS, rules.plate_thickness),
    CheckedKey("plate.radius", "m", _LENGTHS, rules.sphere_radius),
    CheckedKey("sphere.radius", "m", _LENGTHS, rules.sphere_radius),
    CheckedKey("sphere.mass", "kg", ("g", "mg"), rules.sphere_mass),
    CheckedKey(
        "sphere.inertia",
        "kg m^2",
        ("kg cm^2", "g m^2", "kg mm^2", "g cm^2", "g mm^2"),
        rules.sphere_inertia,
    ),
    CheckedKey("drop.height", "m", _LENGTHS, between(high=300.0, above="is very high")),
    CheckedKey("drop.speed", "m/s", _SPEEDS, between(high=1000.0, above="is very fast")),
    CheckedKey("drop.gravity", "m/s^2", _ACCELERATIONS, rules.gravitational_acceleration),
    CheckedKey("contact.stiffness", "N/m^n", _LAW_STIFFNESSES, rules.contact_stiffness),
    CheckedKey("contact.penalty", "N/m", _STIFFNESSES, rules.contact_stiffness),
    CheckedKey("contact.damping_max", "N s/m", _DAMPINGS, rules.contact_damping),
    CheckedKey("contact.damping", "N s/m", _DAMPINGS, rules.contact_damping),
    CheckedKey(
        "contact.full_damping_penetration", "m", ("mm", "um"), rules.full_damping_penetration
    ),
    CheckedKey("contact.effective_modulus", "Pa", _MODULI, rules.elastic_modulus),
    CheckedKey("contact.yield_strength", "Pa", _STRENGTHS, rules.strength),
    CheckedKey("contact.yield_pressure", "Pa", _STRENGTHS, rules.strength),
    CheckedKey(
        "contact.effective_radius",
        "m",
        _LENGTHS,
        near(lambda estimate: estimate.radius, "the sphere's", "m", factor=100.0, within=5.0),
    ),
    CheckedKey(
        "contact.effective_mass",
        "kg",
        ("g",),
        near(lambda estimate: estimate.mass, "the sphere's", "kg", factor=100.0, within=5.0),
    ),
    CheckedKey(
        "contact.work_of_adhesion",
        "J/m^2",
        ("mJ/m^2",),
        between(high=20.0, above="is very much for two surfaces"),
    ),
    CheckedKey("contact.dissipation_time", "s", ("us", "ms"), rules.dissipation_time),
    CheckedKey(
        "contact.local_stiffness",
        "N/m",
        _STIFFNESSES,
        near(lambda estimate: estimate.force / estimate.depth, "Hertz's", "N/m", factor=3000.0),
    ),
    CheckedKey("contact.measured.max_force", "N", _FORCES, _LARGEST_FORCE),
    CheckedKey("contact.measured.rebound_height", "m", _LENGTHS, _REBOUND),
    CheckedKey("calibrate.target.max_force", "N", _FORCES, _LARGEST_FORCE),
    CheckedKey(
        "calibrate.target.duration",
        "s",
        _TIMES,
        near(lambda estimate: estimate.contact_time, "the duration of Hertz's contact,", "s"),
    ),
    CheckedKey(
        "calibrate.target.max_indentation",
        "m",
        _LENGTHS,
        near(lambda estimate: estimate.depth, "Hertz's largest indentation,", "m"),
    ),
    CheckedKey("calibrate.target.rebound_height", "m", _LENGTHS, _REBOUND),
    CheckedKey("calibrate.target.rebound_heights", "m", _LENGTHS, _REBOUND),
    CheckedKey("run.duration", "s", _TIMES, rules.run_duration),
    CheckedKey("run.rest_speed", "m/s", _SPEEDS, rules.rest_speed),
    *_material("plate.supports.#.material"),
    CheckedKey("plate.supports.#.stiffness", "N/m", _STIFFNESSES, rules.support_stiffness),
    CheckedKey(
        "plate.supports.#.length",
        "m",
        _LENGTHS,
        between(high=50.0, above="is very long for a column"),
    ),
    CheckedKey("plate.mesh.element_size", "m", _LENGTHS, rules.element_size),
    CheckedKey("plate.mesh.margin", "m", _LENGTHS, rules.margin),
    CheckedKey("sphere.max_frequency", "Hz", _FREQUENCIES, rules.modal_frequency),
    CheckedKey("plate.max_frequency", "Hz", _FREQUENCIES, rules.modal_frequency),
    CheckedKey("sensors.#.rate", "Hz", _FREQUENCIES, rules.sampling_rate),
    CheckedKey("sensors.#.corner", "Hz", _FREQUENCIES, rules.filter_corner),
    CheckedKey(
        "sensors.#.accelerometer.resonance",
        "Hz",
        _FREQUENCIES,
        between(
            100.0,
            1e8,
            below="is very low for an accelerometer",
            above="is very high for an accelerometer",
        ),
    ),
    CheckedKey(
        "sensors.#.geophone.natural_frequency",
        "Hz",
        _FREQUENCIES,
        between(
            0.01, 500.0, below="is very low for a geophone", above="is very high for a geophone"
        ),
    ),
    CheckedKey("sensors.#.accelerometer.noise", "m/s^2", _ACCELERATIONS, rules.below_sensor_range),
    CheckedKey(
        "sensors.#.accelerometer.resolution", "m/s^2", _ACCELERATIONS, rules.below_sensor_range
    ),
)
"""Checked keys, in an order in which a value precedes those whose range depends on it."""
