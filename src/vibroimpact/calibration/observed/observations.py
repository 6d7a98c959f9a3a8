"""Impacts to be matched: approach speeds, target or measured values, and their noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.observed.flights import Flights, VacuumFlights, vacuum_height
from vibroimpact.calibration.observed.inputs import Input
from vibroimpact.calibration.observed.noise import (
    Noise,
    as_noise,
    no_noise,
    of_the_impact_before,
    own_noise,
    scaled,
    standard_deviations,
)


class Correction(NamedTuple):
    """What a record itself determines, and is corrected by.

    Its value, standard deviation (0 if it is not estimated), and their unit.
    """

    value: float
    deviation: float
    unit: str


class Effects(NamedTuple):
    """What one standard deviation of each of k typed inputs, such as gravity, changes.

    It changes the approach speeds [m/s], (n, k), and the target values beyond the computed ones,
    (n, k) by name. All impacts share the inputs.
    """

    inputs: tuple[Input, ...]
    speeds: Floats
    wanted: Mapping[str, Floats]


class Record(NamedTuple):
    """A record over time, corrected by what it determines itself.

    It has times [s] and forces above the baseline [N], one piece per impact; or positions [m] in
    one piece, with the times at which the flights from the plate begin [s].
    """

    quantity: Literal["force", "position"]
    pieces: tuple[tuple[Floats, Floats], ...]
    begins: tuple[float, ...] = ()


@dataclass(frozen=True)
class Observations:
    """Measured impacts that a calibration matches, with their covariance.

    Noise is a linear map from independent sources of unit variance, so that a reading shared by two
    impacts (the height between them) counts once.

    Parameters
    ----------
    speeds : array, shape (n,)
        Approach speeds [m/s].
    wanted : mapping of str to array, shape (n,)
        Target values by the names of `MATCHABLE`, in SI units.
    speed_noise : array, shape (n, m)
        Contribution of each noise source to the approach speeds [m/s]; kept as a sparse array, as
        is `noise`.
    noise : mapping of str to array, shape (n, m)
        Contribution of each source to the target values. Empty: the values are exact.
    deviations_known : bool
        Whether the magnitudes of the sources are known; otherwise only their ratios are.
    labels : tuple of str
        Names of the impacts in messages, such as "impact 3" or "row 7".
    of_the_drop : bool
        Whether they are the successive impacts of the drop.
    noise_from : str
        Origin of the magnitudes of the sources, in words.
    doubts : tuple of str
        Warnings, as sentences.
    flights : Flights, optional
        Model of the flights between impacts if they have drag; rebound heights are then converted
        to those in a vacuum.
    record : Record, optional
        The record in which they were found.
    notes : tuple of str
        How they were evaluated, as sentences.
    corrections : mapping of str to Correction
        What the record itself determines: of a position its "zero" [m], the "drift" of that [m/s],
        and its "clock", in seconds of the record per second.
    effects : Effects, optional
        What the uncertainty of typed inputs changes.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> exact = vi.calibration.Observations(
    ...     speeds=np.array([8.8, 6.8]), wanted={"restitution": np.array([0.77, 0.78])}
    ... )
    >>> exact.measured, exact.which.tolist()
    (False, [0, 1])
    """

    speeds: Floats
    wanted: Mapping[str, Floats]
    speed_noise: Noise = field(default_factory=lambda: no_noise(0, 0))
    noise: Mapping[str, Noise] = field(default_factory=dict)
    deviations_known: bool = False
    labels: tuple[str, ...] = ()
    of_the_drop: bool = True
    noise_from: str = "the given standard deviations"
    doubts: tuple[str, ...] = ()
    flights: Flights | None = None
    record: Record | None = None
    notes: tuple[str, ...] = ()
    corrections: Mapping[str, Correction] = field(default_factory=dict)
    effects: Effects | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed_noise", as_noise(self.speed_noise))
        object.__setattr__(
            self, "noise", {name: as_noise(values) for name, values in self.noise.items()}
        )

    @property
    def measured(self) -> bool:
        """Whether they come from a measurement, with noise, rather than from a law."""
        return bool(self.noise)

    @property
    def which(self) -> Indices:
        """Index of the impact of the drop that each represents, (n,).

        It is 0 if they are not impacts of the drop.
        """
        if self.of_the_drop:
            return np.arange(len(self.speeds))
        return np.zeros(len(self.speeds), dtype=np.intp)

    def redrawn(self, random: np.random.Generator) -> tuple[Floats, dict[str, Floats]]:
        """Return approach speeds and target values with random noise and random inputs."""
        # one draw for all, as a reading may be a source of several speeds and targets
        draw = random.normal(size=self.speed_noise.shape[1])
        speeds = self.speeds + self.speed_noise @ draw
        wanted = {name: values + self.noise[name] @ draw for name, values in self.wanted.items()}
        if self.effects is None:
            return speeds, wanted
        input_draw = random.normal(size=len(self.effects.inputs))
        for name, effect in self.effects.wanted.items():
            if name in wanted:
                wanted[name] = wanted[name] + effect @ input_draw
        return speeds + self.effects.speeds @ input_draw, wanted

    @property
    def speed_deviations(self) -> Floats:
        """Standard deviations of the approach speeds [m/s], (n,).

        They are 0 where speeds are exact or their noise is of unknown magnitude.
        """
        if self.deviations_known:
            by_noise = standard_deviations(self.speed_noise)
        else:
            by_noise = np.zeros(len(self.speeds))
        if self.effects is None:
            return by_noise
        return np.asarray(np.hypot(by_noise, np.linalg.norm(self.effects.speeds, axis=1)))


def impact_label(observations: Observations, impact: int) -> str:
    """Return the name of an impact in messages, or its number from 1 if it has none."""
    if observations.labels:
        return observations.labels[impact]
    return f"impact {impact + 1}"


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

    The approach speed after a flight of height h is :math:`\sqrt{2 g (h - R)}`; lower in air.

    Parameters
    ----------
    heights : array, shape (n,)
        Height of the sphere's centre above the plate at the apex of each rebound [m].
    deviation : array, shape (n,), optional
        Standard deviation of each [m].
    first_speed : float
        Approach speed of the first impact [m/s], taken as exact.
    radius, gravity : float
        Radius of the sphere [m], and acceleration of gravity [m/s^2].
    labels : tuple of str, optional
        Names of the impacts.
    flights : Flights, optional
        Model of the flights; a vacuum by default.

    Examples
    --------
    >>> impacts = from_heights(
    ...     np.array([0.525, 0.1]), None, first_speed=4.0, radius=0.025, gravity=9.8
    ... )
    >>> impacts.speeds.round(4).tolist(), impacts.wanted["rebound_height"].round(9).tolist()
    ([4.0, 3.1305], [0.525, 0.1])
    """
    flight_model = flights or VacuumFlights(gravity)
    fall_speeds, fall_slopes = flight_model.speed_after_fall(heights - radius)
    rises, rise_slopes = vacuum_height(flight_model, heights - radius)
    height_deviation = deviation
    if height_deviation is None:
        # of unknown magnitude: the same for all heights
        height_deviation = np.ones(len(heights))
    readings = own_noise({"rebound_height": height_deviation})["rebound_height"]
    return Observations(
        speeds=np.append(first_speed, fall_speeds[:-1]),
        wanted={"rebound_height": radius + rises},
        # an approach speed follows from the height before the impact
        speed_noise=of_the_impact_before(scaled(fall_slopes, readings)),
        noise={"rebound_height": scaled(rise_slopes, readings)},
        deviations_known=deviation is not None,
        labels=labels or tuple(f"impact {number + 1}" for number in range(len(heights))),
        flights=flights,
    )


