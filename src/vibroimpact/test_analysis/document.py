"""A correlation as data: its tables, and its summary, which `correlate --json` prints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.arrays import Floats
from vibroimpact.quoting import visible
from vibroimpact.test_analysis.correlate import Correlation
from vibroimpact.test_analysis.criteria import Criteria, Responses
from vibroimpact.test_analysis.mode_pairs import ModePair, damping_field
from vibroimpact.units.display import MISSING, digits

RECORD_HEADERS = (
    "Record",
    "Polarity",
    "Correlation",
    "Measured over simulated",
    "Residual, %",
    "FRAC",
)
"""Headers of the table of records."""
MODE_HEADERS = (
    "Mode",
    "Computed, Hz",
    "Measured, Hz",
    "95 % ±",
    "Difference, %",
    "Damping ratio of the case",
    "Measured damping ratio",
    "95 % from",
    "to",
    "Remark",
)
"""Headers of the table of modes."""
TEXTS = ("Record", "Response", "Unit", "Polarity", "Band", "Remark")
"""Headers of columns of words."""
MODE_COLUMNS = (
    "mode",
    "case_frequency_Hz",
    "case_damping_ratio",
    "case_response",
    "frequency_Hz",
    "frequency_low_Hz",
    "frequency_high_Hz",
    "damping_ratio",
    "damping_ratio_low",
    "damping_ratio_high",
    "damping_measured",
    "remark",
)
"""Columns of `modes.csv`."""


def what_frac_is_of(found: Correlation) -> str:
    """Return of what the frequency response assurance criterion is."""
    if not found.hits:
        return "the spectra of the signals, since no force was measured"
    return (
        f"the frequency responses to the force, by H1 from {found.hits} "
        f"hit{'s' if found.hits > 1 else ''}"
    )


def record_rows(found: Correlation) -> list[list[str]]:
    """Return the cells of the table of records."""
    columns = zip(
        found.sensors,
        found.polarity,
        found.coefficient,
        found.scale,
        found.relative_residual,
        found.frac,
        strict=True,
    )
    return [
        [
            visible(sensor.name),
            "inverted" if sign < 0.0 else "as simulated",
            f"{alike:.3f}",
            digits(scale, 4),
            f"{100.0 * part:.1f}",
            f"{of:.3f}",
        ]
        for sensor, sign, alike, scale, part, of in columns
    ]


def octave_headers(found: Criteria) -> list[str]:
    """Return the headers of the table of octaves."""
    return ["Band", *(visible(sensor.name) for sensor in found.sensors)]


def response_columns(found: Responses, plain: Mapping[str, str]) -> dict[str, Floats]:
    """Return the columns of `responses.csv`: the frequency, and of each response magnitude and
    phase of both, and the coherence.

    Parameters
    ----------
    found : Responses
        The correlation.
    plain : mapping of str to str
        What stands for the name of each sensor.
    """
    columns = {"frequency_Hz": found.frequency}
    for number, sensor in enumerate(found.sensors):
        name = plain[sensor.name]
        for what, response in (
            ("measured", found.measured_response),
            ("simulated", found.simulated_response),
        ):
            columns |= {
                f"{name}_{what}_magnitude": np.abs(response[number]),
                f"{name}_{what}_phase_rad": np.angle(response[number]),
            }
        if found.coherence is not None:
            columns[f"{name}_coherence"] = found.coherence[number]
    return columns


def octave_rows(found: Criteria) -> list[list[str]]:
    """Return the cells of the table of octaves: the criterion of each record over each,
    and over the whole band.
    """
    whole = [
        f"{found.band[0]:.5g} to {found.band[1]:.5g} Hz, whole",
        *(f"{value:.3f}" for value in found.frac),
    ]
    parts = [
        [
            f"{low:.5g} to {high:.5g} Hz",
            *(MISSING if np.isnan(value) else f"{value:.3f}" for value in values),
        ]
        for (low, high), values in zip(found.octaves, found.octave_frac.T, strict=True)
    ]
    return [whole, *parts]


def mode_cells(modes: Sequence[ModePair]) -> tuple[list[str], list[list[str]]]:
    """Return headers and rows of the table of modes."""
    return without_blank_remarks(MODE_HEADERS, [mode_row(pair) for pair in modes])


def without_blank_remarks(
    headers: Sequence[str], rows: Sequence[Sequence[str]]
) -> tuple[list[str], list[list[str]]]:
    """Return headers and rows of a table whose last column has remarks, without that if
    there is none.
    """
    told = len(headers) if any(row[-1] for row in rows) else len(headers) - 1
    return list(headers[:told]), [list(row[:told]) for row in rows]


def mode_row(pair: ModePair) -> list[str]:
    """Return the cells of a mode in its table."""
    number = MISSING if pair.number is None else str(pair.number)
    computed, ratio = (
        MISSING if pair.number is None else digits(value, 5)
        for value in (pair.frequency, pair.damping_ratio)
    )
    if pair.measured is None:
        return [
            number,
            computed,
            MISSING,
            MISSING,
            MISSING,
            ratio,
            MISSING,
            MISSING,
            MISSING,
            pair.remark,
        ]
    mode = pair.measured
    half = mode.frequency.interval[1] - mode.frequency.value
    ratio_and_ends = (mode.damping_ratio.value, *mode.damping_ratio.interval)
    damping = [MISSING if mode.doubt else digits(value, 4) for value in ratio_and_ends]
    difference = MISSING if pair.number is None else signed(100.0 * pair.frequency_difference)
    return [
        number,
        computed,
        digits(mode.frequency.value, 6),
        digits(half, 2),
        difference,
        ratio,
        *damping,
        pair.remark,
    ]


def signed(value: float) -> str:
    """Return a number with its sign and two decimals; 0.00, which has none.

    Examples
    --------
    >>> signed(1.486), signed(-0.004)
    ('+1.49', '0.00')
    """
    text = f"{value:+.2f}"
    return text if float(text) else text[1:]


def mode_table(found: Criteria) -> list[dict[str, Any]]:
    """Return the modes as rows of `MODE_COLUMNS`; None where there is no number."""
    return [mode_record(pair) for pair in found.modes]


def mode_record(pair: ModePair) -> dict[str, Any]:
    """Return a mode as a row of `MODE_COLUMNS`."""
    return dict(zip(MODE_COLUMNS, _mode_values(pair), strict=True))


def _mode_values(pair: ModePair) -> list[Any]:
    of_case = (
        [pair.frequency, pair.damping_ratio, pair.response]
        if pair.number is not None
        else 3 * [None]
    )
    mode = pair.measured
    measured = (
        6 * [None]
        if mode is None
        else [
            part
            for one in (mode.frequency, mode.damping_ratio)
            for part in (one.value, *one.interval)
        ]
    )
    return [pair.number, *of_case, *measured, pair.damping_measured, pair.remark]


def summary_of_correlation(found: Correlation) -> dict[str, Any]:
    """Return the content of `summary.json`, and of what `correlate --json` prints."""
    records = zip(
        found.sensors,
        found.polarity,
        found.coefficient,
        found.skew,
        found.scale,
        found.relative_residual,
        found.frac,
        found.octave_frac,
        found.scaled_frac,
        found.damped_frac,
        strict=True,
    )
    return {
        "name": found.case.name,
        "version": __version__,
        "band_Hz": list(found.band),
        "rate_Hz": found.sensors[0].rate,
        "first_touch_s": found.first_touch,
        "delay_s": found.delay,
        "hits": found.hits,
        "octaves_Hz": [list(one) for one in found.octaves],
        "records": {
            sensor.name: {
                "polarity": int(sign),
                "correlation": float(alike),
                "later_than_others_s": float(late),
                "scale": float(scale),
                "residual_rms_relative": float(part),
                "frac": float(of),
                "octave_frac": [None if np.isnan(value) else float(value) for value in octaves],
                "scaled_frac": float(scaled),
                "damped_frac": float(damped),
            }
            for sensor, sign, alike, late, scale, part, of, octaves, scaled, damped in records
        },
        "removed": {
            name: {"offset": one.offset, "drift": one.drift} for name, one in found.removed.items()
        },
        "modes": mode_table(found),
        "damping": damping_field(found.modes),
        "doubts": list(found.doubts),
    }
