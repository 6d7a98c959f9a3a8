"""Effect of the errors of a plate's model on the records of its sensors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.identification.plate import Plate, compliances_of, shapes_of


def model_error_signals(
    plate: Plate,
    touched: Problem,
    names: Sequence[str],
    rate: float,
    times: Floats,
    impulses: Floats,
    samples: int,
) -> Floats:
    """Return the changes of records by one standard deviation of each error of the plate's model.

    They are (S + modes, S, samples). The errors are those of the static response of the modes left
    out to each sensor, whose standard deviation is that response, as it grows towards their
    frequencies, and those of the frequencies.

    Parameters
    ----------
    plate : Plate
        The plate.
    touched : Problem
        The problem with the contact at the place of the force.
    names : sequence of str
        Names of the S sensors.
    rate : float
        Samples per second [Hz].
    times, impulses : array, shape (n,)
        When the force acts, after the first sample [s], and its impulses [N s].
    samples : int
        Number of samples of a record.
    """
    sensors = len(names)

    def signals(responses: Floats) -> Floats:
        return sampled_responses(responses, rate, times, impulses, samples)

    residual = compliances_of(touched, names)[:, None] * plate.heard(names).residual
    # the error of a sensor's static response moves its record alone
    of_residuals = plate.model_error * np.eye(sensors)[:, :, None] * signals(residual)

    shapes = shapes_of(touched)
    modes = len(shapes)
    detuned = (plate.frequency_errors * shapes)[:, None, None] * plate.detuned(names)
    of_frequencies = signals(detuned.reshape(modes * sensors, -1))
    return np.concatenate([of_residuals, of_frequencies.reshape(modes, sensors, samples)])
