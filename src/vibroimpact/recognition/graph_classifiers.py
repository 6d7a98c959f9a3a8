"""The operators of ONNX that are classifiers: that their lists agree with each other, and
refer to what there is.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Indices
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted

Attributes = dict[str, Any]
Shapes = list[tuple[int, ...]]

_DEEPEST = 1000
"""Levels of a tree."""

_LEAF, _BRANCH = b"LEAF", b"BRANCH_LEQ"
_TRANSFORMS = (b"NONE", b"LOGISTIC", b"SOFTMAX")


def with_length(
    attributes: Attributes, key: str, *lengths: int, otherwise: int | None = None
) -> NDArray[Any]:
    """Return a list of finite numbers of one of some lengths, or an empty one if it may be missing.

    Raises
    ------
    InputError
        If it is not; the sentence lacks its subject, the operator.
    """
    values = attributes.get(key)
    if values is None and otherwise == 0:
        return np.zeros(0)
    if not isinstance(values, np.ndarray):
        raise InputError(f"has no list {key}")
    if len(values) not in lengths:
        raise InputError(
            f"has a list {key} of {len(values)} numbers, where "
            f"{' or '.join(map(str, sorted(set(lengths))))} belong"
        )
    if not np.isfinite(values).all():
        raise InputError(f"has a list {key} with numbers that are not finite")
    return values


def one_of(attributes: Attributes, key: str, allowed: Collection[Any]) -> None:
    """Raise InputError unless an attribute is missing or one of the allowed values."""
    if key in attributes and attributes[key] not in allowed:
        raise InputError(f"has {quoted(attributes[key])} as {key}")


def _only(attributes: Attributes, *keys: str) -> None:
    unknown = sorted(attributes.keys() - set(keys))
    if unknown:
        raise InputError(
            f"has the attribute {quoted(unknown[0])}, which it does not have in "
            "a model of this program"
        )


def _check_labels(attributes: Attributes, key: str, classes: int) -> None:
    if with_length(attributes, key, classes).tolist() != list(range(classes)):
        raise InputError(f"has other classes than 0 to {classes - 1}")


def _linear(attributes: Attributes, rows: int, features: int, classes: int) -> Shapes:
    _only(
        attributes,
        "classlabels_ints",
        "coefficients",
        "intercepts",
        "multi_class",
        "post_transform",
    )
    _check_labels(attributes, "classlabels_ints", classes)
    with_length(attributes, "coefficients", classes * features)
    with_length(attributes, "intercepts", classes)
    one_of(attributes, "multi_class", (0, 1))
    one_of(attributes, "post_transform", _TRANSFORMS)
    return [(rows,), (rows, classes)]


def _machine(attributes: Attributes, rows: int, features: int, classes: int) -> Shapes:
    """Check a support vector machine; it gives a number for each pair of classes, and of
    two classes one for each.
    """
    keys = (
        "coefficients",
        "kernel_params",
        "kernel_type",
        "post_transform",
        "rho",
        "support_vectors",
        "vectors_per_class",
    )
    _only(attributes, "classlabels_ints", *keys)
    _check_labels(attributes, "classlabels_ints", classes)
    counts = with_length(attributes, "vectors_per_class", classes)
    if (counts < 1).any() or (counts > 10**9).any():
        raise InputError("has classes without support vectors")
    vectors, pairs = int(counts.sum()), classes * (classes - 1) // 2
    with_length(attributes, "support_vectors", vectors * features)
    with_length(attributes, "coefficients", vectors * (classes - 1))
    with_length(attributes, "rho", pairs)
    with_length(attributes, "kernel_params", 3)
    one_of(attributes, "kernel_type", (b"RBF",))
    one_of(attributes, "post_transform", (b"NONE",))
    return [(rows,), (rows, max(2, pairs))]


def _trees(attributes: Attributes, rows: int, features: int, classes: int) -> Shapes:
    nodes = (
        "falsenodeids",
        "featureids",
        "hitrates",
        "missing_value_tracks_true",
        "modes",
        "nodeids",
        "treeids",
        "truenodeids",
        "values",
    )
    leaves = ("class_ids", "class_nodeids", "class_treeids", "class_weights")
    _only(
        attributes,
        *(f"nodes_{name}" for name in nodes),
        *leaves,
        "classlabels_int64s",
        "base_values",
        "post_transform",
    )
    _check_labels(attributes, "classlabels_int64s", classes)
    one_of(attributes, "post_transform", _TRANSFORMS)
    with_length(attributes, "base_values", 1, classes, otherwise=0)
    modes = np.array(attributes.get("nodes_modes", []), dtype=object)
    count = len(modes)
    is_leaf = modes == _LEAF
    if not count or not (is_leaf | (modes == _BRANCH)).all():
        raise InputError("has no nodes of trees, or nodes that are neither leaves nor branches")
    with_length(attributes, "nodes_values", count)
    for name in ("hitrates", "missing_value_tracks_true"):
        with_length(attributes, f"nodes_{name}", count, otherwise=0)
    tracks = attributes.get("nodes_missing_value_tracks_true")
    if tracks is not None and not np.isin(tracks, (0, 1)).all():
        raise InputError("has branches that take missing values to neither side")
    _check_range(
        "nodes_featureids", with_length(attributes, "nodes_featureids", count)[~is_leaf], features
    )
    places = _Places(
        with_length(attributes, "nodes_treeids", count),
        with_length(attributes, "nodes_nodeids", count),
    )
    _check_range("nodes_treeids", places.trees, count)
    _check_range("nodes_nodeids", places.nodes, count)
    ends = [
        with_length(attributes, f"nodes_{side}nodeids", count)[~is_leaf]
        for side in ("true", "false")
    ]
    _check_branches(is_leaf, [places.find(places.trees[~is_leaf], end) for end in ends])
    weights = len(attributes.get("class_ids", ()))
    trees, ids = (
        with_length(attributes, f"class_{name}", weights) for name in ("treeids", "nodeids")
    )
    if not weights or not is_leaf[places.find(trees, ids)].all():
        raise InputError("has weights of nodes that are no leaves")
    with_length(attributes, "class_weights", weights)
    _check_range("class_ids", with_length(attributes, "class_ids", weights), classes)
    return [(rows,), (rows, classes)]


def _check_range(key: str, values: Indices, end: int) -> None:
    if not ((values >= 0) & (values < end)).all():
        raise InputError(f"has {key} that are not from 0 to {end - 1}")


class _Places:
    """The places of nodes in their list, by the numbers of tree and node.

    Parameters
    ----------
    trees, nodes : array of int
        The numbers of each node.
    """

    def __init__(self, trees: Indices, nodes: Indices) -> None:
        self.trees, self.nodes = trees, nodes
        order = np.lexsort((nodes, trees))
        self._order, self._keys = order, self._key(trees, nodes)[order]
        if (np.diff(self._keys) == 0).any():
            raise InputError("has two nodes of the same number in a tree")

    def _key(self, trees: Indices, nodes: Indices) -> Indices:
        return np.asarray(
            np.clip(trees, -1, 2**31) * 2**31 + np.clip(nodes, -1, 2**31 - 1), dtype=np.int64
        )

    def find(self, trees: Indices, nodes: Indices) -> Indices:
        """Return the place of each of some nodes."""
        keys = self._key(trees, nodes)
        place = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        if (self._keys[place] != keys).any():
            raise InputError("refers to nodes that there are not")
        return np.asarray(self._order[place])


def _check_branches(is_leaf: NDArray[np.bool_], ends: list[Indices]) -> None:
    """Check that branches lead to leaves: from the roots on each node is reached once, within some
    levels.

    Parameters
    ----------
    is_leaf : array of bool
        Whether a node is a leaf.
    ends : two arrays of int
        The nodes that each branch leads to, in the order of the branches.
    """
    count = len(is_leaf)
    reached_by = np.bincount(np.concatenate(ends), minlength=count)
    if (reached_by > 1).any():
        raise InputError("has nodes that two branches lead to")
    first, second = np.full(count, -1), np.full(count, -1)
    first[~is_leaf], second[~is_leaf] = ends
    level, seen = np.flatnonzero(reached_by == 0), 0
    for _ in range(_DEEPEST):
        seen += len(level)
        level = level[~is_leaf[level]]
        if not len(level):
            break
        level = np.concatenate([first[level], second[level]])
    if seen != count:
        raise InputError(f"has trees that do not end, or are deeper than {_DEEPEST} levels")


CLASSIFIERS: dict[str, Callable[[Attributes, int, int, int], Shapes]] = {
    "LinearClassifier": _linear,
    "SVMClassifier": _machine,
    "TreeEnsembleClassifier": _trees,
}
"""By the name of the operator, what checks it and returns the shapes of the classes and
of their probabilities or scores.
"""
