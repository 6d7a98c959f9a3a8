r"""Regularised deconvolution: a force in time from records that are linear in it.

The force is piecewise linear between nodes, zero at both ends, and smooth: its third differences
are normal, of a common standard deviation, which may be larger by a factor where a contact begins
and ends. Both that deviation and the estimate follow from the marginal likelihood of the records
(D. J. C. MacKay, Bayesian interpolation, Neural Computation 4:415, 1992). A sign is not imposed:
the contact laws of many programs pull before release, and where the records do not tell the force,
the band says so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats

_STRENGTHS = np.logspace(-12.0, 6.0, 181)
"""Strengths of the prior that are tried, over that of the data."""


@dataclass(frozen=True)
class Deconvolved:
    """A force in time, with what is known of it.

    Parameters
    ----------
    force : array, shape (nodes,)
        The force at its nodes [N].
    covariance : array, shape (nodes, nodes)
        Covariance of the force [N^2].
    strength : float
        Strength of the prior, over that of the data.
    evidence : float
        Logarithm of the marginal likelihood of the records, but for a constant.
    """

    force: Floats
    covariance: Floats
    strength: float
    evidence: float

    @property
    def deviation(self) -> Floats:
        """Standard deviations of the force at its nodes [N]."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    def deviation_of(self, weights: Floats) -> float:
        """Return the standard deviation of a sum of the nodes with weights, such as the impulse."""
        return float(np.sqrt(weights @ self.covariance @ weights))


def deconvolve(matrix: Floats, record: Floats, roughness: Floats | None = None) -> Deconvolved:
    """Return the force behind records.

    Parameters
    ----------
    matrix : array, shape (samples, nodes)
        The records of a unit force at each node, over the standard deviation of the noise.
    record : array, shape (samples,)
        The records, over the same.
    roughness : array, shape (nodes + 3,), optional
        Relative standard deviations of the third differences, which lie half a step beside the
        nodes; ones by default.

    Examples
    --------
    >>> time = np.linspace(0.0, 1.0, 41)[1:-1]
    >>> force = np.sin(np.pi * time) ** 2
    >>> response = np.tril(np.exp(-(time[:, None] - time)))
    >>> noise = 0.01 * np.random.default_rng(1).standard_normal(39)
    >>> found = deconvolve(response / 0.01, (response @ force + noise) / 0.01)
    >>> bool(abs(found.force.max() - 1.0) < 0.03)
    True
    """
    from scipy.linalg import eigh

    nodes = matrix.shape[1]
    differences = np.diff(np.eye(nodes + 6), 3, axis=0)[:, 3:-3]  # of a force that is zero outside
    rough = differences
    if roughness is not None:
        rough = differences / roughness[:, None]
    normal = matrix.T @ matrix
    smooth = rough.T @ rough
    projected = matrix.T @ record
    # both quadratic forms are diagonal in the same coordinates
    eigenvalues, vectors = eigh(normal, smooth)
    eigenvalues = np.maximum(eigenvalues, 0.0)
    amplitudes = vectors.T @ projected
    scale = float(eigenvalues.max())
    strengths = scale * _STRENGTHS[:, None]
    # of each strength the logarithm of the marginal likelihood: misfit, and volume of the prior
    explained = amplitudes**2 / (eigenvalues + strengths)
    evidence = 0.5 * (explained - np.log1p(eigenvalues / strengths)).sum(axis=1)
    best = int(np.argmax(evidence))
    strength = float(strengths[best, 0])
    covariance = (vectors / (eigenvalues + strength)) @ vectors.T
    return Deconvolved(
        force=np.asarray(covariance @ projected),
        covariance=np.asarray(covariance),
        strength=strength / scale,
        evidence=float(evidence[best]),
    )
