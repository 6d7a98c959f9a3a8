"""What the calibration of a case tells: the values found, how well they meet the target, charts."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from vibroimpact._version import __version__
from vibroimpact.arrays import Floats
from vibroimpact.calibration.charts import calibration_charts
from vibroimpact.calibration.contact_law.adams_dialog import (
    calibrated_dialog,
    dialog_note,
    dialog_table,
)
from vibroimpact.calibration.contact_law.calibration import Calibration, case_name
from vibroimpact.calibration.contact_law.file_contents import (
    CALIBRATION,
    calibration_table,
    columns_of,
    comparison_rows,
)
from vibroimpact.calibration.contact_law.law_report import (
    differences_tables,
    fit_sentences,
    function_words,
    given_sentences,
    match_words,
    values_table,
    ways_words,
)
from vibroimpact.calibration.friction.calibrate import FrictionCalibration
from vibroimpact.calibration.friction.friction_report import (
    friction_document,
    friction_sentences,
    friction_table,
    friction_words,
    given_values_sentences,
    together_words,
)
from vibroimpact.calibration.observed.observations import impact_label
from vibroimpact.cases.build import resolved_case
from vibroimpact.files.check_sums import CHECK_SUMS, digests_of, sealed
from vibroimpact.files.result_folder import CASE, write_case
from vibroimpact.report.report import Block, Code, Explanation, Note, Quantity, Report, Section
from vibroimpact.results.csv_files import write_csv

_MOST_VALUES = 6
"""Values of a parameter that the answer states; a table below has all."""


def report_of(calibration: Calibration | FrictionCalibration) -> Report:
    """Return the report of a calibration.

    The folder has `calibration.json`, `matched.csv`, of contact laws `comparison.csv`, and of a
    case `case.toml`: the case with the calibrated values, ready to run.

    Parameters
    ----------
    calibration : Calibration or FrictionCalibration
        The calibration.
    """
    if isinstance(calibration, FrictionCalibration):
        return _friction_report(calibration)
    return _law_report(calibration)


def _law_report(calibration: Calibration) -> Report:
    """Return the report of the calibration of a parameter of a contact law."""
    document = calibration_table(calibration)
    comparison = comparison_rows(calibration)
    impacts: list[Block] = [values_table(calibration)]
    if dialog := calibrated_dialog(calibration):
        impacts.append(dialog_table(dialog, calibration.observations.labels))
        if len(dialog) > 1:
            impacts.append(Note(dialog_note(calibration.parameter)))
    sections = [Section("impacts", "Impact by impact", impacts)]
    if tables := differences_tables(calibration):
        ways = ways_words(calibration)
        note = Note(f"Differences from the target, with {ways}.")
        values = Explanation("All values are in comparison.csv.")
        sections.append(Section("wrong", "Remaining differences", [*tables, note, values]))
    return _report(
        calibration,
        answer=function_words(calibration),
        matched=f"With {calibration.problem.laws[0].name}, {match_words(calibration)}.",
        sentences=[*given_sentences(calibration), *fit_sentences(calibration)],
        quantities=_law_quantities(calibration),
        sections=sections,
        parameter=calibration.parameter,
        document=document,
        tables={"matched": document["matched"], "comparison": comparison},
    )


def _law_quantities(calibration: Calibration) -> list[Quantity]:
    """Return the values to type: one for every impact, or one for each of the first ones."""
    values = calibration.values
    number = min(len(values), _MOST_VALUES)
    notes = [impact_label(calibration.observations, impact) for impact in range(number)]
    if np.ptp(values) == 0.0:
        notes = ["for every impact"]
        number = 1
    dialog = calibrated_dialog(calibration)
    if len(dialog) >= number and calibration.parameter == "damping_max":
        notes = [
            f"{note}; {row['damping_N_s_mm']:.4g} N s/mm in Adams' dialog"
            for note, row in zip(notes, dialog, strict=False)
        ]
    return [
        Quantity(
            calibration.parameter,
            float(values[impact]),
            calibration.unit,
            _relative_error(values, calibration.intervals, impact),
            notes[impact],
        )
        for impact in range(number)
    ]


def _friction_quantities(calibration: FrictionCalibration) -> list[Quantity]:
    """Return the values of friction to type."""
    return [
        Quantity(
            name,
            float(calibration.values[number]),
            calibration.parameters.units[number],
            _relative_error(calibration.values, calibration.intervals, number),
        )
        for number, name in enumerate(calibration.names)
    ]


def _relative_error(values: Floats, intervals: Floats | None, number: int) -> float:
    """Return half the interval of a value over it; NaN if it has none that is bounded."""
    if intervals is None or not values[number]:
        return math.nan
    half = 0.5 * float(np.ptp(intervals[number])) / abs(float(values[number]))
    return half if math.isfinite(half) else math.nan


def _friction_report(calibration: FrictionCalibration) -> Report:
    """Return the report of a calibration of friction."""
    document = friction_document(calibration)
    law = calibration.parameters.law.name
    impacts = Section("impacts", "Impact by impact", (friction_table(calibration),))
    return _report(
        calibration,
        answer=friction_words(calibration),
        matched=f"With friction by {law}, {together_words(calibration)}.",
        sentences=[*given_values_sentences(calibration), *friction_sentences(calibration)],
        quantities=_friction_quantities(calibration),
        sections=[impacts],
        parameter=", ".join(calibration.names),
        document=document,
        tables={"matched": document["matched"]},
    )


def _report(
    calibration: Calibration | FrictionCalibration,
    *,
    answer: str,
    matched: str,
    sentences: Sequence[str],
    quantities: Sequence[Quantity],
    sections: Sequence[Section],
    parameter: str,
    document: Mapping[str, Any],
    tables: Mapping[str, Sequence[Mapping[str, Any]]],
) -> Report:
    """Return a report with what calibrations of laws and of friction have in common."""
    case = calibration.problem.source
    name = case_name(calibration.problem)
    title = name or "a drop"
    sections = list(sections)
    files: dict[str, Callable[[Path], object]] = {}
    if case:
        lead = "As it was given; the calibrated one is case.toml, beside this page."
        code = Code("case", lead, tomli_w.dumps(case))
        sections.append(Section("case", "Case", (code,), after_charts=True))
        files[CASE] = partial(write_case, resolved_case(calibration.calibrated_case))
    files[CALIBRATION] = partial(_write_calibration, document)
    for table, rows in tables.items():
        files[f"{table}.csv"] = partial(_write_rows, rows)
    return Report(
        title=f"{title[:1].upper()}{title[1:]}, calibrated",
        answer=answer,
        quantities=quantities,
        sentences=[matched, *sentences],
        sections=sections,
        charts=calibration_charts(calibration),
        warnings=calibration.doubts,
        files=files,
        summary={"name": name, "version": __version__, "calibration": parameter},
        data={**document, **tables},
    )


def _write_calibration(document: Mapping[str, Any], path: Path) -> None:
    """Write the calibration with its checksum, and that of the case beside it if there is one."""
    path.write_bytes(sealed({**document, CHECK_SUMS: digests_of(path.parent, (CASE,))}))


def _write_rows(rows: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write a table."""
    write_csv(list(map(dict, rows)), columns_of(rows), path)
