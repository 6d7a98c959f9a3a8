"""The command that reproduces the paper."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.shared import Force, app, console, fail, note


@app.command()
def reproduce(
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="The folder to make, or to add to with --only.")] = Path(
        "vibroimpact-paper"
    ),
    only: Annotated[
        str | None, typer.Option("--only", metavar="A,B,C", help="Only these parts, such as table2,fig4; those in DIR already stay.")
    ] = None,
    force: Force = False,
) -> None:
    """Reproduce the paper: each printed number beside the computed one, and its figures.

    The report says of each whether it is reproduced, explained, or not reproduced, and why. What is done stays done: an
    interrupted run goes on with --only.
    """
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.report.reproduction.folder import missing_parts, reproduce_paper
    from vibroimpact.report.reproduction.summary import summary_table

    names = None if only is None else [name.strip() for name in only.split(",") if name.strip()]
    screen = console()
    try:
        with patient_progress("reproducing", screen) as progress:
            folder = reproduce_paper(output, names, force=force, progress=progress, tell=note)
    except KeyboardInterrupt:
        left = missing_parts(output)
        go_on = f"; go on with: vibroimpact reproduce -o {output} --only {','.join(left)}" if left else ""
        fail(f"interrupted; the parts that are done stay{go_on}", 130)
    screen.print(summary_table(folder))
    typer.echo(f"wrote {folder / 'report.html'}")
