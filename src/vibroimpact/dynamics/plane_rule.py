r"""Collocation in the phase plane: the speed over the indentation, which knows its ends.

Half a contact runs between first touch or release and the deepest point. With :math:`\delta = \delta_m (1 - y^2)^p`, p the
`root` of the law, y goes from 0, where it is deepest, to 1, where the surfaces meet, and the square of the speed,
:math:`w = y^2 u`, is smooth in y throughout:

.. math:: \frac{dw}{dy} = 2 a(\delta, \pm\sqrt w)\, \frac{d\delta}{dy} = y\, G(y),\qquad u(y) = \frac1{y^2} \int_0^y z\, G(z)\, dz

G is collocated at N Gauss nodes, which is of order 2N - 1 at y = 1 (Hairer, Lubich and Wanner 2006, section II.1), and so
are the integrals over the half contact of the work and of the time, :math:`dt = d\delta/\sqrt w`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.dynamics.collocation import Floats


@dataclass(frozen=True)
class PlaneRule:
    """Nodes and matrices for N nodes and a power p; columns are (N, 1).

    Parameters
    ----------
    nodes : array, shape (N, 1)
        Nodes y in (0, 1).
    per_node : array, shape (N, 1)
        One over them.
    shape : array, shape (N, 1)
        Indentation as a part of the deepest.
    slope : array, shape (N, 1)
        Its derivative, over y: negative.
    mean : array, shape (N + 1, N)
        From G at the nodes to u at the nodes and at 1.
    integral : array, shape (N + 1, N)
        From values at the nodes to their integrals from 0 to the nodes and to 1.
    weights : array, shape (N,)
        Of the integral from 0 to 1.
    last : array, shape (2, N)
        From values at the nodes to their last two Legendre coefficients.
    derivatives : tuple of three arrays, shape (N, N)
        From values at the nodes to the first, second and third derivative there.
    barycentric : array, shape (N, 1)
        Barycentric weights of the nodes.
    """

    nodes: Floats
    per_node: Floats
    shape: Floats
    slope: Floats
    mean: Floats
    integral: Floats
    weights: Floats
    last: Floats
    derivatives: tuple[Floats, Floats, Floats]
    barycentric: Floats

    def weights_at(self, y: Floats) -> Floats:
        """Return the weights of the values at the nodes for their polynomials at y (B,): (N, B)."""
        distance = y - self.nodes
        distance[distance == 0.0] = 1e-300  # at a node, its weight outweighs all others
        weights = self.barycentric / distance
        weights /= weights.sum(axis=0)
        return np.asarray(weights)


@cache
def plane_rule(number: int, root: int) -> PlaneRule:
    """Return the rule with `number` nodes for a law that is smooth in that root of the indentation.

    Examples
    --------
    Undamped Hertz without gravity, where G is a multiple of the slope times the shape to the power 3/2, has w = 1 at touch:

    >>> rule = plane_rule(10, 2)
    >>> bool(abs((rule.mean @ (-2.5 * rule.slope * rule.shape**1.5))[-1, 0] - 1) < 1e-14)
    True
    """
    z, weights = legendre.leggauss(number)
    nodes, ends = (z + 1.0) / 2.0, np.append((z + 1.0) / 2.0, 1.0)
    coefficients: Floats = np.asarray(np.linalg.inv(legendre.legvander(z, number - 1)), dtype=np.float64)
    times_y: Floats = np.stack([legendre.legmul(column, [0.5, 0.5]) for column in coefficients.T], axis=1)

    def integrals(series: Floats) -> Floats:
        return np.asarray(legendre.legvander(2.0 * ends - 1.0, len(series)) @ legendre.legint(series, lbnd=-1, axis=0) / 2.0)

    def slopes(order: int) -> Floats:
        return np.asarray(legendre.legvander(z, number - 1 - order) @ (2.0**order * legendre.legder(coefficients, order, axis=0)))

    inside = 1.0 - nodes * nodes
    barycentric = 1.0 / np.prod(4.0 * (nodes[:, None] - nodes) + np.eye(number), axis=1)  # 4: against underflow
    return PlaneRule(
        nodes[:, None],
        1.0 / nodes[:, None],
        (inside**root)[:, None],
        (-2.0 * root * inside ** (root - 1))[:, None],
        np.ascontiguousarray(integrals(times_y) / (ends * ends)[:, None]),
        integrals(coefficients),
        weights / 2.0,
        coefficients[-2:],
        (slopes(1), slopes(2), slopes(3)),
        barycentric[:, None],
    )
