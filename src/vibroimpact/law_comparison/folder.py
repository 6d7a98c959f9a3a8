"""Writes a comparison of contact laws as a folder: data and report, and figures where
they are asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import tomli_w

from vibroimpact._version import __version__
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.dynamics.columns import impact_columns
from vibroimpact.law_comparison.charts import comparison_charts
from vibroimpact.law_comparison.comparison import (
    Comparison,
    comparison_doubts,
    comparison_subtitle,
    comparison_table,
    comparison_title,
    free_parameter_words,
)
from vibroimpact.law_comparison.document import summary_of_comparison
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import impact_rows, write_csv
from vibroimpact.results.folder import new_folder, write_summary


def save_comparison(
    comparison: Comparison,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write a comparison atomically: `comparison.csv`, `summary.json`, the cases and a report.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing result folder.
    figures : sequence of str
        Formats in which the charts are also written as files, into a folder `figures`: of "png",
        "svg" and "pdf".

    Raises
    ------
    InputError
        If the folder exists and may not be replaced, or it can't be written to.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> comparison = vi.compare_laws(vi.load_case("paper:type1-theory"), ["tsuji", "flores"])
    >>> with TemporaryDirectory() as folder:
    ...     sorted(
    ...         file.name for file in vi.save_comparison(comparison, f"{folder}/compared").iterdir()
    ...     )
    ['cases', 'comparison.csv', 'report.html', 'summary.json']
    """
    with new_folder(directory, force=force) as folder:
        rows = [
            {"law": name, **row}
            for name, one in comparison.results.items()
            for row in impact_rows(one.impacts)
        ]
        columns = impact_columns(
            name for one in comparison.results.values() for name in one.impacts
        )
        write_csv(rows, ["law", *columns], folder / "comparison.csv")
        write_summary(summary_of_comparison(comparison), folder)
        (folder / "cases").mkdir()
        for name, one in comparison.results.items():
            (folder / "cases" / f"{name}.toml").write_text(
                tomli_w.dumps(one.case), encoding="utf-8"
            )
        charts = comparison_charts(comparison)
        write_figures(charts, folder, figures)
        headers, cells = comparison_table(comparison)
        page = render_page(
            __package__,
            charts,
            name=comparison_title(comparison),
            subtitle=comparison_subtitle(comparison),
            headers=headers,
            rows=cells,
            free=[
                (name, free_parameter_words(law), comparison.results[name].status)
                for name, law in comparison.laws.items()
            ],
            doubts=comparison_doubts(comparison),
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
