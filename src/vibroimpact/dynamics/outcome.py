"""Why the run of a drop ended."""

from __future__ import annotations

from enum import Enum


class Outcome(Enum):
    """Why a drop's run ended; the value is the rule's name."""

    IMPACTS = "number of impacts"
    DURATION = "duration"
    REST_SPEED = "at rest: rest speed"
    CAPTURED = "at rest: contact without release"
    STUCK = "at rest: stuck"
    LEFT = "left for good"
    LIMIT = "limit of impacts"
    FAILED = "failed"
    RIDING = "limit of a ride"

    @property
    def at_rest(self) -> bool:
        """Did the sphere come to rest?"""
        return self in (Outcome.REST_SPEED, Outcome.CAPTURED, Outcome.STUCK)

    @property
    def code(self) -> int:
        """Its place in `OUTCOMES`, by which arrays and files hold it."""
        return _CODES[self]


OUTCOMES = tuple(Outcome)
"""All outcomes, by their codes."""

_CODES = {outcome: code for code, outcome in enumerate(OUTCOMES)}
