"""A figure of the reproduction with title and caption, and the line styles of overlapping curves."""

from __future__ import annotations

from typing import Any, NamedTuple

from matplotlib.figure import Figure

from vibroimpact.report.style import LOOPS


class Drawing(NamedTuple):
    """A figure of the reproduction.

    Parameters
    ----------
    figure : Figure
        The figure.
    title : str
        Title, with the number of the figure in the paper.
    sentence : str
        Caption.
    """

    figure: Figure
    title: str
    sentence: str


LINE_STYLES: tuple[dict[str, Any], ...] = tuple(
    {"color": colour, "linestyle": dashes, "linewidth": width, "alpha": opacity}
    for (colour, dashes), width, opacity in zip(LOOPS, (2.3, 1.5, 1.1), (0.35, 1.0, 1.0), strict=False)
)
"""Styles of up to three curves that may coincide: the first is wide and pale, so that it stays visible under the others."""
