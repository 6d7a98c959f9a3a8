"""The set-up of a drop: a dimensioned sketch, and what bodies, law and sensors are, in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact.cases.fields.fluid import fluid_words
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Arrow, Label, Line, Mark, Outline
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.law import unit_of
from vibroimpact.contact.registry import contact_laws
from vibroimpact.contact.speed_function import of_table
from vibroimpact.dynamics.sensors.instruments.registry import instruments
from vibroimpact.quoting import shortened, visible
from vibroimpact.results.result import Result
from vibroimpact.results.single_supports import single_supports
from vibroimpact.runs.below import body_below, level_below
from vibroimpact.runs.chart_data import touch_height
from vibroimpact.runs.sensor_marks import sensor_marks
from vibroimpact.runs.supports import (
    Extent,
    held_nodes,
    plate_extent,
    plate_outline,
    support_outlines,
    support_words,
    supports_from_the_side,
)
from vibroimpact.units.display import brief, digits, multiple

_TURN = np.linspace(0.0, 2.0 * np.pi, 61)
_THIN = 0.015
"""Drawn thickness of a plate whose thickness is not known, relative to its longer side."""
_USUAL_RADIUS = 0.025
"""Drawn radius of a sphere whose radius is not known [m]."""


def setup_chart(result: Result) -> Chart:
    """Return a dimensioned sketch of the set-up: from the side, and from above where the plate has
    a size.

    Parameters
    ----------
    result : Result
        The result; without a case only what it holds itself is drawn.
    """
    extent = plate_extent(result)
    panels = [_from_the_side(result, extent)]
    if extent:
        panels.append(_from_above(result, extent))
    return Chart(
        "setup",
        "Set-up",
        (tuple(panels),),
        f"To scale but for {_listed(_not_to_scale(result, extent))}.",
        height=2.9,
    )


def _listed(things: Sequence[str]) -> str:
    """Return things in a sentence."""
    *first, last = things
    if not first:
        return last
    return f"{', '.join(first)} and {last}"


def _not_to_scale(result: Result, extent: Extent | None) -> list[str]:
    """Return what is not drawn to scale: the height of the drop, and what is not known."""
    things = ["the height of the drop"]
    if result.case.get("plate", {}).get("radius") is not None:
        return things
    if not _knows_radius(result):
        things.append("the sphere, whose radius is not given")
    if extent is None:
        return [*things, "the plate, whose size is not given"]
    things.append(_supports_not_to_scale(result))
    if not np.isfinite(extent.thickness) and result.plate_shape is None:
        things.append("the thickness of the plate, which is not given")
    return things


def _supports_not_to_scale(result: Result) -> str:
    """Return what of the supports is not drawn to scale: points and lines have no width."""
    is_narrow = any(
        support["type"] in ("edge", "point", "spring") and not support.get("radius")
        for support in single_supports(result.case)
    )
    if is_narrow and result.case["plate"].get("model") != "rigid":
        return "the depth of the supports, and the width of those of edges and points"
    return "the depth of the supports"


def drawn_radius(result: Result) -> float:
    """Return the radius of the sphere as it is drawn [m]; of a body made in Python the
    height of its centre at first touch.
    """
    radius = result.case.get("sphere", {}).get("radius")
    if radius is None:
        radius = touch_height(result)
    if np.isfinite(float(radius)) and float(radius) > 0.0:
        return float(radius)
    return _USUAL_RADIUS


def _knows_radius(result: Result) -> bool:
    """Return whether the drawn radius of the sphere is its own; one made in Python that
    touches nothing is drawn with a usual one.
    """
    return result.case.get("sphere", {}).get("radius") is not None or touch_height(result) > 0.0


def _contact_point(result: Result) -> tuple[float, float]:
    """Return where on the plate the sphere falls [m]."""
    if result.deflection is not None:  # of a mesh that was brought the case may give a named set
        return float(result.deflection.contact[0]), float(result.deflection.contact[1])
    x, y = result.case.get("drop", {}).get("position", (0.0, 0.0))
    return float(x), float(y)


def _from_the_side(result: Result, extent: Extent | None) -> Panel:
    radius = drawn_radius(result)
    below = result.case.get("plate", {}).get("radius")
    if below is not None:
        marks = _sphere_below(result, float(below))
        half = max(float(below), 2.0 * radius)
        at = 0.0
    else:
        at = _contact_point(result)[0]
        around = extent or Extent((at - 5.0 * radius, at + 5.0 * radius), (0.0, 0.0), 1.2 * radius)
        marks = _plate(result, around, dimensioned=extent is not None)
        half = 0.5 * (around.x[1] - around.x[0])
    high = max(3.4 * radius, 0.42 * half)
    if result.plate_shape is not None:  # parts of it may stand higher than the contact point
        high = max(high, float(result.plate_shape.high[2]) + 2.0 * radius)
    marks += [
        Line(np.array([at, at]), np.array([0.0, high - radius]), role="dotted"),
        Outline(at + radius * np.cos(_TURN), high + radius * np.sin(_TURN), role="sphere"),
    ]
    if _knows_radius(result):
        marks.append(Label(at - radius, high, f"radius {as_given(radius, 'm')}", "right"))
    beside = at + 1.8 * radius + 0.02 * half
    marks += dimension((beside, 0.0), (beside, high), _drop_words(result), "left")
    return Panel(Axis("x", "m"), Axis("z", "m"), tuple(marks), "From the side", picture=True)


def _sphere_below(result: Result, radius: float) -> list[Mark]:
    """Return the sphere in the plate's place, on what holds it."""
    marks: list[Mark] = [Outline(radius * np.cos(_TURN), radius * np.sin(_TURN) - radius)]
    marks.append(Label(radius, -radius, f"radius {as_given(radius, 'm')}", "left"))
    if result.case["plate"].get("supports") != "free":
        ground = np.array([-0.6, 0.6, 0.6, -0.6]) * radius
        deep = np.array([2.0, 2.0, 2.25, 2.25]) * radius
        marks.insert(0, Outline(ground, -deep, role="support"))
    return marks


