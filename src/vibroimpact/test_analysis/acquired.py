"""Records of a test: the motion of sensors and, if measured, the force of the hammer by hits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
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
"""Samples by which records of one rate may drift apart until their end, as rates differ by
rounding.
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
        """Begin and end of each pulse of force, after the first sample, (pulses, 2) [s].

        They include what a converter's filter spreads of it, up to the middle between two pulses.
        """
        first, last = np.array(self.pulses, dtype=float).reshape(-1, 2).T
        spread_between = np.minimum(LEAD, 0.5 * (first[1:] - last[:-1]))
        begins = first - np.append(LEAD, spread_between)
        ends = last + np.append(spread_between, LEAD)
        return np.stack([begins, ends], axis=1) / self.rate

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
    all_records = list(records)
    if force is not None:
        all_records.append(force)
    _check_samples(all_records)
    rate = all_records[0].rate if all_records else 1.0
    # one rate for all, and no baselines
    all_records = [without_baseline(replace(record, rate=rate)) for record in all_records]
    used_sensors = sensors_of(
        [replace(sensor, rate=rate) for sensor in sensors], all_records[: len(records)]
    )
    if force is not None and force.unit != "N":
        unit = f"is in {force.unit}"
        if force.unit in ("", "1"):
            unit = "has no unit"
        raise InputError(f"the record {quoted(force.name)} {unit}; the force of a hammer is in N")
    samples, start = on_common_time(all_records)
    _check_length(all_records, samples.shape[1])
    for record, values in zip(all_records, samples, strict=True):
        if np.ptp(values) == 0.0:
            where = ""
            if len(all_records) > 1:
                where = " where it overlaps with the others"
            raise InputError(
                f"the record {quoted(record.name)} is constant{where}; it has no onset"
            )
    recorded, _ = on_common_time([_with_baseline(record) for record in all_records])
    removed = tuple(record.removed or Removed(0.0, 0.0) for record in all_records)
    motion = samples[: len(records)]
    if force is None:
        onset = min(
            onset_time(Record(record.name, values, rate, record.unit, removed=record.removed))
            for record, values in zip(all_records, motion, strict=True)
        )
        return Acquired(
            sensors=used_sensors,
            value=motion,
            force=None,
            start=start,
            onsets=(round(onset * rate),),
            ends=(),
            pulses=(),
            recorded=recorded,
            removed=removed,
        )
    force_samples = samples[-1]
    hits = find_packets(
        Record(force.name, force_samples, rate, "N", removed=removed[-1]), dead_time=_SAME_HIT
    )
    return Acquired(
        sensors=used_sensors,
        value=motion,
        force=force_samples,
        start=start,
        onsets=tuple(hits.first.tolist()),
        ends=tuple(hits.last.tolist()),
        pulses=_pulses(force_samples, rate),
        recorded=recorded,
        removed=removed,
    )


def _check_samples(records: Sequence[Record]) -> None:
    """Check that records have one rate, and finite samples."""
    for record in records:
        first = records[0]
        if abs(record.rate / first.rate - 1.0) * len(record.value) > _DRIFT:
            raise InputError(
                f"the record {quoted(record.name)} has {record.rate:.9g} samples per second, and "
                f"{quoted(first.name)} {first.rate:.9g}; give records of one acquisition, or "
                "resample one of them"
            )
        if not np.isfinite(record.value).all():
            raise InputError(
                f"a sample of the record {quoted(record.name)} is not a finite "
                "number; give it without gaps"
            )


def _with_baseline(record: Record) -> Record:
    """Return a record as it was recorded, before its baseline was removed."""
    if record.recorded is None:
        return record
    return replace(record, value=record.recorded)


def _check_length(records: Sequence[Record], sample_count: int) -> None:
    """Check that records have enough samples in common."""
    if sample_count >= 2 * LEAD:
        return
    if len(records) == 1:
        have = f"the record {quoted(records[0].name)} has {sample_count} samples"
        remedy = "give a longer one"
    else:
        ending = "" if sample_count == 1 else "s"
        have = f"the records have {sample_count} sample{ending} in common"
        remedy = "give longer records that overlap in time"
    raise InputError(f"{have}, and {2 * LEAD} are needed; {remedy}")


def _pulses(force: Floats, rate: float) -> tuple[tuple[int, int], ...]:
    """Return the first and the last sample of each pulse of a force.

    A pulse is where the force is above a tenth of its largest. The envelope, by which hits are
    found, falls so slowly beside a pulse that it joins pulses which are near.
    """
    high = np.flatnonzero(np.abs(force) >= THRESHOLD * np.abs(force).max())
    gaps = np.flatnonzero(np.diff(high) > max(1.0, _APART * rate))
    firsts = high[np.append(0, gaps + 1)]
    lasts = high[np.append(gaps, len(high) - 1)]
    return tuple(zip(firsts.tolist(), lasts.tolist(), strict=True))
