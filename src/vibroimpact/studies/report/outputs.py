"""The scalar results of a study, and the selection of drops for statistics and figures."""

from __future__ import annotations

from math import ceil, prod
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.dynamics.statement.outcome import Outcome
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.drop_variables import OUTCOME, PEAK_TABLE, SENSOR_PEAK
from vibroimpact.studies.report.percentiles import Spread, spread_of
from vibroimpact.units.display import Multiple, multiple

_BODIES = 6
_SENSORS = 3
"""Maximum number of results drawn, of the bodies and of sensors."""


class Output(NamedTuple):
    """A result with one value per drop.

    Attributes
    ----------
    name : str
        Name of the variable.
    title, short : str
        Name in tables and titles, and a shorter one for narrow panels.
    unit : str
        SI unit.
    spread : Spread
        Statistics of its values in the independent drops.
    """

    name: str
    title: str
    short: str
    unit: str
    spread: Spread

    @property
    def scale(self) -> Multiple:
        """The multiple of the unit in which it is shown."""
        return multiple(self.unit, self.spread.percentiles[-1])

    @property
    def is_sensor_reading(self) -> bool:
        """Whether it is the reading of a sensor."""
        return self.name not in PEAK_TABLE

    @property
    def is_zero(self) -> bool:
        """Whether it is zero in all drops."""
        return self.spread.drops > 0 and not self.spread.mean and not any(self.spread.percentiles)

    @property
    def is_informative(self) -> bool:
        """Whether it is worth a figure: it varies and describes the response."""
        return self.spread.varies and (self.is_sensor_reading or PEAK_TABLE[self.name].is_drawn)


def output_names(study: Study) -> list[str]:
    """Return the names of the scalar results, the most important first; sensors precede
    the results that are not drawn.
    """
    drawn = [name for name, peak in PEAK_TABLE.items() if peak.is_drawn]
    others = [name for name, peak in PEAK_TABLE.items() if not peak.is_drawn]
    sensors = [name for name in study.shapes if name.endswith(SENSOR_PEAK)]
    return [name for name in (*drawn, *sensors, *others) if name in study.shapes]


def study_outputs(study: Study) -> list[Output]:
    """Return the results with their statistics, the most important first."""
    outputs = []
    for name in output_names(study):
        if name in PEAK_TABLE:
            title = PEAK_TABLE[name].title
            short = PEAK_TABLE[name].short
        else:
            title = f"Largest reading of {name.removesuffix(SENSOR_PEAK)}"
            short = title
        outputs.append(
            Output(
                name,
                title,
                short,
                study.meanings[name][0],
                spread_of(independent_values(study, name)),
            )
        )
    return outputs


def drawn_outputs(outputs: list[Output]) -> list[Output]:
    """Return the results to be drawn."""
    worth = [output for output in outputs if output.is_informative]
    bodies = [output for output in worth if not output.is_sensor_reading]
    sensors = [output for output in worth if output.is_sensor_reading]
    return [*bodies[:_BODIES], *sensors[:_SENSORS]]


def independent_drops(study: Study) -> int:
    """Return the number of leading drops that are independent of each other: blocks A and
    B in the design "saltelli", else all.
    """
    if study.design != "saltelli":
        return study.size
    return 2 * (study.size // (2 + len(study.coordinates)))


def independent_values(study: Study, name: str) -> NDArray[Any]:
    """Return a result in all independent drops, flat; NaN for failed drops."""
    if study.is_grid:
        return read_output(study, name)
    return read_output(study, name, slice(0, independent_drops(study)))


def on_grid(study: Study, name: str) -> NDArray[Any]:
    """Return a result on the grid, without axes of a single level; NaN for failed drops."""
    levels = [length for length in study.dimensions.values() if length > 1]
    shape_of_drop = study.shapes[name][len(study.dimensions) :]
    return read_output(study, name).reshape(*levels, *shape_of_drop)


def on_two_axes(study: Study, name: str, first: int, second: int) -> Floats:
    """Return the median of a result over all axes of a grid but two, with the levels of the first
    as rows and of the second as columns.

    Parameters
    ----------
    study : Study
        A study on a grid.
    name : str
        Name of the result.
    first, second : int
        The two axes, counted among those of several levels.
    """
    values = on_grid(study, name)
    moved = np.moveaxis(values, (first, second), (0, 1))
    flat = moved.reshape(*moved.shape[:2], -1)
    medians = np.full(flat.shape[:2], np.nan)
    for place in np.ndindex(*medians.shape):
        here = flat[place]
        here = here[np.isfinite(here)]
        if len(here) == 1:
            # of two axes alone there are many places, each with one drop
            medians[place] = here[0]
        elif len(here):
            medians[place] = np.median(here)
    return medians


def sampled_places(study: Study, most: int) -> tuple[slice, ...]:
    """Return slices along each dimension that select a representative subset of the drops, without
    randomness.

    For sampled points these are the first ones, as the order is random and any leading part of a
    Sobol sequence is evenly distributed; for other points they are equally spaced.
    """
    if study.design not in ("grid", "zip"):
        number = independent_drops(study)
        if number > most:
            number = _at_most(most, study.design)
        return (slice(0, number),)
    lengths = list(study.dimensions.values())
    steps = [1] * len(lengths)
    while (
        prod(sampled := [ceil(length / step) for length, step in zip(lengths, steps, strict=True)])
        > most
    ):
        steps[int(np.argmax(sampled))] += 1
    return tuple(slice(None, None, step) for step in steps)


def drop_numbers(study: Study, *places: slice) -> Indices:
    """Return the numbers in drops.csv of the drops at slices along each dimension, flat;
    without slices of all.
    """
    if not places:
        return np.arange(study.size)
    if not study.is_grid:
        return np.arange(study.size)[places[0]]
    lengths = tuple(study.dimensions.values())
    chosen = np.meshgrid(
        *(np.arange(length)[place] for length, place in zip(lengths, places, strict=True)),
        indexing="ij",
    )
    return np.asarray(np.ravel_multi_index(tuple(chosen), lengths).ravel(), dtype=np.intp)


def sampled_output(study: Study, name: str, most: int) -> Floats:
    """Return a result in a representative subset of the drops, (drops, ...); NaN for
    failed drops.
    """
    return read_output(study, name, *sampled_places(study, most))


def read_output(study: Study, name: str, *places: slice) -> Floats:
    """Return a result for slices of the drops, flattened; NaN for failed drops, even if a
    partial result was stored.
    """
    values = study.values(name, *places)
    values = values.reshape(-1, *study.shapes[name][len(study.dimensions) :])
    if values.dtype != np.float64:
        values = values.astype(np.float64)
    if study.failures:
        values[study.values(OUTCOME, *places).reshape(-1) == Outcome.FAILED.code] = np.nan
    return values


def _at_most(most: int, design: str) -> int:
    """Return the number of leading drops to take: a power of two for a Sobol sequence,
    which is balanced then.
    """
    if design == "latin-hypercube":
        return most
    return 1 << (most.bit_length() - 1)
