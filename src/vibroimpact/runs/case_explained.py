"""Explanation of a case in a terminal: resolved values, expected contact, cost and doubts."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator
from dataclasses import fields

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.costs import describe_costs
from vibroimpact.cases.doubts import doubts
from vibroimpact.cases.fields.fluid import fluid_words
from vibroimpact.cases.fields.sensor import SensorSection
from vibroimpact.cases.limits.conditions import DropSummary
from vibroimpact.cases.rigid.expected import expected_of, first_restitution
from vibroimpact.cases.rigid.oblique import friction_law_of, is_oblique
from vibroimpact.cases.rigid.pair import ball_of, contact_pair, is_free_sphere, sphere_density
from vibroimpact.cases.rigid.plate_motion import motion_length
from vibroimpact.cases.rigid.rigid_problem import (
    by_speed_of,
    contact_laws_of,
    deforms,
    elastic_names,
    mass_of_sphere,
    rigid_problem,
    touch_speed,
)
from vibroimpact.cases.rigid.run_ends import ends_of_run
from vibroimpact.contact.law import CompliantLaw, unit_of
from vibroimpact.dynamics.fluids.liquid import restitution_kept
from vibroimpact.dynamics.sensors.instruments.registry import instruments
from vibroimpact.materials import RIGID, Material
from vibroimpact.report.terminal_report import warning_lines
from vibroimpact.report.terminal_table import facts
from vibroimpact.units.display import STANDARD_GRAVITY

# relative difference of the mean density of a sphere from that of its material, up to which it may
# be solid
_LIKE_SOLID = 0.1


def _plate_text(case: Case) -> str:
    """Return a description of the plate, or of the sphere in its place."""
    plate = case.plate
    if plate.radius is not None:
        held = "free" if plate.supports == "free" else "rigid, held fixed"
        return f"in its place a sphere, radius {plate.radius:g} m, {held}"
    if plate.model != "rigid":
        description = "elastic"
    elif plate.motion is None:
        description = "rigid, held fixed"
    else:
        description = "rigid, moved with its supports"
    if plate.size:
        description += f", {' x '.join(f'{side:g}' for side in plate.size)} m"
    return description


def case_explained(case: Case, aside: Container[str] = ()) -> RenderableType:
    """Return the explanation of a case: resolved values, expected contact, cost, and doubts.

    Parameters
    ----------
    case : Case
        The case; it is not run.
    aside : container of str
        Keys of the case whose implausible values are reported elsewhere, and not doubted here.
    """
    law = contact_laws_of(case)[0]
    expected = expected_of(case)
    rows = [
        *_body_rows(case),
        *_drop_rows(case),
        ("contact law", f"{case.contact.law}: {law.equation}"),
        *_parameter_rows(case),
        *_liquid_rows(case),
        *_friction_rows(case),
        ("stops", " or ".join(_ends_of_a_run(case))),
        ("tolerance", f"{case.run.tolerance:g}"),
        *_calibration_rows(case),
    ]
    if isinstance(law, CompliantLaw) and law.lasting:
        rows.append(("each impact", _where_impacts_lie(case)))
    rows += _expected_rows(case, expected)
    rows += _labelled("cost", describe_costs(case))
    warnings = doubts(resolved_case(case), expected, aside)
    return Group(Text(case.name or "a drop", style="bold"), facts(rows), *warning_lines(warnings))


def _labelled(label: str, lines: Iterable[str]) -> list[tuple[str, str]]:
    """Return rows of which the first has a label."""
    return [("" if number else label, line) for number, line in enumerate(lines)]


def _body_rows(case: Case) -> list[tuple[str, str]]:
    sphere = case.sphere
    return [
        (
            "sphere",
            f"radius {sphere.radius:g} m, mass {mass_of_sphere(case):.6g} kg, {sphere.model}, of "
            f"{_material_text(sphere.material)}",
        ),
        *_ball_rows(case),
        ("plate", f"{_plate_text(case)}, of {_material_text(case.plate.material)}"),
        *_motion_rows(case),
        *_elastic_rows(case),
        *_coupling_rows(case),
        ("effective modulus", f"{contact_pair(case).effective_modulus:.6g} Pa"),
    ]


def _drop_rows(case: Case) -> list[tuple[str, str]]:
    speed = f"{touch_speed(case):.6g} m/s"
    if is_oblique(case):
        speed += " along the normal"
    rows = [("first approach speed", f"{speed}, gravity {case.drop.gravity:g} m/s2")]
    if case.drop.air is not None:
        rows.append(("air", fluid_words(case.drop.air.model_dump(exclude_none=True))))
    return rows


def _parameter_rows(case: Case) -> Iterator[tuple[str, str]]:
    """Yield a row for each parameter of the contact law.

    A list in the case gives one law per impact: parameters that differ are shown for each.
    """
    laws = contact_laws_of(case)
    functions = by_speed_of(case)
    for item in fields(laws[0]):
        values = [getattr(law, item.name) for law in laws]
        if values[0] is None or (item.metadata["memory"] and not any(values)):
            continue
        if item.name in functions:
            phrase = f"{unit_of(item, 1)}: {functions[item.name].words}".removeprefix(": ")
        else:
            if len(set(values)) == 1:
                values = values[:1]
            numbers = ", ".join(f"{value:.9g}" for value in values)
            phrase = f"{numbers} {unit_of(item, getattr(laws[0], 'exponent', 1))}"
        yield f"  {item.name}", phrase


def _liquid_rows(case: Case) -> list[tuple[str, str]]:
    table = case.contact.local.liquid
    if table is None:
        return []
    density = sphere_density(case.sphere)
    stokes = table.liquid().stokes_number(touch_speed(case), case.sphere.radius, density)
    damping = (
        f"at the first touch the Stokes number is {stokes:.4g}, and "
        f"{restitution_kept(stokes):.5g} of the restitution remains"
    )
    return [("liquid", f"{fluid_words(table.model_dump())}: {damping}")]


def _friction_rows(case: Case) -> list[tuple[str, str]]:
    friction = friction_law_of(case)
    if friction is None:
        return []
    rows = [("friction law", f"{friction.name}: {friction.equation}")]
    for item in fields(friction):
        quantity = f"{getattr(friction, item.name):.9g} {item.metadata['unit']}".rstrip()
        rows.append((f"  {item.name}", quantity))
    return rows


def _calibration_rows(case: Case) -> list[tuple[str, str]]:
    if case.calibrate is None:
        return []
    tuned = case.calibrate.parameter or "loss parameter of the law"
    if isinstance(tuned, tuple):
        tuned = ", ".join(tuned)
    return [("to calibrate", f"{tuned}; a run ignores [calibrate]")]


def _where_impacts_lie(case: Case) -> str:
    """Return where each impact of a law lies that leaves dents."""
    if case.drop.same_spot:
        return "on the same spot: the dents of earlier ones remain (drop.same_spot = true)"
    return "on fresh surfaces (drop.same_spot = false)"


def _expected_rows(case: Case, expected: DropSummary) -> list[tuple[str, str]]:
    """Return rows on restitution and expected contact.

    They are those of rigid bodies, and labelled so where the bodies deform.
    """
    restitution = "restitution"
    without_losses = "without losses"
    if deforms(case) and not is_free_sphere(case):
        restitution = "restitution if rigid"
        without_losses = "without losses, rigid"
    rows = _labelled(restitution, _restitution_lines(case))
    if not math.isnan(expected.force):
        contact = f"indentation {expected.depth:.4g} m, force {expected.force:.4g} N"
        rows.append((without_losses, contact))
    return rows


def _ends_of_a_run(case: Case) -> list[str]:
    """Return what ends a run of a case, whichever comes first."""
    ends = ["at rest" if case.drop.gravity else "when it flies off for good"]
    ends += [end.words for end in ends_of_run(case)]
    if is_oblique(case) and case.plate.size:
        ends.append("when it falls off the edge of the plate")
    return ends


def _ball_rows(case: Case) -> list[tuple[str, str]]:
    """Return rows on a sphere whose mass or moment of inertia is given: its mean density,
    and how it turns.
    """
    sphere = case.sphere
    ball = ball_of(case.sphere)
    lines = []
    if sphere.mass is not None:
        ratio = sphere_density(sphere) / sphere.material.density
        lines.append(
            f"of a mean density of {sphere_density(sphere):.4g} kg/m3, {ratio:.3g} times "
            "its material's" + _inside(ratio)
        )
    if sphere.inertia is not None or (sphere.mass is not None and is_oblique(case)):
        problem = rigid_problem(case)
        inertia = (
            f"moment of inertia {problem.sphere_inertia:.4g} kg m2, "
            f"{problem.inertia_ratio:.4g} times mass and squared radius"
        )
        if ball.inertia is None:
            inertia += ', as of a solid ball; of a shell: sphere.inertia = "hollow"'
        lines.append(inertia)
    return [("", line) for line in lines]


def _inside(ratio: float) -> str:
    """Return what a ball may be whose mean density is so many times that of its material,
    and what that means for the contact.
    """
    if ratio < 1.0 - _LIKE_SOLID:
        return (
            ", so hollow or light inside; a stiffness from Hertz's theory is that of a solid ball"
        )
    if ratio > 1.0 + _LIKE_SOLID:
        return ", so heavy inside"
    return ""


def _motion_rows(case: Case) -> list[tuple[str, str]]:
    """Return the row on the motion of the plate's supports."""
    motion = case.plate.motion
    if motion is None:
        return []
    along = f"along ({', '.join(f'{part:g}' for part in motion.direction)})"
    if motion.file is not None:
        lasts = "repeated" if motion.repeat else f"for {motion_length(case):.6g} s"
        return [("motion of supports", f"as in {motion.file}, {lasts}, {along}")]
    angular_frequency = 2.0 * math.pi * float(motion.frequency or 0.0)
    strength = float(motion.amplitude or 0.0) * angular_frequency**2
    phrase = (
        f"amplitude {motion.amplitude:g} m, frequency {motion.frequency:g} Hz, phase "
        f"{motion.phase:g} rad, {along}"
    )
    return [
        (
            "motion of supports",
            f"{phrase}: up to {strength:.4g} m/s2, {strength / STANDARD_GRAVITY:.4g} times "
            "standard gravity",
        )
    ]


