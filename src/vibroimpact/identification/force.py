"""The force in time from records, with the place known: no contact law is assumed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.model_errors import model_error_signals
from vibroimpact.identification.plate import Place, Plate, compliances_of, shapes_of
from vibroimpact.identification.setting import Setting, setup_slopes
from vibroimpact.signals.inverse.deconvolve import Deconvolved, deconvolve

_BEFORE = 0.35
"""How long before first touch the force may act, in durations of the pulse."""
_AFTER = 1.8
"""How long after first touch it may, in durations of the pulse."""
_MOST_NODES = 120
"""Largest number of nodes."""
_KINK_WIDTH = 0.06
"""How far the kinks of a force at its begin and end reach, in durations."""
_KINK_SIZES = (0.0, 3.0, 15.0, 63.0, 255.0)
"""How much larger its third differences may be there."""


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
        node = int(np.argmax(self.found.force))
        return float(self.found.force[node]), float(self.found.deviation[node])

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
    touched = plate.at(place)
    names = [sensor.name for sensor in measured.sensors]
    samples = measured.value.shape[1]
    gains = np.ones((len(names), 1))
    if setting is not None:
        gains = 1.0 + setting.found.gain[:, None]
    responses = gains * plate.heard(names).at(shapes_of(touched), compliances_of(touched, names))

    nodes = _nodes(touch, duration, measured.rate)
    offsets, shares = _hat(nodes.step)
    columns = []
    for time in nodes.time:
        of_node = sampled_responses(responses, measured.rate, time + offsets, shares, samples)
        columns.append((of_node * measured.weights).ravel())
    # rows are samples of all records, in standard deviations of their noise
    matrix = np.stack(columns, axis=1)
    record = (measured.value * measured.weights).ravel()
    kinks = _kinks(nodes, touch, duration)

    # errors of the model move the records in proportion to the force, which a first estimate tells
    first = _smooth(matrix, record, kinks)
    times = (nodes.time[:, None] + offsets).ravel()
    impulses = (first.force[:, None] * shares).ravel()

    def signals(responses: Floats) -> Floats:
        return sampled_responses(responses, measured.rate, times, impulses, samples)

    errors = gains * model_error_signals(
        plate, touched, names, measured.rate, times, impulses, samples
    )
    if setting is not None:
        by_setup = setup_slopes(setting.plate, plate, setting.numbers, names, place, signals)
        errors = np.concatenate([errors, np.tensordot(setting.errors.T, by_setup, 1)])
    whiten = whitening((errors * measured.weights).reshape(len(errors), -1).T)
    force = _smooth(whiten(matrix), whiten(record), kinks)

    residual = (record - matrix @ force.force).reshape(measured.value.shape)
    return Force(nodes.time, force, measured.noise[:, None] * residual)


class _Nodes(NamedTuple):
    """Times of the nodes of a force and their distance [s]."""

    time: Floats
    step: float


def _nodes(touch: float, duration: float, rate: float) -> _Nodes:
    """Return nodes about a pulse, at the instants at which responses are sampled, or at fewer."""
    span = _BEFORE + _AFTER
    fine_samples = max(1.0, np.ceil(span * duration * rate * FINENESS / _MOST_NODES))
    step = float(fine_samples) / (rate * FINENESS)
    time = touch - _BEFORE * duration + step * np.arange(int(span * duration / step) + 1)
    return _Nodes(np.asarray(time), step)


def _hat(step: float) -> tuple[Floats, Floats]:
    """Return impulses that stand for the force of a node, a hat of unit height.

    Their times from the node [s] and their sizes are by Gauss's rule on either half of the hat.
    """
    nodes, weights = np.polynomial.legendre.leggauss(4)
    half = 0.5 * (1.0 + nodes)
    offsets = step * np.concatenate([half - 1.0, 1.0 - half])
    shares = 0.5 * step * np.concatenate([weights * half, weights * half])
    return offsets, shares


def _kinks(nodes: _Nodes, touch: float, duration: float) -> Floats:
    """Return where third differences are those of a kink, where a pulse begins and ends."""
    # third differences lie between the nodes
    between = nodes.time[0] + nodes.step * (np.arange(len(nodes.time) + 3) - 1.5)
    width = _KINK_WIDTH * duration
    kinks = np.zeros(len(between))
    for kink in (touch, touch + duration):
        kinks += np.exp(-(((between - kink) / width) ** 2))
    return kinks


def _smooth(matrix: Floats, record: Floats, kinks: Floats) -> Deconvolved:
    """Return the force with the kinks, where it begins and ends, that the records prefer."""
    forces = [deconvolve(matrix, record, 1.0 + size * kinks) for size in _KINK_SIZES]
    return max(forces, key=lambda force: force.evidence)


def whitening(errors: Floats) -> Callable[[Floats], Floats]:
    """Return the map that makes unit white noise and errors white.

    The errors, (samples, n), have unit deviations.
    """
    # noise and errors together have the variance 1 + d^2 along each principal direction
    vectors, deviations, _ = np.linalg.svd(errors, full_matrices=False)
    reduction = 1.0 - 1.0 / np.sqrt(1.0 + deviations**2)

    def whiten(values: Floats) -> Floats:
        return np.asarray(values - (vectors * reduction) @ (vectors.T @ values))

    return whiten
