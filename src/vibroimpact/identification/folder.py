"""Writes an identification as a folder: the force, the summary, the case and a report."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import tomli_w

from vibroimpact._version import __version__
from vibroimpact.cases.build import resolved_case
from vibroimpact.charts.figures_folder import write_figures
from vibroimpact.identification.charts import identification_charts
from vibroimpact.identification.document import (
    HEADERS,
    identification_rows,
    summary_of_identification,
)
from vibroimpact.identification.identify import Identification
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_columns
from vibroimpact.results.folder import new_folder, write_summary
from vibroimpact.signals.estimate import Estimate


def save_identification(
    found: Identification,
    directory: str | PathLike[str],
    *,
    force: bool = False,
    figures: Sequence[str] = (),
) -> Path:
    """Write an identification atomically: `force.csv`, `summary.json`, `case.toml` and a report.

    A force from the records alone that is withheld, since it contradicts the contact, is not
    written.

    Parameters
    ----------
    found : Identification
        The identification.
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
    ...     "modes": 20,
    ...     "supports": "clamped",
    ...     "damping": 0.01,
    ... }
    >>> case = vi.read_case(
    ...     {
    ...         "sphere": {"radius": 0.02, "material": "rock-paper"},
    ...         "plate": plate,
    ...         "drop": {"speed": 2.0, "position": [0.02, 0.01]},
    ...         "contact": {"law": "hertz"},
    ...         "run": {"impacts": 1},
    ...         "sensors": [
    ...             {"name": "a", "position": [0.1, 0.03], "rate": 20e3},
    ...             {"name": "b", "position": [-0.05, 0.08], "rate": 20e3},
    ...         ],
    ...     }
    ... )
    >>> found = vi.identify(
    ...     case,
    ...     [
    ...         vi.Record(name, one.value, 20e3, "m/s2")
    ...         for name, one in vi.simulate(case).signals().items()
    ...     ],
    ... )
    >>> with TemporaryDirectory() as folder:
    ...     place = vi.save_identification(found, f"{folder}/identified")
    ...     round(vi.load_case(place / "case.toml").sphere.radius, 3)
    0.02
    """
    with new_folder(directory, force=force) as folder:
        if found.force is not None:
            recovered = found.force.found
            spread = Estimate(0.0, 1.0).interval[1] * recovered.deviation
            columns = {
                "time_s": found.measured.start + found.force.time,
                "force_N": recovered.force,
                "force_low_N": recovered.force - spread,
                "force_high_N": recovered.force + spread,
            }
            write_columns(columns, folder / "force.csv")
        write_summary(summary_of_identification(found), folder)
        (folder / "case.toml").write_text(
            tomli_w.dumps(resolved_case(found.plate.case)), encoding="utf-8"
        )
        charts = identification_charts(found)
        write_figures(charts, folder, figures)
        page = render_page(
            __package__,
            charts,
            name=found.plate.case.name or "An impact",
            headers=list(HEADERS),
            rows=identification_rows(found),
            doubts=found.doubts,
            certain=found.certain,
            model_errors=bool(found.plate.model_error),
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)
