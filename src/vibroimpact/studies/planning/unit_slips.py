"""Suspected slips of units in a study: in its case, and in the values of its swept keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.wrong_units.detect import slips, swept_slips
from vibroimpact.errors import InputError
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.studies.planning.sweep import Sweep
from vibroimpact.studies.planning.swept_keys import case_at


def axis_slips(sweep: Sweep) -> list[str]:
    """Return a sentence for each swept key with values that suggest a slip of a unit."""
    return swept_slips(resolved_case(sweep.case), sweep.plan.columns)


def sweep_slips(sweep: Sweep) -> list[str]:
    """Return a sentence for each number of a study that suggests a slip of a unit.

    It may be swept or not; no sentence is repeated.
    """
    return _all_slips(resolved_case(sweep.case), sweep.plan.columns)


def study_slips(table: Mapping[str, Any], values: Mapping[str, NDArray[Any]]) -> list[str]:
    """Return the sentences of `sweep_slips` for a completed study.

    Parameters
    ----------
    table : mapping
        The case, with the structure of a TOML case file.
    values : mapping of str to array
        By swept key its values in SI units; the first of each belongs to the first point.
    """
    try:
        case: Case = case_at(
            {key: section for key, section in table.items() if key != "sweep"},
            {key: column[0] for key, column in values.items()},
        )
    except InputError:  # mesh files may be missing when results are read
        return []
    return _all_slips(resolved_case(case), values)


def _all_slips(case: ResolvedCase, values: Mapping[str, NDArray[Any]]) -> list[str]:
    """Return the sentences on the numbers of a case that are not swept, and on swept values."""
    return [*slips(case, values), *swept_slips(case, values)]
