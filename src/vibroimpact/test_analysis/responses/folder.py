"""Writes a correlation of frequency responses as a folder: responses, modes, the summary,
the case and a report.
"""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import tomli_w

from vibroimpact._version import __version__
from vibroimpact.cases.build import resolved_case
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.files.plain_names import plain_names
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_columns, write_csv
from vibroimpact.results.folder import new_folder, write_summary
from vibroimpact.test_analysis.document import (
    MODE_COLUMNS,
    TEXTS,
    mode_cells,
    mode_table,
    octave_headers,
    octave_rows,
    response_columns,
)
from vibroimpact.test_analysis.mode_pairs import damping_field
from vibroimpact.test_analysis.responses.charts import response_charts
from vibroimpact.test_analysis.responses.document import (
    RESPONSE_HEADERS,
    WHAT_FRAC_IS_OF,
    response_rows,
    summary_of_responses,
)
from vibroimpact.test_analysis.responses.result import ResponseCorrelation


def save_response_correlation(
    found: ResponseCorrelation,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write a correlation of frequency responses atomically.

    The folder has `responses.csv` (frequency, and of each response magnitude and phase of both, and
    the coherence), `modes.csv`, `summary.json`, `case.toml` and a report.

    Parameters
    ----------
    found : ResponseCorrelation
        The correlation.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing folder.
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
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> plate = {
    ...     "size": [0.3, 0.3, 0.02],
    ...     "material": "steel",
    ...     "model": "elastic",
    ...     "modes": 10,
    ...     "supports": "clamped",
    ...     "damping": 0.01,
    ... }
    >>> case = vi.read_case(
    ...     {
    ...         "sphere": {"radius": 0.02, "material": "steel"},
    ...         "plate": plate,
    ...         "drop": {"speed": 1.0, "position": [0.02, 0.01]},
    ...         "contact": {"law": "hertz"},
    ...         "sensors": [{"name": "a", "position": [0.1, 0.03]}],
    ...     }
    ... )
    >>> found = vi.correlate_responses(
    ...     case, vi.responses_of_case(case, np.arange(500.0, 4000.0, 2.0))
    ... )
    >>> with TemporaryDirectory() as folder:
    ...     sorted(
    ...         file.name
    ...         for file in vi.save_response_correlation(found, f"{folder}/compared").iterdir()
    ...     )
    ['case.toml', 'modes.csv', 'report.html', 'responses.csv', 'summary.json']
    """
    with new_folder(directory, force=force) as folder:
        plain = plain_names([sensor.name for sensor in found.sensors])
        write_columns(response_columns(found, plain), folder / "responses.csv")
        write_csv(mode_table(found), list(MODE_COLUMNS), folder / "modes.csv")
        write_summary(summary_of_responses(found), folder)
        (folder / "case.toml").write_text(
            tomli_w.dumps(resolved_case(found.case)), encoding="utf-8"
        )
        charts = response_charts(found)
        write_figures(charts, folder, figures)
        page = render_page(
            __package__,
            charts,
            name=found.case.name or "A test",
            response_headers=list(RESPONSE_HEADERS),
            responses=response_rows(found),
            octave_headers=octave_headers(found),
            octaves=octave_rows(found),
            of=WHAT_FRAC_IS_OF,
            modes=mode_cells(found.modes),
            texts=TEXTS,
            damping=damping_field(found.modes),
            doubts=found.doubts,
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
