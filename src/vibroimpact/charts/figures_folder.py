"""The folder `figures` of a result folder, with its charts as files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vibroimpact.charts.chart import Chart

FIGURES = "figures"
"""Name of the folder of the charts as files, inside a result folder."""


def write_figures(charts: Sequence[Chart], folder: Path, formats: Sequence[str]) -> None:
    """Write charts as files into a new folder `figures` of an existing folder; nothing if there are
    no formats.

    Parameters
    ----------
    charts : sequence of Chart
        The charts.
    folder : pathlib.Path
        The existing folder.
    formats : sequence of str
        Of "png", "svg" and "pdf".
    """
    if not formats:
        return
    from vibroimpact.charts.files import save_charts  # here, as it imports matplotlib

    (folder / FIGURES).mkdir()
    save_charts(charts, folder / FIGURES, formats)
