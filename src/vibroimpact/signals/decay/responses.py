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
_PLACED = 0.25
"""Standard deviation of a frequency, in distances of the measured ones, from which on
what has no damping is no mode.
"""
_TRIED = 64
"""Places where it is sought."""
_ROUNDS, _OUTSTANDING = 8, 6.0
"""Fits of the noise over the size of the response, each with the weights of the one
before, and the multiple of it that is no noise.
"""
_FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) / 70.0**0.5
"""Fourth differences, of the variance of noise."""
_SAME = 1e-6
"""Relative difference of frequencies that is none."""


@dataclass(frozen=True)
class Lines(Spectra):
    r"""Frequency responses in a band, with angular frequencies in radians per second: :math:`g(s) =
    1 / (i \omega - s)`.

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

    def strongest(self, left: Complex) -> Floats:
        """As `Spectra.strongest`."""
        best, found = -1.0, np.zeros(2)
        energy = np.sum(np.abs(left) ** 2, axis=1)
        for ratio in _RATIOS:
            # in the middle of the half-power bandwidths with most energy: what rings there peaks in
            # one of them
            width = max(1, int(ratio * float(self.omega.mean()) / self.step))
            most = np.argsort(np.add.reduceat(energy, np.arange(0, len(energy), width)))[-_TRIED:]
            omega = self.omega[np.minimum(most * width + width // 2, len(energy) - 1)]
            shape = self.transform((1j - ratio) * omega)[0] / self.unit[:, None]
            power = np.sum(np.abs(shape.conj().T @ left) ** 2, axis=1) / np.sum(
                np.abs(shape) ** 2, axis=0
            )
            place = int(np.argmax(power))
            if power[place] > best:
                best, found = (
                    float(power[place]),
                    np.array([np.log(ratio * omega[place]), omega[place] / self.step]),
                )
        return found

    def weighed(self, tones: Tones) -> Self:
        """Return the responses with noise of which a part is the same at all frequencies, and a
        part grows with the response.

        The first is that of the sensors, the second that of the force, of averages that differ and
        of leakage. Both are fitted to what the tones leave, of all channels together.
        """
        rest = (self.value - self.of(tones)).T
        left = rest - self.powers @ np.linalg.lstsq(self.powers, rest, rcond=None)[0]
        return replace(self, spread=_spread(left, self.value.T - left, self.floor))

    def telling(self, tones: Floats, left: Complex, penalty: float) -> Floats:
        """Return the tones without those that follow the noise of one channel, where it
        is larger than that of the others.
        """
        left = left * self.unit[:, None]
        channels = [
            replace(
                self,
                value=self.value[[one]],
                spread=_spread(left[:, [one]], (self.value.T - left)[:, [one]], self.floor[[one]]),
            )
            for one in range(len(self.value))
        ]
        while len(tones):
            fewer = [np.delete(tones, one, axis=0) for one in range(len(tones))]
            misfits = [
                sum(channel.misfit(part) for channel in channels) for part in (tones, *fewer)
            ]
            least = int(np.argmin(misfits[1:]))
            if misfits[1 + least] - misfits[0] > penalty:
                break
            tones = fewer[least]
        return tones

    def misfit(self, tones: Floats) -> float:
        """Return minus twice the logarithm of the likelihood of tones, apart from what is
        the same for all.
        """
        rows = self.rows
        design = np.concatenate(
            [self.columns(tones)[0].reshape(len(rows), -1), self.smooth()], axis=1
        )
        basis, _ = np.linalg.qr(design / np.linalg.norm(design, axis=0))
        left = rows - basis @ (basis.T @ rows)
        return float(
            np.sum(len(rows) * np.log(np.maximum(np.mean(left**2, axis=0), self.floor**2)))
        )

    def covariance(self, fit: Fit, model: Callable[[Floats], tuple[Floats, Floats]]) -> Floats:
        """Return the covariance of the parameters of a fit by what it leaves, whatever
        the noise of each channel is there.
        """
        left, slopes = model(fit.parameters)
        turned = slopes @ fit.covariance
        leverage = np.minimum(np.sum(turned * slopes, axis=1), 0.5)
        scattered = turned * (left / (1.0 - leverage))[:, None]
        untold = max(0.0, 1.0 - float(np.mean(left**2)))  # of the least noise, where less is left
        return np.asarray(scattered.T @ scattered + untold * fit.covariance)


def _spread(noise: Complex, response: Complex, floor: Floats) -> Floats:
    """Return the standard deviation of noise at each frequency, of mean square 1, from noise and
    responses of all channels, (bins, S).

    Its variance is a constant and a multiple of the square of the response, fitted without what
    stands out.
    """
    scale = np.maximum(np.sqrt(np.mean(np.abs(noise) ** 2, axis=0)), floor)
    square, size = (np.mean(np.abs(one / scale) ** 2, axis=1) for one in (noise, response))
    columns = np.stack([np.ones_like(size), size], axis=1)
    variance = float(np.median(square)) + float(np.median(square / size)) * size
    for _ in range(_ROUNDS):  # a square varies by as much as its mean
        usual = square < _OUTSTANDING * variance
        shares, _ = optimize.nnls((columns / variance[:, None])[usual], (square / variance)[usual])
        if not shares.any():
            break
        variance = np.maximum(columns @ shares, _LEAST_NOISE**2 * float((columns @ shares).max()))
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
    >>> ends = (vi.DegreeOfFreedom(("a1",)), vi.DegreeOfFreedom(("hammer",)))
    >>> (mode,) = vi.modes_in_responses([vi.FrequencyResponse(*ends, frequency, value, "m/N")])
    >>> round(mode.frequency.value, 3), round(mode.damping_ratio.value, 6)
    (400.0, 0.01)
    """
    frequency, value = common_lines(responses)
    band = (float(frequency[0]), float(frequency[-1])) if band is None else band
    number = int(((frequency >= band[0]) & (frequency <= band[1])).sum())
    if number < _LEAST:
        words = (
            f"there are {number} frequencies of the responses from {band[0]:g} to {band[1]:g} "
            f"Hz, and {_LEAST} at least are needed"
        )
        raise InputError(f"{words}; take a wider band, or measure with a finer resolution")
    duration = (number - 1) / float(
        np.ptp(frequency[(frequency >= band[0]) & (frequency <= band[1])])
    )
    bands = tuple(bands_in(band, duration))
    spectra = [_lines(frequency, value, *ends) for ends in bands]
    modes = with_doubts(modes_in_bands(band, bands, spectra, 1.0), duration)
    return tuple(
        mode for mode in modes if not mode.doubt or mode.frequency.deviation * duration < _PLACED
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
    for one in responses:
        if (
            len(one.frequency) != len(first.frequency)
            or np.abs(one.frequency / first.frequency - 1.0).max() > _SAME
        ):
            spans = (
                f"{len(each.frequency)} from {each.frequency[0]:g} to {each.frequency[-1]:g} Hz"
                for each in (first, one)
            )
            words = (
                f"{quoted(first.name)} and {quoted(one.name)} have different frequencies, "
                f"{' and '.join(spans)}"
            )
            raise InputError(f"the responses {words}; give those of one measurement")
        if not one.value.any():
            raise InputError(
                f"the frequency response {quoted(one.name)} is zero throughout; leave it out"
            )
    return first.frequency, np.stack([one.value for one in responses])


def _lines(frequency: Floats, value: Complex, low: float, high: float) -> Lines:
    """Return the responses in a band and its margins."""
    inside = (frequency >= low / _MARGIN) & (frequency <= _MARGIN * high)
    part = value[:, inside]
    floor = _LEAST_NOISE * np.sqrt(np.mean(np.abs(part) ** 2, axis=1))
    # what is smooth has small fourth differences
    differences = np.stack([np.convolve(one, _FOURTH, mode="same") for one in part], axis=1)
    return Lines(
        2.0 * np.pi * frequency[inside],
        part,
        floor,
        np.pad(_spread(differences[2:-2], part.T[2:-2], floor), 2, mode="edge"),
    )
