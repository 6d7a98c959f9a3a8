r"""Weights of a step along the plate, for contacts whose normal motion is known.

In the parameter :math:`\theta` of a step, from 0 to 1, :math:`dt/d\theta` and the depth D are cubics, given by value and slope at both
ends. The acceleration is taken as linear in :math:`\theta` first, and then as the cubic with the value and the slope that it turns out to
have at the end.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.arrays import Floats

_TINY = 1e-300  # a depth, for powers of zero

_HERMITE = np.array([[1.0, 0.0, -3.0, 2.0], [0.0, 1.0, -2.0, 1.0], [0.0, 0.0, 3.0, -2.0], [0.0, 0.0, -1.0, 1.0]])
"""Coefficients, lowest power first, of the cubics with one value or slope of one, in the order of a cubic's ends."""


def _weigh(factor: Floats, start: Floats, end: Floats) -> Floats:
    """Return the integrals of a polynomial times the four cubics, from start to end (N, 4)."""
    products = np.array([np.convolve(factor, cubic) for cubic in _HERMITE])
    powers = np.arange(1, products.shape[1] + 1)
    return np.asarray((end[:, None] ** powers - start[:, None] ** powers) / powers @ products.T)


_PLACES, _SHARES = legendre.leggauss(3)
_PLACES, _SHARES = 0.5 * (_PLACES + 1.0), 0.5 * _SHARES
_AT = _PLACES[:, None] ** np.arange(4) @ _HERMITE.T
_SO_FAR, _RAMP_SO_FAR = _weigh(np.ones(1), np.zeros(3), _PLACES), _weigh(np.array([0.0, 1.0]), np.zeros(3), _PLACES)
_WHOLE = np.concatenate([_weigh(factor, np.zeros(1), np.ones(1)) for factor in (np.ones(1), np.array([0.0, 1.0]), *_HERMITE[2:])])
_LATER = np.array([_PLACES, *_AT.T[2:]]) * _SHARES


def step_weights(pace: Floats, depth: Floats, power: int) -> tuple[Floats, Floats]:
    r"""Return the weights of a step, and those that correct it.

    Parameters
    ----------
    pace : array, shape (..., 4, B)
        :math:`dt/d\theta` [s], and its slope, at the start and at the end of the step.
    depth : array, shape (..., 4, B)
        The same of the depth [m].
    power : int
        Of the contact radius, :math:`\sqrt D`, in the integral below.

    Returns
    -------
    weights : array, shape (..., 3, 3, B)
        For the change of the displacement s, the integral :math:`\int \sqrt D^{\,power} ds`, and the velocity v at the end, from v at the
        start and the acceleration and its slope there.
    corrections : array, shape (..., 2, 2, B)
        For s and v at the end, from the errors of the acceleration and its slope there.
    """
    found = np.empty((*pace.shape[:-2], 3, 3, pace.shape[-1]))
    corrections = np.empty((*pace.shape[:-2], 2, 2, pace.shape[-1]))
    whole = _WHOLE @ pace
    here, so_far = _AT @ pace, _SO_FAR @ pace
    later = _LATER @ (here * (whole[..., :1, :] - so_far))
    found[..., 0, 0, :] = whole[..., 0, :]
    found[..., 0, 1, :] = 0.5 * whole[..., 0, :] ** 2
    found[..., 0, 2, :] = later[..., 0, :]
    here *= np.sqrt(np.maximum(_AT @ depth, _TINY)) ** power
    found[..., 1, 0, :] = _SHARES @ here
    found[..., 1, 1, :] = _SHARES @ (here * so_far)
    found[..., 1, 2, :] = _SHARES @ (here * (_RAMP_SO_FAR @ pace))
    found[..., 2, 0, :] = 1.0
    found[..., 2, 1:, :] = whole[..., :2, :]
    corrections[..., 0, :, :] = later[..., 1:, :]
    corrections[..., 1, :, :] = whole[..., 2:, :]
    return found, corrections


def cubic_at(ends: Floats, place: Floats | float) -> tuple[Floats, Floats]:
    """Return value and slope of a cubic at a place between 0 and 1; `ends`: those at 0 and at 1 (4, ...)."""
    value, slope, bend, twist = np.tensordot(_HERMITE.T, ends, 1)
    return value + place * (slope + place * (bend + place * twist)), slope + place * (2.0 * bend + 3.0 * place * twist)


def before_and_after(ends: Floats, place: Floats) -> tuple[Floats, Floats]:
    """Return the values and slopes of a cubic at the ends of two parts of a step, (4, B) each, whose parameters go from 0 to 1 again.

    `ends`: those of the step (4, B); `place`: where the first part ends, between 0 and 1 (B,).
    """
    (value, slope), rest = cubic_at(ends, place), 1.0 - place
    return np.array([ends[0], ends[1] * place, value, slope * place]), np.array([value, slope * rest, ends[2], ends[3] * rest])


def slowed(pace: Floats, depth: Floats, near: Floats) -> tuple[Floats, Floats]:
    r"""Return pace and depth of steps in a parameter :math:`\tau` that runs evenly in the root of the distance to a point beyond.

    There :math:`\theta = (1 - (1 - b \tau)^2) / (1 - (1 - b)^2)` with :math:`b = 1 - \sqrt r`.

    Parameters
    ----------
    pace, depth : array, shape (4, B)
        As in `step_weights`.
    near : array, shape (B,)
        r, the distance to that point at the end over that at the start: 1 if it is far away.
    """
    root = np.sqrt(near)
    first = 2.0 / (1.0 + root)
    last, bend = first * root, -first * (1.0 - root)
    slower = np.array([pace[0] * first, pace[1] * first**2 + pace[0] * bend, pace[2] * last, pace[3] * last**2 + pace[2] * bend])
    return slower, np.array([depth[0], depth[1] * first, depth[2], depth[3] * last])
