"""X."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, FunctionLoader, StrictUndefined, Template

from vibroimpact.errors import InputError
from vibroimpact.files.write_into_folder import write_into


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


def write_beside(folder: Path, write: Callable[[Path], None], goes: tuple[str, ...] = ()) -> None:
    """Write the files of a report into a folder that is there: all of them or none.

    Parameters
    ----------
    folder : pathlib.Path
        Where they go.
    write : callable
        Writes them into an empty folder.
    goes : tuple of str
        Patterns of the files of `folder` that go if they were not written again.

    Raises
    ------
    InputError
        If the folder can't be written to.
    """
    try:
        write_into(folder, write, goes)
    except OSError as error:
        raise InputError(f"{folder}: the report can't be written: {error.strerror or error}") from None
