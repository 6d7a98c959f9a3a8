"""The force in time from records, with the place known: no contact law is assumed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.model_errors import model_error_signals
from vibroimpact.identification.plate import Place, Plate, compliances_of, shapes_of
from vibroimpact.identification.setting import Setting, setup_slopes
from vibroimpact.signals.inverse.deconvolve import Deconvolved, deconvolve

_BEFORE, _AFTER = 0.35, 1.8
"""Where the force may act: in durations of the pulse before its first touch, and after it."""
_MOST = 120
"""Largest number of nodes."""
_KINK, _KINKS = 0.06, (0.0, 3.0, 15.0, 63.0, 255.0)
"""How far the kinks of a force at its begin and end reach, in durations, and how much
larger its third differences may be there.
"""


@dataclass(frozen=True)
class Force:
    """The force in time.

    Parameters
    ----------
    time : array, shape (nodes,)
        Its nodes, after the first sample of the records [s].
    found : Deconvolved
        The force there.
    residual : array, shape (S, samples)
        What it leaves of the records.
    """

    time: Floats
    found: Deconvolved
    residual: Floats

    @property
    def step(self) -> float:
        """Distance of the nodes [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def peak(self) -> tuple[float, float]:
        """Largest force with its standard deviation [N]."""
        place = int(np.argmax(self.found.force))
        return float(self.found.force[place]), float(self.found.deviation[place])

    @property
    def impulse(self) -> tuple[float, float]:
        """Impulse with its standard deviation [N s]."""
        weights = np.full(len(self.time), self.step)
        return float(weights @ self.found.force), self.found.deviation_of(weights)


def force_behind(
    plate: Plate,
    measured: Measured,
    place: Place,
    touch: float,
    duration: float,
    setting: Setting | None = None,
) -> Force:
    """Return the force behind records, at a place that is known.

    Parameters
    ----------
    plate : Plate
        The plate.
    measured : Measured
        The records, with the noise about what a force on this plate explains.
    place : tuple of two floats
        The place [m].
    touch, duration : float
        About when the force acts [s].
    setting : Setting, optional
        The set-up that was found, with its errors, if not all of it is certain.
    """
    there = plate.at(place)
    names, samples = [sensor.name for sensor in measured.sensors], measured.value.shape[1]
    gains = np.ones((len(names), 1)) if setting is None else 1.0 + setting.found.gain[:, None]
    answers = gains * plate.heard(names).at(shapes_of(there), compliances_of(there, names))
    points = max(1.0, np.ceil((_BEFORE + _AFTER) * duration * measured.rate * FINENESS / _MOST))
    step = float(points) / (measured.rate * FINENESS)
    time = (
        touch - _BEFORE * duration + step * np.arange(int((_BEFORE + _AFTER) * duration / step) + 1)
    )
    # the force of a node is a hat, by Gauss's rule on either half of it
    nodes, weights = np.polynomial.legendre.leggauss(4)
    half = 0.5 * (1.0 + nodes)
    spread, share = (
        step * np.concatenate([half - 1.0, 1.0 - half]),
        0.5 * step * np.concatenate([weights * half, weights * half]),
    )
    columns = [
        sampled_responses(answers, measured.rate, one + spread, share, samples) for one in time
    ]
    matrix = np.stack([(column * measured.weights).ravel() for column in columns], axis=1)
    record = (measured.value * measured.weights).ravel()
    # third differences lie between the nodes; those of a kink are large
    beside = time[0] + step * (np.arange(len(time) + 3) - 1.5)
    kinks = sum(
        np.exp(-(((beside - one) / (_KINK * duration)) ** 2)) for one in (touch, touch + duration)
    )
    first = _smooth(matrix, record, kinks)
    times, impulses = (time[:, None] + spread).ravel(), (first.force[:, None] * share).ravel()
    errors = gains * model_error_signals(
        plate, there, names, measured.rate, times, impulses, samples
    )
    if setting is not None:

        def signals(of: Floats) -> Floats:
            return sampled_responses(of, measured.rate, times, impulses, samples)

        by_setup = setup_slopes(setting.plate, plate, setting.numbers, names, place, signals)
        errors = np.concatenate([errors, np.tensordot(setting.errors.T, by_setup, 1)])
    white = whitening((errors * measured.weights).reshape(len(errors), -1).T)
    found = _smooth(white(matrix), white(record), kinks)
    left = (record - matrix @ found.force).reshape(measured.value.shape)
    return Force(np.asarray(time), found, measured.noise[:, None] * left)


def _smooth(matrix: Floats, record: Floats, kinks: Floats) -> Deconvolved:
    """Return the force with the kinks, where it begins and ends, that the records prefer."""
    return max(
        (deconvolve(matrix, record, 1.0 + more * kinks) for more in _KINKS),
        key=lambda found: found.evidence,
    )


def whitening(errors: Floats) -> Callable[[Floats], Floats]:
    """Return the map that makes the sum of unit white noise and of errors (samples, n)
    with unit deviations white.
    """
    vectors, deviations, _ = np.linalg.svd(errors, full_matrices=False)
    less = 1.0 - 1.0 / np.sqrt(1.0 + deviations**2)
    return lambda values: values - (vectors * less) @ (vectors.T @ values)
