"""Skewness and kurtosis: the third and fourth moment of the samples about their mean."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature
from vibroimpact.signals.reasons import Reason


def _moments(block: Block) -> Floats:
    # from the first sample, so that a constant has no deviation at all
    centred = block.value - block.value[:, :1]
    centred -= centred.mean(axis=1, keepdims=True)
    largest = np.abs(centred).max(axis=1, keepdims=True)
    centred /= largest  # small deviations of a large signal would underflow
    square = centred * centred
    variance = square.mean(axis=1)
    third_power = np.einsum("ij,ij->i", square, centred)
    fourth_power = np.einsum("ij,ij->i", square, square)
    skewness = third_power / block.samples / variance**1.5
    kurtosis = fourth_power / block.samples / variance**2
    return np.stack([skewness, kurtosis], axis=1)


_SOURCE = "Joanes & Gill 1998, J. R. Stat. Soc. D 47:183"

FAMILY = Family(
    (
        Feature(
            name="skewness",
            meaning="third standardized moment: 0 if symmetrical about the mean",
            equation="mean((x - mean(x))^3) / mean((x - mean(x))^2)^1.5",
            source=f"{_SOURCE}, g1",
            offset_free=True,
            lacking=Reason.CONSTANT,
        ),
        Feature(
            name="kurtosis",
            meaning="fourth standardized moment: 3 for normal noise, more for impulses",
            equation="mean((x - mean(x))^4) / mean((x - mean(x))^2)^2",
            source=f"{_SOURCE}, g2 + 3",
            offset_free=True,
            lacking=Reason.CONSTANT,
        ),
    ),
    _moments,
)
