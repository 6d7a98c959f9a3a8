"""The report of the reproduction, assembled from its parts: Markdown, HTML, and the table of verdicts on the terminal."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from markdown_it import MarkdownIt

from vibroimpact._version import __version__
from vibroimpact.charts.figures_folder import FIGURES
from vibroimpact.paper.printed import PAPER
from vibroimpact.paper.report.markdown import table
from vibroimpact.paper.report.outline import CHAPTERS, PARTS
from vibroimpact.paper.report_section import Verdict
from vibroimpact.report.page import render_drawn_page
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable

TITLE = "The paper, reproduced"


def report_text(parts: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the report as Markdown.

    Parameters
    ----------
    parts : mapping of str to mapping
        The available parts by name, each with "title", "text" and "rows".
    """
    missing = [name for name in PARTS if name not in parts]
    chapters = {chapter: [part.name for part in members if part.name in parts] for chapter, members in CHAPTERS.items()}
    pieces = [f"# {TITLE}\n", *(f"{words}\n" for words in (*_OPENING, *(() if missing else _IN_SHORT)))]
    pieces += [f"- [{chapter}](#{_anchor(chapter)})" for chapter, available in chapters.items() if available]
    pieces += ["", *_summary(parts)]
    for chapter, available in chapters.items():
        pieces += [f"## {chapter}\n", *(str(parts[name]["text"]) for name in available)] if available else []
    if missing:
        pieces.append(f"Not made yet: {', '.join(missing)}. `vibroimpact reproduce -o DIR` makes them.\n")
    pieces.append(f"Made by vibroimpact {__version__}: `vibroimpact reproduce`.\n")
    return "\n".join(pieces)


def _anchor(heading: str) -> str:
    """Return the anchor of a heading, formed as on GitHub."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


_OPENING = (
    f"Each number of {PAPER}, compared with the computed one, and each of its figures that shows a result, drawn from the computation "
    "(figures 1 and 2 are sketches of its notation). A rock sphere falls from 4 m onto a steel plate and bounces: both rigid (Type 1), "
    "the sphere elastic (Type 2), both elastic (Type 3).",
    "A value counts as reproduced if it agrees within half a unit of the last digit printed. It counts as explained if a falsifiable "
    "hypothesis gives a range that contains the printed value; as fitted if the model was fitted to it, so that the agreement is no "
    "evidence; otherwise as not reproduced. The drop height and the full-damping penetration, printed with one digit, are taken as "
    "exact. The two values of Type 1 that are not printed, or misprinted, were estimated jointly from several numbers and then rounded; "
    "values that follow from them still count as reproduced. The verdicts are computed. Rows are counted: a value that is computed in "
    "three ways has three rows.",
)

_IN_SHORT = (
    "Summary, in the interpretation of the authors of this package: the results of the paper for rigid bodies (Type 1) are reproduced or "
    "explained except for two misprints, with the restitution and the full-damping penetration that its own numbers imply; Table 2 is "
    "consistent with peaks read from samples. The results printed for elastic bodies (Types 2 and 3) are not reproduced by any setting "
    "that was tried, neither with a consistent model nor with the superposed one of multibody programs. An unresolved run is a "
    "hypothesis: it approximates force, rebound and strain energy of the sphere, but not its fall beyond touch, the order of the forces, "
    "or the energies of the plate.",
)


def verdict_counts(parts: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, int]]:
    """Return the number of rows with each verdict, by part and for "all"; an empty dict if no part has rows."""
    found = {name: [row["verdict"] for row in part["rows"]] for name, part in parts.items() if part["rows"]}
    if found:
        found["all"] = [verdict for verdicts in list(found.values()) for verdict in verdicts]
    return {name: {verdict.value: verdicts.count(verdict.value) for verdict in Verdict} for name, verdicts in found.items()}


def _summary(parts: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Return the table of verdicts as Markdown, in a list that is empty if no part has rows."""
    found = verdict_counts(parts)
    if not found:
        return []
    cells = [(str(parts[name]["title"]) if name in parts else "All", *map(str, by.values())) for name, by in found.items()]
    return [table(("Part", *(verdict.value.capitalize() for verdict in Verdict)), cells) + "\n"]


_IMAGE = re.compile(rf'<p><img src="{FIGURES}/(?P<name>[^"]+)\.png" alt="(?P<title>[^"]*)" /></p>\n<p>.*?</p>\n', re.S)
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
    body = re.sub(r"<table>(.*?)</table>", r'<div class="wide"><table class="words">\1</table></div>', body, flags=re.S)
    body = re.sub(r"<h2>(.*?)</h2>", lambda found: f'<h2 id="{_anchor(found[1])}">{found[1]}</h2>', body)
    for verdict in Verdict:
        body = re.sub(rf"<td>({verdict.value}(?:[:,][^<]*)?)</td>", rf'<td class="{verdict.name.lower()}">\1</td>', body)
    opening, chapters, rest = body.partition("<h2")
    pieces, done = [], 0
    for image in _IMAGE.finditer(chapters + rest):
        # a chart has its title and caption itself
        before = (chapters + rest)[done : image.start()].removesuffix(f"<h3>{image['title']}</h3>\n")
        pieces.append((before, image["name"]))
        done = image.end()
    pieces.append(((chapters + rest)[done:], ""))
    return render_drawn_page(__package__, charts, name=TITLE, opening=opening, pieces=pieces)


def verdict_table(parts: Mapping[str, Mapping[str, Any]]) -> TerminalTable:
    """Return the number of values with each verdict, by part."""
    by_part = verdict_counts(parts)
    verdicts = [
        TerminalColumn(verdict.value.replace(" ", "\u00a0"), [str(by[verdict.value]) for by in by_part.values()]) for verdict in Verdict
    ]
    return TerminalTable([TerminalColumn("part", list(by_part), text=True), *verdicts], bold=[len(by_part) - 1])
