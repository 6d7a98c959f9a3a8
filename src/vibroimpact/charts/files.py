"""Charts written as files: PNG, SVG and PDF."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from PIL import Image

from vibroimpact.charts.chart import Chart
from vibroimpact.charts.made import warn_of_lost
from vibroimpact.charts.matplotlib import matplotlib_figure
from vibroimpact.charts.print_style import print_style
from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted

_DPI = 200


def save_charts(
    charts: Sequence[Chart],
    directory: Path,
    formats: Sequence[str] = ("png",),
    progress: Callable[[float], None] = lambda done: None,
) -> list[Path]:
    """Write each chart as `NAME.FORMAT` into an existing directory; one that can't be drawn is left
    out, with a `ChartWarning`.

    Parameters
    ----------
    charts : sequence of Chart
        The charts.
    directory : pathlib.Path
        Existing directory.
    formats : sequence of str
        Of "png", "svg" and "pdf".
    progress : callable, optional
        Called with the part of the charts that is written, up to 1.

    Returns
    -------
    list of pathlib.Path
        The files.

    Raises
    ------
    InputError
        If there is no such format.

    Examples
    --------
    >>> import tempfile
    >>> from vibroimpact.charts.axis import Axis
    >>> from vibroimpact.charts.chart import Panel
    >>> from vibroimpact.charts.marks import Line
    >>> line = Line(np.array([0.0, 1.0]), np.array([5.0, 7.0]))
    >>> chart = Chart("force", "Force", ((Panel(Axis("Time", "s"), Axis("Force", "N"), (line,)),),))
    >>> with tempfile.TemporaryDirectory() as place:
    ...     [file.name for file in save_charts([chart], Path(place), ("png", "pdf"))]
    ['force.png', 'force.pdf']
    """
    check_formats(formats)
    written = []
    for number, chart in enumerate(charts, start=1):
        for name in dict.fromkeys(formats):
            try:
                # a figure of its own, as drawing changes the layout of the next drawing
                content = FORMATS[name](matplotlib_figure(chart))
            except Exception as error:
                warn_of_lost(chart.name, error)
                continue
            written.append(directory / f"{chart.name}.{name}")
            written[-1].write_bytes(content)
        progress(number / len(charts))
    return written


def check_formats(formats: Sequence[str]) -> None:
    """Check that there are figures of some formats.

    Raises
    ------
    InputError
        If there is no such format, or none is given.

    Examples
    --------
    >>> check_formats(["pgn"])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    vibroimpact.errors.InputError: there are no figures of the format "pgn"; there are png, ...
    """
    for name in formats:
        if name not in FORMATS:
            known = f"there are {choices(FORMATS, name)}"
            raise InputError(f"there are no figures of the format {quoted(name)}; {known}")
    if not formats:
        raise InputError(f"name a format of the figures: {', '.join(FORMATS)}")


def render_png(figure: Figure) -> bytes:
    """Return a figure as PNG at 200 dots per inch."""
    with print_style():
        figure.set_dpi(_DPI)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()  # type: ignore[no-untyped-call]
        pixels = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        page = Image.fromarray(pixels).convert("RGB")
        file = BytesIO()
        page.save(file, "png", dpi=(_DPI, _DPI), compress_level=6)
    return file.getvalue()


def render_svg(figure: Figure) -> bytes:
    """Return a figure as SVG with text as outlines, reproducible byte for byte."""
    with print_style():
        figure.set_dpi(_DPI)  # of what is drawn as pixels in it, such as many points
        file = BytesIO()
        FigureCanvasSVG(figure).print_svg(file, metadata={"Date": None})  # type: ignore[no-untyped-call]
    return file.getvalue()


def render_pdf(figure: Figure) -> bytes:
    """Return a figure as PDF, reproducible byte for byte."""
    with print_style():
        figure.set_dpi(_DPI)
        file = BytesIO()
        FigureCanvasPdf(figure).print_pdf(file, metadata={"CreationDate": None})  # type: ignore[no-untyped-call]
    return file.getvalue()


FORMATS: dict[str, Callable[[Figure], bytes]] = {
    "png": render_png,
    "svg": render_svg,
    "pdf": render_pdf,
}
"""What renders a figure in each format."""
