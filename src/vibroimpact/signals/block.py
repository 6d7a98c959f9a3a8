"""A block of signals of equal length with what several features need of them.

Spectrum, envelope and packets are each computed once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

from vibroimpact.arrays import Complex, Floats
from vibroimpact.signals.envelope import hilbert_envelope
from vibroimpact.signals.packets import DEAD_TIME, THRESHOLD, Packets, packets_in


@dataclass(frozen=True)
class Block:
    """Finite signals of one length and rate.

    Parameters
    ----------
    value : array, shape (n, samples)
        The signals; with one sample at least.
    rate : float
        Sampling rate [Hz].
    given : array, shape (n,), optional
        Given threshold of each envelope; by default a tenth of its largest value.
    dead_time : float, default 5e-3
        Dead time of packets [s].
    recorded : array, shape (n, samples), optional
        The signals as they were recorded, at any scale, if a baseline was removed from them.
    """

    value: Floats
    rate: float
    given: Floats | None = None
    dead_time: float = DEAD_TIME
    recorded: Floats | None = None

    @property
    def samples(self) -> int:
        """Number of samples of a signal."""
        return int(self.value.shape[1])

    @cached_property
    def magnitude(self) -> Floats:
        """Magnitudes of the samples, (n, samples)."""
        return np.abs(self.value)

    @cached_property
    def peak(self) -> Floats:
        """Largest magnitude, (n,)."""
        return np.asarray(self.magnitude.max(axis=1))

    @cached_property
    def square_sum(self) -> Floats:
        """Sum of the squares of the samples, (n,)."""
        return np.asarray(np.einsum("ij,ij->i", self.value, self.value))

    @cached_property
    def transform(self) -> Complex:
        """Fourier transform at frequencies from zero to half the rate, (n, samples // 2 + 1)."""
        return np.asarray(fft.rfft(self.value))

    @cached_property
    def frequency(self) -> Floats:
        """Frequencies of the transform [Hz]."""
        return np.asarray(fft.rfftfreq(self.samples, 1.0 / self.rate))

    @cached_property
    def power(self) -> Floats:
        """Energy at the frequencies of the transform.

        The sum over them is that of the squares of the samples (Parseval).
        """
        power = (self.transform.real**2 + self.transform.imag**2) / self.samples
        # all but zero and half the rate have a negative frequency of the same energy
        power[:, 1 : (self.samples + 1) // 2] *= 2.0
        return np.asarray(power)

    @cached_property
    def envelope(self) -> Floats:
        """Hilbert envelopes, (n, samples)."""
        return hilbert_envelope(self.value)

    @cached_property
    def threshold(self) -> Floats:
        """Threshold of the envelope, (n,)."""
        if self.given is not None:
            return self.given
        return np.asarray(THRESHOLD * self.envelope.max(axis=1))

    @cached_property
    def packets(self) -> Packets:
        """Packets of the signals."""
        return packets_in(self.value, self.envelope, self.threshold, self.rate, self.dead_time)
