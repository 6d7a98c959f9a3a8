"""The parameters that can be tuned: those of the contact law, and the modal damping of a body."""

from __future__ import annotations

from dataclasses import Field, fields, replace
from typing import Any, Literal

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.fit.matching import Tunable
from vibroimpact.calibration.fit.single_impacts import batched_law, single_impacts
from vibroimpact.contact.law import ContactLaw, unit_of
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError, choices
from vibroimpact.ranges import Range

_MODAL_START = 0.02
"""Initial guess of a damping ratio."""

_FAR = 1e6
"""Ratio of a given value to the example of its parameter above which the search begins at the
example: so far off, contacts may take a second each, or fail.
"""


def law_parameter(problem: Problem, name: str | None = None) -> Tunable:
    """Return a parameter of the contact law of a drop as a `Tunable`.

    Parameters
    ----------
    problem : Problem
        The drop.
    name : str, optional
        The parameter; by default the one that determines the energy loss.

    Raises
    ------
    InputError
        If the law has no such parameter, or none that determines its loss.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law_parameter(vi.load_case("paper:type1-constant").to_problem()).given.tolist()
    [179.75]
    """
    laws = problem.laws
    first = laws[0]
    field = _chosen_field(first, name)
    chosen = field.name
    # the value that is sought takes the place of a function of the approach speed
    by_speed = {key: function for key, function in problem.by_speed.items() if key != chosen}
    problem = replace(problem, by_speed=by_speed)
    given = np.array([float(getattr(law, chosen)) for law in laws])

    def respond(speeds: Floats, values: Floats, which: Indices) -> dict[str, Floats]:
        law = batched_law(laws, int(which.max()) + 1)
        return single_impacts(problem, law.take(which).changed({chosen: values}), speeds)

    def drop(values: Floats) -> Problem:
        changed_laws = tuple(
            _law(laws, impact).changed({chosen: _value(values, impact)})
            for impact in range(max(len(values), len(laws)))
        )
        return replace(problem, laws=changed_laws)

    allowed: Range = field.metadata["range"]
    damps = (
        chosen == first.free_parameter
        and allowed.at_least == 0.0
        and not np.isfinite(allowed.at_most)
    )
    return Tunable(
        name=chosen,
        unit=unit_of(field, getattr(first, "exponent", 1.0)),
        allowed=allowed,
        start=float(_start(float(given[0]), field.metadata["example"])),
        given=given,
        respond=respond,
        drop=drop,
        damps=damps,
    )


def _chosen_field(law: ContactLaw, name: str | None) -> Field[Any]:
    """Return the field of a law that is tuned, by default that of its free parameter.

    Raises
    ------
    InputError
        If the law has no such parameter, or gives another one in its place.
    """
    parameters = {field.name: field for field in fields(law) if not field.metadata["memory"]}
    known = {key: field for key, field in parameters.items() if getattr(law, key) is not None}
    if name is None and law.free_parameter is None:
        raise InputError(
            f"{law.name} has no loss parameter; name another law, or, to match something other "
            f"than the rebound, one of {', '.join(known)}",
            "parameter",
        )
    chosen = name or str(law.free_parameter)
    if chosen in known:
        return known[chosen]
    if chosen in parameters:
        raise InputError(
            f"the case gives no {chosen} of {law.name}, in whose place it gives another "
            f"parameter; give {chosen} alone, or tune one of {', '.join(known)}",
            "parameter",
        )
    raise InputError(
        f'{law.name} has no parameter "{chosen}"; it has {choices(known, chosen)}', "parameter"
    )


def modal_damping(problem: Problem, body: Literal["sphere", "plate"]) -> Tunable:
    """Return the damping ratio of a body, common to all its modes, as a `Tunable`.

    Parameters
    ----------
    problem : Problem
        The drop.
    body : "sphere" or "plate"
        The body.

    Raises
    ------
    InputError
        If the body is rigid.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> problem = vi.load_case("paper:type2", {"sphere.modes": 5}).to_problem()
    >>> vi.calibration.modal_damping(problem, "sphere").given.tolist()
    [0.01]
    """
    modal_body = getattr(problem, body)
    modes = modal_body.modes
    if modes is None:
        raise InputError(
            f'the {body} is rigid and has no modes to damp; give it model = "elastic"', "parameter"
        )

    def damped(ratio: float) -> Problem:
        # rigid motions have no damping
        ratios = np.where(modes.frequencies > 0.0, ratio, 0.0)
        damped_modes = replace(modes, damping_ratios=ratios)
        return replace(problem, **{body: replace(modal_body, modes=damped_modes)})

    def respond(speeds: Floats, values: Floats, which: Indices) -> dict[str, Floats]:
        # other modes for each value: no batch
        impacts = []
        for speed, value, impact in zip(speeds, values, which, strict=True):
            law = _law(problem.laws, int(impact))
            impacts.append(single_impacts(damped(float(value)), law, np.array([speed])))
        return {
            name: np.concatenate([outcomes[name] for outcomes in impacts]) for name in impacts[0]
        }

    def drop(values: Floats) -> Problem:
        return damped(float(values[0]))

    ratios = np.unique(modes.damping_ratios[modes.frequencies > 0.0])
    # one value stands for all modes, and there is none if they differ
    given = ratios if len(ratios) == 1 else np.array([np.nan])
    start = float(given[0]) if given[0] > 0.0 else _MODAL_START
    return Tunable(
        name=f"{body}.damping",
        unit="",
        allowed=Range(at_least=0, at_most=10),
        start=start,
        given=given,
        respond=respond,
        drop=drop,
    )


def _law(laws: tuple[ContactLaw, ...], impact: int) -> ContactLaw:
    """Return the law of an impact; the last one holds for all further impacts."""
    return laws[min(impact, len(laws) - 1)]


def _value(values: Floats, impact: int) -> float:
    """Return the value of an impact; the last one holds for all further impacts."""
    return float(values[min(impact, len(values) - 1)])


def _start(given: float, example: float | None) -> float:
    """Return the value at which a search begins.

    It is the given one, unless that is zero or out of proportion.
    """
    if not example:
        return given or 1.0
    near = 1.0 / _FAR <= abs(given / example) <= _FAR
    return given if near else float(example)
