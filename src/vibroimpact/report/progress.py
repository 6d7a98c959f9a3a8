"""Progress bars: one for a fraction done, shown after a delay of a second, and one for a
count of items.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text

_DELAY = 1.0  # seconds


@contextmanager
def patient_progress(what: str, console: Console) -> Iterator[Callable[[float], None]]:
    """Yield a callback for the fraction done, in [0, 1]; the bar appears after one
    second, and only on a terminal.
    """
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
    )
    task = bar.add_task(what, total=1.0)
    begin = time.monotonic()
    shown = False

    def update(fraction: float) -> None:
        nonlocal shown
        if not shown and console.is_terminal and time.monotonic() - begin > _DELAY:
            shown = True
            bar.start()
        if shown:
            bar.update(task, completed=fraction)

    try:
        yield update
    finally:
        if shown:  # stopping a bar that was never started prints an empty line
            bar.stop()


@contextmanager
def counting_progress(what: str, console: Console) -> Iterator[Callable[[int, int | None], None]]:
    """Yield a callback for the items done and their total, None if it is not known; the
    bar shows the rate, and only on a terminal.
    """
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        _Rate(),
        TimeRemainingColumn(),
    )
    bar = Progress(
        *columns,
        console=console,
        transient=True,
        disable=not console.is_terminal,
        speed_estimate_period=60.0,
    )
    task = None

    def update(done: int, total: int | None) -> None:
        nonlocal task
        if task is None:  # items of an earlier run must not count for the rate
            task = bar.add_task(what, total=total, completed=done)
        bar.update(task, completed=done)

    with bar:
        yield update


class _Rate(ProgressColumn):
    """Column with the items per second."""

    def render(self, task: Task) -> Text:
        if task.speed is None:
            return Text("")
        if task.speed < 100:
            return Text(f"{task.speed:,.3g}/s")
        return Text(f"{task.speed:,.0f}/s")
