"""Contact laws by how well they fit restitutions that were measured at several speeds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from vibroimpact.arrays import Floats
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.rigid.rigid_problem import by_speed_of, contact_laws_of
from vibroimpact.contact.law import ContactLaw, unit_of
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.restitution import achieved_restitution, law_achieving
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.law_comparison.laws import cases_under
from vibroimpact.ranges import Range
from vibroimpact.report.reported import Reported

_START = 0.9
"""Restitution to which a law is tuned before its fit, which nearly every law reaches."""

_DECIMALS = 6
"""Decimals of residuals by which laws are ranked."""

_GRID = 25
"""Values of a parameter that are tried in each search."""

_REFINEMENTS = 3
"""Searches, each between the neighbours of the best value of the one before."""

_BEYOND = 4.0 ** np.arange(-12.0, 13.0)
"""Multiples of values of a parameter at which its best value is sought."""


@dataclass(frozen=True)
class FittedLaw:
    """A contact law fitted to n measured restitutions.

    Parameters
    ----------
    name : str
        Name of the law.
    parameter, unit : str
        Its loss parameter, with which it is fitted, and the SI unit; empty if it has none.
    value : float
        The value of the parameter that fits all restitutions best; NaN without a parameter.
    restitution : array, shape (n,)
        The restitutions that the law achieves with it.
    residual, largest : float
        Root mean square of achieved less measured restitution, over the impacts, and the largest of
        its magnitudes.
    own_values : array, shape (n,)
        The value with which the law achieves each measured restitution; NaN where none does.
    """

    name: str
    parameter: str
    unit: str
    value: float
    restitution: Floats = field(repr=False)
    residual: float
    largest: float
    own_values: Floats = field(repr=False)


@dataclass(frozen=True)
class Ranking(Reported, reported_in="vibroimpact.law_comparison.ranking_report"):
    """Contact laws, the best fitting first, between the bodies of a case.

    Parameters
    ----------
    name : str
        Name of the case.
    source : str
        Where the restitutions are from.
    mass : float
        Effective mass of the bodies [kg].
    speed, restitution, count : array, shape (n,)
        Measured approach speeds [m/s] and restitutions, and the number of impacts of each.
    laws : list of FittedLaw
        The laws by their residuals.
    functions : dict of str to ContactLaw
        Each law with its best value.
    left_out : dict of str to str
        Why other laws could not be fitted.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory")
    >>> found = vi.laws.rank_laws(case, [1.0, 2.0, 4.0], [0.83, 0.8, 0.77], ["newton", "tsuji"])
    >>> round(found.laws[0].value, 3), found.laws[0].own_values.tolist()
    (0.8, [0.83, 0.8, 0.77])
    """

    name: str
    source: str
    mass: float
    speed: Floats
    restitution: Floats
    count: Floats
    laws: list[FittedLaw]
    functions: dict[str, ContactLaw] = field(repr=False)
    left_out: dict[str, str]


def rank_laws(
    case: Case,
    speed: Floats | Iterable[float],
    restitution: Floats | Iterable[float],
    laws: Iterable[str] | None = None,
    given: Mapping[str, Any] | None = None,
    *,
    count: Floats | None = None,
    source: str = "",
    progress: Callable[[float], None] | None = None,
) -> Ranking:
    """Return contact laws by how well they fit restitutions measured at several speeds.

    The loss parameter of each law is fitted by least squares, with one value for all speeds; beside
    it, each restitution has the value that alone achieves it. A law whose own values are the same
    at all speeds holds at others too. Bodies are rigid but for their contact, without gravity.

    Parameters
    ----------
    case : Case
        The bodies. Parameters that the law of the case shares are used for others, as
        `compare_laws` does.
    speed, restitution : array, shape (n,)
        Approach speeds [m/s] and restitutions.
    laws : iterable of str, optional
        Names of laws; by default all.
    given : mapping of str, optional
        Parameters: "KEY" for every law that has it, "LAW.KEY" for one.
    count : array, shape (n,), optional
        Number of impacts of which each restitution is the mean, by which it is weighted; 1 by
        default.
    source : str, optional
        Where the restitutions are from, for the report.
    progress : callable, optional
        Called with the fraction done, in [0, 1].

    Raises
    ------
    InputError
        If there are fewer than two speeds, a law is unknown, or no law can be fitted.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory")
    >>> speed = [0.5, 1.0, 2.0, 4.0]
    >>> kuwabara = vi.laws.KuwabaraKono(stiffness=5e8, dissipation_time=1e-5)
    >>> measured = vi.laws.achieved_restitution(kuwabara, 0.09, speed)
    >>> found = rank_laws(case, speed, measured, ["newton", "kuwabara-kono"])
    >>> [(law.name, round(law.residual, 4)) for law in found.laws]
    [('kuwabara-kono', 0.0), ('newton', 0.0188)]
    """
    speeds = np.asarray(speed, dtype=float)
    measured = np.asarray(restitution, dtype=float)
    weights = np.ones(len(speeds)) if count is None else np.asarray(count, dtype=float)
    _check(case, speeds, measured)
    names = list(contact_laws()) if laws is None else list(laws)
    mass = float(contact_pair(case).effective_mass)
    fitted = []
    functions: dict[str, ContactLaw] = {}
    left_out: dict[str, str] = {}
    for number, name in enumerate(names):
        try:
            law = _law_under(case, name, given)
            found, functions[name] = _fitted_law(law, mass, speeds, measured, weights)
            fitted.append(found)
        except (InputError, ComputationError) as error:
            if laws is not None:
                raise
            left_out[name] = str(error).removeprefix(f"{name}: ")
        if progress is not None:
            progress((number + 1) / len(names))
    if not fitted:
        raise InputError(f"no law can be fitted: {'; '.join(left_out.values())}")
    # laws with the same restitution differ by rounding, and stay in their order
    fitted.sort(key=lambda law: round(law.residual, _DECIMALS))
    return Ranking(
        name=case.name or "a drop",
        source=source,
        mass=mass,
        speed=speeds,
        restitution=measured,
        count=weights,
        laws=fitted,
        functions=functions,
        left_out=left_out,
    )


def _check(case: Case, speeds: Floats, measured: Floats) -> None:
    if len(np.unique(speeds)) < 2:
        raise InputError("laws are told apart by several speeds, and there is one; give more")
    if speeds.shape != measured.shape:
        raise InputError(
            f"there are {len(speeds)} speeds and {len(measured)} restitutions; give one each"
        )
    Range(above=0).check(speeds, shown="an approach speed [m/s]")
    if not np.all((measured > 0.0) & (measured <= 1.0)):
        wrong = measured[~((measured > 0.0) & (measured <= 1.0))][0]
        raise InputError(
            f"a restitution of {wrong:g} can't be that of a contact; it must be greater than 0 and "
            "at most 1"
        )
    if case.contact.local.liquid is not None:
        raise InputError(
            "laws are fitted to impacts without a liquid; leave it out", "contact.liquid"
        )


def _law_under(case: Case, name: str, given: Mapping[str, Any] | None) -> ContactLaw:
    """Return a law between the bodies of a case, with some value of its loss parameter."""
    of_law = {
        key: value
        for key, value in (given or {}).items()
        if "." not in key or key.startswith(f"{name}.")
    }
    own = {item.name for item in fields(contact_laws()[name])} if name in contact_laws() else set()
    of_law = {key: value for key, value in of_law.items() if "." in key or key in own}
    under = cases_under(case, [name], of_law, _START)[name]
    if by_speed_of(under):
        raise InputError(f"{name}: a function of the approach speed is not fitted; give a number")
    return contact_laws_of(under)[0]


def _fitted_law(
    law: ContactLaw, mass: float, speeds: Floats, measured: Floats, weights: Floats
) -> tuple[FittedLaw, ContactLaw]:
    """Return a law with the value of its loss parameter that fits best, and its fit."""
    own_values = np.full(len(speeds), np.nan)
    value = np.nan
    unit = ""
    name = law.free_parameter
    if name is not None:
        item = next(entry for entry in fields(law) if entry.name == name)
        unit = unit_of(item, getattr(law, "exponent", 1.0))
        for row, (speed, restitution) in enumerate(zip(speeds, measured, strict=True)):
            own_values[row] = _own_value(law, name, float(restitution), mass, float(speed))
        value = _best_value(
            law, name, item.metadata["range"], own_values, mass, speeds, measured, weights
        )
        law = law.changed({name: value})
    achieved = np.asarray(achieved_restitution(law, mass, speeds), dtype=float)
    found = FittedLaw(
        name=law.name,
        parameter=name or "",
        unit=unit,
        value=float(value),
        restitution=achieved,
        residual=_residual(achieved, measured, weights),
        largest=float(np.max(np.abs(achieved - measured))),
        own_values=own_values,
    )
    return found, law


def _own_value(law: ContactLaw, name: str, restitution: float, mass: float, speed: float) -> float:
    """Return the value with which a law achieves one restitution; NaN if none does."""
    try:
        return float(getattr(law_achieving(law, restitution, mass, speed), name))
    except (InputError, ComputationError):
        return float("nan")


def _best_value(
    law: ContactLaw,
    name: str,
    allowed: Range,
    own_values: Floats,
    mass: float,
    speeds: Floats,
    measured: Floats,
    weights: Floats,
) -> float:
    """Return the value of a parameter with the least residual."""

    def residual(value: float) -> float:
        trial = law.changed({name: float(allowed.clip(value))})
        try:
            achieved = np.asarray(achieved_restitution(trial, mass, speeds), dtype=float)
        except (InputError, ComputationError):
            return np.inf
        return _residual(achieved, measured, weights)

    reached = own_values[np.isfinite(own_values)]
    if len(reached) == len(own_values):
        # every restitution falls or rises with the value: the best one is among their own values
        candidates = np.linspace(reached.min(), reached.max(), _GRID)
        if reached.min() > 0.0:
            candidates = np.append(candidates, np.geomspace(reached.min(), reached.max(), _GRID))
    else:
        about = float(getattr(law, name))
        if len(reached):
            about = float(np.median(reached))
        candidates = np.append(reached, about * _BEYOND)
    # a law that lets slow spheres stick has jumps, about which the grid is refined
    for _ in range(_REFINEMENTS):
        candidates = np.unique([float(allowed.clip(value)) for value in candidates])
        residuals = [residual(value) for value in candidates]
        best = int(np.argmin(residuals))
        best_value = float(candidates[best])
        low = candidates[max(best - 1, 0)]
        high = candidates[min(best + 1, len(candidates) - 1)]
        candidates = np.append(np.linspace(low, high, _GRID), best_value)
    if low == high:
        return float(low)
    refined = minimize_scalar(
        residual, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * (high - low)}
    )
    if refined.fun < residuals[best]:
        return float(refined.x)
    return best_value


def _residual(achieved: Floats, measured: Floats, weights: Floats) -> float:
    """Return the weighted root mean square of a difference."""
    return float(np.sqrt(np.average((achieved - measured) ** 2, weights=weights)))
