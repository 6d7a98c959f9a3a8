"""Comparison of one drop under several contact laws, and the texts and table that report it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.case import Case
from vibroimpact.cases.pair import contact_pair, sphere_density
from vibroimpact.cases.rigid_problem import contact_laws_of, touch_speed
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.columns import ALL_IMPACT_COLUMNS
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.law_comparison.laws import cases_under
from vibroimpact.results.result import Result, result_of
from vibroimpact.runs.tables import formatted_column
from vibroimpact.units.display import MISSING, text

_SPEEDS = 61


@dataclass(frozen=True)
class Comparison:
    """One drop with several contact laws.

    Parameters
    ----------
    name : str
        Name of the case.
    results : dict of str to Result
        Result under each law, by the name of the law.
    laws : dict of str to ContactLaw
        Law of the first impact, by its name.
    speeds : array, shape (S,)
        Approach speeds [m/s].
    restitutions : dict of str to array, shape (S,)
        Restitution that each law of the first impact achieves at these speeds, without gravity.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> comparison = vi.compare_laws(vi.load_case("paper:type1-theory"), ["tsuji", "flores"])
    >>> comparison.speeds.shape, {name: one.shape for name, one in comparison.restitutions.items()}
    ((61,), {'tsuji': (61,), 'flores': (61,)})
    """

    name: str
    results: dict[str, Result] = field(repr=False)
    laws: dict[str, ContactLaw]
    speeds: np.ndarray = field(repr=False)
    restitutions: dict[str, np.ndarray] = field(repr=False)


def compare_laws(
    case: Case,
    laws: Iterable[str],
    given: Mapping[str, Any] | None = None,
    *,
    achieving: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Comparison:
    """Run a case with each of several contact laws.

    Parameters
    ----------
    case : Case
        The case; its own law is used only if it is among the laws.
    laws : iterable of str
        Names of laws.
    given : mapping of str, optional
        Parameters: "KEY" for every law that has it, "LAW.KEY" for one; the others come from the
        case where its law has one of the same name and unit.
    achieving : float, optional
        Give each law the value of its free parameter with which it achieves this restitution [-] at
        the speed of the first impact, between rigid bodies, without gravity, and without the losses
        in a liquid.
    progress : callable, optional
        Called with the fraction done, in [0, 1].

    Raises
    ------
    InputError
        If a law or parameter is unknown, a parameter is missing, or a law can't achieve the
        restitution.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> comparison = vi.compare_laws(
    ...     vi.load_case("paper:type1-theory"), ["hunt-crossley", "flores"]
    ... )
    >>> {
    ...     name: round(float(one.impacts["restitution_achieved"][0]), 3)
    ...     for name, one in comparison.results.items()
    ... }
    {'hunt-crossley': 0.739, 'flores': 0.63}
    """
    cases = cases_under(case, laws, given, achieving)
    mass, speed = contact_pair(case).effective_mass, touch_speed(case)
    speeds = speed * np.geomspace(1e-3, 3.0, _SPEEDS)
    first, results, restitutions = {}, {}, {}
    for number, (name, one) in enumerate(cases.items()):
        results[name] = result_of(simulate(one))
        first[name] = contact_laws_of(one)[0]
        restitutions[name] = achieved_restitution(_around(one, first[name], speeds), mass, speeds)
        if progress is not None:
            progress((number + 1) / len(cases))
    return Comparison(case.name or "a drop", results, first, speeds, restitutions)


def _around(case: Case, law: ContactLaw, speeds: Floats) -> ContactLaw:
    """Return a law with the restitution that the liquid of a case, if there is one,
    leaves it at each approach speed [m/s].
    """
    table = case.contact.local.liquid
    return (
        law
        if table is None
        else table.liquid().around(law, speeds, case.sphere.radius, sphere_density(case.sphere))
    )


_COLUMNS = ("max_indentation_m", "max_force_N", "duration_s", "rebound_height_m", "energy_lost_J")


def comparison_title(comparison: Comparison) -> str:
    """Return the title of a comparison, without the name of the case, which may mention a
    law that is not compared.
    """
    number = len(comparison.results)
    return f"One drop with {number} contact law{'' if number == 1 else 's'}"


def comparison_subtitle(comparison: Comparison) -> str:
    """Return the subtitle of a comparison: the case and its first approach speed."""
    speeds = next(iter(comparison.results.values())).impacts["approach_speed_m_s"]
    arrives = f", which arrives at {text(float(speeds[0]), 'm/s')}" if len(speeds) else ""
    return f'The drop is that of the case "{comparison.name}"{arrives}.'


def comparison_table(comparison: Comparison) -> tuple[list[tuple[str, str]], list[list[str]]]:
    """Return headings with units, and a row for each law: required and achieved restitution, and
    the first impact.

    Columns in which no law has a value are left out.
    """
    headers = [
        ("Law", ""),
        ("Impacts", ""),
        ("Restitution asked", ""),
        ("Restitution achieved, first", ""),
        ("achieved, last", ""),
    ]
    rows = []
    for name, one in comparison.results.items():
        some = [
            _restitution(one, "restitution_asked", 0),
            *(_restitution(one, "restitution_achieved", at) for at in (0, -1)),
        ]
        rows.append([name, str(len(one.impacts["impact"])), *some])
    for name in _COLUMNS:
        first = np.array(
            [
                one.impacts[name][0] if len(one.impacts[name]) else np.nan
                for one in comparison.results.values()
            ]
        )
        change = np.array(
            [
                one.change_by_impact[0] if len(one.impacts[name]) else 0.0
                for one in comparison.results.values()
            ]
        )
        unit, cells = formatted_column(name, first, change)
        headers.append((ALL_IMPACT_COLUMNS[name].label, unit))
        for row, cell in zip(rows, cells, strict=True):
            row.append(cell)
    known = [
        column for column in range(len(headers)) if any(row[column] != MISSING for row in rows)
    ]
    return [headers[column] for column in known], [
        [row[column] for column in known] for row in rows
    ]


def _restitution(result: Result, name: str, at: int) -> str:
    """Return the restitution of the first or last impact, rounded to its significant digits."""
    values = result.impacts[name]
    return (
        formatted_column(name, values, result.change_by_impact)[1][at] if len(values) else MISSING
    )


def comparison_doubts(comparison: Comparison) -> list[str]:
    """Return the distinct doubts of all drops, each with the laws that it concerns."""
    laws: dict[str, list[str]] = {}
    for name, one in comparison.results.items():
        for doubt in one.doubts:
            laws.setdefault(doubt, []).append(name)
    every = len(comparison.results)
    return [
        f"{'every law' if len(names) == every > 1 else ', '.join(names)}: {doubt}"
        for doubt, names in laws.items()
    ]


def free_parameter_words(law: ContactLaw) -> str:
    """Return the free parameter of a law with its value and unit, or "nothing to set" if
    the law has none.
    """
    name = law.free_parameter
    if name is None:
        return "nothing to set"
    unit = next(item for item in law.__dataclass_fields__.values() if item.name == name).metadata[
        "unit"
    ]
    return f"{name} = {float(getattr(law, name)):.6g} {unit}".rstrip()
