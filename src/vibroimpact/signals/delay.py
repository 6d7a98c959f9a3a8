"""The delay between signals that have a band of frequencies in common, to a part of a sample."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import fft

from vibroimpact.arrays import Complex, Floats

_OVERSAMPLING = 8
"""Lags per sample at which the correlation is computed before its top is found."""
_NEWTON_STEPS = 20
_EDGE = 0.1
"""Width of the edges of a band, relative to their frequencies."""


class Delay(NamedTuple):
    """The delay of signals after others.

    Parameters
    ----------
    time : float
        How much later they are [s].
    polarity : array, shape (S,)
        1, or -1 where one is upside down.
    correlation : array, shape (S,)
        Correlation coefficient of each pair at this delay and polarity.
    gain : array, shape (S,)
        The multiple of the earlier signal that is nearest to the later one at this delay, of either
        sign.
    """

    time: float
    polarity: Floats
    correlation: Floats
    gain: Floats


def band_limited(value: Floats, rate: float, band: tuple[float, float]) -> Floats:
    """Return signals (..., samples) without what lies outside a band of frequencies [Hz].

    The filter has no delay; the signals are taken as zero before and after.

    Examples
    --------
    >>> time = np.arange(4000) / 10e3
    >>> tones = np.sin(2e2 * np.pi * time) + np.sin(4e3 * np.pi * time)
    >>> left = band_limited(tones, 10e3, (1000.0, 3000.0)) - np.sin(4e3 * np.pi * time)
    >>> bool(np.abs(left[500:3500]).max() < 0.01)
    True
    """
    samples = value.shape[-1]
    length = fft.next_fast_len(2 * samples, real=True)
    gain = _gain(fft.rfftfreq(length, 1.0 / rate), band)
    filtered = fft.irfft(gain * fft.rfft(value, length), length)
    return np.asarray(filtered[..., :samples])


def delay_between(
    later: Floats, earlier: Floats, rate: float, band: tuple[float, float], most: float
) -> Delay:
    r"""Return the one delay of signals after others at which they correlate best, of either sign.

    That is where the sum over the pairs of the magnitudes of their normalised cross-correlations is
    largest, each of band-limited signals:

    .. math:: c(\tau) = \int X(f)\,Y^*(f)\,e^{2 \pi i f \tau}\,df

    which is known between the samples too, so that its top is found there by Newton's method (Knapp
    and Carter 1976, IEEE Trans. Acoust. Speech Signal Process. 24:320: the cross-correlator).

    Parameters
    ----------
    later, earlier : array, shape (S, samples)
        The signals.
    rate : float
        Samples per second [Hz].
    band : tuple of two floats
        The band of frequencies [Hz].
    most : float
        Largest magnitude of the delay [s].

    Examples
    --------
    >>> time = np.arange(400) / 10e3
    >>> def burst(at):
    ...     return np.exp(-(((time - at) / 1e-3) ** 2)) * np.sin(4e3 * np.pi * (time - at))
    >>> found = delay_between(-burst(0.02034)[None], burst(0.02)[None], 10e3, (500.0, 4000.0), 2e-3)
    >>> round(1e3 * found.time, 4), found.polarity.tolist(), found.correlation.round(4).tolist()
    (0.34, [-1.0], [1.0])
    """
    # padded to twice the length, so that no lag wraps the end of a signal around to its begin
    length = fft.next_fast_len(2 * later.shape[1], real=True)
    frequency = fft.rfftfreq(length, 1.0 / rate)
    gain = _gain(frequency, band)
    later_spectrum = gain * fft.rfft(later, length)
    earlier_spectrum = gain * fft.rfft(earlier, length)
    # the one-sided spectrum holds all frequencies twice, but zero and half the rate
    is_single = (frequency == 0.0) | (frequency == 0.5 * rate)
    weights = np.where(is_single, 1.0, 2.0) / length
    later_norm = _norms(later_spectrum, weights)
    earlier_norm = _norms(earlier_spectrum, weights)
    norms = np.maximum(later_norm * earlier_norm, 1e-300)
    cross_spectrum = later_spectrum * earlier_spectrum.conj() / norms[:, None]

    # the highest of the correlations at a grid of lags, in eighths of a sample
    correlations = _OVERSAMPLING * fft.irfft(cross_spectrum, _OVERSAMPLING * length)
    largest_lag = min(int(most * rate * _OVERSAMPLING), _OVERSAMPLING * length // 2 - 1)
    lags = np.arange(-largest_lag, largest_lag + 1)
    together = np.abs(correlations[:, lags]).sum(axis=0)
    best_lag = int(lags[np.argmax(together)])
    polarity = np.where(correlations[:, best_lag] < 0.0, -1.0, 1.0)

    # from there on between the lags, with the signs that the signals have at it
    time_of_lag = best_lag / (_OVERSAMPLING * rate)
    upright_spectrum = weights * (polarity @ cross_spectrum)
    time = _top_near(time_of_lag, upright_spectrum, frequency, rate)
    turn = np.exp(2j * np.pi * frequency * time)
    correlation = (cross_spectrum @ (weights * turn)).real
    gain = correlation * later_norm / np.maximum(earlier_norm, 1e-300)
    return Delay(time, polarity, polarity * correlation, gain)


def _norms(spectrum: Complex, weights: Floats) -> Floats:
    """Return the roots of the energies of signals with one-sided spectra, by Parseval's theorem."""
    return np.asarray(np.sqrt((weights * np.abs(spectrum) ** 2).sum(axis=1)))


def _top_near(time: float, spectrum: Complex, frequency: Floats, rate: float) -> float:
    """Return the time [s] near another at which a correlation with a spectrum is largest.

    Newton's method seeks where the derivative of the correlation is zero.
    """
    turn_rate = 2j * np.pi * frequency
    longest_step = 0.5 / (_OVERSAMPLING * rate)
    for _ in range(_NEWTON_STEPS):
        terms = spectrum * np.exp(turn_rate * time)
        slope = float((turn_rate * terms).real.sum())
        curvature = float((turn_rate**2 * terms).real.sum())
        step = 0.0
        if curvature < 0.0:  # else the nearest zero of the slope is no top
            step = -slope / curvature
        time += float(np.clip(step, -longest_step, longest_step))
        if abs(step) * rate < 1e-12:
            break
    return time


def _gain(frequency: Floats, band: tuple[float, float]) -> Floats:
    """Return the gain of a band, whose edges fall as cosines outside of it."""
    low, high = band
    below = np.clip((low - frequency) / (_EDGE * low), 0.0, 1.0)
    above = np.clip((frequency - high) / (_EDGE * high), 0.0, 1.0)
    return np.asarray(0.25 * (1.0 + np.cos(np.pi * below)) * (1.0 + np.cos(np.pi * above)))
