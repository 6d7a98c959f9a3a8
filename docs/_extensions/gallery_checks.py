"""What an example of the gallery must do: end without a warning, draw figures with a
title, and leave no file. A fault fails the build.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from sphinx.errors import ExtensionError
from sphinx_gallery.scrapers import matplotlib_scraper

_SOURCES = {".py", ".rst", ".toml"}
"""What lies in the folder of the examples before they run."""


def has_title(figure: Figure) -> bool:
    """Return whether a figure or one of its axes has a title, which becomes the text for
    those who do not see the figure.
    """
    titles = [axes.get_title(side) for axes in figure.axes for side in ("left", "center")]
    return bool(figure.get_suptitle() or any(titles))


def scrape(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Save the figures of matplotlib that a block has drawn, each of which must have a title."""
    for number in plt.get_fignums():
        if not has_title(plt.figure(number)):
            raise ExtensionError(f"{block_vars['src_file']}: the figure has no title")
    return matplotlib_scraper(block, block_vars, gallery_conf)


def check_example(gallery_conf: dict[str, Any], example: str | None, when: str) -> None:
    """Turn warnings of an example into errors, and refuse the files that it leaves beside
    itself.
    """
    if when == "before":
        warnings.simplefilter("error")
        # plt.show() of each example
        warnings.filterwarnings("ignore", "FigureCanvasAgg is non-interactive")
        return
    warnings.resetwarnings()
    if example is None:
        return
    folder = Path(gallery_conf["src_dir"], gallery_conf["examples_dirs"][0]).resolve()
    files = [
        file.name for file in folder.iterdir() if file.is_file() and file.suffix not in _SOURCES
    ]
    if files:
        raise ExtensionError(f"{example}: the example leaves {', '.join(sorted(files))}")
