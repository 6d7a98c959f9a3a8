"""What the core computes flights through fluids with."""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Cube, Matrix, Vector


class Moving(NamedTuple):
    """Motion of b spheres that fly through a fluid.

    time: since the start of the flight [s] (b,). place [m], velocity [m/s]: (C, b), the last
    component along the normal. lost: energy per mass of the sphere that drag has taken since the
    start [J/kg] (b,).
    """

    time: Vector
    place: Matrix
    velocity: Matrix
    lost: Vector


class Corners(NamedTuple):
    """Motion of B spheres at the ends of the K pieces of their flights.

    time (K, B), place, velocity (K, C, B), lost (K, B): as in `Moving`; a drop with fewer pieces
    repeats its last. top: the number of the one that is at the top of all flights.
    """

    time: Matrix
    place: Cube
    velocity: Cube
    lost: Matrix
    top: int


class Falling(NamedTuple):
    """What B spheres fall through, and how they are pulled.

    reynolds: Reynolds number over the speed [s/m]. drag: deceleration over the drag coefficient and
    the square of the speed [1/m]. coefficient: a constant drag coefficient, NaN where it follows
    from the Reynolds number. inertia: mass that is accelerated over that of the sphere. All (B,).
    gravity: acceleration without drag [m/s^2] (C, B).
    """

    reynolds: Vector
    drag: Vector
    coefficient: Vector
    inertia: Vector
    gravity: Matrix


class FallRule(NamedTuple):
    """A Radau rule of N nodes under a time map: integral (N, N) up to the nodes, and
    moved (N,), the second integral up to the end.
    """

    integral: Matrix
    moved: Vector


class FallRules(NamedTuple):
    """The rules of pieces up to the top of a flight, and down from there."""

    rising: FallRule
    falling: FallRule
