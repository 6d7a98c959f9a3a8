"""The Adams model of a drop, in Adams' units MMKS: millimetres, kilograms, newtons and seconds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from textwrap import wrap
from typing import Any, NamedTuple

from vibroimpact.calibration.contact_law.adams_dialog import dialog_rows
from vibroimpact.exporting.adams_contact import AdamsContact, Names, adams_contact
from vibroimpact.exporting.adams_motion import AdamsMotion, adams_friction, adams_motion
from vibroimpact.exporting.adams_text import LINE
from vibroimpact.exporting.contact_parameters import (
    first_contact,
    is_lossless,
    laws_of_impacts,
    shared_notes,
    unknown_damping_note,
)
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.program_friction import friction_notes
from vibroimpact.files.plain_names import identifier, plain_words
from vibroimpact.materials import Material

_STEPS = 50
"""Least number of integration steps per contact."""

_OUTPUTS = 20
"""Least number of outputs per contact."""

_LONGEST_NAME = 40

_OWN_NAMES = {
    *("ground", "spot", "corner", "plate", "sphere", "cm", "ball"),
    *("touch", "approach_speed", "damping", "contact", "gravity", "motion", "drop"),
    *("slip_x", "slip_y", "drag", "friction", "opposite", "along_plate"),
}
"""Names of the other elements of the model, which a material may not have."""

ACCURACY = 1e-6
"""Error tolerance of the integrator; of displacements [mm]."""

SENSOR_ERROR = 1e-4
"""Tolerance of the sensor on the gap [mm]: 1/1000 of Adams' penetration of full damping."""

TESTED = (
    "a strict parser of the documented syntax, which integrates the contact of what it "
    "reads; restitution, peak force and rebound "
    "heights of vibroimpact's drops between rigid bodies within 1e-7, velocities after "
    "friction within 2e-5. No Adams was run"
)


class MaterialData(NamedTuple):
    """A material: density [kg/mm^3], Young's modulus [N/mm^2], Poisson's ratio."""

    name: str
    density: float
    youngs_modulus: float
    poissons_ratio: float


@dataclass(frozen=True)
class AdamsModel:
    """The model; the plate's upper surface is z = 0, z upwards; `plate` is its size [mm],
    None if unknown.
    """

    name: str
    title: str
    contact: AdamsContact
    mass: float
    inertia_ratio: float
    centre: tuple[float, float, float]
    velocity: float
    motion: AdamsMotion | None
    plate: tuple[float, float, float] | None
    materials: tuple[MaterialData, ...]
    notes: tuple[str, ...]
    end: float
    longest_step: float
    output_step: float

    @property
    def radius(self) -> float:
        """Radius of the sphere [mm]."""
        return self.contact.radius

    @property
    def inertia(self) -> float:
        """Moment of inertia of the sphere about any axis through its centre [kg mm^2]."""
        return self.inertia_ratio * self.mass * self.radius**2

    @property
    def pull(self) -> tuple[float, float, float]:
        """Acceleration of gravity [mm/s^2]."""
        if self.motion is None:
            return 0.0, 0.0, -self.contact.gravity
        return *self.motion.gravity, -self.contact.gravity

    @property
    def spot(self) -> tuple[float, float, float]:
        """The point of the plate below the sphere at the start [mm]."""
        x, y, _ = self.centre
        return x, y, 0.0

    @property
    def corner(self) -> tuple[float, float, float]:
        """The lower corner of the plate from which it reaches along x, y and z [mm]."""
        assert self.plate is not None
        length, width, thickness = self.plate
        return -0.5 * length, -0.5 * width, -thickness


def adams_model(drop: Drop) -> AdamsModel:
    """Return the Adams model of a drop.

    Raises
    ------
    InputError
        If its contact law is not supported, or it has no impact.
    """
    contact = adams_contact(drop)
    duration, _ = first_contact(laws_of_impacts(drop)[0], drop)
    materials = [drop.sphere_material]
    if drop.plate_material != drop.sphere_material:
        materials.append(drop.plate_material)
    x, y = drop.position
    plate = None
    if drop.plate_size is not None:
        length, width, thickness = drop.plate_size
        plate = (1e3 * length, 1e3 * width, 1e3 * thickness)
    return AdamsModel(
        name=legal_name(drop.name),
        # without underscores: Adams View takes a comment adams_view_name='...' as the name of the
        # next element
        title=f'the case "{plain_words(drop.name).replace("_", " ")}"',
        contact=contact,
        mass=drop.mass,
        inertia_ratio=drop.inertia_ratio,
        centre=(1e3 * x, 1e3 * y, 1e3 * drop.height),
        velocity=-1e3 * drop.speed,
        motion=adams_motion(drop),
        plate=plate,
        materials=_material_data([material for material in materials if _is_elastic(material)]),
        notes=tuple(adams_notes(drop)),
        end=drop.end_time,
        longest_step=_round_down(duration / _STEPS),
        output_step=_round_down(duration / _OUTPUTS),
    )


def adams_notes(drop: Drop) -> list[str]:
    """Return the limitations of the model."""
    notes = [*shared_notes(drop), *friction_notes(drop, "Adams", adams_friction(drop))]
    if not drop.notes and is_lossless(drop.impacts):
        notes.append(unknown_damping_note(drop.laws[0]))
    return notes


