"""A progress bar that shows itself only when work takes longer than a second."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

_PATIENCE = 1.0  # seconds


@contextmanager
def patient_progress(what: str, console: Console) -> Iterator[Callable[[float], None]]:
    """Give a function that is told the fraction done, in [0, 1]; silent for the first second and off a terminal."""
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
    )
    task = bar.add_task(what, total=1.0)
    begin, shown = time.monotonic(), False

    def tell(fraction: float) -> None:
        nonlocal shown
        if not shown and console.is_terminal and time.monotonic() - begin > _PATIENCE:
            shown = True
            bar.start()
        if shown:
            bar.update(task, completed=fraction)

    try:
        yield tell
    finally:
        if shown:  # one that was never started would leave an empty line
            bar.stop()
