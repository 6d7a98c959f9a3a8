"""The limits of the theory over the drops of a study: the number of each drop, and which of them it is beyond."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.cases.build import resolved
from vibroimpact.cases.case import Case
from vibroimpact.cases.conditions import Conditions, Seen
from vibroimpact.cases.limit import limits, numbers_of
from vibroimpact.cases.limits.plate_waves import plate_theory_error
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.bending import largest_bending
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.truncation import time_of_contact
from vibroimpact.dynamics.vibrating.sensitivity import change_by_impact
from vibroimpact.studies.axes import Values
from vibroimpact.studies.drop_variables import DOUBTS, LIMIT
from vibroimpact.studies.swept_keys import with_values


def limit_meanings() -> dict[str, tuple[str, str]]:
    """Return unit and meaning of what a study keeps of limits."""
    return {DOUBTS: ("1", "limits that the drop is beyond"), **{f"{LIMIT}{name}": ("1", limit.meaning) for name, limit in limits().items()}}


def limit_columns(drops: Conditions, count: int) -> dict[str, NDArray[Any]]:
    """Return the numbers of the limits that have a bearing on drops, and a bit for each that a drop is beyond.

    Parameters
    ----------
    drops : Conditions
        One drop, or a batch of them.
    count : int
        How many.
    """
    numbers, beyond = numbers_of(drops), np.zeros(count, dtype=np.int32)
    for bit, (name, limit) in enumerate(limits().items()):
        if name in numbers:
            beyond |= np.left_shift(np.greater(numbers[name], limit.threshold), bit, dtype=np.int32)
    return {DOUBTS: beyond, **{f"{LIMIT}{name}": _one_each(number, count) for name, number in numbers.items()}}


def _one_each(number: Any, count: int) -> NDArray[np.float32]:
    return np.array(np.broadcast_to(number, count), dtype=np.float32)


def batch_conditions(case: Case, arrays: Mapping[str, Values], law: ContactLaw, peaks: Mapping[str, NDArray[Any]]) -> Conditions:
    """Return the conditions of a batch of rigid drops, to which the limits are applied.

    Parameters
    ----------
    case : Case
        That of the first of them.
    arrays : mapping of str to array
        The values at dotted keys in which they differ.
    law : ContactLaw
        Of the first impact, with arrays for parameters.
    peaks : mapping of str to array
        What came of them.
    """
    table = with_values(resolved(case), {key: values for key, values in arrays.items() if not key.startswith("contact.")})
    given = {item.name: getattr(law, item.name) for item in fields(law)}
    table["contact"] |= {name: value for name, value in given.items() if value is not None}
    return Conditions(table, _seen(peaks))


def drop_conditions(response: Response, peaks: Mapping[str, NDArray[Any]]) -> Conditions:
    """Return the conditions of one drop, whose bodies may vibrate."""
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
    )
    return Conditions(problem.source or {}, seen)


def _seen(peaks: Mapping[str, NDArray[Any]]) -> Seen:
    return Seen(
        force=peaks["largest_force_N"],
        depth=peaks["largest_indentation_m"],
        duration=peaks["first_duration_s"],
        speed=peaks["first_approach_speed_m_s"],
    )
