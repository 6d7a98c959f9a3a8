"""What sensors on the plate record: the exact motion of their points, as an accelerometer there would read it."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vibroimpact.contact.phase.collocation import Floats
from vibroimpact.contact.phase.oscillators import FreeMotion, Oscillators
from vibroimpact.contact.phase.vibrating_stretch import VibratingStretch
from vibroimpact.dynamics.lying import Lying
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensor import Sensor, sample_count
from vibroimpact.dynamics.vibration import oscillators_of
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating_segment import VibratingSegment

_BLOCK, _ROWS = 512, 128
"""Samples for which propagators are kept, the next block starting from where the last one ended; and blocks done at once, at most."""
_NEGLIGIBLE = 1e-20
"""Of the fastest mode: what moves less is left out."""
_PER_PERIOD = 20.0
"""Samples a period of an accelerometer's resonance, at least, where its own motion is followed."""
MOST_SAMPLES = 100_000_000
"""Of one sensor; more do not fit into memory."""


@dataclass(frozen=True)
class Signal:
    """What a sensor recorded.

    `time` [s] and `value` (samples,). `left_out`: how many modes lie at or above half the rate and are left out.
    """

    sensor: Sensor
    time: Floats
    value: Floats
    left_out: int


def record(problem: Problem, segments: Sequence[VibratingSegment], sensors: Sequence[Sensor], end: float) -> dict[str, Signal]:
    """Return the signals of sensors over a run, by their names.

    The samples are exact values of the modal solution. A mode at or above half the sampling rate is left out, as an ideal
    anti-alias filter would; what is left of the contact's own spectrum above that is not filtered.

    Parameters
    ----------
    problem : Problem
        What was simulated.
    segments : sequence of VibratingSegment
        The history of one drop.
    sensors : sequence of Sensor
        What is watched.
    end : float
        When the run ends [s].

    Raises
    ------
    InputError
        If the plate does not vibrate, has no such point, or there would be too many samples.
    """
    signals = {}
    for rate in {_rate(sensor) for sensor in sensors}:
        group = [sensor for sensor in sensors if _rate(sensor) == rate]
        times: dict[float, Floats] = {}
        for sensor, value in zip(group, _sampled(problem, segments, group, rate, end), strict=True):
            read = _read(sensor, value, rate)
            time = times.setdefault(sensor.rate, np.arange(len(read)) / sensor.rate)
            signals[sensor.name] = Signal(sensor, time, read, _left_out(problem, sensor))
    return {sensor.name: signals[sensor.name] for sensor in sensors}


def _rate(sensor: Sensor) -> float:
    """Return at how many samples per second a point is followed: for a resonance, a whole multiple of the sensor's rate."""
    meter = sensor.accelerometer
    if meter is None or meter.resonance is None:
        return sensor.rate
    return sensor.rate * max(1, math.ceil(_PER_PERIOD * meter.resonance / sensor.rate))


def _sampled(problem: Problem, segments: Sequence[VibratingSegment], sensors: Sequence[Sensor], rate: float, end: float) -> Floats:
    """Return what points do, (sensors, samples)."""
    modes = problem.plate.modes
    if modes is None:
        raise InputError("the plate is rigid, so that its points do not move; give it modes", "sensors")
    for sensor in sensors:
        if sensor.name not in modes.points:
            raise InputError(f'the modes of the plate do not know a point "{sensor.name}"', "sensors")
    count = sample_count(end, rate)
    if count * len(sensors) > MOST_SAMPLES:
        raise InputError(f"{count:.3g} samples of {len(sensors)} sensors are more than {MOST_SAMPLES:.0e}; ask for a lower rate", "sensors")
    kept = np.stack([modes.frequencies < 0.5 * sensor.rate for sensor in sensors])
    shapes = kept * np.stack([modes.points[sensor.name] @ np.asarray(sensor.direction) for sensor in sensors])
    values, blocks = np.zeros((len(sensors), count)), _blocks(problem, rate)
    for segment in segments:
        first = math.ceil(segment.start * rate - 1e-9)
        last = min(math.ceil(segment.end * rate - 1e-9), count) if segment is not segments[-1] else count
        if last <= first:
            continue
        offset = first / rate - segment.start
        moving = segment.moving
        if isinstance(moving, VibratingStretch):
            values[:, first:last] = _in_contact(moving, sensors, shapes, offset + np.arange(last - first) / rate)
            moving.forget()
        elif isinstance(moving, Lying):
            values[:, first:last] = _while_lying(moving, sensors, shapes, offset, last - first, rate)
        else:
            values[:, first:last] = _in_free_motion(blocks, moving, sensors, shapes, offset, last - first)
    return values


def _in_contact(stretch: VibratingStretch, sensors: Sequence[Sensor], shapes: Floats, times: Floats) -> Floats:
    of = stretch.around.oscillators
    times = np.clip(times, 0.0, stretch.length)
    state, force = stretch.state(times), stretch.force_at(stretch.rule.unmap_time(times / stretch.length))
    of_all = {"displacement": state.displacement, "velocity": state.velocity, "acceleration": of.accelerations(state, force)}
    of_each = {name: values[:, of.ground] for name, values in of_all.items()}
    return np.stack([of_each[sensor.quantity] @ shape for sensor, shape in zip(sensors, shapes, strict=True)])


