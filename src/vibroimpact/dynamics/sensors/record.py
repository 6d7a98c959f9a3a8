"""Signals of sensors on the plate: the motion of points through the instruments, as samples."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS, antialias_of, gain_at
from vibroimpact.dynamics.sensors.filtered_chain import filtered_chain
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.electronics import amplified, seeds
from vibroimpact.dynamics.sensors.instruments.instrument import SUBJECTS_AT_REST
from vibroimpact.dynamics.sensors.instruments.pole_pairs import Section
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor, sample_count
from vibroimpact.dynamics.sensors.measuring_chain import (
    MeasuringChain,
    measuring_chain,
    next_octave,
)
from vibroimpact.dynamics.sensors.overload import (
    RINGING,
    Overload,
    clipped_part,
    finer_rate,
    overload_of,
)
from vibroimpact.dynamics.sensors.ports import Ports, ports_of
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.dynamics.sensors.sampled import (
    around_first_contact,
    first_motion,
    outputs_around_first_contact,
    response_length,
    sample_at_instants,
    sample_filtered,
    sample_filtered_chain,
)
from vibroimpact.dynamics.sensors.sound import heard
from vibroimpact.dynamics.sensors.steady_outputs import steady_outputs
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import bases_of_plate
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices

MOST_SAMPLES = 100_000_000
"""Largest number of samples of all sensors, or by which the clipping of one is followed.