def adams_dialog(drop: Drop) -> list[dict[str, Any]]:
    """Return the fields of the dialog of a contact for each impact; none if the law is
    not IMPACT.
    """
    return dialog_rows(laws_of_impacts(drop))


def remarks(model: AdamsModel) -> list[str]:
    """Return the remarks at the head of the file, one line each."""
    contact = model.contact
    # Adams' IMPACT reaches its damping at a penetration
    damping = "hysteretic damping factor D [-]"
    if contact.penetration is not None:
        damping = "largest damping C [N s/mm]"
    lines = [
        "written by vibroimpact; units: mm, kg, N, s (MMKS); z is up, the plate's upper "
        "surface is z = 0",
        "the plate is part of the ground; both bodies are rigid, and do not use the materials",
        f"stiffness in N/mm^n = that in N/m^n over 1000^n, n = {contact.exponent:g}",
        f"{damping}: {contact.meaning}",
        f"the longest step is about 1/{_STEPS} of the first contact, the output step about "
        f"1/{_OUTPUTS}: with steps as long as the contact "
        "it gets one output or none, and the largest force is missed",
    ]
    if contact.holds_speed:
        lines.append(
            "the sensor is true while the sphere is free; it then stores the speed of the "
            "next touch, from the energy, which is "
            "the same at any moment of a flight; in contact it is false, and the value is held"
        )
    if model.motion is not None:
        lines.append(
            "friction is the coefficient times the contact force, against the slip; a slip "
            "that is not large beside "
            f"{model.motion.creep:.3g} mm/s has less"
        )
    return [*lines, *model.notes]


def legal_name(text: str) -> str:
    """Return a valid Adams name: letters, digits and underscores, not starting with a digit.

    Examples
    --------
    >>> legal_name("the paper's Type 1"), legal_name("4 m"), legal_name("")
    ('the_paper_s_Type_1', 'drop_4_m', 'drop')
    """
    name = identifier(text, "A-Za-z0-9", "drop", longest=_LONGEST_NAME)
    return f"drop_{name}" if name[0].isdigit() else name


def header_lines(model: AdamsModel) -> list[str]:
    """Return the lines of the comment at the head of a file, without their marks."""
    return [
        line
        for remark in (model.title, *remarks(model))
        for line in wrap(remark, LINE - 2, break_on_hyphens=False)
    ]


def adams_quantities(model: AdamsModel, names: Names, contact: str) -> dict[str, Any]:
    """Return what the templates of Adams View and Adams/Solver name, in Adams' units; functions
    are run-time expressions.

    Parameters
    ----------
    model : AdamsModel
        The model.
    names : Names
        References to its elements.
    contact : str
        Reference to the force element of the contact.
    """
    quantities: dict[str, Any] = {
        "model": model,
        "names": names,
        "header_lines": header_lines(model),
        "diameter": 2.0 * model.radius,
        "oblique": model.motion is not None,
        "stores_approach_speed": model.contact.holds_speed,
        "damping_varies": model.contact.varies,
        "sensor_error": SENSOR_ERROR,
        "error_tolerance": ACCURACY,
        "gap": model.contact.gap(names),
        "speed_at_touch": model.contact.coming_speed(names),
        "stored_approach_speed": model.contact.held_speed(names),
        "damping": model.contact.damping_now(names),
        "contact_force": model.contact.force(names),
        "requests": {"motion": model.contact.readings(names, contact)},
    }
    if model.motion is not None:
        components = model.motion.components(names)
        quantities["velocity_along_plate"] = model.motion.velocity
        quantities["spin"] = model.motion.spin
        # Adams View takes angles in degrees, Adams/Solver in radians
        quantities["spin_in_degrees"] = [math.degrees(spin) for spin in model.motion.spin]
        quantities["friction_variables"] = model.motion.variables(names, contact)
        quantities["friction_force"] = components[:3]
        quantities["friction_torque"] = components[3:]
        quantities["requests"]["along_plate"] = model.motion.readings(names)
    return quantities


def _is_elastic(material: Material) -> bool:
    return math.isfinite(material.density) and math.isfinite(material.youngs_modulus)


def _material_data(materials: list[Material]) -> tuple[MaterialData, ...]:
    """Return materials with names distinct from each other and from those of other
    elements, ignoring case.
    """
    names: list[str] = []
    for material in materials:
        name = legal_name(material.name or "material")
        # Adams does not tell upper from lower case
        taken = _OWN_NAMES | {other.lower() for other in names}
        if name.lower() in taken:
            name = f"{name}_material_{len(names) + 1}"
        names.append(name)
    return tuple(
        MaterialData(
            name=name,
            density=1e-9 * material.density,
            youngs_modulus=1e-6 * material.youngs_modulus,
            poissons_ratio=material.poissons_ratio,
        )
        for name, material in zip(names, materials, strict=True)
    )


def _round_down(value: float) -> float:
    """Return a number rounded down to two digits.

    Examples
    --------
    >>> _round_down(5.39e-6), _round_down(0.0999)
    (5.3e-06, 0.099)
    """
    scale = 10.0 ** (1 - math.floor(math.log10(value)))
    return float(f"{math.floor(value * scale) / scale:.1e}")
