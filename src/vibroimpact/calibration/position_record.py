"""Impacts in a measured record of position."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.calibration.observations import Floats, Observations
from vibroimpact.calibration.record_noise import ABOVE_NOISE, named_samples, record_noise
from vibroimpact.errors import InputError

_FEWEST = 5
"""Samples of a flight through which a parabola is laid, at least."""

_SMALL, _LEAST = 0.02, 1e-9
"""Parts of the largest rise: what is no flight, and the least noise that a record has."""

_FAR = 0.5  # of the radius, that flights may meet above or below where the sphere touches


class _Flight(NamedTuple):
    """A parabola: height of its top [m] and when it is there [s]; the standard deviation of the height under noise of one; the sum
    of squares that is left of how many degrees of freedom; then its standard deviation [m].
    """

    top: float
    when: float
    under_noise: float
    left: float
    freedom: int
    deviation: float = 0.0


def impacts_in_position(
    time: Floats, position: Floats, *, radius: float, gravity: float, first_speed: float, lines: Sequence[int] | None = None
) -> Observations:
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
    lines : sequence of int, optional
        The line of a file that each sample stands on, for messages.

    Returns
    -------
    Observations
        With standard deviations from what is left over of the parabolas.

    Raises
    ------
    InputError
        If the record does not show an impact, or a flight has too few samples.

    Examples
    --------
    >>> t = np.linspace(0.0, 1.2, 601)
    >>> y = np.where(t < 0.5, 0.025 + 4.9 * (0.25 - t**2), 0.025 + np.maximum(3.0 * (t - 0.5) - 4.9 * (t - 0.5) ** 2, 0.0))
    >>> found = impacts_in_position(t, y, radius=0.025, gravity=9.8, first_speed=4.9)
    >>> found.speeds.round(3).tolist(), found.wanted["rebound_height"].round(4).tolist()
    ([4.9], [0.4842])
    """
    noise, at = record_noise(position), named_samples(lines)
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
                    f"between the impacts at {at(begin)} and {at(end)} only {len(inside)} samples show the sphere above its radius, and it "
                    f"takes {_FEWEST}; sample faster, end the record sooner, or look at sign and unit of the position"
                )
            flights.append(None)
            continue
        flights.append(_parabola(time[inside], position[inside], gravity))
    if any(flights):
        flights = _pooled(flights, _LEAST * float(np.ptp(position)))
    if flights[1] is None:
        raise InputError("the record ends before it shows how high the sphere rebounds from the first impact")
    last = len(flights) if flights[-1] is not None else len(flights) - 1
    known = [flight for flight in flights[1:last] if flight is not None]
    _check_level(flights, [at(low) for low in lows], radius, gravity)
    tops = np.array([flight.top for flight in known])
    if np.any(tops <= radius):
        raise InputError("the sphere never rises above its radius; position must be the height of its centre above the plate")
    return _between_flights(flights[0], known, tops, radius, gravity, first_speed, [at(low) for low in lows])


def _between_flights(
    first: _Flight | None, known: list[_Flight], tops: Floats, radius: float, gravity: float, first_speed: float, places: list[str]
) -> Observations:
    falls = np.sqrt(2.0 * gravity * (tops - radius))
    deviations = np.array([flight.deviation for flight in known])
    number = len(known)
    sources, before = np.zeros((number, number + 1)), np.zeros((number, number + 1))
    sources[:, 1:] = np.diag(deviations)
    before[1:, 1:] = np.diag(gravity / falls * deviations)[:-1]
    if first is not None and first.top > radius:
        first_speed = float(np.sqrt(2.0 * gravity * (first.top - radius)))
        before[0, 0] = gravity / first_speed * first.deviation
    labels = tuple(f"impact {number + 1}, {place}" for number, place in enumerate(places[: len(known)]))
    speeds = np.append(first_speed, falls[:-1])
    noise_from = "the scatter of the record"
    return Observations(speeds, {"rebound_height": tops}, before, {"rebound_height": sources}, True, labels, noise_from=noise_from)


def _parabola(time: Floats, position: Floats, gravity: float) -> _Flight:
    """Return the flight through samples: only height and speed are free."""
    middle = time.mean()
    across = time - middle
    powers = np.vander(across, 2, increasing=True)
    fallen = position + 0.5 * gravity * across**2
    (height, speed), *_ = np.linalg.lstsq(powers, fallen, rcond=None)
    left = fallen - powers @ np.array([height, speed])
    slope = np.array([1.0, speed / gravity])
    under_noise = float(np.sqrt(slope @ np.linalg.inv(powers.T @ powers) @ slope))
    when = float(middle + speed / gravity)
    return _Flight(float(height + 0.5 * speed**2 / gravity), when, under_noise, float(left @ left), len(time) - 2)


def _pooled(flights: list[_Flight | None], least: float) -> list[_Flight | None]:
    """Return flights with their standard deviations, from what is left over of all of them."""
    known = [flight for flight in flights if flight is not None]
    noise = float(np.hypot(np.sqrt(sum(flight.left for flight in known) / sum(flight.freedom for flight in known)), least))
    return [flight and flight._replace(deviation=noise * flight.under_noise) for flight in flights]


def _check_level(flights: list[_Flight | None], places: list[str], radius: float, gravity: float) -> None:
    """Raise unless neighbouring flights meet about where the sphere touches the plate."""
    for (one, other), place in zip(itertools.pairwise(flights), places, strict=True):
        if one is None or other is None:
            continue
        # where two parabolas of the same gravity cross
        across = other.when - one.when
        at = 0.5 * across + (one.top - other.top) / (gravity * across)
        level = one.top - 0.5 * gravity * at**2
        if abs(level - radius) > _FAR * radius:
            raise InputError(
                f"the flights before and after {place} meet at {level:.4g} m, and the sphere touches at its radius, {radius:g} m; position "
                "must be the height of its centre above the plate, and its unit, time and gravity those of the record"
            )


def _lowest(position: Floats, noise: float) -> NDArray[np.intp]:
    """Return the samples at which the sphere is lowest between two flights."""
    from scipy.signal import find_peaks

    rise = float(position.max() - position.min())
    found, _ = find_peaks(-position, prominence=max(_SMALL * rise, ABOVE_NOISE * noise), plateau_size=1)
    return np.asarray(found)
