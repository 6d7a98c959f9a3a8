"""Noise of measured impacts: contributions of independent sources, as sparse matrices.

A source reaches one or two neighbouring impacts, so that everything here is linear in the number of
impacts.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
from scipy.linalg import cholesky_banded, solve_banded
from scipy.sparse import coo_array, csr_array, diags_array, hstack, vstack
from scipy.sparse.csgraph import reverse_cuthill_mckee

from vibroimpact.arrays import Floats

Noise: TypeAlias = Any
"""A sparse array (n, m): the contributions of m sources of unit variance to n impacts."""


def as_noise(contributions: Any) -> Noise:
    """Return contributions (n, m), dense or sparse, as a sparse array."""
    return csr_array(contributions)


def no_noise(impacts: int, sources: int) -> Noise:
    """Return the noise of exact values."""
    return csr_array((impacts, sources))


def own_noise(deviations: Mapping[str, Floats]) -> dict[str, Noise]:
    """Return the noise of quantities that are read independently at each impact.

    `deviations` are their standard deviations, (n,).

    Examples
    --------
    >>> noise = own_noise({"max_force": np.array([1.0, 2.0]), "duration": np.array([0.1, 0.2])})
    >>> noise["duration"].toarray().tolist()
    [[0.0, 0.0, 0.1, 0.0], [0.0, 0.0, 0.0, 0.2]]
    """
    names = list(deviations)
    impacts = len(deviations[names[0]])
    noise = {}
    for number, name in enumerate(names):
        # n sources for each quantity
        before = no_noise(impacts, number * impacts)
        after = no_noise(impacts, (len(names) - 1 - number) * impacts)
        noise[name] = csr_array(hstack([before, diags_array(deviations[name]), after]))
    return noise


def with_common_source(
    noise: Mapping[str, Noise], contributions: Mapping[str, Floats]
) -> dict[str, Noise]:
    """Return noise with one more source that all impacts have in common.

    `contributions` to each impact, (n,), are by quantity; to other quantities it contributes
    nothing.

    Examples
    --------
    >>> own = own_noise({"duration": np.array([0.1, 0.2])})
    >>> with_common_source(own, {"duration": np.array([0.3, 0.4])})["duration"].toarray().tolist()
    [[0.1, 0.0, 0.3], [0.0, 0.2, 0.4]]
    """
    with_common = {}
    for name, own in noise.items():
        contribution = contributions.get(name, np.zeros(own.shape[0]))
        with_common[name] = csr_array(hstack([own, csr_array(contribution[:, None])]))
    return with_common


def scaled(factors: Floats, noise: Noise) -> Noise:
    """Return noise with the contributions to each impact multiplied by a factor, (n,)."""
    return csr_array(diags_array(factors) @ noise)


def of_the_impact_before(noise: Noise) -> Noise:
    """Return noise that each impact takes from the one before it; the first has none."""
    return csr_array(vstack([no_noise(1, noise.shape[1]), noise[:-1]]))


def standard_deviations(noise: Noise) -> Floats:
    """Return the standard deviation at each impact, (n,).

    Examples
    --------
    >>> standard_deviations(as_noise([[3.0, 4.0], [0.0, 1.0]])).tolist()
    [5.0, 1.0]
    """
    return np.asarray(np.sqrt((noise * noise).sum(axis=1)), dtype=float)


def whitened(noise: Noise, columns: Floats) -> Floats:
    r"""Return columns (n, k) such that their noise is independent and of unit variance.

    They are in another order, and multiplied by the inverse of a root of the covariance of their
    noise. The covariance :math:`N N^T` is ordered into a narrow band, in which its Cholesky factor
    stays.

    Raises
    ------
    numpy.linalg.LinAlgError
        If a value has no noise.

    Examples
    --------
    >>> sorted(
    ...     whitened(as_noise([[2.0, 0.0], [0.0, 4.0]]), np.array([[1.0], [1.0]])).ravel().tolist()
    ... )
    [0.25, 0.5]
    """
    covariance = csr_array(noise @ noise.T)
    order = reverse_cuthill_mckee(covariance, symmetric_mode=True)
    ordered = coo_array(covariance[order][:, order])
    below_diagonal = ordered.row - ordered.col
    width = int(below_diagonal.max(initial=0))
    # the lower triangle, with a row for each of its diagonals
    band = np.zeros((width + 1, len(order)))
    lower = below_diagonal >= 0
    band[below_diagonal[lower], ordered.col[lower]] = ordered.data[lower]
    root = cholesky_banded(band, lower=True, overwrite_ab=True)
    return np.asarray(solve_banded((width, 0), root, columns[order]))
