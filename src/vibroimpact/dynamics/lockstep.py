"""Concurrent simulation of many drops: coroutines yield subproblems, which are solved in groups of one kind.

Each drop is a generator. In each round all generators run until they yield subproblems, such as stretches of contact; those of the same
kind are solved together as arrays, and the solutions are sent back.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from typing import Any, Protocol, Self, TypeVar

import numpy as np

_MOST_COORDINATES = 30_000  # in one group, so that its arrays fit in the processor's cache


class Subproblem(Protocol):
    """A subproblem that a coroutine yields, to be solved together with others of its kind."""

    @property
    def kind(self) -> object:
        """Key that subproblems must share to be solved together."""

    @property
    def size(self) -> int:
        """Number of coordinates, by which the size of groups is limited."""

    @classmethod
    def solve_group(cls, problems: Sequence[Self]) -> Sequence[Any]:
        """Return the solutions of subproblems of one kind."""


Result = TypeVar("Result")
Coroutine = Generator[list[Any], list[Any], Result]
"""A generator that yields lists of subproblems, receives their solutions, and returns a result."""


def solve(problem: Subproblem) -> Coroutine[Any]:
    """Yield one subproblem and return its solution, or raise the exception that its solver raised."""
    (found,) = yield [problem]
    if isinstance(found, Exception):
        raise found
    return found


def run_in_lockstep(coroutines: Iterable[Coroutine[Result]]) -> Coroutine[list[Result]]:
    """Return the results of several coroutines, combined into one: each round yields the subproblems of all that are still running."""
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
    """Run a coroutine to its end, solving its subproblems in groups, and return its result."""
    with np.errstate(all="ignore"):  # Newton iterates may overflow; results that are not finite are detected and retried
        try:
            problems = next(coroutine)
            while True:
                problems = coroutine.send(_solve_in_groups(problems))
        except StopIteration as end:
            found: Result = end.value
            return found


def _solve_in_groups(problems: list[Any]) -> list[Any]:
    """Return the solutions of subproblems in order, solved in groups of the same type and kind."""
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
    """Return the solutions of subproblems of one kind; in place of a failed one, the exception."""
    try:
        return list(problems[0].solve_group(problems))
    except Exception as error:  # raised by a user's contact law, for example: solve one by one, so that only that drop fails
        if len(problems) == 1:
            return [error]
        return [found for problem in problems for found in _solve_group([problem])]
