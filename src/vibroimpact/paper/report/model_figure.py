"""Figure 3: the rigid model, with its dimensions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from vibroimpact.arrays import Floats
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_case
from vibroimpact.paper.report.drawing import Drawing
from vibroimpact.paper.runs import Runs
from vibroimpact.report.layout import WIDTH, new_figure
from vibroimpact.report.projection import TILT, project
from vibroimpact.report.style import ACCENT, INK
from vibroimpact.units.display import text

_HEIGHT = 4.5
"""Height of the figure [in]."""
_CENTRE, _VIEW_HEIGHT = (-0.02, 0.03), 0.72
"""Centre of the view, and its height [m]."""
_DRAWN_DROP, _BAR_LENGTH, _OFFSET = 0.36, 0.13, 0.05
"""Height at which the sphere is drawn, length of the bars, and offset of dimension lines [m]."""
_TOP, _FRONT, _SIDE, _BAR, _SHADE, _GROUND = "#dbe3ea", "#aab6c1", "#8e9ba8", "#c3c9cf", "#969fa8", "#f1efea"
_ROCK, _LIT = np.array([0.24, 0.21, 0.19]), np.array([0.72, 0.67, 0.61])

Point = tuple[float, float, float]


def draw_model(runs: Runs) -> Drawing:
    """Draw the sphere above the plate on its four bars, in parallel projection, with dimensions.

    Parameters
    ----------
    runs : Runs
        The simulations; the case of Type 3 has the dimensions.
    """
    case = resolved_case(load_case("paper:type3"))
    length, width, thickness = case["plate"]["size"]
    support = case["plate"]["supports"][0]
    along, across = support["spacing"]
    figure = new_figure(_HEIGHT)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_xlim(*(_CENTRE[0] + np.array([-0.5, 0.5]) * _VIEW_HEIGHT * WIDTH / _HEIGHT))
    axes.set_ylim(*(_CENTRE[1] + np.array([-0.5, 0.5]) * _VIEW_HEIGHT))
    foot = -thickness - _BAR_LENGTH
    # drawn from back to front, since patches cover those drawn before
    _fill(axes, _corners(1.2 * length, 1.25 * width, foot), _GROUND, "none")
    for x, y in ((-1, 1), (1, 1), (-1, -1), (1, -1)):
        _draw_bar(axes, (0.5 * x * along, 0.5 * y * across), support["radius"], -thickness, foot)
    _draw_plate(axes, length, width, thickness)
    _draw_sphere(axes, case["sphere"]["radius"], case["drop"]["height"])
    half, deep = 0.5 * length, 0.5 * width
    _draw_dimension(axes, (-half, deep, 0.0), (half, deep, 0.0), (0.0, _OFFSET), _millimetres(length))
    _draw_dimension(axes, (-half, -deep, 0.0), (-half, deep, 0.0), (-_OFFSET, 0.0), _millimetres(width))
    half, deep = 0.5 * along, 0.5 * across
    _draw_dimension(axes, (-half, -deep, foot), (half, -deep, foot), (0.0, -1.8 * _OFFSET), _millimetres(along))
    _draw_dimension(axes, (half, -deep, foot), (half, deep, foot), (1.8 * _OFFSET, 0.0), _millimetres(across))
    _draw_properties(axes, case)
    radius = _millimetres(support["radius"])
    sentence = (
        f"To scale but for the drop. The paper gives neither radius nor length of the bars: their radius is drawn as the {radius} of the "
        "patches that hold the elastic plate here. The rigid plate is fixed, so that they play no part."
    )
    return Drawing(figure, "Figure 3: the rigid model", sentence)


def _millimetres(value: float) -> str:
    return f"{1e3 * value:.5g} mm"


def _corners(length: float, width: float, z: float) -> list[Point]:
    """Return the corners of a centred rectangle, counterclockwise from the front left one."""
    return [(0.5 * x * length, 0.5 * y * width, z) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def _projected(points: Sequence[Point | Floats]) -> Floats:
    """Return the projection of points, (points, 2)."""
    return np.column_stack(project(*np.array(points, dtype=float).T))


def _fill(axes: Axes, points: list[Point], colour: str, edge: str = INK) -> None:
    axes.add_patch(Polygon(_projected(points), facecolor=colour, edgecolor=edge, linewidth=0.7, joinstyle="round"))


def _draw_bar(axes: Axes, at: tuple[float, float], radius: float, top: float, foot: float) -> None:
    """Draw the visible side of an upright cylinder, with its right part shaded."""
    (across, upper), (_, lower) = _projected([(*at, top), (*at, foot)])
    for first, colour, edge in ((np.pi, _BAR, INK), (1.65 * np.pi, _SHADE, "none")):
        turn = np.linspace(first, 2.0 * np.pi, 40)
        rim = np.column_stack([across + radius * np.cos(turn), lower + radius * np.sin(TILT) * np.sin(turn)])
        ends = [[rim[-1, 0], upper], [rim[0, 0], upper]]
        axes.add_patch(Polygon(np.concatenate([rim, ends]), facecolor=colour, edgecolor=edge, linewidth=0.7))


def _draw_plate(axes: Axes, length: float, width: float, thickness: float) -> None:
    upper, lower = _corners(length, width, 0.0), _corners(length, width, -thickness)
    _fill(axes, [upper[0], upper[1], lower[1], lower[0]], _FRONT)
    _fill(axes, [upper[1], upper[2], lower[2], lower[1]], _SIDE)
    _fill(axes, upper, _TOP)
    corner = _projected([(0.5 * length, 0.5 * width, -0.5 * thickness)])[0]
    axes.annotate(
        f"{_millimetres(thickness)} thick",
        corner,
        (14.0, -16.0),
        textcoords="offset points",
        fontsize=8.0,
        arrowprops={"arrowstyle": "-", "color": ACCENT, "linewidth": 0.7, "shrinkB": 0.0},
    )


def _draw_sphere(axes: Axes, radius: float, drop: float) -> None:
    """Draw the sphere above the centre of the plate, with its drop height on a broken dimension line."""
    (across, ground), (_, centre) = _projected([(0.0, 0.0, 0.0), (0.0, 0.0, _DRAWN_DROP)])
    axes.plot([across, across], [ground, centre], color=INK, linewidth=0.6, linestyle=(0, (10, 3, 2, 3)))
    axes.plot(across, ground, "+", color=INK, markersize=7.0, markeredgewidth=0.8)
    for part in np.linspace(1.0, 0.0, 40):  # rings towards the light
        middle = (across - 0.35 * radius * (1.0 - part), centre + 0.4 * radius * (1.0 - part))
        axes.add_patch(Circle(middle, radius * part, facecolor=_LIT + (_ROCK - _LIT) * part**1.5, edgecolor="none", zorder=2.0))
    axes.add_patch(Circle((across, centre), radius, facecolor="none", edgecolor=INK, linewidth=0.7, zorder=2.1))
    beside = across + 2.6 * radius
    for height, start in ((ground, across), (centre, across + 1.15 * radius)):
        axes.plot([start, beside + 0.3 * radius], [height, height], color=ACCENT, linewidth=0.5)
    axes.annotate("", (beside, ground), (beside, centre), arrowprops=_ARROW)
    gap = ground + 0.62 * (centre - ground)
    axes.plot([beside - 0.009, beside + 0.009], [gap - 0.007, gap + 0.003], color="white", linewidth=5.0, solid_capstyle="butt")
    for shift in (-0.004, 0.004):
        axes.plot([beside - 0.009, beside + 0.009], [gap - 0.006 + shift, gap + 0.002 + shift], color=ACCENT, linewidth=0.8)
    axes.text(beside + 0.015, gap, f"{text(drop, 'm', 1)}, not to scale", fontsize=8.0, va="center")
    axes.text(across - 1.4 * radius, centre, f"radius {_millimetres(radius)}", fontsize=8.0, ha="right", va="center")


_ARROW = {"arrowstyle": "<|-|>,head_width=0.13,head_length=0.35", "color": ACCENT, "linewidth": 0.7, "shrinkA": 0.0, "shrinkB": 0.0}


def _draw_dimension(axes: Axes, start: Point, end: Point, aside: tuple[float, float], words: str) -> None:
    """Draw a dimension line between two points, offset along x and y."""
    ends = np.array([start, end])
    shift = np.array([*aside, 0.0])
    for near, far in zip(ends, ends + 1.15 * shift, strict=True):
        axes.plot(*_projected([near, far]).T, color=ACCENT, linewidth=0.5)
    first, last = _projected([*(ends + shift)])
    axes.annotate("", first, last, arrowprops=_ARROW)
    slope = np.degrees(np.arctan2(last[1] - first[1], last[0] - first[0]))
    box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
    across, up = 0.5 * (first + last)
    axes.text(across, up, words, fontsize=8.0, ha="center", va="center", rotation=slope, rotation_mode="anchor", bbox=box)


def _draw_properties(axes: Axes, case: Mapping[str, Any]) -> None:
    """Write the materials of the bodies, gravity and the support."""
    lines = []
    for body in ("sphere", "plate"):
        material = case[body]["material"]
        stiff = f"E = {material['youngs_modulus'] / 1e9:g} GPa, \u03bd = {material['poissons_ratio']:g}"
        lines.append(f"{body}: {material['density']:g} kg/m³, {stiff}")
    lines.append(f"gravity: {case['drop']['gravity']:g} m/s²")
    axes.text(0.025, 0.965, "\n".join(lines), transform=axes.transAxes, fontsize=8.0, va="top", linespacing=1.5)
    axes.text(0.025, 0.04, "four bars, fixed to the ground", transform=axes.transAxes, fontsize=8.0)
