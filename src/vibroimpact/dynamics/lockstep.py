"""What goes on by steps that are solved together with those of others: the stretches of contact of several systems, round by round."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
from typing import Any, Protocol, TypeVar

import numpy as np


class Problem(Protocol):
    """What a course asks for."""

    @property
    def kind(self) -> object:
        """What has to be the same for problems that are solved together."""


Asked = TypeVar("Asked", bound=Problem)
Solved = TypeVar("Solved")
Result = TypeVar("Result")


def in_lockstep(courses: Iterable[Generator[Asked, Solved, Result]], solve: Callable[[Sequence[Asked]], Sequence[Solved]]) -> list[Result]:
    """Return what comes of courses: each yields problems, gets them back solved, and returns what came of it.

    Parameters
    ----------
    courses : iterable of generator
        They go on round by round.
    solve : callable
        Solves problems of one kind together.
    """
    running = dict(enumerate(courses))
    found: dict[int, Result] = {}
    alike: dict[object, list[tuple[int, Asked]]] = {}

    def go_on(number: int, solved: Any) -> None:
        try:
            problem = running[number].send(solved)
        except StopIteration as end:
            found[number] = end.value
        else:
            alike.setdefault(problem.kind, []).append((number, problem))

    with np.errstate(all="ignore"):  # guesses may be wild; what is not finite is found and tried again
        for number in running:
            go_on(number, None)
        while alike:
            groups = list(alike.values())
            alike.clear()
            for group in groups:
                for (number, _), solved in zip(group, solve([problem for _, problem in group]), strict=True):
                    go_on(number, solved)
    return [found[number] for number in running]
