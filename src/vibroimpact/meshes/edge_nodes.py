"""Nodes in the middle of edges that a mesh file leaves out of elements of second order."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS

OMITTED = -1
"""Stands for the number of a node that is left out."""


class EdgeNodes(NamedTuple):
    """Elements with all their nodes.

    Attributes
    ----------
    elements : mapping of str to int array
        Numbers of the nodes of each kind, in our order.
    numbers : int array, shape (n,)
        Numbers of all nodes, ascending.
    points : array, shape (n, 3)
        Their coordinates.
    made : int
        How many nodes were made.
    linear : list of tuple of three ints
        Nodes in the middle of edges of elements of first order, whose motion is the mean of the two
        corners: node and corners.
    """

    elements: dict[str, Integers]
    numbers: Integers
    points: Floats
    made: int
    linear: list[tuple[int, int, int]]


def with_edge_nodes(
    elements: Mapping[str, Integers], numbers: Integers, points: Floats
) -> EdgeNodes:
    """Return elements with the nodes that were left out of their edges.

    They are those of neighbours, or new ones halfway between the corners.

    Parameters
    ----------
    elements : mapping of str to int array
        Numbers of the nodes of each kind, in our order, `OMITTED` for those that are left out,
        which are no corners.
    numbers, points : array, shape (n,) and (n, 3)
        Numbers of all nodes, ascending, and their coordinates.
    """
    complete = {kind: nodes.copy() for kind, nodes in elements.items()}
    if not any((nodes == OMITTED).any() for nodes in complete.values()):
        return EdgeNodes(complete, numbers, points, 0, [])
    edges, edges_of_kinds = _edges(complete)
    middle = np.full(len(edges), OMITTED)
    is_straight = np.zeros(len(edges), dtype=bool)  # the edge of an element of first order
    is_needed = np.zeros(len(edges), dtype=bool)  # an element leaves its node out
    for kind, of_elements in edges_of_kinds.items():
        stated = _middle_nodes(kind, complete[kind])
        if stated is None:
            is_straight[of_elements] = True
        else:
            np.maximum.at(middle, of_elements, stated.ravel())
            is_needed[of_elements[stated.ravel() == OMITTED]] = True
    # what no neighbour has either is a new node
    new = np.flatnonzero(is_needed & (middle == OMITTED))
    middle[new] = numbers.max(initial=0) + 1 + np.arange(len(new))
    for kind, of_elements in edges_of_kinds.items():
        stated = _middle_nodes(kind, complete[kind])
        if stated is not None:
            known = middle[of_elements].reshape(stated.shape)
            stated[...] = np.where(stated == OMITTED, known, stated)
    # new nodes lie as on a straight edge
    halfway = np.zeros((len(new), 3))
    if len(numbers):
        ends = np.minimum(np.searchsorted(numbers, edges[new]), max(len(numbers) - 1, 0))
        halfway = points[ends].mean(axis=1)
    linear = [
        (int(middle[edge]), int(edges[edge, 0]), int(edges[edge, 1]))
        for edge in new[is_straight[new]]
    ]
    return EdgeNodes(
        complete,
        np.concatenate([numbers, middle[new]]),
        np.concatenate([points, halfway]),
        len(new),
        linear,
    )


def _edges(elements: Mapping[str, Integers]) -> tuple[Integers, dict[str, Integers]]:
    """Return the edges of elements, each once, and those of the elements of each kind.

    An edge is the numbers of its two corners, ascending. The edges of a kind are indices, (elements
    times edges,).
    """
    ends = [
        np.sort(nodes[:, np.array(ELEMENT_KINDS[kind].edges)], axis=2).reshape(-1, 2)
        for kind, nodes in elements.items()
    ]
    edges, indices = np.unique(np.concatenate(ends), axis=0, return_inverse=True)
    bounds = np.cumsum([len(of_kind) for of_kind in ends])[:-1]
    return edges, dict(zip(elements, np.split(indices.ravel(), bounds), strict=True))


def _middle_nodes(kind: str, nodes: Integers) -> Integers | None:
    """Return a view of the nodes in the middle of edges, (elements, edges).

    None for a kind of first order.
    """
    element = ELEMENT_KINDS[kind]
    if element.order == 1:
        return None
    return nodes[:, element.corners : element.corners + len(element.edges)]
