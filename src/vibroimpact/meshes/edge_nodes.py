"""Nodes in the middle of edges that a mesh file leaves out of elements of second order."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.structures.element_kinds import ELEMENT_KINDS

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
    """Return elements whose omitted nodes are those of their neighbours, or new ones halfway
    between the corners of their edges.

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
    kinds = list(complete)
    ends = [
        np.sort(complete[kind][:, np.array(ELEMENT_KINDS[kind].edges)], axis=2).reshape(-1, 2)
        for kind in kinds
    ]
    edges, of = np.unique(np.concatenate(ends), axis=0, return_inverse=True)
    of_kinds = np.split(of.ravel(), np.cumsum([len(part) for part in ends])[:-1])
    middle, straight = np.full(len(edges), OMITTED), np.zeros(len(edges), dtype=bool)
    wanted = np.zeros(len(edges), dtype=bool)
    for kind, edge in zip(kinds, of_kinds, strict=True):
        given = _middle_nodes(kind, complete[kind])
        if given is None:
            straight[edge] = True
        else:
            np.maximum.at(middle, edge, given.ravel())
            wanted[edge[given.ravel() == OMITTED]] = True
    new = np.flatnonzero(wanted & (middle == OMITTED))
    middle[new] = numbers.max(initial=0) + 1 + np.arange(len(new))
    for kind, edge in zip(kinds, of_kinds, strict=True):
        given = _middle_nodes(kind, complete[kind])
        if given is not None:
            given[...] = np.where(given == OMITTED, middle[edge].reshape(given.shape), given)
    at = np.minimum(np.searchsorted(numbers, edges[new]), max(len(numbers) - 1, 0))
    halfway = points[at].mean(axis=1) if len(numbers) else np.zeros((len(new), 3))
    linear = [
        (int(middle[edge]), int(edges[edge, 0]), int(edges[edge, 1])) for edge in new[straight[new]]
    ]
    return EdgeNodes(
        complete,
        np.concatenate([numbers, middle[new]]),
        np.concatenate([points, halfway]),
        len(new),
        linear,
    )


def _middle_nodes(kind: str, nodes: Integers) -> Integers | None:
    """Return a view of the nodes in the middle of edges, (elements, edges); None for a
    kind of first order.
    """
    element = ELEMENT_KINDS[kind]
    return (
        nodes[:, element.corners : element.corners + len(element.edges)]
        if element.order > 1
        else None
    )
