"""Decks of other programs: rendering of the templates beside the export formats."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from vibroimpact.exporting.adams_text import (
    adams_number,
    adams_numbers,
    column_titles,
    solver_lines,
    view_function,
)

if TYPE_CHECKING:
    from jinja2 import Environment

_FORMATS = "vibroimpact.exporting.formats"
"""Package that holds the folder of templates."""


def render_deck(template: str, **quantities: Any) -> str:
    """Return the text of a deck.

    Quantities are inserted as they are, and never read as a template: a name that a user chose must
    come through `vibroimpact.files.plain_names`.

    Parameters
    ----------
    template : str
        Name of the template in `exporting/formats/templates/`.
    **quantities
        What the template names; one that is missing is an error. Filters for templates
        are the other functions of this module, and those of `adams_text`.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> law = SimpleNamespace(name="hertz", equation="F = K delta^n")
    >>> render_deck("lammps.in.j2", case_name="a drop", contact_law=law)
    Traceback (most recent call last):
    ...
    jinja2.exceptions.UndefinedError: 'notes' is undefined
    """
    return _environment().get_template(template).render(quantities)


@cache
def _environment() -> Environment:
    # the formats are imported for lists of their names, which need no templates
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    folder = files(_FORMATS).joinpath("templates")
    environment = Environment(
        loader=FunctionLoader(lambda name: folder.joinpath(name).read_text(encoding="utf-8")),
        undefined=StrictUndefined,
        autoescape=False,  # decks are no HTML
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters |= {
        "number": number,
        "numbers": numbers,
        "comment_lines": comment_lines,
        "xml_comment": xml_comment,
        "adams_number": adams_number,
        "adams_numbers": adams_numbers,
        "column_titles": column_titles,
        "view_function": view_function,
        "solver_lines": solver_lines,
    }
    return environment


def number(value: float) -> str:
    """Return the shortest text from which a program reads the same float.

    Examples
    --------
    >>> number(0.1 + 0.2), number(5)
    ('0.30000000000000004', '5.0')
    """
    return repr(float(value))


def numbers(values: Iterable[float], separator: str = " ") -> str:
    """Return the text of several floats, each as `number` writes it.

    Examples
    --------
    >>> numbers([1, 2.5], ", ")
    '1.0, 2.5'
    """
    return separator.join(map(number, values))


def comment_lines(notes: list[str]) -> str:
    """Return notes as comment lines of a script.

    Examples
    --------
    >>> comment_lines(["one thing", "another"])
    '# one thing\\n# another'
    """
    return "\n".join(f"# {note}" for note in notes)


def xml_comment(text: str) -> str:
    """Return a text without two hyphens in sequence, which would end a comment in XML.

    Examples
    --------
    >>> xml_comment("a -- b -->")
    'a - - b - ->'
    """
    return re.sub("-(?=-)", "- ", text)
