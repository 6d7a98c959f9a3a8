r"""The moment against twisting of a contact that also slides, of floats and of arrays.

Each point of a contact that slides at the speed s and twists at the rate :math:`\omega` rubs
against its own velocity. Over Hertz's pressure on a circle of radius a this leaves, of the moment
of full twisting and with :math:`q = a |\omega| / s`, the share

.. math::

    \frac{16}{15\pi}\, q\; F(q^2) \quad (q \le 1),\qquad
    1 - \frac{1}{q^2} + \frac{3}{8 q^4} \quad (q \ge 1),\qquad
   F(z) = {}_2F_1\left(\tfrac12, \tfrac12; \tfrac72; z\right)

A contact whose friction Q is less than :math:`\mu F` sticks somewhere. Its share is then at most
about :math:`\sqrt{1 - (Q / \mu F)^2}`, which is taken if it is more than that of sliding.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import scalar
from vibroimpact.contact.choice import where

FULL_TWISTING = 3.0 * np.pi / 16.0
"""Moment of full twisting under Hertz's pressure, over friction force and contact radius [-]."""

_SLIDING_FACTOR = 16.0 / (15.0 * np.pi)  # of q F(q^2)
_CLOSED_FROM = 0.25  # square of q: below, the closed form of F loses digits
_TINY = 1e-300  # m/s: where nothing moves, no ratio is 0/0


def _series(terms: int) -> tuple[float, ...]:
    """Return the first coefficients of F in powers of its argument, the last one first."""
    coefficients = [1.0]
    for term in range(terms - 1):
        coefficients.append(coefficients[-1] * (0.5 + term) ** 2 / ((3.5 + term) * (1.0 + term)))
    return tuple(reversed(coefficients))


_COEFFICIENTS = _series(20)


@scalar
def sliding_factor(ratio: Array) -> Array:
    r"""Return F of a squared ratio of velocities q, 0 <= q <= 1 [-].

    It is the series, or what Gauss's relations between neighbours make of
    :math:`{}_2F_1(1/2, 1/2; 3/2; z) = \arcsin\sqrt z / \sqrt z` (Abramowitz and Stegun 1964, 15.1.6
    and 15.2.12).

    Examples
    --------
    >>> from scipy.special import hyp2f1
    >>> ratio = np.linspace(0.0, 1.0, 1001)
    >>> bool(
    ...     np.allclose(
    ...         sliding_factor(ratio), hyp2f1(0.5, 0.5, 3.5, ratio**2), rtol=2e-13, atol=0.0
    ...     )
    ... )
    True
    """
    square = ratio * ratio
    by_series = 0.0
    for coefficient in _COEFFICIENTS:  # Horner's scheme
        by_series = by_series * square + coefficient
    # 2F1(1/2, 1/2; c; z) for c = 3/2, 5/2 and 7/2
    z = np.minimum(np.maximum(square, _CLOSED_FROM), 1.0)
    for_three_halves = np.arcsin(np.sqrt(z)) / np.sqrt(z)
    for_five_halves = (0.75 * np.sqrt(1.0 - z) - 1.5 * (0.5 - z) * for_three_halves) / z
    closed_form = 0.9375 * ((1.0 - z) * for_three_halves - (1.0 - 2.0 * z) * for_five_halves) / z
    return where(square < _CLOSED_FROM, by_series, closed_form)


@scalar
def twisting_share(rim_speed: Array, slip: Array, used: Array) -> Array:
    """Return the share of the moment of full twisting that a contact has [-].

    Parameters
    ----------
    rim_speed, slip : float or array
        Speed of the rim by the twisting, and speed of the contact point along the plate [m/s], both
        at least zero.
    used : float or array
        Friction over the largest there can be [-].

    Examples
    --------
    >>> twisting_share(np.array([1.0, 2.0, 1e-3]), np.array([0.0, 1.0, 1.0]), 1.0).round(4).tolist()
    [1.0, 0.7734, 0.0003]
    """
    larger_speed = np.maximum(np.maximum(rim_speed, slip), _TINY)
    ratio = np.minimum(rim_speed, slip) / larger_speed  # q, or 1/q where that is less
    square = ratio * ratio
    mostly_sliding = _SLIDING_FACTOR * ratio * sliding_factor(ratio)
    mostly_twisting = 1.0 - square + 0.375 * square * square
    sticking = np.sqrt(np.maximum(1.0 - used * used, 0.0))
    return np.maximum(where(slip > rim_speed, mostly_sliding, mostly_twisting), sticking)
