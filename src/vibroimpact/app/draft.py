"""The result of a drop while it is being changed: as of a run, but with fewer points, so that it is there at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.results.deflection import deflection_of
from vibroimpact.results.result import Result, bare_result, result_of

TOLERANCE = 1e-6
"""Tolerance of a draft: its numbers are right to six digits."""

_POINTS = 1000
"""Points of its history, about."""

_FRAMES = 36
"""Frames of the plate in motion."""


class _Signals(Mapping[str, Signal]):
    """The signals of a response, computed when one is looked at."""

    def __init__(self, response: Response) -> None:
        self._response, self._names = response, [sensor.name for sensor in response.problem.sensors]
        self._found: dict[str, Signal] = {}

    def __getitem__(self, name: str) -> Signal:
        if not self._found:
            self._found = self._response.signals()
        return self._found[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def draft_of(response: Response) -> Result:
    """Return the result of a response to one drop whose bodies vibrate, with a history of about 1000 points.

    For rigid bodies it is the result itself, which takes no time.
    """
    if not response.problem.vibrates:
        return result_of(response)
    return bare_result(response, response.history(_POINTS), _Signals(response), deflection_of(response, _FRAMES))
