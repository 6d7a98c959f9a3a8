"""What sensors on the plate record: the motion of their points through a chain of instruments, as samples."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.antialias import Section, antialias_of
from vibroimpact.dynamics.sensors.filtered_chain import filtered_chain
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain, measuring_chain
from vibroimpact.dynamics.sensors.overload import finer_rate, overload, taken_away
from vibroimpact.dynamics.sensors.sampled import around_first_contact, follow_at_instants, follow_filtered, longest_span
from vibroimpact.dynamics.sensors.sensor import Sensor, sample_count
from vibroimpact.dynamics.vibrating.bodies import bases_of_plate
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment
    from vibroimpact.structures.modal_model import ModalBasis

MOST_SAMPLES = 100_000_000
"""Of one sensor; more do not fit into memory."""
_NONE = np.zeros(3)
_WIDER = 8
"""Times the rate: up to half of that samples without a filter are taken to hold what is there."""


@dataclass(frozen=True)
class Signal:
    """What a sensor recorded.

    Parameters
    ----------
    sensor : Sensor
        What recorded it.
    value : array, shape (samples,)
        What was read at `time`, in the unit of the sensor.
    uncertainty : float, default NaN
        About how far it may be off for the modes left out, as a part of its rms value around the first contact.
    peak : float, default NaN
        The largest magnitude that reached an accelerometer's range, before it is clipped [m/s^2].
    overload_time : float, default 0
        For how long it was driven beyond its range, in all [s].
    """

    sensor: Sensor
    value: Floats
    uncertainty: float = float("nan")
    peak: float = float("nan")
    overload_time: float = 0.0

    @property
    def time(self) -> Floats:
        """Times of the samples since the start [s], made anew when they are asked for: they take as much memory as the values."""
        return self.times(0, len(self.value))

    def times(self, first: int, last: int) -> Floats:
        """Return the times of some samples [s], from the first to before the last."""
        return np.arange(first, min(last, len(self.value))) / self.sensor.rate

    def first_at(self, time: float) -> int:
        """Return the number of the first sample that is not before a time [s]; if there is none, how many there are."""
        about = min(max(int(time * self.sensor.rate) - 2, 0), len(self.value))  # which is off by rounding
        return about + int(np.searchsorted(self.times(about, about + 5), time))

    @property
    def largest(self) -> float:
        """The largest magnitude."""
        return float(max(self.value.max(initial=0.0), -self.value.min(initial=0.0)))


def record(problem: Problem, segments: Sequence[VibratingSegment], sensors: Sequence[Sensor], end: float) -> dict[str, Signal]:
    """Return the signals of sensors over a run, by their names.

    The chain is that of an instrument: the motion with all modes kept, and what the contact force does quasi-statically to those left
    out; the mounted resonance; the range; the anti-alias filter; samples, with their noise and steps. All that is linear in it is
    computed in closed form, at the samples alone.

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
    modes = _checked(problem, sensors, end)
    groups: dict[tuple[float, str, float | None, tuple[Section, ...]], list[Sensor]] = {}
    for sensor in sensors:
        groups.setdefault((sensor.rate, sensor.filter, sensor.corner, _resonance(sensor)), []).append(sensor)
    signals: dict[str, Signal] = {}
    for group in groups.values():
        signals |= _recorded(problem, modes, segments, group, end)
    return {sensor.name: signals[sensor.name] for sensor in sensors}


def _checked(problem: Problem, sensors: Sequence[Sensor], end: float) -> ModalBasis:
    """Return the modes of the plate, if it has any and they know the points that are watched."""
    modes = problem.plate.modes
    if modes is None:
        raise InputError("the plate is rigid, so that its points do not move; give it modes", "sensors")
    for sensor in sensors:
        if sensor.name not in modes.points:
            raise InputError(f'the modes of the plate do not know a point "{sensor.name}"', "sensors")
        meter = sensor.accelerometer
        rate = sensor.rate if meter is None or meter.range is None else finer_rate(sensor.rate, meter.resonance)
        count = sample_count(end, rate) * (len(sensors) if rate == sensor.rate else 1)
        if count > MOST_SAMPLES:
            why = "" if rate == sensor.rate else ", at which the clipping of its range is followed,"
            raise InputError(f"{count:.3g} samples{why} are more than {MOST_SAMPLES:.0e}; ask for a lower rate", "sensors")
    return modes


