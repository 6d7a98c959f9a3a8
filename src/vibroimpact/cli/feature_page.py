"""The table of features in docs/signals.md, which `make docs` writes again."""

from __future__ import annotations

import sys
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.report.markdown_table import markdown_table
from vibroimpact.signals.feature import Feature
from vibroimpact.signals.registry import signal_features

BEGIN = "<!-- features: begin (written by make docs) -->"
"""The line before the table."""

END = "<!-- features: end -->"
"""The line after the table."""


def feature_page(page: str) -> str:
    """Return the text of signals.md with its table as the registry has it.

    Raises
    ------
    InputError
        If a marker is missing.

    Examples
    --------
    >>> feature_page(f"Features:\\n{BEGIN}\\n{END}").splitlines()[4][:24]
    '| `peak` | x | largest m'
    """
    start, begin, table_and_end = page.partition(BEGIN)
    _, end, remainder = table_and_end.partition(END)
    if not begin or not end:
        raise InputError(f"signals.md: the lines {BEGIN} and {END} must stand around the table")
    rows = [_row(feature) for feature in signal_features().values()]
    table = markdown_table(("feature", "unit", "what", "equation", "source"), rows)
    return f"{start}{BEGIN}\n{table}\n{END}{remainder}"


def _row(feature: Feature) -> tuple[str, ...]:
    return (
        f"`{feature.name}`",
        feature.unit_for("x"),
        _cell(feature.meaning),
        f"`{_cell(feature.equation)}`",
        feature.source,
    )


def _cell(text: str) -> str:
    return text.replace("|", r"\|")


if __name__ == "__main__":
    path = Path(sys.argv[1]) / "signals.md"
    path.write_text(feature_page(path.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"wrote {path}")
