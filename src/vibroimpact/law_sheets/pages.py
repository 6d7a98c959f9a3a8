"""Documentation of the contact laws in markdown: one page per law, and the table of laws
with links to them.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from os import PathLike
from pathlib import Path

from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.registry import contact_laws
from vibroimpact.errors import InputError
from vibroimpact.law_sheets.text import (
    SPEED,
    ParameterText,
    asked_and_achieved,
    law_text,
    short_sources,
)
from vibroimpact.report.markdown_table import markdown_table

BEGIN = "<!-- laws: begin (written by make docs) -->"
END = "<!-- laws: end -->"
"""The marker lines before and after the table in laws.md."""

_ENDS = {
    "zero-indentation": "at zero indentation",
    "zero-force": "at zero force",
    "pull-off": "at pull-off",
}
_TENSION = {"none": "never", "cut": "cut at zero", "kept": "before the end"}


def law_pages(laws_page: str) -> dict[str, str]:
    """Return the documentation of this package's contact laws by file name, relative to the
    documentation folder.

    Parameters
    ----------
    laws_page : str
        The present text of laws.md; the table between its two markers is replaced.

    Raises
    ------
    InputError
        If a marker is missing.

    Examples
    --------
    >>> pages = law_pages(BEGIN + END)
    >>> pages["laws/hertz.md"].splitlines()[0]
    '# `hertz`'
    """
    before, begin, rest = laws_page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise InputError(f"laws.md: the lines {BEGIN} and {END} must stand around the table")
    laws = [law for law in contact_laws().values() if law.__module__.startswith("vibroimpact.")]
    pages = {f"laws/{law.name}.md": law_page(law) for law in laws}
    return {"laws.md": f"{before}{BEGIN}\n{_table_of(laws)}\n{END}{after}", **pages}


def law_page(law: type[ContactLaw]) -> str:
    """Return the documentation page of a contact law in GitHub markdown."""
    text = law_text(law)
    parts = [
        f"# `{law.name}`",
        text.title,
        f"```text\n{text.equation}\n```",
        *map(_marked, text.body),
        "## Parameters",
        _table(
            ("parameter", "meaning", "unit", "allowed", "if left out"), map(_row, text.parameters)
        ),
        *(f"Refused {_marked(line)[:1].lower()}{_marked(line)[1:]}" for line in text.raises),
    ]
    if text.state:
        rows = ((f"`{item.name}`", _cell(item.meaning), item.unit or "-") for item in text.state)
        parts += [
            "## State",
            "Zero at first contact.",
            _table(("state", "meaning", "unit"), rows),
            text.persistence,
        ]
    parts += ["## End of the contact", f"{text.end} {text.tension}".strip()]
    if text.departure:
        parts += ["## Departure from the source", text.departure]
    if text.notes:
        parts += ["## Notes", *map(_marked, text.notes)]
    pairs = asked_and_achieved(law)
    if pairs:
        parts += [
            "## Restitution",
            "Asked for and achieved, of the paper's rock sphere on its steel plate at "
            f"{SPEED:g} m/s, without gravity:",
            _table(
                ("asked", *(f"{asked:g}" for asked, _ in pairs)),
                [("achieved", *(f"{achieved:.3f}" for _, achieved in pairs))],
            ),
        ]
    parts += ["## Curves", f"```console\n$ vibroimpact laws {law.name} -o {law.name}.png\n```"]
    parts += ["draws the curves of the law with typical parameters."]
    parts += [
        "## References",
        "\n".join(f"- {_marked(reference)}" for reference in text.references or (text.source,)),
    ]
    parts += ["[All contact laws](../laws.md)"]
    return "\n\n".join(parts) + "\n"


def write_law_pages(docs_dir: str | PathLike[str]) -> list[Path]:
    """Write the pages of the contact laws and the table in laws.md into the documentation folder.

    Parameters
    ----------
    docs_dir : path
        The folder that holds laws.md.

    Returns
    -------
    list of pathlib.Path
        The files written.
    """
    folder = Path(docs_dir)
    pages = law_pages((folder / "laws.md").read_text(encoding="utf-8"))
    (folder / "laws").mkdir(exist_ok=True)
    for name, page in pages.items():
        (folder / name).write_text(page, encoding="utf-8")
    return [folder / name for name in pages]


def _table_of(laws: Iterable[type[ContactLaw]]) -> str:
    rows = []
    for law in laws:
        end = "instantaneous"
        tension = ""
        if issubclass(law, CompliantLaw):
            end = _ENDS[law.contact_end]
            tension = _TENSION[law.tension]
        equation = law.equation.replace("|", r"\|")  # which would end a cell of the table
        source = short_sources(law)
        if law.departure:
            source += "; changed"
        rows.append((f"[`{law.name}`](laws/{law.name}.md)", f"`{equation}`", end, tension, source))
    return _table(("law", "force, or restitution", "contact ends", "tensile force", "source"), rows)


def _row(item: ParameterText) -> tuple[str, ...]:
    return (
        f"`{item.name}`",
        _cell(item.meaning),
        item.unit or "-",
        item.allowed or "any number",
        item.default,
    )


def _table(heading: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    return markdown_table(heading, rows).replace("|  |", "| |")


def _cell(text: str) -> str:
    return _marked(text).replace("|", r"\|")


def _marked(paragraph: str) -> str:
    """Return a paragraph of a docstring with its formulas in GitHub markdown."""
    if paragraph.startswith(".. math::"):
        return f"```math\n{paragraph.removeprefix('.. math::').strip()}\n```"
    return re.sub(r":math:`([^`]*)`", r"$`\1`$", paragraph)


if __name__ == "__main__":
    for path in write_law_pages(sys.argv[1]):
        print(f"wrote {path}")
