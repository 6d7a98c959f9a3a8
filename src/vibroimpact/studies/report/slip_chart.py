"""Chart of a study of oblique drops: the dimensionless map of their first impacts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.cases.rigid.oblique import friction_law_of
from vibroimpact.cases.rigid.rigid_problem import rigid_problem
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.marks import Points
from vibroimpact.dynamics.motion.columns import OBLIQUE_IMPACT_COLUMNS
from vibroimpact.runs.slip_map import moduli_ratio, slip_map, slips
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.swept_keys import case_at
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.drops import MOST_DROPS, drop_texts, grouped, values_at
from vibroimpact.studies.report.outputs import drop_numbers, sampled_output, sampled_places

_COLUMNS = (*tuple(OBLIQUE_IMPACT_COLUMNS)[2:12], "approach_speed_m_s", "restitution_achieved")
_OF_THE_CONTACT = (
    "sphere.radius",
    "sphere.mass",
    "sphere.inertia",
    "sphere.material",
    "plate.radius",
    "plate.material",
    "contact.",
)
"""Beginnings of the keys on which radius, moment of inertia, coefficient and moduli depend."""


def slip_chart(study: Study) -> Chart | None:
    """Return the dimensionless map of the first impacts; None if the study did not keep oblique
    impacts, or they have no friction.

    Nor is there one where the plate is moved, as the velocities of the impact table are not
    relative to it.
    """
    if study.table["plate"].get("motion") or any(
        name not in study.shapes or not study.shapes[name][-1] for name in _COLUMNS
    ):
        return None
    numbers = drop_numbers(study, *sampled_places(study, MOST_DROPS))
    impacts = {
        name: sampled_output(study, name, MOST_DROPS).reshape(len(numbers), -1)[:, 0]
        for name in _COLUMNS
    }
    pairs = _pairs(study, numbers)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = pairs.coefficient * pairs.ratio * impacts["approach_speed_m_s"]
        before, after = (slip / scale for slip in slips(impacts, pairs.radius))
    with_slip = np.flatnonzero(np.isfinite(before) & np.isfinite(after))
    if not with_slip.size:
        return None
    numbers = numbers[with_slip]
    before = before[with_slip]
    after = after[with_slip]
    quantities = {"Slip before, ψ": ("1", before), "Slip after, ψ": ("1", after)}
    axes = [axis for axis in study_axes(study) if axis.varies]
    groups = grouped(study, axes, numbers, drop_texts(study, quantities, numbers))
    marks = [
        Points(
            before[group.chosen],
            after[group.chosen],
            group.name,
            group.role,
            group.texts,
            group.keys,
        )
        for group in groups
    ]
    return slip_map(
        marks,
        before,
        impacts["restitution_achieved"][with_slip],
        pairs.ratio[with_slip],
        pairs.inertia_ratio[with_slip],
        "The first impact of each drop a mark.",
    )


class _Pairs(NamedTuple):
    """Radius [m] and moment of inertia (over m R^2) of the sphere, coefficient of
    friction and E*/G* of drops; NaN where not known.
    """

    radius: Floats
    inertia_ratio: Floats
    coefficient: Floats
    ratio: Floats


def _pairs(study: Study, numbers: Indices) -> _Pairs:
    """Return what the contacts of drops are; each combination of the keys on which it
    depends is read once.
    """
    axes = [
        replace(axis, values=study.coordinates[axis.key])
        for axis in study_axes(study)
        if axis.key.startswith(_OF_THE_CONTACT)
    ]
    keys = [axis.key for axis in axes]
    columns = [values_at(study, axis, numbers).tolist() for axis in axes]
    rows: list[tuple[Any, ...]] = [()] * len(numbers)
    if columns:
        rows = list(zip(*columns, strict=True))
    contacts = {
        row: _contact_at(study, dict(zip(keys, row, strict=True))) for row in dict.fromkeys(rows)
    }
    return _Pairs(*np.array([contacts[row] for row in rows], dtype=float).T)


def _contact_at(study: Study, values: Mapping[str, Any]) -> tuple[float, float, float, float]:
    """Return a row of `_Pairs` for values of keys; other keys do not matter to it."""
    table = {key: value for key, value in study.table.items() if key != "sweep"}
    first_values = {key: levels[0] for key, levels in study.coordinates.items()}
    case = case_at(table, {**first_values, **values})
    coefficient = ratio = np.nan
    law = friction_law_of(case)
    if law is not None:
        coefficient = law.coefficient
        ratio = moduli_ratio(law, case)
    return case.sphere.radius, rigid_problem(case).inertia_ratio, coefficient, ratio
