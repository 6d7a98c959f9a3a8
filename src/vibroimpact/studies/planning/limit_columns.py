"""The limits of the theory for the drops of a study.

For each limit the number that is compared with it, and which limits are exceeded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.limits.conditions import Conditions, DropSummary
from vibroimpact.cases.limits.limit import limits, numbers_of
from vibroimpact.cases.rigid.rigid_problem import by_speed_of
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.cases.validity.plate_mesh import plate_mesh_error
from vibroimpact.cases.validity.plate_waves import plate_theory_error
from vibroimpact.contact.law import ContactLaw
from vibroimpact.dynamics.bending import largest_bending
from vibroimpact.dynamics.change_by_impact import change_by_impact
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.truncation import time_of_contact
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.studies.planning.axes import Values
from vibroimpact.studies.planning.drop_variables import DOUBTS, LIMIT


def limit_meanings() -> dict[str, tuple[str, str]]:
    """Return unit and meaning of the variables on limits in a study."""
    return {
        DOUBTS: ("1", "limits that the drop is beyond"),
        **{f"{LIMIT}{name}": ("1", limit.meaning) for name, limit in limits().items()},
    }


def limit_columns(drops: Conditions, count: int) -> dict[str, NDArray[Any]]:
    """Return the numbers of the applicable limits, and which limits each drop exceeds, as bits.

    Parameters
    ----------
    drops : Conditions
        Conditions of one drop or of a batch.
    count : int
        Number of drops.
    """
    numbers = numbers_of(drops)
    doubts = np.zeros(count, dtype=np.int32)
    for bit, (name, limit) in enumerate(limits().items()):
        if name in numbers:
            exceeds = np.greater(numbers[name], limit.threshold)
            doubts |= np.left_shift(exceeds, bit, dtype=np.int32)
    columns: dict[str, NDArray[Any]] = {DOUBTS: doubts}
    for name, number in numbers.items():
        # what the drops of a batch have in common has one number
        of_each = np.broadcast_to(number, count)
        columns[f"{LIMIT}{name}"] = np.array(of_each, dtype=np.float32)
    return columns


def batch_conditions(
    case: Case, arrays: Mapping[str, Values], law: ContactLaw, peaks: Mapping[str, NDArray[Any]]
) -> Conditions:
    """Return the conditions of a batch of drops with rigid bodies, to compare with the limits.

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
    other_arrays = {
        key: values
        for key, values in arrays.items()
        if not key.startswith("contact.") or key.startswith("contact.liquid.")
    }
    table = cast("ResolvedCase", with_values(resolved_case(case), other_arrays))
    # the parameters that the law has at the first impact; those that depend on the speed stay
    by_speed = by_speed_of(case)
    for item in fields(law):
        parameter = getattr(law, item.name)
        if item.name not in by_speed and parameter is not None:
            table["contact"][item.name] = parameter
    return Conditions(table, _peak_summary(peaks))


def drop_conditions(response: Response, peaks: Mapping[str, NDArray[Any]]) -> Conditions:
    """Return the conditions of one drop, whose bodies may vibrate, to compare with the limits."""
    problem = response.problem
    impacts = response.impacts
    modes = {}
    for body, truncation_error in response.truncation.items():
        highest_frequency = float(getattr(problem, body).modes.frequencies[-1])
        modes[body] = (truncation_error, highest_frequency)
    duration = np.nan
    if len(impacts["impact"]):
        duration = time_of_contact(impacts)
    summary = replace(
        _peak_summary(peaks),
        duration=duration,
        deflection=largest_bending(response),
        modes=modes,
        changes=change_by_impact(impacts, problem.tolerance),
        plate_theory=plate_theory_error(problem.facts, impacts),
        plate_mesh=plate_mesh_error(problem.facts, impacts),
    )
    return Conditions(problem.source or {}, summary)


def _peak_summary(peaks: Mapping[str, NDArray[Any]]) -> DropSummary:
    """Return the outcomes that are among the peaks of a drop."""
    return DropSummary(
        force=peaks["largest_force_N"],
        depth=peaks["largest_indentation_m"],
        duration=peaks["first_duration_s"],
        speed=peaks["first_approach_speed_m_s"],
    )
