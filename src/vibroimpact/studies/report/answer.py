"""What a study answers: how much its results change, or their medians, with what causes it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.report.report import Quantity
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.drop_variables import SIGNAL
from vibroimpact.studies.planning.population import CLASS, ROCK
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.labels import level_words, percent
from vibroimpact.studies.report.outputs import (
    Output,
    drawn_outputs,
    independent_values,
    on_grid,
)
from vibroimpact.studies.report.percentiles import median_interval
from vibroimpact.studies.report.sensitivity_table import RANKS, SOBOL, Sensitivity, strongest
from vibroimpact.units.display import digits, text

FEW_DROPS = 12
"""Number of drops up to which each has a row, and none are summed up as percentiles."""

_MOST_RESULTS = 6
_MOST_CLASSES = 3
"""Results of a study, and classes of each of them, that the answer states."""


def answer_of(
    study: Study, outputs: list[Output], sensitivity: Sensitivity | None
) -> list[Quantity]:
    """Return the main results of a study, those that change most first.

    Of chosen points, and of few, these are ranges; of many sampled points, medians with their
    intervals. A data set begins with its numbers of falls and signals.

    Parameters
    ----------
    study : Study
        The completed study.
    outputs : list of Output
        Its results.
    sensitivity : Sensitivity, optional
        The sensitivity of those that describe the response.
    """
    drawn = sorted(drawn_outputs(outputs), key=_relative_change, reverse=True)[:_MOST_RESULTS]
    if study.labels:
        of_results = [_median(study, output, sensitivity) for output in drawn]
        return [*_data_set(study), *of_results]
    if not drawn:
        first = [output for output in outputs[:_MOST_RESULTS] if output.spread.drops]
        return [Quantity(output.title, output.spread.mean, output.unit) for output in first]
    are_chosen = study.design in ("grid", "zip")
    if are_chosen or study.size <= FEW_DROPS:
        return [_range(study, output, sensitivity) for output in drawn]
    return [_median(study, output, sensitivity) for output in drawn]


def _relative_change(output: Output) -> float:
    """Return the range of a result over its mean."""
    spread = output.spread
    return (spread.highest - spread.lowest) / (abs(spread.mean) or math.inf)


def _range(study: Study, output: Output, sensitivity: Sensitivity | None) -> Quantity:
    """Return the smallest and the largest value of a result, and what changes it."""
    axes = [axis for axis in study_axes(study) if axis.varies]
    if study.is_grid and len(axes) == 1:
        note = _where(study, output, axes[0])
    else:
        note = influence_words(sensitivity, output)
    spread = output.spread
    return Quantity(output.title, spread.lowest, output.unit, note=note, largest=spread.highest)


def _where(study: Study, output: Output, axis: StudyAxis) -> str:
    """Return at which levels of the only axis a result is smallest and largest."""
    values = on_grid(study, output.name)
    smallest = level_words(axis, int(np.nanargmin(values)))
    largest = level_words(axis, int(np.nanargmax(values)))
    return f"smallest at {axis.words} {smallest}, largest at {largest}"


def _median(study: Study, output: Output, sensitivity: Sensitivity | None) -> Quantity:
    """Return the median of a result with its interval, those of the classes or what changes it."""
    values = independent_values(study, output.name)
    independent = len(values)
    if study.labels:
        # falls of one rock are alike
        independent = len(np.unique(study.labels[ROCK]))
    interval = median_interval(values, independent)
    note = _of_classes(study, output, values) or influence_words(sensitivity, output)
    median = output.spread.percentiles[2]
    return Quantity(f"{output.title}, median", median, output.unit, note=note, interval=interval)


def _of_classes(study: Study, output: Output, values: Floats) -> str:
    """Return the median of a result in each class; "" without classes, or of many."""
    if not study.labels:
        return ""
    names = sorted(set(study.labels[CLASS].tolist()))
    if not 1 < len(names) <= _MOST_CLASSES:
        return ""
    medians = []
    for name in names:
        of_class = values[study.labels[CLASS] == name]
        median = float(np.nanmedian(of_class)) if np.isfinite(of_class).any() else math.nan
        medians.append(f"{name} {text(median, output.unit, 3)}")
    return ", ".join(medians)


def influence_words(sensitivity: Sensitivity | None, output: Output) -> str:
    """Return the key with the largest effect on a result, with its size; "" if it is not known."""
    if sensitivity is None:
        return ""
    key = strongest(sensitivity, output.name)
    if key is None:
        return ""
    number = sensitivity.keys.index(key)
    if sensitivity.way == RANKS:
        correlation = float(sensitivity.rows[output.name]["rank_correlation"][number])
        return f"most with {key} (rank correlation {digits(correlation, 2)})"
    strength = percent(float(sensitivity.strength[output.name][number]))
    if sensitivity.way == SOBOL:
        return f"{strength} of its variance by {key}"
    return f"{key} alone changes it by {strength}"


def _data_set(study: Study) -> Iterator[Quantity]:
    """Yield how many falls and signals a data set has, with its classes and its size."""
    classes = study.labels[CLASS]
    counts = ", ".join(
        f"{int((classes == name).sum()):,} {name}" for name in sorted(set(classes.tolist()))
    )
    rocks = len(np.unique(study.labels[ROCK]))
    yield Quantity("Falls", study.size, note=f"{counts}; of {rocks:,} rocks")
    signals = [name for name in study.shapes if name.startswith(SIGNAL)]
    if signals:
        sensors = ", ".join(name.removeprefix(SIGNAL) for name in signals)
        samples = study.shapes[signals[0]][-1]
        size = 1e-6 * study.path.stat().st_size
        note = f"of {sensors}, {samples:,} samples each; {digits(size, 2)} MB in {study.path.name}"
        without_failures = study.size - len(study.failures)
        yield Quantity("Signals", without_failures * len(signals), note=note)
