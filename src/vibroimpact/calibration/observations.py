"""What impacts are to be like: approach speeds, and what was wanted or measured at each, with its noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.flights import Flights, VacuumFlights, vacuum_height


class Record(NamedTuple):
    """What was recorded over time: times [s] and values of a force [N], above its level at rest, one piece an impact; or of a position
    [m], in one piece, and when the first impact ends in that [s].
    """

    quantity: Literal["force", "position"]
    pieces: tuple[tuple[Floats, Floats], ...]
    begin: float = 0.0


@dataclass(frozen=True)
class Observations:
    """Impacts to be matched.

    Noise is a linear map from independent sources, each of unit variance, so that readings which two impacts share (the height
    between them) are counted once.

    Parameters
    ----------
    speeds : array, shape (n,)
        Approach speeds [m/s].
    wanted : mapping of str to array, shape (n,)
        By the names of `MATCHABLE` in SI.
    speed_noise : array, shape (n, m)
        What each source adds to the approach speeds [m/s].
    noise : mapping of str to array, shape (n, m)
        What each source adds to what is wanted. Empty: there is no noise, what is wanted is exact.
    deviations_known : bool
        Are the sizes of the sources known? Else only how they compare.
    labels : tuple of str
        What each is called in messages, such as "impact 3" or "row 7".
    of_the_drop : bool
        Are they the impacts of the drop, in order?
    noise_from : str
        Where the sizes of the sources come from, in words.
    doubts : tuple of str
        What to doubt of them.
    flights : Flights, optional
        How the sphere flies from impact to impact, where that is not in a vacuum; then rebound heights are those that it would
        reach in one.
    record : Record, optional
        The record that they were found in.
    notes : tuple of str
        How they were evaluated, in sentences.
    """

    speeds: Floats
    wanted: Mapping[str, Floats]
    speed_noise: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    noise: Mapping[str, Floats] = field(default_factory=dict)
    deviations_known: bool = False
    labels: tuple[str, ...] = ()
    of_the_drop: bool = True
    noise_from: str = "the given standard deviations"
    doubts: tuple[str, ...] = ()
    flights: Flights | None = None
    record: Record | None = None
    notes: tuple[str, ...] = ()

    @property
    def measured(self) -> bool:
        """Do they come from a measurement, and not from a rule?"""
        return bool(self.noise)

    @property
    def which(self) -> Indices:
        """Which impact of the drop each stands for; those that were measured apart from it for the first, (n,)."""
        return np.arange(len(self.speeds)) if self.of_the_drop else np.zeros(len(self.speeds), dtype=np.intp)

    def redrawn(self, random: np.random.Generator) -> tuple[Floats, dict[str, Floats]]:
        """Return approach speeds and what is wanted, as another measurement might have found them."""
        draw = random.normal(size=self.speed_noise.shape[1])
        return self.speeds + self.speed_noise @ draw, {name: values + self.noise[name] @ draw for name, values in self.wanted.items()}


def from_heights(
    heights: Floats,
    deviation: Floats | None,
    *,
    first_speed: float,
    radius: float,
    gravity: float,
    labels: tuple[str, ...] = (),
    flights: Flights | None = None,
) -> Observations:
    r"""Return the impacts between measured rebound heights.

    With :math:`\sqrt{2 g (h - R)}` the sphere comes down from a height h to the next; in air more slowly.

    Parameters
    ----------
    heights : array, shape (n,)
        Of the sphere's centre above the plate at the top of each rebound [m].
    deviation : array, shape (n,), optional
        Standard deviation of each [m].
    first_speed : float
        Speed of the first touch [m/s], taken as exact.
    radius, gravity : float
        Of the sphere [m], and acceleration [m/s^2].
    labels : tuple of str, optional
        What each is called.
    flights : Flights, optional
        How the sphere flies; in a vacuum by default.

    Examples
    --------
    >>> found = from_heights(np.array([0.525, 0.1]), None, first_speed=4.0, radius=0.025, gravity=9.8)
    >>> found.speeds.round(4).tolist(), found.wanted["rebound_height"].round(9).tolist()
    ([4.0, 3.1305], [0.525, 0.1])
    """
    flying = flights or VacuumFlights(gravity)
    falls, slopes = flying.speed_after_fall(heights - radius)
    rises, scales = vacuum_height(flying, heights - radius)
    noise = np.diag(np.ones(len(heights)) if deviation is None else deviation)
    before = np.vstack([np.zeros(len(heights)), slopes[:-1, None] * noise[:-1]])
    names = labels or tuple(f"impact {number + 1}" for number in range(len(heights)))
    speeds, known = np.append(first_speed, falls[:-1]), deviation is not None
    wanted, noises = {"rebound_height": radius + rises}, {"rebound_height": scales[:, None] * noise}
    return Observations(speeds, wanted, before, noises, known, names, flights=flights)


def with_noise_scale(seen: Observations, scatter: float, weights: Mapping[str, float]) -> Observations:
    """Return observations whose noise, so far only compared, has a size: `scatter` times what it was, less where a weight says so."""
    noise = {name: scatter / np.sqrt(weights.get(name, 1.0)) * values for name, values in seen.noise.items()}
    return replace(seen, speed_noise=scatter * seen.speed_noise, noise=noise, deviations_known=True)


def from_table(
    speeds: Floats,
    wanted: Mapping[str, Floats],
    deviations: Mapping[str, Floats] | None,
    labels: tuple[str, ...],
    *,
    of_the_drop: bool = False,
) -> Observations:
    """Return impacts that were measured apart from each other, at approach speeds that are exact.

    Parameters
    ----------
    speeds : array, shape (n,)
        Approach speeds [m/s].
    wanted : mapping of str to array, shape (n,)
        By the names of `MATCHABLE`, in SI.
    deviations : mapping of str to array, optional
        Their standard deviations, in the same units.
    labels : tuple of str
        What each impact is called.
    of_the_drop : bool, default False
        Are they the impacts of the drop, in order?
    """
    number, several = len(speeds), len(wanted)
    noise = {}
    for place, (name, values) in enumerate(wanted.items()):
        size = np.abs(values) if deviations is None else deviations[name]  # of unknown size: alike in percent
        block = np.zeros((number, number * several))
        block[:, place * number : (place + 1) * number] = np.diag(size)
        noise[name] = block
    return Observations(speeds, wanted, np.zeros((number, number * several)), noise, deviations is not None, labels, of_the_drop)
