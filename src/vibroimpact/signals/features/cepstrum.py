"""Cepstral coefficients: the shape of the logarithmic spectrum, from coarse to fine.

Its bands are of equal width: those of the mel scale follow the ear, and a plate has none.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy import fft

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature

_BANDS = 20
_COEFFICIENTS = 8
_LEAST = 4 * _BANDS
_FLOOR = 1e-10
"""Energy of a band that counts as none, as a part of the whole: -100 dB."""


def _cepstral_coefficients(block: Block) -> Floats:
    energy = block.power @ _triangular_windows(block.power.shape[1])
    level = np.log(energy / block.power.sum(axis=1, keepdims=True) + _FLOOR)
    # the first coefficient is the size of all bands, and no shape
    return np.asarray(fft.dct(level, axis=1, norm="ortho")[:, 1 : _COEFFICIENTS + 1])


@lru_cache(maxsize=8)
def _triangular_windows(frequencies: int) -> Floats:
    """Return triangular windows, (frequencies, bands), that overlap by half.

    They fill the range from zero to half the rate.
    """
    position = np.linspace(0.0, _BANDS + 1.0, frequencies)[:, None]
    return np.asarray(np.maximum(1.0 - np.abs(position - np.arange(1, _BANDS + 1)), 0.0))


FAMILY = Family(
    tuple(
        Feature(
            name=f"cepstrum_{number}",
            meaning=f"cepstral coefficient {number} of 20 linear bands",
            equation=f"sqrt(2/20) sum(ln(E[b]/sum(P) + 1e-10) cos(pi {number} (b - 1/2) / 20), b = "
            "1..20), E of triangular bands",
            source="Davis & Mermelstein 1980, IEEE Trans. Acoust. Speech Signal Process. 28:357, "
            "with linear bands",
            least=_LEAST,
        )
        for number in range(1, _COEFFICIENTS + 1)
    ),
    _cepstral_coefficients,
)
