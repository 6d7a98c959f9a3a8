r"""Memory of a Hertzian contact under varying normal and tangential forces: the turning points of
its history.

By the method of dimensionality reduction the contact is a row of independent springs, each of
stiffness :math:`G^* dx`. That at x
touches at the depth :math:`c = x^2/R` and slips where its displacement reaches :math:`\kappa (D -
c)`: this gives the force of Cattaneo's
and Mindlin's contact, under any history (V. L. Popov and M. Hess, Method of Dimensionality
Reduction in Contact Mechanics and Friction, Springer 2015, chapter 5; J. Jaeger, New Solutions in
Contact Mechanics, WIT Press 2005).

The displacements of all springs are a curve: with s the displacement of the sphere over kappa, a
spring that does not slip keeps the
displacement S(c) at which it would be free of force. For slip in the direction :math:`r = \pm 1`
the coordinate

.. math:: x = c - r S

rises along the curve, which ends at the present :math:`D - r s`. When that falls, every spring
slips whose x is larger, and those that stick are as they were when the rim of the contact was where
the slip ends. So with the integral I of the friction force
(`contact.friction.law`) and its largest value :math:`\tfrac23 D^{3/2}`

.. math::

    r I = \tfrac23 D^{3/2} - H(x),\qquad H = \tfrac23 c^{3/2} - r I(c),\qquad
    \frac{dH}{dx} = \sqrt c

where H(x) is known of the points of the curve. When the slip ends, what slipped is replaced by a
straight line.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.friction_records import Curve

RIM, BELOW = 0, 1
"""Entries of `Curve.top`."""

DEPTH, DISPLACEMENT, INTEGRAL = 0, 1, 2
"""Columns of `Curve.points`."""

_TINY = 1e-300
_SHORT = 1e-9  # of its depth: length of a piece of a curve that is none
_MOST_SHARE = 2.0
"""How far H is extended from the last piece of a curve, in lengths of it from its lower end."""


@compiled
def new_curve(room: int) -> Curve:
    """Return the curve of a contact before first touch: one point, with room for others.

    Examples
    --------
    A contact is pressed to the depth 1, then displaced by 0.19: the force is Cattaneo's, :math:`1 -
    (1 - s)^{3/2}` of that of sliding.

    >>> curve = new_curve(4)
    >>> add_rim(curve, 1.0, 0.0, 0.0)
    >>> begin_at_rim(curve)
    >>> held, front = held_at(curve, 1.0, 1.0 - 0.19)
    >>> round(1.0 - 1.5 * held, 6), round(1 - (1 - 0.19) ** 1.5, 6)
    (0.271, 0.271)
    """
    return Curve(np.zeros((room, 3)), np.zeros(2, np.int64))


@compiled
def put_rim(curve: Curve, point: int, depth: float, displacement: float, integral: float) -> None:
    """Make a point of a curve its last."""
    curve.points[point, DEPTH] = depth
    curve.points[point, DISPLACEMENT] = displacement
    curve.points[point, INTEGRAL] = integral
    curve.top[RIM] = point


@compiled
def add_rim(curve: Curve, depth: float, displacement: float, integral: float) -> None:
    """Add the present rim of a contact to its curve."""
    put_rim(curve, curve.top[RIM] + 1, depth, displacement, integral)


@compiled
def begin_at_rim(curve: Curve) -> None:
    """Let a contact begin to slip at its rim."""
    curve.top[BELOW] = max(curve.top[RIM] - 1, 0)


@compiled
def middle_of(curve: Curve, direction: float) -> float:
    """Return the x below which all of a contact slides [m]."""
    return float(-direction * curve.points[0, DISPLACEMENT])


@compiled
def held_at(curve: Curve, direction: float, x: float) -> tuple[float, float]:
    """Return H of a contact that slips [m^1.5], and its derivative, the root of the depth at which
    the slip ends [m^0.5].

    Between two points c is taken as linear in x, and H has its value at both.
    """
    points = curve.points
    below = curve.top[BELOW]
    while below > 0 and x < points[below, DEPTH] - direction * points[below, DISPLACEMENT]:
        below -= 1
    curve.top[BELOW] = below
    low = points[below, DEPTH]
    moved = points[below, DISPLACEMENT]
    high = points[below + 1, DEPTH]
    deep = high - low
    length = deep - direction * (points[below + 1, DISPLACEMENT] - moved)
    share = (x - low + direction * moved) / max(length, _SHORT * deep + _TINY)
    share = min(max(share, 0.0), _MOST_SHARE)  # 0 where all of the contact slides
    # with c linear in x, H rises by the integral of sqrt(c) dx = 2/3 dx/dc d(c^(3/2))
    slope = (2.0 / 3.0) * length / max(deep, _TINY)
    depth = low + share * deep
    root = math.sqrt(depth)
    cube_low = low * math.sqrt(low)
    cube_high = high * math.sqrt(high)
    # what H changes by between the points, beside what it would if c were linear
    pulled = points[below, INTEGRAL]
    excess = (2.0 / 3.0 - slope) * (cube_high - cube_low) - direction * (
        points[below + 1, INTEGRAL] - pulled
    )
    # the rest of the change comes in smoothly, as 3 t^2 - 2 t^3 of the share t: with no slope at
    # either point
    linear = (2.0 / 3.0) * cube_low - direction * pulled + slope * (depth * root - cube_low)
    return linear + excess * share * share * (3.0 - 2.0 * share), root


@compiled
def end_slip(
    curve: Curve,
    direction: float,
    held: float,
    root: float,
    depth: float,
    displacement: float,
    integral: float,
) -> None:
    """Let a contact cease to slip: a straight line leads from where the slip ended to the rim.

    Parameters
    ----------
    curve : Curve
        Of the contact.
    direction : float
        Of the slip, 1 or -1.
    held, root : float
        H [m^1.5], and the root of the depth at which the slip ends [m^0.5], 0 where all of the
        contact slides.
    depth, displacement, integral : float
        Of the rim now [m], [m], [m^1.5].
    """
    front = root * root
    point = 0 if root == 0.0 else curve.top[BELOW] + 1
    put_rim(
        curve,
        point,
        front,
        displacement - direction * (depth - front),
        direction * ((2.0 / 3.0) * front * root - held),
    )
    add_rim(curve, depth, displacement, integral)
