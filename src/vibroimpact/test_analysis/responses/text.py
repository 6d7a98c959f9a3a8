"""What the correlate command prints of frequency responses."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from vibroimpact.runs.text import doubt_lines
from vibroimpact.test_analysis.document import mode_cells, octave_headers, octave_rows
from vibroimpact.test_analysis.mode_pairs import damping_field
from vibroimpact.test_analysis.responses.document import (
    RESPONSE_HEADERS,
    WHAT_FRAC_IS_OF,
    response_rows,
)
from vibroimpact.test_analysis.responses.result import ResponseCorrelation
from vibroimpact.test_analysis.text import criteria_table


def response_summary(found: ResponseCorrelation) -> RenderableType:
    """Return how frequency responses agree, the modes of both, the damping to be put into
    the case, and the doubts, for the terminal.
    """
    parts: list[RenderableType] = [
        Text(found.case.name or "a test", style="bold"),
        criteria_table(RESPONSE_HEADERS, response_rows(found)),
        Text(f"\nFRAC of {WHAT_FRAC_IS_OF}"),
        criteria_table(octave_headers(found), octave_rows(found)),
        Text("\nmodes"),
        criteria_table(*mode_cells(found.modes)),
    ]
    if damping := damping_field(found.modes):
        parts.append(Text(f"\nin [plate] of the case:\n{damping}"))
    return Group(*parts, *doubt_lines(found.doubts))
