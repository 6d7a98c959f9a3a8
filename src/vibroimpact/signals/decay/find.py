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

_WIDTH, _MARGIN = 2.0**0.5, 1.12
"""Ratio of the ends of a band that is fitted at once, and how far beyond them tones are
fitted too.
"""
_CYCLES = 1000.0
"""Cycles of the lowest frequency of a band that are used of it."""
_BINS = 32
"""Least number of bins in a band."""
_LEAST_NOISE = 1e-4
"""Least noise, relative to the rms value of a record: no plate is linear beyond."""
_WIDEST = 0.2
"""Largest damping ratio: what is damped more does not ring."""
_VAGUE = 0.25
"""Standard deviation of the logarithm of a damping ratio from which on it counts as unknown."""
_APART = 3.0
"""Distance of modes that are close to each other: in bins, or in half-power bandwidths."""


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
    >>> ringing = vi.Record(
    ...     "a",
    ...     np.exp(-2.0 * np.pi * 400.0 * 0.01 * time) * np.sin(2.0 * np.pi * 400.0 * time),
    ...     10e3,
    ...     "m/s2",
    ... )
    >>> (mode,) = vi.modes_in_decay([ringing], (300.0, 500.0))
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
    bands = tuple(bands_in(band, value.shape[1] / rate))
    modes = modes_in_bands(band, bands, [_bins(value, rate, *ends) for ends in bands], rate)
    return tuple(with_doubts(modes, value.shape[1] / rate))


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
    found = [tones_in(one) for one in spectra]
    # once more, without what the tones of other bands leave in each
    own = [
        one.part((one.frequency >= turn * low) & (one.frequency < turn * high))
        for (low, high), one in zip(bands, found, strict=True)
    ]
    alone = [_alone(one, [*own[:number], *own[number + 1 :]]) for number, one in enumerate(spectra)]
    found = [tones_in(one.weighed(tones)) for one, tones in zip(alone, found, strict=True)]
    modes: list[DecayMode] = []
    for (low, high), one, tones in zip(bands, spectra, found, strict=True):
        resolution, last = one.step / turn, modes[-1].frequency.value if modes else 0.0
        for mode in _modes(tones, rate):
            place = mode.frequency.value
            inside = low - resolution <= place < high + resolution and band[0] <= place <= band[1]
            # in the band below too
            twice = place < low + 2.0 * resolution and abs(place - last) < resolution
            if inside and not twice and mode.damping_ratio.value < _WIDEST:
                modes.append(mode)
    return sorted(modes, key=lambda mode: mode.frequency.value)


def _alone(bins: Spectra, others: Sequence[Tones]) -> Spectra:
    """Return the spectra in a band without the tones of other bands that lie outside of
    its margins.
    """
    low, high = bins.omega[[0, -1]]
    for one in others:
        bins = bins.without(one.part((one.frequency < low) | (one.frequency > high)))
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
    rate, samples = records[0].rate, len(records[0].value)
    if any((one.rate, len(one.value)) != (rate, samples) for one in records):
        raise InputError(
            "the records have different rates or numbers of samples; give those of one acquisition"
        )
    for one in records:
        if not np.isfinite(one.value).all():
            raise InputError(f"a sample of {quoted(one.name)} is not a finite number")
        if samples == 0:
            raise InputError(f"the record {quoted(one.name)} has no samples")
        if np.ptp(one.value) == 0.0:
            raise InputError(f"the record {quoted(one.name)} is constant; nothing decays in it")
    low, high = band
    if not 0.0 < low < high <= 0.5 * rate:
        raise InputError(
            f"a band from {low:g} to {high:g} Hz is not allowed; its ends must rise, from "
            f"above 0 to {0.5 * rate:g} Hz, half the rate"
        )
    if (high - low) * samples < _BINS * rate:
        values = int((high - low) * samples / rate)
        words = (
            f"the spectrum has {values} values in a band of {high - low:g} Hz by a decay of "
            f"{samples / rate:.3g} s"
        )
        raise InputError(
            f"{words}, and {_BINS} at least are needed; take a longer decay or a wider band"
        )
    return np.stack([one.value for one in records]), rate


def bands_in(band: tuple[float, float], duration: float) -> Iterator[tuple[float, float]]:
    """Yield the bands that are fitted at once: half octaves, or wider ones where the
    record is short.
    """
    low, end = band
    while low < end:
        least = _BINS / min(duration, _CYCLES / low)
        high = max(low * _WIDTH, low + least)
        if end - high < max(0.5 * (high - low), least):
            high = end
        yield low, high
        low = high


def _bins(value: Floats, rate: float, low: float, high: float) -> Bins:
    """Return the spectra in a band and its margins."""
    samples = min(value.shape[1], round(_CYCLES * rate / low))
    first, last = np.ceil(low / _MARGIN * samples / rate), np.floor(_MARGIN * high * samples / rate)
    number = np.arange(max(int(first), 1), min(int(last), (samples - 1) // 2) + 1)
    part = value[:, :samples]
    floor = _LEAST_NOISE * np.sqrt(np.mean(part**2, axis=1))
    return Bins(2.0 * np.pi / samples * number, fft.rfft(part)[:, number], floor, samples)


def _modes(tones: Tones, rate: float) -> Iterator[DecayMode]:
    for decay, frequency, covariance, amplitude in zip(
        tones.decay, tones.frequency, tones.covariance, tones.amplitude, strict=True
    ):
        size = float(np.hypot(decay, frequency))
        ratio = float(decay / size)
        # by the logarithm of the decay, and by the frequency
        of_size = np.array([decay * ratio, frequency / size])
        of_ratio = np.array([1.0, 0.0]) - of_size / size
        deviations = [
            float(np.sqrt(max(one @ covariance @ one, 0.0))) for one in (of_size, of_ratio)
        ]
        scale = rate / (2.0 * np.pi)
        yield DecayMode(
            Estimate(scale * size, scale * deviations[0]),
            Estimate(ratio, deviations[1], logarithmic=True),
            tuple((2.0 * np.abs(amplitude)).tolist()),
        )


def with_doubts(modes: Sequence[DecayMode], duration: float) -> Iterator[DecayMode]:
    """Yield modes with the doubt about their damping, from so much time of decay [s]."""
    places = np.array([mode.frequency.value for mode in modes])
    for number, mode in enumerate(modes):
        if mode.damping_ratio.deviation < _VAGUE:
            yield mode
            continue
        distance = np.abs(places - places[number])
        distance[number] = np.inf
        nearest = int(np.argmin(distance))
        used = min(duration, _CYCLES / places[number])
        width = max(1.0 / used, 2.0 * mode.damping_ratio.value * places[number])
        close = f"too close to the mode at {places[nearest]:.5g} Hz"
        yield replace(
            mode, doubt=close if distance[nearest] < _APART * width else "too noisy, or too weak"
        )
