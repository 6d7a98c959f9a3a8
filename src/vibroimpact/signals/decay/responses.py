"""Modes in frequency responses: frequencies and damping ratios with intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from scipy import optimize

from vibroimpact.arrays import Complex, Floats
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted
from vibroimpact.signals.decay.decaying_tones import Spectra, Tones
from vibroimpact.signals.decay.find import DecayMode, bands_in, modes_in_bands, with_doubts
from vibroimpact.signals.frequency_response import FrequencyResponse
from vibroimpact.signals.inverse.gauss_newton import Fit

_MARGIN = 1.12
"""How far beyond the ends of a band that is fitted at once tones are fitted too."""
_LEAST = 32
"""Least number of frequencies in a band."""
_LEAST_NOISE = 1e-4
"""Least noise, relative to the rms value of a response: no plate is linear beyond."""
_RATIOS = np.geomspace(3e-4, 0.1, 7)
"""Damping ratios at which a further mode is sought."""
_UNRESOLVED = 0.25
"""Standard deviation of a frequency, in distances of those measured, that is of no mode.

It counts where the damping is in doubt.
"""
_TRIED = 64
"""Frequencies at which a further mode is sought."""
_ROUNDS = 8
"""Fits of the noise over the size of the response, each with the weights of the one before."""
_OUTSTANDING = 6.0
"""Multiple of the variance of noise that is no noise."""
_FOURTH_DIFFERENCE = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) / 70.0**0.5
"""Coefficients of a fourth difference that has the variance of noise."""
_SAME = 1e-6
"""Relative difference of frequencies that is none."""


@dataclass(frozen=True)
class Lines(Spectra):
    r"""Frequency responses in a band, in which a tone has :math:`g(s) = 1 / (i \omega - s)`.

    Angular frequencies are in radians per second.

    Parameters
    ----------
    spread : array, shape (bins,)
        Standard deviation of the noise of each frequency, relative to the others.
    """

    spread: Floats

    @property
    def step(self) -> float:
        """Mean distance of frequencies."""
        return float((self.omega[-1] - self.omega[0]) / (len(self.omega) - 1))

    @property
    def unit(self) -> Floats:
        """As `Spectra.unit`."""
        return self.spread

    def transform(self, s: Complex) -> tuple[Complex, Complex]:
        """As `Spectra.transform`."""
        value = 1.0 / (1j * self.omega[:, None] - s)
        return np.asarray(value), np.asarray(value**2)

    def strongest(self, residual: Complex) -> Floats:
        """As `Spectra.strongest`."""
        highest = -1.0
        best = np.zeros(2)
        energy = np.sum(np.abs(residual) ** 2, axis=1)
        for ratio in _RATIOS:
            # in the middle of the half-power bandwidths with most energy: what rings there peaks in
            # one of them
            width = max(1, int(ratio * float(self.omega.mean()) / self.step))
            firsts = np.arange(0, len(energy), width)
            in_widths = np.add.reduceat(energy, firsts)
            strongest = firsts[np.argsort(in_widths)[-_TRIED:]]
            omega = self.omega[np.minimum(strongest + width // 2, len(energy) - 1)]
            tone, _ = self.transform((1j - ratio) * omega)
            shape = tone / self.unit[:, None]
            # the energy that the best amplitude of each tone takes from the residual
            match = np.sum(np.abs(shape.conj().T @ residual) ** 2, axis=1)
            power = match / np.sum(np.abs(shape) ** 2, axis=0)
            peak = int(np.argmax(power))
            if power[peak] > highest:
                highest = float(power[peak])
                best = np.array([np.log(ratio * omega[peak]), omega[peak] / self.step])
        return best

    def weighed(self, tones: Tones) -> Self:
        """Return the responses with noise of two parts: constant, and growing with the response.

        The first is that of the sensors, the second that of the force, of averages that differ and
        of leakage. Both are fitted to what the tones leave, of all channels together.
        """
        rest = (self.value - self.of(tones)).T
        smooth = self.powers @ np.linalg.lstsq(self.powers, rest, rcond=None)[0]
        noise = rest - smooth
        return replace(self, spread=_spread(noise, self.value.T - noise, self.floor))

    def telling(self, tones: Floats, residual: Complex, penalty: float) -> Floats:
        """Return the tones without those that follow the noise of one channel.

        They would, where that is larger than the noise of the others.
        """
        noise = residual * self.unit[:, None]
        response = self.value.T - noise
        channels = []
        for number in range(len(self.value)):
            channel = [number]
            spread = _spread(noise[:, channel], response[:, channel], self.floor[channel])
            one_channel = replace(
                self, value=self.value[channel], floor=self.floor[channel], spread=spread
            )
            channels.append(one_channel)

        def misfit(tones: Floats) -> float:
            return sum(channel.misfit(tones) for channel in channels)

        while len(tones):
            misfit_of_all = misfit(tones)
            without_one = [np.delete(tones, number, axis=0) for number in range(len(tones))]
            misfits = [misfit(fewer) for fewer in without_one]
            least = int(np.argmin(misfits))
            if misfits[least] - misfit_of_all > penalty:
                break
            tones = without_one[least]
        return tones

    def misfit(self, tones: Floats) -> float:
        """Return minus twice the logarithm of the likelihood of tones, apart from constants."""
        rows = self.rows
        columns, _ = self.columns(tones)
        design = np.concatenate([columns.reshape(len(rows), -1), self.smooth()], axis=1)
        basis, _ = np.linalg.qr(design / np.linalg.norm(design, axis=0))
        residual = rows - basis @ (basis.T @ rows)
        variance = np.maximum(np.mean(residual**2, axis=0), self.floor**2)
        return float(np.sum(len(rows) * np.log(variance)))

    def covariance(self, fit: Fit, model: Callable[[Floats], tuple[Floats, Floats]]) -> Floats:
        """Return the covariance of the parameters of a fit by its residuals.

        It holds whatever the noise of each channel is there.
        """
        residual, slopes = model(fit.parameters)
        turned = slopes @ fit.covariance
        # a residual is smaller than the noise by the leverage of its row
        leverage = np.minimum(np.sum(turned * slopes, axis=1), 0.5)
        scattered = turned * (residual / (1.0 - leverage))[:, None]
        # of the least noise, where less is left
        missing = max(0.0, 1.0 - float(np.mean(residual**2)))
        return np.asarray(scattered.T @ scattered + missing * fit.covariance)


def _spread(noise: Complex, response: Complex, floor: Floats) -> Floats:
    """Return the standard deviation of noise at each frequency, (bins,), of mean square 1.

    Noise and responses are those of all channels, (bins, S). The variance is a constant and a
    multiple of the square of the response, fitted without what stands out.
    """
    rms = np.sqrt(np.mean(np.abs(noise) ** 2, axis=0))
    scale = np.maximum(rms, floor)
    noise_square = np.mean(np.abs(noise / scale) ** 2, axis=1)
    response_square = np.mean(np.abs(response / scale) ** 2, axis=1)
    columns = np.stack([np.ones_like(response_square), response_square], axis=1)
    constant = float(np.median(noise_square))
    multiple = float(np.median(noise_square / response_square))
    variance = constant + multiple * response_square
    for _ in range(_ROUNDS):
        usual = noise_square < _OUTSTANDING * variance
        # a square varies by as much as its mean, which is the weight
        weighed_columns = (columns / variance[:, None])[usual]
        weighed_squares = (noise_square / variance)[usual]
        shares, _ = optimize.nnls(weighed_columns, weighed_squares)
        if not shares.any():
            break
        variance = columns @ shares
        variance = np.maximum(variance, _LEAST_NOISE**2 * float(variance.max()))
    return np.asarray(np.sqrt(variance / np.mean(variance)))


def modes_in_responses(
    responses: Sequence[FrequencyResponse], band: tuple[float, float] | None = None
) -> tuple[DecayMode, ...]:
    r"""Return the modes in frequency responses, in the order of their frequencies.

    Parameters
    ----------
    responses : sequence of FrequencyResponse
        Frequency responses of one structure, at the same frequencies, equally spaced or not.
    band : tuple of two floats, optional
        The band of frequencies [Hz]; by default all.

    Returns
    -------
    tuple of DecayMode
        The modes that stand out of the noise, with the amplitudes of their tones in the impulse
        response of each.

    Raises
    ------
    InputError
        If there are no responses, their frequencies differ, one is zero throughout, or there are
        fewer than 32 frequencies in the band.

    Notes
    -----
    A sum of modes, :math:`\sum_r c_r / (i \omega - s_r) + \bar c_r / (i \omega - \bar s_r)` with
    poles :math:`s_r` that all responses have
    in common, is fitted as `modes_in_decay` fits tones: half an octave at a time, with a polynomial
    for what other modes leave there and for the quantity (an acceleration is that sum and a linear
    function), and as many modes as the extended Bayesian information criterion finds. Noise has a
    part that is the same at all frequencies and one that grows with the response; their ratio is
    fitted too. This is the fit of greatest likelihood, of which intervals are those of the fit;
    fits of a rational fraction by linear least squares, such as LSCF (PolyMAX), are biased by
    noise, have no intervals, and their poles are chosen by hand in a diagram.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> frequency = np.arange(200.0, 800.0, 0.5)
    >>> value = 1.0 / (400.0**2 - frequency**2 + 2j * 0.01 * 400.0 * frequency)
    >>> ends = (vi.signals.DegreeOfFreedom(("a1",)), vi.signals.DegreeOfFreedom(("hammer",)))
    >>> (mode,) = vi.signals.modes_in_responses(
    ...     [vi.signals.FrequencyResponse(*ends, frequency, value, "m/N")]
    ... )
    >>> round(mode.frequency.value, 3), round(mode.damping_ratio.value, 6)
    (400.0, 0.01)
    """
    frequency, value = common_lines(responses)
    if band is None:
        band = (float(frequency[0]), float(frequency[-1]))
    in_band = frequency[(frequency >= band[0]) & (frequency <= band[1])]
    count = len(in_band)
    if count < _LEAST:
        raise InputError(
            f"there are {count} frequencies of the responses from {band[0]:g} to {band[1]:g} "
            f"Hz, and {_LEAST} at least are needed; take a wider band, or measure with a finer "
            "resolution"
        )
    # of records with this distance of frequencies
    duration = (count - 1) / float(np.ptp(in_band))
    bands = tuple(bands_in(band, duration))
    spectra = [_lines(frequency, value, low, high) for low, high in bands]
    # the rate is that of radians per second
    modes = with_doubts(modes_in_bands(band, bands, spectra, 1.0), duration)
    return tuple(
        mode
        for mode in modes
        if not mode.doubt or mode.frequency.deviation * duration < _UNRESOLVED
    )


def common_lines(responses: Sequence[FrequencyResponse]) -> tuple[Floats, Complex]:
    """Return the frequencies of responses [Hz] and their values, (S, frequencies).

    Raises
    ------
    InputError
        If there are none, their frequencies differ, or one is zero throughout.
    """
    if not responses:
        raise InputError("there is no frequency response; give at least one")
    first = responses[0]
    for response in responses:
        if not _same_frequencies(response.frequency, first.frequency):
            raise InputError(
                f"the responses {quoted(first.name)} and {quoted(response.name)} have different "
                f"frequencies, {_span(first.frequency)} and {_span(response.frequency)}; "
                "give those of one measurement"
            )
        if not response.value.any():
            raise InputError(
                f"the frequency response {quoted(response.name)} is zero throughout; leave it out"
            )
    return first.frequency, np.stack([response.value for response in responses])


def _same_frequencies(frequency: Floats, reference: Floats) -> bool:
    if len(frequency) != len(reference):
        return False
    return bool(np.abs(frequency / reference - 1.0).max() <= _SAME)


def _span(frequency: Floats) -> str:
    return f"{len(frequency)} from {frequency[0]:g} to {frequency[-1]:g} Hz"


def _lines(frequency: Floats, value: Complex, low: float, high: float) -> Lines:
    """Return the responses in a band and its margins."""
    inside = (frequency >= low / _MARGIN) & (frequency <= _MARGIN * high)
    in_band = value[:, inside]
    floor = _LEAST_NOISE * np.sqrt(np.mean(np.abs(in_band) ** 2, axis=1))
    # what is smooth has small fourth differences, so that these are noise; two at each end are not
    # complete
    differences = [np.convolve(channel, _FOURTH_DIFFERENCE, mode="same") for channel in in_band]
    noise = np.stack(differences, axis=1)[2:-2]
    spread = np.pad(_spread(noise, in_band.T[2:-2], floor), 2, mode="edge")
    return Lines(2.0 * np.pi * frequency[inside], in_band, floor, spread)
