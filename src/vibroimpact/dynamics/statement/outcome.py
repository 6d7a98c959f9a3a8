"""Reasons for the end of a run."""

from __future__ import annotations

from enum import Enum


class Outcome(Enum):
    """Reason why the run of a drop ended; the value is the name of the rule.

    Files store its number: a further one is the last.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> response = vi.simulate(vi.load_case("paper:type1-theory"))
    >>> response.outcomes[0], response.outcomes[0].at_rest
    (<Outcome.IMPACTS: 'number of impacts'>, False)
    """

    IMPACTS = "number of impacts"
    DURATION = "duration"
    REST_SPEED = "at rest: rest speed"
    CAPTURED = "at rest: contact without release"
    STUCK = "at rest: stuck"
    LEFT = "left for good"
    LIMIT = "limit of impacts"
    FAILED = "failed"
    RIDING = "limit of a ride"
    FELL = "beside the plate"

    @property
    def at_rest(self) -> bool:
        """Whether the sphere is at rest."""
        return self in (Outcome.REST_SPEED, Outcome.CAPTURED, Outcome.STUCK)

    @property
    def code(self) -> int:
        """Its index in `OUTCOMES`, which arrays and files store."""
        return _CODES[self]


OUTCOMES = tuple(Outcome)
"""All outcomes, by their codes."""

_CODES = {outcome: code for code, outcome in enumerate(OUTCOMES)}
