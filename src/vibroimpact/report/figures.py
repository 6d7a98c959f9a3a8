"""The figures of a report, drawn from a result and saved."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from PIL import Image

from vibroimpact.report.deflection_figure import draw_deflection
from vibroimpact.report.excerpt import contacts
from vibroimpact.report.histories import draw_history
from vibroimpact.report.ledger import draw_ledger
from vibroimpact.report.loops import draw_loops
from vibroimpact.report.motion_figures import draw_plate_energy, draw_plate_motion, draw_sphere_energy
from vibroimpact.report.quantities import ACCELERATION, FORCE, POSITION, VELOCITY
from vibroimpact.report.sensor_figures import draw_sensor, drawn_sensors
from vibroimpact.report.style import style
from vibroimpact.storage.result import Result

_DPI = 150


def draw_figures(result: Result) -> dict[str, Figure]:
    """Draw the figures of a result.

    Parameters
    ----------
    result : Result
        A run of one drop.

    Returns
    -------
    dict of str to Figure
        In the order of the report: `position`, `force`, `velocity`, `acceleration`, `force_indentation`
        and `energy`; where bodies vibrate also `sphere_energy`, `plate_motion`, `plate_energy`, `deflection` and one
        for each sensor. Those of force, acceleration and indentation are left out where no contact has a
        duration: with an instantaneous law they do not exist.
    """
    in_contact = bool(len(contacts(result)))
    with style():
        figures = {"position": draw_history(result, POSITION)}
        if in_contact:
            figures["force"] = draw_history(result, FORCE)
        figures["velocity"] = draw_history(result, VELOCITY)
        if in_contact:
            figures["acceleration"] = draw_history(result, ACCELERATION)
            figures["force_indentation"] = draw_loops(result)
        figures["energy"] = draw_ledger(result)
        figures |= _of_vibration(result) if result.vibrates and len(result.impacts["time_s"]) else {}
    return figures


def _of_vibration(result: Result) -> dict[str, Figure]:
    figures = {"sphere_energy": draw_sphere_energy(result)}
    if "plate" in result.peaks:
        figures |= {"plate_motion": draw_plate_motion(result), "plate_energy": draw_plate_energy(result)}
        figures |= {"deflection": draw_deflection(result)} if result.deflection is not None else {}
        figures |= {figure: draw_sensor(result, name) for figure, name in drawn_sensors(result).items()}
    return figures


def save_figures(figures: Mapping[str, Figure], directory: Path) -> dict[str, bytes]:
    """Write each figure as `NAME.png` and `NAME.svg` into an existing directory.

    Returns
    -------
    dict of str to bytes
        The SVG of each figure, so that a page can hold it without drawing it again.
    """
    pictures = {}
    for name, figure in figures.items():
        (directory / f"{name}.png").write_bytes(render_png(figure))
        pictures[name] = render_svg(figure)
        (directory / f"{name}.svg").write_bytes(pictures[name])
    return pictures


def render_png(figure: Figure) -> bytes:
    """Return a figure as PNG of 150 dots an inch."""
    with style():
        figure.set_dpi(_DPI)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()  # type: ignore[no-untyped-call]
        pixels = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        page, file = Image.fromarray(pixels).convert("RGB"), BytesIO()
        page.save(file, "png", dpi=(_DPI, _DPI), compress_level=3)
    return file.getvalue()


def render_svg(figure: Figure) -> bytes:
    """Return a figure as SVG, text as outlines."""
    with style():
        file = BytesIO()
        FigureCanvasSVG(figure).print_svg(file, metadata={"Date": None})  # type: ignore[no-untyped-call]
    return file.getvalue()
