"""Figures rendered as PNG and as SVG, and written as files."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from PIL import Image

from vibroimpact.report.style import style

_DPI = 150


def save_figures(figures: Mapping[str, Figure], directory: Path) -> dict[str, bytes]:
    """Write each figure as `NAME.png` and `NAME.svg` into an existing directory.

    Returns
    -------
    dict of str to bytes
        The SVG of each figure, to embed in a page without rendering it again.
    """
    pictures = {}
    for name, figure in figures.items():
        (directory / f"{name}.png").write_bytes(render_png(figure))
        pictures[name] = render_svg(figure)
        (directory / f"{name}.svg").write_bytes(pictures[name])
    return pictures


def render_png(figure: Figure) -> bytes:
    """Return a figure as PNG at 150 dots per inch."""
    with style():
        figure.set_dpi(_DPI)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()  # type: ignore[no-untyped-call]
        pixels = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        page, file = Image.fromarray(pixels).convert("RGB"), BytesIO()
        page.save(file, "png", dpi=(_DPI, _DPI), compress_level=3)
    return file.getvalue()


def render_svg(figure: Figure) -> bytes:
    """Return a figure as SVG with text as outlines, reproducible byte for byte."""
    with style():
        file = BytesIO()
        FigureCanvasSVG(figure).print_svg(file, metadata={"Date": None})  # type: ignore[no-untyped-call]
    return file.getvalue()
