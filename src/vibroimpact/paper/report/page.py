"""The report of the reproduction, assembled from its parts: Markdown, HTML, and the table
of verdicts on the terminal.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from markdown_it import MarkdownIt
from rich.console import Group
from rich.text import Text

from vibroimpact._version import __version__
from vibroimpact.charts.chart import stored_chart
from vibroimpact.charts.figures_folder import FIGURES
from vibroimpact.paper.printed import PAPER
from vibroimpact.paper.report.markdown import table
from vibroimpact.paper.report.outline import CHAPTERS, PARTS
from vibroimpact.paper.report_section import Kind, Verdict
from vibroimpact.report.page import render_page
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable
from vibroimpact.units.display import digits

TITLE = "The paper, reproduced"


def report_text(parts: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the report as Markdown.

    Parameters
    ----------
    parts : mapping of str to mapping
        The available parts by name, each with "title", "text" and "rows".
    """
    missing = [name for name in PARTS if name not in parts]
    chapters = {
        chapter: [part.name for part in members if part.name in parts]
        for chapter, members in CHAPTERS.items()
    }
    pieces = [
        f"# {TITLE}\n",
        *(f"{words}\n" for words in (*_OPENING, *(() if missing else _IN_SHORT))),
    ]
    pieces += [
        f"- [{chapter}](#{_anchor(chapter)})"
        for chapter, available in chapters.items()
        if available
    ]
    pieces += ["", *_summary(parts)]
    for chapter, available in chapters.items():
        pieces += (
            [f"## {chapter}\n", *(str(parts[name]["text"]) for name in available)]
            if available
            else []
        )
    if missing:
        pieces.append(
            f"Not made yet: {', '.join(missing)}. `vibroimpact reproduce -o DIR` makes them.\n"
        )
    pieces.append(f"Made by vibroimpact {__version__}: `vibroimpact reproduce`.\n")
    return "\n".join(pieces)


def _anchor(heading: str) -> str:
    """Return the anchor of a heading, formed as on GitHub."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


_OPENING = (
    f"The numbers that {PAPER} prints, compared with computed ones, and its figures 3 to "
    "23, drawn from the computation. A rock sphere "
    "falls from 4 m onto a steel plate and bounces: both rigid (Type 1), the sphere elastic "
    "(Type 2), both elastic (Type 3).",
    "A value counts as reproduced if it agrees within half a unit of the last digit "
    "printed, or keeps a printed bound. It counts as "
    "explained if a hypothesis gives a value or a range with which it agrees within its "
    "digits; as fitted if the model was fitted to it, "
    "so that the agreement is no evidence; otherwise as not reproduced. The drop height and "
    "the full-damping penetration, printed with "
    "one digit, are taken as exact. The verdicts are computed. Rows are counted: a value "
    "that is computed in three ways has three rows.",
    "What a verdict shows depends on the kind of the comparison, which is counted apart:",
    "- result: computed from the inputs of the paper, and from what was assumed or inferred "
    "from other printed numbers; the printed value itself was not used.\n"
    "- inferred: the restitution of the theory is not printed, and the full-damping "
    "penetration is taken for a misprint. Both were "
    "inferred from printed numbers of this kind and then rounded. That these agree shows "
    "that two values are compatible with all of them; "
    "none of them by itself is evidence.\n"
    "- fitted model: computed by a model with parameters that were fitted to printed "
    "results of Type 2, the fitted ones and the others.\n"
    "- arithmetic: calculated from other printed results, without a simulation; it compares "
    "the paper with itself.\n"
    "- input: what the paper assumes, compared with the shipped case.",
)

_IN_SHORT = (
    "Summary, in the interpretation of the authors of this package. Of the results printed "
    "for rigid bodies (Type 1), the contact "
    "stiffness follows from the inputs to all digits. One height, two percentages, the "
    "dampings and their function are compatible "
    "with one restitution and one full-damping penetration, which were inferred from them. "
    "Force and acceleration are not met: the "
    "computed ones are 1.3 % larger. Table 2 is not met either; it is compatible with peaks "
    "read from samples, by ranges 3.9 to 12.4 "
    "percentage points wide. The results printed for elastic bodies (Types 2 and 3) are not "
    "reproduced by any setting that was tried, "
    "neither with a consistent model nor with the superposed one of multibody programs; the "
    "results that are reproduced are bounds, or "
    "printed with one digit. An unresolved run is a hypothesis: it approximates force, "
    "rebound and strain energy of the sphere, but not "
    "its fall beyond touch, the order of the forces, or the energies of the plate.",
)


def verdict_counts(parts: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, int]]:
    """Return the number of rows with each verdict, by part and for "all"; an empty dict
    if no part has rows.
    """
    found = {
        name: [row["verdict"] for row in part["rows"]]
        for name, part in parts.items()
        if part["rows"]
    }
    if found:
        found["all"] = [verdict for verdicts in list(found.values()) for verdict in verdicts]
    return {
        name: {verdict.value: verdicts.count(verdict.value) for verdict in Verdict}
        for name, verdicts in found.items()
    }


def kind_counts(parts: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, int]]:
    """Return the number of rows with each verdict, by the kind of the comparison; an
    empty dict if no part has rows.
    """
    found = [(row["kind"], row["verdict"]) for part in parts.values() for row in part["rows"]]
    counts = {
        kind.value: {verdict.value: found.count((kind.value, verdict.value)) for verdict in Verdict}
        for kind in Kind
    }
    return counts if found else {}


class RangeWidths(NamedTuple):
    """The widths of the ranges that explain the printed values of a part.

    Parameters
    ----------
    number : int
        Number of explained values.
    least, most : float
        Smallest and largest width, relative to the printed value.
    """

    number: int
    least: float
    most: float


def range_widths(parts: Mapping[str, Mapping[str, Any]]) -> dict[str, RangeWidths]:
    """Return the widths of the ranges by which values are explained, by part; only parts
    with explained values.
    """
    found = {}
    for name, part in parts.items():
        explained = [row for row in part["rows"] if row["verdict"] == Verdict.EXPLAINED.value]
        widths = [
            (row["range_high"] - row["range_low"]) / abs(float(row["printed"])) for row in explained
        ]
        if widths:
            found[name] = RangeWidths(len(widths), min(widths), max(widths))
    return found


def _summary(parts: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Return the tables of verdicts by kind and by part and that of the ranges as
    Markdown, in a list that is empty without rows.
    """
    by_part = verdict_counts(parts)
    if not by_part:
        return []
    verdicts = [verdict.value.capitalize() for verdict in Verdict]
    kinds = [(kind.capitalize(), *map(str, by.values())) for kind, by in kind_counts(parts).items()]
    cells = [
        (str(parts[name]["title"]) if name in parts else "All", *map(str, by.values()))
        for name, by in by_part.items()
    ]
    pieces = [table(("Kind", *verdicts), kinds), table(("Part", *verdicts), cells)]
    widths = [
        (
            str(parts[name]["title"]),
            str(found.number),
            *(f"{digits(100.0 * width, 2)} %" for width in (found.least, found.most)),
        )
        for name, found in range_widths(parts).items()
    ]
    if widths:
        headers = (
            "Part",
            "Explained",
            "Narrowest range, of the printed value",
            "Widest range, of the printed value",
        )
        pieces += [
            "How wide the ranges are that explain a value: the wider, the less an "
            "explanation shows.",
            table(headers, widths),
        ]
    return [f"{piece}\n" for piece in pieces]


