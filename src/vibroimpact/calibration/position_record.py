"""Impacts in a measured position record."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import diags_array

from vibroimpact.arrays import Floats, Indices
from vibroimpact.calibration.flights import Flights, VacuumFlights, vacuum_height
from vibroimpact.calibration.noise import scaled
from vibroimpact.calibration.observations import Observations, Record
from vibroimpact.calibration.record_noise import ABOVE_NOISE, record_noise, sample_label
from vibroimpact.contact.roots import find_root
from vibroimpact.errors import InputError

_FEWEST = 5
"""Minimum number of samples of a fitted flight."""

_SMALL, _LEAST = 0.02, 1e-9
"""Fractions of the range of the record: the least prominence of an impact, and the lower bound of the noise."""

_SETTLED, _ROUNDS = 1e-13, 30
"""Tolerance of the fit of a flight relative to its height, and the maximum number of iterations."""

_FAR = 0.5  # tolerance of the height at which successive flights meet, as a fraction of the radius


class _Flight(NamedTuple):
    """A fitted flight: height [m] and time [s] of its apex; standard deviation of the height per unit of noise; residual sum of squares and
    its degrees of freedom; the standard deviation of the height [m].
    """

    top: float
    when: float
    under_noise: float
    left: float
    freedom: int
    deviation: float = 0.0


def impacts_in_position(
    time: Floats,
    position: Floats,
    *,
    radius: float,
    gravity: float,
    first_speed: float,
    lines: Sequence[int] | None = None,
    flights: Flights | None = None,
) -> Observations:
    """Return the impacts of a sphere whose height was recorded.

    A free flight under the given gravity (a parabola in a vacuum) is fitted between successive impacts by least squares; the speeds
    at its ends follow from its apex. Samples near an impact are omitted, so that the contact need not be resolved.

    Parameters
    ----------
    time, position : array, shape (n,)
        Time [s], and height of the sphere's centre above the plate [m].
    radius, gravity : float
        Radius of the sphere [m], and acceleration of gravity [m/s^2], > 0.
    first_speed : float
        Approach speed of the first impact [m/s]; used if the record does not show the fall before it.
    lines : sequence of int, optional
        The line of each sample in the file, for messages.
    flights : Flights, optional
        Model of the flights; a vacuum by default.

    Returns
    -------
    Observations
        With standard deviations from the residuals of the fitted flights.

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
    noise, at, flying = record_noise(position), sample_label(lines), flights or VacuumFlights(gravity)
    lows = _lowest(position, noise)
    if not len(lows):
        raise InputError("the record does not show an impact: nowhere does the sphere stop falling and rise again")
    # fit the fall before the first impact and the flight after each; the record may cut the first and the last short
    ends = [0, *lows, len(time) - 1]
    fitted: list[_Flight | None] = []
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
            fitted.append(None)
            continue
        fitted.append(_fitted(time[inside], position[inside], flying))
    if any(fitted):
        fitted = _pooled(fitted, _LEAST * float(np.ptp(position)))
    if fitted[1] is None:
        raise InputError("the record ends before it shows how high the sphere rebounds from the first impact")
    last = len(fitted) if fitted[-1] is not None else len(fitted) - 1
    known = [flight for flight in fitted[1:last] if flight is not None]
    _check_level(fitted, [at(low) for low in lows], radius, flying)
    if any(flight.top <= radius for flight in known):
        raise InputError("the sphere never rises above its radius; position must be the height of its centre above the plate")
    labels = tuple(f"impact {number + 1}, {at(low)}" for number, low in enumerate(lows[: len(known)]))
    begin = known[0].when - float(flying.flight(flying.speed_to_rise(np.array(known[0].top - radius))[0]).rise_time)
    found = _between_flights(fitted[0], known, radius, flying, first_speed, labels)
    return replace(found, flights=flights, record=Record("position", ((time, position),), begin))


