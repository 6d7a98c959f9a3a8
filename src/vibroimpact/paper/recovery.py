"""The restitution and full-damping penetration of the paper, estimated from its printed
numbers, and the section on them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from vibroimpact.arrays import Floats
from vibroimpact.paper.derived import parabola
from vibroimpact.paper.evidence import (
    PENETRATIONS,
    RESTITUTIONS,
    Evidence,
    ImpactSplines,
    evidence_of,
    impact_splines,
)
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report_section import ReportSection, TextTable
from vibroimpact.paper.runs import Runs
from vibroimpact.units.display import MISSING, fixed

_ROUNDS = 20
_UNBOUNDED = (-np.inf, np.inf)


@dataclass(frozen=True)
class Estimate:
    """An estimate with its standard deviation."""

    value: float
    deviation: float

    def apart(self, value: float) -> float:
        """Return the distance of a value from the estimate [standard deviations]."""
        return abs(value - self.value) / self.deviation


@dataclass(frozen=True)
class RecoveredParameters:
    """Estimates of the restitution and the full-damping penetration from the printed numbers.

    Parameters
    ----------
    evidence : tuple of Evidence
        The evidence, with estimated scatter.
    restitution, penetration : Estimate
        Joint estimates; the penetration in m.
    worst : float
        Largest residual of the joint estimate [standard deviations].
    alone : mapping of str to two estimates
        Restitution and penetration [m] from each piece of evidence alone, with the other parameter
        at its joint estimate; None where the evidence does not depend on the parameter.
    single : bool
        Whether the first rebound rises with the penetration, and each rebound of the theory with
        the restitution, over the search ranges, so that the solution is unique.
    as_printed : tuple of three floats
        With the printed penetration: first rebound height [m], fourth height error and fifth
        compression error [%].
    parabolas : tuple of two arrays
        Coefficients of the least-squares parabola through the printed dampings at the approach
        speeds of the simulation and of the theory, lowest power first [SI].
    round_values : tuple of two floats
        Joint estimates rounded to two digits (restitution) and one digit (penetration [m]).
    """

    evidence: tuple[Evidence, ...]
    restitution: Estimate
    penetration: Estimate
    worst: float
    alone: dict[str, tuple[Estimate | None, Estimate | None]]
    single: bool
    as_printed: tuple[float, float, float]
    parabolas: tuple[Floats, Floats]
    round_values: tuple[float, float]


@lru_cache(maxsize=1)
def recover_parameters(runs: Runs) -> RecoveredParameters:
    """Return the estimates from the printed numbers.

    Parameters
    ----------
    runs : Runs
        The cases.
    """
    splines = impact_splines(runs)
    evidence, fit = _joint_fit(evidence_of(splines))
    restitution, logarithm = fit.x
    # residuals are in standard deviations, so that this is the covariance of the estimates
    covariance = np.linalg.inv(fit.jac.T @ fit.jac)
    deviations = np.sqrt(np.diag(covariance))
    penetration = _in_metres(logarithm, deviations[1])
    given = np.log10(printed("full_damping_penetration").value)
    round_values = float(f"{restitution:.2g}"), float(f"{penetration.value:.1g}")
    return RecoveredParameters(
        evidence=evidence,
        restitution=Estimate(float(restitution), float(deviations[0])),
        penetration=penetration,
        worst=float(np.abs(fit.fun).max()),
        alone={
            source.name: (_single_estimate(source, fit.x, 0), _single_estimate(source, fit.x, 1))
            for source in evidence
        },
        single=_is_unique(splines),
        as_printed=(
            float(splines.variable["rebound_height_m"](given)[0]),
            float(splines.below_theory("constant", "rebound_height_m", restitution, given)[3]),
            float(splines.below_theory("constant", "max_indentation_m", restitution, given)[4]),
        ),
        parabolas=(
            parabola(splines.variable["approach_speed_m_s"](logarithm)),
            parabola(splines.theory["approach_speed_m_s"](restitution)),
        ),
        round_values=round_values,
    )


def off_joint(recovered: RecoveredParameters, evidence: Evidence) -> float:
    """Return the distance of the joint estimate from a piece of evidence, in half-widths
    of its band: at most 1 inside the band.
    """
    joint = (recovered.restitution, recovered.penetration)
    pairs = zip(recovered.alone[evidence.name], joint, strict=True)
    apart = [alone.apart(together.value) for alone, together in pairs if alone is not None]
    return max(apart) / evidence.half_width


def penetration_bands(recovered: RecoveredParameters, penetration: float) -> tuple[bool, ...]:
    """Return whether a penetration [m] lies in the band of each piece of evidence that
    depends on the penetration alone.
    """
    return tuple(
        penetration_alone.apart(penetration) <= source.half_width
        for source, (restitution_alone, penetration_alone) in zip(
            recovered.evidence, recovered.alone.values(), strict=True
        )
        if restitution_alone is None and penetration_alone is not None
    )


def implied_restitution(evidence: Evidence, restitutions: Floats, penetrations: Floats) -> Floats:
    """Return the restitution that a piece of evidence implies at each penetration; NaN where it
    lies outside the search range.

    Minimises the sum of squared residuals over the grid of restitutions, refined by a parabola
    through the lowest three points.

    Parameters
    ----------
    evidence : Evidence
        Evidence that depends on the restitution.
    restitutions : array
        Search grid [-], evenly spaced.
    penetrations : array
        Full-damping penetrations [m].
    """
    log_penetrations = np.log10(penetrations)
    residuals = evidence.standardised(restitutions[None, :], log_penetrations[:, None])
    squares = np.sum(residuals**2, axis=-1)
    # evidence may be independent of the penetration
    squares = np.broadcast_to(squares, (len(penetrations), len(restitutions)))
    lowest = np.argmin(squares, axis=1)
    inside = np.clip(lowest, 1, len(restitutions) - 2)
    rows = np.arange(len(penetrations))
    left = squares[rows, inside - 1]
    middle = squares[rows, inside]
    right = squares[rows, inside + 1]
    # vertex of the parabola, in steps of the grid from its middle point
    vertex = 0.5 * (left - right) / (left - 2.0 * middle + right)
    grid_step = restitutions[1] - restitutions[0]
    implied = restitutions[inside] + vertex * grid_step
    # lowest at an end of the grid, the minimum lies outside
    return np.where(lowest == inside, implied, np.nan)


def _joint_fit(evidence: tuple[Evidence, ...]) -> tuple[tuple[Evidence, ...], OptimizeResult]:
    """Return the evidence with estimated scatter, and the joint fit of restitution and logarithm of
    the penetration.

    Weights and solution depend on each other, so both are iterated to a fixed point from the fit to
    the rounded values.
    """
    ranges = np.array([RESTITUTIONS, np.log10(PENETRATIONS)])
    rounded = tuple(source for source in evidence if source.freedom is None)
    fit = _fit(partial(_joint_residuals, rounded), ranges.mean(axis=1), tuple(ranges.T))
    for _ in range(_ROUNDS):
        evidence = tuple(_with_scatter(source, fit.x) for source in evidence)
        previous = fit.x
        fit = _fit(partial(_joint_residuals, evidence), previous)
        if np.all(np.abs(fit.x - previous) < 1e-10):
            break
    return evidence, fit


def _fit(
    residuals: Callable[[Floats], Floats], start: Floats, bounds: tuple[Any, ...] = _UNBOUNDED
) -> OptimizeResult:
    """Return the least-squares solution, with tolerances near machine precision."""
    return least_squares(residuals, start, x_scale=0.01, xtol=1e-14, ftol=1e-14, bounds=bounds)


def _joint_residuals(evidence: tuple[Evidence, ...], at: Floats) -> Floats:
    """Return the standardised residuals of all evidence in the joint estimate."""
    return np.concatenate([source.standardised(*at) for source in evidence if source.joint])


def _with_scatter(evidence: Evidence, at: Floats) -> Evidence:
    """Return evidence with the standard deviation of its residuals at the current estimate."""
    if evidence.freedom is None:
        return evidence
    return replace(
        evidence,
        deviation=math.sqrt(float(np.sum(evidence.residuals(*at) ** 2)) / evidence.freedom),
    )


def _single_estimate(evidence: Evidence, at: Floats, which: int) -> Estimate | None:
    """Return the estimate of one parameter from one piece of evidence, with the other
    parameter fixed.
    """

    def residuals(x: Floats) -> Floats:
        parameters = list(at)
        parameters[which] = x[0]
        return evidence.standardised(*parameters)

    fit = _fit(residuals, at[which : which + 1])
    steepness = float(np.linalg.norm(fit.jac))
    if steepness == 0.0:
        return None
    deviation = 1.0 / steepness
    if which == 0:
        return Estimate(float(fit.x[0]), deviation)
    return _in_metres(fit.x[0], deviation)


def _in_metres(logarithm: float, deviation: float) -> Estimate:
    """Return the estimate of a penetration from that of its decimal logarithm."""
    value = 10.0 ** float(logarithm)
    return Estimate(value, value * math.log(10.0) * float(deviation))


def _is_unique(splines: ImpactSplines) -> bool:
    """Return whether the first rebound rises with the penetration, and all of the theory
    with the restitution, over the search ranges.
    """
    simulation, theory = (drops["rebound_height_m"] for drops in (splines.variable, splines.theory))
    return bool(
        np.all(np.diff(simulation(simulation.x)[:, 0]) > 0.0)
        and np.all(np.diff(theory(theory.x), axis=0) > 0.0)
    )


def recovery_section(runs: Runs) -> ReportSection:
    """Return the section on the restitution and the full-damping penetration.

    Parameters
    ----------
    runs : Runs
        The cases.
    """
    recovered = recover_parameters(runs)
    return ReportSection(
        title="The restitution and the full-damping penetration, from the paper's own numbers",
        paragraphs=(
            "The restitution e_h of the theory is not printed, and the full-damping "
            "penetration d_max is printed as "
            f"{printed('full_damping_penetration').text} m. Both follow from the other "
            "printed numbers. The table gives what each piece of "
            "evidence implies with the other value held at the joint estimate: as far as "
            "rounding allows, or with the standard deviation that its own residuals show.",
            "The damping function is the least-squares parabola through the printed "
            "dampings at the approach speeds of the simulation "
            "with variable damping, as stated in section 3.2, and not at those of the "
            "theory, as the second table shows. It determines "
            "d_max by itself; at the speeds of the theory it only confirms that the "
            "rebounds match, and is not used. The errors of "
            "Table 2 are not used either: they are consistent with peaks read from samples, "
            "and missed peaks bias them.",
        ),
        tables=(_implied_table(recovered), _coefficients_table(recovered)),
        conclusion=(
            _joint_words(recovered),
            _printed_words(recovered),
            _round_value_words(recovered, runs),
            "Established: with Lankarani and Nikravesh's law as the theory, and with the "
            "printed dampings in IMPACT clipped at zero, the "
            "printed numbers used here agree with these two values. A hypothesis: that the "
            "authors used the round ones.",
        ),
    )


def _implied_table(recovered: RecoveredParameters) -> TextTable:
    """Return the table of the estimates from each piece of evidence, and of the joint estimate."""
    cells = []
    for evidence in recovered.evidence:
        restitution_alone, penetration_alone = recovered.alone[evidence.name]
        known = "rounding" if evidence.freedom is None else "scatter"
        used = "yes" if evidence.joint else "no"
        cells.append(
            (
                evidence.name,
                _estimate_text(restitution_alone, 1.0, evidence.half_width),
                _estimate_text(penetration_alone, 1e3, evidence.half_width),
                known,
                used,
            )
        )
    cells.append(
        (
            "all used evidence, jointly",
            _estimate_text(recovered.restitution),
            _estimate_text(recovered.penetration, 1e3),
            "standard deviations",
            "",
        )
    )
    return TextTable(
        ("evidence", "e_h [-]", "d_max [mm]", "uncertainty from", "used"),
        tuple(cells),
        "What each number implies",
    )


def _coefficients_table(recovered: RecoveredParameters) -> TextTable:
    """Return the table of the parabola through the printed dampings: as printed, and at
    the speeds of simulation and theory.
    """
    cells = tuple(
        (
            str(power),
            *(fixed(value, 5) for value in (printed(f"damping_function.{power + 1}").value, *both)),
        )
        for power, both in enumerate(zip(*recovered.parabolas, strict=True))
    )
    headers = (
        "power of v",
        "printed",
        "at the simulation's speeds, at the joint estimate",
        "at the theory's speeds",
    )
    return TextTable(
        headers, cells, "Coefficients of the parabola through the printed dampings [SI]"
    )


def _joint_words(recovered: RecoveredParameters) -> str:
    single = "A second solution is not excluded."
    if recovered.single:
        single = (
            f"There is no second solution between e_h = {RESTITUTIONS[0]:g} and "
            f"{RESTITUTIONS[1]:g}, d_max = {1e6 * PENETRATIONS[0]:g} "
            f"and {1e6 * PENETRATIONS[1]:g} µm: the first rebound rises with d_max, and the "
            "rebounds of the theory rise with e_h, all the way."
        )
    return (
        f"Jointly e_h = {_estimate_text(recovered.restitution)} and d_max = "
        f"{_estimate_text(recovered.penetration, 1e3)} mm; the largest "
        f"residual is {recovered.worst:.1f} standard deviations. {single}"
    )


def _printed_words(recovered: RecoveredParameters) -> str:
    given = printed("full_damping_penetration")
    met = penetration_bands(recovered, given.value)
    height, fourth, fifth = recovered.as_printed
    phrase = (
        f"The printed d_max, {given.text} m, is met by {sum(met) or 'none'} of the "
        f"{len(met)} pieces of evidence that depend on it alone. "
        f"With it the first rebound would be {fixed(height, 4)} m (printed "
        f"{printed('type1.rebound_height').text} m), "
        f"with constant damping the fourth {fixed(fourth, 1)} % below the theory's "
        f"(printed {printed('constant.height_error.4').text} %) "
        f"and the fifth compression {fixed(fifth, 1)} % below it (printed "
        f"{printed('constant.compression_error.5').text} %)."
    )
    if any(met):
        return phrase
    own = fixed(1e3 * recovered.penetration.value, 4)
    return (
        f"{phrase} The paper's other numbers are those of {own} mm, so that it seems "
        "to be a misprint."
    )


def _round_value_words(recovered: RecoveredParameters, runs: Runs) -> str:
    """Return the sentence on the round values, which the shipped cases use."""
    restitution, penetration = recovered.round_values
    rounded = {
        "type1.rebound_height": runs.response("type1-constant").impacts["rebound_height_m"][0],
        "constant.height_error.4": runs.below_theory("constant", "rebound_height_m")[3],
        "constant.compression_error.5": runs.below_theory("constant", "max_indentation_m")[4],
    }
    worst = max(
        abs(float(value) - printed(name).value) / printed(name).half
        for name, value in rounded.items()
    )
    come = "all come" if worst <= 1.0 else "not all come"
    off = (recovered.restitution.value - restitution) / recovered.restitution.deviation
    side = "below" if off > 0.0 else "above"
    return (
        f"At the round values, e_h = {restitution:g} and d_max = {1e3 * penetration:g} mm, "
        f"the {len(rounded)} numbers with an uncertainty "
        f"from rounding are off by at most {fixed(worst, 2)} times half a "
        "unit of their last digit: "
        f"{come} out as printed. The "
        f"round e_h lies {fixed(abs(off), 1)} standard deviations "
        f"{side} the joint estimate."
    )


def _estimate_text(estimate: Estimate | None, unit: float = 1.0, reach: float = 1.0) -> str:
    """Return an estimate with its uncertainty, rounded to match it; `unit` is the number
    of display units in one SI unit.
    """
    if estimate is None:
        return MISSING
    value = unit * estimate.value
    half = unit * reach * estimate.deviation
    decimals = max(0, 1 - math.floor(math.log10(half)))
    return f"{fixed(value, decimals)} ± {fixed(half, decimals)}"
