"""The reproduction as a page of the documentation: `python -m vibroimpact.paper.report.documented DIR docs`."""

from __future__ import annotations

import shutil
import sys
from os import PathLike
from pathlib import Path

from vibroimpact.paper.report.markdown import FIGURES

_IMAGES = "images/reproduction"


def documented(text: str) -> str:
    """Return the report with its figures where the documentation has them."""
    return text.replace(f"]({FIGURES}/", f"]({_IMAGES}/")


def write_documented(directory: str | PathLike[str], docs: str | PathLike[str]) -> Path:
    """Write the page of the documentation from the folder of a reproduction, and return it."""
    folder, page = Path(directory), Path(docs) / "reproduction.md"
    shutil.rmtree(Path(docs) / _IMAGES, ignore_errors=True)
    (Path(docs) / _IMAGES).mkdir(parents=True)
    for picture in sorted((folder / FIGURES).glob("*.png")):
        shutil.copy(picture, Path(docs) / _IMAGES)
    page.write_text(documented((folder / "report.md").read_text(encoding="utf-8")), encoding="utf-8")
    return page


if __name__ == "__main__":
    print(f"wrote {write_documented(sys.argv[1], sys.argv[2])}")
