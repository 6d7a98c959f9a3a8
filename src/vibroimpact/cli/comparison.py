"""The command `compare`, which runs one case under several contact laws."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.completion import complete_laws, complete_parameter
from vibroimpact.cli.shared import (
    CaseArgument,
    Figures,
    Force,
    Json,
    app,
    names_in,
    output_folder,
    progress_of,
    save_and_show,
    settings_of,
    stem,
)


@app.command()
def compare(
    case: CaseArgument,
    laws: Annotated[
        str,
        typer.Option(
            "--laws",
            metavar="A,B,C",
            autocompletion=complete_laws,
            help="The contact laws, separated by commas.",
        ),
    ],
    given: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            autocompletion=complete_parameter,
            help="Parameter of every law that has it, or LAW.KEY=VALUE for one law; may be "
            "repeated.",
        ),
    ] = None,
    achieving: Annotated[
        float | None,
        typer.Option(
            "--achieving",
            metavar="E",
            help="Tune each law to this restitution between rigid bodies, at the first speed, "
            "without gravity and losses in a liquid.",
        ),
    ] = None,
    output: Annotated[Path | None, output_folder("CASE-compared")] = None,
    figures: Figures = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Compare the results of several contact laws for one case.

    Parameters of the case's own law are also used for the other laws that have them; friction and a
    liquid stay under each law.
    """
    from vibroimpact.cases.reader import load_case
    from vibroimpact.files.result_folder import check_free
    from vibroimpact.law_comparison.comparison import compare_laws

    compared_case = load_case(case)
    target = output or Path(f"{stem(case)}-compared")
    check_free(target, force=force)
    with progress_of("comparing", as_json=as_json) as progress:
        comparison = compare_laws(
            compared_case,
            names_in(laws),
            settings_of(given, "restitution=0.7 or adams-impact.damping_max=180"),
            achieving=achieving,
            progress=progress,
        )
    save_and_show(comparison, target, force=force, figures=figures, as_json=as_json)
