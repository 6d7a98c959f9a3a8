"""A correlation of frequency responses as data: its table, and its summary, which
`correlate --json` prints.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.quoting import visible
from vibroimpact.test_analysis.document import mode_table
from vibroimpact.test_analysis.mode_pairs import damping_field
from vibroimpact.test_analysis.responses.doubts import COHERENT
from vibroimpact.test_analysis.responses.result import ResponseCorrelation
from vibroimpact.units.display import MISSING, digits, multiple

RESPONSE_HEADERS = (
    "Response",
    "Unit",
    "Polarity",
    "Measured over simulated",
    "Level, dB",
    "Phase, °",
    "FRAC",
    "Coherence",
)
"""Headers of the table of responses."""
WHAT_FRAC_IS_OF = "the measured frequency responses"


def response_rows(found: ResponseCorrelation) -> list[list[str]]:
    """Return the cells of the table of responses."""
    columns = zip(
        found.sensors,
        found.units,
        found.polarity,
        found.scale,
        found.level_difference,
        np.degrees(found.phase_difference),
        found.frac,
        _coherences(found),
        strict=True,
    )
    return [
        [
            visible(sensor.name),
            multiple(unit, 0.0).unit,
            "inverted" if sign < 0.0 else "as simulated",
            digits(scale, 4),
            f"{level:.2f}",
            f"{phase:.1f}",
            f"{of:.3f}",
            MISSING if coherence is None else f"{coherence:.3f}",
        ]
        for sensor, unit, sign, scale, level, phase, of, coherence in columns
    ]


def _coherences(found: ResponseCorrelation) -> list[float | None]:
    """Return the median coherence of each response; None if it is not known."""
    if found.coherence is None:
        return [None] * len(found.sensors)
    return [None if np.isnan(one).any() else float(np.median(one)) for one in found.coherence]


def summary_of_responses(found: ResponseCorrelation) -> dict[str, Any]:
    """Return the content of `summary.json`, and of what `correlate --json` prints of
    frequency responses.
    """
    coherences = _coherences(found)
    return {
        "name": found.case.name,
        "version": __version__,
        "band_Hz": list(found.band),
        "reference": found.reference,
        "reciprocal": found.reciprocal,
        "octaves_Hz": [list(one) for one in found.octaves],
        "responses": {
            sensor.name: {
                "unit": found.units[number],
                "polarity": int(found.polarity[number]),
                "scale": float(found.scale[number]),
                "level_difference_dB": float(found.level_difference[number]),
                "phase_difference_rad": float(found.phase_difference[number]),
                "frac": float(found.frac[number]),
                "octave_frac": [
                    None if np.isnan(value) else float(value) for value in found.octave_frac[number]
                ],
                "scaled_frac": float(found.scaled_frac[number]),
                "damped_frac": float(found.damped_frac[number]),
                "coherence_median": coherences[number],
                "coherence_low_part": None
                if found.coherence is None or coherences[number] is None
                else float((found.coherence[number] < COHERENT).mean()),
            }
            for number, sensor in enumerate(found.sensors)
        },
        "modes": mode_table(found),
        "damping": damping_field(found.modes),
        "doubts": list(found.doubts),
    }
