"""Writes a correlation as a folder: signals, frequency responses, criteria, modes, the
summary, the case and a report.
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
from vibroimpact.test_analysis.charts import correlation_charts
from vibroimpact.test_analysis.correlate import Correlation
from vibroimpact.test_analysis.document import (
    MODE_COLUMNS,
    RECORD_HEADERS,
    TEXTS,
    mode_cells,
    mode_table,
    octave_headers,
    octave_rows,
    record_rows,
    response_columns,
    summary_of_correlation,
    what_frac_is_of,
)
from vibroimpact.test_analysis.mode_pairs import damping_field


def save_correlation(
    found: Correlation,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write a correlation atomically.

    The folder has `overlay.csv` (time, and of each record measured, simulated and residual),
    `responses.csv` (frequency, and of each record magnitude and phase of both), `modes.csv`,
    `summary.json`, `case.toml` and a report.

    Parameters
    ----------
    found : Correlation
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
    ...         "run": {"duration": 0.1},
    ...         "sensors": [{"name": "a", "position": [0.1, 0.03], "rate": 20e3}],
    ...     }
    ... )
    >>> record = vi.Record("a", vi.simulate(case).signals()["a"].value, 20e3, "m/s2")
    >>> found = vi.correlate(case, [record], window=0.05)
    >>> with TemporaryDirectory() as folder:
    ...     sorted(file.name for file in vi.save_correlation(found, f"{folder}/compared").iterdir())
    ['case.toml', 'modes.csv', 'overlay.csv', 'report.html', 'responses.csv', 'summary.json']
    """
    with new_folder(directory, force=force) as folder:
        plain = plain_names([sensor.name for sensor in found.sensors])
        overlay = {"time_s": found.time}
        for number, sensor in enumerate(found.sensors):
            name = plain[sensor.name]
            for what in ("measured", "simulated", "residual"):
                overlay[f"{name}_{what}"] = getattr(found, what)[number]
        write_columns(overlay, folder / "overlay.csv")
        write_columns(response_columns(found, plain), folder / "responses.csv")
        write_csv(mode_table(found), list(MODE_COLUMNS), folder / "modes.csv")
        write_summary(summary_of_correlation(found), folder)
        (folder / "case.toml").write_text(
            tomli_w.dumps(resolved_case(found.case)), encoding="utf-8"
        )
        charts = correlation_charts(found)
        write_figures(charts, folder, figures)
        page = render_page(
            __package__,
            charts,
            name=found.case.name or "A test",
            record_headers=list(RECORD_HEADERS),
            records=record_rows(found),
            octave_headers=octave_headers(found),
            octaves=octave_rows(found),
            of=what_frac_is_of(found),
            aligned=f"{1e3 * found.aligned:.3g} ms",
            modes=mode_cells(found.modes),
            texts=TEXTS,
            damping=damping_field(found.modes),
            doubts=found.doubts,
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
