"""What `sweep --json` prints: the numbers of drops, the tables of the report, and the doubts."""

from __future__ import annotations

from typing import Any

from vibroimpact.studies.report.outputs import study_outputs
from vibroimpact.studies.report.sensitivity_table import informative_sensitivity
from vibroimpact.studies.report.tables import (
    doubt_sentences,
    percentiles_rows,
    reasons,
    sensitivity_rows,
)
from vibroimpact.studies.study import Study


def study_document(study: Study) -> dict[str, Any]:
    """Return the outcome of a study: the rows of `percentiles.csv` and `sensitivity.csv`,
    failures, exceeded limits and doubts.
    """
    outputs = study_outputs(study)
    found = informative_sensitivity(study, outputs)
    return {
        "name": study.name,
        "version": study.version,
        "study": {"design": study.design, "drops": study.size, "failed": len(study.failures)},
        "reasons": [{"drops": number, "reason": words} for number, words in reasons(study)],
        "percentiles": percentiles_rows(outputs),
        "sensitivity": sensitivity_rows(found) if found is not None else [],
        "limits": [one._asdict() for one in study.doubts],
        "doubts": doubt_sentences(study),
    }
