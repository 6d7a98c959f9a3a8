"""Records of the sensors of a case on a common time, around the first touch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_case
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.quoting import quoted
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.clipped import clipped_samples
from vibroimpact.signals.onset import onset_time
from vibroimpact.signals.reading.one_record import is_named
from vibroimpact.signals.record import Record, Removed
from vibroimpact.units.display import digits

_LEAST = 64
"""Least number of samples from first touch on."""
_QUIET = 16
"""Least number of samples before first touch that tell the noise."""
_UNKNOWN = 0.01
"""Noise, relative to the rms value, that is assumed until a fit tells it."""
_STRAIN = ("1", "m/m")
"""Unit of a strain, as a record has it and as a sensor."""
_SAME = 1e-3
"""Relative difference of rates, and difference of instants in sampling periods, that is none."""
_SIGNALS = "result.nc"
"""File of the signals in the folder of a run."""
_CASE = "case.toml"
"""File of its case."""


@dataclass(frozen=True)
class Measured:
    """Records of sensors around the first touch.

    Parameters
    ----------
    sensors : tuple of Sensor
        The sensors.
    value : array, shape (S, samples)
        Their samples.
    heard : array of bool, shape (S, samples)
        Whether a sample is used: one that is clipped is not.
    rate : float
        Samples per second [Hz].
    start : float
        Time of the first sample [s].
    onset : float
        When the first of the records rises, after the first sample [s].
    noise : array, shape (S,)
        Standard deviation of the noise of each.
    quiet : bool
        Whether the noise is that before first touch; else it is a guess.
    removed : tuple of Removed
        The baselines that were removed from the records.
    polarity : array, shape (S,)
        1, or -1 for a record whose sign was changed.
    """

    sensors: tuple[Sensor, ...]
    value: Floats
    heard: Bools
    rate: float
    start: float
    onset: float
    noise: Floats
    quiet: bool
    removed: tuple[Removed, ...]
    polarity: Floats

    def inverted(self, which: Floats) -> Measured:
        """Return the records times 1 or -1 each, (S,)."""
        return replace(self, value=which[:, None] * self.value, polarity=which * self.polarity)

    @property
    def weights(self) -> Floats:
        """One over the noise, (S, samples); zero where a sample is not used."""
        return self.heard / self.noise[:, None]

    @property
    def rms(self) -> Floats:
        """Root mean square of the samples of each that are used."""
        return rms_of(self.value, self.heard)

    @property
    def band(self) -> float:
        """Highest frequency that the sensors pass [Hz]."""
        return min(sensor.passed for sensor in self.sensors)


def measured_of(sensors: Sequence[Sensor], records: Sequence[Record], window: float) -> Measured:
    """Return records around their first touch, for the sensors that they are named after.

    Their baselines are removed.

    Parameters
    ----------
    sensors : sequence of Sensor
        The sensors of a case.
    records : sequence of Record
        The records.
    window : float
        Time from first touch on that is used [s].

    Raises
    ------
    InputError
        If there is no sensor of that name, its unit or rate is another, two records have one name,
        they were not sampled at the same instants, or one is too short, not finite or constant.
    """
    used = sensors_of(sensors, records)
    rate = used[0].rate
    records = [without_baseline(record) for record in records]
    whole, start = on_common_time(records)
    clipped = _clipped_on_common_time(records)
    end = start + whole.shape[1] / rate
    onset = min(onset_time(record) for record in records)
    onset_sample = round((onset - start) * rate)
    first = max(0, onset_sample - HALF_LENGTH - 1)
    last = min(round((onset + window - start) * rate), round((end - start) * rate))
    if last - onset_sample < _LEAST:
        raise InputError(
            f"the records have {max(0, last - onset_sample)} samples in common from first touch "
            f"on, to at most {1e3 * window:g} ms; {_LEAST} are needed, which are "
            f"{digits(1e3 * _LEAST / rate, 3)} ms at {rate:.10g} Hz"
        )
    value = whole[:, first:last]
    heard = ~clipped[:, first:last]
    rms = rms_of(value, heard)
    before = whole[:, :first]
    # without a rest of its own, a record has noise in proportion to itself
    noise = _UNKNOWN * rms
    quiet = False
    if first >= _QUIET:
        quiet_noise = np.std(before, axis=1)
        # zeros before first touch tell no noise
        quiet = bool(np.all(quiet_noise > 1e-9 * rms))
        if quiet:
            noise = quiet_noise
    return Measured(
        sensors=used,
        value=value,
        heard=heard,
        rate=rate,
        start=start + first / rate,
        onset=onset - start - first / rate,
        noise=noise,
        quiet=quiet,
        removed=tuple(record.removed or Removed(0.0, 0.0) for record in records),
        polarity=np.ones(len(used)),
    )


def _clipped_on_common_time(records: Sequence[Record]) -> Bools:
    """Return which samples of records are clipped, in the time that they have in common."""
    clipped = [replace(record, value=clipped_samples(record).astype(float)) for record in records]
    on_time, _ = on_common_time(clipped)
    return on_time > 0.0


def rms_of(value: Floats, heard: Bools) -> Floats:
    """Return the root mean square of each row (S, samples) over the samples that are used."""
    energy = (value**2 * heard).sum(axis=1)
    samples = np.maximum(heard.sum(axis=1), 1)
    return np.asarray(np.sqrt(energy / samples))


def sensors_of(sensors: Sequence[Sensor], records: Sequence[Record]) -> tuple[Sensor, ...]:
    """Return the sensor that each record is named after.

    Raises
    ------
    InputError
        If there is no record, no sensor of that name, its unit or rate is another, or two records
        have one name.
    """
    known = {sensor.name: sensor for sensor in sensors}
    chosen: dict[str, Sensor] = {}
    for record in records:
        name = _sensor_name(record, known)
        if name is None:
            raise InputError(_no_sensor(record, known))
        if name in chosen:
            raise InputError(f"there are two records {quoted(name)}; give those of one fall")
        _check(record, known[name])
        chosen[name] = known[name]
    if not chosen:
        raise InputError("there is no record; give the files with those of the sensors")
    return tuple(chosen.values())


def _sensor_name(record: Record, known: Mapping[str, Sensor]) -> str | None:
    """Return the name of the sensor that a record is named after; None if there is none."""
    # its own name first, then the cells of headers
    for name in (record.name, *known):
        if name in known and is_named(record, name):
            return name
    return None


def _no_sensor(record: Record, known: Mapping[str, Sensor]) -> str:
    """Return the message that there is no sensor with the name of a record."""
    names = ", ".join(f'"{name}"' for name in known)
    message = f"the case has no sensor {quoted(record.name)}; it has {names}"
    if record.source.lower().endswith(".csv"):
        first = next(iter(known.values()))
        message += (
            "; a column of a CSV file is named after its sensor and has its unit, "
            f'such as "{first.name} [{first.unit}]"'
        )
    return f"{message}.{did_you_mean(record.name, known)}"


def on_common_time(records: Sequence[Record]) -> tuple[Floats, float]:
    """Return the samples of records in the time that they have in common, and its begin [s].

    The samples are (S, samples).

    Raises
    ------
    InputError
        If they were not sampled at the same instants.
    """
    rate = records[0].rate
    start = max(record.start for record in records)
    end = min(record.start + len(record.value) / rate for record in records)
    offsets = [(start - record.start) * rate for record in records]
    if any(abs(offset - round(offset)) > _SAME * max(1.0, offset) for offset in offsets):
        raise InputError(
            "the records were not sampled at the same instants; give those of one acquisition"
        )
    from_start = [
        record.value[round(offset) :] for record, offset in zip(records, offsets, strict=True)
    ]
    lengths = [len(value) for value in from_start]
    # rounded, the common time may be a sample longer than one of them
    samples = min(max(0, round((end - start) * rate)), *lengths)
    return np.stack([value[:samples] for value in from_start]), start


def has_unit_of(record: Record, sensor: Sensor) -> bool:
    """Return whether a record is in the unit that a sensor reads."""
    return record.unit.replace("^", "") == sensor.unit or (record.unit, sensor.unit) == _STRAIN


def _check(record: Record, sensor: Sensor) -> None:
    """Raise InputError unless a record can be that of a sensor."""
    name = quoted(record.name)
    if not has_unit_of(record, sensor):
        unit = "without a unit"
        if record.unit:
            unit = f"in {record.unit}"
        raise InputError(
            f"the record {name} is {unit}, and the sensor of that name reads {sensor.unit}"
        )
    if abs(record.rate / sensor.rate - 1.0) > _SAME:
        raise InputError(
            f"the record {name} has {record.rate:.10g} samples per second, and the sensor of that "
            f"name {sensor.rate:.10g}; write rate = {record.rate:.10g} in the case, with the "
            "anti-alias filter that the record has"
        )
    if not np.isfinite(record.value).all():
        raise InputError(f"the record {name} has samples that are not finite numbers")
    if not len(record.value):
        raise InputError(f"the record {name} has no samples; it shows no impact")
    if np.ptp(record.value) == 0.0:
        raise InputError(f"the record {name} is constant; it shows no impact")


def is_own_run(case: CaseTable, records: Sequence[Record]) -> bool:
    """Return whether records are from the folder of a run whose plate is modelled as in a case.

    Then they have no errors of that model.
    """
    sources = {Path(record.source) for record in records}
    folders = {source.parent for source in sources}
    if len(folders) != 1 or any(source.name != _SIGNALS for source in sources):
        return False
    file = folders.pop() / _CASE
    if not file.is_file():
        return False
    try:
        other = load_case(file)
    except InputError:  # of another version, or changed by hand
        return False
    return bool(resolved_case(other)["plate"] == resolved_case(case)["plate"])
