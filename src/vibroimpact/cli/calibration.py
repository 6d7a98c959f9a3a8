"""The command `calibrate`, which finds the damping for a required or measured rebound, or
the restitution of bounces in a record.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.completion import RECORDS, TABLES, complete_case_or_record
from vibroimpact.cli.shared import (
    Changes,
    Columns,
    Figures,
    Force,
    Json,
    app,
    exit_on_interrupt,
    note,
    progress_of,
    save_and_show,
    settings_of,
    stem,
    written_in,
)
from vibroimpact.errors import InputError


@app.command()
def calibrate(
    case: Annotated[
        str,
        typer.Argument(
            metavar="CASE|RECORD",
            autocompletion=complete_case_or_record,
            help=(
                'A TOML file, a shipped case such as "paper:calibration", a record of '
                "bounces (WAV, CSV, UFF, NetCDF-4), "
                "or a table of restitutions over the approach speed."
            ),
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="The folder to make; by default CASE-calibrated."
        ),
    ] = None,
    changes: Changes = None,
    channel: Annotated[
        str | None,
        typer.Option("--channel", metavar="NAME", help="Channel to use, if a record has several."),
    ] = None,
    gravity: Annotated[
        str | None,
        typer.Option(
            "--gravity",
            metavar="VALUE",
            help='Gravity during the flights of a record, such as "9.81 m/s^2 +- 0.005 m/s^2"; '
            "by default 9.80665 m/s^2.",
        ),
    ] = None,
    height: Annotated[
        str | None,
        typer.Option(
            "--height",
            metavar="LENGTH",
            help='Height of fall before the first touch of a record, such as "0.3 m +- 5 mm".',
        ),
    ] = None,
    contact: Annotated[
        str | None,
        typer.Option(
            "--contact",
            metavar="TIME",
            help='Contact time of the impacts of a record, such as "0.2 ms +- 10 %"; by default 0.',
        ),
    ] = None,
    columns: Columns = None,
    figures: Figures = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Calibrate a contact law to a specified or measured rebound. From a record of bounces, or a
    table, fit the restitution.

    The [calibrate] section of a case specifies the target: a contact law, a restitution, or
    measurements. Without it the damping of Adams' IMPACT is calibrated to the law of the case. From
    a record of sound or vibration, restitution and speed of each impact follow from the times
    between bounces; a table has them: speed [m/s], restitution and, for means, count.
    """
    from vibroimpact.calibration.impact_table import holds_restitutions
    from vibroimpact.files.result_folder import check_free

    target = Path(f"{stem(case)}-calibrated") if output is None else output
    given = {"--channel": channel, "--gravity": gravity, "--height": height, "--contact": contact}
    if Path(case).suffix.lower() in RECORDS:
        if changes:
            raise InputError("--set changes the keys of a case, and a record or a table has none")
        check_free(target, force=force)
        if Path(case).suffix.lower() in TABLES and holds_restitutions(case, columns):
            of_records = [option for option, value in given.items() if value is not None]
            if of_records:
                raise InputError(
                    f"{of_records[0]} goes with a record of bounces; {case} is a table of "
                    "restitutions, which has no times"
                )
            _fit_table(Path(case), target, columns, figures=figures, force=force, as_json=as_json)
            return
        _listen(
            Path(case),
            target,
            channel,
            columns,
            gravity,
            height,
            contact,
            figures=figures,
            force=force,
            as_json=as_json,
        )
        return
    for option, value in {**given, "--columns": columns}.items():
        if value is not None:
            kinds = (
                ("a table of restitutions or of bounces", TABLES)
                if option == "--columns"
                else ("a record of bounces", RECORDS)
            )
            raise InputError(
                f"{option} goes with {kinds[0]} ({', '.join(kinds[1])}); a case has its own keys"
            )
    from vibroimpact.calibration.calibrate_case import calibrate_case, load_calibration
    from vibroimpact.cases.reader import prefix_errors

    what = load_calibration(case, settings_of(changes))
    check_free(target, force=force)
    with progress_of("calibrating", as_json=as_json) as progress:
        calibration = prefix_errors(case, lambda: calibrate_case(what, progress, note))
    save_and_show(calibration, target, force=force, figures=figures, as_json=as_json)


def _fit_table(
    file: Path, target: Path, columns: str | None, *, figures: bool, force: bool, as_json: bool
) -> None:
    """Fit the restitutions of a table over the approach speed, and print and write them."""
    from vibroimpact.calibration.restitutions.restitutions import load_restitutions

    restitutions = load_restitutions(file, columns=columns)
    save_and_show(restitutions, target, force=force, figures=figures, as_json=as_json)


def _listen(
    file: Path,
    target: Path,
    channel: str | None,
    columns: str | None,
    gravity: str | None,
    height: str | None,
    contact: str | None,
    *,
    figures: bool,
    force: bool,
    as_json: bool,
) -> None:
    """Find the restitution of bounces in a record, and print and write it."""
    from vibroimpact.calibration.bounces.rebounds import rebounds_of
    from vibroimpact.calibration.inputs import BRIEF
    from vibroimpact.files.reading import with_path
    from vibroimpact.signals.bounces.find import find_bounces
    from vibroimpact.signals.reading.one_record import one_record

    with exit_on_interrupt():
        contact_duration = BRIEF if contact is None else written_in("--contact", contact, "s")
        acceleration = None if gravity is None else written_in("--gravity", gravity, "m/s^2")
        drop_height = None if height is None else written_in("--height", height, "m")
        record = one_record(file, channel, columns)
        try:
            bounces = find_bounces(record, contact_duration)
            rebounds = rebounds_of(bounces, gravity=acceleration, height=drop_height)
        except InputError as error:
            raise with_path(file, error) from None
    save_and_show(rebounds, target, force=force, figures=figures, as_json=as_json)
