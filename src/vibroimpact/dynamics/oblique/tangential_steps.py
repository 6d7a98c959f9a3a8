r"""Steps of contacts along one direction, with known normal motion: the tangential motion between two points of a grid.

A step has the parameter :math:`\theta` from 0 to 1, and the method is that with first and second derivatives at both ends,

.. math:: y_1 - y_0 = \tfrac12 (y_0' + y_1') + \tfrac1{12} (y_0'' - y_1''),

of order four with the error constant 1/720 (Hairer, Norsett and Wanner 1993, section II.13). With the velocity v, the displacement s and
the integral I of `contact.friction.law`, the pace :math:`t' = dt/d\theta` and :math:`k = 2 G^* \sqrt R / m_t`

.. math:: v' = t' (g - k I),\qquad s' = t' v,

where I follows from a linear equation in a contact that sticks, and from s in one that slips.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Self

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.arrays import Drops, Floats
from vibroimpact.contact.friction.cubics import cubic_at

TINY = 1e-150
"""A depth or its change, to divide by."""

_NODES, _SHARES = legendre.leggauss(3)
_NODES, _SHARES = 0.5 * (_NODES + 1.0), 0.5 * _SHARES
"""Of Gauss' quadrature from 0 to 1."""


def _row(number: int) -> Floats:
    """Return a property that is a row of `rows`."""

    def read(whole: _Rows) -> Floats:
        return np.asarray(whole.rows[number])

    return property(read)  # type: ignore[return-value]


class _Rows:
    """Quantities of b contacts, each a row (b,) of an array."""

    __slots__ = ("rows",)

    def __init__(self, rows: Floats) -> None:
        self.rows = rows

    def take(self, here: Drops) -> Self:
        """Return those of some contacts."""
        return type(self)(self.rows.take(here, axis=1))


class Drive(_Rows):
    r"""The normal motion of b contacts at one end of a step; arrays are (b,).

    `time`: since first touch [s], `pace` and `pace_slope`: its derivatives. `depth` [m] and `depth_slope`. `most`: the integral I of a
    contact that slides [m^1.5], and `swept`: its integral over time so far.
    """

    __slots__ = ()
    time, pace, pace_slope, depth, depth_slope, most, swept = (_row(number) for number in range(7))

    def shortened(self, part: Floats) -> Drive:
        """Return the same for a parameter that goes from 0 to 1 in a part of the step."""
        time, pace, pace_slope, depth, depth_slope, most, swept = self.rows
        return Drive(np.array([time, pace * part, pace_slope * part**2, depth, depth_slope * part, most, swept]))


class Motion(_Rows):
    """The tangential motion of b contacts: `velocity` v, `displacement` s, `integral` I; arrays are (b,)."""

    __slots__ = ()
    velocity, displacement, integral = (_row(number) for number in range(3))


def sliding_integral(depth: Floats) -> Floats:
    """Return the integral I of a contact that slides [m^1.5]."""
    return np.asarray((2.0 / 3.0) * depth * np.sqrt(depth))


def between(start: Drive, end: Drive, place: Floats) -> Drive:
    """Return the normal motion at a place of a step, from 0 to 1."""
    time, _ = cubic_at(np.array([start.time, start.pace, end.time, end.pace]), place)
    (pace, depth), (pace_slope, depth_slope) = cubic_at(_pace_and_depth(start, end), place)
    depth = np.maximum(depth, 0.0)
    most, rest = sliding_integral(depth), 1.0 - place
    # from the end, where there may be little left
    bend = (
        pace_slope * most
        + pace * np.sqrt(depth) * depth_slope
        - end.pace_slope * end.most
        - end.pace * np.sqrt(end.depth) * end.depth_slope
    )
    left = rest * (0.5 * (pace * most + end.pace * end.most) + rest / 12.0 * bend)
    return Drive(np.array([time, pace, pace_slope, depth, depth_slope, most, end.swept - left]))


def _pace_and_depth(start: Drive, end: Drive) -> Floats:
    """Return pace and depth with their slopes at both ends of a step (4, 2, b)."""
    return np.array([rows for one in (start, end) for rows in ((one.pace, one.depth), (one.pace_slope, one.depth_slope))])


def stick(start: Drive, end: Drive, motion: Motion, stiffness: Floats, pull: Floats, power: float) -> Motion:
    r"""Return the motion at the end of a step in which contacts stick.

    There :math:`I = a^\gamma z` with the contact radius over the root of R, :math:`a = \sqrt D`, and :math:`z' = t' a^{1 - \gamma} v`.

    Parameters
    ----------
    start, end : Drive
        Normal motion.
    motion : Motion
        At the start.
    stiffness, pull : array, shape (b,)
        k [1/(m^0.5 s^2)], and the acceleration g [m/s^2].
    power : float
        :math:`\gamma`.
    """
    velocity, _, integral = motion.rows
    stretch = integral / np.maximum(start.depth, TINY) ** (0.5 * power) if power else integral
    (pull_0, slope_0), (pull_1, slope_1) = (_paced(drive, power) for drive in (start, end))
    (spring_0, bend_0), (spring_1, bend_1) = (_paced(drive, 1.0 - power) for drive in (start, end))
    if power > 1.0:  # where the contact ends the pace over its radius is as before
        spring_1, bend_1 = np.where(end.depth > 0.0, spring_1, spring_0), np.where(end.depth > 0.0, bend_1, 0.0)
    pull_0, slope_0, pull_1, slope_1 = (stiffness * one for one in (pull_0, slope_0, pull_1, slope_1))
    less_0, less_1 = 1.0 - pull_0 * spring_0 / 12.0, 1.0 - pull_1 * spring_1 / 12.0
    right = less_0 * velocity - (0.5 * pull_0 + slope_0 / 12.0) * stretch + pull * (end.time - start.time)
    right_stretch = (0.5 * spring_0 + bend_0 / 12.0) * velocity + less_0 * stretch
    right_stretch += pull / 12.0 * (spring_0 * start.pace - spring_1 * end.pace)
    back, forth = 0.5 * pull_1 - slope_1 / 12.0, 0.5 * spring_1 - bend_1 / 12.0
    determinant = less_1**2 + back * forth
    after = (less_1 * right - back * right_stretch) / determinant
    stretch = (forth * right + less_1 * right_stretch) / determinant
    integral_after = stretch * end.depth ** (0.5 * power) if power else stretch
    return moved(start, end, motion, after, integral_after, stiffness, pull)


