"""Signals with their classes, and which of them share a rock, a plate or a fall."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Indices

GROUPS = ("rock", "plate", "fall")
"""What signals may share."""


@dataclass(frozen=True, eq=False)
class SensorSignals:
    """The signals of one sensor, of one length and rate.

    Parameters
    ----------
    values : array of float32, shape (signals, samples)
        Samples in SI units; a signal that ends early has NaN after its end.
    rate : float
        Sampling rate [Hz].
    unit : str
        Unit of the samples.

    Examples
    --------
    >>> SensorSignals(np.zeros((2, 4), np.float32), 25.6e3, "m/s2").values.shape
    (2, 4)
    """

    values: NDArray[np.float32]
    rate: float
    unit: str


@dataclass(frozen=True, eq=False)
class LabelledSignals:
    """Signals of one data set with their classes, groups and further labels.

    Parameters
    ----------
    name : str
        Title of the data set.
    sensors : mapping of str to SensorSignals
        The signals by sensor; each has as many rows as there are signals.
    classes : array of int, shape (signals,), optional
        Index of the class of each signal; None where it is not known.
    class_names : tuple of str
        Names of the classes.
    groups : mapping of str to array of int
        Identifiers of what the signals share: "rock", "plate", "fall".
    drawn : mapping of str to array
        The keys that were drawn, such as "drop.height": numbers in SI units, or names.
    truth : mapping of str to array
        What the simulation knows and a sensor does not, such as "first_duration_s".
    bayes_error : float, optional
        A lower bound on the error rate, where it is known.
    total : int, optional
        Number of signals in the file, of which these are a part.
    check_sum : str, optional
        SHA-256 of the file.
    bayes_error_sees : str, optional
        The quantities alone that a classifier sees for which this bound was computed; None if the
        data set states the bound.
    rows : array of int, shape (signals,), optional
        The place of each signal in the file, from 0; by default all are there, in this order.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> signals = vi.recognition.load_labelled_signals("falls")
    >>> len(signals), signals.class_names, signals.sensors["a1"].rate
    (96, ('coal', 'gangue'), 20000.0)
    """

    name: str
    sensors: Mapping[str, SensorSignals]
    classes: Indices | None
    class_names: tuple[str, ...]
    groups: Mapping[str, Indices] = field(default_factory=dict)
    drawn: Mapping[str, NDArray[np.generic]] = field(default_factory=dict)
    truth: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    bayes_error: float | None = None
    total: int | None = None
    check_sum: str = ""
    bayes_error_sees: str | None = None
    rows: Indices | None = None

    @property
    def places(self) -> Indices:
        """The place of each signal in its file, from 0."""
        if self.rows is None:
            return np.arange(len(self))
        return self.rows

    def __len__(self) -> int:
        """Return the number of signals."""
        return len(next(iter(self.sensors.values())).values)

    def only(self, kept: Indices) -> LabelledSignals:
        """Return some of the signals.

        Examples
        --------
        >>> silence = SensorSignals(np.zeros((2, 4), np.float32), 1e3, "V")
        >>> both = LabelledSignals("two", {"a1": silence}, np.array([0, 1]), ("coal", "gangue"))
        >>> len(both.only(np.array([1])))
        1
        """
        classes = self.classes
        if classes is not None:
            classes = classes[kept]
        return replace(
            self,
            sensors={
                name: replace(sensor, values=sensor.values[kept])
                for name, sensor in self.sensors.items()
            },
            classes=classes,
            groups={name: numbers[kept] for name, numbers in self.groups.items()},
            drawn={key: values[kept] for key, values in self.drawn.items()},
            truth={name: values[kept] for name, values in self.truth.items()},
            rows=self.places[kept],
        )

    def of_present_classes(self) -> LabelledSignals:
        """Return the signals without the names of classes that none of them has."""
        if self.classes is None:
            return self
        present, classes = np.unique(self.classes, return_inverse=True)
        names = tuple(self.class_names[number] for number in present)
        return replace(self, classes=classes, class_names=names)


def lengths(values: NDArray[np.float32]) -> Indices:
    """Return the length of each signal without the NaN or zeros after its end [samples].

    Examples
    --------
    >>> lengths(np.array([[1, 2, 0, 0], [0, 3, 4, np.nan], [0, 0, 0, 0]], np.float32)).tolist()
    [2, 3, 0]
    """
    is_sample = np.isfinite(values) & (values != 0.0)
    samples_after_end = np.argmax(is_sample[:, ::-1], axis=1)
    return np.where(is_sample.any(axis=1), values.shape[1] - samples_after_end, 0)
