"""Progress bars: one that shows itself only when work takes longer than a second, and one that counts what is done."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, Task, TextColumn, TimeRemainingColumn
from rich.text import Text

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


@contextmanager
def counting_progress(what: str, console: Console) -> Iterator[Callable[[int, int], None]]:
    """Give a function that is told how many are done and of how many; it shows their rate and the time left, on a terminal alone."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        _Rate(),
        TimeRemainingColumn(),
    )
    bar = Progress(*columns, console=console, transient=True, disable=not console.is_terminal, speed_estimate_period=60.0)
    task = None

    def tell(done: int, total: int) -> None:
        nonlocal task
        if task is None:  # what was done before does not count for the rate
            task = bar.add_task(what, total=total, completed=done)
        bar.update(task, completed=done)

    with bar:
        yield tell


class _Rate(ProgressColumn):
    """How many a second."""

    def render(self, task: Task) -> Text:
        return Text("" if task.speed is None else f"{task.speed:,.3g}/s" if task.speed < 100 else f"{task.speed:,.0f}/s")
