r"""Radau collocation over one stretch of contact, in a time variable in which the force is smooth.

A stretch of duration h is mapped from x in [0, 1] by t = h m(x). Hertz's force is not smooth in
time where it is zero
(:math:`\delta^{3/2}`, with :math:`\delta \sim t`), but it is smooth in the root of time. With p the
`root` of the law (2 for Hertz), the
maps are

* "touch" :math:`m = x^p`, for a stretch that begins at first touch,
* "release" :math:`m = 1 - (1 - x)^p`, for a stretch that ends with zero indentation,
* "inside" :math:`m = x`, for all others.

On the nodes :math:`x_i` of the right-hand Radau rule, :math:`\dot y = f` becomes
:math:`y_i = y_0 + h \sum_j Q_{ij} m'_j f_j`, which is of order 2N - 1 at the end of the stretch
(Hairer and Wanner 1996, section IV.5). The last node is the end of the stretch, where event
conditions are imposed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Literal

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.arrays import Floats

Map = Literal["touch", "inside", "release"]


@dataclass(frozen=True)
class Rule:
    """A Radau rule with N nodes under a time map, with its matrices.

    Parameters
    ----------
    time_map : {"touch", "inside", "release"}
        The time map.
    root : int
        Its power p.
    nodes : array, shape (N,)
        Nodes x in (0, 1]; the last is 1.
    time : array, shape (N,)
        m(x) at the nodes.
    slope : array, shape (N,)
        m'(x) at the nodes.
    integral : array, shape (N, N)
        Q m': integrals over time, per unit duration, from 0 to each node.
    integral_twice : array, shape (N, N)
        `integral` applied twice.
    coefficients : array, shape (N, N)
        From values at the nodes to Legendre coefficients in 2 x - 1.
    barycentric : array, shape (N + 1,)
        Barycentric weights of the points 0 and the nodes.
    """

    time_map: Map
    root: int
    nodes: Floats
    time: Floats
    slope: Floats
    integral: Floats
    integral_twice: Floats
    coefficients: Floats
    barycentric: Floats

    def map_time(self, x: Floats) -> Floats:
        """Return m(x), the time as a fraction of the duration."""
        if self.time_map == "touch":
            return x**self.root
        if self.time_map == "release":
            return 1.0 - (1.0 - x) ** self.root
        return x

    def unmap_time(self, fraction: Floats) -> Floats:
        """Return the x of a time given as a fraction of the duration, clipped to [0, 1]."""
        fraction = np.clip(fraction, 0.0, 1.0)
        if self.time_map == "touch":
            return fraction ** (1.0 / self.root)
        if self.time_map == "release":
            return 1.0 - (1.0 - fraction) ** (1.0 / self.root)
        return fraction

    @cached_property
    def end_slope(self) -> Floats:
        """Weights (N,) of the nodal values in the time derivative at the end, times the duration.

        They are not defined for "release".
        """
        order = np.arange(len(self.nodes))
        return np.asarray((order * (order + 1.0)) @ self.coefficients / self.slope[-1])

    @cached_property
    def weights_at_start(self) -> Floats:
        """Weights of the nodal values in their polynomial at x = 0, (N, 1)."""
        return np.asarray(
            legendre.legvander(-np.ones(1), len(self.nodes) - 1) @ self.coefficients
        ).T.copy()

    def interpolate(self, x: Floats, values: Floats) -> Floats:
        """Return the polynomial through nodal `values` (N,) or (N, B) at x (T,).

        It is (T,) or (T, B).
        """
        return np.asarray(
            legendre.legvander(2.0 * x - 1.0, len(self.nodes) - 1) @ (self.coefficients @ values)
        )

    def integrate(self, x: Floats, values: Floats) -> Floats:
        """Return the time integral per unit duration of nodal `values`, from 0 to x (T,).

        The values are (N,) or (N, B).
        """
        return self.integral_to(x) @ values

    def integral_to(self, x: Floats) -> Floats:
        """Return the matrix of `integrate`, (T, N).

        It takes nodal values to time integrals per unit duration up to x (T,).
        """
        return np.asarray(self.weights(x)[1:].T @ self.integral)  # a polynomial that is zero at 0

    def weights(self, x: Floats) -> Floats:
        """Return the barycentric weights of the values at 0 and at the nodes, (N + 1, ...).

        They interpolate at x of any shape.
        """
        shape = (-1,) + (1,) * x.ndim
        distance = x - np.concatenate([[0.0], self.nodes]).reshape(shape)
        distance[distance == 0.0] = 1e-300  # at a point itself, its weight dominates all others
        weights = self.barycentric.reshape(shape) / distance
        weights /= weights.sum(axis=0)
        return np.asarray(weights)


@cache
def collocation_rule(number: int, time_map: Map, root: int = 2) -> Rule:
    """Return the Radau rule with `number` nodes under a time map.

    Examples
    --------
    The integral of 3 t^2 over the unit stretch, whatever the map:

    >>> rule = collocation_rule(5, "touch")
    >>> bool(abs((rule.integral @ (3 * rule.time**2))[-1] - 1) < 1e-14)
    True
    """
    nodes, coefficients, integral = _radau(number)
    if time_map == "touch":
        time = nodes**root
        slope = root * nodes ** (root - 1)
    elif time_map == "release":
        time = 1.0 - (1.0 - nodes) ** root
        slope = root * (1.0 - nodes) ** (root - 1)
    else:
        time = nodes
        slope = np.ones(number)
    integral = integral * slope
    points = np.concatenate([[0.0], nodes])
    distances = 4.0 * (points[:, None] - points)  # the factor 4 avoids underflow
    barycentric = 1.0 / np.prod(distances + np.eye(number + 1), axis=1)
    return Rule(
        time_map, root, nodes, time, slope, integral, integral @ integral, coefficients, barycentric
    )


@cache
def _radau(number: int) -> tuple[Floats, Floats, Floats]:
    """Return the nodes on (0, 1], the matrix to Legendre coefficients, and that of integration.

    The integrals are those at the nodes.
    """
    polynomial = np.zeros(number + 1)
    # P_N - P_{N-1} vanishes at the right-hand nodes
    polynomial[number] = 1.0
    polynomial[number - 1] = -1.0
    z = np.sort(legendre.legroots(polynomial).real)
    derivative = legendre.legder(polynomial)
    for _ in range(3):  # refine the roots by Newton's method
        z -= legendre.legval(z, polynomial) / legendre.legval(z, derivative)
    z[-1] = 1.0
    coefficients: Floats = np.asarray(
        np.linalg.inv(legendre.legvander(z, number - 1)), dtype=np.float64
    )
    antiderivative = legendre.legint(coefficients, lbnd=-1, axis=0) / 2.0
    integral = np.asarray(legendre.legvander(z, number) @ antiderivative)
    return (z + 1.0) / 2.0, coefficients, integral
