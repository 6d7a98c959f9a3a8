"""What `cases` prints: the shipped cases."""

from __future__ import annotations

from typing import Any

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.cases.reader import load_table, shipped_cases
from vibroimpact.report.terminal_table import TerminalColumn, TerminalTable


def shipped_cases_table() -> RenderableType:
    """Return the table of the shipped cases: name, title, and the command that they are for."""
    cases = shipped_cases_document()["cases"]
    columns = (
        TerminalColumn("case", list(cases), text=True),
        TerminalColumn("what it is", [case["name"] for case in cases.values()], text=True),
        TerminalColumn("command", [case["command"] for case in cases.values()], text=True),
    )
    notes = 'Start a case of your own from one of them: "vibroimpact new NAME --from paper:type3".'
    return Group(TerminalTable(columns), Text(), Text(notes))


def shipped_cases_document() -> dict[str, Any]:
    """Return the shipped cases by name, each with its title and the command that it is for."""
    tables = {name: load_table(name) for name in shipped_cases()}
    cases = {
        name: {"name": case["name"], "command": command_for(case)} for name, case in tables.items()
    }
    return {"cases": cases}


DEEDS = {
    "run": "run it",
    "sweep": "run the study",
    "calibrate": "calibrate it",
    "dataset": "compute the data set",
}
"""What the command that a case is meant for does with it."""


def command_for(case: dict[str, Any]) -> str:
    """Return the command that a case is meant for: it has a section of its own in the case."""
    if "classes" in case.get("sweep", {}):
        return "dataset"
    for command in ("sweep", "calibrate"):
        if command in case:
            return command
    return "run"