def _between_flights(
    first: _Flight | None, known: list[_Flight], radius: float, flying: Flights, first_speed: float, labels: tuple[str, ...]
) -> Observations:
    tops, deviations = (np.array([getattr(flight, name) for flight in known]) for name in ("top", "deviation"))
    falls, slopes = flying.speed_after_fall(tops - radius)
    rises, scales = vacuum_height(flying, tops - radius)
    number, of_first = len(known), 0.0
    if first is not None and first.top > radius:
        speed, slope = flying.speed_after_fall(np.array(first.top - radius))
        first_speed, of_first = float(speed), float(slope) * first.deviation
    tops_noise = diags_array(deviations, offsets=1, shape=(number, number + 1))  # the first source is the fall before the first impact
    before = diags_array(np.append(of_first, (slopes * deviations)[:-1]), shape=(number, number + 1))
    wanted, noise = {"rebound_height": radius + rises}, {"rebound_height": scaled(scales, tops_noise)}
    noise_from = "the scatter of the record"
    return Observations(np.append(first_speed, falls[:-1]), wanted, before, noise, True, labels, noise_from=noise_from)


def _fitted(time: Floats, position: Floats, flying: Flights) -> _Flight:
    """Return the least-squares fit of a flight to samples; the free parameters are height and time of its apex."""
    middle, gravity = float(time.mean()), flying.gravity
    across = time - middle
    powers = np.vander(across, 2, increasing=True)
    (height, speed), *_ = np.linalg.lstsq(powers, position + 0.5 * gravity * across**2, rcond=None)  # initial guess: in a vacuum
    top, when = float(height + 0.5 * speed**2 / gravity), float(middle + speed / gravity)
    for _ in range(_ROUNDS):
        fallen, downwards = flying.depth_at(time - when)
        left, slopes = position - (top - fallen), np.stack([np.ones_like(time), downwards], axis=1)
        step, *_ = np.linalg.lstsq(slopes, left, rcond=None)
        top, when = top + float(step[0]), when + float(step[1])
        if abs(step[0]) <= _SETTLED * abs(top):
            break
    left = position - (top - flying.depth_at(time - when)[0])
    inverse = np.linalg.pinv(slopes.T @ slopes)
    return _Flight(top, when, float(np.sqrt(inverse[0, 0])), float(left @ left), len(time) - 2)


def _pooled(flights: list[_Flight | None], least: float) -> list[_Flight | None]:
    """Return the flights with standard deviations from the pooled residuals of all of them."""
    known = [flight for flight in flights if flight is not None]
    noise = float(np.hypot(np.sqrt(sum(flight.left for flight in known) / sum(flight.freedom for flight in known)), least))
    return [flight and flight._replace(deviation=noise * flight.under_noise) for flight in flights]


def _check_level(fitted: list[_Flight | None], places: list[str], radius: float, flying: Flights) -> None:
    """Check that successive flights meet near the height at which the sphere touches the plate."""
    for (one, other), place in zip(itertools.pairwise(fitted), places, strict=True):
        if one is None or other is None:
            continue
        level = _where_they_meet(one, other, flying)
        if not abs(level - radius) <= _FAR * radius:
            meet = f"meet at {level:.4g} m" if np.isfinite(level) else "do not meet"
            raise InputError(
                f"the flights before and after {place} {meet}, and the sphere touches at its radius, {radius:g} m; position "
                "must be the height of its centre above the plate, and its unit, time and gravity those of the record"
            )


def _where_they_meet(one: _Flight, other: _Flight, flying: Flights) -> float:
    """Return the height at which a flight crosses the following one between their apexes [m]; NaN if it does not."""

    def apart(time: Floats) -> Floats:
        return (other.top - flying.depth_at(time - other.when)[0]) - (one.top - flying.depth_at(time - one.when)[0])

    ends = np.array([one.when]), np.array([other.when])
    if not (apart(ends[0])[0] < 0.0 < apart(ends[1])[0]):
        return float("nan")
    return float(one.top - flying.depth_at(find_root(apart, *ends) - one.when)[0][0])


def _lowest(position: Floats, noise: float) -> Indices:
    """Return the indices of the local minima of the position, the impacts."""
    from scipy.signal import find_peaks

    rise = float(position.max() - position.min())
    found, _ = find_peaks(-position, prominence=max(_SMALL * rise, ABOVE_NOISE * noise), plateau_size=1)
    return np.asarray(found)
