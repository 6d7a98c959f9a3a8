"""The results of a study: which there are, and how many of the drops are looked at."""

from __future__ import annotations

from math import prod
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.response import Outcome
from vibroimpact.report.excerpt import Floats
from vibroimpact.report.study.axes import design_of
from vibroimpact.storage.study import Study
from vibroimpact.studies.columns import OUTCOME, PEAKS, SENSOR_PEAK
from vibroimpact.studies.percentiles import Spread, spread_of

_TITLES = {
    "largest_force_N": "Largest force",
    "largest_indentation_m": "Largest indentation",
    "first_restitution_achieved": "Restitution achieved, first impact",
    "first_duration_s": "Duration of the first contact",
    "total_energy_lost_J": "Energy lost in all contacts",
    "first_rebound_height_m": "Height of the first rebound",
    "largest_acceleration_m_s2": "Largest acceleration",
    "first_approach_speed_m_s": "Speed at first touch",
    "first_restitution_asked": "Restitution asked, first impact",
    "number_of_impacts": "Number of impacts",
    "end_time_s": "Time at the end of the run",
    "closure_relative": "Closure of the energy, relative",
}
_TOLD_ALONE = {"closure_relative", "first_restitution_asked", "end_time_s", "number_of_impacts", "first_approach_speed_m_s"}
"""Results that are told in numbers: of no body's behaviour, or as good as an input."""

_FAILED = list(Outcome).index(Outcome.FAILED)

_BODIES, _SENSORS = 6, 3
"""How many results of the bodies, and of sensors, are drawn."""


class Output(NamedTuple):
    """A result, one value a drop.

    Attributes
    ----------
    name : str
        Of the variable.
    title : str
        As people say it.
    unit : str
        SI.
    spread : Spread
        Of its values in the drops that are independent.
    """

    name: str
    title: str
    unit: str
    spread: Spread

    @property
    def tells(self) -> bool:
        """Is it worth a picture: does it vary, and say something of the bodies?"""
        return self.spread.varies and self.name not in _TOLD_ALONE


def output_names(study: Study) -> dict[str, str]:
    """Return the results that are one number a drop, and their titles; those that matter most come first."""
    sensors = {name: f"Largest reading of {name.removesuffix(SENSOR_PEAK)}" for name in study.shapes if name.endswith(SENSOR_PEAK)}
    titles = {name: _TITLES.get(name, PEAKS[name][1].capitalize()) for name in [*_TITLES, *PEAKS] if name in study.shapes}
    bodies = [name for name in titles if name not in _TOLD_ALONE]
    return {name: {**titles, **sensors}[name] for name in [*bodies, *sensors, *(name for name in titles if name in _TOLD_ALONE)]}


def study_outputs(study: Study, most: int | None = None) -> list[Output]:
    """Return the results with their spread, or the first of them."""
    names = list(output_names(study).items())[:most]
    return [Output(name, title, study.meanings[name][0], spread_of(independent(study, name))) for name, title in names]


def drawn_outputs(outputs: list[Output]) -> list[Output]:
    """Return the results that are drawn."""
    worth = [one for one in outputs if one.tells]
    bodies = [one for one in worth if not one.name.endswith(SENSOR_PEAK)]
    sensors = [one for one in worth if one.name.endswith(SENSOR_PEAK)]
    return [*bodies[:_BODIES], *sensors[:_SENSORS]]


def independent_drops(study: Study) -> int:
    """Return how many drops, from the first on, are independent of each other: in the design "saltelli" the blocks A and B."""
    return study.size if design_of(study) != "saltelli" else 2 * (study.size // (2 + len(study.coordinates)))


def independent(study: Study, name: str) -> NDArray[Any]:
    """Return a result in all drops that are independent of each other, flat; NaN where the drop failed."""
    whole = len(study.dimensions) > 1
    return read_output(study, name) if whole else read_output(study, name, slice(0, independent_drops(study)))


def on_grid(study: Study, name: str) -> NDArray[Any]:
    """Return a result on the grid, without the dimensions of axes that have one level; NaN where the drop failed."""
    shape = grid_shape(study)
    found = read_output(study, name)
    return found.reshape(*(length for length in shape if length > 1), *study.shapes[name][len(shape) :])


def grid_shape(study: Study) -> tuple[int, ...]:
    """Return how many levels the axes have, in the order of the points."""
    return study.shapes[OUTCOME]


def some_places(study: Study, most: int) -> tuple[slice, ...]:
    """Return where some drops lie that stand for all, along each dimension: the same ones each time.

    Of drawn points these are the first, since every one of them lies anywhere, and the first of a Sobol sequence are as even as
    all; of other points they are evenly apart.
    """
    design, lengths = design_of(study), grid_shape(study)
    if design not in ("grid", "zip"):
        number = independent_drops(study)
        return (slice(0, number if number <= most else _at_most(most, design)),)
    steps = [1] * len(lengths)
    while prod(_lengths(lengths, steps)) > most:
        longest = int(np.argmax(_lengths(lengths, steps)))
        steps[longest] += 1
    return tuple(slice(None, None, step) for step in steps)


def some(study: Study, name: str, most: int) -> Floats:
    """Return a result in some drops, (drops, ...); NaN where the drop failed."""
    return read_output(study, name, *some_places(study, most))


def read_output(study: Study, name: str, *places: slice) -> Floats:
    """Return a result at some places, the drops flat: of a drop that failed there is none, whatever it got to."""
    found = study.values(name, *places)
    found = found.reshape(-1, *study.shapes[name][len(grid_shape(study)) :])
    if found.dtype != np.float64:
        found = found.astype(np.float64)
    if study.failures:
        found[study.values(OUTCOME, *places).reshape(-1) == _FAILED] = np.nan
    return found


def _lengths(lengths: tuple[int, ...], steps: list[int]) -> list[int]:
    return [-(-length // step) for length, step in zip(lengths, steps, strict=True)]


def _at_most(most: int, design: str) -> int:
    """Return how many of the first drops are taken: a power of two of a Sobol sequence, which is even then."""
    return most if design == "latin-hypercube" else 1 << (most.bit_length() - 1)
