"""Writes the modes of measured frequency responses as a folder: tables, the summary and a
report.
"""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Mark, Rug
from vibroimpact.quoting import shortened, visible
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import new_folder, write_summary
from vibroimpact.test_analysis.charts import MOST, magnitude_lines, those_drawn
from vibroimpact.test_analysis.document import TEXTS
from vibroimpact.test_analysis.measured.document import (
    MEASURED_COLUMNS,
    measured_records,
    measured_table,
    summary_of_measured,
)
from vibroimpact.test_analysis.measured.modes_of_file import MeasuredModes


def save_measured_modes(
    found: MeasuredModes,
    name: str,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write the modes of measured frequency responses atomically: `modes.csv`, `summary.json` and a
    report.

    Parameters
    ----------
    found : MeasuredModes
        The modes.
    name : str
        What was measured.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing folder.
    figures : sequence of str
        Formats in which the charts are also written as files, into a folder `figures`: of "png",
        "svg" and "pdf".

    Raises
    ------
    InputError
        If the folder exists and may not be replaced, or it can't be written to.
    """
    with new_folder(directory, force=force) as folder:
        write_csv(measured_records(found), list(MEASURED_COLUMNS), folder / "modes.csv")
        write_summary(summary_of_measured(found), folder)
        charts = made_charts({"responses": lambda: _chart(found)})
        write_figures(charts, folder, figures)
        headers, rows = measured_table(found)
        page = render_page(
            __package__,
            charts,
            name=name,
            headers=headers,
            modes=rows,
            texts=TEXTS,
            sources=list(dict.fromkeys(visible(one.source) for one in found.responses)),
            doubts=found.doubts,
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)


def _chart(found: MeasuredModes) -> Chart:
    axis = Axis("Frequency", "Hz", range=(float(found.frequency[0]), float(found.frequency[-1])))
    places = np.array(
        [pair.measured.frequency.value for pair in found.modes if pair.measured is not None]
    )
    rows = []
    for one, value in zip(found.responses[:MOST], found.value, strict=False):
        lines, shown = magnitude_lines(found.frequency, (value,), (("measured", "main"),))
        scale = Axis("Magnitude", one.unit, log=True, range=shown)
        marks: tuple[Mark, ...] = (*lines, Rug(places, "measured modes"))
        rows.append((Panel(axis, scale, marks, shortened(visible(one.name), 40)),))
    caption = (
        "Measured frequency responses. Ticks mark the modes that were "
        f"found.{those_drawn(len(found.responses))}"
    )
    return Chart("responses", "Frequency responses", tuple(rows), caption)
