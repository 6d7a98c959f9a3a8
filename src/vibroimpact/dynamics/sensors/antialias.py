"""Anti-alias filters of a sensor: a converter's linear-phase filter, an analogue low-pass, or none.

"sigma-delta" is the decimation filter of a delta-sigma converter: a linear-phase low-pass of 66
sampling periods, here the ideal one at half the rate under J. F. Kaiser's window (Nonrecursive
digital filter design using the I0-sinh window function, Proc. IEEE Int. Symp. Circuits and Systems,
1974): from 0 to 0.45 of the rate flat within 0.001 dB, from 0.55 of it on at least 100 dB down. Its
delay of 33 samples is compensated, so that a sample also depends a little on later times.
"butterworth" is S. Butterworth's low-pass of order eight (On the theory of filter amplifiers,
Experimental Wireless 7:536, 1930), causal and with its delay. "none" takes the values at the
sampling instants, so that higher frequencies alias into the band.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.instruments.pole_pairs import PolePairs, Section
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor

HALF_LENGTH = 33
"""Half width of the converter's kernel in sampling periods."""
FINENESS = 8
"""Points per sampling period of tables of the kernel and of its responses."""
# Kaiser's parameter: 102 dB, and with this length a transition band of a tenth of the rate
_KAISER = 10.4
_ORDER = 8


@dataclass(frozen=True)
class AntiAlias:
    """An anti-alias filter.

    `half_length`: half width of its linear-phase kernel in samples, zero if it has none.
    `sections`: its pairs of poles.
    """

    half_length: int = 0
    sections: tuple[Section, ...] = ()


def antialias_of(sensor: Sensor) -> AntiAlias:
    """Return the anti-alias filter of a sensor.

    Examples
    --------
    >>> (
    ...     antialias_of(Sensor("a")).half_length,
    ...     len(antialias_of(Sensor("a", filter="butterworth")).sections),
    ... )
    (33, 4)
    """
    if sensor.filter == "sigma-delta":
        return AntiAlias(half_length=HALF_LENGTH)
    if sensor.filter == "butterworth":
        return AntiAlias(sections=butterworth(sensor.passed))
    return AntiAlias()


def butterworth(corner: float) -> tuple[Section, ...]:
    """Return the pairs of poles of a Butterworth low-pass of order eight.

    It has a gain of 1 / sqrt(2) at the corner frequency [Hz].
    """
    omega = 2.0 * math.pi * corner
    angles = (math.pi * (2.0 * number + 1.0) / (2.0 * _ORDER) for number in range(_ORDER // 2))
    return tuple((omega**2, 2.0 * omega * math.sin(angle)) for angle in angles)


def gain_at(sensor: Sensor, frequency: float) -> float:
    """Return the gain of the anti-alias filter of a sensor at a frequency [Hz].

    Examples
    --------
    >>> (
    ...     round(gain_at(Sensor("a", filter="butterworth", corner=50.0), 50.0), 6),
    ...     round(gain_at(Sensor("a"), 50.0), 4),
    ... )
    (0.707107, 1.0)
    """
    if sensor.filter == "butterworth":
        return 1.0 / math.sqrt(1.0 + (frequency / sensor.passed) ** (2 * _ORDER))
    if sensor.filter == "none":
        return 1.0
    x = np.arange(-HALF_LENGTH * FINENESS, HALF_LENGTH * FINENESS + 1) / FINENESS
    return abs(float(kernel(x) @ np.cos(2.0 * math.pi * frequency / sensor.rate * x))) / FINENESS


def kernel(x: Floats) -> Floats:
    """Return the converter's kernel at times in sampling periods, per sampling period.

    Examples
    --------
    >>> x = np.arange(-HALF_LENGTH * 8, HALF_LENGTH * 8 + 1) / 8
    >>> round(float(kernel(x).sum() / 8), 5)  # unit gain at frequency zero
    1.0
    """
    window = np.i0(_KAISER * np.sqrt(np.maximum(1.0 - (x / HALF_LENGTH) ** 2, 0.0))) / np.i0(
        _KAISER
    )
    return np.asarray(np.where(np.abs(x) <= HALF_LENGTH, np.sinc(x) * window, 0.0))


def kernel_derivatives() -> Floats:
    """Return the kernel and its first two derivatives per sampling period, (3, points).

    There are `FINENESS` points per period.
    """
    cells = 2 * HALF_LENGTH * FINENESS
    values = kernel(np.arange(-HALF_LENGTH * FINENESS, HALF_LENGTH * FINENESS + 1) / FINENESS)
    # derivatives by the Fourier transform, zero padded against circular wrap-around
    size = 2 * cells
    spectrum = np.fft.rfft(values, size)
    factor = 2j * np.pi * np.fft.rfftfreq(size, 1.0 / FINENESS)
    factor[-1] = 0.0
    first, second = (np.fft.irfft(spectrum * factor**order, size)[: cells + 1] for order in (1, 2))
    return np.stack([values, first, second])


def parallel(sections: tuple[Section, ...]) -> list[tuple[Floats, Section]]:
    """Return the partial fractions of a low-pass of pairs of poles.

    They are given as the numerator a + b s of each pair, (2,), and the pair.
    """
    fractions = []
    for number, (stiffness, damping) in enumerate(sections):
        poles = PolePairs(np.array([stiffness]), np.array([damping]))
        numerator = stiffness * poles.low_pass([*sections[:number], *sections[number + 1 :]])
        fractions.append((numerator[:, 0], sections[number]))
    return fractions
