"""Runs several generators round by round, and solves what they ask for in groups: many drops at once."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from typing import Any, Protocol, Self, TypeVar

import numpy as np

_TOGETHER = 30_000  # coordinates that are computed at once: their arrays stay in the cache


class Problem(Protocol):
    """What a course asks for."""

    @property
    def kind(self) -> object:
        """What has to be the same for problems that are solved together."""

    @property
    def size(self) -> int:
        """How many coordinates it has."""

    @classmethod
    def solved(cls, problems: Sequence[Self]) -> Sequence[Any]:
        """Return the solutions of problems of one kind."""


Result = TypeVar("Result")
Course = Generator[list[Any], list[Any], Result]
"""A computation that yields lists of problems, gets back their solutions, and returns what came of it."""


def asked(problem: Problem) -> Course[Any]:
    """Return the solution of a problem, or raise what kept it from being solved."""
    (found,) = yield [problem]
    if isinstance(found, Exception):
        raise found
    return found


def side_by_side(courses: Iterable[Course[Result]]) -> Course[list[Result]]:
    """Return what comes of courses, as one course: in each round all that go on ask for what they need next."""
    running = list(courses)
    found: dict[int, Result] = {}
    asked: dict[int, list[Any]] = {}

    def go_on(number: int, solutions: list[Any] | None) -> None:
        try:
            asked[number] = running[number].send(solutions)  # type: ignore[arg-type]
        except StopIteration as end:
            asked.pop(number, None)
            found[number] = end.value

    for number in range(len(running)):
        go_on(number, None)
    while asked:
        counts = [(number, len(problems)) for number, problems in asked.items()]
        solutions = iter((yield [problem for problems in asked.values() for problem in problems]))
        for number, count in counts:
            go_on(number, [next(solutions) for _ in range(count)])
    return [found[number] for number in range(len(running))]


def computed(course: Course[Result]) -> Result:
    """Return what comes of a course, whose problems are solved in groups of a kind."""
    with np.errstate(all="ignore"):  # guesses may be wild; what is not finite is found and tried again
        try:
            problems = next(course)
            while True:
                problems = course.send(_solved(problems))
        except StopIteration as end:
            found: Result = end.value
            return found


def _solved(problems: list[Any]) -> list[Any]:
    groups: dict[object, list[int]] = {}
    for number, problem in enumerate(problems):
        groups.setdefault((type(problem), problem.kind), []).append(number)
    found: dict[int, Any] = {}
    for numbers in groups.values():
        first = problems[numbers[0]]
        most = max(_TOGETHER // max(first.size, 1), 1)
        for begin in range(0, len(numbers), most):
            some = numbers[begin : begin + most]
            found.update(zip(some, _solved_alike([problems[number] for number in some]), strict=True))
    return [found[number] for number in range(len(problems))]


def _solved_alike(problems: list[Any]) -> list[Any]:
    """Return the solutions of problems of one kind; in place of one, what it raises."""
    try:
        return list(problems[0].solved(problems))
    except Exception as error:  # as of a law of another package, which must not end the others
        if len(problems) == 1:
            return [error]
        return [found for problem in problems for found in _solved_alike([problem])]
