"""The simulations behind the reproduction, run on first use and cached."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, lru_cache

from vibroimpact.arrays import Array, Floats
from vibroimpact.calibration.calibrate_case import calibrate_case, load_calibration
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.cases.reader import load_case
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.results.fine_history import fine_history

TREATMENTS = ("consistent", "superposed", "identified")
"""Treatments of the local compliance of elastic bodies; Types 2 and 3 are shipped as a
case for each.
"""

DAMPINGS = ("constant", "variable")
"""Simulations of Type 1: the same damping for all impacts, or a damping for each."""

IMPACTS = (1, 2, 3, 4, 5)
"""Impact numbers, counted from 1 as in the paper."""


class Runs:
    """Problems and responses of the shipped cases of the paper, cached by name.

    Parameters
    ----------
    tell : callable, optional
        Called with a message before a long computation.

    Examples
    --------
    >>> Runs().response("type1-theory").impacts["rebound_height_m"].round(4).tolist()
    [2.4111, 1.4572, 0.8846, 0.5409, 0.3346]
    """

    def __init__(self, tell: Callable[[str], None] | None = None) -> None:
        self._tell = tell
        self._problems: dict[str, Problem] = {}
        self._responses: dict[str, Response] = {}

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
        """Return the response of Type 2 or 3 (`kind`) under one of the `TREATMENTS`."""
        if treatment == "consistent":
            return self.response(f"type{kind}")
        return self.response(f"type{kind}-{treatment}")

    @cached_property
    def calibration(self) -> Calibration:
        """The calibrated damping of Adams' IMPACT that reproduces each impact of the theory."""
        calibration = calibrate_case(load_calibration("paper:calibration"))
        assert isinstance(calibration, Calibration)
        return calibration

    def below_theory(self, damping: str, column: str) -> Floats:
        """Return the shortfall of a column of the impact table against the theory [%],
        for a simulation of `DAMPINGS`.
        """
        simulation = self.response(f"type1-{damping}").impacts[column]
        theory = self.response("type1-theory").impacts[column]
        return 100.0 * (1.0 - simulation / theory)


@lru_cache(maxsize=16)
def history_of(response: Response) -> dict[str, Floats]:
    """Return the history of a response, sampled finely enough for each contact and for
    the later peaks of the plate.
    """
    return fine_history(response)


def with_law(problem: Problem, **parameters: Array) -> Problem:
    """Return a problem with other parameters of its contact laws, each a number or an
    array over drops.
    """
    return replace(problem, laws=tuple(replace(law, **parameters) for law in problem.laws))
