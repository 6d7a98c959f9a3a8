"""What the core collocates a phase of the contact of two rigid bodies with.

The annotations name the types of compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Cube, Integers

TURNING_AT_TOUCH, TURNING, AT_TOUCH, BETWEEN, AT_TOUCH_INWARD, BETWEEN_INWARD = range(6)
"""Kinds of segment: TURNING, its speed is zero at its deep end; AT_TOUCH, its shallow end is where
the surfaces meet or part.

The motion of those INWARD is known at the shallow end, of the others at the deep end, or at both
where the deep end is sought.
"""

KINDS = 6

PLACE, BARYCENTRIC, FACTOR, PER_FACTOR, SHAPE, FALL, WEIGHT, LAST, BEFORE_LAST = range(9)
"""Vectors of a kind of segment: nodes and far end, their barycentric weights, f, 1/f, s, ds/dy over
f, the weights of the integral over the segment, and those of the last two Legendre coefficients.
"""

VECTORS = 9

(
    STATIC,
    LOSS,
    RATE,
    SLOPE,
    SQUARE,
    DEFECT,
    BY_SQUARE,
    REACHED,
    GROWTH,
    SHRUNK,
    CHANGE,
    BY_DEPTH,
    BY_LENGTH,
    SUMMAND,
    DELTA,
    SPEED,
) = range(16)
"""Vectors of the solution, rows of its room: static and dissipative force, G, the slope of the
indentation by y over f, u, others of Newton's method, the indentation and its rate.
"""

PACE, ELAPSED, SHARE = 16, 17, 18
"""Further ones: pace dt/dy, time since the start, and weights of interpolation."""

ROWS = 19


class PhaseRules(NamedTuple):
    """Gauss rules of L numbers of nodes, rising, for the segments of a phase.

    tolerance: relative error allowed of the approach speed. roughness: the last Legendre
    coefficients allowed, and roughness_inside, where a contact ends within a segment; sharper:
    times as small they have to be for G where the motion between the nodes is asked for. root:
    power of the indentation in whose root the force is smooth at touch. counts (L,): numbers of
    nodes. vectors (6 L, 9, M): of each kind of segment; M, their length, has room for the nodes and
    the far end. matrices (12 L, M, M), two of each kind: from G at the nodes to the change of u,
    and from values to their integrals, up to the nodes and the far end, with a row for each node
    that they are taken from. onward (L, M, M): from values at the nodes of the rule before to those
    at its own.
    """

    tolerance: float
    roughness: float
    roughness_inside: float
    sharper: float
    root: int
    counts: Integers
    vectors: Cube
    matrices: Cube
    onward: Cube


class Segment(NamedTuple):
    """A segment of a phase between two indentations, as it is to be solved.

    kind: of those above. sign: of the indentation rate, 1 or -1. deep, shallow: its ends [m]; the
    deep one an estimate where it is sought. begun: square of the speed at the end where it is
    known. wanted: that at the shallow end where the deep end is sought, else 0 [m^2/s^2].
    """

    kind: int
    sign: float
    deep: float
    shallow: float
    begun: float
    wanted: float


class Phase(NamedTuple):
    """The solution of a segment, in whose room the motion at the nodes stays.

    solved: to the tolerance? rule: number of the rule. deep: its deep end [m]. reached: square of
    the speed at the far end [m^2/s^2]. duration [s]. lost: energy [J]. roughness: the last Legendre
    coefficients of acceleration and pace, relative to their integrals.
    """

    solved: bool
    rule: int
    deep: float
    reached: float
    duration: float
    lost: float
    roughness: float
