r"""Collocation in the phase plane: the speed as a function of the indentation.

A phase of a contact, compression or restitution, is divided into segments at the indentations where the force is not smooth, numbered
from the deep end to the shallow one. In each, y goes from 0 at its deep end to 1 at its shallow one, and
:math:`\delta = \delta_1 + (\delta_0 - \delta_1)\, s(y)`, with

* :math:`s = 1 - y^2` where the speed is zero at the deep end of the phase: so it is smooth in y, also in the next segments, which may
  begin just beyond that point; :math:`s = 1 - y` in a phase that begins with a speed,
* raised to the power p, the `root` of the law, in a segment that ends at touch.

The square of the speed, :math:`w = f^2 u` with f = y in a segment where the speed becomes zero and f = 1 else, is smooth
in y throughout, and collocated at N Gauss nodes, with the acceleration a:

.. math:: \frac{dw}{dy} = 2 a(\delta, \pm\sqrt w)\, \frac{d\delta}{dy} = f\, G(y),
          \qquad u(y) = \frac1{f^2} \left(w(0) + \int_0^y f\, G(z)\, dz\right)

which is of order 2N - 1 at y = 1 (Hairer, Lubich and Wanner 2006, section II.1), and so are the integrals over the segment of the work and
of the time, :math:`dt = d\delta/\sqrt w`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from vibroimpact.arrays import Floats, Indices

DENSE = 33


@dataclass(frozen=True)
class PlaneRule:
    """Nodes and matrices of a phase of S segments with N nodes each; columns are (N, 1), or (S N, 1) for all segments.

    Parameters
    ----------
    segments, number, root : int
        S, N and p.
    turns : bool
        Whether the speed is zero at the deep end of the first segment.
    touches : bool
        Whether the shallow end of the last segment is the touch of the surfaces.
    nodes : array, shape (N, 1)
        Nodes y in (0, 1).
    factor, per_node : array, shape (S N, 1)
        f there, and one over it.
    shape : array, shape (S N, 1)
        s there.
    slope : array, shape (S N, 1)
        Its derivative, over f: negative.
    mean : array, shape (S, N + 1, N)
        From G at the nodes to the integral of f G over f^2 from the start of the segment, at the nodes and at 1.
    integral : array, shape (N + 1, N)
        From values at the nodes to their integrals from 0 to the nodes and to 1.
    weights : array, shape (N,)
        Of the integral from 0 to 1.
    last : array, shape (2, N)
        From values at the nodes to their last two Legendre coefficients.
    derivatives : array, shape (2, N, N)
        From values at the nodes to the first and the second derivative there.
    dense : array, shape (33, N)
        From values at the nodes to values at evenly spaced y.
    barycentric : array, shape (N, 1)
        Barycentric weights of the nodes.
    barycentric_to_end : array, shape (N + 1, 1)
        The same of the nodes and 1, for integrals.
    end : array, shape (N,)
        From values at the nodes to the value at 1.
    """

    segments: int
    number: int
    root: int
    turns: bool
    touches: bool
    nodes: Floats
    factor: Floats
    per_node: Floats
    shape: Floats
    slope: Floats
    mean: Floats
    integral: Floats
    weights: Floats
    last: Floats
    derivatives: Floats
    dense: Floats
    barycentric: Floats
    barycentric_to_end: Floats
    end: Floats

    def split(self, values: Floats) -> Floats:
        """Return values at all nodes (S N, B) as an array by segments (S, N, B)."""
        return values.reshape(self.segments, self.number, values.shape[-1])

    def indentations(self, levels: Floats) -> Floats:
        """Return the indentations at all nodes [m] (S N, B) between levels [m] (S + 1, B)."""
        found = (levels[:-1] - levels[1:])[:, None] * self.split(self.shape)
        found += levels[1:, None]
        return np.asarray(found.reshape(-1, levels.shape[-1]))

    def indentation_slope(self, levels: Floats) -> Floats:
        """Return the derivative of the indentation by y over f, at all nodes [m] (S N, B)."""
        return np.asarray(((levels[:-1] - levels[1:])[:, None] * self.split(self.slope)).reshape(-1, levels.shape[-1]))

    def cumulative(self, values: Floats) -> Floats:
        """Return the integrals from the deep end to all nodes and segment ends (S, N + 1, B), of values at the nodes (S N, B)."""
        return self._accumulated(self.integral @ self.split(values))

    def cumulative_square(self, values: Floats) -> Floats:
        """Return u - w(0) / f^2 at all nodes and segment ends (S, N + 1, B), from G at the nodes (S N, B)."""
        return self._accumulated(self.mean @ self.split(values))

    def _accumulated(self, found: Floats) -> Floats:
        """Add to each segment the value at the end of the one before, in place."""
        for segment in range(1, self.segments):
            found[segment] += found[segment - 1, -1]
        return found

    def weights_at(self, y: Floats) -> Floats:
        """Return the weights of barycentric interpolation from the nodes of a segment to y (B,): (N, B)."""
        return _weights(self.barycentric, y - self.nodes)

    def weights_to_end(self, y: Floats) -> Floats:
        """Return the weights of barycentric interpolation from the nodes of a segment and its end to y (T,): (N + 1, T)."""
        return _weights(self.barycentric_to_end, y - np.append(self.nodes, 1.0)[:, None])

    def with_end(self, values: Floats) -> Floats:
        """Return values at the nodes and the ends of the segments (N + 1, S), of values at the nodes of one drop (S N, 1)."""
        by_segment = self.split(values)[..., 0].T
        return np.concatenate([by_segment, (self.end @ by_segment)[None]])

    def integrals_of(self, values: Floats) -> Floats:
        """Return the integrals from the deep end of each segment to its nodes and end (N + 1, S), of values of one drop (S N, 1)."""
        return np.asarray(self.integral @ self.split(values)[..., 0].T)

    def shape_at(self, segment: Indices, y: Floats) -> tuple[Floats, Floats]:
        """Return s and f at y (B,) of segments (B,)."""
        inside = 1.0 - y * y if self.turns else 1.0 - y
        touching = (segment == self.segments - 1) & self.touches
        return np.where(touching, inside**self.root, inside), np.where((segment == 0) & self.turns, y, 1.0)


def _weights(barycentric: Floats, distance: Floats) -> Floats:
    """Return the weights of barycentric interpolation at distances from the points (N, T)."""
    distance[distance == 0.0] = 1e-300  # at a point the interpolant is its value
    weights = barycentric / distance
    weights /= weights.sum(axis=0)
    return np.asarray(weights)


@cache
def plane_rule(number: int, root: int, segments: int = 1, *, turns: bool = True, touches: bool = True) -> PlaneRule:
    """Return the collocation rule of a phase of some segments with `number` nodes each.

    `root`: the force is smooth in that root of the indentation.

    Examples
    --------
    Undamped Hertz without gravity, where G is a multiple of the slope times the shape to the power 3/2, has w = 1 at touch:

    >>> rule = plane_rule(10, 2)
    >>> bool(abs(rule.cumulative_square(-2.5 * rule.slope * rule.shape**1.5)[0, -1, 0] - 1) < 1e-14)
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

    integral = integrals(coefficients)
    factor, shape, slope, mean = [], [], [], []
    for segment in range(segments):
        turning, power = turns and segment == 0, root if touches and segment == segments - 1 else 1
        inside, falls = (1.0 - nodes * nodes, 2.0 * nodes) if turns else (1.0 - nodes, np.ones(number))
        factor.append(nodes if turning else np.ones(number))
        shape.append(inside**power)
        slope.append(-falls / factor[-1] * power * inside ** (power - 1))
        mean.append(np.ascontiguousarray(integrals(times_y) / (ends * ends)[:, None]) if turning else integral)
    barycentric = 1.0 / np.prod(4.0 * (nodes[:, None] - nodes) + np.eye(number), axis=1)  # the factor 4 avoids underflow
    return PlaneRule(
        segments,
        number,
        root,
        turns,
        touches,
        nodes[:, None],
        np.concatenate(factor)[:, None],
        1.0 / np.concatenate(factor)[:, None],
        np.concatenate(shape)[:, None],
        np.concatenate(slope)[:, None],
        np.stack(mean),
        integral,
        weights / 2.0,
        coefficients[-2:],
        np.stack([slopes(1), slopes(2)]),
        legendre.legvander(np.linspace(-1.0, 1.0, DENSE), number - 1) @ coefficients,
        barycentric[:, None],
        np.append(barycentric / (4.0 * (nodes - 1.0)), 1.0 / np.prod(4.0 * (1.0 - nodes)))[:, None],
        coefficients.sum(axis=0),
    )
