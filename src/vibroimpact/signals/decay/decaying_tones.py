r"""Sums of decaying tones in a band of frequencies, fitted to the spectra of records.

A tone :math:`2 \operatorname{Re}(c\,p^n)`, :math:`p = e^s`, of N samples has the discrete Fourier
transform

.. math::

    X_k = c\,g(s) + \bar c\,g(\bar s), \qquad g(s) = \frac{1 - e^{s N}}{1 - e^{s - 2 \pi i k / N}}

exactly, and white noise has independent values of one variance there, so that a fit to the bins of
a band by least squares is that of the greatest likelihood. What tones outside the band leave in it
is smooth, a polynomial in k. Amplitudes are eliminated (variable projection: Golub and Pereyra
1973, SIAM J. Numer. Anal. 10:413; its derivatives after Kaufman 1975, BIT 15:49).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, signal

from vibroimpact.arrays import Complex, Floats
from vibroimpact.signals.inverse.gauss_newton import Fit, gauss_newton

_SMOOTH = 4
"""Number of coefficients of the polynomial."""
_MOST = 24
"""Largest number of tones in a band."""
_DECAYS = np.geomspace(0.5, 200.0, 7)
"""Decays over the record, in nepers, at which a further tone is sought."""
_ROUNDS, _SAME = 6, 0.02
"""Most fits, each with the noise that the one before left, and relative change of the
ratios of channels that ends them.
"""
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
        return Tones(
            self.decay[which],
            self.frequency[which],
            self.covariance[which],
            self.amplitude[which],
            self.noise,
        )


@dataclass(frozen=True)
class Spectra(ABC):
    r"""Spectra in a band, in which a tone is :math:`c\,g(s) + \bar c\,g(\bar s)`.

    Parameters
    ----------
    omega : array, shape (bins,)
        Angular frequencies.
    value : array, shape (S, bins)
        Spectrum of each channel.
    floor : array, shape (S,)
        Least standard deviation of the noise.
    """

    omega: Floats
    value: Complex
    floor: Floats

    @property
    @abstractmethod
    def step(self) -> float:
        """Distance of bins."""

    @property
    @abstractmethod
    def unit(self) -> Floats:
        """Standard deviation of real and imaginary part of each bin under noise of unit
        variance, (bins,).
        """

    @abstractmethod
    def transform(self, s: Complex) -> tuple[Complex, Complex]:
        """Return the spectra g of tones of unit amplitude and their derivatives in s, (bins, n)."""

    @abstractmethod
    def strongest(self, left: Complex) -> Floats:
        """Return where a further tone tells most of what is left, (bins, S): the
        logarithm of its decay and its frequency in bins.
        """

    def weighed(self, tones: Tones) -> Self:
        """Return the spectra with the noise of each bin as a fit of tones leaves it: that
        of white noise is the same for all.
        """
        return self

    def telling(self, tones: Floats, left: Complex, penalty: float) -> Floats:
        """Return the tones, (n, 2), that tell more than a penalty where each channel has
        noise of its own; all, if all have the same.
        """
        return tones

    def covariance(self, fit: Fit, model: Callable[[Floats], tuple[Floats, Floats]]) -> Floats:
        """Return the covariance of the parameters of a fit: by its curvature, where the
        noise is as `unit` has it.
        """
        return fit.covariance

    @property
    def rows(self) -> Floats:
        """Real and imaginary parts of each channel, (2 bins, S), of unit variance under
        noise of unit variance.
        """
        return _parts(self.value.T / self.unit[:, None])

    def without(self, tones: Tones) -> Self:
        """Return the spectra without tones that are known."""
        return replace(self, value=self.value - self.of(tones))

    def of(self, tones: Tones) -> Complex:
        """Return the spectra of tones, (S, bins)."""
        s = -tones.decay + 1j * tones.frequency
        upper, lower = (self.transform(one)[0] for one in (s, s.conj()))
        return np.asarray((upper @ tones.amplitude + lower @ tones.amplitude.conj()).T)

    @property
    def powers(self) -> Floats:
        """Polynomials of what tones outside the band leave, (bins, polynomials)."""
        place = 2.0 * (self.omega - self.omega[0]) / (self.omega[-1] - self.omega[0]) - 1.0
        return np.asarray(np.polynomial.legendre.legvander(place, _SMOOTH - 1))

    def smooth(self) -> Floats:
        """Return their columns, (2 bins, columns)."""
        powers = self.powers / self.unit[:, None]
        return np.block([[powers, np.zeros_like(powers)], [np.zeros_like(powers), powers]])

    def columns(self, tones: Floats) -> tuple[Floats, Floats]:
        """Return the columns of tones, (2 bins, n, 2), and their derivatives in both parameters, (2
        bins, n, 2, 2).

        Parameters
        ----------
        tones : array, shape (n, 2)
            Logarithm of the decay and frequency in bins of each.
        """
        decay = np.exp(tones[:, 0])
        s = -decay + 1j * self.step * tones[:, 1]
        (upper, upper_slope), (lower, lower_slope) = (self.transform(one) for one in (s, s.conj()))
        columns = np.stack([upper + lower, 1j * (upper - lower)], axis=-1)
        rates = ((-decay, -decay), (1j * self.step, -1j * self.step))
        slopes = [
            np.stack(
                [a * upper_slope + b * lower_slope, 1j * (a * upper_slope - b * lower_slope)],
                axis=-1,
            )
            for a, b in rates
        ]
        unit = self.unit[:, None, None]
        return _parts(columns / unit), _parts(np.stack(slopes, axis=-1) / unit[..., None])


@dataclass(frozen=True)
class Bins(Spectra):
    """Discrete Fourier transforms of records in a band, with angular frequencies in radians per
    sample.

    Parameters
    ----------
    samples : int
        Number of samples of the records.
    """

    samples: int

    @property
    def step(self) -> float:
        """Distance of bins."""
        return 2.0 * np.pi / self.samples

    @property
    def unit(self) -> Floats:
        """As `Spectra.unit`, of white noise of the samples."""
        return np.full(len(self.omega), np.sqrt(0.5 * self.samples))

    def transform(self, s: Complex) -> tuple[Complex, Complex]:
        """As `Spectra.transform`."""
        turn = np.exp(s - 1j * self.omega[:, None])
        end = np.exp(s * self.samples)
        value = (1.0 - end) / (1.0 - turn)
        return np.asarray(value), np.asarray((value * turn - self.samples * end) / (1.0 - turn))

    def strongest(self, left: Complex) -> Floats:
        """As `Spectra.strongest`."""
        number = len(self.omega)
        offset = self.step * np.arange(-number, number + 1)
        best, found = -1.0, np.zeros(2)
        for nepers in _DECAYS:
            decay = nepers / self.samples
            shape = (1.0 - np.exp(-nepers - 1j * self.samples * offset)) / (
                1.0 - np.exp(-decay - 1j * offset)
            )
            energy = np.convolve(np.ones(number), np.abs(shape) ** 2)[number : 2 * number]
            match = [
                np.abs(signal.fftconvolve(one, shape[::-1].conj())[number : 2 * number]) ** 2
                for one in left.T
            ]
            power = np.sum(match, axis=0) / energy
            place = int(np.argmax(power))
            if power[place] > best:
                best, found = (
                    float(power[place]),
                    np.array([np.log(decay), self.omega[place] / self.step]),
                )
        return found


def _parts(value: Complex) -> Floats:
    return np.concatenate([value.real, value.imag])


def tones_in(bins: Spectra) -> Tones:
    """Return the tones in a band: one after the other is added where the spectra that are left show
    it most, as long as it tells.

    A tone tells if it lowers the extended Bayesian information criterion, which counts its
    parameters and the bins where it may lie (Chen and Chen 2008, Biometrika 95:759).
    """
    rows, channels = bins.rows, len(bins.value)
    penalty = (2 + 2 * channels) * np.log(rows.size) + 2.0 * np.log(len(bins.omega))
    best = _fit(bins, rows, np.zeros((0, 2)))
    while len(best.tones) < min(_MOST, len(bins.omega) // 6):
        more = _fit(bins, rows, np.concatenate([best.tones, [_next(bins, best)]]))
        if best.misfit(len(rows)) - more.misfit(len(rows)) < penalty:
            break
        best = more
    number = len(bins.omega)
    telling = bins.telling(
        best.tones, np.asarray(best.left[:number] + 1j * best.left[number:]), penalty
    )
    return (best if len(telling) == len(best.tones) else _fit(bins, rows, telling)).found(bins)


@dataclass(frozen=True)
class _Fit:
    """Tones, (n, 2), what they leave, (2 bins, S), the noise, (S,), their c (n, S) and
    covariance of the parameters (n, 2, 2).
    """

    tones: Floats
    left: Floats
    noise: Floats
    amplitude: Complex
    covariance: Floats

    def misfit(self, number: int) -> float:
        """Minus twice the logarithm of the likelihood, apart from what is the same for all."""
        return float(2.0 * number * np.log(self.noise).sum())

    def found(self, bins: Spectra) -> Tones:
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


def _fit(bins: Spectra, rows: Floats, start: Floats) -> _Fit:
    """Return the fit of so many tones, from where they begin; the noise that weighs
    channels is that of the round before.
    """
    number, smooth = len(start), bins.smooth()

    def solved(tones: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        columns, slopes = bins.columns(tones)
        design = np.concatenate([columns.reshape(len(rows), -1), smooth], axis=1)
        scale = np.linalg.norm(design, axis=0)
        basis, triangle = linalg.qr(design / scale, mode="economic", check_finite=False)
        share = linalg.solve_triangular(
            triangle + 1e-14 * np.eye(len(triangle)), basis.T @ rows, check_finite=False
        )
        return (
            rows - basis @ (basis.T @ rows),
            (share / scale[:, None])[: 2 * number].reshape(number, 2, rows.shape[1]),
            basis,
            slopes,
        )

    freedom = max(
        1.0 - (2.0 * number + smooth.shape[1] + 2.0 * number / rows.shape[1]) / len(rows), 0.1
    )

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
        tones = fit.parameters.reshape(-1, 2)
        before, noise = noise, noise_of(solved(tones)[0])
        covariance = bins.covariance(fit, model) * float(np.mean(noise**2 / before**2))
        if np.ptp(noise / before) < _SAME * np.max(noise / before):  # channels weigh as they did
            break
    left, share, *_ = solved(tones)
    own = covariance.reshape(number, 2, number, 2)[np.arange(number), :, np.arange(number)]
    return _Fit(tones, left, noise, share[:, 0] + 1j * share[:, 1], own)


def _next(bins: Spectra, fit: _Fit) -> Floats:
    """Return where a further tone tells most: the logarithm of its decay and its
    frequency in bins.
    """
    number = len(bins.omega)
    return bins.strongest(
        np.asarray((fit.left[:number] + 1j * fit.left[number:]) / fit.noise, dtype=complex)
    )
