"""The reproduction as a page of the documentation: `python -m
vibroimpact.paper.report.docs_page DIR docs`.
"""

from __future__ import annotations

import shutil
import sys
from os import PathLike
from pathlib import Path

from PIL import Image

from vibroimpact.files.result_folder import FIGURES

_IMAGES = "images/reproduction"


def docs_page_text(text: str) -> str:
    """Return the report with the paths of its figures in the documentation."""
    return text.replace(f"]({FIGURES}/", f"]({_IMAGES}/")


def write_docs_page(directory: str | PathLike[str], docs: str | PathLike[str]) -> Path:
    """Write the page of the documentation and its figures from the folder of a
    reproduction; return the path of the page.
    """
    folder = Path(directory)
    page = Path(docs) / "reproduction.md"
    shutil.rmtree(Path(docs) / _IMAGES, ignore_errors=True)
    (Path(docs) / _IMAGES).mkdir(parents=True)
    for picture in sorted((folder / FIGURES).glob("*.png")):
        # 256 colours are enough for a chart, and make a page of many less than half as heavy
        Image.open(picture).quantize(256, dither=Image.Dither.NONE).save(
            Path(docs) / _IMAGES / picture.name, optimize=True
        )
    page.write_text(
        docs_page_text((folder / "report.md").read_text(encoding="utf-8")), encoding="utf-8"
    )
    return page


if __name__ == "__main__":
    print(f"wrote {write_docs_page(sys.argv[1], sys.argv[2])}")
