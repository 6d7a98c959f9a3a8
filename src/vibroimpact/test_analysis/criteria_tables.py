"""Tables of the agreement of a test with its simulation, over octaves and modes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.build import resolved_case
from vibroimpact.charts.chart import Chart
from vibroimpact.files.plain_names import plain_names
from vibroimpact.files.result_folder import CASE, write_case
from vibroimpact.quoting import visible
from vibroimpact.report.report import (
    Block,
    Code,
    Explanation,
    Note,
    Quantity,
    Report,
    Section,
    Table,
    finite_interval,
    table_of,
)
from vibroimpact.results.csv_files import write_columns, write_csv
from vibroimpact.test_analysis.criteria import Comparison, Criteria, Responses
from vibroimpact.test_analysis.mode_pairs import ModePair, damping_field
from vibroimpact.units.display import MISSING, digits

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
TEXTS = ("Remark",)
"""Headers of columns of words in a table of modes."""
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


def write_responses(correlation: Responses, path: Path) -> None:
    """Write frequency, and of each response magnitude and phase of both, and the coherence."""
    plain = plain_names([sensor.name for sensor in correlation.sensors])
    columns = {"frequency_Hz": correlation.frequency}
    for number, sensor in enumerate(correlation.sensors):
        name = plain[sensor.name]
        for origin, response in (
            ("measured", correlation.measured_response),
            ("simulated", correlation.simulated_response),
        ):
            columns[f"{name}_{origin}_magnitude"] = np.abs(response[number])
            columns[f"{name}_{origin}_phase_rad"] = np.angle(response[number])
        if correlation.coherence is not None:
            columns[f"{name}_coherence"] = correlation.coherence[number]
    write_columns(columns, path)


def write_modes(correlation: Criteria, path: Path) -> None:
    """Write the modes of both."""
    write_csv(mode_table(correlation), list(MODE_COLUMNS), path)


def comparison_report(
    correlation: Comparison,
    sections: Sequence[Section],
    charts: Sequence[Chart],
    summary: Mapping[str, Any],
    files: Mapping[str, Callable[[Path], object]] | None = None,
) -> Report:
    """Return the report of a comparison, whose folder has `responses.csv`, `modes.csv` and
    `case.toml` beside other files.
    """
    return Report(
        title=f"{correlation.case.name or 'A test'}, test and simulation",
        quantities=[*_agreement(correlation), *answer_of_modes(correlation.modes)],
        sections=sections,
        charts=charts,
        warnings=correlation.doubts,
        files={
            **(files or {}),
            "responses.csv": partial(write_responses, correlation),
            "modes.csv": partial(write_modes, correlation),
            CASE: partial(write_case, resolved_case(correlation.case)),
        },
        summary=summary,
        provenance="the case is case.toml, beside this page.",
    )


def _agreement(criteria: Criteria) -> Iterator[Quantity]:
    """Yield the criterion of the record or response that agrees least."""
    least = int(np.argmin(criteria.frac))
    low, high = criteria.band
    note = f"of {visible(criteria.sensors[least].name)}, from {low:.4g} to {high:.4g} Hz"
    yield Quantity("Smallest FRAC", float(criteria.frac[least]), note=note, figures=3)


def answer_of_modes(modes: Sequence[ModePair]) -> Iterator[Quantity]:
    """Yield how many modes are paired, and the pairs that differ most.

    Parameters
    ----------
    modes : sequence of ModePair
        The modes of a case beside measured ones.
    """
    in_case = sum(pair.number is not None for pair in modes)
    measured = sum(pair.measured is not None for pair in modes)
    pairs = [pair for pair in modes if pair.number is not None and pair.measured is not None]
    note = f"of {in_case} modes of the case in the band and {measured} measured ones"
    yield Quantity("Paired modes", len(pairs), note=note)
    if not pairs:
        return
    worst = max(pairs, key=lambda pair: abs(pair.frequency_difference))
    assert worst.measured is not None  # as of all pairs
    low, high = worst.measured.frequency.interval
    yield Quantity(
        "Largest frequency difference",
        100.0 * worst.frequency_difference,
        "%",
        note=f"measured less computed, mode {worst.number} at {worst.frequency:.5g} Hz",
        interval=finite_interval(
            100.0 * (low / worst.frequency - 1.0), 100.0 * (high / worst.frequency - 1.0)
        ),
    )
    damped = [pair for pair in pairs if pair.damping_measured]
    if damped:
        ratios = [_damping_ratio(pair) for pair in damped]
        yield Quantity(
            "Measured over computed damping",
            min(ratios),
            note=f"damping ratios of {len(damped)} modes",
            largest=max(ratios),
            figures=3,
        )


def _damping_ratio(pair: ModePair) -> float:
    """Return the measured damping ratio over that of the case."""
    assert pair.measured is not None  # as of all pairs
    return pair.measured.damping_ratio.value / pair.damping_ratio


def octave_blocks(criteria: Criteria, compared: str) -> tuple[Table, Note]:
    """Return the table of octaves with its note: the criterion of each record over each octave,
    and over the whole band; `compared`: of what it is.
    """
    headings = ["Band", *(visible(sensor.name) for sensor in criteria.sensors)]
    low, high = criteria.band
    rows = [[f"{low:.5g} to {high:.5g} Hz, whole", *(f"{frac:.3f}" for frac in criteria.frac)]]
    for (low, high), fracs in zip(criteria.octaves, criteria.octave_frac.T, strict=True):
        rows.append([f"{low:.5g} to {high:.5g} Hz", *map(_frac_cell, fracs)])
    note = Note(
        f"FRAC of {compared}: the frequency response assurance criterion, 1 where they are equal "
        "except for a factor."
    )
    return table_of(headings, rows), note


def modes_section(modes: Sequence[ModePair], explanation: str) -> Section:
    """Return the section on the modes: their table, and the damping to be put into the case."""
    blocks: list[Block] = [table_of(*mode_cells(modes), TEXTS)]
    if damping := damping_field(modes):
        lead = "In [plate] of the case, the measured damping is"
        blocks.append(Code("damping", lead, damping, is_short=True))
    blocks.append(Explanation(explanation))
    return Section("modes", "Modes", blocks)


def _frac_cell(frac: float) -> str:
    return MISSING if np.isnan(frac) else f"{frac:.3f}"


def polarity_cell(polarity: float) -> str:
    """Return how a record is positive beside its simulation; `polarity` is 1 or -1."""
    return "inverted" if polarity < 0.0 else "as simulated"


def known_or_none(values: Floats) -> list[float | None]:
    """Return numbers as JSON can hold them: None for NaN, of what is not known."""
    return [None if np.isnan(value) else float(value) for value in values]


def mode_cells(modes: Sequence[ModePair]) -> tuple[list[str], list[list[str]]]:
    """Return headers and rows of the table of modes."""
    return without_blank_remarks(MODE_HEADERS, [mode_row(pair) for pair in modes])


def without_blank_remarks(
    headers: Sequence[str], rows: Sequence[Sequence[str]]
) -> tuple[list[str], list[list[str]]]:
    """Return headers and rows of a table whose last column has remarks, without that if
    there is none.
    """
    kept = len(headers)
    if not any(row[-1] for row in rows):
        kept -= 1
    return list(headers[:kept]), [list(row[:kept]) for row in rows]


def mode_row(pair: ModePair) -> list[str]:
    """Return the cells of a mode in its table."""
    number = MISSING
    computed = MISSING
    ratio = MISSING
    difference = MISSING
    if pair.number is not None:
        number = str(pair.number)
        computed = digits(pair.frequency, 5)
        ratio = digits(pair.damping_ratio, 5)
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
    if mode.doubt:
        damping = [MISSING] * 3
    else:
        ratio_and_ends = (mode.damping_ratio.value, *mode.damping_ratio.interval)
        damping = [digits(value, 4) for value in ratio_and_ends]
    if pair.number is not None:
        difference = signed(100.0 * pair.frequency_difference)
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


def mode_table(criteria: Criteria) -> list[dict[str, Any]]:
    """Return the modes as rows of `MODE_COLUMNS`; None where there is no number."""
    return [mode_record(pair) for pair in criteria.modes]


def mode_record(pair: ModePair) -> dict[str, Any]:
    """Return a mode as a row of `MODE_COLUMNS`."""
    return dict(zip(MODE_COLUMNS, _mode_values(pair), strict=True))


def _mode_values(pair: ModePair) -> list[Any]:
    of_case: list[Any] = 3 * [None]
    if pair.number is not None:
        of_case = [pair.frequency, pair.damping_ratio, pair.response]
    measured: list[Any] = 6 * [None]
    if pair.measured is not None:
        frequency = pair.measured.frequency
        ratio = pair.measured.damping_ratio
        measured = [frequency.value, *frequency.interval, ratio.value, *ratio.interval]
    return [pair.number, *of_case, *measured, pair.damping_measured, pair.remark]
