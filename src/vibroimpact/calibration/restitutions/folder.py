"""Write the folder of measured restitutions: data and the report page, and figures where
they are asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from vibroimpact._version import __version__
from vibroimpact.calibration.bounces.charts import restitution_chart
from vibroimpact.calibration.bounces.tables import law_sentences
from vibroimpact.calibration.restitutions.document import restitution_document, restitution_rows
from vibroimpact.calibration.restitutions.restitutions import Restitutions
from vibroimpact.calibration.restitutions.text import (
    case_sentence,
    noise_sentence,
    restitution_cells,
    status_sentence,
)
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.charts.made import made_charts
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import new_folder, write_summary


def save_restitutions(
    found: Restitutions,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write `restitutions.csv`, `summary.json` and `report.html` into a new folder, atomically.

    Parameters
    ----------
    found : Restitutions
        The restitutions, as `read_restitutions` returns them.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing folder.
    figures : sequence of str
        Formats in which the chart is also written as a file, into a folder `figures`: of "png",
        "svg" and "pdf".

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError
        If the folder exists already, or can't be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "ev.csv")
    ...     _ = file.write_text("speed [m/s],restitution\\n1,0.81\\n2,0.78\\n4,0.74\\n")
    ...     sorted(
    ...         one.name
    ...         for one in vi.save_restitutions(
    ...             vi.read_restitutions(file), f"{folder}/found"
    ...         ).iterdir()
    ...     )
    ['report.html', 'restitutions.csv', 'summary.json']
    """
    rows, charts = (
        restitution_rows(found),
        made_charts({"restitution": lambda: restitution_chart(found)}),
    )
    with new_folder(directory, force=force) as folder:
        write_csv(rows, list(rows[0]), folder / "restitutions.csv")
        write_summary(restitution_document(found), folder)
        write_figures(charts, folder, figures)
        headers, cells = restitution_cells(found)
        page = render_page(
            __package__,
            charts,
            name=Path(found.source).name,
            status=status_sentence(found),
            fits=[
                sentence for sentence in (*law_sentences(found), case_sentence(found)) if sentence
            ],
            doubts=found.doubts,
            headers=headers,
            rows=cells,
            notes=[noise_sentence(found)],
            source=found.source,
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
