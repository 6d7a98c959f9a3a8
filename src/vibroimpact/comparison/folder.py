"""Writes a comparison of contact laws as a folder: data, figures and report."""

from __future__ import annotations

import json
from os import PathLike
from pathlib import Path

import tomli_w

from vibroimpact._version import __version__
from vibroimpact.comparison.comparison import (
    Comparison,
    comparison_doubts,
    comparison_subtitle,
    comparison_table,
    comparison_title,
    free_parameter_words,
)
from vibroimpact.comparison.figures import draw_comparison
from vibroimpact.dynamics.columns import impact_columns
from vibroimpact.report.figure_files import save_figures
from vibroimpact.report.page import picture, template
from vibroimpact.results.csv_files import impact_rows, write_csv
from vibroimpact.results.folder import SUMMARY, new_folder

_TITLES = {
    "position": ("Position", "The sphere's centre above the plate, under each law."),
    "force": ("Contact force of the first impact", "Time counts from first touch."),
    "force_indentation": (
        "Force over indentation of the first impact",
        "The area that a loop encloses is the energy lost. Laws without a force are not shown.",
    ),
    "restitution": (
        "Restitution achieved",
        "Lines: each law with the parameters of its first impact, on fresh surfaces and without gravity. Marks: the impacts of "
        "the run; under a law whose dent lasts those after the first lie above its line.",
    ),
}


def save_comparison(comparison: Comparison, directory: str | PathLike[str], *, force: bool = False) -> Path:
    """Write a comparison atomically: `comparison.csv`, `summary.json`, the cases, figures and a report.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing result folder.

    Raises
    ------
    InputError
        If the folder exists and may not be replaced, or it can't be written to.
    """
    with new_folder(directory, force=force) as folder:
        rows = [{"law": name, **row} for name, one in comparison.results.items() for row in impact_rows(one.impacts)]
        columns = impact_columns(name for one in comparison.results.values() for name in one.impacts)
        write_csv(rows, ["law", *columns], folder / "comparison.csv")
        laws = {
            name: {"status": one.status, "impacts": impact_rows(one.impacts), "energy": one.energy, "doubts": one.doubts}
            for name, one in comparison.results.items()
        }
        summary = {"name": comparison.name, "version": __version__, "laws": laws}
        (folder / SUMMARY).write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")
        (folder / "cases").mkdir()
        for name, one in comparison.results.items():
            (folder / "cases" / f"{name}.toml").write_text(tomli_w.dumps(one.case), encoding="utf-8")
        (folder / "figures").mkdir()
        drawn = draw_comparison(comparison.results, comparison.speeds, comparison.restitutions)
        pictures = save_figures(drawn, folder / "figures")
        headers, cells = comparison_table(comparison)
        page = template(__package__).render(
            name=comparison_title(comparison),
            subtitle=comparison_subtitle(comparison),
            headers=headers,
            rows=cells,
            free=[(name, free_parameter_words(law)) for name, law in comparison.laws.items()],
            results=comparison.results,
            doubts=comparison_doubts(comparison),
            pictures=[picture(name, *_TITLES[name], svg) for name, svg in pictures.items()],
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
