"""What impacts are to be like: approach speeds, and what was wanted or measured at each, with its noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


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
        By the names of `OUTCOMES` in SI; NaN where one was not observed.
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
    """

    speeds: Floats
    wanted: Mapping[str, Floats]
    speed_noise: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    noise: Mapping[str, Floats] = field(default_factory=dict)
    deviations_known: bool = False
    labels: tuple[str, ...] = ()
    of_the_drop: bool = True

    @property
    def measured(self) -> bool:
        """Do they come from a measurement, and not from a rule?"""
        return bool(self.noise)

    def redrawn(self, random: np.random.Generator) -> tuple[Floats, dict[str, Floats]]:
        """Return approach speeds and what is wanted, as another measurement might have found them."""
        draw = random.normal(size=self.speed_noise.shape[1])
        return self.speeds + self.speed_noise @ draw, {name: values + self.noise[name] @ draw for name, values in self.wanted.items()}


def from_heights(
    heights: Floats, deviation: Floats | None, *, first_speed: float, radius: float, gravity: float, labels: tuple[str, ...] = ()
) -> Observations:
    """Return the impacts between measured rebound heights.

    The speed after an impact is :math:`\\sqrt{2 g (h - R)}`, and with it the sphere comes down to the next.

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

    Examples
    --------
    >>> found = from_heights(np.array([0.525]), None, first_speed=4.0, radius=0.025, gravity=9.8)
    >>> found.wanted["separation_speed"].round(4).tolist()
    [3.1305]
    """
    separation = np.sqrt(2.0 * gravity * (heights - radius))
    slope = gravity / separation * (np.ones(len(heights)) if deviation is None else deviation)
    noise = np.diag(slope)
    before = np.vstack([np.zeros(len(heights)), noise[:-1]])
    speeds = np.append(first_speed, separation[:-1])
    names = labels or tuple(f"impact {number + 1}" for number in range(len(heights)))
    return Observations(speeds, {"separation_speed": separation}, before, {"separation_speed": noise}, deviation is not None, names)


def scaled(seen: Observations, scatter: float) -> Observations:
    """Return observations whose noise, so far only compared, has a size: `scatter` times what it was."""
    noise = {name: scatter * values for name, values in seen.noise.items()}
    return replace(seen, speed_noise=scatter * seen.speed_noise, noise=noise, deviations_known=True)


def from_table(
    speeds: Floats, wanted: Mapping[str, Floats], deviations: Mapping[str, Floats] | None, labels: tuple[str, ...]
) -> Observations:
    """Return impacts that were measured apart from each other, at approach speeds that are exact.

    One alone is the first of the drop.

    Parameters
    ----------
    speeds : array, shape (n,)
        Approach speeds [m/s].
    wanted : mapping of str to array, shape (n,)
        By the names of `OUTCOMES`, in SI.
    deviations : mapping of str to array, optional
        Their standard deviations, in the same units.
    labels : tuple of str
        What each impact is called.
    """
    number, several = len(speeds), len(wanted)
    noise = {}
    for place, (name, values) in enumerate(wanted.items()):
        size = np.abs(values) if deviations is None else deviations[name]  # of unknown size: alike in percent
        block = np.zeros((number, number * several))
        block[:, place * number : (place + 1) * number] = np.diag(size)
        noise[name] = block
    return Observations(speeds, wanted, np.zeros((number, number * several)), noise, deviations is not None, labels, number == 1)
