"""A study as data: the numbers of drops, the tables of the report, and the doubts."""

from __future__ import annotations

from typing import Any

from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.outputs import Output
from vibroimpact.studies.report.sensitivity_table import Sensitivity
from vibroimpact.studies.report.tables import (
    doubt_sentences,
    percentiles_rows,
    reasons,
    sensitivity_rows,
)


def study_document(
    study: Study, outputs: list[Output], sensitivity: Sensitivity | None
) -> dict[str, Any]:
    """Return the outcome of a study: the rows of `percentiles.csv` and `sensitivity.csv`,
    failures, exceeded limits and doubts.
    """
    return {
        "name": study.name,
        "version": study.version,
        "study": {"design": study.design, "drops": study.size, "failed": len(study.failures)},
        "reasons": [{"drops": number, "reason": reason} for number, reason in reasons(study)],
        "percentiles": percentiles_rows(outputs),
        "sensitivity": [] if sensitivity is None else sensitivity_rows(sensitivity),
        "limits": [limit._asdict() for limit in study.doubts],
        "doubts": doubt_sentences(study),
    }