def _elastic_rows(case: Case) -> list[tuple[str, str]]:
    if not elastic_names(case):
        return []
    from vibroimpact.modes.elastic_rows import elastic_rows  # here, as it imports scipy.sparse

    return elastic_rows(case)


def _coupling_rows(case: Case) -> list[tuple[str, str]]:
    """Return rows on the treatment of local indentation and on the sensors."""
    if not deforms(case):
        return []
    local = case.contact.local
    phrase: list[str] = []
    if elastic_names(case) or local.local_compliance is not None:
        phrase.append(local.local_compliance or "consistent, by default")
    if local.finite_sphere:
        phrase.append("Hertz's half space corrected to a sphere of finite size")
    if local.local_stiffness is not None:
        phrase.append(
            f"local element of {local.local_stiffness:.6g} N/m and {local.local_damping:.6g} N s/m"
        )
    if local.measured is not None:
        where = "on a rigid plate" if local.measured.plate == "rigid" else "on this plate"
        phrase.append(
            f"local element found from a largest force of {local.measured.max_force:.6g} N {where}"
        )
    rows = []
    if phrase:
        rows.append(("local compliance", "; ".join(phrase)))
    for sensor in case.sensors:
        if isinstance(sensor.position, str):
            place = sensor.position
        else:
            place = f"({sensor.position[0]:g}, {sensor.position[1]:g}) m"
        if sensor.subject == "support":
            where = f"of the support at {place}"
        else:
            where = f"at {place}, {sensor.face} face"
        phrase = [
            f"{sensor.quantity} {where}",
            *_instrument(sensor),
            f"{sensor.rate:g} Hz",
            _filter(sensor),
            *_electronics(sensor),
        ]
        rows.append((f"sensor {sensor.name}", ", ".join(phrase)))
    return rows


