"""Runs several generators round by round, and solves what they ask for in groups: many drops at once."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from typing import Any, Protocol, Self, TypeVar

import numpy as np

_MOST_COORDINATES = 30_000  # coordinates that are computed at once: their arrays stay in the cache


class Subproblem(Protocol):
    """What a course asks for."""

    @property
    def kind(self) -> object:
        """What has to be the same for problems that are solved together."""

    @property
    def size(self) -> int:
        """How many coordinates it has."""

    @classmethod
    def solve_group(cls, problems: Sequence[Self]) -> Sequence[Any]:
        """Return the solutions of problems of one kind."""


Result = TypeVar("Result")
Coroutine = Generator[list[Any], list[Any], Result]
"""A computation that yields lists of problems, gets back their solutions, and returns what came of it."""


def solve(problem: Subproblem) -> Coroutine[Any]:
    """Return the solution of a problem, or raise what kept it from being solved."""
    (found,) = yield [problem]
    if isinstance(found, Exception):
        raise found
    return found


def run_in_lockstep(coroutines: Iterable[Coroutine[Result]]) -> Coroutine[list[Result]]:
    """Return what comes of courses, as one course: in each round all that go on ask for what they need next."""
    running = list(coroutines)
    found: dict[int, Result] = {}
    pending: dict[int, list[Any]] = {}

    def advance(number: int, solutions: list[Any] | None) -> None:
        try:
            pending[number] = running[number].send(solutions)  # type: ignore[arg-type]
        except StopIteration as end:
            pending.pop(number, None)
            found[number] = end.value

    for number in range(len(running)):
        advance(number, None)
    while pending:
        counts = [(number, len(problems)) for number, problems in pending.items()]
        solutions = iter((yield [problem for problems in pending.values() for problem in problems]))
        for number, count in counts:
            advance(number, [next(solutions) for _ in range(count)])
    return [found[number] for number in range(len(running))]


def run_coroutine(coroutine: Coroutine[Result]) -> Result:
    """Return what comes of a course, whose problems are solved in groups of a kind."""
    with np.errstate(all="ignore"):  # guesses may be wild; what is not finite is found and tried again
        try:
            problems = next(coroutine)
            while True:
                problems = coroutine.send(_solve_in_groups(problems))
        except StopIteration as end:
            found: Result = end.value
            return found


def _solve_in_groups(problems: list[Any]) -> list[Any]:
    groups: dict[object, list[int]] = {}
    for number, problem in enumerate(problems):
        groups.setdefault((type(problem), problem.kind), []).append(number)
    found: dict[int, Any] = {}
    for numbers in groups.values():
        first = problems[numbers[0]]
        most = max(_MOST_COORDINATES // max(first.size, 1), 1)
        for begin in range(0, len(numbers), most):
            chunk = numbers[begin : begin + most]
            found.update(zip(chunk, _solve_group([problems[number] for number in chunk]), strict=True))
    return [found[number] for number in range(len(problems))]


def _solve_group(problems: list[Any]) -> list[Any]:
    """Return the solutions of problems of one kind; in place of one, what it raises."""
    try:
        return list(problems[0].solve_group(problems))
    except Exception as error:  # as of a law of another package, which must not end the others
        if len(problems) == 1:
            return [error]
        return [found for problem in problems for found in _solve_group([problem])]
