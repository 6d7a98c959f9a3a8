"""The Hilbert envelope of signals."""

from __future__ import annotations

import numpy as np
from scipy import fft

from vibroimpact.arrays import Floats


def hilbert_envelope(value: Floats) -> Floats:
    """Return the magnitude of the analytic signals of real signals, along the last axis.

    Before and after the samples the signals are taken as zero: a signal that begins at its first
    sample does not leak into its end, as it would if the record were taken as a period.

    Parameters
    ----------
    value : array, shape (..., samples)
        The signals, of one sample at least.

    Returns
    -------
    array, shape (..., samples)
        The envelopes, nowhere below the magnitude of the signal.

    References
    ----------
    Marple, S. L. (1999). Computing the discrete-time "analytic" signal via FFT. IEEE Trans. Signal
    Process. 47, 2600-2603.

    Examples
    --------
    >>> tone = 3.0 * np.sin(2.0 * np.pi * np.arange(4096) / 8)
    >>> hilbert_envelope(tone)[2000:2004].round(2).tolist()
    [3.0, 3.0, 3.0, 3.0]
    """
    samples = value.shape[-1]
    length = fft.next_fast_len(2 * samples, real=True)
    length += length % 2
    # the analytic signal has no negative frequencies: its imaginary part is the transform of the
    # spectrum turned by a quarter
    spectrum = fft.rfft(value, length)
    spectrum *= -1j
    spectrum[..., 0] = spectrum[..., -1] = 0.0
    return np.asarray(np.hypot(value, fft.irfft(spectrum, length)[..., :samples]))
