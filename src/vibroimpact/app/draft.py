"""The result of a drop while it is being changed: as of a run, but with fewer points, so that it is there at once."""

from __future__ import annotations

from vibroimpact.dynamics.response import Response
from vibroimpact.results.deflection import deflection_of
from vibroimpact.results.peaks import peaks_of
from vibroimpact.results.result import Result, result_of

TOLERANCE = 1e-6
"""Tolerance of a draft: its numbers are right to six digits."""

_POINTS = 2000
"""Points of its history, about."""

_FRAMES = 36
"""Frames of the plate in motion."""


def draft_of(response: Response) -> Result:
    """Return the result of a response to one drop whose bodies vibrate, with a history of about 2000 points.

    For rigid bodies it is the result itself, which takes no time.
    """
    if not response.problem.vibrates:
        return result_of(response)
    history = response.history(_POINTS)
    return Result(
        case=response.problem.source or {},
        impacts=response.impacts,
        history=history,
        energy={name: float(value) for name, value in response.energy.items()},
        status=response.status,
        deformation=dict(response.problem.facts),
        truncation=response.truncation,
        peaks=peaks_of(response, history),
        signals=response.signals() if response.problem.sensors else {},
        deflection=deflection_of(response, _FRAMES),
    )
