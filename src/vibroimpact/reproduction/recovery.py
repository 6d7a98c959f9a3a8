"""What the paper does not print, or prints wrongly: its restitution and its full-damping penetration, from its own numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares

from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.reproduction.printed import printed
from vibroimpact.reproduction.row import Row
from vibroimpact.reproduction.runs import Runs
from vibroimpact.reproduction.section import Section, Table

Floats = NDArray[np.float64]
Residuals = Callable[[Any, Any], Floats]
Kind = Literal["rounding", "scatter"]

RESTITUTIONS = (0.3, 0.95)
PENETRATIONS = (1e-6, 5e-4)
"""Where the two are looked for: restitution [-], full-damping penetration [m]."""

_MISSING = "-"
"""What stands for a value that evidence does not depend on."""

_STEPS = 81
_SWEEPS = 20
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
    kind : {"rounding", "scatter"}
        How far off they may be: half a unit of the last digit, or as far as the residuals themselves show.
    freedom : int
        Degrees of freedom of the residuals, where these show it.
    deviations : array
        Standard deviations of the residuals.
    joint : bool
        Does it count in the joint estimate?
    """

    name: str
    residuals: Residuals
    kind: Kind
    freedom: int
    deviations: Floats
    joint: bool = True

    def standardised(self, restitution: Any, logarithm: Any) -> Floats:
        """Return the residuals over their standard deviations."""
        return self.residuals(restitution, logarithm) / self.deviations


