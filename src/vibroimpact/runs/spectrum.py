"""Amplitude spectrum of a sensor signal after the first touch."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.results.result import Result

_LONGEST = 2**17
"""Largest number of samples transformed."""


class AmplitudeSpectrum(NamedTuple):
    """One-sided amplitude spectrum: frequencies [Hz], amplitudes in the unit of the
    signal, and length of the record [s].
    """

    frequency: Floats
    amplitude: Floats
    span: float


def amplitude_spectrum(values: Floats, rate: float) -> AmplitudeSpectrum:
    """Return the amplitude spectrum of a decaying response that starts abruptly.

    The window is the falling half of a Hann window, which keeps the onset and tapers the end. The
    spectrum is scaled so that a steady tone has its amplitude; a transient has a lower one the
    longer the record is.

    Parameters
    ----------
    values : array
        Samples.
    rate : float
        Sampling rate [Hz].

    Returns
    -------
    AmplitudeSpectrum
        Spectrum from 0 to half of the sampling rate.

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
    return AmplitudeSpectrum(
        np.arange(len(amplitude)) * rate / len(values), amplitude, len(values) / rate
    )


def first_response(result: Result, name: str) -> slice:
    """Return the slice of a sensor's samples from the first touch to the next, or to the
    end; at most 131072 samples.
    """
    touches = result.impacts["time_s"]
    signal = result.signals[name]
    first = 0
    last = len(signal.value)
    if len(touches):
        first = signal.first_at(float(touches[0]))
    if len(touches) > 1:
        last = signal.first_at(float(touches[1]))
    return slice(first, min(last, first + _LONGEST))
