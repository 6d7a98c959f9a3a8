"""Write docs/validation.md from what tests recorded: `python tests/validation_page.py` (see `agreement.py`)."""

from __future__ import annotations

import re
from itertools import groupby
from pathlib import Path
from typing import Any, get_args

from agreement import ROOT, TOLD, Kind, Subject, read

PAGE = ROOT / "docs" / "validation.md"
PROSE = Path(__file__).with_suffix(".md")
"""What the page says in words, with places for what is made."""
KINDS = {
    "closed form": "formulas of theory",
    "published computation": "numbers that others printed, or points of their figures",
    "other program": "programs, run beside this one",
    "own independent computation": "integrations, series and finite elements that share nothing with the package but NumPy and SciPy",
    "consistency": "no opponent: limits, conservation laws, round trips, convergence, another way through the package",
    "experiment": "measurements",
}


def number(value: float) -> str:
    """A number without needless zeros: 1e-8, 0.005, 12166."""
    return re.sub(r"e([+-])0*(\d)", lambda found: f"e{found[1].strip('+')}{found[2]}", f"{value:.6g}")


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
    """One opponent of one file of tests."""
    first = rows[0]
    table = ["| case | quantity | theirs | ours | deviation | tolerance |", "|---|---|---|---|---|---|", *map(line, rows)]
    about = f"{_capital(first['kind'])}. {first['source'].rstrip('.')}. `{first['file']}`"
    return [f"### {_capital(first['opponent'])}", "", about, "", *table, ""]


def blocks(rows: list[dict[str, Any]], title: str) -> list[str]:
    if not rows:
        return []
    by = sorted(rows, key=lambda row: (get_args(Kind).index(row["kind"]), row["opponent"], row["file"]))
    made = [block(list(group)) for _, group in groupby(by, key=lambda row: (row["opponent"], row["file"]))]
    return [f"## {title}", "", *(one for part in made for one in part)]


def part(row: dict[str, Any]) -> float:
    """The deviation as a part of what is compared, or 0 where that is nothing."""
    if row["measure"] not in ("absolute", "mean"):
        return float(row["deviation"])
    largest = max(map(abs, row["theirs"]))
    return row["deviation"] / largest if largest else 0.0


def summary(rows: list[dict[str, Any]]) -> list[str]:
    """Of each kind of opponent how many there are, of how many comparisons and values, and where the results are off most."""
    table = ["| kind | what it is | opponents | comparisons | values | worst deviation, as a part |", "|---|---|---|---|---|---|"]
    for kind, some in ((kind, [row for row in rows if row["kind"] == kind]) for kind in get_args(Kind)):
        if some:
            worst = max(some, key=part)
            counts = len({row["opponent"] for row in some}), len(some), sum(row["points"] for row in some)
            told = f"{part(worst):.1g}: {worst['opponent']}; {worst['case']}; {worst['quantity']}"
            table.append(f"| {kind} | {KINDS[kind]} | " + " | ".join(f"{count:,}" for count in counts) + f" | {told} |")
    return [*table, ""]


def missing(rows: list[dict[str, Any]]) -> list[str]:
    """Files of comparisons that were not run."""
    found = {path.relative_to(ROOT).as_posix() for path in (ROOT / "tests" / "verification").glob("test_*.py")}
    left = sorted(found - {row["file"] for row in rows})
    return [f"* Not run when this page was made: {', '.join(f'`{file}`' for file in left)}.", ""] if left else []


def page(rows: list[dict[str, Any]]) -> str:
    """The whole page, of rows as `agreement.read` has them."""
    measured, computed = ([row for row in rows if (row["kind"] == "experiment") == which] for which in (True, False))
    tables = []
    for subject in get_args(Subject):
        tables += blocks([row for row in computed if row["subject"] == subject], _capital(subject))
    tables += blocks(measured, "Experiments")
    made = {"summary": summary(rows), "comparisons": tables, "missing": missing(rows)}
    return re.sub(r"<!-- (\w+) -->\n", lambda place: "\n".join(made[place[1]]), PROSE.read_text(encoding="utf-8"))


if __name__ == "__main__":
    PAGE.write_text(page(read(TOLD)), encoding="utf-8")
