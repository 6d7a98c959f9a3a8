"""The force in time from records, with the place known: no contact law is assumed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.antialias import FINENESS
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.plate import Plate, compliances_of, shapes_of
from vibroimpact.signals.inverse.deconvolve import Deconvolved, deconvolve

_BEFORE, _AFTER = 0.35, 1.8
"""Where the force may act: in durations of the pulse before its first touch, and after it."""
_MOST = 120
"""Largest number of nodes."""


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


def force_behind(plate: Plate, measured: Measured, there: Problem, touch: float, duration: float) -> Force:
    """Return the force behind records, at a place that is known.

    Parameters
    ----------
    plate : Plate
        The plate.
    measured : Measured
        The records.
    there : Problem
        The problem with the contact at the place.
    touch, duration : float
        About when the force acts [s].
    """
    names = [sensor.name for sensor in measured.sensors]
    answers = plate.heard(names).at(shapes_of(there), compliances_of(there, names))
    points = max(1.0, np.ceil((_BEFORE + _AFTER) * duration * measured.rate * FINENESS / _MOST))
    step = float(points) / (measured.rate * FINENESS)
    time = touch - _BEFORE * duration + step * np.arange(int((_BEFORE + _AFTER) * duration / step) + 1)
    # the force of a node is a hat, by Gauss's rule on either half of it
    nodes, weights = np.polynomial.legendre.leggauss(4)
    half = 0.5 * (1.0 + nodes)
    spread, share = step * np.concatenate([half - 1.0, 1.0 - half]), 0.5 * step * np.concatenate([weights * half, weights * half])
    samples = measured.value.shape[1]
    columns = [sampled_responses(answers, measured.rate, one + spread, share, samples) for one in time]
    matrix = np.stack([(column / measured.noise[:, None]).ravel() for column in columns], axis=1)
    record = (measured.value / measured.noise[:, None]).ravel()
    found = deconvolve(matrix, record)
    left = (record - matrix @ found.force).reshape(measured.value.shape)
    return Force(np.asarray(time), found, measured.noise[:, None] * left)
