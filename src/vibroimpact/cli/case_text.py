"""Terminal output of `cases`: the shipped cases."""

from __future__ import annotations

import tomllib

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.cases.reader import case_text, shipped_cases
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable


def shipped_cases_table() -> RenderableType:
    """Return the table of the shipped cases: name, title, and the command that they are for."""
    titles = shipped_cases()
    columns = (
        TerminalColumn("case", list(titles), text=True),
        TerminalColumn("what it is", list(titles.values()), text=True),
        TerminalColumn("command", [_command(name) for name in titles], text=True),
    )
    notes = 'Start a case of your own from one of them: "vibroimpact new NAME --from paper:type3".'
    return Group(TerminalTable(columns), Text(), Text(notes))


def _command(name: str) -> str:
    """Return the command that a case is meant for: it has a section of its own in the case."""
    table = tomllib.loads(case_text(name))
    return "sweep" if "sweep" in table else "calibrate" if "calibrate" in table else "run"
