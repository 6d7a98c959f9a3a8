"""HTML pages of all reports: template, charts with their data and scripts, and
replacement of report files on disk.
"""

from __future__ import annotations

import zlib
from base64 import b64encode
from collections.abc import Callable, Sequence
from dataclasses import asdict
from functools import cache
from hashlib import sha256
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined, Template
from markupsafe import Markup

from vibroimpact.charts.chart import Chart
from vibroimpact.charts.made import drawn
from vibroimpact.charts.pack import pack
from vibroimpact.charts.palette import DIVERGING, DIVERGING_ON_DARK, GRID, GROUND, INK, LOOKS, SOFT
from vibroimpact.charts.plotly import plotly_chart
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_into
from vibroimpact.report.result_warning import size_of

_CHARTS = "vibroimpact.charts"
_COMPRESSION = 6
"""Level of compression of the scripts and data of a page: it takes a fifth of a second."""


def render_page(
    package: str, charts: Sequence[Chart], scene: dict[str, Any] | None = None, **values: Any
) -> str:
    """Return a report as one self-contained page whose charts can be explored, without network.

    The content policy of the page allows its own scripts alone, by their checksums. Charts and
    plotly itself lie compressed in it.

    Parameters
    ----------
    package : str
        Package that holds the template `page.html.j2`, which extends the `base.html.j2` of this
        one.
    charts : sequence of Chart
        The charts; the template places them by `figure(charts.NAME)`.
    scene : dict, optional
        The plate in motion, as `runs.scene.scene_of` returns it.
    **values
        What else the template takes; texts are escaped.
    """
    figures = [drawn(chart, plotly_chart) for chart in charts]
    data = pack({"charts": figures, "scene": scene, "palette": palette()})
    scripts = [
        _script(_CHARTS, "scripts/arrays.js"),
        _script(_CHARTS, "scripts/charts.js"),
        _script(_CHARTS, "scripts/scene.js"),
        _script(__package__, "page.js"),
    ]
    # the page's policy lets browsers run these scripts alone
    digests = [*map(_digest, scripts), _plotly_digest()]
    return template(package).render(
        charts={figure["name"]: figure for figure in figures},
        heights={figure["name"]: figure["layout"]["height"] + 90 for figure in figures},
        keys={figure["name"]: _keys_of(figure) for figure in figures},
        scene=scene is not None,
        views=max((figure["views"] for figure in figures), key=len, default=()),
        theme=Markup(_script(_CHARTS, "scripts/theme.css")),
        scripts=[Markup(script) for script in scripts],
        hashes=" ".join(f"'sha256-{digest}'" for digest in digests),
        plotly=_plotly_compressed(),
        data=b64encode(zlib.compress(data, _COMPRESSION)).decode(),
        **values,
    )


def _keys_of(chart: dict[str, Any]) -> list[str]:
    """Return by what the points of a chart may be coloured."""
    return list(dict.fromkeys(key for trace in chart["data"] for key in trace.get("keys", ())))


@cache
def template(package: str) -> Template:
    """Return the page template `page.html.j2` of a package, which extends the `base.html.j2` of
    this one.

    Values are escaped, and an undefined variable is an error.
    """
    of = {"page.html.j2": package, "base.html.j2": __package__, "parts.html.j2": __package__}
    loader = FunctionLoader(lambda file: files(of[file]).joinpath(file).read_text(encoding="utf-8"))
    environment = Environment(
        loader=loader,
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["size_of"] = size_of
    return environment.get_template("page.html.j2")


def palette() -> dict[str, dict[str, str | list[str]]]:
    """Return the colour of every role on light and on dark ground, and as `diverging` those of a
    surface that moves up and down.

    Examples
    --------
    >>> palette()["dark"]["ground"], palette()["light"]["diverging"][2]
    ('#14181d', '#f7f7f7')
    """
    looks = {"ground": GROUND, "ink": INK, "soft": SOFT, "grid": GRID, **LOOKS}
    scales = {"light": DIVERGING, "dark": DIVERGING_ON_DARK}
    return {
        theme: {
            **{role: asdict(look)[theme] for role, look in looks.items()},
            "diverging": [colour for _, colour in stops],
        }
        for theme, stops in scales.items()
    }


def _script(package: str, file: str) -> str:
    return files(package).joinpath(file).read_text(encoding="utf-8")


@cache
def plotly_script() -> str:
    """Return the text of plotly's script, from the installed package, which is not
    imported for it.
    """
    package = find_spec("plotly")
    assert package is not None  # a dependency of this package
    assert package.submodule_search_locations is not None
    return (
        Path(package.submodule_search_locations[0]) / "package_data" / "plotly.min.js"
    ).read_text(encoding="utf-8")


@cache
def _plotly_digest() -> str:
    return _digest(plotly_script())


@cache
def _plotly_compressed() -> str:
    return b64encode(zlib.compress(plotly_script().encode(), _COMPRESSION)).decode()


def _digest(script: str) -> str:
    return b64encode(sha256(script.encode()).digest()).decode()


def replace_report_files(
    folder: Path, write: Callable[[Path], None], stale: tuple[str, ...] = ()
) -> None:
    """Replace the files of a report in an existing folder atomically.

    Parameters
    ----------
    folder : pathlib.Path
        The existing folder.
    write : callable
        Function that writes the files into an empty working folder.
    stale : tuple of str
        Patterns of files of `folder` to delete unless they were written again.

    Raises
    ------
    InputError
        If the folder can't be written to.
    """
    try:
        write_into(folder, write, stale)
    except OSError as error:
        raise InputError(
            f"{folder}: the report can't be written: {error.strerror or error}"
        ) from None
