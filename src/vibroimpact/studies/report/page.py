"""Write the report of a study: tables of percentiles and sensitivity, and the page with
its charts.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

from vibroimpact.report.page import render_page, replace_report_files
from vibroimpact.results.csv_files import write_csv
from vibroimpact.studies.design import find_design
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.card import CARD, data_card
from vibroimpact.studies.report.charts import study_charts
from vibroimpact.studies.report.labels import drops_text
from vibroimpact.studies.report.outputs import Output, drawn_outputs, study_outputs
from vibroimpact.studies.report.restitution import restitution_sentence, summarize_restitution
from vibroimpact.studies.report.sensitivity_table import Sensitivity, informative_sensitivity
from vibroimpact.studies.report.tables import (
    COUNTED_FROM,
    PERCENTILE_COLUMNS,
    axes_table,
    counts_sentence,
    doubt_sentences,
    failures_table,
    percentiles_rows,
    percentiles_table,
    reasons,
    sensitivity_rows,
    sensitivity_table,
    sensitivity_words,
    spread_words,
    without_effect,
)
from vibroimpact.studies.study import Study
from vibroimpact.studies.study_folder import study_toml

PAGE, SPREADS, SENSITIVITY = "report.html", "percentiles.csv", "sensitivity.csv"


def write_study_report(study: Study, folder: Path) -> None:
    """Write `percentiles.csv`, `sensitivity.csv` if there are sensitivities, `card.md` of a
    population, and `report.html`.

    All files are written to a temporary folder and then moved into place one by one.

    Parameters
    ----------
    study : Study
        The completed study.
    folder : pathlib.Path
        Folder of the study.

    Raises
    ------
    InputError
        If the folder can't be written.
    """
    replace_report_files(folder, partial(_write, study), stale=(SENSITIVITY, CARD))


def _write(study: Study, folder: Path) -> None:
    outputs = study_outputs(study)
    found = informative_sensitivity(study, outputs)
    write_csv(percentiles_rows(outputs), PERCENTILE_COLUMNS, folder / SPREADS)
    if found is not None and found.rows:
        table = sensitivity_rows(found)
        write_csv(table, list(table[0]), folder / SENSITIVITY)
    if study.labels:
        (folder / CARD).write_text(data_card(study), encoding="utf-8")
    (folder / PAGE).write_text(_page(study, outputs, found), encoding="utf-8")


def _page(study: Study, outputs: list[Output], found: Sensitivity | None) -> str:
    charts = study_charts(study, outputs, found)
    table = (
        sensitivity_table(found, drawn_outputs(outputs))
        if found is not None and found.rows
        else None
    )
    return render_page(
        __package__,
        charts,
        name=study.name[:1].upper() + study.name[1:],
        shown=[chart.name for chart in charts],
        counts=counts_sentence(study),
        failed=len(study.failures) == study.size,
        restitution=restitution_sentence(summarize_restitution(study)),
        doubts=doubt_sentences(study),
        counted_from=COUNTED_FROM,
        design=f"{study.design}: {find_design(study.design).meaning}",
        axes=axes_table(study, study_axes(study)),
        reasons=[
            (f"{drops_text(number)}{', such as' if number > 1 else ''}", words)
            for number, words in reasons(study)
        ],
        failures=failures_table(study) if study.failures else None,
        failed_drops=len(study.failures),
        spread_words=spread_words(study),
        percentiles=percentiles_table(outputs),
        without=[
            one.title for one in outputs if not one.spread.drops and not one.is_sensor_reading
        ],
        zero=[one.title for one in outputs if one.is_zero],
        sensitivity=table if table and table[1] else None,
        sensitivity_words=sensitivity_words(found) if table and found is not None else "",
        without_effect=without_effect(found, drawn_outputs(outputs))
        if table and found is not None
        else [],
        notes=found.notes if found is not None else [],
        together=study.design == "zip",
        study=study_toml(study.table),
        version=study.version,
    )
