"""The style of figures for print: sizes of letters, frames and grid, of the file beside
it, and labels that are safe.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib as mpl

from vibroimpact.quoting import shortened, visible

_FILE = Path(__file__).with_name("print.mplstyle")

_PROCESS_SETTINGS = ("backend", "backend_fallback", "interactive", "toolbar", "timezone")
"""Process-wide settings that do not affect the look of figures, and are left unchanged."""


def print_style() -> AbstractContextManager[None]:
    """Return a context manager that applies the style of print over any user settings of
    matplotlib, and restores them on exit.
    """
    return mpl.rc_context({**_overridden_defaults(), **_settings()})


def _overridden_defaults() -> dict[Any, Any]:
    """Return matplotlib's defaults for settings changed by the user, such as LaTeX text
    or fonts that may be missing.
    """
    have = dict(mpl.rcParams.items())
    return {
        name: value
        for name, value in _defaults().items()
        if name not in _settings()
        and (type(value) is not type(have.get(name)) or value != have.get(name))
    }


@cache
def _settings() -> dict[Any, Any]:
    return dict(mpl.rc_params_from_file(_FILE, use_default_template=False).items())


@cache
def _defaults() -> dict[Any, Any]:
    return {
        name: value for name, value in mpl.rcParamsDefault.items() if name not in _PROCESS_SETTINGS
    }


def lettering(name: str, most: int = 60) -> str:
    r"""Return a user-chosen name as a figure label: one line, shortened to `most` characters, with
    dollar signs escaped.

    Matplotlib would take an unescaped dollar sign as the start of a formula, and a line break would
    displace the titles.

    Examples
    --------
    >>> print(lettering(r"a$\frac{$b"))
    a\$\frac{\$b
    >>> print(lettering("left\nupper"), lettering("a" * 300, 10))
    left\nupper aaaa ... a
    """
    return shortened(visible(name[: 10 * most]), most).replace("$", r"\$")
