r"""The place of a pulse by least squares over a grid: impulse, duration and instant are eliminated
at each place.

Where the record of a unit pulse at a place is :math:`\sum_i \varphi_i\,h_i`, the least misfit over
the impulse J of records d is

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
    """The best pulse at each place: misfit (places,), impulse [N s], duration [s] and
    number of the first touch.
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
    energy = float(records @ records)
    best = Matched(np.full(len(shapes), energy), *np.zeros((3, len(shapes))))
    for duration in durations:
        middle = responses(duration, touches[len(touches) // 2])
        # the energy of a pulse hardly depends on when it is
        power = np.einsum("pi,ij,pj->p", shapes, middle @ middle.T, shapes, optimize=True)
        for touch in touches:
            # a force pushes
            along = np.maximum(shapes @ (responses(duration, touch) @ records), 0.0)
            impulse = np.divide(along, power, out=np.zeros_like(along), where=power > 0.0)
            misfit = energy - along * impulse
            better = misfit < best.misfit
            found = (misfit, impulse, np.full(len(shapes), duration), np.full(len(shapes), touch))
            best = Matched(
                *(np.where(better, new, old) for new, old in zip(found, best, strict=True))
            )
    return best


def local_minima(values: Floats) -> Integers:
    """Return the places in a flattened grid (rows, columns) whose values are below those of their
    eight neighbours, the least first.

    Examples
    --------
    >>> local_minima(np.array([[3.0, 2.0, 3.0, 4.0], [4.0, 4.0, 4.0, 1.0]])).tolist()
    [7, 1]
    """
    padded = np.pad(values, 1, constant_values=np.inf)
    around = np.lib.stride_tricks.sliding_window_view(padded, (3, 3)).reshape(*values.shape, 9)
    lowest = np.flatnonzero((around.argmin(axis=-1) == 4).ravel())
    return np.asarray(lowest[np.argsort(values.ravel()[lowest])])
