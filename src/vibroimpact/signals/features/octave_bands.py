"""Energies in octave bands below half the sampling rate."""

from __future__ import annotations

import itertools

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature

_BANDS = 6
_LEAST = 2 ** (_BANDS + 2)  # two frequencies in the lowest band


def _octave_band_energies(block: Block) -> Floats:
    total = block.power.sum(axis=1)
    # edges of the bands, from half the rate down; a frequency on an edge is in the band below,
    # whatever its rounding error
    edges = block.rate / 2.0 / 2.0 ** np.arange(_BANDS + 1) * (1.0 + 1e-12)
    ends = np.searchsorted(block.frequency, edges, side="right")
    shares = [
        block.power[:, first:end].sum(axis=1) / total for end, first in itertools.pairwise(ends)
    ]
    return np.stack(shares, axis=1)


FAMILY = Family(
    tuple(
        Feature(
            name=f"octave_band_{number}",
            meaning=f"part of the energy in octave {number} below half the rate",
            equation=f"sum(P, rate/{2 ** (number + 1)} < f <= rate/{2**number}) / sum(P)",
            source="of this program: ratios of 2 down from half the rate, not standard octave "
            "bands",
            least=_LEAST,
        )
        for number in range(1, _BANDS + 1)
    ),
    _octave_band_energies,
)
