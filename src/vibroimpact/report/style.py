"""The style of all figures: font sizes, colours, line styles that differ in greyscale too, and safe labels."""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache
from typing import Any

import matplotlib as mpl

from vibroimpact.shown import shortened, visible

ENLARGED = 5
"""Most contacts shown enlarged; more panels would be too narrow to read."""

INK = "#1b1b1b"
ACCENT = "#0b4f8a"
MARK = "#b3400e"
CONTACT = "#e6e6e6"
"""Colours of the main line, of enlarged parts, of marks, and of the background of a contact."""

# colours of different luminance, and different dashes, keep the lines apart in greyscale print
LOOPS: tuple[tuple[str, str | tuple[int, tuple[int, ...]]], ...] = (
    ("#00204d", "-"),
    ("#0072b2", (0, (6, 2))),
    ("#b3400e", (0, (6, 2, 1, 2))),
    ("#5f8f3e", (0, (2, 1))),
    ("#cc79a7", "-"),
    ("#6b6b6b", (0, (10, 2, 2, 2))),
    ("#c79000", (0, (4, 3))),
    ("#56a8d8", (0, (1, 1))),
)
"""Colours and dashes of the loops, in order."""

MARKS = ("o", "s", "^", "D", "v")
"""Marks of the first `ENLARGED` impacts, in order."""

# distinct in luminance and hatch, from the bottom of the stack to its top
BANDS: dict[str, tuple[str, str]] = {
    "contact_dissipated_J": ("#404040", ""),
    "plastic_work_J": ("#9c6b52", ".."),
    "sphere_damping_J": ("#7d7d7d", "\\\\\\\\"),
    "plate_damping_J": ("#a3a3a3", "||||"),
    "written_off_at_rest_J": ("#ffffff", "xx"),
    "contact_elastic_J": ("#f7cd6b", "////"),
    "sphere_motion_J": ("#e8a0a0", "...."),
    "plate_motion_J": ("#c9e3b4", "----"),
    "potential_J": ("#d6e6f4", ""),
    "kinetic_J": ("#4a8cc7", "\\\\"),
}
"""Colour and hatch of each band of the energy balance."""

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
    "axes.formatter.limits": (-4, 5),
    "axes.formatter.useoffset": False,
    "axes.unicode_minus": True,
    "grid.color": "#d9d9d9",
    "grid.linewidth": 0.5,
    "xtick.color": "#555555",
    "ytick.color": "#555555",
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "axes.labelcolor": INK,
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


def style() -> AbstractContextManager[None]:
    """Return a context manager that applies the report style over any user settings of matplotlib, and restores them on exit."""
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
