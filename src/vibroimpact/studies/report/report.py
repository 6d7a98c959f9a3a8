"""What a study tells: how its results are distributed and what they depend on, with charts."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from vibroimpact.report.report import (
    Block,
    Code,
    Facts,
    Note,
    Paragraph,
    Report,
    Section,
)
from vibroimpact.results.csv_files import write_csv
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.computation.study_folder import study_toml
from vibroimpact.studies.planning.design import find_design
from vibroimpact.studies.report.answer import FEW_DROPS, answer_of
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.card import CARD, data_card
from vibroimpact.studies.report.charts import study_charts
from vibroimpact.studies.report.outputs import Output, drawn_outputs, study_outputs
from vibroimpact.studies.report.restitution import restitution_sentence, summarize_restitution
from vibroimpact.studies.report.sensitivity_table import Sensitivity, informative_sensitivity
from vibroimpact.studies.report.short_section import short_section
from vibroimpact.studies.report.tables import (
    COUNTED_FROM,
    PERCENTILE_COLUMNS,
    axes_table,
    counts_sentence,
    doubt_sentences,
    failures_table,
    percentiles_rows,
    percentiles_table,
    points_table,
    reason_sentences,
    reasons,
    sensitivity_rows,
    sensitivity_table,
    sensitivity_words,
    spread_words,
    without_effect,
)

SPREADS = "percentiles.csv"
SENSITIVITY = "sensitivity.csv"


def report_of(study: Study) -> Report:
    """Return the report of a study.

    Its files are `percentiles.csv`, `sensitivity.csv` if there are sensitivities, and `card.md` of
    a population.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory").to_problem().source
    >>> sweep = vi.studies.sweep_of({**case, "sweep": {"over": {"drop.height": ["1 m", "2 m"]}}})
    >>> with TemporaryDirectory() as folder:
    ...     report = report_of(
    ...         vi.studies.load_study(vi.studies.run_sweep(sweep, f"{folder}/heights"))
    ...     )
    >>> report.answer, list(report.files), [chart.name for chart in report.charts]
    ('2 drops; none failed.', ['percentiles.csv', 'sensitivity.csv'], ['curves', 'restitution'])
    """
    outputs = study_outputs(study)
    sensitivity = informative_sensitivity(study, outputs)
    restitution = restitution_sentence(summarize_restitution(study))
    files = {SPREADS: partial(_write_percentiles, outputs)}
    if sensitivity is not None and sensitivity.rows:
        files[SENSITIVITY] = partial(_write_sensitivity, sensitivity)
    if study.labels:
        files[CARD] = partial(_write_card, study)
    return Report(
        title=study.name,
        answer=counts_sentence(study),
        quantities=answer_of(study, outputs, sensitivity),
        has_failed=len(study.failures) == study.size,
        sentences=[restitution] if restitution else [],
        sections=_sections(study, outputs, sensitivity),
        charts=study_charts(study, outputs, sensitivity),
        above_charts="The label of a point gives the number of its drop in drops.csv, and the "
        "command that runs it alone; a click shows the command below, to be copied.",
        commands="In the study's folder",
        warnings=doubt_sentences(study),
        warnings_note=COUNTED_FROM,
        files=files,
        summary=study_document(study, outputs, sensitivity),
        version=study.version,
        provenance="all results of all drops are in study.nc.",
    )


def _sections(
    study: Study, outputs: list[Output], sensitivity: Sensitivity | None
) -> list[Section]:
    """Return keys, failures, distribution and sensitivity, each if there are any, and the file; a
    terminal shows the main results in their place.
    """
    sections = [_swept_section(study)]
    if study.failures:
        sections.append(_failures_section(study))
    distribution = _distribution_section(study, outputs)
    if distribution is not None:
        sections.append(distribution)
    if sensitivity is not None:
        influence = _sensitivity_section(sensitivity, drawn_outputs(outputs))
        if influence is not None:
            sections.append(influence)
    # why there is no sensitivity is told all the same
    notes = []
    if sensitivity is not None:
        notes = [Note(note) for note in sensitivity.notes]
    if study.design == "zip":
        notes.append(
            Note("The keys of a zip change together, so that their effects can't be separated.")
        )
    last = sections[-1]
    sections[-1] = replace(last, blocks=(*last.blocks, *notes))
    return [*sections, _study_section(study), short_section(study, outputs)]


def _swept_section(study: Study) -> Section:
    design = f"Design {study.design}: {find_design(study.design).meaning}."
    axes = Facts(axes_table(study, study_axes(study)))
    return Section("swept", "Swept keys", (Paragraph(design), axes), medium="page")


def _failures_section(study: Study) -> Section:
    """Return why drops failed, and the first of them."""
    table = failures_table(study)
    shown = len(table.columns[0].cells)
    failed = len(study.failures)
    which = "Drops"
    if shown < failed:
        which = f"The first {shown} of {failed}; drops"
    numbering = f"{which} are numbered from 0, as in drops.csv. All reasons are in study.nc."
    blocks: list[Block] = [Paragraph(reason) for reason in reason_sentences(study)]
    blocks += [table, Note(numbering)]
    return Section("failures", "Drops that failed", blocks, medium="page")


def _distribution_section(study: Study, outputs: list[Output]) -> Section | None:
    """Return how the results are distributed, of few drops each of them; None without a value of
    any.
    """
    if study.size <= FEW_DROPS:
        return _points_section(study, outputs)
    table = percentiles_table(outputs)
    if not table.columns[0].cells:
        return None
    note = f"In SI with all digits: percentiles.csv.{_left_out_words(outputs)}"
    blocks = (Paragraph(spread_words(study)), table, Note(note))
    return Section("spread", "Distribution of the results", blocks, medium="page")


def _points_section(study: Study, outputs: list[Output]) -> Section | None:
    """Return the results of each drop; None without a value of any."""
    table = points_table(study, outputs)
    if table is None:
        return None
    note = f"Further results, and all digits in SI: drops.csv.{_left_out_words(outputs)}"
    return Section("spread", "Results of the drops", (table, Note(note)), medium="page")


def _left_out_words(outputs: list[Output]) -> str:
    """Return sentences on the results that tables leave out, as they have nothing to show."""
    left_out = {
        "Zero in all drops": [output for output in outputs if output.is_zero],
        "Without a value in any drop": [
            output for output in outputs if not output.spread.drops and not output.is_sensor_reading
        ],
    }
    sentences = ""
    for reason, results in left_out.items():
        if results:
            sentences += f" {reason}: {', '.join(output.title for output in results).lower()}."
    return sentences


def _sensitivity_section(sensitivity: Sensitivity, drawn: list[Output]) -> Section | None:
    """Return on which keys the results depend; None if no key has an effect."""
    table = sensitivity_table(sensitivity, drawn)
    if not table.columns[0].cells:
        return None
    note = "With all digits, and of further results: sensitivity.csv."
    idle = without_effect(sensitivity, drawn)
    if idle:
        note = (
            "Left out, as all their numbers are missing or zero once rounded: "
            f"{', '.join(idle)}. {note}"
        )
    blocks = (Paragraph(sensitivity_words(sensitivity)), table, Note(note))
    return Section("matters", "Sensitivity", blocks, medium="page")


def _study_section(study: Study) -> Section:
    lead = (
        "The study file; plain numbers are in SI units. To run it again: vibroimpact sweep "
        "study.toml -o another-folder."
    )
    text = Code("study", lead, study_toml(study.table))
    return Section("study", "Study", (text,), after_charts=True, medium="page")


def _write_percentiles(outputs: list[Output], path: Path) -> None:
    write_csv(percentiles_rows(outputs), PERCENTILE_COLUMNS, path)


def _write_sensitivity(sensitivity: Sensitivity, path: Path) -> None:
    rows = sensitivity_rows(sensitivity)
    write_csv(rows, list(rows[0]), path)


def _write_card(study: Study, path: Path) -> None:
    path.write_text(data_card(study), encoding="utf-8")


def study_document(
    study: Study, outputs: list[Output], sensitivity: Sensitivity | None
) -> dict[str, Any]:
    """Return the outcome of a study: the rows of `percentiles.csv` and `sensitivity.csv`,
    failures, exceeded limits and doubts.
    """
    rows = []
    if sensitivity is not None:
        rows = sensitivity_rows(sensitivity)
    return {
        "name": study.name,
        "version": study.version,
        "study": {"design": study.design, "drops": study.size, "failed": len(study.failures)},
        "reasons": [{"drops": number, "reason": reason} for number, reason in reasons(study)],
        "percentiles": percentiles_rows(outputs),
        "sensitivity": rows,
        "limits": [limit._asdict() for limit in study.doubts],
        "doubts": doubt_sentences(study),
    }
