"""The amplitude spectrum of what a sensor recorded after the first touch."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.results.result import Result

_LONGEST = 2**17
"""Samples that are transformed at most."""


class AmplitudeSpectrum(NamedTuple):
    """A one-sided spectrum: frequencies [Hz], amplitudes in the unit of the signal, and how long a piece it is of [s]."""

    frequency: Floats
    amplitude: Floats
    span: float


def amplitude_spectrum(values: Floats, rate: float) -> AmplitudeSpectrum:
    """Return the amplitude spectrum of a response that starts at once and dies away.

    The window is the falling half of Hann's, which leaves the start as it is and fades the end out. A steady tone reads its
    amplitude; a transient reads less the longer the piece is.

    Parameters
    ----------
    values : array
        The samples.
    rate : float
        Samples per second [Hz].

    Examples
    --------
    >>> time = np.arange(1000) / 1000.0
    >>> found = amplitude_spectrum(3.0 * np.sin(2.0 * np.pi * 125.0 * time), 1000.0)
    >>> float(found.frequency[found.amplitude.argmax()]), float(found.amplitude.max().round(2))
    (125.0, 3.0)
    """
    window = 0.5 + 0.5 * np.cos(np.pi * np.arange(len(values)) / len(values))
    amplitude = np.abs(np.fft.rfft(window * values)) / window.sum()
    amplitude[1:] *= 2.0
    return AmplitudeSpectrum(np.arange(len(amplitude)) * rate / len(values), amplitude, len(values) / rate)


def first_response(result: Result, name: str) -> slice:
    """Return which samples of a sensor lie between the first touch and the next one, or the end; at most 131072."""
    touches, signal = result.impacts["time_s"], result.signals[name]
    first = signal.first_at(float(touches[0])) if len(touches) else 0
    last = signal.first_at(float(touches[1])) if len(touches) > 1 else len(signal.value)
    return slice(first, min(last, first + _LONGEST))
