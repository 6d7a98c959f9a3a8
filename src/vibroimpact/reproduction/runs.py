"""The simulations that the reproduction needs, each done when it is first asked for, and once."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

from vibroimpact.calibration.calibration import Calibration
from vibroimpact.cases.calibration import calibrate_case, load_calibration
from vibroimpact.cases.reader import load_case
from vibroimpact.contact.phase.collocation import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.storage.fine_history import fine_history

TREATMENTS = ("consistent", "superposed", "identified")
"""How the local compliance of elastic bodies is treated; the shipped cases of Types 2 and 3 come in each."""


class Runs:
    """Responses to the shipped cases of the paper.

    Parameters
    ----------
    tell : callable, optional
        Is told, in words, what takes long.

    Examples
    --------
    >>> Runs().response("type1-theory").impacts["rebound_height_m"].round(4).tolist()
    [2.4111, 1.4572, 0.8846, 0.5409, 0.3346]
    """

    def __init__(self, tell: Callable[[str], None] | None = None) -> None:
        self._tell = tell
        self._problems: dict[str, Problem] = {}
        self._responses: dict[str, Response] = {}
        self._calibration: Calibration | None = None

    def problem(self, name: str) -> Problem:
        """Return the problem of a shipped case, such as "type1-theory"."""
        if name not in self._problems:
            self._problems[name] = load_case(f"paper:{name}").to_problem(None, self._tell)
        return self._problems[name]

    def response(self, name: str) -> Response:
        """Return the response to a shipped case."""
        if name not in self._responses:
            self._responses[name] = simulate(self.problem(name))
        return self._responses[name]

    def treated(self, kind: int, treatment: str) -> Response:
        """Return the response of Type 2 or 3 under one of the `TREATMENTS`."""
        return self.response(f"type{kind}" if treatment == "consistent" else f"type{kind}-{treatment}")

    @property
    def calibration(self) -> Calibration:
        """The damping of Adams' IMPACT with which each impact is as under the theory."""
        if self._calibration is None:
            self._calibration = calibrate_case(load_calibration("paper:calibration"))
        return self._calibration


@lru_cache(maxsize=16)
def history_of(response: Response) -> dict[str, Floats]:
    """Return the history of a response, fine enough for every contact and for the peaks of the plate after it."""
    return fine_history(response)
