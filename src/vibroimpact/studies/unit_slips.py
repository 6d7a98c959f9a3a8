"""Slips of units in a study: in its case, and in the values that its keys run over."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from vibroimpact.cases.build import resolved
from vibroimpact.cases.case import Case
from vibroimpact.cases.slips.find import slips, swept_slips
from vibroimpact.errors import InputError
from vibroimpact.studies.sweep import Sweep
from vibroimpact.studies.swept_keys import case_at


def axis_slips(sweep: Sweep) -> list[str]:
    """Return a sentence for each swept key of a study with values that look like a slip of a unit."""
    return swept_slips(resolved(sweep.case), sweep.plan.columns)


def sweep_slips(sweep: Sweep) -> list[str]:
    """Return a sentence for each number of a study that looks like a slip of a unit, swept or not; each is said once."""
    return _once(resolved(sweep.case), sweep.plan.columns)


def study_slips(table: Mapping[str, Any], values: Mapping[str, NDArray[Any]]) -> list[str]:
    """Return what `sweep_slips` does, of a study whose results are there.

    Parameters
    ----------
    table : mapping
        The case, as a TOML file would hold it.
    values : mapping of str to array
        By the swept key its values, in SI; the first of each is at the first point.
    """
    try:
        case: Case = case_at({key: one for key, one in table.items() if key != "sweep"}, {key: one[0] for key, one in values.items()})
    except InputError:  # the meshes of a study may be gone when its results are read
        return []
    return _once(resolved(case), values)


def _once(case: Mapping[str, Any], values: Mapping[str, NDArray[Any]]) -> list[str]:
    return [*slips(case, values), *swept_slips(case, values)]
