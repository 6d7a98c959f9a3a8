"""Write the report of a study: figures, tables of percentiles and sensitivity, and the page."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from vibroimpact.report.figure_files import save_figures
from vibroimpact.report.page import Picture, picture, replace_report_files, template
from vibroimpact.results.csv_files import write_csv
from vibroimpact.studies.design import find_design
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.figures import draw, study_figures
from vibroimpact.studies.report.labels import drops_text
from vibroimpact.studies.report.outputs import Output, drawn_outputs, study_outputs
from vibroimpact.studies.report.restitution import restitution_sentence, summarize_restitution
from vibroimpact.studies.report.sensitivity import Sensitivity, sensitivity_of
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
)
from vibroimpact.studies.study import Study
from vibroimpact.studies.study_folder import study_toml

PAGE, FIGURES, SPREADS, SENSITIVITY = "report.html", "figures", "percentiles.csv", "sensitivity.csv"


def write_study_report(study: Study, folder: Path) -> None:
    """Write figures, `percentiles.csv`, `sensitivity.csv` if there are sensitivities, and `report.html`.

    All files are written to a temporary folder and then moved into place one by one; obsolete figures are removed.

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
    replace_report_files(folder, partial(_write, study), stale=(SENSITIVITY, f"{FIGURES}/*.*"))


def _write(study: Study, folder: Path) -> None:
    (folder / FIGURES).mkdir()
    outputs = study_outputs(study)
    found = sensitivity_of(study, [one for one in outputs if one.is_informative])
    write_csv(percentiles_rows(outputs), PERCENTILE_COLUMNS, folder / SPREADS)
    if found is not None and found.rows:
        table = sensitivity_rows(found)
        write_csv(table, list(table[0]), folder / SENSITIVITY)
    (folder / PAGE).write_text(_page(study, outputs, found, _pictures(study, outputs, found, folder)), encoding="utf-8")


def _pictures(study: Study, outputs: list[Output], found: Sensitivity | None, folder: Path) -> list[Picture]:
    """Draw and save the figures one by one, so that only one is in memory."""
    pictures = []
    for name, one in study_figures(study, outputs, found).items():
        figure = draw(one)
        if figure is not None:
            svg = save_figures({name: figure}, folder / FIGURES)[name]
            pictures.append(picture(name, one.title, one.caption, svg))
    return pictures


def _page(study: Study, outputs: list[Output], found: Sensitivity | None, pictures: list[Picture]) -> str:
    table = sensitivity_table(found, drawn_outputs(outputs)) if found is not None and found.rows else None
    return template(__package__).render(
        name=study.name[:1].upper() + study.name[1:],
        counts=counts_sentence(study),
        failed=len(study.failures) == study.size,
        restitution=restitution_sentence(summarize_restitution(study)),
        doubts=doubt_sentences(study),
        counted_from=COUNTED_FROM,
        design=f"{study.design}: {find_design(study.design).meaning}",
        axes=axes_table(study, study_axes(study)),
        reasons=[(f"{drops_text(number)}{', such as' if number > 1 else ''}", words) for number, words in reasons(study)],
        failures=failures_table(study) if study.failures else None,
        spread_words=spread_words(study),
        percentiles=percentiles_table(outputs),
        without=[one.title for one in outputs if not one.spread.drops and not one.is_sensor_reading],
        sensitivity=table,
        sensitivity_words=sensitivity_words(found) if table and found is not None else "",
        notes=found.notes if found is not None else [],
        together=study.design == "zip",
        pictures=pictures,
        study=study_toml(study.table),
        version=study.version,
    )
