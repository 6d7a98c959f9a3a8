r"""Tabulated motions of a plate as sums of harmonic ones, which pass through every sample.

A displacement that is sampled at N + 1 equal steps over a time T is a sum of cosines
:math:`c_k \cos(\pi k t/T)`, by the discrete cosine transform of the first kind. Their sum goes on
evenly beyond both ends, where it would have a kink. Six harmonic motions of the frequencies
:math:`(m + 1/2)/(2T)` take the slopes and the third derivatives there, so that the coefficients of
a smooth record fall with the sixth power of k. They are those whose remainder is least in the upper
quarter of the frequencies.

One period of a motion that repeats is a trigonometric polynomial.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.statement.plate_motion import PlateMotion

# of the largest acceleration: what all harmonic motions that are left out may add up to
_NEGLIGIBLE = 1e-6

_SIGNIFICANT = 10.0  # of the standard deviation of the noise: what is more is no noise

_HALF_WAVES = np.array([2, 4, 8])
"""The m of the motions that take the slopes and the third derivatives at the ends.

They are as many times more as N has 128ths.
"""


def tabulated_motion(
    step: float, displacement: Floats, direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
) -> PlateMotion:
    """Return a motion through samples of the displacement at equal steps, from its mean position.

    Parameters
    ----------
    step : float
        Time between samples [s], the first of which is at time zero.
    displacement : array, shape (samples,)
        Displacement along the direction [m], at least 33.
    direction : tuple of three floats, default (0, 0, 1)
        Unit vector of the motion.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 201)
    >>> motion = tabulated_motion(0.005, 0.001 * np.sin(30.0 * time))
    >>> offset = (motion.at(time)[0] - 0.001 * np.sin(30.0 * time)).mean()
    >>> bool(np.allclose(motion.at(0.7031)[0] - offset, 0.001 * np.sin(30.0 * 0.7031), rtol=1e-6))
    True
    """
    from scipy.fft import dct  # here, as few plates are shaken

    last = len(displacement) - 1
    order = np.arange(last + 1)
    length = step * last
    time = step * order
    # sines have a slope at the start alone, and cosines at the end alone; their means cancel in
    # pairs
    half_waves = _HALF_WAVES * (1 + last // 128) + 0.5
    omega = half_waves * np.pi / length
    angles = omega[:, None] * time
    waves = np.concatenate([np.sin(angles), np.cos(angles)])
    # integrals over the record: 1/omega of a sine, as its cosine is zero at the end
    means = np.concatenate([1.0 / omega, np.sin(omega * length) / omega])
    neighbours = [[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]]
    pairs = np.kron(np.eye(2), neighbours) / means
    spectra = dct(np.vstack([pairs @ waves, displacement]), 1, axis=1) / last
    pair_spectra = spectra[:-1]
    spectrum = spectra[-1]
    # by least squares in the upper quarter, without what is lost in the noise of the samples
    upper = order > 3 * last // 4
    left, singular_values, right = np.linalg.svd(pair_spectra[:, upper].T, full_matrices=False)
    components = spectrum[upper] @ left
    noise = float(np.std(spectrum[upper] - left @ components))
    significant = np.where(np.abs(components) > _SIGNIFICANT * noise, components, 0.0)
    pair_amplitudes = significant / singular_values @ right
    cosines = spectrum - pair_amplitudes @ pair_spectra
    cosines[-1] *= 0.5  # the first kind counts the last cosine twice
    cosine_omega = np.pi / length * order[1:]
    frequency = np.concatenate([omega, omega, cosine_omega]) / (2.0 * np.pi)
    amplitude = np.concatenate([pair_amplitudes @ pairs, cosines[1:]])
    # an amplitude is positive: half a turn of the phase stands for its sign
    is_sine = np.arange(len(amplitude)) < len(omega)
    phase = np.where(is_sine, 0.0, 0.5 * np.pi) + np.pi * (amplitude < 0.0)
    return _motion(np.abs(amplitude), frequency, phase, direction)


def periodic_motion(
    step: float, displacement: Floats, direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
) -> PlateMotion:
    """Return the motion through samples of one period of the displacement at equal steps.

    It is counted from its mean position, and is the trigonometric polynomial of least degree
    through the samples.

    Parameters
    ----------
    step : float
        Time between samples [s], the first of which is at time zero, and comes again one step after
        the last.
    displacement : array, shape (samples,)
        Displacement along the direction [m].
    direction : tuple of three floats, default (0, 0, 1)
        Unit vector of the motion.

    Examples
    --------
    >>> time = np.arange(100) * 0.001
    >>> motion = periodic_motion(0.001, 0.002 * np.sin(2.0 * np.pi * 30.0 * time + 0.5))
    >>> (
    ...     motion.frequency.round(9).tolist(),
    ...     motion.amplitude.round(9).tolist(),
    ...     motion.phase.round(9).tolist(),
    ... )
    ([30.0], [0.002], [0.5])
    """
    number = len(displacement)
    spectrum = np.fft.rfft(displacement)[1:] / number
    order = np.arange(1, len(spectrum) + 1)
    # a real spectrum has two halves, which meet at half the sampling rate
    amplitude = np.abs(spectrum) * np.where(2 * order == number, 1.0, 2.0)
    frequency = order / (number * step)
    return _motion(amplitude, frequency, np.angle(spectrum) + 0.5 * np.pi, direction)


def _motion(
    amplitude: Floats, frequency: Floats, phase: Floats, direction: tuple[float, float, float]
) -> PlateMotion:
    """Return a motion without those of its harmonic parts that hardly add to its acceleration."""
    acceleration = amplitude * frequency**2
    ascending = np.argsort(acceleration)
    considerable = np.cumsum(acceleration[ascending]) > _NEGLIGIBLE * acceleration.max()
    kept = np.sort(ascending[considerable])
    return PlateMotion(
        amplitude=amplitude[kept], frequency=frequency[kept], phase=phase[kept], direction=direction
    )


def integrated_twice(step: float, acceleration: Floats) -> Floats:
    """Return the displacement [m] of samples of an acceleration at equal steps [s], (samples,).

    The parabola that fits the displacement best is taken away: an accelerometer knows neither the
    velocity at the start nor its own zero.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 2001)
    >>> found = integrated_twice(0.0005, -400.0 * np.sin(200.0 * np.pi * time))
    >>> round(float(np.ptp(found)) * (200.0 * np.pi) ** 2 / 800.0, 1)
    1.0
    """
    from scipy.interpolate import CubicSpline

    time = step * np.arange(len(acceleration))
    displacement = CubicSpline(time, acceleration).antiderivative(2)(time)
    parabola = np.polynomial.Polynomial.fit(time, displacement, 2)
    return np.asarray(displacement - parabola(time))


def integrated_twice_over_period(step: float, acceleration: Floats) -> Floats:
    """Return the displacement [m] of samples of one period of an acceleration, (samples,).

    The samples are taken at equal steps [s]. The means of acceleration, velocity and displacement
    are taken for zero, as they are for a motion that stays where it is.

    Examples
    --------
    >>> time = np.arange(50) / 50.0
    >>> found = integrated_twice_over_period(
    ...     0.02, -((6.0 * np.pi) ** 2) * np.cos(6.0 * np.pi * time)
    ... )
    >>> bool(np.allclose(found, np.cos(6.0 * np.pi * time)))
    True
    """
    spectrum = np.fft.rfft(acceleration)
    spectrum[0] = 0.0
    omega = 2.0 * np.pi * np.fft.rfftfreq(len(acceleration), step)[1:]
    spectrum[1:] /= -(omega**2)
    return np.fft.irfft(spectrum, len(acceleration))
