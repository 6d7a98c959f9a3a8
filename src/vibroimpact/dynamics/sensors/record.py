"""Signals of sensors on the plate: the motion of points through the instruments, as samples."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.antialias import FINENESS, antialias_of, gain_at
from vibroimpact.dynamics.sensors.electronics import amplified, seeds
from vibroimpact.dynamics.sensors.filtered_chain import filtered_chain
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.force_sensor import ForceSensor
from vibroimpact.dynamics.sensors.instruments.microphone import Microphone
from vibroimpact.dynamics.sensors.left_out import next_octave
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain, measuring_chain
from vibroimpact.dynamics.sensors.overload import (
    RINGING,
    Overload,
    clipped_part,
    finer_rate,
    overload,
)
from vibroimpact.dynamics.sensors.pole_pairs import Section
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
from vibroimpact.dynamics.sensors.sensor import Sensor, sample_count
from vibroimpact.dynamics.sensors.sound import heard
from vibroimpact.dynamics.sensors.steady_outputs import steady_outputs
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.dynamics.vibrating.vibrating_bodies import bases_of_plate
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices

MOST_SAMPLES = 100_000_000
"""Largest number of samples of all sensors, or by which the clipping of one is followed;
more do not fit into memory.
"""
_NONE = np.zeros(3)
_WIDER = 8
"""Multiple of the rate: samples without a filter are taken to contain frequencies up to
half of it.
"""


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
        if isinstance(sensor.instrument, Microphone):
            value, uncertainty = heard(
                problem,
                _plate(problem, ports),
                ports,
                segments,
                sensor,
                sample_count(end, sensor.rate),
            )
            signals[sensor.name] = Signal(sensor, _digitised(sensor, value), uncertainty)
        else:
            groups.setdefault(
                (sensor.rate, sensor.filter, sensor.corner, sensor.sections), []
            ).append(sensor)
    for group in groups.values():
        signals |= _recorded(problem, ports, segments, group, end)
    return {sensor.name: signals[sensor.name] for sensor in sensors}


def _check(problem: Problem, sensors: Sequence[Sensor], end: float) -> None:
    """Raise InputError if the plate is rigid and at rest, lacks a point, or there would
    be too many samples.
    """
    modes = problem.plate.modes
    if modes is None and problem.motion is None:
        raise InputError(
            "the plate has neither modes nor supports that move: its sensors record "
            "nothing; give it modes",
            "sensors",
        )
    for sensor in sensors:
        if isinstance(sensor.instrument, (ForceSensor, Microphone)) and problem.motion is not None:
            words = (
                "microphones and force sensors are for plates whose supports are at rest; leave "
                "out the sensor, or the motion"
            )
            raise InputError(words, "sensors")
        _check_place(modes, sensor)
        meter = _limited(sensor)
        rate = sensor.rate if meter is None else finer_rate(sensor.rate, meter.resonance)
        count = (
            sum(sample_count(end, one.rate) for one in sensors)
            if rate == sensor.rate
            else sample_count(end, rate)
        )
        if count > MOST_SAMPLES:
            whose, remedy = "of all sensors", "ask for a lower rate or a shorter run"
            if rate != sensor.rate:
                whose = f'by which the clipping of the sensor "{sensor.name}" is followed'
                remedy = "ask for a shorter run, or leave out its range or its resonance"
            raise InputError(
                f"{count:.3g} samples, {whose}, are more than {MOST_SAMPLES:.0e}; {remedy}",
                "sensors",
            )


def _check_place(modes: ModalBasis | None, sensor: Sensor) -> None:
    """Raise InputError if the modes of the plate do not know where a sensor is, or do not
    tell the delays of sound finely enough.
    """
    if modes is None:
        return
    if not isinstance(sensor.instrument, Microphone):
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
        words = (
            f'the paths of sound to the microphone "{sensor.name}" are valid for {highest:g} '
            "samples per second at most"
        )
        raise InputError(f"{words}; ask for a lower rate than {sensor.rate:g} Hz", "sensors")


def _plate(problem: Problem, ports: Ports) -> Oscillators:
    """Return the rigid motions and modes of the plate as oscillators, driven at ports."""
    parts = ((basis.angular_frequencies, basis.damping_ratios) for basis in bases_of_plate(problem))
    frequencies, ratios = (np.concatenate(part) for part in zip(*parts, strict=True))
    return Oscillators(frequencies, ratios, ports.shapes)


def _limited(sensor: Sensor) -> Accelerometer | None:
    """Return the accelerometer of a sensor if it has a range."""
    meter = sensor.instrument
    return meter if isinstance(meter, Accelerometer) and meter.range is not None else None


def _recorded(
    problem: Problem,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    group: Sequence[Sensor],
    end: float,
) -> dict[str, Signal]:
    """Return the signals of sensors with the same rate, filter and poles of their instruments."""
    sensor, motion, count = group[0], problem.motion, sample_count(end, group[0].rate)
    antialias, poles = antialias_of(sensor), (*sensor.sections, *antialias_of(sensor).sections)
    values, uncertainties = np.zeros((len(group), count)), np.zeros(len(group))
    if problem.plate.modes is not None:
        values, uncertainties = _excited(problem, ports, segments, group, count)
    if motion is not None:
        values += steady_outputs(
            motion,
            problem.plate.modes,
            group,
            poles,
            sensor.rate,
            range(count),
            bool(antialias.half_length),
        )
    # a filter still holds what was cut off before the run
    before = 0 if motion is None else RINGING
    signals = {}
    for number, one in enumerate(group):
        value, meter, facts = (
            values[number],
            _limited(one),
            {"uncertainty": float(uncertainties[number])},
        )
        if meter is not None and meter.range is not None:
            found = _overload(problem, ports, segments, one, before, end)
            if one.filter == "none":
                value = np.clip(value, -meter.range, meter.range)
            else:
                value = value - clipped_part(found, antialias, one.rate, count)
            facts |= {"peak": found.peak, "overload_time": found.time}
        signals[one.name] = Signal(one, _digitised(one, value), **facts)
    return signals


def _excited(
    problem: Problem,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    group: Sequence[Sensor],
    count: int,
) -> tuple[Floats, Floats]:
    """Return samples of the vibration that impacts excite (S, count), and how far the
    modes left out may change each (S,).
    """
    sensor, bare = group[0], _chain(problem, ports, group, group[0].sections)
    antialias, rate, around = (
        antialias_of(sensor),
        sensor.rate,
        around_first_contact(segments, sensor.rate),
    )
    # a converter's filter is applied in closed form; an analogue one is a part of the chain,
    # sampled at instants
    if antialias.half_length:
        known = filtered_chain(bare, rate, response_length(segments, rate, around))
        values = sample_filtered(known, ports, segments, range(count))
    else:
        chain = _chain(problem, ports, group, (*sensor.sections, *antialias.sections))
        values = sample_at_instants(chain, ports, rate, segments, count)
        rate *= 1 if antialias.sections else _WIDER
        known = filtered_chain(bare, rate, response_length(segments, rate, around))
    # the error by the modes left out, from a model of the next octave
    steeper = 2.0 ** np.array([[one.steepness] for one in group])
    left_out = filtered_chain(
        _next_octave_chain(bare, steeper, sensor.sections),
        rate,
        response_length(segments, rate, around),
    )
    norm, left_out_norm = (
        np.linalg.norm(outputs_around_first_contact(one, ports, segments, around), axis=1)
        for one in (known, left_out)
    )
    return values, left_out_norm / np.where(norm > 0.0, norm, np.inf)


def _overload(
    problem: Problem,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    sensor: Sensor,
    before: int,
    end: float,
) -> Overload:
    """Return what of the signal of a sensor lies beyond its range, from so many of its
    samples before the run on.
    """
    meter, ahead = _limited(sensor), antialias_of(sensor).half_length / sensor.rate
    assert meter is not None
    assert meter.range is not None
    rate = finer_rate(sensor.rate, meter.resonance)
    finer, level = round(rate / sensor.rate), meter.range
    first = first_motion(segments, rate) // finer if problem.motion is None else -before
    samples = range(first * finer, sample_count(end + ahead, rate))
    value = np.zeros(len(samples))
    if problem.motion is not None:
        value += steady_outputs(
            problem.motion, problem.plate.modes, [sensor], sensor.sections, rate, samples, True
        )[0]
        level = max(meter.range - float(np.abs(value).max()), 0.0)
    if problem.plate.modes is not None:
        alone, moved = (
            _chain(problem, ports, [sensor], sensor.sections),
            range(max(samples.start, 0), samples.stop),
        )
        value[-len(moved) :] += sample_filtered_chain(
            alone, ports, rate, segments, moved, np.array([level])
        )[0]
    return overload(value, rate, samples.start, end, meter.range)


def _chain(
    problem: Problem, ports: Ports, group: Sequence[Sensor], sections: Sequence[Section]
) -> MeasuringChain:
    """Return the chain from the contact forces to sensors, through pairs of poles."""
    bases = bases_of_plate(problem)
    shapes = np.stack(
        [
            np.concatenate([basis.points[one.name] for basis in bases]) @ np.asarray(one.components)
            for one in group
        ]
    )
    compliance = np.array(
        [
            [part.get(one.name, _NONE) @ np.asarray(one.components) for one in group]
            for part in ports.residuals
        ]
    )
    return measuring_chain(
        _plate(problem, ports), shapes, compliance, [one.order for one in group], sections
    )


def _next_octave_chain(
    chain: MeasuringChain, steeper: Floats, poles: Sequence[Section]
) -> MeasuringChain:
    """Return the chain of the modes left out of the next octave, beyond their
    quasi-static response, as an estimate.
    """
    above, shapes_above = next_octave(chain.plate, steeper * chain.shapes)
    static = -(shapes_above * above.shape[:, None] / above.angular_frequency**2).sum(axis=2)
    return measuring_chain(above, shapes_above, static, chain.orders, poles)


def _digitised(sensor: Sensor, value: Floats) -> Floats:
    """Return samples with what is not linear: noise and resolution of an accelerometer;
    and with gain, amplifier and converter.
    """
    meter, amplifier = sensor.instrument, sensor.amplifier
    if isinstance(meter, Accelerometer):
        if meter.noise:
            seed = [zlib.crc32(sensor.name.encode()), *seeds(meter.seed)]
            value = value + meter.noise * np.random.default_rng(seed).standard_normal(len(value))
        value = (
            value
            if meter.resolution is None
            else meter.resolution * np.round(value / meter.resolution)
        )
    if meter is not None:
        value = meter.gain * value
    if amplifier is not None:
        value = amplified(
            amplifier, sensor.name, value, sensor.rate, gain_at(sensor, amplifier.mains)
        )
    return value if sensor.converter is None else sensor.converter.read(value)
