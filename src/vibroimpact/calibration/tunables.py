"""The parameters that can be tuned: those of the contact law, and the modal damping of a body."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Literal

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.matching import Tunable
from vibroimpact.calibration.single_impacts import batched_law, single_impacts
from vibroimpact.contact.law import ContactLaw, unit_of
from vibroimpact.dynamics.problem import Problem
from vibroimpact.errors import InputError, choices
from vibroimpact.ranges import Range

_MODAL_START = 0.02
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
    laws, first = problem.laws, problem.laws[0]
    known = {
        item.name: item
        for item in fields(first)
        if not item.metadata["memory"] and getattr(first, item.name) is not None
    }
    if name is None and first.free_parameter is None:
        other = f"or, to match something other than the rebound, one of {', '.join(known)}"
        raise InputError(
            f"{first.name} has no loss parameter; name another law, {other}", "parameter"
        )
    chosen = name or str(first.free_parameter)
    if chosen in {item.name for item in fields(first) if not item.metadata["memory"]} - set(known):
        words = (
            f"the case gives no {chosen} of {first.name}, in whose place it gives another parameter"
        )
        raise InputError(
            f"{words}; give {chosen} alone, or tune one of {', '.join(known)}", "parameter"
        )
    if chosen not in known:
        raise InputError(
            f'{first.name} has no parameter "{chosen}"; it has {choices(known, chosen)}',
            "parameter",
        )
    # what is sought takes the place of a function of the approach speed
    problem = replace(
        problem,
        by_speed={key: function for key, function in problem.by_speed.items() if key != chosen},
    )
    told = known[chosen].metadata
    given = np.array([float(getattr(law, chosen)) for law in laws])
    start = _start(float(given[0]), told["example"])

    def respond(speeds: Floats, values: Floats, which: Indices) -> dict[str, Floats]:
        law = batched_law(laws, int(which.max()) + 1)
        return single_impacts(problem, law.take(which).changed({chosen: values}), speeds)

    def drop(values: Floats) -> Problem:
        number = max(len(values), len(laws))
        return replace(
            problem,
            laws=tuple(
                _law(laws, impact).changed({chosen: _at(values, impact)})
                for impact in range(number)
            ),
        )

    unit = unit_of(known[chosen], getattr(first, "exponent", 1.0))
    allowed: Range = told["range"]
    damps = (
        chosen == first.free_parameter
        and allowed.at_least == 0.0
        and not np.isfinite(allowed.at_most)
    )
    return Tunable(chosen, unit, allowed, float(start), given, respond, drop, damps)


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
    >>> problem = vi.read_case(
    ...     {
    ...         "sphere": {
    ...             "radius": "25 mm",
    ...             "material": "rock-paper",
    ...             "model": "elastic",
    ...             "modes": 5,
    ...             "damping": 0.02,
    ...         },
    ...         "plate": {"material": "rigid"},
    ...         "drop": {"speed": 1.0},
    ...         "contact": {"law": "hertz"},
    ...     }
    ... ).to_problem()
    >>> vi.modal_damping(problem, "sphere").given.tolist()
    [0.02]
    """
    modes = getattr(problem, body).modes
    if modes is None:
        raise InputError(
            f'the {body} is rigid and has no modes to damp; give it model = "elastic"', "parameter"
        )

    def damped(ratio: float) -> Problem:
        ratios = np.where(modes.frequencies > 0.0, ratio, 0.0)
        return replace(
            problem,
            **{body: replace(getattr(problem, body), modes=replace(modes, damping_ratios=ratios))},
        )

    def respond(speeds: Floats, values: Floats, which: Indices) -> dict[str, Floats]:
        each = [
            single_impacts(damped(float(value)), _law(problem.laws, int(impact)), np.array([speed]))
            for speed, value, impact in zip(speeds, values, which, strict=True)
        ]
        return {name: np.concatenate([one[name] for one in each]) for name in each[0]}

    ratios = np.unique(modes.damping_ratios[modes.frequencies > 0.0])
    given = np.array([ratios[0] if len(ratios) == 1 else np.nan])
    start = float(given[0]) if given[0] > 0.0 else _MODAL_START
    return Tunable(
        f"{body}.damping",
        "",
        Range(at_least=0, at_most=10),
        start,
        given,
        respond,
        lambda values: damped(float(values[0])),
    )


def _law(laws: tuple[ContactLaw, ...], impact: int) -> ContactLaw:
    return laws[min(impact, len(laws) - 1)]


def _at(values: Floats, impact: int) -> float:
    return float(values[min(impact, len(values) - 1)])


def _start(given: float, example: float | None) -> float:
    """Return the value at which a search begins: the given one, unless it is zero or out
    of proportion.
    """
    if not example:
        return given or 1.0
    near = 1.0 / _FAR <= abs(given / example) <= _FAR
    return given if near else float(example)
