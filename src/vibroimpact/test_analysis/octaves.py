"""The octaves of a band, and the frequency response assurance criterion over each."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.signals.frac import frac

FEW = 4
"""Frequencies below which an octave has no criterion: of one it is 1 whatever the signals
are, of n that are unrelated about 1/n.
"""


def octaves_of(band: tuple[float, float]) -> tuple[tuple[float, float], ...]:
    """Return the octaves within a band, whose centres are 1 kHz times powers of 2.

    The outer ones end with the band.

    Examples
    --------
    >>> [(round(low, 1), round(high, 1)) for low, high in octaves_of((300.0, 1600.0))]
    [(300.0, 353.6), (353.6, 707.1), (707.1, 1414.2), (1414.2, 1600.0)]
    """
    number = np.arange(-10, 12)
    edges = 1000.0 * 2.0 ** (number + 0.5)
    inner = edges[(edges > band[0]) & (edges < band[1])]
    return tuple(itertools.pairwise([band[0], *inner.tolist(), band[1]]))


def frac_of_octaves(
    octaves: Sequence[tuple[float, float]], frequency: Floats, measured: Complex, simulated: Complex
) -> Floats:
    """Return the criterion of responses, (S, frequencies), over each octave, (S, octaves).

    It is NaN with fewer than four frequencies in it.
    """
    unknown = np.full(len(measured), np.nan)
    criteria = []
    for low, high in octaves:
        inside = (frequency >= low) & (frequency <= high)
        if inside.sum() < FEW:
            criteria.append(unknown)
        else:
            criteria.append(frac(measured[:, inside], simulated[:, inside]))
    return np.stack(criteria, axis=1)
