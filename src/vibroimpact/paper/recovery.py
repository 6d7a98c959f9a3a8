"""What the paper does not print, or prints wrongly: its restitution and its full-damping penetration, from its own numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from vibroimpact.arrays import Floats
from vibroimpact.paper.damping_function import parabola
from vibroimpact.paper.evidence import PENETRATIONS, RESTITUTIONS, Evidence, Sweeps, evidence_of, sweep
from vibroimpact.paper.printed import printed
from vibroimpact.paper.runs import Runs

_ROUNDS = 20
_UNBOUNDED = (-np.inf, np.inf)


@dataclass(frozen=True)
class Estimate:
    """A value and its standard deviation."""

    value: float
    deviation: float

    def apart(self, value: float) -> float:
        """Return how far off a value is [standard deviations]."""
        return abs(value - self.value) / self.deviation


@dataclass(frozen=True)
class Recovery:
    """What the numbers of the paper imply.

    Parameters
    ----------
    evidence : tuple of Evidence
        The numbers.
    restitution, penetration : Estimate
        The joint estimates; the penetration in m.
    worst : float
        The largest residual of the joint estimate, in standard deviations.
    alone : mapping of str to two estimates
        The restitution and the penetration [m] from each piece of evidence, the other one held at its joint estimate; None where it
        does not depend on it.
    single : bool
        Does the first rebound rise with the penetration, and each rebound of the theory with the restitution, over all that was
        searched, so that there can be no second solution?
    as_printed : tuple of three floats
        With the printed penetration: first rebound height [m], fourth height error and fifth compression error [%].
    parabolas : tuple of two arrays
        Coefficients of the least-squares parabola through the printed dampings at the approach speeds of the simulation and of the
        theory, lowest power first [SI].
    round_values : tuple of two floats
        The round values nearest to the joint estimates: the restitution of two digits, the penetration of one [m].
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
def recover(runs: Runs) -> Recovery:
    """Return what the numbers of the paper imply.

    Parameters
    ----------
    runs : Runs
        The cases.
    """
    sweeps = sweep(runs)
    evidence, fit = _joint(evidence_of(sweeps))
    restitution, logarithm = fit.x
    deviations = np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))
    penetration = _in_metres(logarithm, deviations[1])
    given = np.log10(printed("full_damping_penetration").value)
    round_values = float(f"{restitution:.2g}"), float(f"{penetration.value:.1g}")
    return Recovery(
        evidence=evidence,
        restitution=Estimate(float(restitution), float(deviations[0])),
        penetration=penetration,
        worst=float(np.abs(fit.fun).max()),
        alone={one.name: (_alone(one, fit.x, 0), _alone(one, fit.x, 1)) for one in evidence},
        single=_single(sweeps),
        as_printed=(
            float(sweeps.variable["rebound_height_m"](given)[0]),
            float(sweeps.below_theory("constant", "rebound_height_m", restitution, given)[3]),
            float(sweeps.below_theory("constant", "max_indentation_m", restitution, given)[4]),
        ),
        parabolas=(
            parabola(sweeps.variable["approach_speed_m_s"](logarithm)),
            parabola(sweeps.theory["approach_speed_m_s"](restitution)),
        ),
        round_values=round_values,
    )


def off_joint(found: Recovery, evidence: Evidence) -> float:
    """Return how far from a piece of evidence the joint estimate is, in halves of the width of its band; up to 1 it lies within."""
    pairs = zip(found.alone[evidence.name], (found.restitution, found.penetration), strict=True)
    return max(alone.apart(joint.value) for alone, joint in pairs if alone is not None) / evidence.reach


def penetration_bands(found: Recovery, penetration: float) -> tuple[bool, ...]:
    """Return whether a penetration [m] lies in the band of each piece of evidence that depends on nothing else."""
    return tuple(
        through.apart(penetration) <= one.reach
        for one, (by, through) in zip(found.evidence, found.alone.values(), strict=True)
        if by is None and through is not None
    )


