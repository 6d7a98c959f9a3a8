"""The style of figures for print: sizes of letters, frames and grid, and labels that are safe."""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache
from typing import Any

import matplotlib as mpl

from vibroimpact.charts.palette import INK
from vibroimpact.shown import shortened, visible

_SETTINGS: dict[Any, Any] = {
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.labelsize": 9.0,
    "figure.titlesize": 10.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "axes.edgecolor": "#555555",
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlelocation": "left",
    # automatic title placement takes a third of the drawing time
    "axes.titley": 1.0,
    "axes.formatter.limits": (-4, 7),
    "axes.formatter.useoffset": False,
    "axes.unicode_minus": True,
    "grid.color": "#d9d9d9",
    "grid.linewidth": 0.5,
    "xtick.color": "#555555",
    "ytick.color": "#555555",
    "xtick.labelcolor": INK.light,
    "ytick.labelcolor": INK.light,
    "text.color": INK.light,
    "axes.labelcolor": INK.light,
    "lines.linewidth": 1.2,
    "lines.solid_joinstyle": "miter",
    "hatch.linewidth": 0.5,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    # points that move a line by less than a fifth of a typographic point are invisible, and enlarge the files
    "path.simplify": True,
    "path.simplify_threshold": 0.2,
    # outlines look the same on every machine, whatever its fonts
    "svg.fonttype": "path",
    # reproducible files, byte for byte
    "svg.hashsalt": "vibroimpact",
}


_PROCESS_SETTINGS = ("backend", "backend_fallback", "interactive", "toolbar", "timezone")
"""Process-wide settings that do not affect the look of figures, and are left unchanged."""


def print_style() -> AbstractContextManager[None]:
    """Return a context manager that applies the style of print over any user settings of matplotlib, and restores them on exit."""
    return mpl.rc_context({**_overridden_defaults(), **_SETTINGS})


def _overridden_defaults() -> dict[Any, Any]:
    """Return matplotlib's defaults for settings changed by the user, such as LaTeX text or fonts that may be missing."""
    have = dict(mpl.rcParams.items())
    return {
        name: value
        for name, value in _defaults().items()
        if name not in _SETTINGS and (type(value) is not type(have.get(name)) or value != have.get(name))
    }


@cache
def _defaults() -> dict[Any, Any]:
    return {name: value for name, value in mpl.rcParamsDefault.items() if name not in _PROCESS_SETTINGS}


def lettering(name: str, most: int = 60) -> str:
    r"""Return a user-chosen name as a figure label: one line, shortened to `most` characters, with dollar signs escaped.

    Matplotlib would take an unescaped dollar sign as the start of a formula, and a line break would displace the titles.

    Examples
    --------
    >>> print(lettering(r"a$\frac{$b"))
    a\$\frac{\$b
    >>> print(lettering("left\nupper"), lettering("a" * 300, 10))
    left\nupper aaaa ... a
    """
    return shortened(visible(name[: 10 * most]), most).replace("$", r"\$")
