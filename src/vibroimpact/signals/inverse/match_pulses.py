r"""The place of a pulse by least squares over a grid.

Its impulse, duration and instant are eliminated at each place. Where the record of a unit pulse at
a place is :math:`\sum_i \varphi_i\,h_i`, the least misfit over the impulse J of records d is

.. math::

    |d|^2 - \frac{(\sum_i \varphi_i\,h_i \cdot d)^2}{\sum_{ij} \varphi_i \varphi_j\,h_i \cdot h_j}

so that a place costs a quadratic form in its mode shapes, however long the records.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Integers


class Matched(NamedTuple):
    """The best pulse at each place, (places,) each.

    Its misfit, impulse [N s], duration [s] and the number of its first touch.
    """

    misfit: Floats
    impulse: Floats
    duration: Floats
    touch: Floats


def match_pulses(
    shapes: Floats,
    records: Floats,
    responses: Callable[[float, int], Floats],
    durations: Iterable[float],
    touches: Sequence[int],
) -> Matched:
    """Return the best pulse at each place.

    Parameters
    ----------
    shapes : array, shape (places, modes)
        Mode shapes at the places.
    records : array, shape (n,)
        The samples of all records, over the standard deviations of their noise.
    responses : callable
        Takes the duration [s] and the number of the first touch of a unit pulse and returns the
        records of it in each mode, (modes, n).
    durations : iterable of float
        Durations that are tried [s].
    touches : sequence of int
        Numbers of the first touches that are tried.

    Examples
    --------
    A pulse on the first of two places, each of which moves in one mode:

    >>> records = np.array([0.0, 0.0, 3.0, 0.0])
    >>> found = match_pulses(
    ...     np.eye(2),
    ...     records,
    ...     lambda duration, touch: np.stack([np.eye(4)[touch], np.ones(4)]),
    ...     [1.0],
    ...     range(4),
    ... )
    >>> found.misfit.tolist(), found.impulse.tolist(), float(found.touch[0])
    ([0.0, 6.75], [3.0, 0.75], 2.0)
    """
    places = len(shapes)
    energy = float(records @ records)
    best = Matched(np.full(places, energy), np.zeros(places), np.zeros(places), np.zeros(places))
    for duration in durations:
        middle = responses(duration, touches[len(touches) // 2])
        # the energy of a pulse hardly depends on when it is
        power = np.einsum("pi,ij,pj->p", shapes, middle @ middle.T, shapes, optimize=True)
        for touch in touches:
            # a force pushes
            correlation = np.maximum(shapes @ (responses(duration, touch) @ records), 0.0)
            no_impulse = np.zeros_like(correlation)
            impulse = np.divide(correlation, power, out=no_impulse, where=power > 0.0)
            misfit = energy - correlation * impulse
            better = misfit < best.misfit
            best = Matched(
                np.where(better, misfit, best.misfit),
                np.where(better, impulse, best.impulse),
                np.where(better, duration, best.duration),
                np.where(better, float(touch), best.touch),
            )
    return best


def local_minima(values: Floats) -> Integers:
    """Return the local minima of a grid (rows, columns), as indices of the flattened array.

    They are below their eight neighbours, and sorted with the least first.

    Examples
    --------
    >>> local_minima(np.array([[3.0, 2.0, 3.0, 4.0], [4.0, 4.0, 4.0, 1.0]])).tolist()
    [7, 1]
    """
    padded = np.pad(values, 1, constant_values=np.inf)
    around = np.lib.stride_tricks.sliding_window_view(padded, (3, 3)).reshape(*values.shape, 9)
    is_lowest = around.argmin(axis=-1) == 4  # the middle of the nine
    minima = np.flatnonzero(is_lowest.ravel())
    return np.asarray(minima[np.argsort(values.ravel()[minima])])
