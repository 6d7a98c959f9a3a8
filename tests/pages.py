"""A reader of pages: their text, their scripts and the data of their charts."""

from __future__ import annotations

import zlib
from base64 import b64decode
from html.parser import HTMLParser
from typing import Any

from vibroimpact.charts.pack import unpack


class Page(HTMLParser):
    """Scripts, attributes and text of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.scripts: list[tuple[dict[str, str | None], str]] = []
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.text = ""
        self._inside = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attributes
        if tag in ("script", "style"):
            self._inside = tag
        if tag == "script":
            self.scripts.append((dict(attributes), ""))

    def handle_endtag(self, tag: str) -> None:
        if tag == self._inside:
            self._inside = ""

    def handle_data(self, data: str) -> None:
        if self._inside == "script":
            self.scripts[-1] = (self.scripts[-1][0], self.scripts[-1][1] + data)
        elif not self._inside:
            self.text += data

    def script(self, name: str) -> str:
        """Return the text of the script that holds data or plotly."""
        return next(text for attributes, text in self.scripts if attributes.get("id") == name)

    def data(self) -> dict[str, Any]:
        """Return the charts, the scene and the colours of the page."""
        found = unpack(zlib.decompress(b64decode(self.script("data"))))
        assert isinstance(found, dict)
        return found
