"""A record: the samples of one channel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted


class Removed(NamedTuple):
    """The baseline that was removed from a record, in the unit of the record.

    Its mean, and its span from the least to the largest.
    """

    offset: float
    drift: float


@dataclass(frozen=True)
class Record:
    """Samples of one channel at equal steps.

    Parameters
    ----------
    name : str
        Name of the channel.
    value : array, shape (samples,)
        The samples, in `unit`.
    rate : float
        Sampling rate [Hz].
    unit : str
        Unit of the samples, in SI: "V", "m/s^2", "Pa", "N".
    start : float, default 0
        Time of the first sample [s].
    source : str, default ""
        The file that it was read from.
    doubts : tuple of str, default ()
        Warnings about the file, as sentences, such as that it is cut off.
    removed : Removed, optional
        The baseline that was removed from the samples; None if none was sought yet.
    recorded : array, shape (samples,), optional
        The samples as they were recorded, if a baseline was removed.
    blur : float, default 0
        Time over which a coder with losses may have spread what begins suddenly [s].

    Raises
    ------
    InputError
        If the samples are not a row of real numbers, or the rate is not a finite number above 0.

    Examples
    --------
    >>> Record("geophone", [0.0, 0.2, -0.1], 10e3, "V").duration
    0.0003
    """

    name: str
    value: Floats
    rate: float
    unit: str
    start: float = 0.0
    source: str = ""
    doubts: tuple[str, ...] = ()
    removed: Removed | None = None
    recorded: Floats | None = None
    blur: float = 0.0

    def __post_init__(self) -> None:
        value = real_numbers(self.value).astype(np.float64, copy=False)
        if value.ndim != 1:
            raise InputError(
                f"the samples of {quoted(self.name)} have {value.ndim} dimensions; a record has one"
            )
        object.__setattr__(self, "value", value)
        object.__setattr__(self, "rate", checked_rate(self.rate))

    @property
    def duration(self) -> float:
        """Number of samples over the rate [s]."""
        return len(self.value) / self.rate

    @property
    def named_doubts(self) -> tuple[str, ...]:
        """The warnings about its file, each with the name of the file."""
        return tuple(f"{self.source or self.name}: {doubt}" for doubt in self.doubts)

    @property
    def time(self) -> Floats:
        """Times of the samples [s]."""
        return self.start + np.arange(len(self.value)) / self.rate


def recorded_samples(record: Record) -> Floats:
    """Return the samples of a record as they were recorded, with its baseline."""
    if record.recorded is None:
        return record.value
    return record.recorded


def real_numbers(values: object) -> NDArray[Any]:
    """Return real numbers of any type as an array of that type.

    Raises
    ------
    InputError
        If they are not numbers, or not real.
    """
    try:
        numbers = np.asarray(values)
    except ValueError:
        raise InputError("the samples are rows of different lengths; give an array") from None
    if numbers.dtype.kind not in "fiub":
        raise InputError(f"the samples are of the type {numbers.dtype}; they must be real numbers")
    return numbers


def checked_rate(rate: float) -> float:
    """Return a sampling rate.

    Raises
    ------
    InputError
        If it is not a finite number above 0.
    """
    if not isinstance(rate, (int, float, np.integer, np.floating)) or not 0.0 < rate < np.inf:
        raise InputError(f"the rate is {quoted(rate)}; it must be a finite number of Hz above 0")
    return float(rate)
