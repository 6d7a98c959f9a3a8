"""The panels of a chart of a study in rows."""

from __future__ import annotations

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Panel

HEIGHT = 2.3
"""Height of a row of panels [in]."""


def in_rows(panels: list[Panel]) -> tuple[tuple[Panel, ...], ...]:
    """Return panels in rows of two; the last one has an empty panel beside it if it would
    be alone, but for a single one.
    """
    if len(panels) > 1 and len(panels) % 2:
        panels = [*panels, Panel(Axis(), Axis(), (), picture=True)]
    return tuple(tuple(panels[first : first + 2]) for first in range(0, len(panels), 2))
