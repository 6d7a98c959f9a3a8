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
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from scipy import fft, linalg

from vibroimpact.arrays import Complex, Floats
from vibroimpact.signals.inverse.gauss_newton import Fit, gauss_newton

_SMOOTH = 4
"""Number of coefficients of the polynomial of what tones outside the band leave in it."""
_MOST_TONES = 24
"""Largest number of tones in a band."""
_DECAYS = np.geomspace(0.5, 200.0, 7)
"""Decays over the record, in nepers, at which a further tone is sought."""
_ROUNDS = 6
"""Most fits, each with the noise that the one before left."""
_SAME_NOISE = 0.02
"""Relative change of the ratios of the noise of channels that ends the fits."""
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
        """Standard deviation of both parts of each bin under noise of unit variance, (bins,)."""

    @abstractmethod
    def transform(self, s: Complex) -> tuple[Complex, Complex]:
        """Return the spectra g of tones of unit amplitude and their derivatives in s, (bins, n)."""

    @abstractmethod
    def strongest(self, residual: Complex) -> Floats:
        """Return where a further tone explains most of a residual, (bins, S).

        That is the logarithm of its decay, and its frequency in bins.
        """

    def weighed(self, tones: Tones) -> Self:
        """Return the spectra with the noise of each bin as a fit of tones leaves it.

        That of white noise is the same for all.
        """
        return self

    def telling(self, tones: Floats, residual: Complex, penalty: float) -> Floats:
        """Return the tones, (n, 2), that tell more than a penalty with noise of each channel.

        These are all, if all channels have the same noise.
        """
        return tones

    def covariance(self, fit: Fit, model: Callable[[Floats], tuple[Floats, Floats]]) -> Floats:
        """Return the covariance of the parameters of a fit.

        It is that by its curvature, where the noise is as `unit` has it.
        """
        return fit.covariance

    @property
    def rows(self) -> Floats:
        """Real and imaginary parts of each channel, (2 bins, S), in units of the noise."""
        return _parts(self.value.T / self.unit[:, None])

    def without(self, tones: Tones) -> Self:
        """Return the spectra without tones that are known."""
        return replace(self, value=self.value - self.of(tones))

    def of(self, tones: Tones) -> Complex:
        """Return the spectra of tones, (S, bins)."""
        s = -tones.decay + 1j * tones.frequency
        upper, _ = self.transform(s)
        lower, _ = self.transform(s.conj())
        return np.asarray((upper @ tones.amplitude + lower @ tones.amplitude.conj()).T)

    @property
    def powers(self) -> Floats:
        """Polynomials of what tones outside the band leave, (bins, polynomials)."""
        position = 2.0 * (self.omega - self.omega[0]) / (self.omega[-1] - self.omega[0]) - 1.0
        return np.asarray(np.polynomial.legendre.legvander(position, _SMOOTH - 1))

    def smooth(self) -> Floats:
        """Return the columns of these polynomials in a fit, (2 bins, columns)."""
        powers = self.powers / self.unit[:, None]
        return np.block([[powers, np.zeros_like(powers)], [np.zeros_like(powers), powers]])

    def columns(self, tones: Floats) -> tuple[Floats, Floats]:
        """Return the columns of tones in a fit, and their derivatives in both parameters.

        The columns, (2 bins, n, 2), are those of the real and the imaginary part of c; the
        derivatives have the shape (2 bins, n, 2, 2).

        Parameters
        ----------
        tones : array, shape (n, 2)
            Logarithm of the decay and frequency in bins of each.
        """
        decay = np.exp(tones[:, 0])
        s = -decay + 1j * self.step * tones[:, 1]
        # a real tone has a pole and its conjugate
        upper, upper_slope = self.transform(s)
        lower, lower_slope = self.transform(s.conj())
        columns = _by_amplitude(upper, lower)
        # derivatives of s and of its conjugate
        turn = 1j * self.step
        by_log_decay = _by_amplitude(-decay * upper_slope, -decay * lower_slope)
        by_frequency = _by_amplitude(turn * upper_slope, -turn * lower_slope)
        slopes = np.stack([by_log_decay, by_frequency], axis=-1)
        unit = self.unit[:, None, None]
        return _parts(columns / unit), _parts(slopes / unit[..., None])


