"""Every fault of a built page is a warning, which fails the build of `make docs-site`."""

from __future__ import annotations

from pathlib import Path

from page_faults import page_faults, read_pages
from sphinx.application import Sphinx
from sphinx.util import logging

_log = logging.getLogger(__name__)


def check(app: Sphinx, fault: Exception | None) -> None:
    if fault is not None or app.builder.name != "html":
        return
    pages = read_pages(Path(app.outdir))
    for sentence in page_faults(pages):
        _log.warning(sentence)
    largest = max(pages.values(), key=lambda page: page.size())
    _log.info(
        f"{len(pages)} pages; the largest, {largest.path.name}, weighs "
        f"{largest.size() / 1e6:.2f} MB with its pictures"
    )


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("build-finished", check, priority=900)  # after what others copy
    return {"parallel_read_safe": True, "parallel_write_safe": True}
