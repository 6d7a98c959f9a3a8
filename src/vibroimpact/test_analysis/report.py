"""What a comparison of a test with its simulation tells: agreement, modes and damping."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.files.plain_names import plain_names
from vibroimpact.quoting import visible
from vibroimpact.report.report import Explanation, Report, Section, Table, table_of
from vibroimpact.results.csv_files import write_columns
from vibroimpact.test_analysis.charts import correlation_charts, what_frac_is_of
from vibroimpact.test_analysis.correlate import Correlation
from vibroimpact.test_analysis.criteria_tables import (
    comparison_report,
    known_or_none,
    mode_table,
    modes_section,
    octave_blocks,
    polarity_cell,
)
from vibroimpact.test_analysis.mode_pairs import damping_field
from vibroimpact.units.display import digits


def report_of(correlation: Correlation) -> Report:
    """Return the report of a comparison of records with their simulation.

    The folder has `overlay.csv` (time, and of each record measured, simulated and residual),
    `responses.csv` (frequency, and of each record magnitude and phase of both), `modes.csv` and
    `case.toml`.
    """
    agreement = Section(
        "agreement",
        "Agreement",
        (
            record_table(correlation),
            Explanation(
                f"The correlation is that of the first {1e3 * correlation.aligned:.3g} ms, by "
                "which records and simulation are aligned in time; measured over simulated is the "
                "scale factor that fits the simulation best to the record; the residual is given "
                "by its rms value relative to that of the record."
            ),
            *octave_blocks(correlation, what_frac_is_of(correlation)),
        ),
    )
    modes = modes_section(
        correlation.modes,
        "Measured frequencies and damping ratios are those of damped sinusoids fitted to the "
        "records after the end of the force; the intervals include noise alone. Modes are paired "
        "by frequency; mode shapes are not compared.",
    )
    return comparison_report(
        correlation,
        (agreement, modes),
        correlation_charts(correlation),
        _summary(correlation),
        {"overlay.csv": partial(_write_overlay, correlation)},
    )


def record_table(correlation: Correlation) -> Table:
    """Return the table of records."""
    headings = ["Record", "Polarity", "Correlation", "Measured over simulated", "Residual, %"]
    rows = []
    for number, sensor in enumerate(correlation.sensors):
        rows.append(
            [
                visible(sensor.name),
                polarity_cell(correlation.polarity[number]),
                f"{correlation.coefficient[number]:.3f}",
                digits(correlation.scale[number], 4),
                f"{100.0 * correlation.relative_residual[number]:.1f}",
                f"{correlation.frac[number]:.3f}",
            ]
        )
    return table_of([*headings, "FRAC"], rows, texts=("Polarity",))


def _write_overlay(correlation: Correlation, path: Path) -> None:
    """Write records, simulation and residuals over time."""
    plain = plain_names([sensor.name for sensor in correlation.sensors])
    overlay = {"time_s": correlation.time}
    for number, sensor in enumerate(correlation.sensors):
        name = plain[sensor.name]
        overlay[f"{name}_measured"] = correlation.measured[number]
        overlay[f"{name}_simulated"] = correlation.simulated[number]
        overlay[f"{name}_residual"] = correlation.residual[number]
    write_columns(overlay, path)


def _summary(correlation: Correlation) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    return {
        "name": correlation.case.name,
        "version": __version__,
        "band_Hz": list(correlation.band),
        "rate_Hz": correlation.sensors[0].rate,
        "first_touch_s": correlation.first_touch,
        "delay_s": correlation.delay,
        "hits": correlation.hits,
        "octaves_Hz": [list(removed) for removed in correlation.octaves],
        "records": _records(correlation),
        "removed": {
            name: {"offset": removed.offset, "drift": removed.drift}
            for name, removed in correlation.removed.items()
        },
        "modes": mode_table(correlation),
        "damping": damping_field(correlation.modes),
        "doubts": list(correlation.doubts),
    }


def _records(correlation: Correlation) -> dict[str, Any]:
    """Return the criteria of each record, by its name."""
    return {
        sensor.name: {
            "polarity": int(correlation.polarity[number]),
            "correlation": float(correlation.coefficient[number]),
            "later_than_others_s": float(correlation.skew[number]),
            "scale": float(correlation.scale[number]),
            "residual_rms_relative": float(correlation.relative_residual[number]),
            "frac": float(correlation.frac[number]),
            "octave_frac": known_or_none(correlation.octave_frac[number]),
            "scaled_frac": float(correlation.scaled_frac[number]),
            "damped_frac": float(correlation.damped_frac[number]),
        }
        for number, sensor in enumerate(correlation.sensors)
    }
