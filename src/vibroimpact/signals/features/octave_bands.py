"""Energies in octave bands below half the sampling rate."""

from __future__ import annotations

import itertools

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature

_BANDS = 6
_LEAST = 2 ** (_BANDS + 2)  # two frequencies in the lowest band


def _of(block: Block) -> Floats:
    total = block.power.sum(axis=1)
    half = block.rate / 2.0
    edges = np.searchsorted(
        block.frequency, half / 2.0 ** np.arange(_BANDS + 1) * (1.0 + 1e-12), side="right"
    )
    bands = [
        block.power[:, low:high].sum(axis=1) / total for high, low in itertools.pairwise(edges)
    ]
    return np.stack(bands, axis=1)


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
    _of,
)