def _paced(drive: Drive, power: float) -> tuple[Floats, Floats]:
    """Return the pace times a power of the root of the depth, and its derivative."""
    if power == 0.0:
        return drive.pace, drive.pace_slope
    depth = np.maximum(drive.depth, TINY)
    raised = np.sqrt(depth) if power == 1.0 else depth ** (0.5 * power)
    return drive.pace * raised, drive.pace_slope * raised + 0.5 * power * drive.pace * raised / depth * drive.depth_slope


def moved(start: Drive, end: Drive, before: Motion, velocity: Floats, integral: Floats, stiffness: Floats, pull: Floats) -> Motion:
    """Return the motion at the end of a step, from velocities and integrals at both ends."""
    pace, pace_there = start.pace, end.pace
    bend = start.pace_slope * before.velocity + pace**2 * (pull - stiffness * before.integral)
    bend -= end.pace_slope * velocity + pace_there**2 * (pull - stiffness * integral)
    return Motion(
        np.array([velocity, before.displacement + 0.5 * (pace * before.velocity + pace_there * velocity) + bend / 12.0, integral])
    )


Held = Callable[[Floats], tuple[Floats, Floats]]
"""From x of contacts that slip to H there and its derivative; see `contact.friction.turning_points`."""


def slide(start: Drive, end: Drive, motion: Motion, stiffness: Floats, pull: Floats, direction: Floats) -> Motion:
    """Return the motion at the end of a step in which all of each contact slides; see `slip`."""
    velocity = motion.velocity + pull * (end.time - start.time) - stiffness * direction * (end.swept - start.swept)
    return moved(start, end, motion, velocity, direction * end.most, stiffness, pull)


def slip(
    start: Drive, end: Drive, motion: Motion, front: Floats, held: Held, stiffness: Floats, pull: Floats, direction: Floats
) -> tuple[Motion, Floats]:
    """Return the motion at the end of a step in which contacts slip, and the root of the depth at which the slip ends.

    `front`: that root at the start [m^0.5] (b,). `held`: from x to H and its derivative. `direction`: of the slip, 1 or -1 (b,). Others: as
    in `stick`.
    """
    velocity, displacement, integral = motion.rows
    _, pace, pace_slope, depth, depth_slope, _, _ = end.rows
    driven, tangential = stiffness * direction, pull - stiffness * integral
    weight, square = 0.5 * pace - pace_slope / 12.0, pace**2 / 12.0
    flow = start.pace * velocity
    ahead = displacement + 0.5 * flow + (start.pace_slope * velocity + start.pace**2 * tangential) / 12.0 - square * pull
    grows = direction * (np.sqrt(start.depth) - front) * start.depth_slope + front * flow
    right = velocity + pull * (end.time - start.time)
    right -= stiffness * ((0.5 * start.pace + start.pace_slope / 12.0) * integral + start.pace / 12.0 * grows)
    # first with the rate at the start, then along the tangent of H at the x to which that leads
    expected = stiffness * (integral + grows)
    there = ahead + weight * (right - weight * expected) + square * expected
    keeps, front = held(depth - direction * there)
    tangent = end.most - keeps - direction * front * there
    stiff, growth = stiffness * front, (np.sqrt(depth) - front) * depth_slope
    right -= driven * (weight * tangent - pace / 12.0 * growth)
    ahead += square * driven * tangent
    less, linked = 1.0 - stiff * square, stiff * weight
    determinant = less**2 + linked * weight
    after, there = (less * right - linked * ahead) / determinant, (weight * right + less * ahead) / determinant
    return Motion(np.array([after, there, direction * np.minimum(tangent + direction * front * there, end.most)])), front


def swept_to_middle(start: Drive, end: Drive, ends: Floats, held: Held, direction: Floats) -> Floats:
    """Return the integral of I over the time of a step at whose end the slip comes to the middle of contacts.

    `ends`: x at both ends of the step, with its derivatives (4, b).
    """
    found, drives = np.zeros(len(direction)), _pace_and_depth(start, end)
    for root, share in zip(_NODES[::-1], _SHARES[::-1], strict=True):  # of the distance to the end, where H has a power of 3/2
        (pace, depth), _ = cubic_at(drives, 1.0 - root**2)
        x, _ = cubic_at(ends, 1.0 - root**2)
        found += 2.0 * root * share * pace * (sliding_integral(np.maximum(depth, 0.0)) - held(x)[0])
    return direction * found
