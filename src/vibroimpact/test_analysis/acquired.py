"""Records of a test: the motion of sensors and, if it was measured, the force of the
hammer, hit by hit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.errors import InputError
from vibroimpact.identification.measured import on_common_time, sensors_of
from vibroimpact.quoting import quoted
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.onset import onset_time
from vibroimpact.signals.packets import THRESHOLD, find_packets
from vibroimpact.signals.record import Record, Removed

_SAME_HIT = 0.05
"""Pulses of force that follow each other within so long are one hit [s]."""
_APART = 5e-4
"""Pulses of force that are further apart than so long are two [s]."""
_DRIFT = 0.1
"""Samples by which records of one rate may drift apart until their end, as rates differ
by rounding.
"""
LEAD = HALF_LENGTH + 1
"""Samples before an onset that belong to it: as early as a converter's filter lets it be heard."""


@dataclass(frozen=True)
class Acquired:
    """Records of a test on a common time.

    Parameters
    ----------
    sensors : tuple of Sensor
        The sensors, with the rate of the records.
    value : array, shape (S, samples)
        Their samples.
    force : array, shape (samples,), or None
        The force of the hammer [N].
    start : float
        Time of the first sample [s].
    onsets : tuple of int
        First sample of each hit; of one alone without a force.
    ends : tuple of int
        The sample after which the force of each hit is over; empty without a force.
    pulses : tuple of (int, int)
        First and last sample of each pulse of force: of more than there are hits, if a hammer hit
        twice.
    recorded : array, shape (S or S + 1, samples)
        The samples with their baselines, as they were recorded; those of the force last.
    removed : tuple of Removed
        The baselines that were removed, in the same order.
    """

    sensors: tuple[Sensor, ...]
    value: Floats
    force: Floats | None
    start: float
    onsets: tuple[int, ...]
    ends: tuple[int, ...]
    pulses: tuple[tuple[int, int], ...]
    recorded: Floats
    removed: tuple[Removed, ...]

    @property
    def rate(self) -> float:
        """Samples per second [Hz]."""
        return self.sensors[0].rate

    @property
    def pulse_times(self) -> Floats:
        """Begin and end of each pulse of force, after the first sample, with what a
        converter's filter spreads of it, (pulses, 2) [s].
        """
        pulses = np.array(self.pulses, dtype=float).reshape(-1, 2)
        room = np.minimum(LEAD, 0.5 * (pulses[1:, 0] - pulses[:-1, 1]))
        before, after = np.append(LEAD, room), np.append(room, LEAD)
        return np.stack([pulses[:, 0] - before, pulses[:, 1] + after], axis=1) / self.rate

    @property
    def passed(self) -> float:
        """Highest frequency that the sensors pass [Hz]."""
        return min(sensor.passed for sensor in self.sensors)


def acquired_of(
    sensors: Sequence[Sensor], records: Sequence[Record], force: Record | None
) -> Acquired:
    """Return the records of a test.

    Parameters
    ----------
    sensors : sequence of Sensor
        The sensors of the case; they get the rate of the records.
    records : sequence of Record
        The records, named after the sensors.
    force : Record, optional
        The force of the hammer.

    Raises
    ------
    InputError
        If there is no record, no sensor of its name, its unit is another, rates differ, records do
        not overlap in time, one is constant or not finite, or the force is not one.
    """
    every = [*records, *([] if force is None else [force])]
    for one in every:
        if abs(one.rate / every[0].rate - 1.0) * len(one.value) > _DRIFT:
            words = (
                f"the record {quoted(one.name)} has {one.rate:.9g} samples per second, and "
                f"{quoted(every[0].name)} {every[0].rate:.9g}"
            )
            raise InputError(f"{words}; give records of one acquisition, or resample one of them")
        if not np.isfinite(one.value).all():
            raise InputError(
                f"a sample of the record {quoted(one.name)} is not a finite "
                "number; give it without gaps"
            )
    rate = every[0].rate if every else 1.0
    every = [without_baseline(replace(one, rate=rate)) for one in every]
    used = sensors_of([replace(sensor, rate=rate) for sensor in sensors], every[: len(records)])
    if force is not None and force.unit != "N":
        unit = "has no unit" if force.unit in ("", "1") else f"is in {force.unit}"
        raise InputError(f"the record {quoted(force.name)} {unit}; the force of a hammer is in N")
    whole, start = on_common_time(every)
    if whole.shape[1] < 2 * LEAD:
        words = (
            f"the records have {whole.shape[1]} sample{'' if whole.shape[1] == 1 else 's'} in "
            "common"
        )
        remedy = "give longer records that overlap in time"
        if len(every) == 1:
            words, remedy = (
                f"the record {quoted(every[0].name)} has {whole.shape[1]} samples",
                "give a longer one",
            )
        raise InputError(f"{words}, and {2 * LEAD} are needed; {remedy}")
    for one, value in zip(every, whole, strict=True):
        if np.ptp(value) == 0.0:
            where = " where it overlaps with the others" if len(every) > 1 else ""
            raise InputError(f"the record {quoted(one.name)} is constant{where}; it has no onset")
    recorded, _ = on_common_time(
        [one if one.recorded is None else replace(one, value=one.recorded) for one in every]
    )
    removed = tuple(one.removed or Removed(0.0, 0.0) for one in every)
    value = whole[: len(records)]
    if force is None:
        onset = min(
            onset_time(Record(one.name, part, rate, one.unit, removed=one.removed))
            for one, part in zip(every, value, strict=True)
        )
        return Acquired(used, value, None, start, (round(onset * rate),), (), (), recorded, removed)
    push = whole[-1]
    hits = find_packets(
        Record(force.name, push, rate, "N", removed=removed[-1]), dead_time=_SAME_HIT
    )
    onsets, ends = (tuple(part.tolist()) for part in (hits.first, hits.last))
    return Acquired(used, value, push, start, onsets, ends, _pulses(push, rate), recorded, removed)


def _pulses(force: Floats, rate: float) -> tuple[tuple[int, int], ...]:
    """Return the first and the last sample of each pulse of a force, where it is above a tenth of
    its largest.

    The envelope, by which hits are found, falls so slowly beside a pulse that it joins pulses which
    are near.
    """
    high = np.flatnonzero(np.abs(force) >= THRESHOLD * np.abs(force).max())
    gaps = np.flatnonzero(np.diff(high) > max(1.0, _APART * rate))
    firsts = high[np.append(0, gaps + 1)]
    lasts = high[np.append(gaps, len(high) - 1)]
    return tuple(zip(firsts.tolist(), lasts.tolist(), strict=True))
