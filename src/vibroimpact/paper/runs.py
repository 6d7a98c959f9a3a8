"""The simulations that the reproduction needs, each done when it is first asked for, and once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, lru_cache

from vibroimpact.arrays import Array, Floats
from vibroimpact.calibration.calibrate_case import calibrate_case, load_calibration
from vibroimpact.calibration.calibration import Calibration
from vibroimpact.cases.reader import load_case
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.results.fine_history import fine_history

TREATMENTS = ("consistent", "superposed", "identified")
"""How the local compliance of elastic bodies is treated; the shipped cases of Types 2 and 3 come in each."""

DAMPINGS = ("constant", "variable")
"""The simulations of Type 1: one damping for all impacts, or one an impact."""

IMPACTS = (1, 2, 3, 4, 5)
"""The impacts, as the paper counts them."""


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

    @cached_property
    def calibration(self) -> Calibration:
        """The damping of Adams' IMPACT with which each impact is as under the theory."""
        return calibrate_case(load_calibration("paper:calibration"))

    def below_theory(self, damping: str, column: str) -> Floats:
        """Return by how much a column of the impact table is below the theory's [%], in the simulation with a damping of `DAMPINGS`."""
        simulation, theory = (self.response(f"type1-{name}").impacts[column] for name in (damping, "theory"))
        return 100.0 * (1.0 - simulation / theory)


@lru_cache(maxsize=16)
def history_of(response: Response) -> dict[str, Floats]:
    """Return the history of a response, fine enough for every contact and for the peaks of the plate after it."""
    return fine_history(response)


def with_law(problem: Problem, **parameters: Array) -> Problem:
    """Return a problem with other parameters of its laws, each a number or one a drop."""
    return replace(problem, laws=tuple(replace(law, **parameters) for law in problem.laws))
