"""Animation of plate and sphere: the deflected plate in parallel projection, with
exaggerated deflection.
"""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Ellipse, PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray
from PIL import Image

from vibroimpact.arrays import Floats
from vibroimpact.charts.palette import DIVERGING, INK, LOOKS
from vibroimpact.charts.print_style import print_style
from vibroimpact.report.projection import TILT, depth, project
from vibroimpact.results.deflection import Deflection
from vibroimpact.results.result import Result
from vibroimpact.results.surface_grid import beyond_edge
from vibroimpact.runs.chart_data import touch_height
from vibroimpact.runs.scene import exaggeration
from vibroimpact.units.display import fixed, text

_SIZE = (5.8, 3.3)
_DPI = 100
_CELLS = 22
"""Number of cells along the longer side of the plate; more would not be visible."""
_MILLISECONDS = 70
"""Duration of a frame."""
_MAP = LinearSegmentedColormap.from_list("deflection", list(DIVERGING))
_SHADES = 25
"""Colour map of the plate, and number of its shades in the palette."""


def animate(result: Result) -> bytes:
    """Return an animation of plate and sphere around the first visit as GIF.

    The plate's deflection is exaggerated by a factor stated in the picture; the sphere and its gap
    to the plate are to scale. Frames are closer in time where the motion is fast, and each states
    its time.

    Parameters
    ----------
    result : Result
        Result with a deflection.
    """
    deflection = result.deflection
    assert deflection is not None  # checked by the caller
    with print_style():
        scene = _AnimationScene(result, deflection)
        frames = [Image.fromarray(scene.frame(number)) for number in range(len(deflection.time))]
    palette = _palette()
    plain = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    file = BytesIO()
    plain[0].save(
        file,
        "gif",
        save_all=True,
        append_images=plain[1:],
        duration=_MILLISECONDS,
        loop=0,
        optimize=False,
    )
    return file.getvalue()


def _palette() -> Image.Image:
    """Return an image with the palette of all frames: the colours of the plate, the same
    darkened for mesh lines, and greys.
    """
    plate = 255.0 * _MAP(np.linspace(0.0, 1.0, _SHADES))[:, :3]
    greys = np.repeat(np.linspace(0.0, 255.0, _SHADES)[:, None], 3, axis=1)
    colours = np.concatenate([plate, 0.8 * plate, greys]).round().astype(np.uint8)
    picture = Image.new("P", (1, 1))
    picture.putpalette(colours.tobytes())
    return picture


