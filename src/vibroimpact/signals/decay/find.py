"""Modes in the free decay of records: frequencies and damping ratios with intervals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import fft

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted
from vibroimpact.signals.decay.decaying_tones import Bins, Spectra, Tones, tones_in
from vibroimpact.signals.estimate import Estimate
from vibroimpact.signals.record import Record

_WIDTH = 2.0**0.5
"""Ratio of the ends of a band that is fitted at once."""
_MARGIN = 1.12
"""How far beyond these ends tones are fitted too, as a ratio."""
_CYCLES = 1000.0
"""Cycles of the lowest frequency of a band over which the records are used."""
_BINS = 32
"""Least number of bins in a band."""
_LEAST_NOISE = 1e-4
"""Least noise, relative to the rms value of a record: no plate is linear beyond."""
_LARGEST_DAMPING = 0.2
"""Largest damping ratio: what is damped more does not ring."""
_VAGUE = 0.25
"""Standard deviation of the logarithm of a damping ratio from which on it counts as unknown."""
_APART = 3.0
"""Distance below which modes are close to each other, in bins or half-power bandwidths."""


@dataclass(frozen=True)
class DecayMode:
    """A mode identified in the decay of records.

    Parameters
    ----------
    frequency : Estimate
        Natural frequency, without damping [Hz].
    damping_ratio : Estimate
        Damping ratio [-].
    amplitude : tuple of float
        Its amplitude in each record at the first sample, in the unit of the record.
    doubt : str
        Why its damping could not be determined; empty if it was.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> time = np.arange(4000) / 10e3
    >>> ringing = vi.signals.Record(
    ...     "a",
    ...     np.exp(-2.0 * np.pi * 400.0 * 0.01 * time) * np.sin(2.0 * np.pi * 400.0 * time),
    ...     10e3,
    ...     "m/s2",
    ... )
    >>> (mode,) = vi.signals.modes_in_decay([ringing], (300.0, 500.0))
    >>> round(mode.frequency.value, 1), round(mode.damping_ratio.value, 4)
    (400.0, 0.01)
    """

    frequency: Estimate
    damping_ratio: Estimate
    amplitude: tuple[float, ...]
    doubt: str = ""


def modes_in_decay(records: Sequence[Record], band: tuple[float, float]) -> tuple[DecayMode, ...]:
    r"""Return the modes in the free decay of records, in the order of their frequencies.

    Parameters
    ----------
    records : sequence of Record
        Records of one decay at several places, or of several decays of one structure: of one rate
        and one number of samples, while no force acts.
    band : tuple of two floats
        The band of frequencies [Hz].

    Returns
    -------
    tuple of DecayMode
        The modes that stand out of the noise.

    Raises
    ------
    InputError
        If there are no records, they have different rates or lengths, a sample is not finite, one
        is constant, or the band does not lie between zero and half the rate or is too narrow for
        records so short.

    Notes
    -----
    Sums of decaying tones, whose frequencies and decays all records have in common, are fitted to
    the discrete Fourier transforms, half an octave at a time, of at most 1000 cycles. In white
    noise this is the fit of greatest likelihood in the band; deviations are a tenth or so above the
    Cramer-Rao bound of the whole record. Tones are added as long as the extended Bayesian
    information criterion falls. Intervals are those of the fit; of a damping ratio those of its
    logarithm.

    Examples
    --------
    >>> time = np.arange(8192) / 25.6e3
    >>> tone = np.exp(-2.0 * np.pi * 0.01 * 400.0 * time) * np.sin(
    ...     2.0 * np.pi * 400.0 * (1.0 - 0.01**2) ** 0.5 * time
    ... )
    >>> (mode,) = modes_in_decay([Record("a1", tone, 25.6e3, "m/s^2")], (200.0, 800.0))
    >>> round(mode.frequency.value, 3), round(mode.damping_ratio.value, 6)
    (400.0, 0.01)
    """
    value, rate = _checked(records, band)
    duration = value.shape[1] / rate
    bands = tuple(bands_in(band, duration))
    spectra = [_bins(value, rate, low, high) for low, high in bands]
    modes = modes_in_bands(band, bands, spectra, rate)
    return tuple(with_doubts(modes, duration))


def modes_in_bands(
    band: tuple[float, float],
    bands: Sequence[tuple[float, float]],
    spectra: Sequence[Spectra],
    rate: float,
) -> list[DecayMode]:
    """Return the modes in spectra, in the order of their frequencies.

    Parameters
    ----------
    band : tuple of two floats
        The band of frequencies that modes are of [Hz].
    bands : sequence of tuples of two floats
        The bands that are fitted at once [Hz].
    spectra : sequence of Spectra
        The spectra in each and in its margins.
    rate : float
        Frequency of one turn per unit of time of the spectra [Hz]: the rate of samples, or 1 for
        radians per second.
    """
    turn = 2.0 * np.pi / rate
    tones_of_bands = [tones_in(bins) for bins in spectra]
    # each band has its own tones; those in its margins are of its neighbours
    own_tones = [
        tones.part((tones.frequency >= turn * low) & (tones.frequency < turn * high))
        for (low, high), tones in zip(bands, tones_of_bands, strict=True)
    ]
    # once more, without what the tones of other bands leave in each
    refined = []
    for number, bins in enumerate(spectra):
        of_others = [*own_tones[:number], *own_tones[number + 1 :]]
        alone = _alone(bins, of_others)
        refined.append(tones_in(alone.weighed(tones_of_bands[number])))

    modes: list[DecayMode] = []
    for (low, high), bins, tones in zip(bands, spectra, refined, strict=True):
        resolution = bins.step / turn
        highest_below = modes[-1].frequency.value if modes else 0.0
        for mode in _modes(tones, rate):
            frequency = mode.frequency.value
            inside = (
                low - resolution <= frequency < high + resolution
                and band[0] <= frequency <= band[1]
            )
            in_band_below_too = (
                frequency < low + 2.0 * resolution and abs(frequency - highest_below) < resolution
            )
            rings = mode.damping_ratio.value < _LARGEST_DAMPING
            if inside and not in_band_below_too and rings:
                modes.append(mode)
    return sorted(modes, key=lambda mode: mode.frequency.value)


def _alone(bins: Spectra, of_others: Sequence[Tones]) -> Spectra:
    """Return the spectra in a band without the tones of other bands outside of its margins."""
    low, high = bins.omega[[0, -1]]
    for tones in of_others:
        bins = bins.without(tones.part((tones.frequency < low) | (tones.frequency > high)))
    return bins


def _checked(records: Sequence[Record], band: tuple[float, float]) -> tuple[Floats, float]:
    """Return the samples of records, (S, samples), and their rate.

    Raises
    ------
    InputError
        As `modes_in_decay`.
    """
    if not records:
        raise InputError("there is no record; give at least one")
    rate = records[0].rate
    samples = len(records[0].value)
    if any(record.rate != rate or len(record.value) != samples for record in records):
        raise InputError(
            "the records have different rates or numbers of samples; give those of one acquisition"
        )
    for record in records:
        name = quoted(record.name)
        if not np.isfinite(record.value).all():
            raise InputError(f"a sample of {name} is not a finite number")
        if samples == 0:
            raise InputError(f"the record {name} has no samples")
        if np.ptp(record.value) == 0.0:
            raise InputError(f"the record {name} is constant; nothing decays in it")
    low, high = band
    if not 0.0 < low < high <= 0.5 * rate:
        raise InputError(
            f"a band from {low:g} to {high:g} Hz is not allowed; its ends must rise, from "
            f"above 0 to {0.5 * rate:g} Hz, half the rate"
        )
    if (high - low) * samples < _BINS * rate:
        bins = int((high - low) * samples / rate)
        raise InputError(
            f"the spectrum has {bins} values in a band of {high - low:g} Hz by a decay of "
            f"{samples / rate:.3g} s, and {_BINS} at least are needed; take a longer decay or a "
            "wider band"
        )
    return np.stack([record.value for record in records]), rate


def bands_in(band: tuple[float, float], duration: float) -> Iterator[tuple[float, float]]:
    """Yield the bands that are fitted at once: half octaves, or wider ones of a short record."""
    low, end = band
    while low < end:
        least_width = _BINS / min(duration, _CYCLES / low)
        high = max(low * _WIDTH, low + least_width)
        # a narrow rest joins the last band
        if end - high < max(0.5 * (high - low), least_width):
            high = end
        yield low, high
        low = high


def _bins(value: Floats, rate: float, low: float, high: float) -> Bins:
    """Return the spectra in a band and its margins."""
    samples = min(value.shape[1], round(_CYCLES * rate / low))
    first = int(np.ceil(low / _MARGIN * samples / rate))
    last = int(np.floor(_MARGIN * high * samples / rate))
    # neither zero nor half the rate, whose spectra are real
    bins = np.arange(max(first, 1), min(last, (samples - 1) // 2) + 1)
    used = value[:, :samples]
    floor = _LEAST_NOISE * np.sqrt(np.mean(used**2, axis=1))
    return Bins(2.0 * np.pi / samples * bins, fft.rfft(used)[:, bins], floor, samples)


def _modes(tones: Tones, rate: float) -> Iterator[DecayMode]:
    """Yield the modes of tones: poles of the magnitude omega and the damping ratio d / omega."""
    to_hertz = rate / (2.0 * np.pi)
    for decay, frequency, covariance, amplitude in zip(
        tones.decay, tones.frequency, tones.covariance, tones.amplitude, strict=True
    ):
        magnitude = float(np.hypot(decay, frequency))
        ratio = float(decay / magnitude)
        # derivatives by the logarithm of the decay, and by the frequency
        magnitude_slope = np.array([decay * ratio, frequency / magnitude])
        log_ratio_slope = np.array([1.0, 0.0]) - magnitude_slope / magnitude
        magnitude_deviation = _deviation(magnitude_slope, covariance)
        yield DecayMode(
            Estimate(to_hertz * magnitude, to_hertz * magnitude_deviation),
            Estimate(ratio, _deviation(log_ratio_slope, covariance), logarithmic=True),
            tuple((2.0 * np.abs(amplitude)).tolist()),
        )


def _deviation(slope: Floats, covariance: Floats) -> float:
    """Return the standard deviation of a number with a slope by parameters with a covariance."""
    return float(np.sqrt(max(float(slope @ covariance @ slope), 0.0)))


def with_doubts(modes: Sequence[DecayMode], duration: float) -> Iterator[DecayMode]:
    """Yield modes with the doubt about their damping, from so much time of decay [s]."""
    frequencies = np.array([mode.frequency.value for mode in modes])
    for number, mode in enumerate(modes):
        if mode.damping_ratio.deviation < _VAGUE:
            yield mode
            continue
        frequency = frequencies[number]
        distance = np.abs(frequencies - frequency)
        distance[number] = np.inf
        nearest = int(np.argmin(distance))
        bin_width = 1.0 / min(duration, _CYCLES / frequency)
        half_power_width = 2.0 * mode.damping_ratio.value * frequency
        if distance[nearest] < _APART * max(bin_width, half_power_width):
            doubt = f"too close to the mode at {frequencies[nearest]:.5g} Hz"
        else:
            doubt = "too noisy, or too weak"
        yield replace(mode, doubt=doubt)
