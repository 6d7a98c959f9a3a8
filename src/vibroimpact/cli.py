"""The command line. Every command is a public function of the package with its result printed."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from vibroimpact.errors import ComputationError, InputError

if TYPE_CHECKING:
    from rich.console import Console

    from vibroimpact.cases.schema import Case

# heavy imports live inside the commands, so that --help is quick

app = typer.Typer(
    name="vibroimpact",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

CaseArgument = Annotated[str, typer.Argument(metavar="CASE", help='A TOML file, or a shipped case such as "paper:type1-theory".')]
Force = Annotated[bool, typer.Option("--force", help="Replace an existing result folder.")]


def _show_version(wanted: bool) -> None:
    if wanted:
        from vibroimpact._version import __version__

        typer.echo(f"vibroimpact {__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and leave.")] = False,
) -> None:
    """What happens when a particle hits a plate: contact, energy and vibration, in a second."""


@app.command()
def demo(
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="The result folder to make.")] = Path("vibroimpact-demo"),
    force: Force = False,
) -> None:
    """Run the paper's Type 1 as a first example.

    A rock sphere falls 4 m on a steel plate and bounces five times.
    """
    _run("paper:type1-variable", output, force=force)


@app.command()
def run(
    case: CaseArgument,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="The result folder to make; by default named after the case.")
    ] = None,
    force: Force = False,
) -> None:
    """Run a case and write its result folder.

    The folder holds the case in full, the impact table, the data as NetCDF, figures, and a report.
    """
    _run(case, output, force=force)


@app.command()
def check(case: CaseArgument) -> None:
    """Validate a case and explain it; run nothing."""
    from vibroimpact.cases.reader import load_case
    from vibroimpact.report.console import case_explained

    _console().print(case_explained(load_case(case)))


@app.command()
def modes(
    case: CaseArgument,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="DIR", help="The folder to make; by default CASE-modes.")] = None,
    force: Force = False,
) -> None:
    """Compute the modes of the elastic bodies of a case.

    The folder holds a table of frequencies, pictures of the first modes, and the meshes for ParaView, Nastran and Abaqus.
    """
    from vibroimpact.cases.modes import compute_modes
    from vibroimpact.cases.reader import load_case
    from vibroimpact.report.modes_folder import save_modes
    from vibroimpact.report.modes_text import modes_summary
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.storage.folder import check_free

    found = load_case(case)
    target = Path(f"{_stem(case)}-modes") if output is None else output
    check_free(target, force=force)
    console = _console()
    try:
        with patient_progress("computing modes", console) as progress:
            bodies = compute_modes(found, progress, lambda text: typer.echo(f"vibroimpact: {text}", err=True))
        folder = save_modes(found, bodies, target, force=force)
    except KeyboardInterrupt:
        _fail("interrupted; nothing was written", 130)
    console.print(modes_summary(found, bodies))
    typer.echo(f"wrote {folder / 'modes.csv'}, and pictures and meshes beside it")


@app.command()
def compare(
    case: CaseArgument,
    laws: Annotated[str, typer.Option("--laws", metavar="A,B,C", help="The contact laws, separated by commas.")],
    given: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUE", help="A parameter for every law that has it, or LAW.KEY=VALUE for one; may be repeated."
        ),
    ] = None,
    achieving: Annotated[
        float | None,
        typer.Option("--achieving", metavar="E", help="Tune each law so that the first impact achieves this restitution."),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="The folder to make; by default CASE-compared.")
    ] = None,
    force: Force = False,
) -> None:
    """Run one case under several contact laws.

    Parameters that the case's own law has are used where another law has the same.
    """
    from vibroimpact.cases.reader import load_case
    from vibroimpact.report.comparison import compare_laws
    from vibroimpact.report.comparison_folder import save_comparison
    from vibroimpact.report.console import comparison_summary
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.storage.folder import check_free

    found = load_case(case)
    target = Path(f"{_stem(case)}-compared") if output is None else output
    check_free(target, force=force)
    console = _console()
    try:
        with patient_progress("comparing", console) as progress:
            comparison = compare_laws(
                found,
                [name.strip() for name in laws.split(",") if name.strip()],
                _settings(given or []),
                achieving=achieving,
                progress=progress,
            )
        folder = save_comparison(comparison, target, force=force)
    except KeyboardInterrupt:
        _fail("interrupted; nothing was written", 130)
    console.print(comparison_summary(comparison))
    typer.echo(f"wrote {folder / 'report.html'}")


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
    target = Path(f"{_stem(case)}-calibrated") if output is None else output
    check_free(target, force=force)
    console = _console()
    try:
        with patient_progress("calibrating", console) as progress:
            found = named(case, lambda: calibrate_case(what, progress, lambda text: typer.echo(f"vibroimpact: {text}", err=True)))
        folder = save_calibration(what.case, found, target, force=force)
    except KeyboardInterrupt:
        _fail("interrupted; nothing was written", 130)
    console.print(calibration_summary(what.case, found))
    typer.echo(f"wrote {folder / 'report.html'}")


@app.command()
def report(directory: Annotated[Path, typer.Argument(metavar="DIR", help="A result folder.")]) -> None:
    """Remake the report of a result folder."""
    from vibroimpact.report.save import remake_report

    typer.echo(f"wrote {remake_report(directory) / 'report.html'}")


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
        _console().print(format_table())
        return
    found = find_export_format(to)
    if directory is None:
        raise InputError(f"name the folder that is to be exported: vibroimpact export DIR --to {to}")
    drop = drop_of(directory)
    written = save_export(drop, found, default_output(directory, to) if output is None else output, force=force)
    _console().print(export_summary(drop, found, written))


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
    _console().print(shown)


@app.command()
def laws(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="Show one law, and draw its curves.")] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="PNG", help="The picture of its curves; by default NAME.png.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing picture.")] = False,
) -> None:
    """List the contact laws, or show one: equation, parameters, sources, and a picture of its curves."""
    from vibroimpact.report.law_sheet import law_sheet, law_table

    console = _console()
    if name is None:
        if output is not None:
            raise InputError("name the law that is to be drawn: vibroimpact laws NAME -o PNG")
        console.print(law_table(console.width))
        return
    from vibroimpact.report.law_curves import picture_path, save_law_picture

    sheet, target = law_sheet(name), picture_path(name, output)
    console.print(sheet)
    typer.echo()
    if target.exists() and not force:
        typer.echo(f"{target} is there already and was left as it is; --force draws it anew")
    else:
        typer.echo(f"wrote {save_law_picture(name, target)}")


@app.command()
def materials(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="Show one material, with the source of each number.")] = None,
) -> None:
    """List the shipped materials, or one with its sources."""
    from vibroimpact.report.console import material_sheet, material_table

    _console().print(material_sheet(name) if name else material_table())


@app.command()
def schema() -> None:
    """Print the JSON schema of a case file."""
    import json

    from vibroimpact.cases.schema import case_schema

    typer.echo(json.dumps(case_schema(), indent=2))


@app.command()
def doctor(
    clear_store: Annotated[bool, typer.Option("--clear-store", help="Empty the store of computed modes.")] = False,
) -> None:
    """Show versions and the store of modes, and test this installation."""
    from vibroimpact.doctor import diagnose, first_rebound_error
    from vibroimpact.report.console import versions_table

    if clear_store:
        from vibroimpact.structures.store import clear_store as clear

        typer.echo(f"removed {clear()} entries from the store of modes")
        return
    _console().print(versions_table(diagnose()))
    error = first_rebound_error()
    if not error < 2e-6:
        raise ComputationError(f"the self-test is off by {error:.1e}; reinstall the package")
    typer.echo(f"self-test passed: the paper's first rebound, off by {error:.1e}")


def main() -> None:
    """Run the command line; errors of the package end in one message and an exit status."""
    try:
        app()
    except InputError as error:
        _fail(str(error), 2)
    except ComputationError as error:
        _fail(str(error), 1)
    except MemoryError:
        _fail("there is not enough memory for this; use larger elements, or ask for less", 1)
    except KeyboardInterrupt:
        _fail("interrupted; nothing was written", 130)
    except BrokenPipeError:
        # the reader of our output has gone; leave quietly, as other tools do
        sys.stderr.close()
        sys.exit(1)
    except OSError as error:
        _fail(f"the computer says: {error.strerror or error}", 1)


def _run(name: str, output: Path | None, *, force: bool) -> None:
    from vibroimpact.cases.reader import load_case
    from vibroimpact.dynamics.simulate import simulate
    from vibroimpact.report.console import result_summary
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.report.save import save_result
    from vibroimpact.storage.folder import check_free, read_result

    case: Case = load_case(name)
    target = Path(_stem(name)) if output is None else output
    check_free(target, force=force)  # before the work, not after it
    console = _console()
    try:
        with patient_progress("computing modes", console) as progress:
            problem = case.to_problem(progress, lambda text: typer.echo(f"vibroimpact: {text}", err=True))
        with patient_progress("simulating", console) as progress:
            response = simulate(problem, progress)
        folder = save_result(response, target, force=force)
    except KeyboardInterrupt:
        _fail("interrupted; nothing was written", 130)
    console.print(result_summary(read_result(folder), console.width))
    typer.echo(f"wrote {folder / 'report.html'}")


def _stem(case: str) -> str:
    """Return what a folder made from a case is called."""
    return Path(case.removeprefix("paper:")).stem


def _settings(given: list[str]) -> dict[str, object]:
    """Read KEY=VALUE as a case file would: a number, a list, or a text with its unit."""
    import tomllib

    settings: dict[str, object] = {}
    for item in given:
        key, equals, value = item.partition("=")
        if not (equals and key.strip() and value.strip()):
            raise InputError(f'--set "{item}": give KEY=VALUE, such as restitution=0.7 or adams-impact.damping_max=180')
        try:
            settings[key.strip()] = tomllib.loads(f"value = {value}")["value"]
        except ValueError:
            settings[key.strip()] = value.strip()  # 5 mm needs no quotes here
    return settings


def _console() -> Console:
    from rich.console import Console

    console = Console()
    if not console.is_terminal:
        console = Console(width=160)  # a pipe or a file has no width; tables must not be cut
    return console


def _fail(message: str, status: int) -> NoReturn:
    typer.echo("\n".join(f"vibroimpact: {line}" for line in message.splitlines()), err=True)
    sys.exit(status)


if __name__ == "__main__":
    main()
