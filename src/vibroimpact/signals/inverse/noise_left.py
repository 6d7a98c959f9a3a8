"""The noise of records from what a linear fit leaves of them."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Floats


def noise_left(residual: Floats, heard: Bools, slopes: Floats, covariance: Floats) -> Floats:
    """Return the noise of each record from what a fit leaves of it.

    That tells it better than a short quiet part does. What is left has less energy than the noise
    by what the fit follows of it: as many samples as unknowns that the record tells, which is the
    trace of its part of the projection (D. J. C. MacKay, Bayesian interpolation, Neural Computation
    4:415, 1992).

    Parameters
    ----------
    residual : array, shape (S, samples)
        What is left of the records.
    heard : array of bool, shape (S, samples)
        The samples that were fitted.
    slopes : array, shape (S samples, p)
        Derivatives of the samples in what was fitted, over the noise that the fit was made with;
        zero for samples that were not fitted.
    covariance : array, shape (p, p)
        Covariance of what was fitted.

    Examples
    --------
    The scatter about a mean:

    >>> record = np.array([[1.0, 3.0, 2.0]])
    >>> float(
    ...     noise_left(
    ...         record - 2.0, np.ones((1, 3), dtype=bool), np.ones((3, 1)), np.array([[1.0 / 3.0]])
    ...     )[0]
    ... )
    1.0
    """
    of_records = slopes.reshape(*residual.shape, -1)
    followed = np.einsum("snp,pq,snq->s", of_records, covariance, of_records, optimize=True)
    degrees_of_freedom = np.maximum(heard.sum(axis=1) - followed, 1.0)
    return np.asarray(np.sqrt((residual**2 * heard).sum(axis=1) / degrees_of_freedom))
