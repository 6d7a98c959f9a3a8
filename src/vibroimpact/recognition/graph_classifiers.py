"""Checks of the operators of ONNX that are classifiers.

Their lists must agree with each other, and refer to what there is.
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

# modes of the nodes of trees
_LEAF = b"LEAF"
_BRANCH = b"BRANCH_LEQ"
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
    """Check a linear classifier."""
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
    """Check a support vector machine.

    It gives a number for each pair of classes, and of two classes one for each.
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
    vectors = int(counts.sum())
    pairs = classes * (classes - 1) // 2
    with_length(attributes, "support_vectors", vectors * features)
    with_length(attributes, "coefficients", vectors * (classes - 1))
    with_length(attributes, "rho", pairs)
    with_length(attributes, "kernel_params", 3)
    one_of(attributes, "kernel_type", (b"RBF",))
    one_of(attributes, "post_transform", (b"NONE",))
    return [(rows,), (rows, max(2, pairs))]


_NODE_LISTS = (
    "nodes_falsenodeids",
    "nodes_featureids",
    "nodes_hitrates",
    "nodes_missing_value_tracks_true",
    "nodes_modes",
    "nodes_nodeids",
    "nodes_treeids",
    "nodes_truenodeids",
    "nodes_values",
)
_LEAF_LISTS = ("class_ids", "class_nodeids", "class_treeids", "class_weights")


def _trees(attributes: Attributes, rows: int, features: int, classes: int) -> Shapes:
    """Check an ensemble of decision trees: its nodes, their branches, and the weights of leaves."""
    _only(
        attributes,
        *_NODE_LISTS,
        *_LEAF_LISTS,
        "classlabels_int64s",
        "base_values",
        "post_transform",
    )
    _check_labels(attributes, "classlabels_int64s", classes)
    one_of(attributes, "post_transform", _TRANSFORMS)
    with_length(attributes, "base_values", 1, classes, otherwise=0)
    is_leaf = _leaves(attributes)
    _check_node_values(attributes, is_leaf, features)
    count = len(is_leaf)
    index = _NodeIndex(
        with_length(attributes, "nodes_treeids", count),
        with_length(attributes, "nodes_nodeids", count),
    )
    _check_range("nodes_treeids", index.trees, count)
    _check_range("nodes_nodeids", index.nodes, count)
    true_ends = with_length(attributes, "nodes_truenodeids", count)[~is_leaf]
    false_ends = with_length(attributes, "nodes_falsenodeids", count)[~is_leaf]
    trees = index.trees[~is_leaf]
    _check_branches(is_leaf, [index.find(trees, ends) for ends in (true_ends, false_ends)])
    _check_weights(attributes, is_leaf, index, classes)
    return [(rows,), (rows, classes)]


def _leaves(attributes: Attributes) -> NDArray[np.bool_]:
    """Return which nodes of trees are leaves; the others are branches."""
    modes = np.array(attributes.get("nodes_modes", []), dtype=object)
    is_leaf = modes == _LEAF
    if not len(modes) or not (is_leaf | (modes == _BRANCH)).all():
        raise InputError("has no nodes of trees, or nodes that are neither leaves nor branches")
    return np.asarray(is_leaf)


def _check_node_values(attributes: Attributes, is_leaf: NDArray[np.bool_], features: int) -> None:
    """Check the features and thresholds of branches, and where they take missing values."""
    count = len(is_leaf)
    with_length(attributes, "nodes_values", count)
    for name in ("hitrates", "missing_value_tracks_true"):
        with_length(attributes, f"nodes_{name}", count, otherwise=0)
    tracks = attributes.get("nodes_missing_value_tracks_true")
    if tracks is not None and not np.isin(tracks, (0, 1)).all():
        raise InputError("has branches that take missing values to neither side")
    feature_numbers = with_length(attributes, "nodes_featureids", count)
    _check_range("nodes_featureids", feature_numbers[~is_leaf], features)


def _check_weights(
    attributes: Attributes, is_leaf: NDArray[np.bool_], index: _NodeIndex, classes: int
) -> None:
    """Check that the weights of classes are those of leaves."""
    count = len(attributes.get("class_ids", ()))
    trees = with_length(attributes, "class_treeids", count)
    nodes = with_length(attributes, "class_nodeids", count)
    if not count or not is_leaf[index.find(trees, nodes)].all():
        raise InputError("has weights of nodes that are no leaves")
    with_length(attributes, "class_weights", count)
    _check_range("class_ids", with_length(attributes, "class_ids", count), classes)


def _check_range(key: str, values: Indices, end: int) -> None:
    if not ((values >= 0) & (values < end)).all():
        raise InputError(f"has {key} that are not from 0 to {end - 1}")


class _NodeIndex:
    """Indices of nodes in their list, by the numbers of tree and node.

    Parameters
    ----------
    trees, nodes : array of int
        The numbers of each node.
    """

    def __init__(self, trees: Indices, nodes: Indices) -> None:
        self.trees = trees
        self.nodes = nodes
        self._order = np.lexsort((nodes, trees))
        self._keys = self._key(trees, nodes)[self._order]
        if (np.diff(self._keys) == 0).any():
            raise InputError("has two nodes of the same number in a tree")

    def _key(self, trees: Indices, nodes: Indices) -> Indices:
        """Return one number for each pair of a tree and a node."""
        # numbers of no tree or node, however large, must not look like another pair
        tree = np.clip(trees, -1, 2**31)
        node = np.clip(nodes, -1, 2**31 - 1)
        return np.asarray(tree * 2**31 + node, dtype=np.int64)

    def find(self, trees: Indices, nodes: Indices) -> Indices:
        """Return the index of each of some nodes."""
        keys = self._key(trees, nodes)
        position = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        if (self._keys[position] != keys).any():
            raise InputError("refers to nodes that there are not")
        return np.asarray(self._order[position])


def _check_branches(is_leaf: NDArray[np.bool_], ends: list[Indices]) -> None:
    """Check that branches lead to leaves.

    From the roots on, each node must be reached once, within some levels.

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
    first_end = np.full(count, -1)
    second_end = np.full(count, -1)
    first_end[~is_leaf], second_end[~is_leaf] = ends
    # level by level from the roots, to which no branch leads; a circle has no root
    level = np.flatnonzero(reached_by == 0)
    reached = 0
    for _ in range(_DEEPEST):
        reached += len(level)
        branches = level[~is_leaf[level]]
        if not len(branches):
            break
        level = np.concatenate([first_end[branches], second_end[branches]])
    if reached != count:
        raise InputError(f"has trees that do not end, or are deeper than {_DEEPEST} levels")


CLASSIFIERS: dict[str, Callable[[Attributes, int, int, int], Shapes]] = {
    "LinearClassifier": _linear,
    "SVMClassifier": _machine,
    "TreeEnsembleClassifier": _trees,
}
"""What checks an operator, by its name.

It returns the shapes of the classes and of their probabilities or scores.
"""
