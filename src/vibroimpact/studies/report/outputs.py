"""The results of a study: which there are, and how many of the drops are looked at."""

from __future__ import annotations

from math import ceil, prod
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.outcome import Outcome
from vibroimpact.studies.drop_variables import OUTCOME, PEAK_TABLE, SENSOR_PEAK
from vibroimpact.studies.percentiles import Spread, spread_of
from vibroimpact.studies.study import Study
from vibroimpact.units.display import Multiple, multiple

_BODIES, _SENSORS = 6, 3
"""How many results of the bodies, and of sensors, are drawn."""


class Output(NamedTuple):
    """A result, one value a drop.

    Attributes
    ----------
    name : str
        Of the variable.
    title, short : str
        As people say it, and what has room over a narrow figure.
    unit : str
        SI.
    spread : Spread
        Of its values in the drops that are independent.
    """

    name: str
    title: str
    short: str
    unit: str
    spread: Spread

    @property
    def scale(self) -> Multiple:
        """The multiple of the unit in which it is drawn and told."""
        return multiple(self.unit, self.spread.percentiles[-1])

    @property
    def is_sensor_reading(self) -> bool:
        """Is it what a sensor reads?"""
        return self.name not in PEAK_TABLE

    @property
    def is_informative(self) -> bool:
        """Is it worth a picture: does it vary, and say something of the bodies?"""
        return self.spread.varies and (self.is_sensor_reading or PEAK_TABLE[self.name].is_drawn)


def output_names(study: Study) -> list[str]:
    """Return the results that are one number a drop; those that matter most come first, and sensors before what is not drawn."""
    drawn = [name for name, peak in PEAK_TABLE.items() if peak.is_drawn]
    others = [name for name, peak in PEAK_TABLE.items() if not peak.is_drawn]
    sensors = [name for name in study.shapes if name.endswith(SENSOR_PEAK)]
    return [name for name in (*drawn, *sensors, *others) if name in study.shapes]


def study_outputs(study: Study, most: int | None = None) -> list[Output]:
    """Return the results with their spread, or the first of them."""
    found = []
    for name in output_names(study)[:most]:
        title = PEAK_TABLE[name].title if name in PEAK_TABLE else f"Largest reading of {name.removesuffix(SENSOR_PEAK)}"
        short = PEAK_TABLE[name].short if name in PEAK_TABLE else title
        found.append(Output(name, title, short, study.meanings[name][0], spread_of(independent_values(study, name))))
    return found


def drawn_outputs(outputs: list[Output]) -> list[Output]:
    """Return the results that are drawn."""
    worth = [one for one in outputs if one.is_informative]
    bodies = [one for one in worth if not one.is_sensor_reading]
    sensors = [one for one in worth if one.is_sensor_reading]
    return [*bodies[:_BODIES], *sensors[:_SENSORS]]


def independent_drops(study: Study) -> int:
    """Return how many drops, from the first on, are independent of each other: in the design "saltelli" the blocks A and B."""
    return study.size if study.design != "saltelli" else 2 * (study.size // (2 + len(study.coordinates)))


def independent_values(study: Study, name: str) -> NDArray[Any]:
    """Return a result in all drops that are independent of each other, flat; NaN where the drop failed."""
    return read_output(study, name) if study.is_grid else read_output(study, name, slice(0, independent_drops(study)))


def on_grid(study: Study, name: str) -> NDArray[Any]:
    """Return a result on the grid, without the dimensions of axes that have one level; NaN where the drop failed."""
    levels = (length for length in study.dimensions.values() if length > 1)
    return read_output(study, name).reshape(*levels, *study.shapes[name][len(study.dimensions) :])


def sampled_places(study: Study, most: int) -> tuple[slice, ...]:
    """Return where some drops lie that stand for all, along each dimension: the same ones each time.

    Of drawn points these are the first, since every one of them lies anywhere, and the first of a Sobol sequence are as even as
    all; of other points they are evenly apart.
    """
    if study.design not in ("grid", "zip"):
        number = independent_drops(study)
        return (slice(0, number if number <= most else _at_most(most, study.design)),)
    lengths = list(study.dimensions.values())
    steps = [1] * len(lengths)
    while prod(left := [ceil(length / step) for length, step in zip(lengths, steps, strict=True)]) > most:
        steps[int(np.argmax(left))] += 1
    return tuple(slice(None, None, step) for step in steps)


def sampled_output(study: Study, name: str, most: int) -> Floats:
    """Return a result in some drops, (drops, ...); NaN where the drop failed."""
    return read_output(study, name, *sampled_places(study, most))


def read_output(study: Study, name: str, *places: slice) -> Floats:
    """Return a result at some places, the drops flat: of a drop that failed there is none, whatever it got to."""
    found = study.values(name, *places)
    found = found.reshape(-1, *study.shapes[name][len(study.dimensions) :])
    if found.dtype != np.float64:
        found = found.astype(np.float64)
    if study.failures:
        found[study.values(OUTCOME, *places).reshape(-1) == Outcome.FAILED.code] = np.nan
    return found


def _at_most(most: int, design: str) -> int:
    """Return how many of the first drops are taken: a power of two of a Sobol sequence, which is even then."""
    return most if design == "latin-hypercube" else 1 << (most.bit_length() - 1)
