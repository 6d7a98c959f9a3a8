"""The place of a force from records: Hertzian pulses over the plate, the best of them refined."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.plate import Place, Plate
from vibroimpact.signals.inverse.gauss_newton import Fit, gauss_newton
from vibroimpact.signals.inverse.hertz_pulse import hertz_impulses
from vibroimpact.signals.inverse.match_pulses import Matched, local_minima, match_pulses

_SHORTEST = 0.5
"""Shortest duration that is tried, over the period at the end of the band."""
_LONGEST = 16.0
"""Longest duration that is tried, over that period."""
_DURATIONS = 8
"""Number of durations that are tried."""
_EARLIER = 10
"""First touches that are tried before the records rise [samples]."""
_LATER = 3
"""First touches that are tried after that [samples]."""
_PHASES = 2
"""First touches that are tried in a sample."""
_REFINED = 4
"""Largest number of places that are refined."""
_WORSE = 0.3
"""How much less they explain, at most, over what the best explains."""
_EXCLUDED = 5.99
"""Difference of minus twice the log-likelihood by which a place is excluded at 95 %.

It is that of two degrees of freedom, the coordinates.
"""
_APART = 0.5
"""Least distance between places that differ, over the step of the grid."""
_NUDGE = 1e-4
"""Step of derivatives along the plate [m]."""
_LEAP = 0.02
"""Step of derivatives in time [samples]."""
_RATIO = 1e-3
"""Step of derivatives in the logarithm of the duration [-]."""


@dataclass(frozen=True)
class Candidate:
    """A place [m] with the Hertzian pulse that fits the records best there.

    The pulse has an impulse [N s], a duration and a first touch [s]. `spread`: standard deviation
    of the logarithm of the duration.
    """

    place: Place
    impulse: float
    duration: float
    touch: float
    spread: float


@dataclass(frozen=True)
class Search:
    """The search for the place.

    Parameters
    ----------
    x, y : array
        The grid [m].
    misfit : array, shape (len(y), len(x))
        Sum of squares of what a pulse at each place leaves, over the energy of the records [-].
    candidates : tuple of Candidate
        The places that explain the records, the best first; others than the first do so no worse
        than by chance.
    """

    x: Floats
    y: Floats
    misfit: Floats
    candidates: tuple[Candidate, ...]


def search_place(plate: Plate, measured: Measured, place: Place | None = None) -> Search:
    """Return where the force was, or the best pulse at a place that is known.

    Parameters
    ----------
    plate : Plate
        The plate.
    measured : Measured
        The records.
    place : tuple of two floats, optional
        The place [m], if it is known.
    """
    if place is None:
        x, y, shapes = plate.grid
    else:
        x = np.array([place[0]])
        y = np.array([place[1]])
        shapes = plate.deflections(np.array([place]))[None]
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    matched = _over_the_plate(plate, measured, shapes.reshape(len(places), -1))
    misfit = matched.misfit.reshape(len(y), len(x))
    # minima that explain much less than the best are not refined
    worst = misfit.min() + _WORSE * (1.0 - misfit.min())
    fits = []
    for lowest in local_minima(misfit)[:_REFINED]:
        if matched.misfit[lowest] > worst:
            continue
        log_impulse = np.log(matched.impulse[lowest])
        log_duration = np.log(matched.duration[lowest])
        start = np.array([*places[lowest], log_impulse, log_duration, matched.touch[lowest]])
        fits.append(_refined(plate, measured, start, known=place is not None))
    step = 0.0
    if place is None:
        step = float(np.hypot(x[1] - x[0], y[1] - y[0]))
    return Search(x, y, misfit, _candidates(plate, measured, fits, _APART * step))


def _candidates(
    plate: Plate, measured: Measured, fits: Sequence[Fit], least_distance: float
) -> tuple[Candidate, ...]:
    """Return the places of fits that explain the records about as well as the best, which is first.

    Places nearer to each other than the least distance [m] are one.
    """
    energies = np.array([float(fit.residual @ fit.residual) for fit in fits])
    # the variance of the samples, over that of the noise, by the best fit of five parameters: over
    # it the differences of energies are chi-squared
    variance = energies.min() / (np.count_nonzero(measured.heard) - 5)
    candidates: list[Candidate] = []
    for number in np.argsort(energies):
        fit = fits[number]
        *place, log_impulse, log_duration, touch = fit.parameters.tolist()
        x, y = np.clip(place, *plate.bounds).tolist()
        is_known = any(
            np.hypot(x - candidate.place[0], y - candidate.place[1]) < least_distance
            for candidate in candidates
        )
        if is_known or not energies[number] - energies.min() < _EXCLUDED * variance:
            continue
        candidates.append(
            Candidate(
                place=(x, y),
                impulse=float(np.exp(log_impulse)),
                duration=float(np.exp(log_duration)),
                touch=touch,
                spread=float(np.sqrt(variance * fit.covariance[3, 3])),
            )
        )
    return tuple(candidates)


def _over_the_plate(plate: Plate, measured: Measured, shapes: Floats) -> Matched:
    """Return the best pulse at places with mode shapes (places, modes).

    Misfits are parts of the energy of the records.
    """
    heard = plate.heard([sensor.name for sensor in measured.sensors])
    modes, sensors, _ = heard.values.shape
    of_modes = heard.values.reshape(modes * sensors, -1)
    samples = measured.value.shape[1]
    rate = measured.rate
    weights = measured.weights
    earliest = math.floor(measured.onset * rate - _EARLIER)
    touches = _EARLIER + _LATER  # in whole samples

    @lru_cache(maxsize=_PHASES)
    def latest(duration: float, phase: int) -> Floats:
        """Return the samples of a pulse at the last of the touches, from the earliest on."""
        times, impulses = hertz_impulses(duration)
        touch = (earliest + touches + phase / _PHASES) / rate
        return sampled_responses(of_modes, rate, touch + times, impulses, samples + touches)

    def responses(duration: float, touch: int) -> Floats:
        later, phase = divmod(touch, _PHASES)
        # a pulse that is a sample later is the same samples, from one earlier on
        first = touches - later
        of_pulse = latest(duration, phase)[:, first : first + samples]
        weighed = of_pulse.reshape(modes, sensors, samples) * weights
        return np.asarray(weighed.reshape(modes, -1))

    records = (measured.value * weights).ravel()
    durations = np.geomspace(_SHORTEST, _LONGEST, _DURATIONS) / measured.band
    matched = match_pulses(shapes, records, responses, durations.tolist(), range(_PHASES * touches))
    return matched._replace(
        misfit=matched.misfit / float(records @ records),
        touch=(earliest + matched.touch / _PHASES) / rate,
    )


def _refined(plate: Plate, measured: Measured, start: Floats, *, known: bool) -> Fit:
    """Return the pulse that fits best, from near it, at a place that is known or not.

    Its parameters are x and y, the logarithms of impulse and duration, and first touch.
    """
    heard = plate.heard([sensor.name for sensor in measured.sensors])
    samples = measured.value.shape[1]
    low, high = plate.bounds
    no_compliance = np.zeros(len(measured.sensors))
    records = (measured.value * measured.weights).ravel()
    later = _LEAP / measured.rate
    nudges = _NUDGE * np.array([[0, 0], [1, 0], [0, 1]])

    def model(parameters: Floats) -> tuple[Floats, Floats]:
        """Return residuals and their derivatives by differences."""
        place = np.clip(parameters[:2], low, high)
        impulse = np.exp(parameters[2])
        duration = np.exp(parameters[3])
        touch = parameters[4]

        def signals(responses: Floats, longer: float = 1.0, later: float = 0.0) -> Floats:
            times, impulses = hertz_impulses(duration * longer)
            sampled = sampled_responses(
                responses, measured.rate, touch + later + times, impulse * impulses, samples
            )
            return np.asarray((sampled * measured.weights).ravel())

        at_place, along_x, along_y = (
            heard.at(shapes, no_compliance) for shapes in plate.deflections(place + nudges)
        )
        here = signals(at_place)
        by_x = np.zeros_like(here)
        by_y = np.zeros_like(here)
        if not known:
            by_x = (signals(along_x) - here) / _NUDGE
            by_y = (signals(along_y) - here) / _NUDGE
        by_log_impulse = here
        by_log_duration = (signals(at_place, longer=1.0 + _RATIO) - here) / _RATIO
        by_touch = (signals(at_place, later=later) - here) / later
        slopes = [by_x, by_y, by_log_impulse, by_log_duration, by_touch]
        return here - records, np.stack(slopes, axis=1)

    of_place = 0.25 * (high - low) / 8.0
    largest_steps = np.array([*of_place, 0.5, 0.3, 1.0 / measured.rate])
    return gauss_newton(model, start, largest_steps)
