"""The command line. Every command is a public function of the package with its result printed."""

from __future__ import annotations

import os
import sys

# each module adds its commands; the order is that of --help
from vibroimpact.cli import drops as drops  # isort: skip
from vibroimpact.cli import comparison as comparison  # isort: skip
from vibroimpact.cli import calibration as calibration  # isort: skip
from vibroimpact.cli import studies as studies  # isort: skip
from vibroimpact.cli import export as export  # isort: skip
from vibroimpact.cli import reproduction as reproduction  # isort: skip
from vibroimpact.cli import reference as reference  # isort: skip
from vibroimpact.cli.shared import app, fail, never_fail_to_print
from vibroimpact.errors import ComputationError, InputError

__all__ = ["app", "main"]


def main() -> None:
    """Run the command line; errors of the package end in one message and an exit status."""
    never_fail_to_print()
    try:
        app()
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
        where = f"{error.filename}: " if error.filename else ""
        fail(f"{where}the computer says: {error.strerror or error}", 1)
