"""What the core writes the normal motion of a contact with, which drives its friction.

The annotations name the types of compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Cube, Integers, Matrix, Vector

MORE_STEPS = 3
"""Times as many steps where the force is steep."""

TIME, PACE, PACE_SLOPE, FORCE, FORCE_SLOPE, IMPULSE = range(6)
"""Rows of a normal motion: time since touch [s] and its derivatives by the parameter,
force [N] and its derivative, impulse [N s].
"""

MOTION_ROWS = 6

NODE_PACE, NODE_FORCE, NODE_PUSH, NODE_PACE_SLOPE, NODE_FORCE_SLOPE, NODE_TIME, NODE_IMPULSE = (
    range(6, 13)
)
"""Further rows of the room: values at the nodes of a segment, the push being the
derivative of the impulse.
"""

GRID_ROWS = 13

VALUES, INTEGRALS = range(2)
"""Matrices of a grid of one's own."""


class NormalPath(NamedTuple):
    """The normal motion of a contact at G points of its parameter.

    rows (6, G): those above. steps (G - 1,): of the parameter, 1; a step of zero joins two parts,
    between which the others may jump.
    """

    rows: Matrix
    steps: Vector


class NormalGrid(NamedTuple):
    """Grids in y on which the normal motion in the segments of a contact is written.

    steps: of a segment; 0 where no motion is asked for. derivatives (L, M, M): from values at the
    nodes of each rule to their derivatives by y there. values, integrals (2 L, M, N): from values
    at the nodes, and from integrals up to the nodes and y = 1, to the points of the grid; of each
    rule for `steps` and for `MORE_STEPS` times as many. own (2, M, N): room for such matrices of a
    segment in which a contact ends. room (13, W): room for values at the nodes and on the grid.
    motion (6, R), parameter (R,): room for the motion of a contact, and for its steps of the
    parameter. points (1,): number of its points.
    """

    steps: int
    derivatives: Cube
    values: Cube
    integrals: Cube
    own: Cube
    room: Matrix
    motion: Matrix
    parameter: Vector
    points: Integers