More do not fit into memory.
"""
_NO_COMPLIANCE = np.zeros(3)
_WIDER = 8
"""Multiple of the rate for samples without a filter: their frequencies reach up to half of it."""


def record(
    problem: Problem, segments: Sequence[VibratingSegment], sensors: Sequence[Sensor], end: float
) -> dict[str, Signal]:
    """Return the signals of sensors over a run, by their names.

    The chain is that of an instrument: the motion of the modes kept and the quasi-static response
    of those left out, and the steady motion of a plate on supports that move; the instrument; its
    range; the anti-alias filter; sampling with noise and resolution; amplifier and converter. All
    linear parts are computed in closed form, at the samples only.

    Parameters
    ----------
    problem : Problem
        The problem.
    segments : sequence of VibratingSegment
        The history of one drop.
    sensors : sequence of Sensor
        The sensors.
    end : float
        End of the run [s].

    Raises
    ------
    InputError
        If the plate neither vibrates nor moves, has no such point, or there would be too many
        samples.
    """
    _check(problem, sensors, end)
    ports = ports_of(segments)
    groups: dict[tuple[float, str, float | None, tuple[Section, ...]], list[Sensor]] = {}
    signals: dict[str, Signal] = {}
    for sensor in sensors:
        if sensor.subject == "sound":
            plate = _plate(problem, ports)
            count = sample_count(end, sensor.rate)
            value, uncertainty = heard(problem, plate, ports, segments, sensor, count)
            signals[sensor.name] = Signal(sensor, _digitised(sensor, value), uncertainty)
        else:
            # sensors with the same linear chain are computed together
            linear_chain = (sensor.rate, sensor.filter, sensor.corner, sensor.sections)
            groups.setdefault(linear_chain, []).append(sensor)
    for group in groups.values():
        signals |= _recorded(problem, ports, segments, group, end)
    return {sensor.name: signals[sensor.name] for sensor in sensors}


def _check(problem: Problem, sensors: Sequence[Sensor], end: float) -> None:
    """Raise InputError if sensors can not record, or there would be too many samples.

    They can not if the plate is rigid and at rest, or lacks a point.
    """
    modes = problem.plate.modes
    if modes is None and problem.motion is None:
        raise InputError(
            "the plate has neither modes nor supports that move: its sensors record "
            "nothing; give it modes",
            "sensors",
        )
    for sensor in sensors:
        if sensor.subject in SUBJECTS_AT_REST and problem.motion is not None:
            raise InputError(
                "microphones and force sensors are for plates whose supports are at rest; leave "
                "out the sensor, or the motion",
                "sensors",
            )
        _check_point(modes, sensor)
        limited = _limited(sensor)
        rate = sensor.rate
        if limited is not None:
            rate = finer_rate(sensor.rate, limited.resonance)
        if rate == sensor.rate:
            count = sum(sample_count(end, each.rate) for each in sensors)
            subject = "of all sensors"
            remedy = "ask for a lower rate or a shorter run"
        else:
            count = sample_count(end, rate)
            subject = f'by which the clipping of the sensor "{sensor.name}" is followed'
            remedy = "ask for a shorter run, or leave out its range or its resonance"
        if count > MOST_SAMPLES:
            raise InputError(
                f"{count:.3g} samples, {subject}, are more than {MOST_SAMPLES:.0e}; {remedy}",
                "sensors",
            )


def _check_point(modes: ModalBasis | None, sensor: Sensor) -> None:
    """Raise InputError if the modes of the plate do not know the position of a sensor.

    Neither may they tell the delays of sound to a microphone too coarsely.
    """
    if modes is None:
        return
    if sensor.subject != "sound":
        if sensor.name not in modes.points:
            raise InputError(f'the modes of the plate have no point "{sensor.name}"', "sensors")
        return
    if sensor.name not in modes.sounds:
        raise InputError(
            f'the modes of the plate have no paths of sound to a microphone "{sensor.name}"',
            "sensors",
        )
    highest = 1.0 / (FINENESS * modes.sounds[sensor.name].step)
    if sensor.rate > 1.000001 * highest:
        raise InputError(
            f'the paths of sound to the microphone "{sensor.name}" are valid for {highest:g} '
            f"samples per second at most; ask for a lower rate than {sensor.rate:g} Hz",
            "sensors",
        )


def _plate(problem: Problem, ports: Ports) -> Oscillators:
    """Return the rigid motions and modes of the plate as oscillators, driven at ports."""
    bases = bases_of_plate(problem)
    return Oscillators(
        np.concatenate([basis.angular_frequencies for basis in bases]),
        np.concatenate([basis.damping_ratios for basis in bases]),
        ports.shapes,
    )


def _limited(sensor: Sensor) -> Accelerometer | None:
    """Return the accelerometer of a sensor if it has a range."""
    instrument = sensor.instrument
    if isinstance(instrument, Accelerometer) and instrument.range is not None:
        return instrument
    return None


def _recorded(
    problem: Problem,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    sensors: Sequence[Sensor],
    end: float,
) -> dict[str, Signal]:
    """Return the signals of sensors with the same rate, filter and poles of their instruments."""
    rate = sensors[0].rate
    count = sample_count(end, rate)
    antialias = antialias_of(sensors[0])
    values = np.zeros((len(sensors), count))
    uncertainties = np.zeros(len(sensors))
    if problem.plate.modes is not None:
        values, uncertainties = _excited(problem, ports, segments, sensors, count)
    if problem.motion is not None:
        values += steady_outputs(
            problem.motion,
            problem.plate.modes,
            sensors,
            (*sensors[0].sections, *antialias.sections),
            rate,
            range(count),
            bool(antialias.half_length),
        )
    # a filter still holds what was cut off before the run
    samples_before = 0 if problem.motion is None else RINGING
    signals = {}
    for number, sensor in enumerate(sensors):
        value = values[number]
        uncertainty = float(uncertainties[number])
        limited = _limited(sensor)
        if limited is None:
            signals[sensor.name] = Signal(sensor, _digitised(sensor, value), uncertainty)
            continue
        assert limited.range is not None
        overload = _overload(problem, ports, segments, sensor, samples_before, end)
        if sensor.filter == "none":
            value = np.clip(value, -limited.range, limited.range)
        else:
            value = value - clipped_part(overload, antialias, rate, count)
        signals[sensor.name] = Signal(
            sensor, _digitised(sensor, value), uncertainty, overload.peak, overload.time
        )
    return signals


def _excited(
    problem: Problem,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    sensors: Sequence[Sensor],
    count: int,
) -> tuple[Floats, Floats]:
    """Return samples of the vibration that impacts excite (S, count), and their uncertainties.

    These are how far the modes left out may change each signal (S,).
    """
    rate = sensors[0].rate
    sections = sensors[0].sections
    antialias = antialias_of(sensors[0])
    around = around_first_contact(segments, rate)
    unfiltered = _chain(problem, ports, sensors, sections)
    # a converter's filter is applied in closed form; an analogue one is a part of the chain,
    # sampled at instants
    if antialias.half_length:
        kept = filtered_chain(unfiltered, rate, response_length(segments, rate, around))
        values = sample_filtered(kept, ports, segments, range(count))
    else:
        chain = _chain(problem, ports, sensors, (*sections, *antialias.sections))
        values = sample_at_instants(chain, ports, rate, segments, count)
        rate *= 1 if antialias.sections else _WIDER
        kept = filtered_chain(unfiltered, rate, response_length(segments, rate, around))
    # the error by the modes left out, from a model of the next octave
    steeper = 2.0 ** np.array([[sensor.steepness] for sensor in sensors])
    left_out = filtered_chain(
        _next_octave_chain(unfiltered, steeper, sections),
        rate,
        response_length(segments, rate, around),
    )
    outputs = outputs_around_first_contact(kept, ports, segments, around)
    norms = np.linalg.norm(outputs, axis=1)
    outputs_left_out = outputs_around_first_contact(left_out, ports, segments, around)
    norms_left_out = np.linalg.norm(outputs_left_out, axis=1)
    return values, norms_left_out / np.where(norms > 0.0, norms, np.inf)


def _overload(
    problem: Problem,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    sensor: Sensor,
    samples_before: int,
    end: float,
) -> Overload:
    """Return what of the signal of a sensor lies beyond its range.

    `samples_before`: number of its samples before the run from which on it counts.
    """
    limited = _limited(sensor)
    assert limited is not None
    assert limited.range is not None
    rate = finer_rate(sensor.rate, limited.resonance)
    oversampling = round(rate / sensor.rate)
    reach = antialias_of(sensor).half_length / sensor.rate  # of the filter beyond the end
    if problem.motion is None:
        first = first_motion(segments, rate) // oversampling
    else:
        first = -samples_before
    samples = range(first * oversampling, sample_count(end + reach, rate))
    value = np.zeros(len(samples))
    level = limited.range  # of the vibration that the range leaves
    if problem.motion is not None:
        value += steady_outputs(
            problem.motion, problem.plate.modes, [sensor], sensor.sections, rate, samples, True
        )[0]
        level = max(limited.range - float(np.abs(value).max()), 0.0)
    if problem.plate.modes is not None:
        chain = _chain(problem, ports, [sensor], sensor.sections)
        in_run = range(max(samples.start, 0), samples.stop)
        value[-len(in_run) :] += sample_filtered_chain(
            chain, ports, rate, segments, in_run, np.array([level])
        )[0]
    return overload_of(value, rate, samples.start, end, limited.range)


def _chain(
    problem: Problem, ports: Ports, sensors: Sequence[Sensor], sections: Sequence[Section]
) -> MeasuringChain:
    """Return the chain from the contact forces to sensors, through pairs of poles."""
    bases = bases_of_plate(problem)
    directions = [np.asarray(sensor.components) for sensor in sensors]
    shapes = np.stack(
        [
            np.concatenate([basis.points[sensor.name] for basis in bases]) @ direction
            for sensor, direction in zip(sensors, directions, strict=True)
        ]
    )
    compliance = np.array(
        [
            [
                residuals.get(sensor.name, _NO_COMPLIANCE) @ direction
                for sensor, direction in zip(sensors, directions, strict=True)
            ]
            for residuals in ports.residuals
        ]
    )
    orders = [sensor.order for sensor in sensors]
    return measuring_chain(_plate(problem, ports), shapes, compliance, orders, sections)


def _next_octave_chain(
    chain: MeasuringChain, steeper: Floats, poles: Sequence[Section]
) -> MeasuringChain:
    """Return the chain of the modes left out of the next octave, as an estimate.

    It is that beyond their quasi-static response.
    """
    modes, shapes = next_octave(chain.plate, steeper * chain.shapes)
    static = -(shapes * modes.shape[:, None] / modes.angular_frequency**2).sum(axis=2)
    return measuring_chain(modes, shapes, static, chain.orders, poles)


def _digitised(sensor: Sensor, value: Floats) -> Floats:
    """Return samples with noise, resolution, gain, amplifier and converter.

    Noise and resolution are those of an accelerometer.
    """
    instrument = sensor.instrument
    if isinstance(instrument, Accelerometer):
        if instrument.noise:
            seed = [zlib.crc32(sensor.name.encode()), *seeds(instrument.seed)]
            noise = np.random.default_rng(seed).standard_normal(len(value))
            value = value + instrument.noise * noise
        if instrument.resolution is not None:
            value = instrument.resolution * np.round(value / instrument.resolution)
    if instrument is not None:
        value = instrument.gain * value
    amplifier = sensor.amplifier
    if amplifier is not None:
        passed = gain_at(sensor, amplifier.mains)
        value = amplified(amplifier, sensor.name, value, sensor.rate, passed)
    if sensor.converter is None:
        return value
    return sensor.converter.read(value)
