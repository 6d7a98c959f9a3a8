r"""Sums of decaying tones in a band of frequencies, fitted to the spectra of records.

A tone :math:`2 \operatorname{Re}(c\,p^n)`, :math:`p = e^s`, of N samples has the discrete Fourier transform

.. math:: X_k = c\,g(s) + \bar c\,g(\bar s), \qquad g(s) = \frac{1 - e^{s N}}{1 - e^{s - 2 \pi i k / N}}

exactly, and white noise has independent values of one variance there, so that a fit to the bins of a band by least squares is that of the
greatest likelihood. What tones outside the band leave in it is smooth, a polynomial in k. Amplitudes are eliminated (variable projection:
Golub and Pereyra 1973, SIAM J. Numer. Anal. 10:413; its derivatives after Kaufman 1975, BIT 15:49).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, signal

from vibroimpact.arrays import Complex, Floats
from vibroimpact.signals.inverse.gauss_newton import gauss_newton

_SMOOTH = 4
"""Number of coefficients of the polynomial."""
_MOST = 24
"""Largest number of tones in a band."""
_DECAYS = np.geomspace(0.5, 200.0, 7)
"""Decays over the record, in nepers, at which a further tone is sought."""
_ROUNDS, _SAME = 6, 0.02
"""Most fits, each with the noise that the one before left, and relative change of the ratios of channels that ends them."""
_LARGEST_STEPS = np.array([0.7, 3.0])
"""Largest change in a step: of the logarithm of the decay, and of the frequency in bins."""


@dataclass(frozen=True)
class Tones:
    """Decaying tones in a band.

    Parameters
    ----------
    decay, frequency : array, shape (n,)
        Nepers per sample, and radians per sample.
    covariance : array, shape (n, 2, 2)
        Covariance of the logarithm of the decay and the frequency of each.
    amplitude : array of complex, shape (n, S)
        c of each in each channel.
    noise : array, shape (S,)
        Standard deviation of white noise of the samples that would leave as much in the band.
    """

    decay: Floats
    frequency: Floats
    covariance: Floats
    amplitude: Complex
    noise: Floats

    def part(self, which: NDArray[np.bool_]) -> Tones:
        """Return some of the tones."""
        return Tones(self.decay[which], self.frequency[which], self.covariance[which], self.amplitude[which], self.noise)


@dataclass(frozen=True)
class Bins:
    """Spectra in a band.

    Parameters
    ----------
    omega : array, shape (bins,)
        Radians per sample.
    value : array, shape (S, bins)
        Discrete Fourier transform of each channel.
    samples : int
        Number of samples.
    floor : array, shape (S,)
        Least standard deviation of the noise of the samples.
    """

    omega: Floats
    value: Complex
    samples: int
    floor: Floats

    @property
    def step(self) -> float:
        """Distance of bins."""
        return 2.0 * np.pi / self.samples

    @property
    def rows(self) -> Floats:
        """Real and imaginary parts of each channel, (2 bins, S), of unit variance under noise of unit variance of the samples."""
        return np.asarray(_parts(self.value.T) / np.sqrt(0.5 * self.samples))

    def without(self, tones: Tones) -> Bins:
        """Return the spectra without tones that are known."""
        s = -tones.decay + 1j * tones.frequency
        upper, lower = (self._transform(one)[0] for one in (s, s.conj()))
        return replace(self, value=self.value - (upper @ tones.amplitude + lower @ tones.amplitude.conj()).T)

    def smooth(self) -> Floats:
        """Return the columns of what tones outside the band leave, (2 bins, columns)."""
        place = np.linspace(-1.0, 1.0, len(self.omega))
        powers = np.polynomial.legendre.legvander(place, _SMOOTH - 1)
        return np.block([[powers, np.zeros_like(powers)], [np.zeros_like(powers), powers]])

    def columns(self, tones: Floats) -> tuple[Floats, Floats]:
        """Return the columns of tones, (2 bins, n, 2), and their derivatives in both parameters, (2 bins, n, 2, 2).

        Parameters
        ----------
        tones : array, shape (n, 2)
            Logarithm of the decay and frequency in bins of each.
        """
        decay = np.exp(tones[:, 0])
        s = -decay + 1j * self.step * tones[:, 1]
        (upper, upper_slope), (lower, lower_slope) = (self._transform(one) for one in (s, s.conj()))
        scale = 1.0 / np.sqrt(0.5 * self.samples)
        columns = np.stack([upper + lower, 1j * (upper - lower)], axis=-1)
        rates = ((-decay, -decay), (1j * self.step, -1j * self.step))
        slopes = [np.stack([a * upper_slope + b * lower_slope, 1j * (a * upper_slope - b * lower_slope)], axis=-1) for a, b in rates]
        return scale * _parts(columns), scale * _parts(np.stack(slopes, axis=-1))

    def _transform(self, s: Complex) -> tuple[Complex, Complex]:
        """Return the transform of tones of unit amplitude and its derivative in s, (bins, n)."""
        turn = np.exp(s - 1j * self.omega[:, None])
        end = np.exp(s * self.samples)
        value = (1.0 - end) / (1.0 - turn)
        return np.asarray(value), np.asarray((value * turn - self.samples * end) / (1.0 - turn))


def _parts(value: Complex) -> Floats:
    return np.concatenate([value.real, value.imag])


def tones_in(bins: Bins) -> Tones:
    """Return the tones in a band: one after the other is added where the spectra that are left show it most, as long as it tells.

    A tone tells if it lowers the extended Bayesian information criterion, which counts its parameters and the bins where it may lie (Chen
    and Chen 2008, Biometrika 95:759).
    """
    rows, channels = bins.rows, len(bins.value)
    penalty = (2 + 2 * channels) * np.log(rows.size) + 2.0 * np.log(len(bins.omega))
    best = _fit(bins, rows, np.zeros((0, 2)))
    while len(best.tones) < min(_MOST, len(bins.omega) // 6):
        more = _fit(bins, rows, np.concatenate([best.tones, [_next(bins, best)]]))
        if best.misfit(len(rows)) - more.misfit(len(rows)) < penalty:
            break
        best = more
    return best.found(bins)


@dataclass(frozen=True)
class _Fit:
    """Tones, (n, 2), what they leave, (2 bins, S), the noise, (S,), their c (n, S) and covariance of the parameters (n, 2, 2)."""

    tones: Floats
    left: Floats
    noise: Floats
    amplitude: Complex
    covariance: Floats

    def misfit(self, number: int) -> float:
        """Minus twice the logarithm of the likelihood, apart from what is the same for all."""
        return float(2.0 * number * np.log(self.noise).sum())

    def found(self, bins: Bins) -> Tones:
        """Return the tones, in the order of their frequencies."""
        order = np.argsort(self.tones[:, 1])
        scale = np.array([1.0, bins.step])
        return Tones(
            np.exp(self.tones[order, 0]),
            bins.step * self.tones[order, 1],
            self.covariance[order] * np.outer(scale, scale),
            self.amplitude[order],
            self.noise,
        )


def _fit(bins: Bins, rows: Floats, start: Floats) -> _Fit:
    """Return the fit of so many tones, from where they begin; the noise that weighs channels is that of the round before."""
    number, smooth = len(start), bins.smooth()

    def solved(tones: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        columns, slopes = bins.columns(tones)
        design = np.concatenate([columns.reshape(len(rows), -1), smooth], axis=1)
        scale = np.linalg.norm(design, axis=0)
        basis, triangle = linalg.qr(design / scale, mode="economic", check_finite=False)
        share = linalg.solve_triangular(triangle + 1e-14 * np.eye(len(triangle)), basis.T @ rows, check_finite=False)
        return rows - basis @ (basis.T @ rows), (share / scale[:, None])[: 2 * number].reshape(number, 2, rows.shape[1]), basis, slopes

    freedom = max(1.0 - (2.0 * number + smooth.shape[1] + 2.0 * number / rows.shape[1]) / len(rows), 0.1)

    def noise_of(left: Floats) -> Floats:
        return np.asarray(np.maximum(np.sqrt(np.mean(left**2, axis=0) / freedom), bins.floor))

    tones, covariance = start, np.zeros((2 * number, 2 * number))
    noise = noise_of(solved(start)[0])
    for _ in range(_ROUNDS if number else 0):

        def model(parameters: Floats, noise: Floats = noise) -> tuple[Floats, Floats]:
            left, share, basis, slopes = solved(parameters.reshape(-1, 2))
            change = np.matmul(slopes.transpose(1, 0, 3, 2), share[:, None])  # (n, 2 bins, 2, S)
            change = change.transpose(1, 3, 0, 2).reshape(len(rows), -1)
            change = -(change - basis @ (basis.T @ change)).reshape(len(rows), rows.shape[1], -1)
            return (left / noise).ravel(), (change / noise[:, None]).reshape(-1, 2 * number)

        fit = gauss_newton(model, tones.ravel(), np.tile(_LARGEST_STEPS, number))
        tones, covariance = fit.parameters.reshape(-1, 2), fit.covariance
        before, noise = noise, noise_of(solved(tones)[0])
        covariance = covariance * float(np.mean(noise**2 / before**2))
        if np.ptp(noise / before) < _SAME * np.max(noise / before):  # channels weigh as they did
            break
    left, share, *_ = solved(tones)
    own = covariance.reshape(number, 2, number, 2)[np.arange(number), :, np.arange(number)]
    return _Fit(tones, left, noise, share[:, 0] + 1j * share[:, 1], own)


def _next(bins: Bins, fit: _Fit) -> Floats:
    """Return where a further tone tells most: the logarithm of its decay and its frequency in bins."""
    number = len(bins.omega)
    left = (fit.left[:number] + 1j * fit.left[number:]) / fit.noise
    offset = bins.step * np.arange(-number, number + 1)
    best, found = -1.0, np.zeros(2)
    for nepers in _DECAYS:
        decay = nepers / bins.samples
        shape = (1.0 - np.exp(-nepers - 1j * bins.samples * offset)) / (1.0 - np.exp(-decay - 1j * offset))
        energy = np.convolve(np.ones(number), np.abs(shape) ** 2)[number : 2 * number]
        match = [np.abs(signal.fftconvolve(one, shape[::-1].conj())[number : 2 * number]) ** 2 for one in left.T]
        power = np.sum(match, axis=0) / energy
        place = int(np.argmax(power))
        if power[place] > best:
            best, found = float(power[place]), np.array([np.log(decay), bins.omega[place] / bins.step])
    return found
