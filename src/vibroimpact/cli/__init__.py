"""The command line: each command calls functions of the package and prints the result."""

from __future__ import annotations

import logging
import os
import sys
from pathlib import Path
from typing import Any

import typer

# each module adds its commands; the order is that of --help
from vibroimpact.cli import drops as drops  # isort: skip
from vibroimpact.cli import comparison as comparison  # isort: skip
from vibroimpact.cli import calibration as calibration  # isort: skip
from vibroimpact.cli import studies as studies  # isort: skip
from vibroimpact.cli import features as features  # isort: skip
from vibroimpact.cli import bound as bound  # isort: skip
from vibroimpact.cli import recognise as recognise  # isort: skip
from vibroimpact.cli import identify as identify  # isort: skip
from vibroimpact.cli import correlate as correlate  # isort: skip
from vibroimpact.cli import export as export  # isort: skip
from vibroimpact.cli import reproduction as reproduction  # isort: skip
from vibroimpact.cli import reference as reference  # isort: skip
from vibroimpact.cli import serve as serve  # isort: skip
from vibroimpact.cli.completion import PROGRAM, concerns_completion, whole_words
from vibroimpact.cli.shared import app, fail, never_fail_to_print, note_warnings
from vibroimpact.errors import LONGEST_LINE, ComputationError, InputError
from vibroimpact.quoting import shortened, visible

__all__ = ["app", "main"]


def main() -> None:
    """Run the command line; an error of the package becomes a message and an exit status."""
    never_fail_to_print()
    note_warnings()
    _isolate_matplotlib()
    try:
        sys.exit(_run())
    except InputError as error:
        fail(str(error), 2)
    except ComputationError as error:
        fail(str(error), 1)
    except MemoryError:
        fail(
            "there is not enough memory for this; ask for less: larger elements, fewer "
            "modes, a shorter run, record or table",
            1,
        )
    except BrokenPipeError:
        # the reader closed the pipe: exit quietly, with the remaining output discarded
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:
        fault = f"the computer says: {error.strerror or error}"
        if error.filename:
            fault = f"{shortened(visible(str(error.filename)), 200)}: {fault}"
        fail(fault, 1)


def _isolate_matplotlib() -> None:
    """Isolate this process from user settings of matplotlib, before it is imported."""
    os.environ["MPLBACKEND"] = "agg"
    os.environ["MATPLOTLIBRC"] = os.devnull
    # it logs each unknown line of a settings file
    logging.getLogger("matplotlib").setLevel(logging.CRITICAL)
    # one in the working directory is read regardless of MATPLOTLIBRC
    settings = Path("matplotlibrc")
    try:
        if settings.is_file():
            settings.read_text(encoding="utf-8")
    except (OSError, ValueError):
        fail(
            "matplotlibrc: this file in the working directory, with settings of matplotlib, "
            "can't be read as UTF-8 text; mend or rename it",
            2,
        )


def _run() -> int:
    """Run the command and return its exit status; typer's own errors are shown shortened."""
    # the name under which a shell completes, however the program was started
    name = PROGRAM if concerns_completion() else None
    try:
        with whole_words():
            return app(standalone_mode=False, prog_name=name) or 0
    except typer.Abort:
        fail("aborted", 1)
    except Exception as error:
        usage_error: Any = error
        # typer's own errors are told by their methods, since their class depends on its version
        if not (hasattr(usage_error, "show") and hasattr(usage_error, "exit_code")):
            raise
        lines = usage_error.message.split("\n")
        usage_error.message = "\n".join(shortened(visible(line), LONGEST_LINE) for line in lines)
        usage_error.show()
        return int(usage_error.exit_code)