def implied_restitution(evidence: Evidence, restitutions: Floats, penetrations: Floats) -> Floats:
    """Return the restitution that a piece of evidence implies at each penetration; NaN where it is none of those given.

    Parameters
    ----------
    evidence : Evidence
        It must depend on the restitution.
    restitutions : array
        Where it is looked for [-], evenly spaced.
    penetrations : array
        Full-damping penetrations [m].
    """
    cost = np.sum(evidence.standardised(restitutions[None, :], np.log10(penetrations)[:, None]) ** 2, axis=-1)
    cost = np.broadcast_to(cost, (len(penetrations), len(restitutions)))  # it may not depend on the penetration
    lowest = np.argmin(cost, axis=1)
    inside = np.clip(lowest, 1, len(restitutions) - 2)
    before, here, after = (cost[np.arange(len(penetrations)), inside + shift] for shift in (-1, 0, 1))
    vertex = 0.5 * (before - after) / (before - 2.0 * here + after)
    found = restitutions[inside] + vertex * (restitutions[1] - restitutions[0])
    return np.where(lowest == inside, found, np.nan)


def _joint(evidence: tuple[Evidence, ...]) -> tuple[tuple[Evidence, ...], OptimizeResult]:
    """Return the evidence with its scatter, and the fit of the restitution and of the logarithm of the penetration."""
    ranges = np.array([RESTITUTIONS, np.log10(PENETRATIONS)])
    rounded = tuple(one for one in evidence if one.freedom is None)
    fit = _fit(partial(_stacked, rounded), ranges.mean(axis=1), tuple(ranges.T))
    for _ in range(_ROUNDS):
        evidence = tuple(_with_scatter(one, fit.x) for one in evidence)
        before, fit = fit.x, _fit(partial(_stacked, evidence), fit.x)
        if np.all(np.abs(fit.x - before) < 1e-10):
            break
    return evidence, fit


def _fit(residuals: Callable[[Floats], Floats], start: Floats, bounds: tuple[Any, ...] = _UNBOUNDED) -> OptimizeResult:
    """Return the least squares of residuals, as sharp as binary numbers allow."""
    return least_squares(residuals, start, x_scale=0.01, xtol=1e-14, ftol=1e-14, bounds=bounds)


def _stacked(evidence: tuple[Evidence, ...], at: Floats) -> Floats:
    """Return the standardised residuals of all evidence that counts."""
    return np.concatenate([one.standardised(*at) for one in evidence if one.joint])


def _with_scatter(one: Evidence, at: Floats) -> Evidence:
    """Return evidence with the scatter that it shows."""
    if one.freedom is None:
        return one
    return replace(one, deviation=math.sqrt(float(np.sum(one.residuals(*at) ** 2)) / one.freedom))


def _alone(one: Evidence, at: Floats, which: int) -> Estimate | None:
    """Return what one piece of evidence implies of one value, the other being held."""

    def residuals(x: Floats) -> Floats:
        return one.standardised(*(x[0] if number == which else value for number, value in enumerate(at)))

    fit = _fit(residuals, at[which : which + 1])
    steepness = float(np.linalg.norm(fit.jac))
    if steepness == 0.0:
        return None
    return _in_metres(fit.x[0], 1.0 / steepness) if which else Estimate(float(fit.x[0]), 1.0 / steepness)


def _in_metres(logarithm: float, deviation: float) -> Estimate:
    """Return the estimate of a penetration from that of its decimal logarithm."""
    value = 10.0 ** float(logarithm)
    return Estimate(value, value * math.log(10.0) * float(deviation))


def _single(sweeps: Sweeps) -> bool:
    """Return whether the rebounds rise all the way: the first with the penetration, all of the theory with the restitution."""
    simulation, theory = (one["rebound_height_m"] for one in (sweeps.variable, sweeps.theory))
    return bool(np.all(np.diff(simulation(simulation.x)[:, 0]) > 0.0) and np.all(np.diff(theory(theory.x), axis=0) > 0.0))