def _instrument(sensor: SensorSection) -> list[str]:
    """Return a description of a sensor's instrument; empty without one."""
    if sensor.instrument is None:
        return []
    stated = sensor.instrument_in_case()
    phrase = ""
    if stated is not None and sensor.table is not None:
        phrase = "; ".join(stated.stated_properties())
    return [f"by {instruments()[sensor.instrument].noun} ({phrase or 'ideal'})"]


def _electronics(sensor: SensorSection) -> list[str]:
    """Return descriptions of a sensor's amplifier and converter."""
    phrase = []
    unit = sensor.sensor().unit
    if (amplifier := sensor.amplifier) is not None:
        if amplifier.hum:
            hum = f"hum of {amplifier.hum:g} {unit} at {amplifier.mains:g} Hz"
        else:
            hum = "no hum"
        phrase.append(
            f"amplifier (gain {amplifier.gain:g}; noise {amplifier.noise:g} {unit}; {hum})"
        )
    if (converter := sensor.converter) is not None:
        phrase.append(
            f"converter (range {converter.range:g} {unit}; {converter.bits or 'unlimited'} bits)"
        )
    return phrase


def _filter(sensor: SensorSection) -> str:
    """Return a description of a sensor's anti-alias filter."""
    if sensor.filter == "none":
        return "no anti-alias filter"
    corner = f" at {sensor.corner:g} Hz" if sensor.corner else ""
    return f"{sensor.filter} filter{corner}"


def _restitution_lines(case: Case) -> list[str]:
    """Return sentences on the restitution that the law achieves, and on the parameter
    that would achieve the one asked.
    """
    asked, achieved, to_ask, refusal = first_restitution(case)
    if math.isnan(to_ask) and not refusal:
        return [f"{achieved:.5g} achieved at the first touch, without gravity"]
    lines = [f"{asked:.5g} asked, {achieved:.5g} achieved at the first touch, without gravity"]
    return [*lines, refusal or f"restitution = {to_ask:.6g} would achieve {asked:.5g}"]


def _material_text(material: Material) -> str:
    name = material.name or "a material"
    if material is RIGID:
        return name
    return (
        f"{name} (E {material.youngs_modulus:.4g} Pa, nu {material.poissons_ratio:g}, "
        f"{material.density:g} kg/m3)"
    )