def _plate(result: Result, extent: Extent, *, dimensioned: bool) -> list[Mark]:
    left, right = extent.x
    thickness = extent.thickness
    words = f"{as_given(thickness, 'm')} thick"
    if not np.isfinite(thickness):
        thickness = _THIN * extent.longer
        words = ""
    top = 0.0
    profile = Outline(
        np.array([left, right, right, left]), np.array([0.0, 0.0, -thickness, -thickness])
    )
    shape = result.plate_shape
    if shape is not None:
        top = float(shape.high[2])
        thickness = -float(shape.low[2])
        words = f"{brief(top + thickness, 'm')} high"
        profile = Outline(*shape.side.T)
    marks: list[Mark] = [profile, *supports_from_the_side(result, extent, thickness)]
    marks += held_nodes(result, (0, 2))
    if dimensioned:
        outlines = [mark for mark in marks if isinstance(mark, Outline)]
        low = min(float(np.nanmin(outline.y)) for outline in outlines) - 0.04 * (right - left)
        beside = max(float(np.nanmax(outline.x)) for outline in outlines)
        marks += dimension((left, low), (right, low), as_given(right - left, "m"), "below")
        if words:
            marks.append(Label(beside, 0.5 * (top - thickness), words, "left"))
    return marks


_APPROACH = ("approach_speed_m_s", "approach_velocity_x_m_s", "approach_velocity_y_m_s")