def with_noise_scale(
    seen: Observations, scatter: float, weights: Mapping[str, float]
) -> Observations:
    """Return the observations with noise of known magnitude.

    It is `scatter` times the relative one, over the root of the weight.
    """
    noise = {
        name: scatter / np.sqrt(weights.get(name, 1.0)) * values
        for name, values in seen.noise.items()
    }
    return replace(seen, speed_noise=scatter * seen.speed_noise, noise=noise, deviations_known=True)


def from_table(
    speeds: Floats,
    wanted: Mapping[str, Floats],
    deviations: Mapping[str, Floats] | None,
    labels: tuple[str, ...],
    *,
    of_the_drop: bool = False,
) -> Observations:
    """Return impacts that were measured independently, at exact approach speeds.

    Parameters
    ----------
    speeds : array, shape (n,)
        Approach speeds [m/s].
    wanted : mapping of str to array, shape (n,)
        Measured values by the names of `MATCHABLE`, in SI units.
    deviations : mapping of str to array, optional
        Standard deviations, in the same units.
    labels : tuple of str
        Names of the impacts.
    of_the_drop : bool, default False
        Whether they are the successive impacts of the drop.
    """
    if deviations is None:
        # of unknown magnitude: the same relative noise for all
        sizes = {name: np.abs(values) for name, values in wanted.items()}
    else:
        sizes = {name: deviations[name] for name in wanted}
    return Observations(
        speeds=speeds,
        wanted=wanted,
        speed_noise=no_noise(len(speeds), len(speeds) * len(wanted)),
        noise=own_noise(sizes),
        deviations_known=deviations is not None,
        labels=labels,
        of_the_drop=of_the_drop,
    )
