"""Commands about the parameters of contacts: found from a rebound, written for other programs, in other units."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.shared import CaseArgument, Force, app, console, fail, note, stem
from vibroimpact.errors import InputError


@app.command()
def calibrate(
    case: CaseArgument,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="The folder to make; by default CASE-calibrated.")
    ] = None,
    force: Force = False,
) -> None:
    """Find the damping with which a sphere bounces as it is wanted to, or was measured to.

    The [calibrate] section of the case says what to match: a contact law, a restitution, or measurements. Without it the
    damping of Adams' IMPACT is found with which the sphere bounces as under the law of the case.
    """
    from vibroimpact.cases.calibration import calibrate_case, load_calibration
    from vibroimpact.cases.reader import named
    from vibroimpact.report.calibration_folder import save_calibration
    from vibroimpact.report.calibration_text import calibration_summary
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.storage.folder import check_free

    what = load_calibration(case)
    target = Path(f"{stem(case)}-calibrated") if output is None else output
    check_free(target, force=force)
    screen = console()
    try:
        with patient_progress("calibrating", screen) as progress:
            found = named(case, lambda: calibrate_case(what, progress, note))
        folder = save_calibration(what.case, found, target, force=force)
    except KeyboardInterrupt:
        fail("interrupted; nothing was written", 130)
    screen.print(calibration_summary(what.case, found))
    typer.echo(f"wrote {folder / 'report.html'}")


@app.command()
def export(
    directory: Annotated[Path | None, typer.Argument(metavar="[DIR]", help="A result folder, or a calibration folder.")] = None,
    to: Annotated[str | None, typer.Option("--to", metavar="FORMAT", help="The format; without it the formats are listed.")] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="PATH", help="The folder, or the file if there is one; by default the folder DIR-FORMAT."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace files of the same names.")] = False,
    formats: Annotated[bool, typer.Option("--formats", help="List the formats.")] = False,
) -> None:
    """Write a result in a format of another program, or list the formats.

    What the format can't hold is said, and what the writer was tested against.
    """
    from vibroimpact.exchange.export_format import find_export_format
    from vibroimpact.report.format_table import export_summary, format_table
    from vibroimpact.storage.export_result import default_output, save_export
    from vibroimpact.storage.exported import drop_of

    if formats and (to is not None or output is not None or force):
        raise InputError("--formats lists them, and takes no other option")
    if formats or to is None:
        if output is not None or force:
            raise InputError("name the format: vibroimpact export DIR --to FORMAT")
        console().print(format_table())
        return
    found = find_export_format(to)
    if directory is None:
        raise InputError(f"name the folder that is to be exported: vibroimpact export DIR --to {to}")
    drop = drop_of(directory)
    written = save_export(drop, found, default_output(directory, to) if output is None else output, force=force)
    console().print(export_summary(drop, found, written))


@app.command(context_settings={"ignore_unknown_options": True})  # a number may be negative
def units(
    quantity: Annotated[list[str], typer.Argument(metavar="NUMBER UNIT", help='Such as 5.115e8 N/m^1.5, or "179.75 N s/m".')],
    to: Annotated[
        str | None, typer.Option("--to", metavar="UNIT", help="In quotes if it has blanks; without it the common unit systems are shown.")
    ] = None,
) -> None:
    """Convert a parameter of a contact to another unit.

    A stiffness in N/m^n is 1000^n times one in N/mm^n, not 1000 times.
    """
    from vibroimpact.report.unit_table import converted, unit_table
    from vibroimpact.units import read_quantity

    try:
        value, unit = read_quantity(" ".join(quantity))
        shown = unit_table(value, unit) if to is None else converted(value, unit, to)
    except InputError as error:
        hint = '; a unit with blanks needs quotes, as in --to "N s/mm"' if to and " " not in to and len(quantity) > 2 else ""
        raise InputError(f"{error}{hint}") from None
    console().print(shown)
