"""What each printed number says of the restitution and the full-damping penetration, as residuals."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.paper.damping_function import function_at, parabola, printed_dampings, printed_function
from vibroimpact.paper.printed import Printed, printed
from vibroimpact.paper.runs import DAMPINGS, IMPACTS, Runs, with_law
from vibroimpact.paper.sampling import QUANTITIES, table2_error

RESTITUTIONS = (0.3, 0.95)
"""Between what the restitution is looked for [-]."""

PENETRATIONS = (1e-6, 5e-4)
"""Between what the full-damping penetration is looked for [m]."""

_STEPS = 81
_UNIFORM = math.sqrt(3.0)
"""Half the width of a uniform distribution over its standard deviation."""


@dataclass(frozen=True)
class Evidence:
    """Numbers of the paper that depend on what is looked for.

    Parameters
    ----------
    name : str
        What they are, in a few words.
    residuals : callable
        What is computed less what is printed, along the last axis, from the restitution and the decimal logarithm of the penetration [m].
    freedom : int, optional
        Degrees of freedom of the residuals, where their scatter shows how far off they may be; None where rounding tells.
    deviation : float
        Standard deviation of the residuals.
    joint : bool
        Does it count in the joint estimate?
    sampled : bool
        Was it read off samples, so that missed peaks pull it to one side?
    """

    name: str
    residuals: Callable[[Any, Any], Floats]
    freedom: int | None
    deviation: float = 1.0
    joint: bool = True
    sampled: bool = False

    @property
    def reach(self) -> float:
        """How far off it is taken to be [standard deviations]: as far as rounding allows, or one where it scatters."""
        return _UNIFORM if self.freedom is None else 1.0

    def standardised(self, restitution: Any, logarithm: Any) -> Floats:
        """Return the residuals over their standard deviation."""
        return self.residuals(restitution, logarithm) / self.deviation


class Sweeps(NamedTuple):
    """Columns of the impact table as functions, with the impacts along the last axis.

    Parameters
    ----------
    theory : dict of str to spline
        The theory's, of the restitution.
    constant, variable : dict of str to spline
        Those of the simulations with either damping, of the decimal logarithm of the full-damping penetration [m].
    """

    theory: dict[str, CubicSpline]
    constant: dict[str, CubicSpline]
    variable: dict[str, CubicSpline]

    def below_theory(self, damping: str, column: str, restitution: Any, logarithm: Any) -> Floats:
        """Return by how much a column is below the theory's [%], in the simulation with a damping of `DAMPINGS`."""
        simulation = self.constant if damping == "constant" else self.variable
        return np.asarray(100.0 * (1.0 - simulation[column](logarithm) / self.theory[column](restitution)))


def sweep(runs: Runs) -> Sweeps:
    """Return what the theory and the simulations give over all that is searched."""
    restitutions, penetrations = np.linspace(*RESTITUTIONS, _STEPS), np.geomspace(*PENETRATIONS, _STEPS)
    return Sweeps(
        _swept(runs.problem("type1-theory"), "restitution", restitutions, restitutions),
        *(_swept(runs.problem(f"type1-{name}"), "full_damping_penetration", penetrations, np.log10(penetrations)) for name in DAMPINGS),
    )


def evidence_of(sweeps: Sweeps) -> tuple[Evidence, ...]:
    """Return all that the paper prints of the two; what scatters has a standard deviation of 1 as yet.

    Parameters
    ----------
    sweeps : Sweeps
        What the theory and the simulations give.
    """
    theory, variable = sweeps.theory, sweeps.variable
    first, fourth, fifth = (printed(name) for name in ("type1.rebound_height", "constant.height_error.4", "constant.compression_error.5"))

    def function_simulated(_: Any, logarithm: Any) -> Floats:
        speeds = variable["approach_speed_m_s"](logarithm)
        return function_at(speeds, parabola(speeds)) - printed_function(speeds)

    def first_rebound(_: Any, logarithm: Any) -> Floats:
        return np.asarray(variable["rebound_height_m"](logarithm)[..., :1] - first.value)

    def rebounds(restitution: Any, logarithm: Any) -> Floats:
        return np.asarray(variable["rebound_height_m"](logarithm) - theory["rebound_height_m"](restitution))

    def fourth_rebound(restitution: Any, logarithm: Any) -> Floats:
        return sweeps.below_theory("constant", "rebound_height_m", restitution, logarithm)[..., 3:4] - fourth.value

    def fifth_compression(restitution: Any, logarithm: Any) -> Floats:
        return sweeps.below_theory("constant", "max_indentation_m", restitution, logarithm)[..., 4:5] - fifth.value

    def function_theory(restitution: Any, _: Any) -> Floats:
        return printed_function(theory["approach_speed_m_s"](restitution)) - printed_dampings()

    return (
        Evidence("the damping function, at the simulation's speeds", function_simulated, freedom=2),
        _rounded("the first rebound", first_rebound, first),
        Evidence("the five rebounds match the theory's", rebounds, freedom=4),
        _rounded("the fourth rebound, constant damping", fourth_rebound, fourth),
        _rounded("the fifth compression, constant damping", fifth_compression, fifth),
        Evidence("the damping function, at the theory's speeds", function_theory, freedom=2, joint=False),
        *(_of_table2(sweeps, quantity, column, damping) for quantity, (_, column, _) in QUANTITIES.items() for damping in DAMPINGS),
    )


def _rounded(name: str, residuals: Callable[[Any, Any], Floats], value: Printed) -> Evidence:
    """Return the evidence of one printed value, off by at most half a unit of its last digit."""
    return Evidence(name, residuals, freedom=None, deviation=value.half / _UNIFORM)


def _of_table2(sweeps: Sweeps, quantity: str, column: str, damping: str) -> Evidence:
    """Return the evidence of a column of Table 2."""
    values: Floats = np.array([table2_error(quantity, damping, impact).value for impact in IMPACTS])

    def errors(restitution: Any, logarithm: Any) -> Floats:
        return sweeps.below_theory(damping, column, restitution, logarithm) - values

    return Evidence(f"Table 2: {quantity}, {damping} damping", errors, freedom=4, joint=False, sampled=True)


def _swept(problem: Problem, parameter: str, values: Floats, axis: Floats) -> dict[str, CubicSpline]:
    """Return columns of the impact table as functions of a parameter of the law: a batch of drops, one a value."""
    impacts = simulate(with_law(problem, **{parameter: values})).impacts
    columns = ("approach_speed_m_s", "rebound_height_m", "max_indentation_m", "max_force_N")
    return {name: CubicSpline(axis, impacts[name]) for name in columns}
