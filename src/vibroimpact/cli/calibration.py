"""The command `calibrate`: damping for a rebound, or restitution of bounces in a record."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

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
    output_folder,
    progress_of,
    save_and_show,
    settings_of,
    stem,
    written_in,
)
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.calibration.bounces.rebounds import Rebounds
    from vibroimpact.calibration.restitutions.restitutions import Restitutions
    from vibroimpact.report.reported import Reported


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
    output: Annotated[Path | None, output_folder("CASE-calibrated")] = None,
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
    from vibroimpact.files.result_folder import check_free

    target = output or Path(f"{stem(case)}-calibrated")
    options_of_records = {
        "--channel": channel,
        "--gravity": gravity,
        "--height": height,
        "--contact": contact,
    }
    finding: Reported
    if Path(case).suffix.lower() not in RECORDS:
        _check_has_no_options(options_of_records, columns)
        finding = _calibrated_case(case, changes, target, force=force, as_json=as_json)
    else:
        if changes:
            raise InputError("--set changes the keys of a case, and a record or a table has none")
        check_free(target, force=force)
        if _is_restitution_table(case, columns):
            finding = _fitted_restitutions(case, columns, options_of_records)
        else:
            with exit_on_interrupt():
                finding = _rebounds_in(Path(case), channel, columns, gravity, height, contact)
    save_and_show(finding, target, force=force, figures=figures, as_json=as_json)


def _check_has_no_options(options: Mapping[str, str | None], columns: str | None) -> None:
    """Raise if options are given with a case that go with a record or a table."""
    for option, value in options.items():
        if value is not None:
            raise InputError(
                f"{option} goes with a record of bounces ({', '.join(RECORDS)}); a case has its "
                "own keys"
            )
    if columns is not None:
        raise InputError(
            "--columns goes with a table of restitutions or of bounces "
            f"({', '.join(TABLES)}); a case has its own keys"
        )


def _calibrated_case(
    case: str, changes: list[str] | None, target: Path, *, force: bool, as_json: bool
) -> Reported:
    """Return the calibration of a case."""
    from vibroimpact.calibration.calibrate_case import calibrate_case, load_calibration
    from vibroimpact.cases.reader import prefix_errors
    from vibroimpact.files.result_folder import check_free

    problem = load_calibration(case, settings_of(changes))
    check_free(target, force=force)
    with progress_of("calibrating", as_json=as_json) as progress:
        return prefix_errors(case, lambda: calibrate_case(problem, progress, note))


def _is_restitution_table(path: str, columns: str | None) -> bool:
    from vibroimpact.calibration.records.impact_table import holds_restitutions

    return Path(path).suffix.lower() in TABLES and holds_restitutions(path, columns)


def _fitted_restitutions(
    path: str, columns: str | None, options_of_records: Mapping[str, str | None]
) -> Restitutions:
    """Return the fit of the restitutions of a table over the approach speed."""
    from vibroimpact.calibration.restitutions.restitutions import load_restitutions

    for option, value in options_of_records.items():
        if value is not None:
            raise InputError(
                f"{option} goes with a record of bounces; {path} is a table of "
                "restitutions, which has no times"
            )
    return load_restitutions(Path(path), columns=columns)


def _rebounds_in(
    path: Path,
    channel: str | None,
    columns: str | None,
    gravity: str | None,
    height: str | None,
    contact: str | None,
) -> Rebounds:
    """Return the rebounds of the bounces in a record."""
    from vibroimpact.calibration.bounces.rebounds import rebounds_of
    from vibroimpact.calibration.observed.inputs import BRIEF
    from vibroimpact.files.reading import with_path
    from vibroimpact.signals.bounces.find import find_bounces
    from vibroimpact.signals.reading.one_record import one_record

    contact_duration = BRIEF
    acceleration = None
    drop_height = None
    if contact is not None:
        contact_duration = written_in("--contact", contact, "s")
    if gravity is not None:
        acceleration = written_in("--gravity", gravity, "m/s^2")
    if height is not None:
        drop_height = written_in("--height", height, "m")
    record = one_record(path, channel, columns)
    try:
        bounces = find_bounces(record, contact_duration)
        return rebounds_of(bounces, gravity=acceleration, height=drop_height)
    except InputError as error:
        raise with_path(path, error) from None
