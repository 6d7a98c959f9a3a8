"""The command line. Every command is a public function of the package with its result printed."""

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
from vibroimpact.cli import export as export  # isort: skip
from vibroimpact.cli import reproduction as reproduction  # isort: skip
from vibroimpact.cli import reference as reference  # isort: skip
from vibroimpact.cli.shared import app, fail, never_fail_to_print
from vibroimpact.errors import LONGEST_LINE, ComputationError, InputError
from vibroimpact.shown import shortened, visible

__all__ = ["app", "main"]


def main() -> None:
    """Run the command line; errors of the package end in one message and an exit status."""
    never_fail_to_print()
    _set_matplotlib_aside()
    try:
        sys.exit(_run())
    except InputError as error:
        fail(str(error), 2)
    except ComputationError as error:
        fail(str(error), 1)
    except MemoryError:
        fail("there is not enough memory for this; use larger elements, or ask for less", 1)
    except BrokenPipeError:
        # the reader of our output has gone; leave quietly, as other tools do, with what is still to be written
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:
        where = f"{shortened(visible(str(error.filename)), 200)}: " if error.filename else ""
        fail(f"{where}the computer says: {error.strerror or error}", 1)


def _set_matplotlib_aside() -> None:
    """Keep what somebody has set for figures of their own from this process, before matplotlib reads it."""
    os.environ["MPLBACKEND"], os.environ["MATPLOTLIBRC"] = "agg", os.devnull
    logging.getLogger("matplotlib").setLevel(logging.CRITICAL)  # it tells of each line that it does not know
    settings = Path("matplotlibrc")  # that of the folder one stands in is read in any case
    try:
        settings.read_text(encoding="utf-8") if settings.is_file() else None
    except (OSError, ValueError):
        fail("matplotlibrc: this file, with which matplotlib sets itself, is not UTF-8 text; mend it, or rename it", 2)


def _run() -> int:
    """Run the command; return its exit status. A wrong option is shown as typer shows it, but cleaned."""
    try:
        return app(standalone_mode=False) or 0
    except typer.Abort:
        fail("aborted", 1)
    except Exception as error:
        wrong: Any = error
        if not (hasattr(wrong, "show") and hasattr(wrong, "exit_code")):  # typer's own errors; their class moves from version to version
            raise
        wrong.message = "\n".join(shortened(visible(line), LONGEST_LINE) for line in wrong.message.split("\n"))
        wrong.show()
        return int(wrong.exit_code)