class _AnimationScene:
    """Drawing of the frames: the static background is rendered once, and the moving
    artists are drawn over copies of it.
    """

    def __init__(self, result: Result, deflection: Deflection) -> None:
        self.deflection = deflection
        self.factor = exaggeration(deflection)
        self.radius = touch_height(result)
        self.contact = np.array(deflection.contact[0]), np.array(deflection.contact[1])
        self.outline = None
        if result.plate_shape is not None:
            self.outline = result.plate_shape.above
        self.touch = float(result.impacts["time_s"][0])
        skip = self.skip = max(1, round(max(len(deflection.x), len(deflection.y)) / _CELLS))
        self.columns, self.rows = (
            np.unique(np.append(np.arange(0, len(side), skip), len(side) - 1))
            for side in (deflection.x, deflection.y)
        )
        self.x, self.y = np.meshgrid(deflection.x[self.columns], deflection.y[self.rows])
        self.canvas = FigureCanvasAgg(Figure(figsize=_SIZE, dpi=_DPI))
        figure = self.canvas.figure
        self.axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self.axes.set_axis_off()
        self.axes.set_aspect("equal")
        self.movers = self._artists(result, figure)
        self._set_limits()
        self.canvas.draw()  # type: ignore[no-untyped-call]
        self.ground = self.canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]

    def _artists(self, result: Result, figure: Figure) -> list[Artist]:
        most = self.factor * float(np.nanmax(np.abs(self.deflection.height)))
        self.plate = PolyCollection(
            [], cmap=_MAP, norm=Normalize(-most, most), edgecolors="#00000030", linewidths=0.3
        )
        self.edge = PathPatch(
            Path(np.zeros((1, 2))), facecolor="none", edgecolor=INK.light, linewidth=0.6
        )
        self.shadow = Ellipse(
            (0.0, 0.0),
            2.0 * self.radius,
            2.0 * self.radius * np.sin(TILT),
            facecolor="#000000",
            alpha=0.25,
        )
        self.ball = Circle(
            (0.0, 0.0),
            self.radius,
            facecolor=LOOKS["sphere"].light,
            edgecolor=INK.light,
            linewidth=1.0,
        )
        self.shine = Ellipse(
            (0.0, 0.0),
            0.5 * self.radius,
            0.35 * self.radius,
            angle=35.0,
            facecolor="white",
            alpha=0.7,
        )
        self.clock = figure.text(0.03, 0.93, "", fontsize=12, color=INK.light)
        phrase = f"plate's deflection magnified {self.factor:g} times; ball and gap to scale"
        figure.text(0.03, 0.045, phrase, fontsize=8, color=INK.light)
        figure.text(0.97, 0.045, "red up, blue down", fontsize=8, color=INK.light, ha="right")
        for artist in (self.plate, self.edge, self.shadow, self.ball, self.shine):
            artist.set_animated(True)
        self.clock.set_animated(True)
        self.axes.add_collection(self.plate, autolim=False)
        for patch in (self.edge, self.shadow, self.ball, self.shine):
            self.axes.add_patch(patch)
        return [self.plate, self.edge, self.shadow, self.ball, self.shine, self.clock]

    def _set_limits(self) -> None:
        deflection = self.deflection
        highest = float(np.nanmax(self._ball_height(slice(None)))) + self.radius
        across, up = project(self.x, self.y, np.zeros_like(self.x))
        swing = self.factor * float(np.nanmax(np.abs(deflection.height)))
        ball = project(*self.contact, np.array(highest))[1]
        top = max(
            float(up.max()) + 0.5 * swing,
            min(float(ball), float(up.max()) + 0.5 * swing + 4.0 * self.radius),
        )
        _show_whole(
            self.axes,
            (float(across.min()), float(across.max())),
            (float(up.min()) - 0.3 * swing, top),
            _SIZE[0] / _SIZE[1],
        )

    def _ball_height(self, frame: int | slice) -> Floats:
        """Return the drawn height of the sphere's centre [m]: at its true gap above the
        exaggerated plate.
        """
        down = self.deflection.contact_deflection[frame]
        return np.asarray(self.deflection.sphere_position[frame] - down + self.factor * down)

    def frame(self, number: int) -> NDArray[np.uint8]:
        """Return a frame as an image, (height, width, 3)."""
        deflection = self.deflection
        drawn_height = deflection.height[number].astype(float)
        if self.outline is not None:
            drawn_height = beyond_edge(drawn_height, self.skip)
            self._cut(drawn_height)
        height = self.factor * drawn_height[np.ix_(self.rows, self.columns)]
        corners = np.stack(project(self.x, self.y, height), axis=-1)
        cells: Any = np.stack(_at_corners_of_cells(corners), axis=2).reshape(-1, 4, 2)
        mean = np.mean(_at_corners_of_cells(height), axis=0).ravel()
        # painter's algorithm: the farthest cells are drawn first
        order = np.argsort(-depth(self.x, self.y)[:-1, :-1].ravel(), kind="stable")
        # heights are NaN outside a plate that is no rectangle
        order = order[np.isfinite(mean[order])]
        self.plate.set_verts(cells[order])
        self.plate.set_array(mean[order])
        self._move_ball(number)
        self.clock.set_text(_clock(float(deflection.time[number]) - self.touch))
        self.canvas.restore_region(self.ground)  # type: ignore[no-untyped-call]
        renderer = self.canvas.get_renderer()  # type: ignore[no-untyped-call]
        for artist in self.movers:
            artist.draw(renderer)
        return np.array(self.canvas.buffer_rgba())[..., :3]  # type: ignore[no-untyped-call]

    def _cut(self, height: Floats) -> None:
        """Cut the plate along its outline, on the deformed surface, and draw that."""
        assert self.outline is not None  # checked by the caller
        x, y = self.outline.T
        columns = np.abs(self.deflection.x[:, None] - x).argmin(axis=0)
        rows = np.abs(self.deflection.y[:, None] - y).argmin(axis=0)
        at_outline = np.nan_to_num(self.factor * height[rows, columns])
        points = np.stack(project(x, y, at_outline), axis=-1)
        is_gap = np.isnan(x)
        codes = np.full(len(x), Path.LINETO, dtype=Path.code_type)
        codes[0] = Path.MOVETO
        codes[1:][is_gap[:-1]] = Path.MOVETO
        path = Path(points[~is_gap], codes[~is_gap])
        self.edge.set_path(path)
        self.plate.set_clip_path(path, self.axes.transData)

    def _move_ball(self, number: int) -> None:
        """Move ball, shine and shadow to where they are in a frame."""
        contact = self.factor * float(self.deflection.contact_deflection[number])
        shadow_x, shadow_y = project(*self.contact, np.array(contact))
        self.shadow.set_center((float(shadow_x), float(shadow_y)))
        ball_x, ball_y = project(*self.contact, self._ball_height(number))
        self.ball.set_center((float(ball_x), float(ball_y)))
        # the light comes from the upper left
        shine_x = float(ball_x) - 0.35 * self.radius
        shine_y = float(ball_y) + 0.4 * self.radius
        self.shine.set_center((shine_x, shine_y))


def _at_corners_of_cells(nodal: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return values on a grid at the four corners of each cell, in the order of an outline."""
    return nodal[:-1, :-1], nodal[:-1, 1:], nodal[1:, 1:], nodal[1:, :-1]


def _show_whole(
    axes: Axes, across: tuple[float, float], up: tuple[float, float], ratio: float
) -> None:
    """Set the limits of axes of an aspect ratio (width over height) so that a range fits
    in equal scales, with margins for labels.
    """
    width = (across[1] - across[0]) * 1.08
    height = (up[1] - up[0]) * 1.22
    width = max(width, height * ratio)
    height = width / ratio
    middle = 0.5 * (across[0] + across[1]), 0.5 * (up[0] + up[1])
    axes.set_xlim(middle[0] - 0.5 * width, middle[0] + 0.5 * width)
    axes.set_ylim(middle[1] - 0.5 * height, middle[1] + 0.5 * height)


def _clock(since: float) -> str:
    # milliseconds with fixed decimals keep the figures of a clock in place
    distance = f"{fixed(since / 1e-3, 2)}\u00a0ms"
    if abs(since) < 1e-3:
        distance = text(abs(since), "s", 3)
    side = "before" if since < 0.0 else "after"
    return f"{distance} {side} first touch"