@dataclass(frozen=True)
class _Blocks:
    """The modes of a plate that still move, and what they are worth over a block of samples: C and S, (samples + 1, modes)."""

    of: Oscillators
    cosine: Floats
    sine: Floats

    def pick(self, which: NDArray[np.bool_]) -> _Blocks:
        """Return some of the modes."""
        return _Blocks(self.of.pick(np.flatnonzero(which)), self.cosine[:, which], self.sine[:, which])

    def step(self, place: Floats) -> Floats:
        """Return displacements and velocities (2, modes) a block later."""
        displacement, velocity = place
        cosine, sine, omega = self.cosine[-1], self.sine[-1], self.of.angular_frequency
        later = -(omega**2) * sine * displacement + (cosine - self.of.damping * sine) * velocity
        return np.stack([cosine * displacement + sine * velocity, later])


def _blocks(problem: Problem, rate: float) -> _Blocks:
    of = oscillators_of(problem)
    of = of.pick(np.flatnonzero(of.ground))
    return _Blocks(of, *of.propagators(np.arange(_BLOCK + 1) / rate))


def _in_free_motion(blocks: _Blocks, motion: FreeMotion, sensors: Sequence[Sensor], shapes: Floats, offset: float, count: int) -> Floats:
    """Return what points do at `count` samples from `offset` [s] on, by matrix products over blocks of them."""
    state, ground = motion.state(np.array(offset)), motion.oscillators.ground
    place = np.stack([state.displacement[ground], state.velocity[ground]])
    values, least = np.empty((len(sensors), count)), _NEGLIGIBLE * _swing(blocks.of, place).max(initial=0.0)
    first, rows = 0, 1
    while first < count:
        lasting = _swing(blocks.of, place) > least  # what damping has taken away need not be followed
        blocks, place, shapes = blocks.pick(lasting), place[:, lasting], shapes[:, lasting]
        part, places = min(_BLOCK * rows, count - first), []
        for _ in range(0, part, _BLOCK):
            places.append(place)
            place = blocks.step(place)
        values[:, first : first + part] = _at_points(blocks, np.stack(places), sensors, shapes)[:, :part]
        first, rows = first + part, min(2 * rows, _ROWS)
    return values


def _while_lying(lying: Lying, sensors: Sequence[Sensor], shapes: Floats, offset: float, count: int, rate: float) -> Floats:
    """Return what points do at `count` samples at a rate [Hz] from `offset` [s] on, while the sphere lies on the plate."""
    free, riding = lying.free, lying.riding
    of, ground = free.oscillators, riding.around.oscillators.ground
    blocks = _Blocks(of, *of.propagators(np.arange(_BLOCK + 1) / rate))
    values = _in_free_motion(blocks, free, sensors, shapes @ riding.modes[1][1:][ground], offset, count)
    displaced = np.array([sensor.quantity == "displacement" for sensor in sensors])
    return np.asarray(values + (displaced * (shapes @ riding.equilibrium.displacement[ground]))[:, None])


def _swing(of: Oscillators, place: Floats) -> Floats:
    """Return how fast each oscillator can ever become [m/s], from displacements and velocities (2, modes)."""
    return np.asarray(np.hypot(of.angular_frequency * place[0], place[1]))


def _at_points(blocks: _Blocks, places: Floats, sensors: Sequence[Sensor], shapes: Floats) -> Floats:
    """Return what points do over whole blocks that begin at places (blocks, 2, modes)."""
    omega, damping = blocks.of.angular_frequency, blocks.of.damping
    displacement, velocity = places[:, 0], places[:, 1]
    push = -(omega**2) * displacement - damping * velocity
    of_each = {
        "displacement": (displacement, velocity),
        "velocity": (velocity, push),
        "acceleration": (push, -(omega**2) * velocity - damping * push),
    }
    ahead = np.concatenate([blocks.cosine[:-1].T, blocks.sine[:-1].T])  # (2 modes, samples)
    values = [
        np.concatenate([part * shape for part in of_each[sensor.quantity]], axis=1) @ ahead
        for sensor, shape in zip(sensors, shapes, strict=True)
    ]
    return np.stack(values).reshape(len(sensors), -1)


def _left_out(problem: Problem, sensor: Sensor) -> int:
    """Return how many modes lie at or above half the rate of a sensor."""
    assert problem.plate.modes is not None  # it was sampled
    return int((problem.plate.modes.frequencies >= 0.5 * sensor.rate).sum())


def _read(sensor: Sensor, value: Floats, rate: float) -> Floats:
    """Return what a sensor reads of what its point does at a rate [Hz]."""
    meter = sensor.accelerometer
    if meter is None:
        return value
    if meter.resonance is not None:
        value = _through_resonance(value, rate, meter.resonance, meter.damping_ratio)
    value = value[:: round(rate / sensor.rate)]
    if meter.noise:
        seed = [zlib.crc32(sensor.name.encode()), *np.atleast_1d(meter.seed).tolist()]
        value = value + meter.noise * np.random.default_rng(seed).standard_normal(len(value))
    if meter.resolution is not None:
        value = meter.resolution * np.round(value / meter.resolution)
    return value if meter.range is None else np.clip(value, -meter.range, meter.range)


def _through_resonance(value: Floats, rate: float, resonance: float, ratio: float) -> Floats:
    r"""Return what a seismic mass reads of its base's acceleration: :math:`\omega^2 / (s^2 + 2 \zeta \omega s + \omega^2)`.

    Exact for a base whose acceleration is straight between samples.
    """
    from scipy.signal import cont2discrete, lfilter

    omega = 2.0 * math.pi * resonance
    system = ([omega**2], [1.0, 2.0 * ratio * omega, omega**2])
    numerator, denominator, _ = cont2discrete(system, 1.0 / rate, method="foh")
    return np.asarray(lfilter(np.ravel(numerator), denominator, value))
