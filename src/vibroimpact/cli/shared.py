"""What commands share: the application, options, output, and exits on failure or interrupt."""

from __future__ import annotations

import io
import os
import signal
import sys
import tomllib
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from vibroimpact.cli.completion import complete_case, complete_change
from vibroimpact.errors import (
    ChartWarning,
    InputError,
    LeftOutWarning,
    SlowLawWarning,
    lines_of,
)
from vibroimpact.quoting import visible

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

    from vibroimpact.report.report import Report
    from vibroimpact.report.reported import Reported
    from vibroimpact.units.written import Written

# heavy imports are inside the commands, so that --help is fast

app = typer.Typer(
    name="vibroimpact",
    no_args_is_help=True,
    add_completion=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

CaseArgument = Annotated[
    str,
    typer.Argument(
        metavar="CASE",
        autocompletion=complete_case,
        help='A TOML file, or a shipped case such as "paper:type1-theory".',
    ),
]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        autocompletion=complete_change,
        help='Change the value of a key, such as plate.size.thickness="10 mm"; may be repeated.',
    ),
]
Columns = Annotated[
    str | None,
    typer.Option(
        "--columns",
        metavar="NAME=UNIT,...",
        help=(
            'Columns of the tables in place of their headers, such as "time=s,-,force=N", '
            "with - for one that is left out; "
            'without times with the rate of the rows, "rate=10 kHz,force=N".'
        ),
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Replace an existing result folder.")]
Json = Annotated[
    bool,
    typer.Option(
        "--json", help="Print one JSON document instead of tables, in SI units and full precision."
    ),
]
Figures = Annotated[
    bool, typer.Option("--figures", help="Write the charts of the report as files too, as PNG.")
]


def output_folder(default: str) -> Any:
    """Return the option of the folder that a command makes; `default` is its name without one."""
    return typer.Option(
        "-o", "--output", metavar="DIR", help=f"The folder to make; by default {default}."
    )


def _show_version(wanted: bool) -> None:
    if wanted:
        from vibroimpact._version import __version__

        say(f"vibroimpact {__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    """Simulate the impact of a particle on a plate: contact force, restitution, energy
    and vibration.
    """


# leaves room, within the 255 bytes of a file name, for the suffixes of the commands and of exports
_LONGEST_STEM = 60


def stem(case: str) -> str:
    """Return the base name of folders for a case: its file name, shortened and printable."""
    path = Path(case.removeprefix("paper:").removeprefix("signals:"))
    name = path.stem[:_LONGEST_STEM]
    return "".join(character if character.isprintable() else "_" for character in name)


def settings_of(
    texts: list[str] | None, example: str = 'plate.size.thickness="10 mm"'
) -> dict[str, Any]:
    """Return the values that `--set` gives by key, read as in a case file.

    A text, also with a unit, needs no quotes.

    Examples
    --------
    >>> settings_of(
    ...     [
    ...         "run.impacts=3",
    ...         "plate.size.thickness=10 mm",
    ...         "contact.law=flores",
    ...         "drop.position=[0.1, 0]",
    ...     ]
    ... )
    {'run.impacts': 3, 'plate.size.thickness': '10 mm', 'contact.law': 'flores', 'drop.position':
    [0.1, 0]}
    """
    settings: dict[str, Any] = {}
    for text in texts or ():
        key, sign, value = map(str.strip, text.partition("="))
        if not (sign and value and all(key.split("."))):
            raise InputError(f'--set "{text}": give KEY=VALUE, such as {example}')
        try:
            settings[key] = tomllib.loads(f"value = {value}")["value"]
        except (ValueError, RecursionError):  # a text without quotes, such as 10 mm
            settings[key] = value
    return settings


def console(*, err: bool = False) -> Console:
    """Return the console of standard output, or of standard error."""
    from vibroimpact.report.console import TerminalConsole

    terminal = TerminalConsole(stderr=err)
    if terminal.is_terminal:
        return terminal
    return TerminalConsole(width=160, stderr=err)  # a pipe or a file has no width of its own


def show(
    document: Callable[[], Mapping[str, Any]], *tables: Callable[[], RenderableType], as_json: bool
) -> None:
    """Print tables, each as soon as it is made, or the document with their data as JSON.

    Parameters
    ----------
    document : callable
        Returns the data, with the names and units of the data files.
    *tables : callable
        Each returns what is printed in a terminal.
    as_json : bool
        Whether the document is printed, and nothing else on standard output.
    """
    if as_json:
        from vibroimpact.files.json_text import json_text

        print(json_text(document()), flush=True)
    else:
        screen = console()
        for table in tables:
            screen.print(table())


def show_folder(
    folder: Path,
    document: Callable[[], Mapping[str, Any]],
    *tables: Callable[[], RenderableType],
    as_json: bool,
    beside: str = "",
) -> None:
    """Print what a folder with a report holds, as `show` does, and that it was written.

    `beside` names what else was written.
    """
    from vibroimpact.files.result_folder import REPORT

    show(lambda: {"folder": str(folder), **document()}, *tables, as_json=as_json)
    also = f", and {beside} beside it" if beside else ""
    say(f"wrote {folder / REPORT}{also}", err=as_json)


def save_and_show(
    finding: Reported, target: Path, *, force: bool, figures: bool = False, as_json: bool
) -> None:
    """Write the folder of a finding, and print its report; or its data as JSON.

    Parameters
    ----------
    finding : Reported
        The finding.
    target : pathlib.Path
        The folder to make.
    force : bool
        Whether an existing result folder is replaced.
    figures : bool
        Whether the charts are written as PNG too.
    as_json : bool
        Whether the data are printed, and nothing else on standard output.
    """
    with exit_on_interrupt():
        report = finding.report
    write_and_show(report, target, force=force, figures=figures, as_json=as_json)


def write_and_show(
    report: Report,
    target: Path,
    *,
    force: bool,
    figures: bool = False,
    as_json: bool,
    beside: str = "",
) -> None:
    """Write the folder of a report, and print it; or its data as JSON.

    `save_and_show` and `show_folder` have the other parameters.
    """
    from vibroimpact.report.save_report import save_report
    from vibroimpact.report.terminal_report import terminal_report

    formats = ("png",) if figures else ()
    with exit_on_interrupt():
        folder = save_report(report, target, force=force, figures=formats)
    show_folder(
        folder,
        lambda: report.document,
        lambda: terminal_report(report),
        as_json=as_json,
        beside=beside,
    )


@contextmanager
def progress_of(activity: str, *, as_json: bool) -> Iterator[Callable[[float], None]]:
    """Show the progress of a command, and yield what is called with the fraction done.

    Ctrl-C exits with the message that nothing was written.
    """
    from vibroimpact.report.progress import patient_progress

    with exit_on_interrupt(), patient_progress(activity, console(err=as_json)) as progress:
        yield progress


def say(text: str, *, err: bool = False) -> None:
    """Print lines in the encoding of the stream, with control characters escaped."""
    from vibroimpact.report.encodable import encodable

    stream = sys.stderr if err else sys.stdout
    encoding = getattr(stream, "encoding", None) or "ascii"
    printable = "\n".join(map(visible, text.split("\n")))
    # flushed, so that a closed pipe raises here and not at exit
    print(encodable(printable, encoding), file=stream, flush=True)


def never_fail_to_print() -> None:
    """Let standard output and error escape characters that they can't encode."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def names_in(text: str) -> list[str]:
    """Return the comma-separated names in a text."""
    return [name.strip() for name in text.split(",") if name.strip()]


def pair_in(option: str, text: str, unit: str, what: str, example: str) -> tuple[float, float]:
    """Return two quantities in the text of an option, in SI.

    Examples
    --------
    >>> pair_in("--place", "60 mm, 40 mm", "m", "x and y", "60 mm, 40 mm")
    (0.06, 0.04)
    """
    quantities = names_in(text)
    if len(quantities) != 2 or text.count(",") != 1:
        raise InputError(
            f'{option} "{text}": give {what}, separated by a comma, such as "{example}"'
        )
    first, second = (quantity_in(option, quantity, unit) for quantity in quantities)
    return first, second


def quantity_in(option: str, text: str, unit: str) -> float:
    """Return the value of an option in SI; a bare number is in SI already.

    Examples
    --------
    >>> quantity_in("--window", "0.04", "s"), quantity_in("--window", "40 ms", "s")
    (0.04, 0.04)
    """
    from vibroimpact.units.quantity_text import number_and_unit
    from vibroimpact.units.reading import to_si

    value: float | str = text
    quantity = number_and_unit(text)
    if quantity is not None and not quantity[1]:
        value = quantity[0]
    try:
        return to_si(value, unit)
    except InputError as error:
        raise InputError(error.message, option) from None


def written_in(option: str, text: str, unit: str) -> Written:
    """Return the value of an option in SI with its standard deviation.

    This is given in the text, or left open by its digits.

    Examples
    --------
    >>> (
    ...     written_in("--height", "0.30 m +- 5 mm", "m").deviation,
    ...     round(written_in("--height", "0.30", "m").deviation, 5),
    ... )
    (0.005, 0.00289)
    """
    from vibroimpact.units.quantity_text import number_and_unit
    from vibroimpact.units.written import read_written

    quantity = number_and_unit(text)
    if quantity is not None and not quantity[1] and unit:
        text = f"{text} {unit}"
    try:
        return read_written(text, unit)
    except InputError as error:
        raise InputError(error.message, option) from None


def note(text: str) -> None:
    """Print a note on standard error, apart from the output of the command."""
    say(f"vibroimpact: {text}", err=True)


def note_warnings() -> None:
    """Show the warnings of the package as notes."""
    show_as_python_does = warnings.showwarning
    left_out: set[str] = set()  # a command may read its case more than once

    def show_warning(
        message: Warning | str, category: type[Warning], *location: Any, **options: Any
    ) -> None:
        if issubclass(category, LeftOutWarning) and str(message) in left_out:
            return
        if issubclass(category, LeftOutWarning):
            left_out.add(str(message))
        if issubclass(category, ChartWarning | LeftOutWarning | SlowLawWarning):
            note(str(message))
        else:
            show_as_python_does(message, category, *location, **options)

    warnings.simplefilter("always", ChartWarning)
    warnings.simplefilter("always", SlowLawWarning)
    warnings.simplefilter("always", LeftOutWarning)
    warnings.showwarning = show_warning


@contextmanager
def exit_on_interrupt() -> Iterator[None]:
    """Exit on Ctrl-C with the message that nothing was written.

    What is written inside must be written atomically, at the end.
    """
    try:
        yield
    except KeyboardInterrupt:
        fail("interrupted; nothing was written", 130)


@contextmanager
def interrupt_flag(message: str) -> Iterator[Callable[[], bool]]:
    """Yield a function that returns whether SIGINT or SIGTERM was received; a second one exits.

    Running work can then finish. An exception raised in a signal handler can surface where it is
    swallowed, and be lost.

    Parameters
    ----------
    message : str
        Message printed on an immediate exit.
    """
    received = 0

    def receive(*_: object) -> None:
        nonlocal received
        received += 1
        if received > 1:
            note(message)
            os._exit(130)  # worker processes end with this one
        note("stopping after what is under way; Ctrl-C once more stops at once")

    # schedulers send SIGTERM
    previous_handlers = {
        number: signal.signal(number, receive) for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield lambda: received > 0
    finally:
        for number, handler in previous_handlers.items():
            signal.signal(number, handler)


def fail(message: str, status: int) -> NoReturn:
    """Print an error message and exit with a status."""
    lines = [f"vibroimpact: {line}" for line in lines_of(message.split("\n"))]
    say("\n".join(lines), err=True)
    sys.exit(status)
