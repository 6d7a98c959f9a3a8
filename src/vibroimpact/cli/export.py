"""The command `export`, which writes results in the formats of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.completion import complete_format
from vibroimpact.cli.shared import Json, app, show
from vibroimpact.errors import InputError


@app.command()
def export(
    directory: Annotated[
        Path | None,
        typer.Argument(metavar="[DIR]", help="A result folder, or a calibration folder."),
    ] = None,
    to: Annotated[
        str | None,
        typer.Option(
            "--to",
            metavar="FORMAT",
            autocompletion=complete_format,
            help="The format; without it the formats are listed.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="PATH",
            help="The folder, or the file of a format with a single file; by default the folder "
            "DIR-FORMAT.",
        ),
    ] = None,
    match: Annotated[
        str | None,
        typer.Option(
            "--match",
            metavar="REBOUND",
            help="Write Adams' IMPACT in place of the contact law: rebound, with the rebound of "
            "the run, elastic bodies included, or contact, with that of its contact law alone.",
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace files of the same names.")
    ] = False,
    formats: Annotated[bool, typer.Option("--formats", help="List the formats.")] = False,
    as_json: Json = False,
) -> None:
    """Export a result to another program, or list the formats.

    The output states what the format can't represent, and what the writer was tested against. For
    Adams it has the numbers of the dialog of a contact.
    """
    from vibroimpact.exporting.document import export_document, formats_document
    from vibroimpact.exporting.export_format import find_export_format
    from vibroimpact.exporting.export_result import default_output, drop_to_export, save_export
    from vibroimpact.exporting.text import export_summary, format_table

    if formats and (to is not None or output is not None or match is not None or force):
        raise InputError("--formats lists the formats, and takes no --to, -o, --match or --force")
    if formats or to is None:
        if output is not None or match is not None or force:
            raise InputError("name the format: vibroimpact export DIR --to FORMAT")
        show(formats_document, format_table, as_json=as_json)
        return
    export_format = find_export_format(to)
    if directory is None:
        raise InputError(
            f"name the folder that is to be exported: vibroimpact export DIR --to {to}"
        )
    drop = drop_to_export(directory, export_format, match)
    target = output or default_output(directory, to)
    files = save_export(drop, export_format, target, force=force)
    show(
        lambda: export_document(drop, export_format, files),
        lambda: export_summary(drop, export_format, files),
        as_json=as_json,
    )
