"""Energies of intrinsic modes: oscillations of rising period, by empirical mode decomposition."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.signals.block import Block
from vibroimpact.signals.cubic_through import cubic_through
from vibroimpact.signals.feature import Family, Feature

_MODES = 4
_SIFTINGS = 6
_LEAST_SAMPLES = 16
_LEVEL = 1e-10
"""Difference of neighbours, over the largest magnitude of the signal, that counts as none.

Differences of cubics have rounding errors.
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
    found_modes = np.zeros((modes, *value.shape))
    rest = value.copy()
    least_step = _LEVEL * np.abs(value).max(axis=1)
    with_mode = np.arange(len(value))  # the signals whose rest has a mode
    for mode in found_modes:
        signals = with_mode  # those that are still sifted
        sifted = rest[signals]
        for sifting in range(siftings):
            maxima, minima = _extrema(sifted, least_step[signals])
            has_both = np.minimum(_count(maxima, sifted), _count(minima, sifted)) > 0
            if not has_both.all():
                if sifting > 0:  # a mode without a maximum or a minimum stays as it is
                    mode[signals] = sifted
                signals = signals[has_both]
                sifted = sifted[has_both]
                if sifting == 0:  # there is no further mode in the others
                    with_mode = signals
                maxima, minima = _extrema(sifted, least_step[signals])
            sifted -= 0.5 * (cubic_through(sifted, maxima) + cubic_through(sifted, minima))
        mode[signals] = sifted
        rest -= mode
    return found_modes


def _extrema(value: Floats, least_step: Floats) -> tuple[Indices, Indices]:
    """Return maxima and minima of signals, as indices of the flattened array.

    Steps count above the least of each signal, (n,); of equal neighbours it is the first.
    """
    samples = value.shape[1]
    step = np.zeros_like(value)  # the last one of a signal is none
    np.subtract(value[:, 1:], value[:, :-1], out=step[:, :-1])
    moving = np.flatnonzero(np.abs(step) > least_step[:, None])
    rises = step.ravel()[moving] > 0.0
    turns = np.zeros(len(moving), dtype=bool)
    turns[:-1] = rises[1:] != rises[:-1]
    # from one signal to the next there is no turn
    ends_of_signals = samples * np.arange(1, len(value))
    last_of_signal = np.searchsorted(moving, ends_of_signals) - 1
    turns[last_of_signal[last_of_signal >= 0]] = False
    extrema = moving[turns] + 1
    is_maximum = rises[turns]
    return extrema[is_maximum], extrema[~is_maximum]


def _count(extrema: Indices, value: Floats) -> Indices:
    """Return how many extrema, in rising order, lie in each signal."""
    bounds = value.shape[1] * np.arange(len(value) + 1)
    return np.asarray(np.diff(np.searchsorted(extrema, bounds)))


def _intrinsic_mode_energies(block: Block) -> Floats:
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
            least=_LEAST_SAMPLES,
        )
        for number in range(1, _MODES + 1)
    ),
    _intrinsic_mode_energies,
)
