"""Terminal output of the command `laws`: the tables of all contact and friction laws, and
the sheet of one law.
"""

from __future__ import annotations

from collections.abc import Iterable

from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.contact.friction.registry import friction_laws
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.registry import contact_laws, find_contact_law
from vibroimpact.law_sheets.text import (
    SPEED,
    LawText,
    ParameterText,
    asked_and_achieved,
    law_text,
    plain_paragraph,
    short_source,
)
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable

_ENDS = {"zero-indentation": "zero indentation", "zero-force": "zero force", "pull-off": "pull-off"}
_TENSION = {"none": "never", "cut": "cut", "kept": "yes"}
_WIDE = 130  # terminal width in columns from which sources are printed in full


def law_table(width: int) -> RenderableType:
    """Return the tables of contact and friction laws for a terminal width in columns."""
    rows = []
    for name, law in contact_laws().items():
        end = "instantaneous"
        tension = "-"
        if issubclass(law, CompliantLaw):
            end = _ENDS[law.contact_end]
            tension = _TENSION[law.tension]
        loss_parameters = law_text(law).loss_parameters.replace("nothing is lost", "-")
        rows.append((name, loss_parameters, end, tension, _source_at(width, law)))
    headings = ("law", "loss parameter", "end of contact", "tension", "source")
    table = TerminalTable(
        [
            TerminalColumn(phrase, cells, text=True)
            for phrase, cells in zip(headings, zip(*rows, strict=True), strict=True)
        ],
        indent=0,
    )
    hint = (
        '"vibroimpact laws NAME" prints a law with equation, parameters and sources; with -o '
        "PNG it draws the curves of a contact law."
    )
    return Group(table, Text(), _friction_table(width), Text(), Text(hint))


def _source_at(width: int, law: type[ContactLaw | FrictionLaw]) -> str:
    """Return the source of a law as it fits into a terminal."""
    if width >= _WIDE:
        return law.source
    return short_source(law)


def _friction_table(width: int) -> RenderableType:
    """Return the table of friction laws for a terminal width in columns."""
    rows = [(name, law.equation, _source_at(width, law)) for name, law in friction_laws().items()]
    headings = ("friction law", "equation", "source")
    cells = zip(*rows, strict=True)
    return TerminalTable(
        [
            TerminalColumn(phrase, list(column), text=True)
            for phrase, column in zip(headings, cells, strict=True)
        ],
        indent=0,
    )


def law_sheet(name: str) -> RenderableType:
    """Return the sheet of a contact or friction law: equation, parameters, state, end of the
    contact, notes and references.

    Raises
    ------
    InputError
        If there is no such law.
    """
    law = friction_laws().get(name) or find_contact_law(name)
    text = law_text(law)
    body = text.body
    if body and body[0].startswith(".. math::"):
        body = body[1:]  # the sheet prints `equation`
    parts: list[RenderableType] = [
        Text(f"{name}: {plain_paragraph(text.title)}", style="bold"),
        Text(),
        _indented(text.equation),
    ]
    if body:
        parts += [Text(), *_prose(body)]
    parts += [*_heading("Parameters"), _parameters(text.parameters)]
    for line in text.raises:
        condition = plain_paragraph(line)
        parts.append(_indented(f"Refused {condition[:1].lower()}{condition[1:]}"))
    parts += _state(text)
    if text.end:
        end = _indented(f"{text.end} {text.tension}".strip())
        parts += [*_heading("End of the contact"), end]
    if text.departure:
        parts += [*_heading("Departure from the source"), _indented(text.departure)]
    if text.notes:
        parts += [*_heading("Notes"), *_prose(text.notes)]
    if issubclass(law, ContactLaw):
        parts += _achieved(law)
    parts += _heading("References")
    for reference in text.references or (text.source,):
        parts.append(_indented(plain_paragraph(reference)))
    return Group(*parts)


def _heading(phrase: str) -> list[RenderableType]:
    return [Text(), Text(phrase, style="bold")]


def _indented(phrase: str) -> RenderableType:
    return Padding(Text(phrase), (0, 0, 0, 2), expand=False)


def _prose(paragraphs: Iterable[str]) -> list[RenderableType]:
    lines = []
    for paragraph in paragraphs:
        margin = "  " if paragraph.startswith("..") else ""  # an equation
        lines.append(_indented(margin + plain_paragraph(paragraph)))
    return lines


def _parameters(parameters: Iterable[ParameterText], *, given: bool = True) -> RenderableType:
    """Return a table of names and meanings, each with its unit and, for parameters
    (`given`), range and default.
    """
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(no_wrap=True)
    for item in parameters:
        facts = [item.unit or "no unit"]
        if given:
            facts += [item.allowed or "any number", _left_out(item.default)]
        table.add_row(item.name, Text(plain_paragraph(item.meaning)))
        table.add_row("", Text("; ".join(facts), style="dim"))
    return Padding(table, (0, 0, 0, 2), expand=False)


def _left_out(default: str) -> str:
    if default.startswith(("required", "optional")):
        return default
    return f"if left out, {default}"


def _state(text: LawText) -> list[RenderableType]:
    if not text.state:
        return []
    return [
        *_heading("State, zero at first contact"),
        _parameters(text.state, given=False),
        _indented(text.persistence),
    ]


def _achieved(law: type[ContactLaw]) -> list[RenderableType]:
    pairs = asked_and_achieved(law)
    if not pairs:
        return []
    table = Table(box=None, padding=(0, 2, 0, 0), show_header=False, pad_edge=False)
    table.add_row("asked", *(f"{asked:g}" for asked, _ in pairs))
    table.add_row("achieved", *(f"{achieved:.3f}" for _, achieved in pairs))
    return [
        *_heading(f"Restitution, of the paper's sphere at {SPEED:g} m/s without gravity"),
        Padding(table, (0, 0, 0, 2), expand=False),
    ]
