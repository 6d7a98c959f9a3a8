"""Sentences and tables of the report of a study."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.limit import limits
from vibroimpact.studies.percentiles import PERCENTILES
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.labels import drops_text, percent, range_text, value_text
from vibroimpact.studies.report.outputs import Output
from vibroimpact.studies.report.sensitivity_table import RANKS, SOBOL, Sensitivity
from vibroimpact.studies.study import Study
from vibroimpact.studies.unit_slips import study_slips
from vibroimpact.units.display import MISSING, digits, fixed

PERCENTILE_COLUMNS = [
    "output",
    "unit",
    "drops",
    "mean",
    "standard_deviation",
    *(f"percentile_{part}" for part in PERCENTILES),
]
"""Columns of `percentiles.csv`."""

COUNTED_FROM = "Drops are counted from 0, as in study.nc and drops.csv."

_WORST_KEYS = 4  # keys shown of the worst drop; all are in drops.csv

_COUNT = "number_of_impacts"
_FAILURES, _REASONS = 10, 5
_MOST_KEYS = 20
_IDLE = set(f"0. ±{MISSING}")
_NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")


def counts_sentence(study: Study) -> str:
    """Return a sentence with the numbers of drops and of failed drops."""
    failed = len(study.failures)
    drops = drops_text(study.size)
    if not failed:
        return f"{drops}; none failed."
    if failed == study.size:
        return f"{drops}; all of them failed." if failed > 1 else f"{drops}; it failed."
    return f"{drops}; {failed} failed ({percent(failed / study.size)})."


def reasons(study: Study) -> list[tuple[int, str]]:
    """Return the most frequent reasons of failure (numbers in the text ignored): the
    number of drops, and the text of the first.
    """
    found: dict[str, str] = {}
    counts: Counter[str] = Counter()
    for words in study.failures.values():
        kind = _NUMBER.sub("#", words)
        found.setdefault(kind, words)
        counts[kind] += 1
    return [(number, found[kind]) for kind, number in counts.most_common(_REASONS)]


def failures_table(study: Study) -> tuple[list[str], list[list[str]]]:
    """Return the table of the first failed drops: headers, and rows with number, point
    and reason.
    """
    axes, rows = study_axes(study), []
    for number, reason in list(study.failures.items())[:_FAILURES]:
        rows.append(
            [
                str(number),
                *(
                    value_text(axis, value)
                    for axis, value in zip(axes, point_of(study, axes, number), strict=True)
                ),
                reason,
            ]
        )
    return ["Drop (from 0)", *(axis.key for axis in axes), "Reason"], rows


def point_of(study: Study, axes: list[StudyAxis], number: int) -> list[Any]:
    """Return the values of the axes for a drop, by its number."""
    if study.is_grid:
        places = np.unravel_index(number, tuple(study.dimensions.values()))
        return [axis.values[place] for axis, place in zip(axes, places, strict=True)]
    return [axis.values[number] for axis in axes]


def doubt_sentences(study: Study) -> list[str]:
    """Return warnings: suspected slips of units, then each limit that drops exceed with
    the number of drops and the worst of them.
    """
    axes, found = study_axes(study), study_slips(study.table, study.coordinates)
    for limit, drops, worst, number in study.doubts:
        known = limits().get(limit)
        title, shown = (
            (known.title, known.shown(number))
            if known
            else (limit.replace("_", " "), digits(number, 3))
        )
        point = zip(axes, point_of(study, axes, worst), strict=True)
        where = ", ".join(
            [f"{axis.key} {value_text(axis, value)}" for axis, value in point if axis.varies][
                :_WORST_KEYS
            ]
        )
        found.append(
            f"{title}: {drops:,} of {study.size:,} drops, worst {shown} at drop "
            f"{worst}{f' ({where})' if where else ''}"
        )
    return found


def axes_table(study: Study, axes: list[StudyAxis]) -> list[tuple[str, str, str]]:
    """Return the table of the swept keys: key, what it is, and range."""
    rows = []
    for axis in axes:
        levels = f"{len(axis.values)} levels, " if study.is_grid and axis.varies else ""
        rows.append((axis.key, axis.words, levels + range_text(axis)))
    return rows


def percentiles_table(outputs: list[Output]) -> tuple[list[str], list[list[str]]]:
    """Return the table of the statistics of the results as text: headers, and a row per
    result that is not zero in all drops.
    """
    rows = []
    for one in outputs:
        spread, (unit, size) = one.spread, one.scale
        if not spread.drops or one.is_zero:
            continue
        # otherwise it is rounding
        deviation = spread.standard_deviation if spread.varies or spread.drops < 2 else 0.0
        parts = [
            f"{part:g}" if one.name == _COUNT else digits(part / size)
            for part in spread.percentiles
        ]
        rows.append(
            [
                one.title,
                unit,
                str(spread.drops),
                digits(spread.mean / size),
                digits(deviation / size),
                *parts,
            ]
        )
    return _without_idle_columns(
        [
            "Result",
            "Unit",
            "Drops",
            "Mean",
            "Standard deviation",
            *(f"{part} %" for part in PERCENTILES),
        ],
        rows,
    )


def percentiles_rows(outputs: list[Output]) -> list[dict[str, Any]]:
    """Return the rows of `percentiles.csv`, in SI units."""
    found = []
    for one in outputs:
        numbers = {"mean": one.spread.mean, "standard_deviation": one.spread.standard_deviation}
        numbers |= {
            f"percentile_{part}": value
            for part, value in zip(PERCENTILES, one.spread.percentiles, strict=True)
        }
        told = {name: value if np.isfinite(value) else None for name, value in numbers.items()}
        found.append({"output": one.name, "unit": one.unit, "drops": one.spread.drops, **told})
    return found


def sensitivity_table(
    found: Sensitivity, outputs: list[Output]
) -> tuple[list[str], list[list[str]]]:
    """Return the table of sensitivities as text: headers, and a row per key with an
    effect (two of Sobol indices), a column per result.
    """
    shown = [one for one in outputs if one.name in found.rows]
    rows = [
        row
        for key in _sensitivity_cells(found, shown).values()
        for row in key
        if not _is_idle(row[1:])
    ]
    return _without_idle_columns(["Key", *(one.title for one in shown)], rows)


def without_effect(found: Sensitivity, outputs: list[Output]) -> list[str]:
    """Return the keys that the table of sensitivities leaves out, as all their numbers
    there are zero once rounded.
    """
    shown = [one for one in outputs if one.name in found.rows]
    return [
        key
        for key, rows in _sensitivity_cells(found, shown).items()
        if all(_is_idle(row[1:]) for row in rows)
    ]


def _sensitivity_cells(found: Sensitivity, shown: list[Output]) -> dict[str, list[list[str]]]:
    """Return the rows of each key."""
    columns = {
        SOBOL: {"first_order": ", alone", "total": ", in all"},
        RANKS: {"rank_correlation": ""},
    }.get(found.way, {"relative_range": ""})
    return {
        key: [
            [f"{key}{words}", *(_cell(found.rows[one.name], column, place) for one in shown)]
            for column, words in columns.items()
        ]
        for place, key in enumerate(found.keys[:_MOST_KEYS])
    }


def _without_idle_columns(
    headers: list[str], rows: list[list[str]]
) -> tuple[list[str], list[list[str]]]:
    """Return a table without columns of nothing but zeros and dashes."""
    kept = [
        place
        for place in range(len(headers))
        if place == 0 or not _is_idle([row[place] for row in rows])
    ]
    return [headers[place] for place in kept], [[row[place] for place in kept] for row in rows]


def _is_idle(cells: list[str]) -> bool:
    """Return whether cells are nothing but zeros and dashes."""
    return bool(cells) and all(cell and set(cell) <= _IDLE for cell in cells)


def sensitivity_rows(found: Sensitivity) -> list[dict[str, Any]]:
    """Return the rows of `sensitivity.csv`, one per result and key."""
    rows = []
    for output, columns in found.rows.items():
        for place, key in enumerate(found.keys):
            cells = {name: float(values[place]) for name, values in columns.items()}
            counts = {
                name: int(value) for name, value in cells.items() if name in ("points", "drops")
            }
            rows.append(
                {
                    "output": output,
                    "key": key,
                    **{name: v if np.isfinite(v) else None for name, v in cells.items()},
                    **counts,
                }
            )
    return rows


def sensitivity_words(found: Sensitivity) -> str:
    """Return the explanation of the table of sensitivities."""
    if found.way == SOBOL:
        return (
            "Sobol's indices, in percent of the variance: of a key alone (first order), and "
            "with its interactions "
            "(total), with half of their 95 % bootstrap intervals. An index that is smaller "
            "than this half is not significantly "
            "different from zero; an estimate may even be negative."
        )
    if found.way == RANKS:
        drops = max((int(row["drops"].max()) for row in found.rows.values()), default=0)
        least = (
            f" Of {drops} drops, magnitudes below {digits(2.0 / np.sqrt(drops), 1)} may be "
            "due to chance."
            if drops
            else ""
        )
        return (
            "Spearman's rank correlation: 1 if the result always rises with the key, \u22121 "
            f"if it always falls.{least}"
        )
    return (
        "Range of a result along one key, from the smallest to the largest, with all other "
        "keys at their middle level, of an even "
        "number the upper of the two in the middle; in percent of the result where all are."
    )


def _cell(row: dict[str, Floats], column: str, place: int) -> str:
    value = float(row[column][place])
    if column == "rank_correlation":
        return digits(value, 2)
    half = (
        f" ± {_percent(float(row[f'{column}_high'][place]) - value)}"
        if f"{column}_high" in row
        else ""
    )
    return f"{_percent(value)}{half}"


def _percent(part: float) -> str:
    return fixed(100.0 * part, 1)


def spread_words(study: Study) -> str:
    """Return the explanation of the table of percentiles."""
    failed = " Drops that failed are left out." if study.failures else ""
    words = {
        "grid": "These percentiles describe the grid; its levels were chosen, so that they are not "
        "probabilities.",
        "zip": "These percentiles describe the chosen points; they are not probabilities.",
        "saltelli": "Percentiles of the results for the sampled keys, from the blocks A and B, "
        "whose drops are independent.",
    }
    return words.get(study.design, "Percentiles of the results for the sampled keys.") + failed
