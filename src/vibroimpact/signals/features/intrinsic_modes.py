"""Energies of intrinsic modes: oscillations of rising period that empirical mode
decomposition takes off a signal.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.signals.block import Block
from vibroimpact.signals.cubic_through import cubic_through
from vibroimpact.signals.feature import Family, Feature

_MODES, _SIFTINGS = 4, 6
_LEAST = 16
_LEVEL = 1e-10
"""Difference of neighbours, beside the largest magnitude of the signal, that counts as
none: differences of cubics have rounding errors.
"""


def intrinsic_modes(value: Floats, modes: int = _MODES, siftings: int = _SIFTINGS) -> Floats:
    """Return the first intrinsic modes of signals.

    A sifting takes the mean of the cubics through the maxima and through the minima off the signal.
    What a fixed number of them leaves is the first mode; it is taken off, and the rest has the next
    one. A rest without a maximum and a minimum has no mode. The cubics are monotone between knots:
    the customary splines overshoot by orders of magnitude in the silence between two impacts.

    Parameters
    ----------
    value : array, shape (n, samples)
        The signals.
    modes : int, default 4
        How many.
    siftings : int, default 6
        Siftings of each mode; a fixed number makes the decomposition the same at every scale (Wu
        and Huang 2009).

    Returns
    -------
    array, shape (modes, n, samples)
        The modes; zero where there is none.
    """
    found, rest, least = (
        np.zeros((modes, *value.shape)),
        value.copy(),
        _LEVEL * np.abs(value).max(axis=1),
    )
    left = np.arange(len(value))  # signals whose rest has a mode
    for mode in found:
        going, sifted = left, rest[left]
        for number in range(siftings):
            tops, bottoms = _extrema(sifted, least[going])
            both = np.minimum(_count(tops, sifted), _count(bottoms, sifted)) > 0
            if not both.all():
                if number:  # a mode without a maximum or a minimum stays as it is
                    mode[going] = sifted
                going, sifted = going[both], sifted[both]
                left = left if number else going
                tops, bottoms = _extrema(sifted, least[going])
            sifted -= 0.5 * (cubic_through(sifted, tops) + cubic_through(sifted, bottoms))
        mode[going] = sifted
        rest -= mode
    return found


def _extrema(value: Floats, least: Floats) -> tuple[Indices, Indices]:
    """Return places of maxima and minima in flattened signals, by steps above the least
    (n,); of equal neighbours the first.
    """
    step = np.zeros_like(value)  # the last one of a signal is none
    np.subtract(value[:, 1:], value[:, :-1], out=step[:, :-1])
    moving = np.flatnonzero(np.abs(step) > least[:, None])
    up = step.ravel()[moving] > 0.0
    turns = np.zeros(len(moving), dtype=bool)
    turns[:-1] = up[1:] != up[:-1]
    ends = np.searchsorted(moving, value.shape[1] * np.arange(1, len(value))) - 1
    turns[ends[ends >= 0]] = False  # from one signal to the next
    place, top = moving[turns] + 1, up[turns]
    return place[top], place[~top]


def _count(places: Indices, value: Floats) -> Indices:
    """Return how many of some places, in rising order, lie in each signal."""
    return np.asarray(np.diff(np.searchsorted(places, value.shape[1] * np.arange(len(value) + 1))))


def _of(block: Block) -> Floats:
    modes = intrinsic_modes(block.value)
    return np.asarray(np.einsum("mij,mij->im", modes, modes) / block.square_sum[:, None])


FAMILY = Family(
    tuple(
        Feature(
            name=f"intrinsic_mode_{number}",
            meaning=f"energy of intrinsic mode {number} over that of the signal",
            equation=f"sum(c[{number}]^2) / sum(x^2), c by {_SIFTINGS} siftings with monotone "
            "cubics",
            source="Huang et al. 1998, Proc. R. Soc. A 454:903; Wu & Huang 2009, Adv. Adapt. Data "
            "Anal. 1:1",
            least=_LEAST,
        )
        for number in range(1, _MODES + 1)
    ),
    _of,
)