@dataclass(frozen=True)
class Estimate:
    """A value and its standard deviation."""

    value: float
    deviation: float


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
    round_values : float
        With the nearest round values, e_h = 0.65 and d_max = 0.1 mm: the largest residual of a rounded number, in halves of a unit of
        its last digit; up to 1 it comes out as printed.
    """

    evidence: tuple[Evidence, ...]
    restitution: Estimate
    penetration: Estimate
    worst: float
    alone: dict[str, tuple[Estimate | None, Estimate | None]]
    single: bool
    as_printed: tuple[float, float, float]
    parabolas: tuple[Floats, Floats]
    round_values: float


@lru_cache(maxsize=1)
def recover(runs: Runs) -> Recovery:
    """Return what the numbers of the paper imply.

    Parameters
    ----------
    runs : Runs
        The cases.
    """
    restitutions, logarithms = (
        np.linspace(*RESTITUTIONS, _STEPS),
        np.linspace(math.log10(PENETRATIONS[0]), math.log10(PENETRATIONS[1]), _STEPS),
    )
    theory = _swept(runs.problem("type1-theory"), "restitution", restitutions, restitutions)
    constant, variable = (
        _swept(runs.problem(f"type1-{name}"), "full_damping_penetration", 10.0**logarithms, logarithms) for name in ("constant", "variable")
    )

    def too_low(column: str, impact: int, e: Any, d: Any) -> Floats:
        """Return by how many per cent the constant damping falls short of the theory."""
        return np.asarray(100.0 * (1.0 - constant[column](d)[..., impact - 1] / theory[column](e)[..., impact - 1]))

    single = bool(np.all(np.diff(variable["rebound_height_m"](logarithms)[:, 0]) > 0.0))
    single &= bool(np.all(np.diff(theory["rebound_height_m"](restitutions), axis=0) > 0.0))
    evidence, at = _joint(_evidence(theory, constant, variable, too_low))
    fit = least_squares(lambda x: _stacked(evidence, x), at, x_scale=(0.01, 0.01), xtol=1e-14, ftol=1e-14)
    deviations = np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))
    given = np.log10(printed("full_damping_penetration").value)
    nearest = round(float(at[0]), 2), round(float(at[1]), 2)
    speeds = variable["approach_speed_m_s"](at[1]), theory["approach_speed_m_s"](at[0])
    return Recovery(
        evidence=evidence,
        restitution=Estimate(float(at[0]), float(deviations[0])),
        penetration=_in_metres(at[1], deviations[1]),
        worst=float(np.abs(fit.fun).max()),
        alone={one.name: (_alone(one, at, 0), _alone(one, at, 1)) for one in evidence},
        single=single,
        as_printed=(
            float(variable["rebound_height_m"](given)[0]),
            float(too_low("rebound_height_m", 4, at[0], given)),
            float(too_low("max_indentation_m", 5, at[0], given)),
        ),
        parabolas=(_parabola(speeds[0]), _parabola(speeds[1])),
        round_values=max(float(np.abs(one.standardised(*nearest)).max()) for one in evidence if one.kind == "rounding") / _UNIFORM,
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
    lowest = np.argmin(cost, axis=1)
    inside = np.clip(lowest, 1, len(restitutions) - 2)
    before, here, after = (cost[np.arange(len(penetrations)), inside + shift] for shift in (-1, 0, 1))
    parabola = 0.5 * (before - after) / (before - 2.0 * here + after)
    found = restitutions[inside] + parabola * (restitutions[1] - restitutions[0])
    return np.where(lowest == inside, found, np.nan)


def recovery(runs: Runs) -> Section:
    """Return the section on the restitution and the full-damping penetration.

    Parameters
    ----------
    runs : Runs
        The cases.
    """
    found = recover(runs)
    e, d = found.restitution, found.penetration
    given = printed("full_damping_penetration")
    height, fourth, fifth = found.as_printed
    nearest = f"e_h = {e.value:.2f} and d_max = {10.0 ** round(math.log10(1e3 * d.value), 2):g} mm"
    cells: list[tuple[str, ...]] = []
    for one in found.evidence:
        by, through = found.alone[one.name]
        width = _UNIFORM if one.kind == "rounding" else 1.0
        cells.append((one.name, _told(by, 1.0, width), _told(through, 1e3, width), one.kind, "yes" if one.joint else "no"))
    cells.append(("all that counts, jointly", _told(e, 1.0, 1.0), _told(d, 1e3, 1.0), "standard deviations", ""))
    return Section(
        title="The restitution and the full-damping penetration, from the paper's own numbers",
        words=(
            "The restitution e_h that the theory needs is nowhere printed, and the full-damping penetration d_max that is printed does "
            "not go with the other numbers. Both follow from what is printed. The table gives what each piece of evidence implies with "
            "the other value held at the joint estimate: as far as rounding allows, or with the standard deviation that its own "
            "residuals show.",
            "The damping function is the least-squares parabola through the printed dampings at the approach speeds of the simulation "
            "with variable damping, as section 3.2 says, and not at those of the theory: the second table shows it. So it fixes d_max by "
            "itself; at the speeds of the theory it only tells once more that the rebounds match, and does not count. Nor do the errors of "
            "Table 2: they were read off samples, and missed peaks pull them to one side.",
        ),
        rows=(
            Row(
                given,
                d.value,
                by="least squares",
                otherwise=f"a misprint: the paper's own numbers are those of {1e3 * d.value:.4f} mm, and 0.1 mm is the default of Adams",
            ),
        ),
        tables=(
            Table(("evidence", "e_h [-]", "d_max [mm]", "known to within", "counts"), tuple(cells), "What each number implies"),
            Table(
                ("power of v", "printed", "at the simulation's speeds", "at the theory's speeds"),
                tuple(
                    (str(power), printed(f"damping_function.{power + 1}").text, f"{simulated:.5f}", f"{theoretical:.5f}")
                    for power, (simulated, theoretical) in enumerate(zip(*found.parabolas, strict=True))
                ),
                "Coefficients of the parabola through the printed dampings [SI]",
            ),
        ),
        conclusion=(
            f"Jointly e_h = {_told(e, 1.0, 1.0)} and d_max = {_told(d, 1e3, 1.0)} mm; the largest residual is {found.worst:.1f} standard "
            "deviations. "
            + (
                f"There is no second solution between e_h = {RESTITUTIONS[0]:g} and {RESTITUTIONS[1]:g}, d_max = {1e6 * PENETRATIONS[0]:g} "
                f"and {1e6 * PENETRATIONS[1]:g} µm: the first rebound rises with d_max, and the rebounds of the theory rise with e_h, all "
                "the way."
                if found.single
                else "A second solution is not excluded."
            ),
            f"With {given.text} m as printed, the first rebound would be {height:.4f} m "
            f"(printed {printed('type1.rebound_height').text} m), "
            f"with constant damping the fourth {fourth:.1f} % too low (printed {printed('constant.height_error.4').text} %) and the fifth "
            f"compression {fifth:.1f} % too small (printed {printed('constant.compression_error.5').text} %).",
            f"At the round values, {nearest}, the three rounded numbers are off by at most {found.round_values:.2f} times half a unit of "
            "their last digit" + (": all come out as printed." if found.round_values <= 1.0 else ": not all come out as printed."),
            "Established: with Lankarani and Nikravesh's law as the theory, and with the printed dampings in IMPACT clipped at zero, the "
            "printed numbers are those of these two values. A reading: that the authors typed in the round ones.",
        ),
    )


def _evidence(
    theory: dict[str, CubicSpline],
    constant: dict[str, CubicSpline],
    variable: dict[str, CubicSpline],
    too_low: Callable[[str, int, Any, Any], Floats],
) -> tuple[Evidence, ...]:
    """Return the evidence; what scatters has a standard deviation of 1 as yet."""
    damping = _dampings()
    function = np.array([printed(f"damping_function.{power}").value for power in range(1, 4)])
    first, fourth, fifth = (printed(name) for name in ("type1.rebound_height", "constant.height_error.4", "constant.compression_error.5"))

    def parabola(e: Any, d: Any) -> Floats:
        speeds = variable["approach_speed_m_s"](d)
        powers = speeds[..., None] ** np.arange(3)
        return np.asarray(powers @ (_parabola(speeds) - function)[..., None])[..., 0] + 0.0 * np.asarray(e)[..., None]

    def rebounds(e: Any, d: Any) -> Floats:
        return np.asarray(variable["rebound_height_m"](d) - theory["rebound_height_m"](e))

    def rebound(e: Any, d: Any) -> Floats:
        return np.asarray(variable["rebound_height_m"](d)[..., :1] - first.value + 0.0 * np.asarray(e)[..., None])

    def height_error(e: Any, d: Any) -> Floats:
        return too_low("rebound_height_m", 4, e, d)[..., None] - fourth.value

    def compression_error(e: Any, d: Any) -> Floats:
        return too_low("max_indentation_m", 5, e, d)[..., None] - fifth.value

    def dampings(e: Any, d: Any) -> Floats:
        speeds = theory["approach_speed_m_s"](e)
        return np.asarray(np.polynomial.polynomial.polyval(speeds, function) - damping + 0.0 * np.asarray(d)[..., None])

    def table(quantity: str, column: str, way: str) -> Evidence:
        texts = [printed(f"table2.{quantity}.{way}.{impact}").value for impact in range(1, 6)]
        drop = constant if way == "constant" else variable

        def errors(e: Any, d: Any) -> Floats:
            return np.asarray(100.0 * (1.0 - drop[column](d) / theory[column](e)) - texts)

        return Evidence(f"Table 2: {quantity}, {way} damping", errors, "scatter", 4, np.ones(1), joint=False)

    return (
        Evidence("the damping function, at the simulation's speeds", parabola, "scatter", 2, np.ones(1)),
        Evidence("the first rebound", rebound, "rounding", 0, np.array([first.half / _UNIFORM])),
        Evidence("the five rebounds match the theory's", rebounds, "scatter", 4, np.ones(1)),
        Evidence("the fourth rebound, constant damping", height_error, "rounding", 0, np.array([fourth.half / _UNIFORM])),
        Evidence("the fifth compression, constant damping", compression_error, "rounding", 0, np.array([fifth.half / _UNIFORM])),
        Evidence("the damping function, at the theory's speeds", dampings, "scatter", 2, np.ones(1), joint=False),
        *(
            table(quantity, column, way)
            for quantity, column in (("compression", "max_indentation_m"), ("force", "max_force_N"))
            for way in ("constant", "variable")
        ),
    )


def _dampings() -> Floats:
    """Return the printed dampings [N s/m]."""
    return np.array([printed(f"damping.{impact}").value for impact in range(1, 6)])


def _parabola(speeds: Floats) -> Floats:
    """Return the coefficients of the least-squares parabola through the printed dampings, lowest power first."""
    return np.asarray(np.linalg.pinv(speeds[..., None] ** np.arange(3)) @ _dampings())


def _joint(evidence: tuple[Evidence, ...]) -> tuple[tuple[Evidence, ...], Floats]:
    """Return the evidence with its scatter, and the restitution and the logarithm of the penetration that fit it best."""
    at = np.array([0.5 * sum(RESTITUTIONS), np.mean(np.log10(PENETRATIONS))])
    rounded = tuple(one for one in evidence if one.kind == "rounding")
    at = least_squares(lambda x: _stacked(rounded, x), at, x_scale=(0.01, 0.01), bounds=_bounds()).x
    for _ in range(_SWEEPS):
        evidence = tuple(_with_scatter(one, at) for one in evidence)
        weighted, before = evidence, at
        at = least_squares(lambda x, each=weighted: _stacked(each, x), at, x_scale=(0.01, 0.01), xtol=1e-14, ftol=1e-14).x
        if np.all(np.abs(at - before) < 1e-10):
            break
    return evidence, at


def _bounds() -> tuple[Floats, Floats]:
    lowest, highest = zip(RESTITUTIONS, np.log10(PENETRATIONS), strict=True)
    return np.array(lowest), np.array(highest)


def _stacked(evidence: tuple[Evidence, ...], x: Floats) -> Floats:
    """Return the standardised residuals of all evidence that counts."""
    return np.concatenate([one.standardised(x[0], x[1]) for one in evidence if one.joint])


def _with_scatter(one: Evidence, at: Floats) -> Evidence:
    """Return evidence with the scatter that it shows."""
    if one.kind == "rounding":
        return one
    scatter = math.sqrt(float(np.sum(one.residuals(at[0], at[1]) ** 2)) / one.freedom)
    return replace(one, deviations=np.array([scatter]))


def _alone(one: Evidence, at: Floats, which: int) -> Estimate | None:
    """Return what one piece of evidence implies of one value, the other being held."""

    def residuals(x: Floats) -> Floats:
        return one.standardised(*(x[0] if number == which else value for number, value in enumerate(at)))

    fit = least_squares(residuals, at[which : which + 1], x_scale=0.01, xtol=1e-14, ftol=1e-14)
    steepness = float(np.linalg.norm(fit.jac))
    if steepness == 0.0:
        return None
    return _in_metres(fit.x[0], 1.0 / steepness) if which else Estimate(float(fit.x[0]), 1.0 / steepness)


def _in_metres(logarithm: float, deviation: float) -> Estimate:
    """Return the estimate of a penetration from that of its decimal logarithm."""
    value = 10.0 ** float(logarithm)
    return Estimate(value, value * math.log(10.0) * float(deviation))


def _swept(problem: Problem, parameter: str, values: Floats, axis: Floats) -> dict[str, CubicSpline]:
    """Return columns of the impact table as functions of a parameter of the law: a batch of drops, one a value."""
    laws = tuple(replace(law, **{parameter: values}) for law in problem.laws)
    impacts = simulate(replace(problem, laws=laws)).impacts
    columns = ("approach_speed_m_s", "rebound_height_m", "max_indentation_m", "max_force_N")
    return {name: CubicSpline(axis, impacts[name]) for name in columns}


def _told(estimate: Estimate | None, unit: float, width: float) -> str:
    """Return an estimate with how well it is known, in as many decimals as that takes; `unit`: how many of it make one of SI."""
    if estimate is None:
        return _MISSING
    value, half = unit * estimate.value, unit * width * estimate.deviation
    decimals = max(0, 1 - math.floor(math.log10(half)))
    return f"{value:.{decimals}f} ± {half:.{decimals}f}"
