"""Features of labelled signals as the tables that classifiers read, and noise for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted
from vibroimpact.recognition.input_faults import DURATION
from vibroimpact.recognition.labelled_signals import LabelledSignals, SensorSignals, lengths
from vibroimpact.signals.baseline import is_large
from vibroimpact.signals.feature_table import feature_table

# names of the tables
FEATURES = "features"
PEAK = "peak"
CONTACT_TIME = "contact time"
TRUE_TIME = "true contact time"
EDGES = "edges"

# names of features
_PEAK = "peak"
_CUT_OFF = "cut_off_10_dB"
_TIMES_CUT_OFF = 1.16
"""Contact time times the frequency at which the spectrum of Hertz's force has fallen by 10 dB."""


@dataclass(frozen=True, eq=False)
class Features:
    """A table of features, a row a signal.

    Parameters
    ----------
    names, units : tuple of str
        Name, "SENSOR.FEATURE", and unit of each column.
    values : array, shape (signals, features)
        The features, of single precision as a saved model takes them; NaN where one has no value.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    values: Floats

    def columns(self, feature: str) -> Floats:
        """Return the columns of one feature, one a sensor."""
        indices = [
            index for index, name in enumerate(self.names) if name.rpartition(".")[2] == feature
        ]
        return self.values[:, indices]


def features_of(signals: LabelledSignals) -> Features:
    """Return the features of all sensors.

    After the end of a signal that is shorter than others stand zeros.

    Raises
    ------
    InputError
        If no signal has a feature.
    """
    names: list[str] = []
    units: list[str] = []
    tables: list[Floats] = []
    for sensor, sensor_signals in signals.sensors.items():
        table = feature_table(
            _continued(sensor_signals), sensor_signals.rate, unit=sensor_signals.unit
        )
        names += [f"{sensor}.{name}" for name in table.names]
        units += table.units
        tables.append(table.values)
    with np.errstate(over="ignore"):
        values = np.hstack(tables).astype(np.float32).astype(float)
    values[~np.isfinite(values)] = np.nan
    if np.isnan(values).all():
        raise InputError(
            f"{signals.name}: no signal has a feature; are they all constant or not finite?"
        )
    return Features(tuple(names), tuple(units), values)


def baseline_doubts(signals: LabelledSignals) -> list[str]:
    """Return doubts about sensors whose signals have large baselines, which are removed."""
    doubts = []
    for sensor, sensor_signals in signals.sensors.items():
        table = feature_table(_continued(sensor_signals), sensor_signals.rate, [_PEAK])
        large = is_large(np.abs(table.offset) + table.drift, table[_PEAK])
        if large.any():
            unit = ""
            if sensor_signals.unit not in ("", "1"):
                unit = f" {sensor_signals.unit}"
            offset = float(np.abs(table.offset[large]).max())
            drift = float(table.drift[large].max())
            baselines = f"baselines with offsets of up to {offset:.4g}{unit}"
            if is_large(drift, offset):
                baselines += f" and drifts of up to {drift:.4g}{unit}"
            doubts.append(
                f"from {large.sum():,} of {len(large):,} signals of {quoted(sensor)} {baselines} "
                "were removed, more than a tenth of their peaks: check that it rests at zero, and "
                "alike in all classes"
            )
    return doubts


def tables_of(signals: LabelledSignals, features: Features) -> dict[str, Floats]:
    """Return what the classifiers read, by name.

    There are all features, single ones for baselines, and what should tell little. The table
    `EDGES` has the length, the first and the last sample of each signal; `TRUE_TIME`, the contact
    time of the simulation, is there only if the data set has it.
    """
    tables = {FEATURES: features.values, EDGES: _edges(signals)}
    tables[PEAK] = features.columns(_PEAK)
    # a spectrum that does not end below half the rate is that of a contact too short to be seen
    tables[CONTACT_TIME] = np.nan_to_num(_TIMES_CUT_OFF / features.columns(_CUT_OFF))
    if DURATION in signals.truth:
        tables[TRUE_TIME] = signals.truth[DURATION][:, np.newaxis]
    return tables


def with_noise(signals: LabelledSignals, level: float, seed: int) -> LabelledSignals:
    """Return signals with white noise added.

    It is of one strength at each sensor, as that of an amplifier is.

    Parameters
    ----------
    signals : LabelledSignals
        The signals.
    level : float
        Ratio of the median signal's mean square to that of the noise [dB].
    seed : int
        Seed of the noise.
    """
    generator = np.random.default_rng(seed)
    sensors = {
        name: _noisy(sensor_signals, level, generator)
        for name, sensor_signals in signals.sensors.items()
    }
    return replace(signals, sensors=sensors)


def _noisy(signals: SensorSignals, level: float, generator: np.random.Generator) -> SensorSignals:
    mean_squares = np.nanmean(np.square(signals.values, dtype=float), axis=1)
    power = float(np.median(mean_squares))
    noise = generator.standard_normal(signals.values.shape, dtype=np.float32)
    amplitude = np.float32(np.sqrt(power * 10.0 ** (-0.1 * level)))
    return replace(signals, values=signals.values + amplitude * noise)


def _continued(signals: SensorSignals) -> Floats:
    """Return signals with zeros in place of the NaN after their ends.

    Other NaN stay, and are a feature's reason to have no value.
    """
    values = signals.values.astype(float)
    ended = np.arange(values.shape[1]) >= lengths(signals.values)[:, np.newaxis]
    values[ended & np.isnan(values)] = 0.0
    return values


def _edges(signals: LabelledSignals) -> Floats:
    """Return the length, the first and the last sample of each signal."""
    columns: list[Floats] = []
    for sensor_signals in signals.sensors.values():
        values = sensor_signals.values
        length = lengths(values)
        last_samples = values[np.arange(len(length)), np.maximum(length - 1, 0)]
        columns += [length.astype(float), values[:, 0].astype(float), last_samples.astype(float)]
    return np.stack(columns, axis=1)


def by_name(features: Features, names: tuple[str, ...]) -> Floats:
    """Return the columns of features in an order of names, as a saved model asks for.

    Raises
    ------
    InputError
        If one is not there.
    """
    column: Mapping[str, int] = {name: number for number, name in enumerate(features.names)}
    missing = [name for name in names if name not in column]
    if missing:
        raise InputError(
            f"the model needs the feature {missing[0]}, which this version does not "
            "compute or the signals do not have"
        )
    return features.values[:, [column[name] for name in names]]
