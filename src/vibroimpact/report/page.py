"""What the pages of all reports share: their template, and the figures that they hold."""

from __future__ import annotations

from base64 import b64encode
from importlib.resources import files
from typing import NamedTuple

from jinja2 import Environment, FunctionLoader, StrictUndefined, Template


class Picture(NamedTuple):
    """A figure on the page: its name, title, caption and data URI."""

    name: str
    title: str
    caption: str
    source: str


def template(package: str) -> Template:
    """Return the template of the page of a package, `page.html.j2`, which extends `base.html.j2` here.

    What it shows is escaped, and it may show nothing that it was not given.
    """
    of = {"page.html.j2": package, "base.html.j2": __package__}
    loader = FunctionLoader(lambda file: files(of[file]).joinpath(file).read_text(encoding="utf-8"))
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return environment.get_template("page.html.j2")


def picture(name: str, title: str, words: str, svg: bytes) -> Picture:
    """Return a figure for a page, which holds it whole."""
    return Picture(name, title, words, f"data:image/svg+xml;base64,{b64encode(svg).decode()}")
