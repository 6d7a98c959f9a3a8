"""Sensitivity of the results of a study to its swept keys, by the method that its design allows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.outputs import (
    Output,
    on_grid,
    read_output,
    sampled_output,
    sampled_places,
)
from vibroimpact.studies.report.scales import ascending_order
from vibroimpact.studies.report.sensitivity import (
    MOST_LEFT_OUT,
    one_at_a_time,
    rank_correlations,
    sobol_indices,
)

SOBOL = "sobol"
RANKS = "ranks"
RANGES = "ranges"
"""The methods: Sobol indices, rank correlations, one-at-a-time ranges."""

_POINTS = 131_072  # maximum number of points of a block for the indices, a power of two
_RANKED = 65_536  # maximum number of drops for rank correlations


class Sensitivity(NamedTuple):
    """Sensitivity of each result to each key.

    Attributes
    ----------
    way : str
        SOBOL, RANKS or RANGES.
    keys : list of str
        Keys that vary; only numeric ones for RANKS.
    rows : dict of str to dict of str to array
        By name of the result the columns of the table, one value per key.
    strength : dict of str to array
        By name of the result the effect of each key: total index, magnitude of the correlation, or
        relative range.
    notes : list of str
        Omissions, as sentences.
    """

    way: str
    keys: list[str]
    rows: dict[str, dict[str, Floats]]
    strength: dict[str, Floats]
    notes: list[str]


def sensitivity_of(study: Study, outputs: list[Output]) -> Sensitivity | None:
    """Return the sensitivity of the given results that vary; None for the design "zip",
    or if no key or no result varies.
    """
    axes = study_axes(study)
    varying = [axis for axis in axes if axis.varies]
    outputs = [output for output in outputs if output.spread.varies]
    if study.design == "zip" or not varying or not outputs:
        return None
    if study.design == "saltelli":
        return _indices(study, axes, outputs)
    if study.is_grid:
        return _ranges(study, [axis for axis in axes if len(axis.values) > 1], outputs)
    return _ranks(study, varying, outputs)


def informative_sensitivity(study: Study, outputs: list[Output]) -> Sensitivity | None:
    """Return the sensitivity of the results that describe the response, as
    `sensitivity.csv` has it; None as `sensitivity_of`.
    """
    return sensitivity_of(study, [output for output in outputs if output.is_informative])


def strongest(sensitivity: Sensitivity, output: str) -> str | None:
    """Return the key with the largest effect on a result; None if it is undetermined."""
    strength = sensitivity.strength.get(output)
    if strength is None or not np.isfinite(strength).any():
        return None
    return sensitivity.keys[int(np.nanargmax(strength))]


def _indices(study: Study, axes: list[StudyAxis], outputs: list[Output]) -> Sensitivity | None:
    rows = {}
    strength = {}
    refused = []
    left_out = {}
    block = study.size // (2 + len(axes))
    points = min(block, _POINTS)
    for output in outputs:
        # failed drops are NaN, and their points are omitted
        blocks = [
            read_output(study, output.name, slice(first, first + points))
            for first in range(0, study.size, block)
        ]
        seed = int(study.table["sweep"].get("seed", 0))
        indices = sobol_indices(np.concatenate(blocks), len(axes), seed)
        if indices is None:
            refused.append(output.title)
            continue
        if indices.left_out:
            left_out[output.title] = indices.left_out
        rows[output.name] = {
            "first_order": indices.first,
            "first_order_low": indices.first - indices.first_error,
            "first_order_high": indices.first + indices.first_error,
            "total": indices.total,
            "total_low": indices.total - indices.total_error,
            "total_high": indices.total + indices.total_error,
            "points": np.full(len(axes), indices.points),
        }
        strength[output.name] = indices.total
    notes = []
    if points < block:
        notes.append(f"Indices are those of the first {points} points of each block.")
    notes += _notes_on_left_out(refused, left_out)
    if not rows and not notes:
        return None
    return Sensitivity(SOBOL, [axis.key for axis in axes], rows, strength, notes)


def _notes_on_left_out(refused: list[str], left_out: dict[str, int]) -> list[str]:
    """Return which results have no indices, and of which some points are left out."""
    notes = []
    if refused:
        part = f"{100 * MOST_LEFT_OUT:g} % of the points"
        reason = (
            f"more than {part} have a drop without a value, since it failed or has none; or "
            "the others are fewer than two, or equal"
        )
        notes.append(f"No indices of {', '.join(refused)}: {reason}.")
    if left_out:
        numbers = ", ".join(f"{number} of {title}" for title, number in left_out.items())
        notes.append(
            f"Points left out, since one of their drops has no value: {numbers}. The indices "
            "are computed from the others."
        )
    return notes


def _ranks(study: Study, axes: list[StudyAxis], outputs: list[Output]) -> Sensitivity | None:
    named = [axis.key for axis in axes if not axis.numeric]
    numeric = [axis for axis in axes if axis.numeric]
    notes = []
    if named:
        notes.append(
            f"{', '.join(named)}: names have no order, so that there is no rank "
            "correlation with them."
        )
    if not numeric:
        return Sensitivity(RANKS, [], {}, {}, notes)
    places = sampled_places(study, _RANKED)
    inputs = np.array([axis.values[places] for axis in numeric])
    rows = {}
    for output in outputs:
        values = sampled_output(study, output.name, _RANKED)
        drops = np.full(len(numeric), int(np.isfinite(values).sum()))
        rows[output.name] = {"rank_correlation": rank_correlations(inputs, values), "drops": drops}
    if inputs.shape[1] < study.size:
        notes.append(f"Ranks are those of the first {inputs.shape[1]} drops.")
    strength = {name: np.abs(row["rank_correlation"]) for name, row in rows.items()}
    return Sensitivity(RANKS, [axis.key for axis in numeric], rows, strength, notes)


def _ranges(study: Study, axes: list[StudyAxis], outputs: list[Output]) -> Sensitivity | None:
    orders = [ascending_order(axis) for axis in axes]
    rows = {}
    strength = {}
    without_middle = []
    for output in outputs:
        ranges = one_at_a_time(on_grid(study, output.name), orders)
        if not np.isfinite(ranges.middle):
            without_middle.append(output.title)
            continue
        rows[output.name] = {
            "lowest": ranges.lowest,
            "at_the_middle": np.full(len(axes), ranges.middle),
            "highest": ranges.highest,
            "relative_range": ranges.relative,
        }
        strength[output.name] = ranges.relative
    notes = []
    if without_middle:
        results = ", ".join(without_middle)
        notes.append(f"No range of {results}: the drop at the middle of the grid has no value.")
    if not rows and not notes:
        return None
    return Sensitivity(RANGES, [axis.key for axis in axes], rows, strength, notes)