def _drop_words(result: Result) -> str:
    start = float(result.history["position_m"][0])
    if start <= touch_height(result):  # a run that begins at first touch
        components = [
            float(result.impacts[name][0]) for name in _APPROACH if name in result.impacts
        ]
        down = components[0]
        speed = float(np.linalg.norm(components))
        phrase = f"arrives at {as_given(speed, 'm/s')}"
        if down < speed:
            phrase += f" at {np.degrees(np.arccos(down / speed)):.4g}° from the normal"
        return phrase
    return f"{as_given(start, 'm')} above {level_below(result)}"


def _from_above(result: Result, extent: Extent) -> Panel:
    (left, right), (front, back), radius, (x, y) = (
        extent.x,
        extent.y,
        drawn_radius(result),
        _contact_point(result),
    )
    marks: list[Mark] = [plate_outline(result, extent)]
    if result.plate_shape is not None and len(below := result.plate_shape.below):
        marks.append(Line(below[:, 0], below[:, 1], "below", "ghost"))
    marks += [
        Outline(*outline, name="support", role="held") for outline in support_outlines(result)
    ]
    marks += held_nodes(result, (0, 1))
    marks.append(Outline(x + radius * np.cos(_TURN), y + radius * np.sin(_TURN), role="sphere"))
    low = min(front, y - radius) - 0.07 * (back - front)
    beside = max(right, x + radius) + 0.05 * (right - left)
    marks += dimension((left, low), (right, low), as_given(right - left, "m"), "below")
    marks += dimension((beside, front), (beside, back), as_given(back - front, "m"), "left")
    marks += sensor_marks(result, (x, y, radius))
    return Panel(Axis("x", "m"), Axis("y", "m"), tuple(marks), "From above", picture=True)


def dimension(
    start: tuple[float, float], end: tuple[float, float], phrase: str, anchor: str
) -> list[Mark]:
    """Return an arrow in both directions with words at its middle."""
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    return [Arrow(start, end, both=True), Label(*middle, phrase, anchor)]


def as_given(value: float, unit: str) -> str:
    """Return a value [SI] as somebody gave it, without zeros at its end."""
    best = multiple(unit, value)
    shown = digits(value / best.size, 6)
    # zeros at the end of an integer, or of a power of ten, are not superfluous
    if "." in shown and "\u00b7" not in shown:
        shown = shown.rstrip("0").rstrip(".")
    return f"{shown}\u00a0{best.unit}".rstrip("\u00a0")


def setup_rows(result: Result) -> list[tuple[str, str]]:
    """Return what bodies, drop, law and sensors are: name and words of each; empty without a case.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> from vibroimpact.results.result import result_of
    >>> rows = setup_rows(result_of(vi.simulate(vi.load_case("paper:type1-theory"))))
    >>> [words.replace(chr(160), " ") for name, words in rows][2]
    '4 m above the plate, gravity 9.8 m/s²'
    """
    case = result.case
    if not case:
        return []
    rows = [
        ("Sphere", _body_words(case["sphere"])),
        (body_below(result).capitalize(), f"{_body_words(case['plate'])}, {support_words(result)}"),
    ]
    rows.append(
        (
            "Drop",
            f"{_drop_words(result)}, gravity "
            f"{as_given(float(case['drop'].get('gravity', 0.0)), 'm/s2')}",
        )
    )
    plate: Mapping[str, Any] = case["plate"]
    if (inclination := plate.get("inclination")) is not None:
        rows.append(("Inclination", f"{np.degrees(float(inclination)):.4g}° about y"))
    if (motion := plate.get("motion")) is not None:
        rows.append(("Motion of the supports", _motion_words(motion)))
    if (air := case["drop"].get("air")) is not None:
        rows.append(("Air", fluid_words(air)))
    of_law = {
        key: value for key, value in case["contact"].items() if key not in ("friction", "liquid")
    }
    rows.append(("Contact law", _law_words(of_law)))
    if (liquid := case["contact"].get("liquid")) is not None:
        rows.append(("Liquid", fluid_words(liquid)))
    if (friction := case["contact"].get("friction")) is not None:
        rows.append(("Friction", _law_words(friction)))
    for sensor in case.get("sensors", ()):
        phrase = sensor["quantity"]
        if "instrument" in sensor:
            phrase += f" by {instruments()[sensor['instrument']].noun}"
        phrase += f" at {_place(sensor['position'])}, {as_given(float(sensor['rate']), 'Hz')}"
        rows.append((f"Sensor {shortened(visible(sensor['name']), 60)}", phrase))
    return rows


