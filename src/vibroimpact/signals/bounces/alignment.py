"""Times of touches below a sample, by what their sounds have in common."""

from __future__ import annotations

import numpy as np
from scipy import fft

from vibroimpact.arrays import Bools, Floats, Indices

_BEFORE, _AFTER, _ASIDE = 0.5e-3, 3e-3, 1e-3
"""What of a touch is compared, before and after it, and how far its time may move at least [s]."""

_FINE = 400e3
"""Rate at which correlations are computed [Hz]; between its samples they are parabolas."""

_ROUNDS = 6

_RESOLVED = 1e-4
"""Standard deviation of what interpolation between samples can tell of sounds below half
the rate, in samples.
"""

_TINY = 1e-300


def aligned(
    value: Floats, rate: float, sample: Indices, blur: float = 0.0, clipped: Bools | None = None
) -> tuple[Floats, Floats]:
    r"""Return the times of touches, and their standard deviations.

    The sounds of bounces are alike: each is shifted to where it correlates best with the mean of
    the others, s (Woody 1967, Med. Biol. Eng.
    5:539). A shift at which their correlation is c has, in noise of variance v, the likelihood
    :math:`\exp(c^2 / (2 v \sum s^2))`; its
    standard deviation includes that it may be a period off. The noise is what is left of a sound
    when the common one is taken from it: noise, clicks and differences in shape alike.

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
    before, after, aside = (
        max(2, round(span * rate)) for span in (_BEFORE, _AFTER, max(_ASIDE, blur))
    )
    length = before + after + 2 * aside
    padded = np.pad(value, length)
    parts = np.stack(
        [padded[at + length - before - aside : at + 2 * length - before - aside] for at in sample]
    )
    window = np.zeros(2 * length)
    window[aside : aside + before] = np.sin(0.5 * np.pi * (np.arange(before) + 0.5) / before) ** 2
    window[aside + before : length - aside] = (
        np.cos(0.5 * np.pi * (np.arange(after) + 0.5) / after) ** 2
    )
    spectra, omega = fft.rfft(parts, 2 * length), 2.0 * np.pi * fft.rfftfreq(2 * length)
    more = max(1, round(_FINE / rate))
    lags = np.arange(-aside * more, aside * more + 1) / more

    def correlation(one: Floats, other: Floats) -> Floats:
        """Return the sums over one and the other at a lag before, at all lags."""
        fine = more * fft.irfft(fft.rfft(one) * np.conj(fft.rfft(other)), 2 * length * more)
        return np.asarray(np.roll(fine, aside * more)[: len(lags)])

    number = len(parts)
    known = np.ones((number, 2 * length))
    if clipped is not None:
        whole = np.pad(clipped, length)
        pieces = [
            whole[at + length - before - aside : at + 2 * length - before - aside] for at in sample
        ]
        known[:, :length] = 1.0 - np.stack(pieces)
    shift, deviation = np.zeros(number), np.zeros(number)
    sounds = np.pad(parts, ((0, 0), (0, length)))
    common = sounds[int(np.argmax(sounds**2 @ window))]  # at first the loudest
    size = np.array([_multiple(sound, common, window) for sound in sounds])
    for turn in range(_ROUNDS):
        for one in range(number):
            if turn:
                common = _mean(sounds, np.where(np.arange(number) == one, 0.0, size))
            energy = np.maximum(correlation(window, common**2), _TINY)
            match = np.maximum(correlation(window * sounds[one], common), 0.0)
            unclipped = window * np.prod(
                [_moved(own, by) for own, by in zip(known, shift, strict=True)], axis=0
            )
            noise = _noise(
                sounds, size, one, fft.irfft(1j * omega * fft.rfft(common), 2 * length), unclipped
            )
            chance = (
                match**2 / energy / (2.0 * noise) - 0.5 * ((shift[one] + lags) / (0.5 * aside)) ** 2
            )
            top = int(np.clip(np.argmax(chance), 1, len(lags) - 2))
            left, middle, right = chance[top - 1 : top + 2]
            bend = max(float(2.0 * middle - left - right), _TINY)
            ahead = lags[top] + float(np.clip(0.5 * (right - left) / bend, -1.0, 1.0)) / more
            # the width of this peak, or what lies in others
            weight = np.exp(chance - middle)
            weight[top - 1 : top + 2] = 0.0
            spread = float(weight @ (lags - ahead) ** 2 / (1.0 + weight.sum()))
            deviation[one] = np.sqrt(
                max(min(1.0 / bend / more**2, float(aside) ** 2), spread) + _RESOLVED**2
            )
            shift[one] = np.clip(shift[one] + ahead, -aside, aside)
            sounds[one] = fft.irfft(spectra[one] * np.exp(1j * omega * shift[one]), 2 * length)
            size[one] = _multiple(sounds[one], common, window)
    # what the sounds have in common is where they were found, in the mean
    return sample + shift - shift @ size**2 / max(float(size @ size), _TINY), deviation


def _multiple(sound: Floats, common: Floats, window: Floats) -> float:
    """Return the multiple of the common sound that a sound is, by least squares; 0 if
    that is negative.
    """
    return max(float(sound @ (window * common)), 0.0) / max(float(common**2 @ window), _TINY)


def _mean(sounds: Floats, size: Floats) -> Floats:
    """Return the common sound of least squares, of which each sound is a multiple."""
    return np.asarray(size @ sounds / max(float(size @ size), _TINY))


def _moved(known: Floats, shift: float) -> Floats:
    """Return which samples of a sound are known once it is shifted between its samples."""
    if known.all():
        return known
    first = int(np.floor(shift))
    return np.asarray(np.roll(known, -first) * np.roll(known, -first - 1))


def _noise(sounds: Floats, size: Floats, one: int, slope: Floats, window: Floats) -> float:
    """Return the variance of samples as it counts for a shift: of what is left of a sound
    without the common one, where its slope is.
    """
    every = _mean(sounds, size)
    left = window * (sounds[one] - every * _multiple(sounds[one], every, window))
    # what is common is in part this sound, noise and all
    share = float(size[one] ** 2) / max(float(size @ size), _TINY)
    spectrum = np.abs(fft.rfft(window * slope)) ** 2
    power = (
        2.0 * float(np.abs(fft.rfft(left)) ** 2 @ spectrum) / len(window) / float(window @ window)
    )
    # of the few numbers that a sound has in its own band, its size and time are fitted
    samples = float((window**2).sum() ** 2 / (window**4).sum())
    freedom = (
        2.0
        * samples
        / len(window)
        * float(spectrum.sum()) ** 2
        / max(float(spectrum @ spectrum), _TINY)
    )
    known = max(1.0 - share, 0.1) * max(1.0 - 2.0 / max(freedom, _TINY), 0.25)
    return max(power / max(float(slope**2 @ window), _TINY) / known, _TINY)
