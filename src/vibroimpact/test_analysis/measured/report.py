"""What measured frequency responses tell: the modes that were fitted to them."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Mark, Rug
from vibroimpact.modes.tables import MeasuredTable
from vibroimpact.quoting import shortened, visible
from vibroimpact.report.report import Explanation, Quantity, Report, Section, Table, table_of
from vibroimpact.results.csv_files import write_csv
from vibroimpact.test_analysis.charts import MOST, magnitude_lines, those_drawn
from vibroimpact.test_analysis.criteria_tables import (
    MODE_COLUMNS,
    MODE_HEADERS,
    TEXTS,
    answer_of_modes,
    mode_cells,
    mode_record,
    mode_row,
    without_blank_remarks,
)
from vibroimpact.test_analysis.measured.modes_of_file import MeasuredModes

_MEASURED = (
    "frequency_Hz",
    "frequency_low_Hz",
    "frequency_high_Hz",
    "damping_ratio",
    "damping_ratio_low",
    "damping_ratio_high",
)
MEASURED_COLUMNS = ("mode", *_MEASURED, "remark")
"""Columns of `modes.csv` of a measured file."""
_OF_MEASURED = (
    "Mode",
    "Measured, Hz",
    "95 % ±",
    "Measured damping ratio",
    "95 % from",
    "to",
    "Remark",
)


def report_of(measured: MeasuredModes) -> Report:
    """Return the report of the modes in measured frequency responses."""
    sources = list(dict.fromkeys(visible(response.source) for response in measured.responses))
    modes = Section(
        "modes",
        "Modes",
        (
            measured_table(measured),
            Explanation(
                "Frequencies and damping ratios are those of a sum of modes fitted to all "
                "responses together; the intervals include noise alone."
            ),
        ),
    )
    return Report(
        title=f"Measured modes of {Path(sources[0]).stem}",
        quantities=_answer(measured),
        sections=(modes,),
        charts=made_charts({"responses": partial(_chart, measured)}),
        warnings=measured.doubts,
        files={"modes.csv": partial(_write_modes, measured)},
        summary=_summary(measured),
        provenance=f"the frequency responses are those of {', '.join(sources)}.",
    )


def _answer(measured: MeasuredModes) -> list[Quantity]:
    """Return how many modes were measured, and the range of their frequencies and damping."""
    modes = [pair.measured for pair in measured.modes if pair.measured is not None]
    low, high = (float(measured.frequency[end]) for end in (0, -1))
    note = f"from {low:.4g} to {high:.4g} Hz, of {len(measured.responses)} responses"
    quantities = [Quantity("Modes", len(modes), note=note)]
    frequencies = [mode.frequency.value for mode in modes]
    # of a mode that is not separated the damping is not known
    ratios = [mode.damping_ratio.value for mode in modes if not mode.doubt]
    for name, values, unit in (
        ("Frequencies", frequencies, "Hz"),
        ("Damping ratios", ratios, ""),
    ):
        if values:
            note = f"of {len(values)} modes"
            quantities.append(Quantity(name, min(values), unit, note=note, largest=max(values)))
    return quantities


def measured_table(measured: MeasuredModes) -> Table:
    """Return the table of measured modes alone, numbered by their frequencies."""
    rows = []
    for number, pair in enumerate(measured.modes, start=1):
        cells = dict(zip(MODE_HEADERS, mode_row(pair), strict=True)) | {"Mode": str(number)}
        rows.append([cells[heading] for heading in _OF_MEASURED])
    return table_of(*without_blank_remarks(_OF_MEASURED, rows), TEXTS)


def measured_records(measured: MeasuredModes) -> list[dict[str, Any]]:
    """Return the measured modes alone as rows of `MEASURED_COLUMNS`."""
    return [
        {
            name: value
            for name, value in (mode_record(pair) | {"mode": number}).items()
            if name in MEASURED_COLUMNS
        }
        for number, pair in enumerate(measured.modes, start=1)
    ]


def compared_table(measured: MeasuredModes) -> MeasuredTable:
    """Return the modes of a case and measured ones as the folder of the case's modes has them."""
    table = table_of(*mode_cells(measured.modes), TEXTS)
    rows = [mode_record(pair) for pair in measured.modes]
    quantities = list(answer_of_modes(measured.modes))
    return MeasuredTable(table, MODE_COLUMNS, rows, measured.doubts, quantities)


def _write_modes(measured: MeasuredModes, path: Path) -> None:
    """Write the measured modes."""
    write_csv(measured_records(measured), list(MEASURED_COLUMNS), path)


def _summary(measured: MeasuredModes) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    return {
        "version": __version__,
        "band_Hz": [float(measured.frequency[0]), float(measured.frequency[-1])],
        "responses": [
            {
                "response": response.name,
                "reference": response.reference.name,
                "unit": response.unit or None,
                "source": response.source,
            }
            for response in measured.responses
        ],
        "modes": measured_records(measured),
        "doubts": list(measured.doubts),
    }


def _chart(measured: MeasuredModes) -> Chart:
    axis = Axis(
        "Frequency", "Hz", range=(float(measured.frequency[0]), float(measured.frequency[-1]))
    )
    places = np.array(
        [pair.measured.frequency.value for pair in measured.modes if pair.measured is not None]
    )
    rows = []
    for response, value in zip(measured.responses[:MOST], measured.value, strict=False):
        lines, shown = magnitude_lines(measured.frequency, (value,), (("measured", "measured"),))
        scale = Axis("Magnitude", response.unit, log=True, range=shown)
        marks: tuple[Mark, ...] = (*lines, Rug(places, "measured modes", "measured"))
        rows.append((Panel(axis, scale, marks, shortened(visible(response.name), 40)),))
    caption = (
        "Measured frequency responses. Ticks mark the modes that were "
        f"measured.{those_drawn(len(measured.responses))}"
    )
    return Chart("responses", "Frequency responses", tuple(rows), caption)
