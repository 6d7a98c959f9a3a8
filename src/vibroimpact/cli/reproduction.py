"""The command `reproduce`, which reproduces the paper."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.completion import complete_parts
from vibroimpact.cli.shared import Json, app, console, fail, names_in, note, show_folder


@app.command()
def reproduce(
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="DIR", help="The folder to make, or to continue."),
    ] = Path("vibroimpact-paper"),
    only: Annotated[
        str | None,
        typer.Option(
            "--only",
            metavar="A,B,C",
            autocompletion=complete_parts,
            help="Only these parts; existing ones are computed again.",
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace an existing folder with all its parts.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Reproduce the numbers and figures of the paper. Each printed value is compared with the
    computed one.

    The report states for each value whether it is reproduced, explained, or not reproduced, and
    why, and whether it is a result or an input or was inferred or fitted. Parts named by --only are
    shown, their figures by the names of their files. An interrupted run is continued with the same
    command.

    The parts: table1, section3.1, fig3, section3.2, fig4 to fig8, damping, table2, section4, fig9,
    section5.1, fig10 to fig13, section5.2, fig14 to fig17, section5.3, fig18 to fig23, conclusions,
    recovery, sampling, unresolved, corrections.
    """
    from vibroimpact.paper.report.folder import missing_parts, reproduce_paper
    from vibroimpact.paper.report.report import report_of_parts
    from vibroimpact.paper.report.reproduction import load_reproduction
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.report.terminal_report import terminal_report

    names = None if only is None else names_in(only)
    screen = console(err=as_json)
    try:
        with patient_progress("reproducing", screen) as progress:
            folder = reproduce_paper(output, names, force=force, progress=progress, tell=note)
    except KeyboardInterrupt:
        missing = [name for name in missing_parts(output) if names is not None and name in names]
        # of parts that were there before it is not known which were computed again
        again = missing or names
        some = f" --only {','.join(again)}" if again else ""
        fail(
            "interrupted; completed parts are kept; continue with: vibroimpact reproduce "
            f"-o {shlex.quote(str(output))}{some}",
            130,
        )
    reproduction = load_reproduction(folder)
    report = reproduction.report
    if names is not None:
        report = report_of_parts(reproduction, names)
    show_folder(folder, lambda: report.document, lambda: terminal_report(report), as_json=as_json)
