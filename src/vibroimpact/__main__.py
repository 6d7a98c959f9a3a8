"""`python -m vibroimpact`, and the program that is installed: the command line."""

from __future__ import annotations

import signal

__all__ = ["main"]


def main() -> None:
    """Run the command line.

    An interrupt while the command line is loaded ends the process by the signal: nothing is under
    way yet, and as an exception it could be lost in a library that is being loaded. Later it raises
    KeyboardInterrupt, or sets the flag of a study.
    """
    hears_interrupts = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if hears_interrupts:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from vibroimpact.cli import main as run_command

    if hears_interrupts:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    run_command()


if __name__ == "__main__":
    main()
