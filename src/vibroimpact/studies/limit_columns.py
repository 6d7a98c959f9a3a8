"""The limits of the theory for the drops of a study: the number compared with each limit,
and the limits exceeded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.conditions import Conditions, DropSummary
from vibroimpact.cases.keys import with_values
from vibroimpact.cases.limit import limits, numbers_of
from vibroimpact.cases.rigid_problem import by_speed_of
from vibroimpact.cases.validity.plate_mesh import plate_mesh_error
from vibroimpact.cases.validity.plate_waves import plate_theory_error
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.bending import largest_bending
from vibroimpact.dynamics.change_by_impact import change_by_impact
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.truncation import time_of_contact
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.studies.axes import Values
from vibroimpact.studies.drop_variables import DOUBTS, LIMIT


def limit_meanings() -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the variables on limits in a study."""
    return {
        DOUBTS: ("1", "limits that the drop is beyond"),
        **{f"{LIMIT}{name}": ("1", limit.meaning) for name, limit in limits().items()},
    }


def limit_columns(drops: Conditions, count: int) -> dict[str, NDArray[Any]]:
    """Return the numbers of the applicable limits, and a bit mask of the limits that each drop
    exceeds.

    Parameters
    ----------
    drops : Conditions
        Conditions of one drop or of a batch.
    count : int
        Number of drops.
    """
    numbers, beyond = numbers_of(drops), np.zeros(count, dtype=np.int32)
    for bit, (name, limit) in enumerate(limits().items()):
        if name in numbers:
            beyond |= np.left_shift(np.greater(numbers[name], limit.threshold), bit, dtype=np.int32)
    return {
        DOUBTS: beyond,
        **{f"{LIMIT}{name}": _one_each(number, count) for name, number in numbers.items()},
    }


def _one_each(number: Any, count: int) -> NDArray[np.float32]:
    return np.array(np.broadcast_to(number, count), dtype=np.float32)


def batch_conditions(
    case: Case, arrays: Mapping[str, Values], law: ContactLaw, peaks: Mapping[str, NDArray[Any]]
) -> Conditions:
    """Return the conditions of a batch of drops with rigid bodies, for the evaluation of the
    limits.

    Parameters
    ----------
    case : Case
        The case of the first of them.
    arrays : mapping of str to array
        The values by dotted key in which they differ.
    law : ContactLaw
        The law of the first impact, with array parameters.
    peaks : mapping of str to array
        Their peaks.
    """
    of_law = (
        key
        for key in arrays
        if key.startswith("contact.") and not key.startswith("contact.liquid.")
    )
    given_elsewhere = {key: arrays[key] for key in arrays.keys() - set(of_law)}
    table = cast("ResolvedCase", with_values(resolved_case(case), given_elsewhere))
    given = {
        item.name: getattr(law, item.name)
        for item in fields(law)
        if item.name not in by_speed_of(case)
    }
    table["contact"] |= {name: value for name, value in given.items() if value is not None}
    return Conditions(table, _seen(peaks))


def drop_conditions(response: Response, peaks: Mapping[str, NDArray[Any]]) -> Conditions:
    """Return the conditions of one drop, whose bodies may vibrate, for the evaluation of
    the limits.
    """
    problem, modes = response.problem, {}
    for body, part in response.truncation.items():
        modes[body] = part, float(getattr(problem, body).modes.frequencies[-1])
    seen = replace(
        _seen(peaks),
        duration=time_of_contact(response.impacts) if len(response.impacts["impact"]) else np.nan,
        deflection=largest_bending(response),
        modes=modes,
        changes=change_by_impact(response.impacts, problem.tolerance),
        plate_theory=plate_theory_error(problem.facts, response.impacts),
        plate_mesh=plate_mesh_error(problem.facts, response.impacts),
    )
    return Conditions(problem.source or {}, seen)


def _seen(peaks: Mapping[str, NDArray[Any]]) -> DropSummary:
    return DropSummary(
        force=peaks["largest_force_N"],
        depth=peaks["largest_indentation_m"],
        duration=peaks["first_duration_s"],
        speed=peaks["first_approach_speed_m_s"],
    )
