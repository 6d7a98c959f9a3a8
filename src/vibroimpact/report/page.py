"""HTML pages of all reports: template, embedded figures, and replacement of report files on disk."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, FunctionLoader, StrictUndefined, Template

from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_into


class Picture(NamedTuple):
    """A figure of a page: name, title, caption and data URI."""

    name: str
    title: str
    caption: str
    source: str


def template(package: str) -> Template:
    """Return the page template `page.html.j2` of a package, which extends the `base.html.j2` of this one.

    Values are escaped, and an undefined variable is an error.
    """
    of = {"page.html.j2": package, "base.html.j2": __package__}
    loader = FunctionLoader(lambda file: files(of[file]).joinpath(file).read_text(encoding="utf-8"))
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return environment.get_template("page.html.j2")


def picture(name: str, title: str, words: str, svg: bytes) -> Picture:
    """Return a figure for a page, embedded as a data URI."""
    return Picture(name, title, words, f"data:image/svg+xml;base64,{b64encode(svg).decode()}")


def replace_report_files(folder: Path, write: Callable[[Path], None], stale: tuple[str, ...] = ()) -> None:
    """Replace the files of a report in an existing folder atomically.

    Parameters
    ----------
    folder : pathlib.Path
        The existing folder.
    write : callable
        Function that writes the files into an empty working folder.
    stale : tuple of str
        Patterns of files of `folder` to delete unless they were written again.

    Raises
    ------
    InputError
        If the folder can't be written to.
    """
    try:
        write_into(folder, write, stale)
    except OSError as error:
        raise InputError(f"{folder}: the report can't be written: {error.strerror or error}") from None
