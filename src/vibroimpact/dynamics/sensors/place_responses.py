r"""Responses of sensors to a force at any position on the plate.

A sensor's response to an impulse of force is linear in the mode shapes :math:`\varphi_i` at the
position of the force and in the residual compliance C between it and the sensor. With the responses
to each of these numbers alone, one table serves all positions:

.. math:: k(t; x) = \sum_i \varphi_i(x)\,k_i(t) + C(x)\,k_C(t)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS, HALF_LENGTH, antialias_of
from vibroimpact.dynamics.sensors.filtered_chain import add_responses, filtered_chain
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain, measuring_chain
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import bases_of_plate
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.errors import InputError

_ROWS = 256
"""Points of a table that are computed at once."""


@dataclass(frozen=True)
class PlaceResponses:
    """Responses of sensors of one rate to unit impulses of force, at any position of the force.

    Parameters
    ----------
    rate : float
        Samples per second [Hz].
    values : array, shape (modes, S, points)
        Response to an impulse where one mode alone moves, at `FINENESS` points per sample from
        `HALF_LENGTH` samples before the impulse on.
    residual : array, shape (S, points)
        The same for a unit of residual compliance.
    """

    rate: float
    values: Floats
    residual: Floats

    def at(self, shapes: Floats, compliance: Floats) -> Floats:
        """Return the responses at a position, (S, points).

        It has mode shapes (modes,) and residual compliances to the sensors (S,).
        """
        return np.asarray(
            np.tensordot(shapes, self.values, 1) + compliance[:, None] * self.residual
        )


def sampled_responses(
    answers: Floats, rate: float, times: Floats, impulses: Floats, count: int
) -> Floats:
    """Return samples of the responses to impulses.

    Parameters
    ----------
    answers : array, shape (S, points)
        Responses to a unit impulse, as of `PlaceResponses.at`.
    rate : float
        Samples per second [Hz].
    times, impulses : array, shape (n,)
        When the force acts, after the first sample [s], and its impulses [N s].
    count : int
        Number of samples.

    Returns
    -------
    array, shape (S, count)
        The samples.
    """
    values = np.zeros((len(answers), count))
    add_responses(values, answers, rate, times, impulses, count)
    return values


def sensor_shapes(problem: Problem, sensors: Sequence[Sensor]) -> Floats:
    """Return how each rigid motion and mode of the plate moves sensors, (modes, S)."""
    bases = bases_of_plate(problem)
    shapes = []
    for sensor in sensors:
        points = np.concatenate([basis.points[sensor.name] for basis in bases])
        shapes.append(points @ np.asarray(sensor.components))
    return np.stack(shapes, axis=1)


def place_responses(problem: Problem, sensors: Sequence[Sensor], duration: float) -> PlaceResponses:
    """Return the responses of sensors to a force at any position on the plate of a problem.

    Parameters
    ----------
    problem : Problem
        The problem, with a plate that vibrates.
    sensors : sequence of Sensor
        The sensors, of one rate.
    duration : float
        Length of the responses after the impulse [s].

    Raises
    ------
    InputError
        If the rates differ, or a sensor is a microphone or has no anti-alias filter.
    """
    unit = unit_responses(problem, sensors, duration)
    return replace(unit, values=sensor_shapes(problem, sensors)[:, :, None] * unit.values)


def unit_responses(problem: Problem, sensors: Sequence[Sensor], duration: float) -> PlaceResponses:
    """Return the responses of sensors at which each mode of the plate of a problem is one.

    Those of `sensor_shapes` are their multiples.

    Parameters
    ----------
    problem, sensors, duration
        As those of `place_responses`.

    Raises
    ------
    InputError
        As `place_responses`.
    """
    _check(sensors)
    # a port for each number that the response is linear in: it alone is one
    modes = len(np.concatenate([basis.frequencies for basis in bases_of_plate(problem)]))
    responses = [
        _responses(problem, sensor, duration, np.eye(modes + 1), np.ones(modes))
        for sensor in sensors
    ]
    # those of a converter's filter are a few points longer
    points = min(response.shape[1] for response in responses)
    table = np.stack([response[:, :points] for response in responses], axis=1)
    return PlaceResponses(sensors[0].rate, table[:-1], table[-1])


def responses_at(
    problem: Problem, sensors: Sequence[Sensor], duration: float, shapes: Floats, compliance: Floats
) -> Floats:
    """Return the responses of sensors to a unit impulse of force at one position, (S, points).

    They are those of `PlaceResponses.at`, in less memory.

    Parameters
    ----------
    problem, sensors, duration
        As those of `place_responses`.
    shapes, compliance : array, shape (modes,) and (S,)
        As those of `PlaceResponses.at`.

    Raises
    ------
    InputError
        As `place_responses`.
    """
    _check(sensors)
    shapes_at_sensors = sensor_shapes(problem, sensors).T
    responses = []
    for number, sensor in enumerate(sensors):
        port = np.append(shapes, compliance[number])[None]
        responses.append(_responses(problem, sensor, duration, port, shapes_at_sensors[number])[0])
    points = min(len(response) for response in responses)
    return np.stack([response[:points] for response in responses])


def _check(sensors: Sequence[Sensor]) -> None:
    """Raise InputError unless sensors have one rate and a filter, and are on the plate."""
    if not sensors:
        raise InputError("there is no sensor; give one or more", "sensors")
    if len({sensor.rate for sensor in sensors}) > 1:
        raise InputError("the sensors have different rates; take sensors of one rate", "sensors")
    for sensor in sensors:
        if sensor.subject == "sound":
            raise InputError(
                f'sensor "{sensor.name}": a microphone measures the sound of the whole '
                "plate; use sensors on it",
                "sensors",
            )
        if sensor.filter == "none":
            raise InputError(
                f'sensor "{sensor.name}": without an anti-alias filter frequencies above half '
                "the rate are aliased into the band; give it the filter "
                '"sigma-delta" or "butterworth"',
                "sensors",
            )


def _responses(
    problem: Problem, sensor: Sensor, duration: float, ports: Floats, shapes: Floats
) -> Floats:
    """Return the responses of a sensor to unit impulses, (P, points).

    `ports`: a row for each, with a weight for each mode, and one of the compliance. `shapes`: those
    of the modes at the sensor.
    """
    bases = bases_of_plate(problem)
    frequencies = np.concatenate([basis.angular_frequencies for basis in bases])
    ratios = np.concatenate([basis.damping_ratios for basis in bases])
    modes = len(frequencies)
    antialias = antialias_of(sensor)
    chain = measuring_chain(
        Oscillators(frequencies, ratios, ports[:, :modes]),
        shapes[None],
        ports[:, modes:],
        [sensor.order],
        (*sensor.sections, *antialias.sections),
    )
    gain = 1.0
    if sensor.instrument:
        gain = sensor.instrument.gain
    if sensor.amplifier:
        gain *= sensor.amplifier.gain
    if antialias.half_length:
        return -gain * filtered_chain(chain, sensor.rate, duration).answers[:, 0]
    return -gain * _at_instants(chain, sensor.rate, duration)


def _at_instants(chain: MeasuringChain, rate: float, duration: float) -> Floats:
    """Return the responses of a chain to impulses of minus the force, (P, points).

    The chain has no converter's filter; the points are those of one that has.
    """
    oscillators = chain.oscillators
    lead = HALF_LENGTH * FINENESS
    times = np.arange(math.ceil(duration * rate * FINENESS) + lead) / (rate * FINENESS)
    responses = np.zeros((len(oscillators.shape), lead + len(times)))
    displacement_weights, velocity_weights = chain.outputs[:, 0]
    for begin in range(0, len(times), _ROWS):
        cosine, sine = oscillators.propagators(times[begin : begin + _ROWS])
        # to a unit initial velocity
        output = displacement_weights * sine + velocity_weights * (
            cosine - oscillators.damping * sine
        )
        first = lead + begin
        responses[:, first : first + len(output)] = oscillators.shape @ output.T
    return responses