_IMAGE = re.compile(
    rf'<p><img src="{FIGURES}/(?P<name>[^"]+)\.png" alt="(?P<title>[^"]*)" /></p>\n<p>.*?</p>\n',
    re.S,
)
"""An image with its caption, as they are in HTML."""


def report_html(text: str, charts: Sequence[dict[str, Any]]) -> str:
    """Return the report as a self-contained HTML page whose charts can be explored.

    Parameters
    ----------
    text : str
        The report as Markdown.
    charts : sequence of dict
        The charts in the place of its images, as `plotly_chart` returns them.
    """
    body = MarkdownIt("commonmark", {"html": False}).enable("table").render(text)
    # tables can scroll, headings get anchors, and verdicts get classes for their colours
    body = re.sub(
        r"<table>(.*?)</table>",
        r'<div class="wide"><table class="words">\1</table></div>',
        body,
        flags=re.S,
    )
    body = re.sub(
        r"<h2>(.*?)</h2>", lambda found: f'<h2 id="{_anchor(found[1])}">{found[1]}</h2>', body
    )
    for verdict in Verdict:
        body = re.sub(
            rf"<td>({verdict.value}(?:[:,][^<]*)?)</td>",
            rf'<td class="{verdict.name.lower()}">\1</td>',
            body,
        )
    opening, chapters, rest = body.partition("<h2")
    pieces, done = [], 0
    for image in _IMAGE.finditer(chapters + rest):
        # a chart has its title and caption itself
        before = (chapters + rest)[done : image.start()].removesuffix(
            f"<h3>{image['title']}</h3>\n"
        )
        pieces.append((before, image["name"]))
        done = image.end()
    pieces.append(((chapters + rest)[done:], ""))
    stored = [stored_chart(chart) for chart in charts]
    return render_page(__package__, stored, name=TITLE, opening=opening, pieces=pieces)


def kind_summary(parts: Mapping[str, Mapping[str, Any]]) -> Group:
    """Return the number of values with each verdict, by the kind of the comparison, and
    what the kinds are.
    """
    by_kind = kind_counts(parts)
    counts = TerminalTable(
        [TerminalColumn("kind", list(by_kind), text=True), *_verdict_columns(by_kind)]
    )
    return Group(Text(), counts, Text(), Text(_KINDS_IN_SHORT))


_KINDS_IN_SHORT = (
    " Only a result tests the paper. Inferred: restitution, full-damping penetration, and "
    "the printed values they were inferred from. "
    "Fitted model: fitted to printed results of Type 2. Arithmetic: from other printed "
    "results. Input: what the paper assumes."
)


def verdict_table(parts: Mapping[str, Mapping[str, Any]]) -> TerminalTable:
    """Return the number of values with each verdict, by part."""
    by_part = verdict_counts(parts)
    return TerminalTable(
        [TerminalColumn("part", list(by_part), text=True), *_verdict_columns(by_part)],
        bold=[len(by_part) - 1],
    )


def _verdict_columns(counts: Mapping[str, Mapping[str, int]]) -> list[TerminalColumn]:
    """Return a column for each verdict, with the numbers of the rows of a table."""
    return [
        TerminalColumn(
            verdict.value.replace(" ", "\u00a0"), [str(by[verdict.value]) for by in counts.values()]
        )
        for verdict in Verdict
    ]
