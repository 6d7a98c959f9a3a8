"""Energies of wavelet packets.

The signal is halved into low and high frequencies, and each half again.
"""

from __future__ import annotations

import itertools

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature

_LEVELS = 3
_NODES = 2**_LEVELS

_LOW = (
    0.2303778133088965,
    0.7148465705529157,
    0.6308807679298589,
    -0.027983769416859854,
    -0.18703481171909309,
    0.030841381835560764,
    0.0328830116668852,
    -0.010597401785069032,
)
"""Daubechies's filter of four vanishing moments (1988, table 1)."""

_HIGH = tuple((-1) ** order * tap for order, tap in enumerate(reversed(_LOW)))
"""Its mirror filter."""


def wavelet_packet_energies(value: Floats) -> Floats:
    """Return the energies of the eight wavelet packets of level 3, from low to high frequencies.

    The transform is orthogonal, of the record as a period, with zeros up to a multiple of eight
    samples: the energies add up to the sum of the squares of the samples.

    Parameters
    ----------
    value : array, shape (n, samples)
        The signals.

    Returns
    -------
    array, shape (n, 8)
        The energies.
    """
    nodes = [np.pad(value, ((0, 0), (0, -value.shape[1] % _NODES)))]
    for _ in range(_LEVELS):
        # the high half of a node that is itself a high half has its frequencies reversed
        filters = itertools.cycle((_LOW, _HIGH, _HIGH, _LOW))
        nodes = [_filtered(node, next(filters)) for node in nodes for _ in range(2)]
    return np.stack([np.einsum("ij,ij->i", node, node) for node in nodes], axis=1)


def _filtered(value: Floats, taps: tuple[float, ...]) -> Floats:
    """Return every second sample of the circular correlation of signals with a filter.

    It begins three samples before the first one.
    """
    samples = value.shape[1]
    wrapped = value[:, np.arange(-3, samples + len(taps) - 4) % samples]
    filtered = taps[0] * wrapped[:, 0:samples:2]
    for lag, tap in enumerate(taps[1:], 1):
        filtered += tap * wrapped[:, lag : lag + samples : 2]
    return np.asarray(filtered)


def _packet_energies_and_entropy(block: Block) -> Floats:
    share = wavelet_packet_energies(block.value) / block.square_sum[:, None]
    log_share = np.log(np.maximum(share, np.finfo(float).tiny))
    entropy = -np.sum(share * log_share, axis=1, keepdims=True) / np.log(_NODES)
    return np.concatenate([share, np.maximum(entropy, 0.0)], axis=1)


_SOURCE = (
    "Coifman & Wickerhauser 1992, IEEE Trans. Inf. Theory 38:713; Daubechies 1988, Commun. Pure "
    "Appl. Math. 41:909"
)

FAMILY = Family(
    (
        *(
            Feature(
                name=f"wavelet_packet_{number}",
                meaning=f"part of the energy in wavelet packet {number} of 8, from low to high "
                "frequencies",
                equation=f"sum(c[{number}]^2) / sum(x^2), c of db4, level 3",
                source=_SOURCE,
                least=_NODES,
            )
            for number in range(1, _NODES + 1)
        ),
        Feature(
            name="wavelet_entropy",
            meaning="entropy of the energies of the wavelet packets, of 1 at most",
            equation="-sum(p ln p) / ln(8), p of the 8 packets",
            source="Rosso et al. 2001, J. Neurosci. Methods 105:65",
            least=_NODES,
        ),
    ),
    _packet_energies_and_entropy,
)
