"""The command `calibrate`, which finds the damping for a required or measured rebound."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.shared import (
    CaseArgument,
    Changes,
    Figures,
    Force,
    Json,
    app,
    console,
    exit_on_interrupt,
    note,
    say,
    settings_of,
    show,
    stem,
)


@app.command()
def calibrate(
    case: CaseArgument,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="The folder to make; by default CASE-calibrated.")
    ] = None,
    changes: Changes = None,
    figures: Figures = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Find the damping with which a sphere bounces as it is wanted to, or was measured to.

    The [calibrate] section of the case says what to match: a contact law, a restitution, or measurements. Without it the
    damping of Adams' IMPACT is found with which the sphere bounces as under the law of the case.
    """
    from vibroimpact.calibration.calibrate_case import calibrate_case, load_calibration
    from vibroimpact.calibration.folder import save_calibration
    from vibroimpact.calibration.reported import report_of
    from vibroimpact.calibration.text import calibration_summary
    from vibroimpact.cases.reader import prefix_errors
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.results.folder import check_free

    what = load_calibration(case, settings_of(changes))
    target = Path(f"{stem(case)}-calibrated") if output is None else output
    check_free(target, force=force)
    screen = console(err=as_json)
    with exit_on_interrupt():
        with patient_progress("calibrating", screen) as progress:
            found = prefix_errors(case, lambda: calibrate_case(what, progress, note))
        folder = save_calibration(what.case, found, target, force=force, figures=("png",) if figures else ())
    told = report_of(what.case, found)
    show(
        lambda: {"folder": str(folder), **told.document, **told.tables},
        lambda: calibration_summary(what.case, told),
        as_json=as_json,
    )
    say(f"wrote {folder / 'report.html'}", err=as_json)
