"""Energies of intrinsic modes: oscillations of rising period that empirical mode decomposition takes off a signal."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.cubic_through import cubic_through
from vibroimpact.signals.feature import Family, Feature

_MODES, _SIFTINGS = 4, 6
_LEAST = 16
_LEVEL = 1e-10
"""Difference of neighbours, beside the largest magnitude of the signal, that counts as none: differences of cubics have rounding errors."""


def intrinsic_modes(value: Floats, modes: int = _MODES, siftings: int = _SIFTINGS) -> Floats:
    """Return the first intrinsic modes of signals.

    A sifting takes the mean of the cubics through the maxima and through the minima off the signal. What a fixed number of them leaves is
    the first mode; it is taken off, and the rest has the next one. A rest without a maximum and a minimum has no mode. The cubics are
    monotone between knots: the customary splines overshoot by orders of magnitude in the silence between two impacts.

    Parameters
    ----------
    value : array, shape (n, samples)
        The signals.
    modes : int, default 4
        How many.
    siftings : int, default 6
        Siftings of each mode; a fixed number makes the decomposition the same at every scale (Wu and Huang 2009).

    Returns
    -------
    array, shape (modes, n, samples)
        The modes; zero where there is none.
    """
    found, rest, least = np.zeros((modes, *value.shape)), value.copy(), _LEVEL * np.abs(value).max(axis=1)
    for mode in found:
        going = np.arange(len(value))
        mode[:] = rest
        for _ in range(siftings):
            tops, bottoms = _extrema(mode[going], least[going])
            more = tops.any(axis=1) & bottoms.any(axis=1)
            if not more.all():
                going, tops, bottoms = going[more], tops[more], bottoms[more]
            sifted = mode[going]
            mode[going] = sifted - 0.5 * (cubic_through(sifted, tops) + cubic_through(sifted, bottoms))
        tops, bottoms = _extrema(rest, least)
        mode[~(tops.any(axis=1) & bottoms.any(axis=1))] = 0.0
        rest -= mode
    return found


def _extrema(value: Floats, least: Floats) -> tuple[Bools, Bools]:
    """Return which samples are maxima and which are minima, by differences above the least (n,); of equal neighbours the first."""
    step = np.diff(value, axis=1)
    rising, falling = step > least[:, None], step < -least[:, None]
    level = ~(rising | falling)
    if level.any():  # a level part ends as the part before it went on, unless the next one turns
        number = np.arange(step.shape[1])
        back = np.maximum.accumulate(np.where(level, 0, number), axis=1)
        ahead = np.minimum.accumulate(np.where(level, step.shape[1] - 1, number)[:, ::-1], axis=1)[:, ::-1]
        row = np.arange(len(value))[:, None]
        rising_before, falling_before = rising[row, back], falling[row, back]
        rising_after, falling_after = rising[row, ahead], falling[row, ahead]
    else:
        rising_before, falling_before, rising_after, falling_after = rising, falling, rising, falling
    tops, bottoms = np.zeros((2, *value.shape), dtype=bool)
    moved = ~level[:, :-1]
    tops[:, 1:-1] = moved & rising_before[:, :-1] & falling_after[:, 1:]
    bottoms[:, 1:-1] = moved & falling_before[:, :-1] & rising_after[:, 1:]
    return tops, bottoms


def _of(block: Block) -> Floats:
    modes = intrinsic_modes(block.value)
    return np.asarray(np.einsum("mij,mij->im", modes, modes) / block.square_sum[:, None])


FAMILY = Family(
    tuple(
        Feature(
            name=f"intrinsic_mode_{number}",
            meaning=f"energy of intrinsic mode {number} over that of the signal",
            equation=f"sum(c[{number}]^2) / sum(x^2), c by {_SIFTINGS} siftings with monotone cubics",
            source="Huang et al. 1998, Proc. R. Soc. A 454:903; Wu & Huang 2009, Adv. Adapt. Data Anal. 1:1",
            least=_LEAST,
        )
        for number in range(1, _MODES + 1)
    ),
    _of,
)
