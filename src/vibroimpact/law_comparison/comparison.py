"""Comparison of one drop under several contact laws."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.case import Case
from vibroimpact.cases.rigid.pair import contact_pair, sphere_density
from vibroimpact.cases.rigid.rigid_problem import contact_laws_of, touch_speed
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.restitution import achieved_restitution
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.law_comparison.laws import cases_under
from vibroimpact.report.reported import Reported
from vibroimpact.results.result import Result, result_of

_SPEEDS = 61


@dataclass(frozen=True)
class Comparison(Reported, reported_in="vibroimpact.law_comparison.report"):
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
    >>> comparison = vi.laws.compare_laws(vi.load_case("paper:type1-theory"), ["tsuji", "flores"])
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
    >>> comparison = vi.laws.compare_laws(
    ...     vi.load_case("paper:type1-theory"), ["hunt-crossley", "flores"]
    ... )
    >>> {
    ...     name: round(float(one.impacts["restitution_achieved"][0]), 3)
    ...     for name, one in comparison.results.items()
    ... }
    {'hunt-crossley': 0.739, 'flores': 0.63}
    """
    cases = cases_under(case, laws, given, achieving)
    mass = contact_pair(case).effective_mass
    speed = touch_speed(case)
    speeds = speed * np.geomspace(1e-3, 3.0, _SPEEDS)
    first = {}
    results = {}
    restitutions = {}
    for number, (name, law_case) in enumerate(cases.items()):
        results[name] = result_of(simulate(law_case))
        first[name] = contact_laws_of(law_case)[0]
        restitutions[name] = achieved_restitution(
            _around(law_case, first[name], speeds), mass, speeds
        )
        if progress is not None:
            progress((number + 1) / len(cases))
    return Comparison(case.name or "a drop", results, first, speeds, restitutions)


def _around(case: Case, law: ContactLaw, speeds: Floats) -> ContactLaw:
    """Return a law with the restitution that the liquid of a case, if there is one,
    leaves it at each approach speed [m/s].
    """
    table = case.contact.local.liquid
    if table is None:
        return law
    return table.liquid().around(law, speeds, case.sphere.radius, sphere_density(case.sphere))
