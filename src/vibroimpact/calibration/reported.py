"""The report of a calibration, of whichever kind it is."""

from __future__ import annotations

from vibroimpact.calibration.adams_dialog import calibrated_dialog, dialog_cells
from vibroimpact.calibration.calibrate_case import calibrated_case
from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.charts import calibration_charts
from vibroimpact.calibration.file_contents import calibration_table, comparison_rows
from vibroimpact.calibration.friction.calibrate import FrictionCalibration
from vibroimpact.calibration.friction.tables import (
    friction_document,
    friction_sentences,
    friction_table,
    friction_words,
    given_values_sentences,
    together_words,
)
from vibroimpact.calibration.report import CalibrationReport
from vibroimpact.calibration.tables import (
    differences_tables,
    fit_sentences,
    function_words,
    given_sentences,
    match_words,
    values_table,
    ways_words,
)
from vibroimpact.cases.case import Case


def report_of(case: Case, found: Calibration | FrictionCalibration) -> CalibrationReport:
    """Return the report of a calibration.

    Parameters
    ----------
    case : Case
        The calibrated case.
    found : Calibration or FrictionCalibration
        Result of its calibration.
    """
    if isinstance(found, FrictionCalibration):
        document = friction_document(case, found)
        return CalibrationReport(
            law=f"friction by {found.parameters.law.name}",
            parameter=", ".join(found.names),
            matched=together_words(found),
            function=friction_words(found),
            fit=friction_sentences(found),
            given=given_values_sentences(found),
            values=friction_table(found),
            differences={},
            ways="",
            charts=calibration_charts(found),
            doubts=found.doubts,
            document=document,
            tables={"matched": document["matched"]},
            calibrated=calibrated_case(case, found),
        )
    dialog, document = calibrated_dialog(found), calibration_table(case, found)
    return CalibrationReport(
        law=case.contact.law,
        parameter=found.parameter,
        matched=match_words(found),
        function=function_words(found),
        fit=fit_sentences(found),
        given=given_sentences(found),
        values=values_table(found),
        dialog=dialog_cells(dialog, found.observations.labels) if dialog else None,
        differences=differences_tables(found),
        ways=ways_words(found),
        charts=calibration_charts(found),
        doubts=found.doubts,
        document=document,
        tables={"matched": document["matched"], "comparison": comparison_rows(found)},
        calibrated=calibrated_case(case, found),
    )
