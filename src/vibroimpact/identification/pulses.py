"""The place of a force from records: Hertzian pulses over the whole plate, then the best
of them refined.
"""

from __future__ import annotations

import math
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

_SHORTEST, _LONGEST, _DURATIONS = 0.5, 16.0, 8
"""Durations that are tried, over the period at the end of the band, and their number."""
_EARLIER, _LATER, _PHASES = 10, 3, 2
"""First touches that are tried: samples before and after the records rise, and how many
in a sample.
"""
_REFINED, _WORSE = 4, 0.3
"""Largest number of places that are refined, and how much less than the best they explain
of what that explains.
"""
_ALIKE = 5.99
"""Difference of minus twice the log-likelihood by which one of two coordinates of a place
is excluded at 95 %.
"""
_APART = 0.5
"""Least distance between places that differ, over the step of the grid."""
_NUDGE = 1e-4  # m, of derivatives along the plate
_LEAP = 0.02  # samples, of derivatives in time
_RATIO = 1e-3  # of derivatives in the duration


@dataclass(frozen=True)
class Candidate:
    """A place [m] with the Hertzian pulse that fits the records best there: impulse [N s], duration
    and first touch [s].

    `spread`: standard deviation of the logarithm of the duration.
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
        x, y, shapes = (
            np.array([place[0]]),
            np.array([place[1]]),
            plate.deflections(np.array([place]))[None],
        )
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    matched = _over_the_plate(plate, measured, shapes.reshape(len(places), -1))
    misfit = matched.misfit.reshape(len(y), len(x))
    worst = misfit.min() + _WORSE * (1.0 - misfit.min())
    fits = []
    for best in local_minima(misfit)[:_REFINED]:
        if matched.misfit[best] <= worst:
            start = [
                *places[best],
                np.log(matched.impulse[best]),
                np.log(matched.duration[best]),
                matched.touch[best],
            ]
            fits.append(_refined(plate, measured, np.array(start), known=place is not None))
    energies = np.array([float(fit.residual @ fit.residual) for fit in fits])
    scale = energies.min() / (np.count_nonzero(measured.heard) - 5)
    step = 0.0 if place is not None else float(np.hypot(x[1] - x[0], y[1] - y[0]))
    found: list[Candidate] = []
    for one in np.argsort(energies):
        *at, impulse, duration, touch = fits[one].parameters.tolist()
        at_x, at_y = np.clip(at, *plate.bounds).tolist()
        again = any(
            np.hypot(at_x - other.place[0], at_y - other.place[1]) < _APART * step
            for other in found
        )
        if not again and energies[one] - energies.min() < _ALIKE * scale:
            spread = float(np.sqrt(scale * fits[one].covariance[3, 3]))
            found.append(
                Candidate(
                    (at_x, at_y), float(np.exp(impulse)), float(np.exp(duration)), touch, spread
                )
            )
    return Search(x, y, misfit, tuple(found))


def _over_the_plate(plate: Plate, measured: Measured, shapes: Floats) -> Matched:
    """Return the best pulse at places with some mode shapes (places, modes); misfits are
    parts of the energy of the records.
    """
    heard = plate.heard([sensor.name for sensor in measured.sensors])
    modes, number, _ = heard.values.shape
    samples, rate = measured.value.shape[1], measured.rate
    flat, weights = heard.values.reshape(modes * number, -1), measured.weights
    earliest, tried = math.floor(measured.onset * rate - _EARLIER), _EARLIER + _LATER

    @lru_cache(maxsize=_PHASES)
    def sampled(duration: float, phase: int) -> Floats:
        time, impulse = hertz_impulses(duration)
        return sampled_responses(
            flat, rate, (earliest + tried + phase / _PHASES) / rate + time, impulse, samples + tried
        )

    def responses(duration: float, touch: int) -> Floats:
        later, phase = divmod(touch, _PHASES)
        # a pulse that is a sample later is the same samples, from one earlier on
        first = tried - later
        part = sampled(duration, phase)[:, first : first + samples].reshape(modes, number, samples)
        return np.asarray((part * weights).reshape(modes, -1))

    records = (measured.value * weights).ravel()
    durations = np.geomspace(_SHORTEST, _LONGEST, _DURATIONS) / measured.band
    matched = match_pulses(shapes, records, responses, durations.tolist(), range(_PHASES * tried))
    return matched._replace(
        misfit=matched.misfit / float(records @ records),
        touch=(earliest + matched.touch / _PHASES) / rate,
    )


def _refined(plate: Plate, measured: Measured, start: Floats, *, known: bool) -> Fit:
    """Return place, logarithms of impulse and duration, and first touch of the pulse that
    fits best, from near it.
    """
    heard = plate.heard([sensor.name for sensor in measured.sensors])
    samples, (low, high) = measured.value.shape[1], plate.bounds
    none = np.zeros(len(measured.sensors))

    def model(parameters: Floats) -> tuple[Floats, Floats]:
        place = np.clip(parameters[:2], low, high)
        impulse, duration, touch = np.exp(parameters[2]), np.exp(parameters[3]), parameters[4]
        answers = [
            heard.at(shapes, none)
            for shapes in plate.deflections(place + _NUDGE * np.array([[0, 0], [1, 0], [0, 1]]))
        ]

        def record(at: Floats, longer: float = 1.0, later: float = 0.0) -> Floats:
            time, impulses = hertz_impulses(duration * longer)
            found = sampled_responses(
                at, measured.rate, touch + later + time, impulse * impulses, samples
            )
            return np.asarray((found * measured.weights).ravel())

        here, later = record(answers[0]), _LEAP / measured.rate
        slopes = [
            *((record(one) - here) / _NUDGE for one in answers[1:]),
            here,
            (record(answers[0], longer=1.0 + _RATIO) - here) / _RATIO,
            (record(answers[0], later=later) - here) / later,
        ]
        if known:
            slopes[:2] = [np.zeros_like(here)] * 2
        return here - (measured.value * measured.weights).ravel(), np.stack(slopes, axis=1)

    most = np.array([*(0.25 * (high - low) / 8.0), 0.5, 0.3, 1.0 / measured.rate])
    return gauss_newton(model, start, most)