@dataclass(frozen=True)
class Bins(Spectra):
    """Discrete Fourier transforms of records in a band.

    Angular frequencies are in radians per sample.

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
        ratio = np.exp(s - 1j * self.omega[:, None])  # of the geometric series
        end = np.exp(s * self.samples)
        value = (1.0 - end) / (1.0 - ratio)
        slope = (value * ratio - self.samples * end) / (1.0 - ratio)
        return np.asarray(value), np.asarray(slope)

    def strongest(self, residual: Complex) -> Floats:
        """As `Spectra.strongest`."""
        count = len(self.omega)
        offset = self.step * np.arange(-count, count + 1)
        in_band = slice(count, 2 * count)
        length = fft.next_fast_len(len(residual) + len(offset) - 1)
        spectra = fft.fft(residual, length, axis=0)
        highest = -1.0
        best = np.zeros(2)
        for nepers in _DECAYS:
            decay = nepers / self.samples
            # the spectrum of a tone at one bin, by the distance from it: that of others is shifted
            shape = (1.0 - np.exp(-nepers - 1j * self.samples * offset)) / (
                1.0 - np.exp(-decay - 1j * offset)
            )
            energy = np.convolve(np.ones(count), np.abs(shape) ** 2)[in_band]
            # the correlation of each channel with it
            products = spectra * fft.fft(shape[::-1].conj(), length)[:, None]
            match = fft.ifft(products, axis=0)[in_band]
            power = np.sum(np.abs(match) ** 2, axis=1) / energy
            peak = int(np.argmax(power))
            if power[peak] > highest:
                highest = float(power[peak])
                best = np.array([np.log(decay), self.omega[peak] / self.step])
        return best


def _by_amplitude(upper: Complex, lower: Complex) -> Complex:
    """Return the derivatives of c upper + conj(c) lower by the parts of c, on a last axis."""
    return np.stack([upper + lower, 1j * (upper - lower)], axis=-1)


def _parts(value: Complex) -> Floats:
    """Return the real parts, and below them the imaginary ones."""
    return np.concatenate([value.real, value.imag])


def _complex(parts: Floats) -> Complex:
    """Return the complex numbers of such parts."""
    count = len(parts) // 2
    return np.asarray(parts[:count] + 1j * parts[count:])


def tones_in(bins: Spectra) -> Tones:
    """Return the tones in a band.

    One after the other is added where the spectra that are left show it most, as long as it tells:
    as long as it lowers the extended Bayesian information criterion, which counts its parameters
    and the bins where it may lie (Chen and Chen 2008, Biometrika 95:759).
    """
    rows = bins.rows
    # a tone has a decay and a frequency, and a complex amplitude in each channel
    parameters = 2 + 2 * len(bins.value)
    penalty = parameters * np.log(rows.size) + 2.0 * np.log(len(bins.omega))
    best = _fit(bins, rows, np.zeros((0, 2)))
    most = min(_MOST_TONES, len(bins.omega) // 6)
    while len(best.tones) < most:
        further = _further_tone(bins, best)
        fit = _fit(bins, rows, np.concatenate([best.tones, [further]]))
        if best.misfit(len(rows)) - fit.misfit(len(rows)) < penalty:
            break
        best = fit
    telling = bins.telling(best.tones, _complex(best.residual), penalty)
    if len(telling) < len(best.tones):
        best = _fit(bins, rows, telling)
    return best.found(bins)


@dataclass(frozen=True)
class _Fit:
    """A fit of tones.

    The tones, (n, 2), their residual, (2 bins, S), the noise, (S,), their c, (n, S), and the
    covariance of their parameters, (n, 2, 2).
    """

    tones: Floats
    residual: Floats
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


class _Solved(NamedTuple):
    """Least squares over the amplitudes of given tones.

    The residual, (2 bins, S), the real and imaginary parts of c, (n, 2, S), an orthonormal basis of
    the columns, and the derivatives of these by the parameters of the tones.
    """

    residual: Floats
    amplitude: Floats
    basis: Floats
    slopes: Floats


def _fit(bins: Spectra, rows: Floats, start: Floats) -> _Fit:
    """Return the fit of so many tones, from where they begin.

    Channels are weighed by the noise that the round before left of them.
    """
    tone_count = len(start)
    channels = rows.shape[1]
    smooth = bins.smooth()
    # tones are common to the channels, amplitudes and polynomials are not
    unknowns = 2.0 * tone_count + smooth.shape[1] + 2.0 * tone_count / channels
    freedom = max(1.0 - unknowns / len(rows), 0.1)

    def noise_of(tones: Floats) -> Floats:
        """Return the noise of each channel by what the best amplitudes leave."""
        residual = _solve_amplitudes(bins, rows, smooth, tones).residual
        rms = np.sqrt(np.mean(residual**2, axis=0) / freedom)
        return np.asarray(np.maximum(rms, bins.floor))

    tones = start
    covariance = np.zeros((2 * tone_count, 2 * tone_count))
    noise = noise_of(tones)
    rounds = _ROUNDS if tone_count else 0
    for _ in range(rounds):

        def model(parameters: Floats, noise: Floats = noise) -> tuple[Floats, Floats]:
            solved = _solve_amplitudes(bins, rows, smooth, parameters.reshape(-1, 2))
            residual = (solved.residual / noise).ravel()
            slopes = _residual_slopes(solved) / noise[:, None]
            return residual, slopes.reshape(-1, 2 * tone_count)

        fit = gauss_newton(model, tones.ravel(), np.tile(_LARGEST_STEPS, tone_count))
        tones = fit.parameters.reshape(-1, 2)
        weighed_by = noise
        noise = noise_of(tones)
        # the covariance of the fit goes with the noise that it was weighed by
        covariance = bins.covariance(fit, model) * float(np.mean(noise**2 / weighed_by**2))
        change = noise / weighed_by
        if np.ptp(change) < _SAME_NOISE * np.max(change):  # channels weigh as they did
            break
    solved = _solve_amplitudes(bins, rows, smooth, tones)
    of_tones = np.arange(tone_count)
    own = covariance.reshape(tone_count, 2, tone_count, 2)[of_tones, :, of_tones]
    amplitude = solved.amplitude[:, 0] + 1j * solved.amplitude[:, 1]
    return _Fit(tones, solved.residual, noise, amplitude, own)


def _solve_amplitudes(bins: Spectra, rows: Floats, smooth: Floats, tones: Floats) -> _Solved:
    """Return the amplitudes of tones that leave least of the rows, beside smooth columns."""
    columns, slopes = bins.columns(tones)
    design = np.concatenate([columns.reshape(len(rows), -1), smooth], axis=1)
    scale = np.linalg.norm(design, axis=0)
    basis, triangle = linalg.qr(design / scale, mode="economic", check_finite=False)
    # tones that coincide would make the triangle singular
    coefficients = linalg.solve_triangular(
        triangle + 1e-14 * np.eye(len(triangle)), basis.T @ rows, check_finite=False
    )
    tone_count = len(tones)
    amplitude = (coefficients / scale[:, None])[: 2 * tone_count]
    return _Solved(
        rows - basis @ (basis.T @ rows),
        amplitude.reshape(tone_count, 2, rows.shape[1]),
        basis,
        slopes,
    )


def _residual_slopes(solved: _Solved) -> Floats:
    """Return the derivatives of the residual by the parameters of tones, (2 bins, S, 2 n).

    After Kaufman (1975) they are those of the columns, less what the basis follows of them.
    """
    rows, channels = solved.residual.shape
    # (n, 2 bins, 2, S): of each tone by each of its two parameters
    change = np.matmul(solved.slopes.transpose(1, 0, 3, 2), solved.amplitude[:, None])
    change = change.transpose(1, 3, 0, 2).reshape(rows, -1)
    change = change - solved.basis @ (solved.basis.T @ change)
    return np.asarray(-change.reshape(rows, channels, -1))


def _further_tone(bins: Spectra, fit: _Fit) -> Floats:
    """Return where a further tone tells most.

    That is the logarithm of its decay, and its frequency in bins.
    """
    return bins.strongest(np.asarray(_complex(fit.residual) / fit.noise, dtype=complex))
