"""The command `compare`, which runs one case under several contact laws."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from vibroimpact.cli.completion import complete_laws, complete_parameter
from vibroimpact.cli.shared import (
    CaseArgument,
    Columns,
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
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.case import Case
    from vibroimpact.law_comparison.ranking import Ranking

_SETTINGS = "restitution=0.7 or adams-impact.damping_max=180"
"""An example of parameters that are set."""


@app.command()
def compare(
    case: CaseArgument,
    laws: Annotated[
        str | None,
        typer.Option(
            "--laws",
            metavar="A,B,C",
            autocompletion=complete_laws,
            help="The contact laws, separated by commas; with --measured by default all.",
        ),
    ] = None,
    measured: Annotated[
        Path | None,
        typer.Option(
            "--measured",
            metavar="TABLE",
            help="Rank the laws by how well they fit measured restitutions over the speed, a table "
            "as of calibrate.",
        ),
    ] = None,
    columns: Columns = None,
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
    liquid stay under each law. With --measured the loss parameter of each law is fitted to a table
    of restitutions: one value for all speeds, beside the value of each.
    """
    from vibroimpact.cases.reader import load_case
    from vibroimpact.files.result_folder import check_free
    from vibroimpact.law_comparison.comparison import compare_laws

    if measured is None and columns is not None:
        raise InputError("--columns goes with the table of --measured")
    if measured is None and laws is None:
        raise InputError("name the laws: vibroimpact compare CASE --laws A,B,C")
    if measured is not None and achieving is not None:
        raise InputError("--measured fits the laws, and --achieving tunes them; give one of them")
    compared_case = load_case(case)
    target = output or Path(f"{stem(case)}-compared")
    check_free(target, force=force)
    if measured is not None:
        with progress_of("fitting", as_json=as_json) as progress:
            ranking = _ranked(compared_case, measured, columns, laws, given, progress)
        save_and_show(ranking, target, force=force, figures=figures, as_json=as_json)
        return
    assert laws is not None
    with progress_of("comparing", as_json=as_json) as progress:
        comparison = compare_laws(
            compared_case,
            names_in(laws),
            settings_of(given, _SETTINGS),
            achieving=achieving,
            progress=progress,
        )
    save_and_show(comparison, target, force=force, figures=figures, as_json=as_json)


def _ranked(
    case: Case,
    table: Path,
    columns: str | None,
    laws: str | None,
    given: list[str] | None,
    progress: Callable[[float], None],
) -> Ranking:
    """Return the laws by their fit to the restitutions of a table."""
    from vibroimpact.calibration.restitutions.restitutions import load_restitutions
    from vibroimpact.law_comparison.ranking import rank_laws

    measured = load_restitutions(table, columns=columns)
    names = None
    if laws is not None:
        names = names_in(laws)
    return rank_laws(
        case,
        measured.approach_speed,
        measured.restitution,
        names,
        settings_of(given, _SETTINGS),
        count=measured.count,
        source=measured.source,
        progress=progress,
    )
