"""Writes a bound as a folder: data and report."""

from __future__ import annotations

from dataclasses import asdict
from os import PathLike
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.bayes_error.bound import BANDWIDTHS, SIGNAL_TO_NOISE, Bound
from vibroimpact.bayes_error.charts import bound_charts
from vibroimpact.bayes_error.observations import OBSERVATIONS
from vibroimpact.bayes_error.tables import (
    HEADERS,
    bound_rows,
    error_rows,
    headline,
    heard_words,
    sampling_words,
    scatter_words,
)
from vibroimpact.report.page import render_page
from vibroimpact.results.csv_files import write_csv
from vibroimpact.results.folder import new_folder, write_summary


def save_bound(bound: Bound, directory: str | PathLike[str], *, force: bool = False) -> Path:
    """Write a bound atomically: `bound.csv`, `map.csv`, `summary.json` and a report.

    Parameters
    ----------
    bound : Bound
        The bound.
    directory : path
        The folder to create.
    force : bool, default False
        Replace an existing result folder.

    Raises
    ------
    InputError
        If the folder exists and may not be replaced, or it can't be written to.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> bound = vi.bound_of(vi.load_sweep("signals:coal-gangue", samples=100))
    >>> with TemporaryDirectory() as folder:
    ...     sorted(file.name for file in vi.save_bound(bound, f"{folder}/told").iterdir())
    ['bound.csv', 'map.csv', 'report.html', 'summary.json']
    """
    with new_folder(directory, force=force) as folder:
        rows = bound_rows(bound)
        write_csv(rows, list(rows[0]), folder / "bound.csv")
        over = [
            {
                "bandwidth_Hz": float(bandwidth),
                "signal_to_noise_dB": float(ratio),
                "error_upper": float(bound.map[place, other]),
            }
            for place, bandwidth in enumerate(BANDWIDTHS)
            for other, ratio in enumerate(SIGNAL_TO_NOISE)
        ]
        write_csv(over, list(over[0]), folder / "map.csv")
        write_summary(bound_document(bound), folder)
        page = render_page(
            __package__,
            bound_charts(bound),
            name=f"Bounds on the classification error: {bound.name}",
            headline=headline(bound),
            heard=heard_words(bound),
            scatter=scatter_words(bound),
            sampling=sampling_words(bound),
            headers=HEADERS,
            rows=error_rows(bound),
            meanings=[(one.name, one.meaning) for one in OBSERVATIONS],
            version=__version__,
        )
        (folder / "report.html").write_text(page, encoding="utf-8")
    return Path(directory)


def bound_document(bound: Bound) -> dict[str, Any]:
    """Return a bound as data: the content of `summary.json`, and what `bound --json` prints."""
    rows = [
        {name: value if value == value else None for name, value in row.items()}
        for row in bound_rows(bound)
    ]
    return {
        "name": bound.name,
        "version": __version__,
        "falls": len(bound.falls),
        "majority_error": bound.majority,
        "channel": asdict(bound.channel),
        "bound": rows,
    }
