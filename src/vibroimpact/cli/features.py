"""The command `features`, which computes features of signals."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from vibroimpact.cli.completion import complete_features
from vibroimpact.cli.shared import (
    Columns,
    Json,
    app,
    console,
    exit_on_interrupt,
    names_in,
    note,
    quantity_in,
    say,
    show,
)
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.signals.record import Record
    from vibroimpact.signals.record_table import RecordTable

_MOST_DOUBTS = 10
"""Number of doubts about records that are shown; further ones are counted."""


@app.command()
def features(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[DIR|FILE...]",
            help="Folders of results or data sets, or files: CSV, WAV, UFF, NetCDF-4.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="CSV", help="Write the table into this file."),
    ] = None,
    only: Annotated[
        str | None,
        typer.Option(
            "--only",
            metavar="NAMES",
            autocompletion=complete_features,
            help="Features to compute, separated by commas.",
        ),
    ] = None,
    threshold: Annotated[
        float | None,
        typer.Option(
            "--threshold",
            metavar="NUMBER",
            help="Threshold of the envelope, in the SI unit of the signal; by default a tenth of "
            "its maximum.",
        ),
    ] = None,
    dead_time: Annotated[
        str,
        typer.Option(
            "--dead-time",
            metavar="TIME",
            help="Time below the threshold after which a packet ends.",
        ),
    ] = "5 ms",
    window: Annotated[
        str | None,
        typer.Option(
            "--window",
            metavar="TIME",
            help='Length of each record to use, from its onset on, such as "40 ms".',
        ),
    ] = None,
    columns: Columns = None,
    packets: Annotated[
        bool,
        typer.Option("--packets", help="One row for each packet, instead of one for each record."),
    ] = False,
    listed: Annotated[
        bool, typer.Option("--list", help="List the features: name, unit, equation, source.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
    as_json: Json = False,
) -> None:
    """Compute features of signals, or list the features.

    Each row of the table is a signal. Where a feature has no value, the last column gives the
    reason.
    """
    from vibroimpact.cli.feature_text import (
        feature_list,
        features_document,
        table_document,
        table_summary,
    )

    if listed:
        if paths or output:
            raise InputError("--list lists the features, and takes no files")
        show(features_document, feature_list, as_json=as_json)
        return
    if not paths:
        raise InputError(
            "name the files or folders with signals: vibroimpact features DIR|FILE... -o "
            "table.csv; --list lists the features"
        )
    from vibroimpact.report.progress import counting_progress
    from vibroimpact.signals.record_table import record_table

    if packets and window is not None:
        raise InputError(
            "a row is a packet with --packets, and a window with --window; give one of them"
        )
    if output is not None:
        _check_table_file(output, force=force)
    names = None if only is None else names_in(only)
    if names == []:
        raise InputError("--only names no feature; --list lists them")
    silence = quantity_in("--dead-time", dead_time, "s")
    length = None
    if window is not None:
        length = quantity_in("--window", window, "s")
    records = _records(paths, columns, threshold, silence, length, packets=packets)
    screen = console(err=as_json)
    with exit_on_interrupt(), counting_progress("signals", screen) as count:
        table = record_table(
            records,
            names,
            threshold=threshold,
            dead_time=silence,
            progress=lambda done: count(done, None),
        )
    if not table.records:
        fault = "there are no signals"
        if packets:
            fault += " with a packet above the threshold"
        raise InputError(fault)
    if output is not None:
        _write_table(table, output)
    show(lambda: table_document(table), lambda: table_summary(table), as_json=as_json)
    if output is not None:
        say(
            f"wrote {output}: {len(table.records)} signals, {len(table.names)} features",
            err=as_json,
        )


def _check_table_file(file: Path, *, force: bool) -> None:
    if file.is_dir():
        raise InputError(f"{file} is a folder; name a file for the table")
    if file.exists() and not force:
        raise InputError(f"{file} exists; take another name, or --force to replace it")


def _write_table(table: RecordTable, file: Path) -> None:
    from vibroimpact.files.atomic_write import write_file
    from vibroimpact.files.recover import recover

    recover(file)
    write_file(file, table.csv_text())


def _records(
    paths: list[Path],
    columns: str | None,
    threshold: float | None,
    dead_time: float,
    window: float | None,
    *,
    packets: bool,
) -> Iterator[Record]:
    """Yield the records of files and folders, or their windows from the onset, or their packets."""
    from vibroimpact.files.reading import with_path
    from vibroimpact.signals.onset import from_onset
    from vibroimpact.signals.packets import packet_records

    for record in _records_without_baseline(paths, columns):
        try:
            if packets:
                yield from packet_records(record, threshold, dead_time)
            elif window is not None:
                yield from_onset(record, window, threshold=threshold)
            else:
                yield record
        except InputError as error:
            raise with_path(record.source, error) from None


def _records_without_baseline(paths: list[Path], columns: str | None) -> Iterator[Record]:
    """Yield the records of files and folders, and show the doubts about them."""
    from vibroimpact.signals.baseline import without_baseline
    from vibroimpact.signals.reading.record_files import load_records

    doubts: set[str] = set()
    for path in paths:
        for record in map(without_baseline, load_records(path, columns)):
            for doubt in record.named_doubts:
                if doubt not in doubts and len(doubts) < _MOST_DOUBTS:
                    note(f"warning: {doubt}")
                doubts.add(doubt)
            yield record
    if len(doubts) > _MOST_DOUBTS:
        note(
            f"warning: there are {len(doubts) - _MOST_DOUBTS:,} further warnings about records; "
            "offset and drift of a table (-o) are what was removed"
        )
