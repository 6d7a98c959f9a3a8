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

_DRAWN_DROP, _BAR_LENGTH, _OFFSET = 0.36, 0.13, 0.05
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
    half, deep = 0.5 * length, 0.5 * width
    marks += _dimension(
        (-half, deep, 0.0), (half, deep, 0.0), (0.0, _OFFSET), _millimetres(length), "above"
    )
    marks += _dimension(
        (-half, -deep, 0.0), (-half, deep, 0.0), (-_OFFSET, 0.0), _millimetres(width), "right"
    )
    half, deep = 0.5 * along, 0.5 * across
    marks += _dimension(
        (-half, -deep, foot),
        (half, -deep, foot),
        (0.0, -1.8 * _OFFSET),
        _millimetres(along),
        "below",
    )
    marks += _dimension(
        (half, -deep, foot), (half, deep, foot), (1.8 * _OFFSET, 0.0), _millimetres(across), "left"
    )
    radius = _millimetres(support["radius"])
    caption = (
        "To scale but for the drop. The paper gives neither radius nor length of the bars: "
        "their radius is drawn as the {radius} of the "
        "patches that hold the elastic plate here. The rigid plate is fixed, so that they "
        "play no part. {properties}."
    ).format(radius=radius, properties="; ".join(_properties(case)))
    panel = Panel(Axis("x", "m"), Axis("z", "m"), tuple(marks), picture=True)
    return Chart("fig3", "Figure 3: the rigid model", ((panel,),), caption, 3.9)


def _millimetres(value: float) -> str:
    return f"{1e3 * value:.5g} mm"


def _bar(at: tuple[float, float], radius: float, top: float, foot: float) -> list[Mark]:
    """Return the visible side of an upright cylinder, in strips by the light on them."""
    # from the left to the right edge, as they are seen
    turn = -TURN + np.linspace(-np.pi, 0.0, _STRIPS + 1)
    rim = np.column_stack([at[0] + radius * np.cos(turn), at[1] + radius * np.sin(turn)])
    low, high = (projected(np.column_stack([rim, np.full(len(rim), z)])) for z in (foot, top))
    middle = 0.5 * (turn[1:] + turn[:-1])
    normals = np.column_stack([np.cos(middle), np.sin(middle), np.zeros(_STRIPS)])
    strips = np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
    return [Facets(strips, light_on(normals)), _line([high[:1], low, high[-1:]])]


def _plate(length: float, width: float, thickness: float) -> list[Mark]:
    """Return the three visible faces of the plate with their edges, and its thickness."""
    upper, lower = (
        np.array(
            [
                (0.5 * x * length, 0.5 * y * width, z)
                for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
            ]
        )
        for z in (0.0, -thickness)
    )
    top, front = projected(upper), projected(np.array([upper[0], upper[1], lower[1], lower[0]]))
    side = projected(np.array([upper[1], upper[2], lower[2], lower[1]]))
    light = light_on(np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]))
    edges = [_line([face, face[:1]]) for face in (front, side, top)]
    corner = projected(np.array([0.5 * length, 0.5 * width, -0.5 * thickness]))
    words = Label(float(corner[0]), float(corner[1]), f"{_millimetres(thickness)} thick", "left")
    return [Facets(np.array([front, side, top]), light), *edges, words]


def _sphere(radius: float, drop: float) -> list[Mark]:
    """Return the sphere above the centre of the plate, with the height of its drop."""
    (across, ground), (_, centre) = projected(
        np.array([(0.0, 0.0, 0.0), (0.0, 0.0, _DRAWN_DROP)])
    ).tolist()
    beside = across + 2.6 * radius
    leads = [
        np.array([(across, ground), (1.08 * beside, ground)]),
        _GAP,
        np.array([(across + radius, centre), (1.08 * beside, centre)]),
    ]
    return [
        Line(np.array([across, across]), np.array([ground, centre]), role="reference"),
        Outline(across + radius * np.cos(_ROUND), centre + radius * np.sin(_ROUND), role="ball"),
        _line(leads, "muted"),
        Arrow((beside, ground), (beside, centre), both=True),
        Label(
            beside, ground + 0.62 * (centre - ground), f"{text(drop, 'm', 1)}, not to scale", "left"
        ),
        Label(across - radius, centre, f"radius {_millimetres(radius)}", "right"),
    ]


def _dimension(
    start: Point, end: Point, aside: tuple[float, float], words: str, anchor: str
) -> list[Mark]:
    """Return a dimension between two points, offset along x and y, with the lines that
    lead to it.
    """
    ends = np.array([start, end])
    shift = np.array([*aside, 0.0])
    first, last = projected(ends + shift).tolist()
    leads = [
        part
        for near, far in zip(ends, ends + 1.15 * shift, strict=True)
        for part in (projected(np.array([near, far])), _GAP)
    ]
    middle = 0.5 * (first[0] + last[0]), 0.5 * (first[1] + last[1])
    arrow = Arrow((first[0], first[1]), (last[0], last[1]), both=True)
    return [_line(leads, "muted"), arrow, Label(*middle, words, anchor)]


_GAP = np.full((1, 2), np.nan)


def _line(parts: Sequence[Floats], role: str = "edge") -> Line:
    x, y = np.concatenate(parts).T
    return Line(np.ascontiguousarray(x), np.ascontiguousarray(y), role=role)


def _properties(case: Mapping[str, Any]) -> list[str]:
    """Return the materials of the bodies, gravity and the support in words."""
    found: list[str] = []
    for body in ("sphere", "plate"):
        material = case[body]["material"]
        stiff = (
            f"E = {material['youngs_modulus'] / 1e9:g} GPa, \u03bd = {material['poissons_ratio']:g}"
        )
        found.append(
            f"{body.capitalize() if not found else body}: {material['density']:g} kg/m³, {stiff}"
        )
    return [*found, f"gravity: {case['drop']['gravity']:g} m/s²", "four bars, fixed to the ground"]
