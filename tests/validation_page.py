"""Write docs/validation.md from the recorded comparisons of the tests: `python
tests/validation_page.py` (see `agreement.py`).
"""

from __future__ import annotations

import re
from itertools import groupby
from pathlib import Path
from typing import Any, get_args

from agreement import ROOT, TOLD, Kind, Subject, read

PAGE = ROOT / "docs" / "validation.md"
PROSE = Path(__file__).with_suffix(".md")
"""The text of the page, with placeholders for the generated tables."""
KINDS = {
    "closed form": "analytical solutions, published formulas and signals of known parameters, "
    "evaluated in the tests; benchmarks with a closed form",
    "published computation": "published numerical results without a closed form, printed or digitized "
    "from figures",
    "other program": "other programs and libraries, run for the same case, or their recorded "
    "results",
    "own independent computation": "integrations, series and finite elements by the same authors; some take "
    "formulas of contact laws, "
    "contact forces, modes or elements of the package",
    "consistency": "no external reference: limits, conservation laws, round trips, convergence, "
    "another method of the package",
    "fitted to published numbers": "published numbers to which an input of the case was fitted here: the fit "
    "meets them; no prediction",
    "experiment": "measurements; friction and restitution measured in the same series, nothing "
    "fitted to the compared values",
    "experiment, speed assumed": "measurements whose impact speeds are not stated; computed at one assumed "
    "speed",
    "fitted to measurements": "measurements to which the compared law or its coefficient was fitted, by "
    "its authors or here: no prediction",
}
MEASURED = ("experiment", "experiment, speed assumed", "fitted to measurements")
"""Kinds whose reference values were measured."""


def number(value: float) -> str:
    """Format a number without trailing zeros: 1e-8, 0.005, 12166."""
    return re.sub(
        r"e([+-])0*(\d)", lambda found: f"e{found[1].strip('+')}{found[2]}", f"{value:.6g}"
    )


def values(ends: list[float]) -> str:
    low, high = map(number, ends)
    return low if low == high else f"{low} to {high}"


def line(row: dict[str, Any]) -> str:
    count = f", {row['points']} values" if row["points"] > 1 else ""
    unit = "" if row["measure"] in ("relative", "of the largest", "rms") else row["unit"]
    measure = "" if row["measure"] == "absolute" else row["measure"]
    cells = (
        row["case"],
        f"{row['quantity']} [{row['unit']}]{count}" if row["unit"] else row["quantity"] + count,
        values(row["theirs"]),
        values(row["ours"]),
        f"≤ {number(row['deviation'])}",
        " ".join([number(row["tolerance"]), *unit.split(), *measure.split()]),
    )
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def block(rows: list[dict[str, Any]]) -> list[str]:
    """The section of one reference in one test file."""
    first = rows[0]
    table = [
        "| case | quantity | reference | vibroimpact | deviation | tolerance |",
        "|---|---|---|---|---|---|",
        *map(line, rows),
    ]
    about = f"{_capital(first['kind'])}: {first['source'].rstrip('.')}. Test: `{first['file']}`"
    return [f"### {_capital(first['opponent'])}", "", about, "", *table, ""]


def blocks(rows: list[dict[str, Any]], title: str) -> list[str]:
    if not rows:
        return []
    by = sorted(
        rows, key=lambda row: (get_args(Kind).index(row["kind"]), row["opponent"], row["file"])
    )
    made = [
        block(list(group))
        for _, group in groupby(by, key=lambda row: (row["opponent"], row["file"]))
    ]
    return [f"## {title}", "", *(one for part in made for one in part)]


def part(row: dict[str, Any]) -> float:
    """The deviation relative to the largest reference value, or 0 if that value is zero."""
    if row["measure"] not in ("absolute", "mean"):
        return float(row["deviation"])
    largest = max(map(abs, row["theirs"]))
    return row["deviation"] / largest if largest else 0.0


def summary(rows: list[dict[str, Any]]) -> list[str]:
    """For each kind: the numbers of references, comparisons and values, and the
    comparison with the largest deviation; see `part`.
    """
    table = [
        "| kind | description | references | comparisons | values | largest relative deviation |",
        "|---|---|---|---|---|---|",
    ]
    for kind, some in (
        (kind, [row for row in rows if row["kind"] == kind]) for kind in get_args(Kind)
    ):
        if some:
            worst = max(some, key=part)
            counts = (
                len({row["opponent"] for row in some}),
                len(some),
                sum(row["points"] for row in some),
            )
            told = f"{part(worst):.2g}: {worst['opponent']}; {worst['case']}; {worst['quantity']}"
            table.append(
                f"| {kind} | {KINDS[kind]} | "
                + " | ".join(f"{count:,}" for count in counts)
                + f" | {told} |"
            )
    return [*table, ""]


def measured(rows: list[dict[str, Any]]) -> list[str]:
    """A sentence on how many comparisons are with measured values, and of which kinds."""
    counts = {kind: sum(row["kind"] == kind for row in rows) for kind in MEASURED}
    kinds = ", ".join(f"{counts[kind]} *{kind}*" for kind in MEASURED)
    predicted = [row for row in rows if row["kind"] == MEASURED[0]]
    assert len({(*row["theirs"], row["points"], row["opponent"]) for row in predicted}) == 1, (
        "other values than those of one series"
    )
    return [
        f"Of these {len(rows):,} comparisons {sum(counts.values())} are with measured "
        f"values: {kinds}. Only the first kind tests a "
        f"prediction, in the same {predicted[0]['points']} measured values under "
        f"{len(predicted)} friction laws.",
        "",
    ]


def missing(rows: list[dict[str, Any]]) -> list[str]:
    """Test files without recorded comparisons."""
    found = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "tests" / "verification").glob("test_*.py")
    }
    left = sorted(found - {row["file"] for row in rows})
    return (
        [
            "* **Not run** when this page was generated: "
            f"{', '.join(f'`{file}`' for file in left)}.",
            "",
        ]
        if left
        else []
    )


def page(rows: list[dict[str, Any]]) -> str:
    """The complete page, from rows as `agreement.read` returns them."""
    experiments, computed = (
        [row for row in rows if (row["kind"] in MEASURED) == which] for which in (True, False)
    )
    tables = []
    for subject in get_args(Subject):
        tables += blocks([row for row in computed if row["subject"] == subject], _capital(subject))
    tables += blocks(experiments, "Experiments")
    made = {
        "summary": summary(rows),
        "measured": measured(rows),
        "comparisons": tables,
        "missing": missing(rows),
    }
    return re.sub(
        r"<!-- (\w+) -->\n",
        lambda place: "\n".join(made[place[1]]),
        PROSE.read_text(encoding="utf-8"),
    )


if __name__ == "__main__":
    PAGE.write_text(page(read(TOLD)), encoding="utf-8")
