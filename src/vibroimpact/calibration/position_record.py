"""Impacts in a measured record of position."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.calibration.observations import Floats, Observations
from vibroimpact.calibration.record_noise import ABOVE_NOISE, record_noise
from vibroimpact.errors import InputError

_FEWEST = 5
"""Samples of a flight through which a parabola is laid, at least."""

_SMALL, _LEAST = 0.02, 1e-9
"""Parts of the largest rise: what is no flight, and the least noise that a record has."""

_FAR = 0.5  # of the radius, that flights may meet above or below where the sphere touches


class _Flight(NamedTuple):
    """A parabola with standard deviations: height of its top [m], and when it is there [s]."""

    top: float
    deviation: float
    when: float


def impacts_in_position(time: Floats, position: Floats, *, radius: float, gravity: float, first_speed: float) -> Observations:
    """Return the impacts of a sphere whose height was recorded.

    A parabola with the given gravity goes through each flight by least squares; its top tells the speeds at its ends. Samples
    near an impact are left out, so that it does not matter how well the contact is resolved.

    Parameters
    ----------
    time, position : array, shape (n,)
        Time [s], and height of the sphere's centre above the plate [m].
    radius, gravity : float
        Of the sphere [m], and acceleration [m/s^2], > 0.
    first_speed : float
        Of the first touch [m/s]; used if the record begins too late to tell it.

    Returns
    -------
    Observations
        With standard deviations from what is left over of the parabolas.

    Raises
    ------
    InputError
        If the record does not show an impact, or a flight has too few samples; rows count from 1.

    Examples
    --------
    >>> t = np.linspace(0.0, 1.2, 601)
    >>> y = np.where(t < 0.5, 0.025 + 4.9 * (0.25 - t**2), 0.025 + np.maximum(3.0 * (t - 0.5) - 4.9 * (t - 0.5) ** 2, 0.0))
    >>> found = impacts_in_position(t, y, radius=0.025, gravity=9.8, first_speed=4.9)
    >>> found.speeds.round(3).tolist(), found.wanted["separation_speed"].round(3).tolist()
    ([4.9], [3.0])
    """
    noise = record_noise(position)
    lows = _lowest(position, noise)
    if not len(lows):
        raise InputError("the record does not show an impact: nowhere does the sphere stop falling and rise again")
    ends = [0, *lows, len(time) - 1]
    flights: list[_Flight | None] = []
    for number, (begin, end) in enumerate(itertools.pairwise(ends)):
        inside = np.arange(begin, end + 1)
        above = position[inside] > radius + ABOVE_NOISE * noise
        inside = inside[above & ((inside - begin >= 2) | (number == 0)) & ((end - inside >= 2) | (number == len(ends) - 2))]
        if len(inside) < _FEWEST:
            if 0 < number < len(ends) - 2:
                raise InputError(
                    f"between the impacts at rows {begin + 1} and {end + 1} only {len(inside)} samples show the sphere in flight, and it "
                    f"takes {_FEWEST}; sample faster, or end the record sooner"
                )
            flights.append(None)
            continue
        flights.append(_parabola(time[inside], position[inside], gravity))
    if flights[1] is None:
        raise InputError("the record ends before it shows how high the sphere rebounds from the first impact")
    last = len(flights) if flights[-1] is not None else len(flights) - 1
    known = [flight for flight in flights[1:last] if flight is not None]
    _check_level(flights, radius, gravity)
    tops = np.array([flight.top for flight in known])
    if np.any(tops <= radius):
        raise InputError("the sphere never rises above its radius; position must be the height of its centre above the plate")
    return _between_flights(flights[0], known, tops, radius, gravity, first_speed, [int(low) + 1 for low in lows])


def _between_flights(
    first: _Flight | None, known: list[_Flight], tops: Floats, radius: float, gravity: float, first_speed: float, rows: list[int]
) -> Observations:
    separation = np.sqrt(2.0 * gravity * (tops - radius))
    slopes = gravity / separation * np.array([flight.deviation for flight in known])
    sources = np.diag(np.append(0.0, slopes))
    if first is not None and first.top > radius:
        first_speed = float(np.sqrt(2.0 * gravity * (first.top - radius)))
        sources[0, 0] = gravity / first_speed * first.deviation
    labels = tuple(f"impact {number + 1}, row {row}" for number, row in enumerate(rows[: len(known)]))
    speeds = np.append(first_speed, separation[:-1])
    return Observations(speeds, {"separation_speed": separation}, sources[:-1], {"separation_speed": sources[1:]}, True, labels)


def _parabola(time: Floats, position: Floats, gravity: float) -> _Flight:
    """Return the flight through samples: only height and speed are free."""
    middle = time.mean()
    across = time - middle
    powers = np.vander(across, 2, increasing=True)
    fallen = position + 0.5 * gravity * across**2
    (height, speed), *_ = np.linalg.lstsq(powers, fallen, rcond=None)
    left = fallen - powers @ np.array([height, speed])
    variance = float(left @ left) / (len(time) - 2) + (_LEAST * float(np.ptp(position))) ** 2
    covariance = variance * np.linalg.inv(powers.T @ powers)
    slope = np.array([1.0, speed / gravity])
    return _Flight(float(height + 0.5 * speed**2 / gravity), float(np.sqrt(slope @ covariance @ slope)), float(middle + speed / gravity))


def _check_level(flights: list[_Flight | None], radius: float, gravity: float) -> None:
    """Raise unless neighbouring flights meet about where the sphere touches the plate."""
    for one, other in itertools.pairwise(flights):
        if one is None or other is None:
            continue
        # where two parabolas of the same gravity cross
        across = other.when - one.when
        at = 0.5 * across + (one.top - other.top) / (gravity * across)
        level = one.top - 0.5 * gravity * at**2
        if abs(level - radius) > _FAR * radius:
            raise InputError(
                f"the flights meet at {level:.4g} m, and the sphere touches at its radius, {radius:g} m; position must be the height of "
                "its centre above the plate, in the unit that the column says"
            )


def _lowest(position: Floats, noise: float) -> NDArray[np.intp]:
    """Return the samples at which the sphere is lowest between two flights."""
    from scipy.signal import find_peaks

    rise = float(position.max() - position.min())
    found, _ = find_peaks(-position, prominence=max(_SMALL * rise, ABOVE_NOISE * noise), plateau_size=1)
    return np.asarray(found)
