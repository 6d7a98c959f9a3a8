"""Shape of the energy spectrum."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature
from vibroimpact.signals.reasons import Reason

_ROLL_OFF = 0.85
_TINY = 1e-30
"""Energy that counts as nothing beside that of the signal, so that its logarithm is finite."""


def _spectral_features(block: Block) -> Floats:
    frequency = block.frequency / block.rate  # whose squares stay in range
    share = block.power / block.power.sum(axis=1, keepdims=True)
    amplitude = np.abs(block.transform)
    centroid = share @ frequency
    # of a signal that is zero throughout there is no spectrum
    silent = np.isnan(centroid)

    # rounding may make the variance of a pure tone negative
    variance = np.maximum(share @ frequency**2 - centroid**2, 0.0)
    bandwidth = np.sqrt(variance)
    roll_off_bin = np.count_nonzero(np.cumsum(share, axis=1) < _ROLL_OFF, axis=1)
    roll_off = frequency[np.minimum(roll_off_bin, len(frequency) - 1)]
    roll_off = np.where(silent, np.nan, roll_off)
    peak_frequency = np.where(silent, np.nan, frequency[amplitude.argmax(axis=1)])
    amplitude_centroid = amplitude @ frequency / amplitude.sum(axis=1)
    cut_off = _cut_off(amplitude, frequency)

    log_share = np.log(share + _TINY)
    # the arithmetic mean of the shares is 1 over their number
    flatness = np.exp(log_share.mean(axis=1)) * len(frequency)
    entropy = np.maximum(-np.einsum("ij,ij->i", share, log_share), 0.0)
    relative_entropy = entropy / np.log(len(frequency))

    frequencies = [centroid, amplitude_centroid, bandwidth, roll_off, peak_frequency, cut_off]
    with_unit = np.stack(frequencies, axis=1) * block.rate
    without_unit = np.stack([flatness, relative_entropy], axis=1)
    return np.concatenate([with_unit, without_unit], axis=1)


def _cut_off(amplitude: Floats, frequency: Floats) -> Floats:
    """Return the highest frequency at which the amplitude is 10 dB below its maximum.

    Between the frequencies of the transform the logarithm of the amplitude is linear.
    """
    signal = np.arange(len(amplitude))
    level = amplitude.max(axis=1, keepdims=True) / np.sqrt(10.0)
    last = amplitude.shape[1] - 1 - (amplitude >= level)[:, ::-1].argmax(axis=1)
    following = np.minimum(last + 1, len(frequency) - 1)
    above = np.log(amplitude[signal, last] / level[:, 0] + _TINY)
    below = np.log(amplitude[signal, following] / level[:, 0] + _TINY)
    step = frequency[following] - frequency[last]
    cut_off = frequency[last] + step * above / (above - below)
    # above that level up to the end of the band, it is not seen
    return np.asarray(np.where(last < following, cut_off, np.nan))


_PEETERS = "Peeters 2004, A large set of audio features, IRCAM, section 6.1, by the energy"

FAMILY = Family(
    (
        Feature(
            name="spectral_centroid",
            meaning="mean frequency of the energy",
            equation="sum(f P) / sum(P)",
            source=_PEETERS,
            unit="Hz",
        ),
        Feature(
            name="amplitude_centroid",
            meaning="mean frequency of the amplitude spectrum, the centroid frequency of bedload "
            "measurement",
            equation="sum(f |X|) / sum|X|",
            source="Wyss et al. 2016, Water Resour. Res. 52:7744",
            unit="Hz",
        ),
        Feature(
            name="spectral_bandwidth",
            meaning="standard deviation of the frequency of the energy",
            equation="sqrt(sum((f - centroid)^2 P) / sum(P))",
            source=_PEETERS,
            unit="Hz",
        ),
        Feature(
            name="spectral_roll_off",
            meaning=f"frequency below which {_ROLL_OFF:.0%} of the energy lies".replace("%", " %"),
            equation=f"least f with sum(P up to f) >= {_ROLL_OFF:g} sum(P)",
            source="Tzanetakis & Cook 2002, IEEE Trans. Speech Audio Process. 10:293, by the "
            "energy",
            unit="Hz",
        ),
        Feature(
            name="peak_frequency",
            meaning="frequency of the largest amplitude",
            equation="argmax |X|",
            source="of this program",
            unit="Hz",
        ),
        Feature(
            name="cut_off_10_dB",
            meaning="highest frequency at which the amplitude is 10 dB below its maximum: 1.16 "
            "over the contact time, of Hertz's force",
            equation="largest f with |X| = max|X| / sqrt(10)",
            source="ISO 7626-5, of hammers",
            unit="Hz",
            lacking=Reason.BROAD_BAND,
        ),
        Feature(
            name="spectral_flatness",
            meaning="geometric over arithmetic mean of the energy: 0 of tones, 0.56 of white noise",
            equation="exp(mean(ln P)) / mean(P)",
            source="Johnston 1988, IEEE J. Sel. Areas Commun. 6:314",
        ),
        Feature(
            name="spectral_entropy",
            meaning="entropy of the energy over the frequencies, of 1 at most",
            equation="-sum(p ln p) / ln(number of p), p = P / sum(P)",
            source="Misra et al. 2004, Proc. ICASSP 1:193",
            least=2,
        ),
    ),
    _spectral_features,
)
