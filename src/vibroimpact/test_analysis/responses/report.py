"""What a comparison of frequency responses tells: agreement, modes and damping."""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.quoting import visible
from vibroimpact.report.report import Explanation, Report, Section, Table, table_of
from vibroimpact.test_analysis.criteria_tables import (
    comparison_report,
    known_or_none,
    mode_table,
    modes_section,
    octave_blocks,
    polarity_cell,
)
from vibroimpact.test_analysis.mode_pairs import damping_field
from vibroimpact.test_analysis.responses.charts import WHAT_FRAC_IS_OF, response_charts
from vibroimpact.test_analysis.responses.doubts import COHERENT
from vibroimpact.test_analysis.responses.result import ResponseCorrelation
from vibroimpact.units.display import MISSING, digits, multiple


def report_of(correlation: ResponseCorrelation) -> Report:
    """Return the report of a comparison of frequency responses.

    The folder has `responses.csv` (frequency, and of each response magnitude and phase of both, and
    the coherence), `modes.csv` and `case.toml`.
    """
    agreement = Section(
        "agreement",
        "Agreement",
        (
            response_table(correlation),
            Explanation(
                "Measured over simulated is the scale factor that fits the simulated response "
                "best to the measured one; level and phase are the medians over the band of the "
                "absolute differences, and the coherence is its median."
            ),
            *octave_blocks(correlation, WHAT_FRAC_IS_OF),
        ),
    )
    modes = modes_section(
        correlation.modes,
        "Measured frequencies and damping ratios are those of a sum of modes fitted to all "
        "responses together; the intervals include noise alone. Modes are paired by frequency; "
        "mode shapes are not compared.",
    )
    return comparison_report(
        correlation,
        (agreement, modes),
        response_charts(correlation),
        _summary(correlation),
    )


def response_table(correlation: ResponseCorrelation) -> Table:
    """Return the table of responses."""
    headings = [
        "Response",
        "Unit",
        "Polarity",
        "Measured over simulated",
        "Level, dB",
        "Phase, °",
        "FRAC",
        "Coherence",
    ]
    coherences = _coherences(correlation)
    phases = np.degrees(correlation.phase_difference)
    rows = []
    for number, sensor in enumerate(correlation.sensors):
        coherence = coherences[number]
        rows.append(
            [
                visible(sensor.name),
                multiple(correlation.units[number], 0.0).unit,
                polarity_cell(correlation.polarity[number]),
                digits(correlation.scale[number], 4),
                f"{correlation.level_difference[number]:.2f}",
                f"{phases[number]:.1f}",
                f"{correlation.frac[number]:.3f}",
                MISSING if coherence is None else f"{coherence:.3f}",
            ]
        )
    return table_of(headings, rows, texts=("Unit", "Polarity"))


def _coherences(correlation: ResponseCorrelation) -> list[float | None]:
    """Return the median coherence of each response; None if it is not known."""
    if correlation.coherence is None:
        return [None] * len(correlation.sensors)
    # the median of a response with NaN, whose coherence is not known, is NaN
    return known_or_none(np.median(correlation.coherence, axis=1))


def _low_parts(correlation: ResponseCorrelation) -> list[float | None]:
    """Return the part of the band where the coherence of each response is low, if it is known."""
    if correlation.coherence is None:
        return [None] * len(correlation.sensors)
    low = (correlation.coherence < COHERENT).mean(axis=1)
    unknown = np.isnan(correlation.coherence).any(axis=1)
    return known_or_none(np.where(unknown, np.nan, low))


def _summary(correlation: ResponseCorrelation) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    coherences = _coherences(correlation)
    low_parts = _low_parts(correlation)
    return {
        "name": correlation.case.name,
        "version": __version__,
        "band_Hz": list(correlation.band),
        "reference": correlation.reference,
        "reciprocal": correlation.reciprocal,
        "octaves_Hz": [list(octave) for octave in correlation.octaves],
        "responses": {
            sensor.name: {
                "unit": correlation.units[number],
                "polarity": int(correlation.polarity[number]),
                "scale": float(correlation.scale[number]),
                "level_difference_dB": float(correlation.level_difference[number]),
                "phase_difference_rad": float(correlation.phase_difference[number]),
                "frac": float(correlation.frac[number]),
                "octave_frac": known_or_none(correlation.octave_frac[number]),
                "scaled_frac": float(correlation.scaled_frac[number]),
                "damped_frac": float(correlation.damped_frac[number]),
                "coherence_median": coherences[number],
                "coherence_low_part": low_parts[number],
            }
            for number, sensor in enumerate(correlation.sensors)
        },
        "modes": mode_table(correlation),
        "damping": damping_field(correlation.modes),
        "doubts": list(correlation.doubts),
    }
