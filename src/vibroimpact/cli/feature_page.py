"""The table of features in docs/signals.md: `make docs` writes it again, and a test finds
it stale.
"""

from __future__ import annotations

import sys
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.report.markdown_table import markdown_table
from vibroimpact.signals.registry import signal_features

BEGIN, END = "<!-- features: begin (written by make docs) -->", "<!-- features: end -->"
"""The marker lines before and after the table."""


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
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise InputError(f"signals.md: the lines {BEGIN} and {END} must stand around the table")
    rows = (
        (
            f"`{one.name}`",
            one.unit_for("x"),
            _cell(one.meaning),
            f"`{_cell(one.equation)}`",
            one.source,
        )
        for one in signal_features().values()
    )
    table = markdown_table(("feature", "unit", "what", "equation", "source"), rows)
    return f"{before}{BEGIN}\n{table}\n{END}{after}"


def _cell(text: str) -> str:
    return text.replace("|", r"\|")


if __name__ == "__main__":
    place = Path(sys.argv[1]) / "signals.md"
    place.write_text(feature_page(place.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"wrote {place}")
