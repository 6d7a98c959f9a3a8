r"""The electronics behind an instrument: an amplifier with noise and hum, and a converter.

.. math:: y = Q\bigl(g\,(x + n + h \cos(2 \pi f_m t + \theta))\bigr)

with white noise n and the phase of the hum drawn from the seed, the gain g, and the converter's
clipping and rounding Q.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats

Seed = int | tuple[int, ...]


@dataclass(frozen=True)
class Amplifier:
    """An amplifier; noise and hum are referred to its input.

    Parameters
    ----------
    gain : float, default 1
        Output over input [-], > 0.
    noise : float, default 0
        Standard deviation of white noise in the samples, in the unit of the instrument.
    hum : float, default 0
        Amplitude of the hum, in the same unit; its phase is drawn.
    mains : float, default 50
        Frequency of the mains [Hz], > 0.
    seed : int or tuple of int, default 0
        Of noise and phase; sensors of different names have their own.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> amplifier = vi.sensors.Amplifier(gain=100.0, noise=2e-3, hum=0.01)
    >>> vi.sensors.Sensor("a1", amplifier=amplifier).amplifier.gain
    100.0
    """

    gain: float = 1.0
    noise: float = 0.0
    hum: float = 0.0
    mains: float = 50.0
    seed: Seed = 0


@dataclass(frozen=True)
class Converter:
    """An analogue-to-digital converter.

    Parameters
    ----------
    range : float
        Largest magnitude that it reads, in the unit of the amplifier's output, > 0; beyond it the
        samples are clipped.
    bits : int, optional
        Its width [-]: of 2 range in so many bits is a step; without it the samples are not rounded.

    Examples
    --------
    >>> Converter(range=8.0, bits=4).read(np.array([0.4, 0.6, 7.9, -9.0])).tolist()
    [0.0, 1.0, 7.0, -8.0]
    """

    range: float
    bits: int | None = None

    @property
    def step(self) -> float:
        """The step of its readings, in the unit of its range; zero if it does not round."""
        if self.bits is None:
            return 0.0
        return math.ldexp(self.range, 1 - self.bits)

    def read(self, value: Floats) -> Floats:
        """Return the readings of samples.

        The upper end of the range is a step below the lower one's magnitude, as of any two's
        complement.
        """
        if self.step:
            value = self.step * np.round(value / self.step)
        return np.clip(value, -self.range, self.range - self.step)


def amplified(amplifier: Amplifier, name: str, value: Floats, rate: float, passed: float) -> Floats:
    """Return samples of an instrument behind an amplifier.

    Parameters
    ----------
    amplifier : Amplifier
        The amplifier.
    name : str
        Name of the sensor.
    value : array, shape (samples,)
        Samples, from the start on.
    rate : float
        Samples per second [Hz].
    passed : float
        Gain of the anti-alias filter at the frequency of the mains [-].
    """
    seed = [zlib.crc32(f"amplifier of {name}".encode()), *seeds(amplifier.seed)]
    generator = np.random.default_rng(seed)
    hum_phase = generator.uniform(0.0, 2.0 * math.pi)
    if amplifier.hum:
        radians_per_sample = 2.0 * math.pi * amplifier.mains / rate
        hum = np.cos(radians_per_sample * np.arange(len(value)) + hum_phase)
        value = value + passed * amplifier.hum * hum
    if amplifier.noise:
        value = value + amplifier.noise * generator.standard_normal(len(value))
    return amplifier.gain * value


def seeds(seed: Seed) -> Sequence[int]:
    """Return a seed as a sequence."""
    return seed if isinstance(seed, tuple) else (seed,)
