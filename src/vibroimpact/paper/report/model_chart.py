"""Figure 3: the rigid model, with its dimensions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_case
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.marks import Arrow, Facets, Label, Line, Mark, Outline
from vibroimpact.report.projection import TURN, light_on, projected
from vibroimpact.units.display import text

_DRAWN_DROP = 0.36
_BAR_LENGTH = 0.13
_OFFSET = 0.05
"""Height at which the sphere is drawn, length of the bars, and offset of dimension lines [m]."""
_STRIPS = 24
"""Strips of the visible side of a bar."""
_ROUND = np.linspace(0.0, 2.0 * np.pi, 73)

Point = tuple[float, float, float]


def model_chart() -> Chart:
    """Return a sketch of the sphere above the plate on its four bars, in parallel
    projection, with the dimensions of the case of Type 3.
    """
    case = resolved_case(load_case("paper:type3"))
    length, width, thickness = case["plate"]["size"]
    support = case["plate"]["supports"][0]
    along, across = support["spacing"]
    foot = -thickness - _BAR_LENGTH
    # from back to front: what is drawn later covers what was drawn before
    marks: list[Mark] = []
    for x, y in ((-1, 1), (1, 1), (-1, -1), (1, -1)):
        marks += _bar((0.5 * x * along, 0.5 * y * across), support["radius"], -thickness, foot)
    marks += _plate(length, width, thickness)
    marks += _sphere(case["sphere"]["radius"], case["drop"]["height"])
    marks += _plate_dimensions(length, width)
    marks += _bar_dimensions(along, across, foot)
    radius = _millimetres(support["radius"])
    caption = (
        "To scale but for the drop. The paper gives neither radius nor length of the bars: "
        "their radius is drawn as the {radius} of the "
        "patches that hold the elastic plate here. The rigid plate is fixed, so that they "
        "play no part. {properties}."
    ).format(radius=radius, properties="; ".join(_properties(case)))
    panel = Panel(Axis("x", "m"), Axis("z", "m"), tuple(marks), picture=True)
    return Chart("fig3", "Figure 3: the rigid model", ((panel,),), caption, 3.9)


def _plate_dimensions(length: float, width: float) -> list[Mark]:
    """Return length and width of the plate, at its back and left edges."""
    x = 0.5 * length
    y = 0.5 * width
    above = (0.0, _OFFSET)
    left = (-_OFFSET, 0.0)
    return [
        *_dimension((-x, y, 0.0), (x, y, 0.0), above, _millimetres(length), "above"),
        *_dimension((-x, -y, 0.0), (-x, y, 0.0), left, _millimetres(width), "right"),
    ]


def _bar_dimensions(along: float, across: float, foot: float) -> list[Mark]:
    """Return the spacings of the bars, at the feet of those in front and on the right."""
    x = 0.5 * along
    y = 0.5 * across
    below = (0.0, -1.8 * _OFFSET)
    right = (1.8 * _OFFSET, 0.0)
    return [
        *_dimension((-x, -y, foot), (x, -y, foot), below, _millimetres(along), "below"),
        *_dimension((x, -y, foot), (x, y, foot), right, _millimetres(across), "left"),
    ]


def _millimetres(value: float) -> str:
    return f"{1e3 * value:.5g} mm"


def _bar(centre: tuple[float, float], radius: float, top: float, foot: float) -> list[Mark]:
    """Return the visible side of an upright cylinder, in strips by the light on them."""
    # from the left to the right edge, as they are seen
    angles = -TURN + np.linspace(-np.pi, 0.0, _STRIPS + 1)
    x = centre[0] + radius * np.cos(angles)
    y = centre[1] + radius * np.sin(angles)
    low = projected(np.column_stack([x, y, np.full(len(x), foot)]))
    high = projected(np.column_stack([x, y, np.full(len(x), top)]))
    middles = 0.5 * (angles[1:] + angles[:-1])
    normals = np.column_stack([np.cos(middles), np.sin(middles), np.zeros(_STRIPS)])
    strips = np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
    return [Facets(strips, light_on(normals)), _line([high[:1], low, high[-1:]])]


_TOWARDS_FRONT = (0.0, -1.0, 0.0)
_TOWARDS_RIGHT = (1.0, 0.0, 0.0)
_UPWARDS = (0.0, 0.0, 1.0)
"""Normals of the visible faces of the plate."""


def _plate(length: float, width: float, thickness: float) -> list[Mark]:
    """Return the three visible faces of the plate with their edges, and its thickness."""
    # corners from the left front one on, counterclockwise as seen from above
    upper = _rectangle(length, width, 0.0)
    lower = _rectangle(length, width, -thickness)
    front = np.concatenate([upper[[0, 1]], lower[[1, 0]]])
    right = np.concatenate([upper[[1, 2]], lower[[2, 1]]])
    faces = [projected(face) for face in (front, right, upper)]
    normals = np.array([_TOWARDS_FRONT, _TOWARDS_RIGHT, _UPWARDS])
    edges = [_line([face, face[:1]]) for face in faces]
    rear_edge = np.array([0.5 * length, 0.5 * width, -0.5 * thickness])
    across, up = projected(rear_edge).tolist()
    label = Label(across, up, f"{_millimetres(thickness)} thick", "left")
    return [Facets(np.array(faces), light_on(normals)), *edges, label]


def _rectangle(length: float, width: float, height: float) -> Floats:
    """Return the corners of a level rectangle about the z axis, (4, 3)."""
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return np.array([(0.5 * x * length, 0.5 * y * width, height) for x, y in signs])


def _sphere(radius: float, drop: float) -> list[Mark]:
    """Return the sphere above the centre of the plate, with the height of its drop."""
    touch, centre = projected(np.array([(0.0, 0.0, 0.0), (0.0, 0.0, _DRAWN_DROP)])).tolist()
    x, ground = touch
    height = centre[1]
    beside = x + 2.6 * radius
    leads = [
        np.array([(x, ground), (1.08 * beside, ground)]),
        _GAP,
        np.array([(x + radius, height), (1.08 * beside, height)]),
    ]
    phrase = f"{text(drop, 'm', 1)}, not to scale"
    return [
        Line(np.array([x, x]), np.array([ground, height]), role="reference"),
        Outline(x + radius * np.cos(_ROUND), height + radius * np.sin(_ROUND), role="sphere"),
        _line(leads, "muted"),
        Arrow((beside, ground), (beside, height), both=True),
        Label(beside, ground + 0.62 * (height - ground), phrase, "left"),
        Label(x - radius, height, f"radius {_millimetres(radius)}", "right"),
    ]


def _dimension(
    start: Point, end: Point, aside: tuple[float, float], phrase: str, anchor: str
) -> list[Mark]:
    """Return a dimension between two points, offset along x and y, with the lines that
    lead to it.
    """
    ends = np.array([start, end])
    shift = np.array([*aside, 0.0])
    leads = []
    for point in ends:
        leads += [projected(np.array([point, point + 1.15 * shift])), _GAP]
    first, last = projected(ends + shift).tolist()
    arrow = Arrow((first[0], first[1]), (last[0], last[1]), both=True)
    label = Label(0.5 * (first[0] + last[0]), 0.5 * (first[1] + last[1]), phrase, anchor)
    return [_line(leads, "muted"), arrow, label]


_GAP = np.full((1, 2), np.nan)


def _line(parts: Sequence[Floats], role: str = "edge") -> Line:
    x, y = np.concatenate(parts).T
    return Line(np.ascontiguousarray(x), np.ascontiguousarray(y), role=role)


def _properties(case: Mapping[str, Any]) -> list[str]:
    """Return the materials of the bodies, gravity and the support in words."""
    materials = []
    for name, body in (("Sphere", "sphere"), ("plate", "plate")):
        material = case[body]["material"]
        modulus = material["youngs_modulus"] / 1e9
        ratio = material["poissons_ratio"]
        materials.append(
            f"{name}: {material['density']:g} kg/m³, E = {modulus:g} GPa, \u03bd = {ratio:g}"
        )
    gravity = f"gravity: {case['drop']['gravity']:g} m/s²"
    return [*materials, gravity, "four bars, fixed to the ground"]
