"""Write the folder of a record of bounces: data and the report page, and figures where
they are asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from vibroimpact._version import __version__
from vibroimpact.calibration.bounces.charts import bounce_charts
from vibroimpact.calibration.bounces.document import bounce_document, bounce_rows
from vibroimpact.calibration.bounces.rebounds import Rebounds
from vibroimpact.calibration.bounces.tables import (
    contact_sentence,
    drop_sentence,
    impact_cells,
    law_sentences,
    other_sentences,
)
from vibroimpact.calibration.inputs import inputs_sentence
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import new_folder, write_summary


def save_rebounds(
    found: Rebounds,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write `bounces.csv`, `summary.json` and `report.html` into a new folder, atomically.

    Parameters
    ----------
    found : Rebounds
        The impacts, as `rebounds_of` returns them.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing folder.
    figures : sequence of str
        Formats in which the charts are also written as files, into a folder `figures`: of "png",
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
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> microphone = vi.Record("microphone", np.zeros(48000), 48e3, "Pa")
    >>> heard = vi.Bounces(
    ...     microphone,
    ...     np.array([0.0, 0.4, 0.72, 0.976]),
    ...     np.full(4, 1e-5),
    ...     np.ones(4),
    ...     np.zeros(0),
    ...     (),
    ... )
    >>> with TemporaryDirectory() as folder:
    ...     sorted(
    ...         file.name
    ...         for file in vi.save_rebounds(vi.rebounds_of(heard), f"{folder}/found").iterdir()
    ...     )
    ['bounces.csv', 'report.html', 'summary.json']
    """
    rows, charts, record = bounce_rows(found), bounce_charts(found), found.bounces.record
    with new_folder(directory, force=force) as folder:
        write_csv(rows, list(rows[0]), folder / "bounces.csv")
        write_summary(bounce_document(found), folder)
        write_figures(charts, folder, figures)
        headers, cells = impact_cells(found)
        page = render_page(
            __package__,
            charts,
            name=record.name,
            status=f"{len(rows)} touches of a bouncing ball.",
            fits=law_sentences(found),
            doubts=found.doubts,
            headers=headers,
            rows=cells,
            notes=[
                drop_sentence(found),
                contact_sentence(found),
                inputs_sentence(found.inputs),
                *other_sentences(found),
            ],
            source=record.source,
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
