"""Residuals of the printed numbers that depend on the unprinted restitution and the
full-damping penetration.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.paper.derived import function_at, parabola, printed_dampings, printed_function
from vibroimpact.paper.printed import PrintedValue, printed
from vibroimpact.paper.runs import DAMPINGS, IMPACTS, Runs, with_law
from vibroimpact.paper.sampling import QUANTITIES, table2_error

RESTITUTIONS = (0.3, 0.95)
"""Search range of the restitution [-]."""

PENETRATIONS = (1e-6, 5e-4)
"""Search range of the full-damping penetration [m]."""

_STEPS = 81
_UNIFORM = math.sqrt(3.0)
"""Half the width of a uniform distribution, in standard deviations."""


@dataclass(frozen=True)
class Evidence:
    """Printed numbers that depend on the two parameters sought.

    Parameters
    ----------
    name : str
        Short description.
    residuals : callable
        Computed less printed values along the last axis, as a function of the restitution and the
        decimal logarithm of the penetration [m].
    freedom : int, optional
        Degrees of freedom of the residuals, where the standard deviation is estimated from their
        scatter; None where it follows from rounding.
    deviation : float
        Standard deviation of the residuals.
    joint : bool
        Whether the residuals enter the joint estimate.
    sampled : bool
        Whether the numbers were read off samples, and are biased by missed peaks.
    """

    name: str
    residuals: Callable[[Any, Any], Floats]
    freedom: int | None
    deviation: float = 1.0
    joint: bool = True
    sampled: bool = False

    @property
    def half_width(self) -> float:
        """Half-width of the band [standard deviations]: the limit of rounding, or one
        where the scatter is estimated.
        """
        return _UNIFORM if self.freedom is None else 1.0

    def standardised(self, restitution: Any, logarithm: Any) -> Floats:
        """Return the residuals over their standard deviation."""
        return self.residuals(restitution, logarithm) / self.deviation


class ImpactSplines(NamedTuple):
    """Splines of columns of the impact table, with the impacts along the last axis.

    Parameters
    ----------
    theory : dict of str to spline
        Columns of the theory over the restitution.
    constant, variable : dict of str to spline
        Columns of the simulations with either damping, over the decimal logarithm of the
        full-damping penetration [m].
    """

    theory: dict[str, CubicSpline]
    constant: dict[str, CubicSpline]
    variable: dict[str, CubicSpline]

    def below_theory(self, damping: str, column: str, restitution: Any, logarithm: Any) -> Floats:
        """Return the shortfall of a column against the theory [%], for a simulation of
        `DAMPINGS`.
        """
        simulation = self.variable
        if damping == "constant":
            simulation = self.constant
        return np.asarray(
            100.0 * (1.0 - simulation[column](logarithm) / self.theory[column](restitution))
        )


def impact_splines(runs: Runs) -> ImpactSplines:
    """Return the impact tables of the theory and the simulations over the search ranges."""
    restitutions = np.linspace(*RESTITUTIONS, _STEPS)
    penetrations = np.geomspace(*PENETRATIONS, _STEPS)
    return ImpactSplines(
        _impact_columns_over(
            runs.problem("type1-theory"), "restitution", restitutions, restitutions
        ),
        *(
            _impact_columns_over(
                runs.problem(f"type1-{name}"),
                "full_damping_penetration",
                penetrations,
                np.log10(penetrations),
            )
            for name in DAMPINGS
        ),
    )


def evidence_of(splines: ImpactSplines) -> tuple[Evidence, ...]:
    """Return all evidence on the two parameters; where the scatter is yet to be estimated, the
    standard deviation is 1.

    Parameters
    ----------
    splines : ImpactSplines
        Impact tables of the theory and the simulations.
    """
    theory = splines.theory
    variable = splines.variable
    first, fourth, fifth = (
        printed(name)
        for name in (
            "type1.rebound_height",
            "constant.height_error.4",
            "constant.compression_error.5",
        )
    )

    def function_simulated(_: Any, logarithm: Any) -> Floats:
        speeds = variable["approach_speed_m_s"](logarithm)
        return function_at(speeds, parabola(speeds)) - printed_function(speeds)

    def first_rebound(_: Any, logarithm: Any) -> Floats:
        return np.asarray(variable["rebound_height_m"](logarithm)[..., :1] - first.value)

    def rebounds(restitution: Any, logarithm: Any) -> Floats:
        return np.asarray(
            variable["rebound_height_m"](logarithm) - theory["rebound_height_m"](restitution)
        )

    def fourth_rebound(restitution: Any, logarithm: Any) -> Floats:
        return (
            splines.below_theory("constant", "rebound_height_m", restitution, logarithm)[..., 3:4]
            - fourth.value
        )

    def fifth_compression(restitution: Any, logarithm: Any) -> Floats:
        return (
            splines.below_theory("constant", "max_indentation_m", restitution, logarithm)[..., 4:5]
            - fifth.value
        )

    def function_theory(restitution: Any, _: Any) -> Floats:
        return printed_function(theory["approach_speed_m_s"](restitution)) - printed_dampings()

    return (
        Evidence("the damping function, at the simulation's speeds", function_simulated, freedom=2),
        _rounded("the first rebound", first_rebound, first),
        Evidence("the five rebounds match the theory's", rebounds, freedom=4),
        _rounded("the fourth rebound, constant damping", fourth_rebound, fourth),
        _rounded("the fifth compression, constant damping", fifth_compression, fifth),
        Evidence(
            "the damping function, at the theory's speeds", function_theory, freedom=2, joint=False
        ),
        *(
            _of_table2(splines, quantity, column, damping)
            for quantity, (_, column, _) in QUANTITIES.items()
            for damping in DAMPINGS
        ),
    )


def _rounded(name: str, residuals: Callable[[Any, Any], Floats], value: PrintedValue) -> Evidence:
    """Return the evidence of one printed value, uniformly distributed within half a unit
    of its last digit.
    """
    return Evidence(name, residuals, freedom=None, deviation=value.half / _UNIFORM)


def _of_table2(splines: ImpactSplines, quantity: str, column: str, damping: str) -> Evidence:
    """Return the evidence of a column of Table 2."""
    values: Floats = np.array([table2_error(quantity, damping, impact).value for impact in IMPACTS])

    def errors(restitution: Any, logarithm: Any) -> Floats:
        return splines.below_theory(damping, column, restitution, logarithm) - values

    return Evidence(
        f"Table 2: {quantity}, {damping} damping", errors, freedom=4, joint=False, sampled=True
    )


def _impact_columns_over(
    problem: Problem, parameter: str, values: Floats, axis: Floats
) -> dict[str, CubicSpline]:
    """Return splines of the impact table over a parameter of the law, from one batch of drops."""
    impacts = simulate(with_law(problem, **{parameter: values})).impacts
    columns = ("approach_speed_m_s", "rebound_height_m", "max_indentation_m", "max_force_N")
    return {name: CubicSpline(axis, impacts[name]) for name in columns}
