"""What all commands share: the application, common options, the console, and how a run ends in failure."""

from __future__ import annotations

import io
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from vibroimpact.errors import lines_of
from vibroimpact.shown import visible

if TYPE_CHECKING:
    from rich.console import Console

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

        say(f"vibroimpact {__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and leave.")] = False,
) -> None:
    """What happens when a particle hits a plate: contact, energy and vibration, in a second."""


_LONGEST_STEM = 60  # what is added to it, here and while it is written, fits into the 255 bytes of a name on disk


def stem(case: str) -> str:
    """Return what a folder made from a case is called."""
    name = Path(case.removeprefix("paper:")).stem[:_LONGEST_STEM]
    return "".join(character if character.isprintable() else "_" for character in name)


def console() -> Console:
    """Return the console, wide where it is no terminal, in letters that it can show."""
    from vibroimpact.report.terminal import TerminalConsole

    screen = TerminalConsole()
    if not screen.is_terminal:
        screen = TerminalConsole(width=160)  # a pipe or a file has no width; tables must not be cut
    return screen


def say(text: str, *, err: bool = False) -> None:
    """Print lines, on standard error if so wanted, in letters that the stream has; what they name can't steer the terminal."""
    from vibroimpact.report.encodable import encodable

    stream, text = sys.stderr if err else sys.stdout, "\n".join(map(visible, text.split("\n")))
    print(encodable(text, getattr(stream, "encoding", None) or "ascii"), file=stream, flush=True)  # a closed pipe is told here, not at exit


def never_fail_to_print() -> None:
    """Let standard output and error give letters that they lack by their numbers, whatever prints them."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def names_in(text: str) -> list[str]:
    """Return the names in a text that are separated by commas."""
    return [name.strip() for name in text.split(",") if name.strip()]


def note(text: str) -> None:
    """Tell what takes long, apart from what the command prints."""
    say(f"vibroimpact: {text}", err=True)


@contextmanager
def whole_or_nothing() -> Iterator[None]:
    """Say on Ctrl-C that nothing was written: what is done inside is written whole at its end."""
    try:
        yield
    except KeyboardInterrupt:
        fail("interrupted; nothing was written", 130)


@contextmanager
def stopping(told: str) -> Iterator[Callable[[], bool]]:
    """Give a function that says whether Ctrl-C was pressed, so that what is under way can be finished; a second one ends all at once.

    An exception that is raised out of a signal may come up where nobody can pass it on, and be lost.

    Parameters
    ----------
    told : str
        What is said if it ends at once.
    """
    pressed = 0

    def press(*_: object) -> None:
        nonlocal pressed
        pressed += 1
        if pressed > 1:
            note(told)
            os._exit(130)  # whoever computes for this process ends with it
        note("stopping after the drops that are under way; Ctrl-C once more stops at once")

    before = {number: signal.signal(number, press) for number in (signal.SIGINT, signal.SIGTERM)}  # the second comes from schedulers
    try:
        yield lambda: pressed > 0
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def fail(message: str, status: int) -> NoReturn:
    """Say what went wrong, and leave with an exit status."""
    say("\n".join(f"vibroimpact: {line}" for line in lines_of(message.split("\n"))), err=True)
    sys.exit(status)