def _motion_words(motion: Mapping[str, Any]) -> str:
    """Return the motion of the plate's supports in words."""
    if (file := motion.get("file")) is not None:
        phrase = [f"as in {shortened(visible(Path(file).name), 60)}"]
        if motion.get("repeat"):
            phrase.append("repeated")
    else:
        phrase = [
            f"amplitude {as_given(float(motion['amplitude']), 'm')}",
            f"frequency {as_given(float(motion['frequency']), 'Hz')}",
        ]
        if motion.get("phase"):
            phrase.append(f"phase {np.degrees(float(motion['phase'])):.4g}°")
    direction = [float(component) for component in motion["direction"]]
    if any(direction[:2]):
        components = ", ".join(f"{component:.4g}" for component in direction)
        phrase.append(f"along ({components})")
    else:
        phrase.append("along the normal")
    return ", ".join(phrase)


def _body_words(body: Mapping[str, Any]) -> str:
    phrase = [str(body.get("model", "rigid"))]
    if body.get("radius") is not None:
        phrase.append(f"radius {as_given(float(body['radius']), 'm')}")
    if body.get("mass") is not None:
        phrase.append(f"mass {as_given(float(body['mass']), 'kg')}")
    inertia = body.get("inertia")
    if isinstance(inertia, str):  # solid or hollow
        phrase.append(inertia)
    elif inertia is not None:
        phrase.append(f"moment of inertia {as_given(float(inertia), 'kg m^2')}")
    if body.get("size"):
        phrase.append(" \u00d7 ".join(as_given(float(side), "m") for side in body["size"]))
    material = body.get("material")
    if isinstance(material, Mapping):
        values = (
            f"E {as_given(float(material['youngs_modulus']), 'Pa')}, \u03bd "
            f"{as_given(float(material['poissons_ratio']), '')}, "
            f"{as_given(float(material['density']), 'kg/m^3')}"
        )
        if material.get("name"):
            values = f"{shortened(visible(material['name']), 60)}: {values}"
        phrase.append(values)
    elif material is not None:
        phrase.append(f"material {material}")
    if body.get("modes"):
        phrase.append(f"{body['modes']} modes")
    return ", ".join(phrase)


def _law_words(contact: Mapping[str, Any]) -> str:
    """Return a law with its parameters in their units; of a law that is not installed
    here they are not known.
    """
    name = str(contact["law"])
    law = {**contact_laws(), **friction_laws()}.get(contact["law"])
    if law is None:
        return shortened(visible(name), 60)
    parameters = []
    for key, item in law.__dataclass_fields__.items():
        value = contact.get(key)
        if value is None or (item.metadata.get("memory") and not np.any(value)):
            continue
        unit = unit_of(item, contact.get("exponent", 1))
        if isinstance(value, Mapping):
            parameters.append(f"{key.replace('_', ' ')} {of_table(value).words}")
            continue
        # a list has a value for each impact
        numbers = [as_given(float(number), unit) for number in np.atleast_1d(value)]
        parameters.append(f"{key.replace('_', ' ')} {', '.join(numbers)}")
    if not parameters:
        return name
    return f"{name}: {', '.join(parameters)}"


def _place(position: Any) -> str:
    if isinstance(position, str):
        return shortened(visible(position), 60)
    best = multiple("m", position)
    coordinates = ", ".join(as_given(float(coordinate) / best.size, "") for coordinate in position)
    return f"({coordinates})\u00a0{best.unit}"
