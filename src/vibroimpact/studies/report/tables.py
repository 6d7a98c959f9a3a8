"""Sentences and tables of the report of a study."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.limits.limit import limits
from vibroimpact.report.report import Column, Table, table_of
from vibroimpact.studies.computation.study import Study, StudyDoubt
from vibroimpact.studies.planning.unit_slips import study_slips
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.labels import drops_text, percent, range_text, value_text
from vibroimpact.studies.report.outputs import Output, read_output
from vibroimpact.studies.report.percentiles import PERCENTILES
from vibroimpact.studies.report.sensitivity_table import RANGES, RANKS, SOBOL, Sensitivity
from vibroimpact.units.display import MISSING, column_texts, digits, fixed, multiple

PERCENTILE_COLUMNS = [
    "output",
    "unit",
    "drops",
    "mean",
    "standard_deviation",
    *(f"percentile_{percentile}" for percentile in PERCENTILES),
]
"""Columns of `percentiles.csv`."""

COUNTED_FROM = "Drops are counted from 0, as in study.nc and drops.csv."

_WORST_KEYS = 4  # keys shown of the worst drop; all are in drops.csv

MOST_COLUMNS = 6  # results of a table of few drops

_COUNT = "number_of_impacts"
_COUNTS = ("points", "drops")  # columns of whole numbers in sensitivity.csv
_FAILURES = 10
_REASONS = 5
_MOST_KEYS = 20
_IDLE = set(f"0. ±{MISSING}")
_NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")


def counts_sentence(study: Study) -> str:
    """Return a sentence with the numbers of drops and of failed drops."""
    failed = len(study.failures)
    drops = drops_text(study.size)
    if not failed:
        return f"{drops}; none failed."
    if failed == study.size == 1:
        return f"{drops}; it failed."
    if failed == study.size:
        return f"{drops}; all of them failed."
    return f"{drops}; {failed} failed ({percent(failed / study.size)})."


def reason_sentences(study: Study) -> list[str]:
    """Return the most frequent reasons of failure, each with its number of drops."""
    sentences = []
    for number, reason in reasons(study):
        such_as = ", such as" if number > 1 else ""
        sentences.append(f"{drops_text(number)}{such_as}: {reason}")
    return sentences


def reasons(study: Study) -> list[tuple[int, str]]:
    """Return the most frequent reasons of failure (numbers in the text ignored): the
    number of drops, and the text of the first.
    """
    first_reasons: dict[str, str] = {}
    counts: Counter[str] = Counter()
    for reason in study.failures.values():
        without_numbers = _NUMBER.sub("#", reason)
        first_reasons.setdefault(without_numbers, reason)
        counts[without_numbers] += 1
    return [(number, first_reasons[kind]) for kind, number in counts.most_common(_REASONS)]


def failures_table(study: Study) -> Table:
    """Return the table of the first failed drops: number, values of the keys, and reason."""
    axes = study_axes(study)
    failures = dict(list(study.failures.items())[:_FAILURES])
    points = [point_of(study, axes, number) for number in failures]
    columns = [Column("Drop (from 0)", [str(number) for number in failures], is_text=True)]
    for number, axis in enumerate(axes):
        columns.append(Column(axis.key, [value_text(axis, point[number]) for point in points]))
    columns.append(Column("Reason", list(failures.values()), is_text=True, wraps=True))
    return Table(columns)


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
    return [
        *study_slips(study.table, study.coordinates),
        *(_doubt_sentence(study, doubt) for doubt in study.doubts),
    ]


def _doubt_sentence(study: Study, doubt: StudyDoubt) -> str:
    """Return a limit that drops exceed, with their number and the worst of them."""
    title = doubt.limit.replace("_", " ")
    worst = digits(doubt.number, 3)
    limit = limits().get(doubt.limit)  # another version may have had others
    if limit:
        title = limit.title
        worst = limit.shown(doubt.number)
    axes = study_axes(study)
    point = zip(axes, point_of(study, axes, doubt.worst), strict=True)
    keys = [f"{axis.key} {value_text(axis, value)}" for axis, value in point if axis.varies]
    values = ""
    if keys:
        values = f" ({', '.join(keys[:_WORST_KEYS])})"
    return (
        f"{title}: {doubt.drops:,} of {study.size:,} drops, worst {worst} at drop "
        f"{doubt.worst}{values}"
    )


def axes_table(study: Study, axes: list[StudyAxis]) -> list[tuple[str, str, str]]:
    """Return the table of the swept keys: key, what it is, and range."""
    rows = []
    for axis in axes:
        values = range_text(axis)
        if study.is_grid and axis.varies:
            values = f"{len(axis.values)} levels, {values}"
        rows.append((axis.key, axis.words, values))
    return rows


def points_table(study: Study, outputs: list[Output]) -> Table | None:
    """Return the table of few drops, a row for each: keys and results; None without a value."""
    shown = main_results(outputs, MOST_COLUMNS)
    if not shown:
        return None
    axes = study_axes(study)
    numbers = range(study.size)
    points = [point_of(study, axes, number) for number in numbers]
    columns = [Column("Drop", [str(number) for number in numbers], is_text=True)]
    for place, axis in enumerate(axes):
        if axis.varies:
            unit, cells = _key_cells(axis, [point[place] for point in points])
            columns.append(Column(axis.key, cells, unit, is_text=not axis.numeric))
    for output in shown:
        values = read_output(study, output.name) / output.scale.size
        columns.append(Column(output.title, column_texts(values, 4), output.scale.unit))
    # a narrow terminal has the most important results
    expendable = [output.title for output in reversed(shown[1:])]
    return Table(columns, file="drops.csv", expendable=expendable)


def _key_cells(axis: StudyAxis, values: list[Any]) -> tuple[str, list[str]]:
    """Return the unit and the cells of a key in some drops."""
    if not axis.numeric:
        return "", [value_text(axis, value) for value in values]
    scale = multiple(axis.unit, values)
    return scale.unit, column_texts(np.array(values, dtype=float) / scale.size, 4)


def main_results(outputs: list[Output], most: int) -> list[Output]:
    """Return the first results that vary; if none does, the first that have a value."""
    with_values = [output for output in outputs[: most + 3] if output.spread.drops]
    varying = [output for output in with_values if output.spread.varies]
    return (varying or with_values)[:most]


def percentiles_table(outputs: list[Output]) -> Table:
    """Return the table of the statistics of the results, a row for each that is not zero in
    all drops.
    """
    headings = ["Result", "Unit", "Drops", "Mean", "Standard deviation"]
    headings += [f"{percentile} %" for percentile in PERCENTILES]
    rows = [
        _statistics_row(output) for output in outputs if output.spread.drops and not output.is_zero
    ]
    return _without_idle_columns(table_of(headings, rows))


def _statistics_row(output: Output) -> list[str]:
    """Return name, unit and statistics of a result."""
    spread = output.spread
    size = output.scale.size
    percentiles = [digits(value / size) for value in spread.percentiles]
    if output.name == _COUNT:
        percentiles = [f"{value:g}" for value in spread.percentiles]
    deviation = spread.standard_deviation
    if spread.drops > 1 and not spread.varies:
        # of equal values it is rounding
        deviation = 0.0
    return [
        output.title,
        output.scale.unit,
        str(spread.drops),
        digits(spread.mean / size),
        digits(deviation / size),
        *percentiles,
    ]


def percentiles_rows(outputs: list[Output]) -> list[dict[str, Any]]:
    """Return the rows of `percentiles.csv`, in SI units."""
    rows = []
    for output in outputs:
        spread = output.spread
        numbers = {"mean": spread.mean, "standard_deviation": spread.standard_deviation}
        for percentile, value in zip(PERCENTILES, spread.percentiles, strict=True):
            numbers[f"percentile_{percentile}"] = value
        row = {"output": output.name, "unit": output.unit, "drops": spread.drops}
        rows.append({**row, **{name: _finite(value) for name, value in numbers.items()}})
    return rows


def _finite(value: float) -> float | None:
    """Return a value; None if it is missing."""
    return value if np.isfinite(value) else None


def sensitivity_table(sensitivity: Sensitivity, outputs: list[Output]) -> Table:
    """Return the table of sensitivities: a row per key with an effect (two of Sobol indices), a
    column per result.
    """
    shown = [output for output in outputs if output.name in sensitivity.rows]
    rows = [
        row
        for rows_of_key in _sensitivity_cells(sensitivity, shown).values()
        for row in rows_of_key
        if not _is_idle(row[1:])
    ]
    return _without_idle_columns(table_of(["Key", *(output.title for output in shown)], rows))


def without_effect(sensitivity: Sensitivity, outputs: list[Output]) -> list[str]:
    """Return the keys that the table of sensitivities leaves out, as all their numbers
    there are zero once rounded.
    """
    shown = [output for output in outputs if output.name in sensitivity.rows]
    return [
        key
        for key, rows in _sensitivity_cells(sensitivity, shown).items()
        if all(_is_idle(row[1:]) for row in rows)
    ]


_SHOWN_COLUMNS = {
    SOBOL: {"first_order": ", alone", "total": ", in all"},
    RANKS: {"rank_correlation": ""},
    RANGES: {"relative_range": ""},
}
"""Columns of `sensitivity.csv` that the table shows, with what follows the key in their rows."""


def _sensitivity_cells(
    sensitivity: Sensitivity, outputs: list[Output]
) -> dict[str, list[list[str]]]:
    """Return the rows of each key."""
    rows: dict[str, list[list[str]]] = {}
    for number, key in enumerate(sensitivity.keys[:_MOST_KEYS]):
        rows[key] = []
        for column, suffix in _SHOWN_COLUMNS[sensitivity.way].items():
            cells = [_cell(sensitivity.rows[output.name], column, number) for output in outputs]
            rows[key].append([f"{key}{suffix}", *cells])
    return rows


def _without_idle_columns(table: Table) -> Table:
    """Return a table without columns of nothing but zeros and dashes."""
    names, *others = table.columns
    return Table((names, *(column for column in others if not _is_idle(column.cells))))


def _is_idle(cells: Sequence[str]) -> bool:
    """Return whether cells are nothing but zeros and dashes."""
    return bool(cells) and all(cell and set(cell) <= _IDLE for cell in cells)


def sensitivity_rows(sensitivity: Sensitivity) -> list[dict[str, Any]]:
    """Return the rows of `sensitivity.csv`, one per result and key."""
    rows = []
    for output, columns in sensitivity.rows.items():
        for number, key in enumerate(sensitivity.keys):
            row: dict[str, Any] = {"output": output, "key": key}
            for name, values in columns.items():
                row[name] = _finite(float(values[number]))
                if name in _COUNTS:
                    row[name] = int(values[number])
            rows.append(row)
    return rows


def sensitivity_words(sensitivity: Sensitivity) -> str:
    """Return the explanation of the table of sensitivities."""
    if sensitivity.way == SOBOL:
        return (
            "Sobol's indices, in percent of the variance: of a key alone (first order), and "
            "with its interactions "
            "(total), with half of their 95 % bootstrap intervals. An index that is smaller "
            "than this half is not significantly "
            "different from zero; an estimate may even be negative."
        )
    if sensitivity.way == RANKS:
        drops = max((int(row["drops"].max()) for row in sensitivity.rows.values()), default=0)
        least = ""
        if drops:
            # twice the standard deviation of the correlation of independent ranks
            chance = digits(2.0 / np.sqrt(drops), 1)
            least = f" Of {drops} drops, magnitudes below {chance} may be due to chance."
        return (
            "Spearman's rank correlation: 1 if the result always rises with the key, \u22121 "
            f"if it always falls.{least}"
        )
    return (
        "Range of a result along one key, from the smallest to the largest, with all other "
        "keys at their middle level, of an even "
        "number the upper of the two in the middle; in percent of the result where all are."
    )


def _cell(columns: dict[str, Floats], name: str, number: int) -> str:
    """Return the sensitivity to a key as text, with half of its interval if it has one."""
    value = float(columns[name][number])
    if name == "rank_correlation":
        return digits(value, 2)
    if f"{name}_high" not in columns:
        return _percent(value)
    half = float(columns[f"{name}_high"][number]) - value
    return f"{_percent(value)} ± {_percent(half)}"


def _percent(fraction: float) -> str:
    return fixed(100.0 * fraction, 1)


def spread_words(study: Study) -> str:
    """Return the explanation of the table of percentiles."""
    failed = ""
    if study.failures:
        failed = " Drops that failed are left out."
    explanations = {
        "grid": "These percentiles describe the grid; its levels were chosen, so that they are not "
        "probabilities.",
        "zip": "These percentiles describe the chosen points; they are not probabilities.",
        "saltelli": "Percentiles of the results for the sampled keys, from the blocks A and B, "
        "whose drops are independent.",
    }
    sampled = "Percentiles of the results for the sampled keys."
    return explanations.get(study.design, sampled) + failed
