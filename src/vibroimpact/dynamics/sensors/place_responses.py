r"""Responses of sensors to a force at any place of the plate.

A sensor's response to an impulse of force is linear in the mode shapes :math:`\varphi_i` at the
place of the force and in the residual
compliance C between the place and the sensor. With the responses to each of these numbers alone,
one table serves all places:

.. math:: k(t; x) = \sum_i \varphi_i(x)\,k_i(t) + C(x)\,k_C(t)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.antialias import FINENESS, HALF_LENGTH, antialias_of
from vibroimpact.dynamics.sensors.filtered_chain import add_responses, filtered_chain
from vibroimpact.dynamics.sensors.instruments.microphone import Microphone
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain, measuring_chain
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.dynamics.vibrating.vibrating_bodies import bases_of_plate
from vibroimpact.errors import InputError

_ROWS = 256
"""Points of a table that are computed at once."""


@dataclass(frozen=True)
class PlaceResponses:
    """Responses of sensors with a common rate to unit impulses of force, for any place of the
    force.

    Parameters
    ----------
    rate : float
        Samples per second [Hz].
    values : array, shape (modes, S, points)
        Response to an impulse at a place where one mode alone moves, at `FINENESS` points per
        sample from `HALF_LENGTH` samples before the impulse on.
    residual : array, shape (S, points)
        The same for a unit of residual compliance.
    """

    rate: float
    values: Floats
    residual: Floats

    def at(self, shapes: Floats, compliance: Floats) -> Floats:
        """Return the responses at a place, (S, points), from its mode shapes (modes,) and
        residual compliances to the sensors (S,).
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
    """Return what each rigid motion and mode of the plate of a problem does at sensors,
    (modes, S).
    """
    bases = bases_of_plate(problem)
    return np.stack(
        [
            np.concatenate([one.points[of.name] for one in bases]) @ np.asarray(of.components)
            for of in sensors
        ],
        axis=1,
    )


def place_responses(problem: Problem, sensors: Sequence[Sensor], duration: float) -> PlaceResponses:
    """Return the responses of sensors to a force at any place of the plate of a problem.

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
    found = unit_responses(problem, sensors, duration)
    return replace(found, values=sensor_shapes(problem, sensors)[:, :, None] * found.values)


def unit_responses(problem: Problem, sensors: Sequence[Sensor], duration: float) -> PlaceResponses:
    """Return the responses of sensors at which each mode of the plate of a problem is one: those of
    `sensor_shapes` are their multiples.

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
    each = [
        _responses(problem, sensor, duration, np.eye(modes + 1), np.ones(modes))
        for sensor in sensors
    ]
    points = min(one.shape[1] for one in each)  # those of a converter's filter are a few longer
    found = np.stack([one[:, :points] for one in each], axis=1)
    return PlaceResponses(sensors[0].rate, found[:-1], found[-1])


def responses_at(
    problem: Problem, sensors: Sequence[Sensor], duration: float, shapes: Floats, compliance: Floats
) -> Floats:
    """Return the responses of sensors to a unit impulse of force at one place, (S, points), as
    `PlaceResponses.at`, in less memory.

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
    seen = sensor_shapes(problem, sensors).T
    ports = [np.append(shapes, c)[None] for c in compliance]
    each = [
        _responses(problem, one, duration, port, at)[0]
        for one, port, at in zip(sensors, ports, seen, strict=True)
    ]
    points = min(len(one) for one in each)
    return np.stack([one[:points] for one in each])


def _check(sensors: Sequence[Sensor]) -> None:
    """Raise InputError unless sensors have one rate, and hear the plate where they are
    through a filter.
    """
    if not sensors:
        raise InputError("there is no sensor; give one or more", "sensors")
    if len({sensor.rate for sensor in sensors}) > 1:
        raise InputError("the sensors have different rates; take sensors of one rate", "sensors")
    for sensor in sensors:
        if isinstance(sensor.instrument, Microphone):
            raise InputError(
                f'sensor "{sensor.name}": a microphone measures the sound of the whole '
                "plate; use sensors on it",
                "sensors",
            )
        if sensor.filter == "none":
            words = (
                "without an anti-alias filter frequencies above half the rate "
                "are aliased into the band"
            )
            raise InputError(
                f'sensor "{sensor.name}": {words}; give it the filter "sigma-delta" or '
                '"butterworth"',
                "sensors",
            )


def _responses(
    problem: Problem, sensor: Sensor, duration: float, ports: Floats, shapes: Floats
) -> Floats:
    """Return the responses of a sensor, at which the modes are `shapes`, to unit impulses, (P,
    points).

    A port has a weight for each mode, and one of the compliance.
    """
    bases = bases_of_plate(problem)
    frequencies, ratios = (
        np.concatenate(part)
        for part in zip(
            *((basis.angular_frequencies, basis.damping_ratios) for basis in bases), strict=True
        )
    )
    number = len(frequencies)
    plate = Oscillators(frequencies, ratios, ports[:, :number])
    antialias = antialias_of(sensor)
    chain = measuring_chain(
        plate,
        shapes[None],
        ports[:, number:],
        [sensor.order],
        (*sensor.sections, *antialias.sections),
    )
    gain = (sensor.instrument.gain if sensor.instrument else 1.0) * (
        sensor.amplifier.gain if sensor.amplifier else 1.0
    )
    if antialias.half_length:
        return -gain * filtered_chain(chain, sensor.rate, duration).answers[:, 0]
    return -gain * _at_instants(chain, sensor.rate, duration)


def _at_instants(chain: MeasuringChain, rate: float, duration: float) -> Floats:
    """Return the responses of a chain without a converter's filter to impulses of minus
    the force, (P, points), as a filtered one's.
    """
    oscillators, lead = chain.oscillators, HALF_LENGTH * FINENESS
    times = np.arange(math.ceil(duration * rate * FINENESS) + lead) / (rate * FINENESS)
    found = np.zeros((len(oscillators.shape), lead + len(times)))
    for begin in range(0, len(times), _ROWS):
        cosine, sine = oscillators.propagators(times[begin : begin + _ROWS])
        seen = chain.outputs[0, 0] * sine + chain.outputs[1, 0] * (
            cosine - oscillators.damping * sine
        )
        found[:, lead + begin : lead + begin + len(seen)] = oscillators.shape @ seen.T
    return found