def _plate(problem: Problem) -> Oscillators:
    parts = ((basis.angular_frequencies, basis.damping_ratios, basis.contact) for basis in bases_of_plate(problem))
    return Oscillators(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _resonance(sensor: Sensor) -> tuple[Section, ...]:
    """Return the poles of the mounted resonance, if the sensor has one."""
    meter = sensor.accelerometer
    if meter is None or meter.resonance is None:
        return ()
    omega = 2.0 * np.pi * meter.resonance
    return ((omega**2, 2.0 * meter.damping_ratio * omega),)


def _recorded(
    problem: Problem, modes: ModalBasis, segments: Sequence[VibratingSegment], group: Sequence[Sensor], end: float
) -> dict[str, Signal]:
    """Return the signals of sensors of one rate, resonance and filter."""
    sensor, plate = group[0], _plate(problem)
    through, resonance, count = antialias_of(sensor), _resonance(sensor), sample_count(end, sensor.rate)
    bases = bases_of_plate(problem)
    shapes = np.stack([np.concatenate([basis.points[one.name] for basis in bases]) @ np.asarray(one.direction) for one in group])
    compliance = np.array([modes.residuals.get(one.name, _NONE) @ np.asarray(one.direction) for one in group])
    orders = [one.order for one in group]
    bare = measuring_chain(plate, shapes, compliance, orders, resonance)
    if through.reach:
        known = filtered_chain(bare, sensor.rate, longest_span(segments, sensor.rate))
        values = follow_filtered(known, segments, count)
    else:
        chain = measuring_chain(plate, shapes, compliance, orders, (*resonance, *through.sections))
        values = follow_at_instants(chain, sensor.rate, segments, count)
        rate = sensor.rate * (1 if through.sections else _WIDER)
        known = filtered_chain(bare, rate, longest_span(segments, rate))
    left_out = filtered_chain(_of_next_octave(plate, shapes, orders, resonance), known.rate, longest_span(segments, known.rate))
    whole, doubted = (np.linalg.norm(around_first_contact(one, segments), axis=1) for one in (known, left_out))
    uncertainties = doubted / np.where(whole > 0.0, whole, np.inf)
    signals = {}
    for number, one in enumerate(group):
        value, meter, facts = values[number], one.accelerometer, {"uncertainty": float(uncertainties[number])}
        if meter is not None and meter.range is not None:
            alone = measuring_chain(plate, shapes[[number]], compliance[[number]], [2], resonance)
            found = overload(alone, finer_rate(one.rate, meter.resonance), segments, end, through.reach / one.rate, meter.range)
            clipped = one.filter == "none"
            value = np.clip(value, -meter.range, meter.range) if clipped else value - taken_away(found, through, one.rate, count)
            facts |= {"peak": found.peak, "overload_time": found.time}
        signals[one.name] = Signal(one, _digitised(one, value), **facts)
    return signals


def _of_next_octave(plate: Oscillators, shapes: Floats, orders: Sequence[int], resonance: Sequence[Section]) -> MeasuringChain:
    """Return the chain of what modes above those kept may do beyond their quasi-static share.

    They are taken for the like of the last octave, at twice the frequencies, and twice as many, as bending of a plate has them.
    """
    last = np.flatnonzero(plate.angular_frequency > 0.5 * plate.angular_frequency.max())
    above, seen = plate.pick(last), 2.0 * shapes[:, last]
    above = replace(above, angular_frequency=2.0 * above.angular_frequency)
    return measuring_chain(above, seen, -(seen * above.shape / above.angular_frequency**2).sum(axis=1), orders, resonance)


def _digitised(sensor: Sensor, value: Floats) -> Floats:
    """Return samples with the noise and the steps of an accelerometer."""
    meter = sensor.accelerometer
    if meter is None:
        return value
    if meter.noise:
        seed = [zlib.crc32(sensor.name.encode()), *np.atleast_1d(meter.seed).tolist()]
        value = value + meter.noise * np.random.default_rng(seed).standard_normal(len(value))
    return value if meter.resolution is None else meter.resolution * np.round(value / meter.resolution)
