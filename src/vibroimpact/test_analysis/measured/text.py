"""What the modes command prints of measured modes."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.modes.measured_table import MeasuredTable
from vibroimpact.runs.text import doubt_lines
from vibroimpact.test_analysis.measured.document import measured_table
from vibroimpact.test_analysis.measured.modes_of_file import MeasuredModes
from vibroimpact.test_analysis.text import criteria_table


def measured_summary(found: MeasuredModes, name: str) -> RenderableType:
    """Return the measured modes and the doubts about them, for the terminal."""
    return Group(
        Text(name, style="bold"), criteria_table(*measured_table(found)), *doubt_lines(found.doubts)
    )


def compared_summary(found: MeasuredTable) -> RenderableType:
    """Return measured modes beside those of a case, and the doubts about them, for the terminal."""
    return Group(
        Text("\nmeasured modes", style="bold"),
        criteria_table(found.headers, found.cells),
        *doubt_lines(found.doubts),
    )
