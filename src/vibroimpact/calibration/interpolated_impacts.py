"""Single impacts of large tables: interpolated over approach speed and value of the parameter, checked cell by cell.

A table of a hundred thousand rows asks for millions of impacts of one law, which depend on two numbers only. They are computed at the
Chebyshev nodes of cells of the logarithm of the speed and of the inverse hyperbolic sine of the value, and interpolated. A cell that does
not agree with impacts between its nodes is divided; where that does not help, as at a kink, impacts are computed one by one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Indices

Respond = Callable[[Floats, Floats], dict[str, Floats]]
"""Takes approach speeds [m/s] (m,) and values (m,); returns quantities of the impacts."""

MANY = 20_000
"""Impacts from which on they are interpolated."""

_AGREES = 1e-10
"""Largest deviation of a cell from computed impacts, relative to the largest value of a quantity in it."""

_NODES = 9
_WIDTH = 0.8  # of an undivided cell, in both directions
_DIVISIONS = 5
_SMALL = 1e-2  # times the start, below which the scale of values is linear
_AT_ONCE = 20_000  # impacts that are interpolated together

_TURN = (2 * np.arange(_NODES) + 1) * np.pi / (2 * _NODES)
_NODE = -np.cos(_TURN)
_WEIGHT = (-1.0) ** np.arange(_NODES) * np.sin(_TURN)  # barycentric
_CHECKED = np.array([[-0.83, 0.41], [0.37, -0.71], [0.91, 0.87], [-0.11, -0.23], [0.02, 0.97], [-0.97, -0.93]])


class _Cell(NamedTuple):
    """Quantities at the nodes, (speeds, values, quantities); None where they have to be computed one by one."""

    nodes: Floats | None


class InterpolatedImpacts:
    """Impacts of one law, as a function of approach speeds and values of its parameter.

    Parameters
    ----------
    respond : callable
        Computes impacts.
    start : float
        Size of the values.
    """

    def __init__(self, respond: Respond, start: float) -> None:
        self._respond = respond
        self._size = _SMALL * abs(start)
        self._cells: dict[tuple[int, int, int], _Cell] = {}
        self._names: list[str] = []

    def __call__(self, speeds: Floats, values: Floats) -> dict[str, Floats]:
        """Return quantities of impacts, each (m,)."""
        if len(speeds) < MANY:
            return self._respond(speeds, values)
        if not self._names:
            self._names = list(self._respond(speeds[:1], values[:1]))
        places = np.stack([np.log(speeds), np.arcsinh(values / self._size)])
        found = np.empty((len(speeds), len(self._names)))
        alone = self._fill(places, np.arange(len(speeds)), found, 0)
        if alone.size:
            computed = self._respond(speeds[alone], values[alone])
            found[alone] = np.stack([computed[name] for name in self._names], axis=1)
        return {name: found[:, column] for column, name in enumerate(self._names)}

    def _fill(self, places: Floats, rows: Indices, found: Floats, depth: int) -> Indices:
        """Interpolate the impacts of some rows; return those that have to be computed one by one."""
        width = _WIDTH / 2**depth
        number = np.floor(places[:, rows] / width).astype(np.int64)
        keys, which = np.unique(number, axis=1, return_inverse=True)
        order = np.argsort(which, kind="stable")
        ends = np.cumsum(np.bincount(which, minlength=keys.shape[1]))
        alone = [np.empty(0, dtype=np.intp)]
        in_cells = {(depth, *key): members for key, members in zip(keys.T.tolist(), np.split(rows[order], ends[:-1]), strict=True)}
        worthwhile = [key for key, members in in_cells.items() if key not in self._cells and len(members) > _NODES**2 + len(_CHECKED)]
        self._compute_cells(worthwhile, width)
        for key, members in in_cells.items():
            cell = self._cells.get(key)
            if cell is None:  # it holds so few impacts that these are computed themselves
                alone.append(members)
            elif cell.nodes is not None:
                middle = (np.array(key[1:])[:, None] + 0.5) * width
                for begin in range(0, len(members), _AT_ONCE):
                    some = members[begin : begin + _AT_ONCE]
                    found[some] = _interpolated(cell.nodes, (places[:, some] - middle) / (0.5 * width))
            elif depth < _DIVISIONS:
                alone.append(self._fill(places, members, found, depth + 1))
            else:
                alone.append(members)
        return np.concatenate(alone)

    def _compute_cells(self, keys: list[tuple[int, int, int]], width: float) -> None:
        """Compute the nodes of cells of one width, all together."""
        if not keys:
            return
        grid = np.stack(np.meshgrid(_NODE, _NODE, indexing="ij"), axis=-1).reshape(-1, 2)
        within = 0.5 * width * np.concatenate([grid, _CHECKED])
        middles = (np.array(keys, dtype=float)[:, 1:] + 0.5) * width
        every = (middles[:, None] + within).reshape(-1, 2)
        computed = self._respond(np.exp(every[:, 0]), self._size * np.sinh(every[:, 1]))
        quantities = np.stack([computed[name] for name in self._names], axis=1).reshape(len(keys), len(within), -1)
        for key, found in zip(keys, quantities, strict=True):
            nodes = found[: len(grid)].reshape(_NODES, _NODES, -1)
            off = np.abs(_interpolated(nodes, _CHECKED.T) - found[len(grid) :]).max(axis=0)
            agrees = off <= _AGREES * np.abs(found).max(axis=0)  # not where one is NaN
            self._cells[key] = _Cell(nodes if agrees.all() else None)


def _interpolated(nodes: Floats, places: Floats) -> Floats:
    """Return quantities (m, q) at places (2, m) in a cell, from -1 to 1, by barycentric interpolation."""
    along, across = (_shares(place) for place in places)
    lines = np.tensordot(along, nodes, axes=1)
    return np.asarray(np.einsum("mj,mjq->mq", across, lines), dtype=float)


def _shares(place: Floats) -> Floats:
    """Return the share of each node in the value at places, (m, nodes)."""
    off = place[:, None] - _NODE
    at_node = off == 0.0
    shares = _WEIGHT / np.where(at_node, 1.0, off)
    hit = at_node.any(axis=1)
    shares[hit] = at_node[hit]
    return np.asarray(shares / shares.sum(axis=1, keepdims=True))
