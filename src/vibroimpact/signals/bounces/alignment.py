"""Times of touches below a sample, by what their sounds have in common."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from vibroimpact.arrays import Bools, Floats, Indices

_BEFORE = 0.5e-3
"""Time before a touch that is compared [s]."""

_AFTER = 3e-3
"""Time after a touch that is compared [s]."""

_LEAST_REACH = 1e-3
"""How far the time of a touch may move at least [s]."""

_FINE_RATE = 400e3
"""Rate at which correlations are computed [Hz]; between its samples they are parabolas."""

_ROUNDS = 6

_RESOLUTION = 1e-4
"""Standard deviation of interpolation between samples, in samples.

It is that of sounds below half the rate.
"""

_TINY = 1e-300


def aligned(
    value: Floats, rate: float, sample: Indices, blur: float = 0.0, clipped: Bools | None = None
) -> tuple[Floats, Floats]:
    r"""Return the times of touches, and their standard deviations.

    The sounds of bounces are alike: each is shifted to where it correlates best with the mean of
    the others, s (Woody 1967, Med. Biol. Eng. 5:539). A shift at which their correlation is c has,
    in noise of variance v, the likelihood :math:`\exp(c^2 / (2 v \sum s^2))`; its standard
    deviation includes that it may be a period off. The noise is what is left of a sound when the
    common one is taken from it: noise, clicks and differences in shape alike.

    Parameters
    ----------
    value : array, shape (samples,)
        The samples.
    rate : float
        Their rate [Hz].
    sample : array of int, shape (n,)
        Where each touch begins, within 1 ms or `blur`; three of them at least.
    blur : float, default 0
        Time over which a coder spread what begins suddenly [s].
    clipped : array of bool, shape (samples,), optional
        Which samples are clipped: by how much is no noise, and does not tell its variance.

    Returns
    -------
    time, deviation : array, shape (n,)
        In samples. The deviations are those of differences between the times: what the sounds have
        in common has no beginning of its own.

    Examples
    --------
    >>> time = np.arange(9600) / 48e3
    >>> def tap(at):
    ...     return np.where(
    ...         time >= at, np.exp(-(time - at).clip(0.0) / 1e-3) * np.sin(2e4 * (time - at)), 0.0
    ...     )
    >>> found, _ = aligned(
    ...     tap(0.03) + tap(0.06 + 0.3 / 48e3) + tap(0.1), 48e3, np.array([1440, 2881, 4800])
    ... )
    >>> np.diff(found).round(1).tolist()
    [1440.3, 1919.7]
    """
    span = _Span.at_rate(rate, blur)
    length = span.length
    padded_length = 2 * length
    window = span.window()
    lags = span.lags()
    omega = 2.0 * np.pi * fft.rfftfreq(padded_length)
    sounds_as_found = span.cut(value, sample)
    spectra = fft.rfft(sounds_as_found, padded_length)
    count = len(sample)
    known = np.ones((count, padded_length))
    if clipped is not None:
        known[:, :length] = 1.0 - span.cut(clipped, sample)

    shift = np.zeros(count)
    deviation = np.zeros(count)
    sounds = np.pad(sounds_as_found, ((0, 0), (0, length)))
    common = sounds[int(np.argmax(sounds**2 @ window))]  # at first the loudest
    gain = np.array([_gain(sound, common, window) for sound in sounds])
    for turn in range(_ROUNDS):
        for touch in range(count):
            if turn > 0:  # the mean of the others
                gain_of_others = gain.copy()
                gain_of_others[touch] = 0.0
                common = _mean(sounds, gain_of_others)
            slope = fft.irfft(1j * omega * fft.rfft(common), padded_length)
            # the common sound is known only where all sounds are
            known_as_shifted = [
                _moved(samples, by) for samples, by in zip(known, shift, strict=True)
            ]
            unclipped = window * np.prod(known_as_shifted, axis=0)
            noise = _noise_variance(sounds, gain, touch, slope, unclipped)
            energy = np.maximum(span.correlation(window, common**2), _TINY)
            match = np.maximum(span.correlation(window * sounds[touch], common), 0.0)
            # the prior of a shift is normal, with half the reach as its deviation
            prior = 0.5 * ((shift[touch] + lags) / (0.5 * span.reach)) ** 2
            log_likelihood = match**2 / energy / (2.0 * noise) - prior
            step, deviation[touch] = _most_likely(log_likelihood, lags, span)
            shift[touch] = np.clip(shift[touch] + step, -span.reach, span.reach)
            turned = spectra[touch] * np.exp(1j * omega * shift[touch])
            sounds[touch] = fft.irfft(turned, padded_length)
            gain[touch] = _gain(sounds[touch], common, window)
    # what the sounds have in common is where they were found, in the mean
    mean_shift = shift @ gain**2 / max(float(gain @ gain), _TINY)
    return sample + shift - mean_shift, deviation


class _Span(NamedTuple):
    """The part of a record around a touch that is compared, in samples.

    Samples before the touch and after it, how far its time may move to either side, and how many
    lags there are in a sample.
    """

    before: int
    after: int
    reach: int
    lags_per_sample: int

    @classmethod
    def at_rate(cls, rate: float, blur: float) -> _Span:
        """Return the span of records with a rate [Hz], which a coder has blurred [s]."""
        return cls(
            max(2, round(_BEFORE * rate)),
            max(2, round(_AFTER * rate)),
            max(2, round(max(_LEAST_REACH, blur) * rate)),
            max(1, round(_FINE_RATE / rate)),
        )

    @property
    def length(self) -> int:
        """Samples that are cut out for each touch."""
        return self.before + self.after + 2 * self.reach

    def cut(self, samples: NDArray[Any], touches: Indices) -> NDArray[Any]:
        """Return the samples around touches, (n, length), with zeros beyond the record."""
        padded = np.pad(samples, self.length)
        firsts = [touch + self.length - self.before - self.reach for touch in touches]
        return np.stack([padded[first : first + self.length] for first in firsts])

    def window(self) -> Floats:
        """Return the weights of samples in the comparison, (2 length,): rising, then falling."""
        window = np.zeros(2 * self.length)
        touch = self.reach + self.before
        rising = 0.5 * np.pi * (np.arange(self.before) + 0.5) / self.before
        falling = 0.5 * np.pi * (np.arange(self.after) + 0.5) / self.after
        window[self.reach : touch] = np.sin(rising) ** 2
        window[touch : self.length - self.reach] = np.cos(falling) ** 2
        return window

    def lags(self) -> Floats:
        """Return the lags at which correlations are computed, in samples."""
        last = self.reach * self.lags_per_sample
        return np.arange(-last, last + 1) / self.lags_per_sample

    def correlation(self, reference: Floats, moved: Floats) -> Floats:
        """Return the sums over a reference and a moved signal at each of the lags."""
        spectrum = fft.rfft(reference) * np.conj(fft.rfft(moved))
        # zeros at higher frequencies interpolate between the samples
        at_all_lags = self.lags_per_sample * fft.irfft(
            spectrum, 2 * self.length * self.lags_per_sample
        )
        last = self.reach * self.lags_per_sample
        return np.asarray(np.roll(at_all_lags, last)[: 2 * last + 1])


def _most_likely(log_likelihood: Floats, lags: Floats, span: _Span) -> tuple[float, float]:
    """Return the most likely lag and its standard deviation, in samples."""
    top = int(np.clip(np.argmax(log_likelihood), 1, len(lags) - 2))
    peak = slice(top - 1, top + 2)
    # a parabola through the highest value and its neighbours
    earlier, highest, later = log_likelihood[peak]
    curvature = max(float(2.0 * highest - earlier - later), _TINY)
    offset = float(np.clip(0.5 * (later - earlier) / curvature, -1.0, 1.0))
    lag = lags[top] + offset / span.lags_per_sample
    # a parabola of the logarithm is a normal distribution, whose variance is the inverse curvature
    own_variance = 1.0 / curvature / span.lags_per_sample**2
    own_variance = min(own_variance, float(span.reach) ** 2)
    # likelihoods that are left beside this peak are those of other periods of the sound
    likelihood = np.exp(log_likelihood - highest)
    likelihood[peak] = 0.0
    second_moment = likelihood @ (lags - lag) ** 2
    variance_of_others = float(second_moment / (1.0 + likelihood.sum()))
    return lag, np.sqrt(max(own_variance, variance_of_others) + _RESOLUTION**2)


def _gain(sound: Floats, common: Floats, window: Floats) -> float:
    """Return the multiple of the common sound nearest to a sound, by least squares; 0 at least."""
    return max(float(sound @ (window * common)), 0.0) / max(float(common**2 @ window), _TINY)


def _mean(sounds: Floats, gain: Floats) -> Floats:
    """Return the common sound of least squares, of which each sound is a multiple."""
    return np.asarray(gain @ sounds / max(float(gain @ gain), _TINY))


def _moved(known: Floats, shift: float) -> Floats:
    """Return which samples of a sound are known once it is shifted between its samples."""
    if known.all():
        return known
    whole = int(np.floor(shift))
    # a sample between two others is known if both are
    return np.asarray(np.roll(known, -whole) * np.roll(known, -whole - 1))


def _noise_variance(
    sounds: Floats, gain: Floats, touch: int, slope: Floats, window: Floats
) -> float:
    """Return the variance of samples as it counts for the shift of a touch.

    It is that of what is left of its sound without the common one, where the slope of that is.
    """
    sound = sounds[touch]
    common = _mean(sounds, gain)
    residual = window * (sound - common * _gain(sound, common, window))
    residual_power = np.abs(fft.rfft(residual)) ** 2
    slope_power = np.abs(fft.rfft(window * slope)) ** 2
    # the noise that moves the sound is that in the band of its slope
    in_band = 2.0 * float(residual_power @ slope_power)
    power = in_band / len(window) / float(window @ window)
    slope_energy = float(slope**2 @ window)
    variance = power / max(slope_energy, _TINY)
    # what is common is in part this sound, noise and all
    share = float(gain[touch] ** 2) / max(float(gain @ gain), _TINY)
    left_by_mean = max(1.0 - share, 0.1)
    # of the few numbers that a sound has in its own band, its size and time are fitted
    freedom = _freedom(window, slope_power)
    left_by_fit = max(1.0 - 2.0 / max(freedom, _TINY), 0.25)
    return max(variance / (left_by_mean * left_by_fit), _TINY)


def _freedom(window: Floats, power: Floats) -> float:
    """Return how many independent numbers a windowed signal with a power spectrum has.

    A window of unequal weights has as few samples as an even one with the same sums of squares and
    fourth powers; so it is with the lines of the spectrum.
    """
    samples = float((window**2).sum() ** 2 / (window**4).sum())
    freedom = 2.0 * samples / len(window) * float(power.sum()) ** 2
    return freedom / max(float(power @ power), _TINY)
