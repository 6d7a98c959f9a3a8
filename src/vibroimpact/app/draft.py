"""The result of a drop while it is being changed: with fewer points, and without doubts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from vibroimpact.dynamics.motion.columns import MOTION_COLUMNS
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.results.deflection import deflection_of
from vibroimpact.results.peaks import FREQUENCIES, MAXIMA, frequencies_of, peaks_of
from vibroimpact.results.result import Result, bare_result, result_of

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis

_TOLERANCE = 1e-6
"""Tolerance of a draft: its numbers are right to six digits."""

_POINTS = 1000
"""Points of its history, about."""

_FRAMES = 36
"""Frames of the plate in motion."""


class _Deferred(Mapping[str, Any]):
    """Mapping whose values are computed group by group, at the first access to one of the group."""

    def __init__(self, *groups: tuple[Iterable[str], Callable[[], Mapping[str, Any]]]) -> None:
        self._compute: dict[str, Callable[[], Mapping[str, Any]]] = {}
        for names, compute in groups:
            self._compute |= dict.fromkeys(names, cache(compute))

    def __getitem__(self, name: str) -> Any:
        return self._compute[name]()[name]

    def __contains__(self, name: object) -> bool:
        return name in self._compute

    def __iter__(self) -> Iterator[str]:
        return iter(self._compute)

    def __len__(self) -> int:
        return len(self._compute)


def drafted(problem: Problem) -> Problem:
    """Return the problem that is simulated for a draft.

    Its numbers are right to six digits, and the growth of small changes is not computed.
    """
    return replace(problem, tolerance=max(problem.tolerance, _TOLERANCE), sensitivity=False)


def draft_of(response: Response) -> Result:
    """Return the result of a response to one drop, with a history of about 1000 points.

    Of the history, the peaks and the signals only what is looked at is computed. For rigid bodies
    it is the result itself, which takes no time.
    """
    problem = response.problem
    if not problem.vibrates:
        return result_of(response)
    further_columns = [name for name in response.history_columns if name not in MOTION_COLUMNS]
    history = _Deferred(
        (MOTION_COLUMNS, partial(response.history, _POINTS, MOTION_COLUMNS)),
        (further_columns, partial(response.history, _POINTS, further_columns)),
    )
    signals = _Deferred(([sensor.name for sensor in problem.sensors], response.signals))
    return bare_result(
        response,
        history,
        _peaks(response, history),
        signals,
        deflection_of(response, _FRAMES),
    )


def _peaks(response: Response, history: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Return peaks and frequencies of each body that vibrates."""
    maxima = cache(lambda: peaks_of(response, history))

    def peaks_of_body(body: str, modes: ModalBasis) -> _Deferred:
        return _Deferred(
            (MAXIMA, lambda: maxima()[body]),
            (FREQUENCIES, partial(frequencies_of, modes)),
        )

    bodies = {"sphere": response.problem.sphere.modes, "plate": response.problem.plate.modes}
    return {body: peaks_of_body(body, modes) for body, modes in bodies.items() if modes is not None}
