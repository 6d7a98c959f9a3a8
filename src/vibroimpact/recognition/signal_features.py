"""Features of labelled signals as the tables that classifiers read, and noise added to
signals before.
"""

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

FEATURES, PEAK, CONTACT_TIME, TRUE_TIME, EDGES = (
    "features",
    "peak",
    "contact time",
    "true contact time",
    "edges",
)
"""Names of the tables."""

_PEAK, _CUT_OFF = "peak", "cut_off_10_dB"
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
        return self.values[
            :,
            [place for place, name in enumerate(self.names) if name.rpartition(".")[2] == feature],
        ]


def features_of(signals: LabelledSignals) -> Features:
    """Return the features of all sensors; after the end of a signal that is shorter than others
    stand zeros.

    Raises
    ------
    InputError
        If no signal has a feature.
    """
    names: list[str] = []
    units: list[str] = []
    parts: list[Floats] = []
    for sensor, one in signals.sensors.items():
        found = feature_table(_continued(one), one.rate, unit=one.unit)
        names += [f"{sensor}.{name}" for name in found.names]
        units += found.units
        parts.append(found.values)
    with np.errstate(over="ignore"):
        values = np.hstack(parts).astype(np.float32).astype(float)
    values[~np.isfinite(values)] = np.nan
    if np.isnan(values).all():
        raise InputError(
            f"{signals.name}: no signal has a feature; are they all constant or not finite?"
        )
    return Features(tuple(names), tuple(units), values)


def baseline_doubts(signals: LabelledSignals) -> list[str]:
    """Return doubts about sensors whose signals have large baselines: `features_of`
    removes them.
    """
    doubts = []
    for sensor, one in signals.sensors.items():
        found = feature_table(_continued(one), one.rate, [_PEAK])
        baselines = np.abs(found.offset) + found.drift
        large = is_large(baselines, found[_PEAK])
        if large.any():
            unit = "" if one.unit in ("", "1") else f" {one.unit}"
            offset, drift = (
                float(np.abs(found.offset[large]).max()),
                float(found.drift[large].max()),
            )
            drifting = f" and drifts of up to {drift:.4g}{unit}" if is_large(drift, offset) else ""
            words = (
                f"from {large.sum():,} of {len(large):,} signals of {quoted(sensor)} baselines "
                f"with offsets of up to {offset:.4g}{unit}"
            )
            words += f"{drifting} were removed, more than a tenth of their peaks"
            doubts.append(f"{words}: check that it rests at zero, and alike in all classes")
    return doubts


def tables_of(signals: LabelledSignals, features: Features) -> dict[str, Floats]:
    """Return what the classifiers read, by name: all features, single ones for baselines, and what
    should tell little.

    The table `EDGES` has the length, the first and the last sample of each signal; `TRUE_TIME`, the
    contact time of the simulation, is there only if the data set has it.
    """
    tables = {FEATURES: features.values, EDGES: _edges(signals)}
    tables[PEAK] = features.columns(_PEAK)
    # a spectrum that does not end below half the rate is that of a contact too short to be seen
    tables[CONTACT_TIME] = np.nan_to_num(_TIMES_CUT_OFF / features.columns(_CUT_OFF))
    if DURATION in signals.truth:
        tables[TRUE_TIME] = signals.truth[DURATION][:, np.newaxis]
    return tables


def with_noise(signals: LabelledSignals, level: float, seed: int) -> LabelledSignals:
    """Return signals with white noise added, of one strength at each sensor, as that of an
    amplifier is.

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
    return replace(
        signals,
        sensors={name: _noisy(one, level, generator) for name, one in signals.sensors.items()},
    )


def _noisy(one: SensorSignals, level: float, generator: np.random.Generator) -> SensorSignals:
    power = float(np.median(np.nanmean(np.square(one.values, dtype=float), axis=1)))
    noise = generator.standard_normal(one.values.shape, dtype=np.float32)
    return replace(
        one, values=one.values + np.float32(np.sqrt(power * 10.0 ** (-0.1 * level))) * noise
    )


def _continued(one: SensorSignals) -> Floats:
    """Return signals with zeros in place of the NaN after their ends; other NaN stay, and
    are a feature's reason to have no value.
    """
    values = one.values.astype(float)
    ended = np.arange(values.shape[1]) >= lengths(one.values)[:, np.newaxis]
    values[ended & np.isnan(values)] = 0.0
    return values


def _edges(signals: LabelledSignals) -> Floats:
    """Return the length, the first and the last sample of each signal."""
    columns: list[Floats] = []
    for one in signals.sensors.values():
        found = lengths(one.values)
        rows = np.arange(len(found))
        columns += [
            found.astype(float),
            one.values[:, 0].astype(float),
            one.values[rows, np.maximum(found - 1, 0)].astype(float),
        ]
    return np.stack(columns, axis=1)


def by_name(features: Features, names: tuple[str, ...]) -> Floats:
    """Return the columns of features in an order of names, as a saved model asks for.

    Raises
    ------
    InputError
        If one is not there.
    """
    place: Mapping[str, int] = {name: number for number, name in enumerate(features.names)}
    missing = [name for name in names if name not in place]
    if missing:
        raise InputError(
            f"the model needs the feature {missing[0]}, which this version does not "
            "compute or the signals do not have"
        )
    return features.values[:, [place[name] for name in names]]
