"""Charts of plotly in the gallery: one script serves all pages, captions are read aloud,
and a print of the chart is its thumbnail.
"""

from __future__ import annotations

import re
from functools import wraps
from html import escape, unescape
from pathlib import Path
from shutil import copyfile
from textwrap import indent
from typing import Any

import plotly
from docutils import nodes
from plotly.graph_objects import Figure
from sphinx.application import Sphinx

import vibroimpact.charts.notebook as notebook
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.files import FORMATS
from vibroimpact.charts.matplotlib import matplotlib_figure

SCRIPT = Path(plotly.__file__).parent / "package_data" / "plotly.min.js"
CLASS = "plotly-chart"

_drawn: list[tuple[Figure, Chart]] = []
"""The figures that examples have asked for, with their charts: a figure can't be a key."""


def scrape(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Return what a page shows of the figure that a block of an example ends with, and
    draw its thumbnail.
    """
    names = block_vars["example_globals"]
    figure = names.get("___")  # the value of the last line, as Sphinx-Gallery calls it
    if not isinstance(figure, Figure):
        return ""
    names["___"] = None  # shown now; the next block may end without a value
    title = figure.layout.title.text or ""
    words = title
    if chart := next((chart for drawn, chart in _drawn if drawn is figure), None):
        words = f"{title}. {chart.caption}"
        Path(next(block_vars["image_path_iterator"])).write_bytes(
            FORMATS["png"](matplotlib_figure(chart))
        )
    _drawn.clear()
    html = figure.to_html(
        full_html=False, include_plotlyjs=False, config={"responsive": True, "displaylogo": False}
    )
    shown = f'<div class="{CLASS}" role="figure" aria-label="{escape(words)}">{html}</div>'
    return f".. raw:: html\n\n{indent(shown, '    ')}\n"


def _remembering(plotly_figure: Any) -> Any:
    @wraps(plotly_figure)
    def figure_of(chart: Chart) -> Figure:
        figure = plotly_figure(chart)
        _drawn.append((figure, chart))
        return figure

    return figure_of


def describe_thumbnails(app: Sphinx, tree: nodes.document) -> None:
    """Give the thumbnails of the gallery, which have none, the words that the pointer shows."""
    words = ""
    for node in tree.findall(lambda node: isinstance(node, nodes.raw | nodes.image)):
        if shown := re.search(r'tooltip="([^"]*)"', node.astext()):
            words = unescape(shown[1])
        elif isinstance(node, nodes.image) and node["uri"].endswith("_thumb.png"):
            node["alt"] = words


def add_script(
    app: Sphinx, page: str, template: str, context: dict[str, Any], tree: nodes.document | None
) -> None:
    """Load plotly's script, and what fits charts to their columns, into pages that have a
    chart of it, and into no other.
    """
    if tree is not None and any(CLASS in raw.astext() for raw in tree.findall(nodes.raw)):
        app.add_js_file(SCRIPT.name)
        app.add_js_file("chart-columns.js")


def copy_script(app: Sphinx, fault: Exception | None) -> None:
    if fault is None:
        copyfile(SCRIPT, Path(app.outdir) / "_static" / SCRIPT.name)


def setup(app: Sphinx) -> dict[str, bool]:
    # before what draws with it is imported
    notebook.plotly_figure = _remembering(notebook.plotly_figure)
    app.connect("doctree-read", describe_thumbnails)
    app.connect("html-page-context", add_script)
    app.connect("build-finished", copy_script)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
