"""Nonlinear least squares by Gauss and Newton, with the covariance of what is fitted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats

_HALVINGS = 5


@dataclass(frozen=True)
class Fit:
    """Parameters fitted by least squares.

    Parameters
    ----------
    parameters : array, shape (p,)
        The parameters.
    covariance : array, shape (p, p)
        Their covariance, for residuals of unit variance.
    residual : array, shape (n,)
        What remains.
    converged : bool
        Whether the last step was below the tolerance.
    """

    parameters: Floats
    covariance: Floats
    residual: Floats
    converged: bool


def gauss_newton(
    model: Callable[[Floats], tuple[Floats, Floats]],
    start: Floats,
    most: Floats,
    tolerance: float = 0.02,
    steps: int = 12,
) -> Fit:
    """Return parameters that make the sum of the squares of residuals least.

    Parameters
    ----------
    model : callable
        Takes parameters (p,) and returns the residuals (n,), in their standard deviations, and
        their derivatives (n, p).
    start : array, shape (p,)
        Where to begin.
    most : array, shape (p,)
        Largest change of each parameter in a step.
    tolerance : float, default 0.02
        The last step is smaller than so many standard deviations.
    steps : int, default 12
        Most steps.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 20)
    >>> def decay(p):
    ...     shape = np.exp(-p[1] * x)
    ...     residual = p[0] * shape - 3.0 * np.exp(-2.0 * x)
    ...     return residual, np.stack([shape, -p[0] * x * shape], axis=1)
    >>> fit = gauss_newton(decay, np.array([1.0, 1.0]), np.array([9.0, 9.0]), 1e-9)
    >>> fit.parameters.round(6).tolist()
    [3.0, 2.0]
    """
    parameters = np.asarray(start, dtype=float)
    residual, slopes = model(parameters)
    converged = False
    for _ in range(steps):
        step = -_covariance(slopes) @ (slopes.T @ residual)
        step /= max(1.0, float(np.max(np.abs(step) / most)))
        # in standard deviations of the residuals
        change = slopes @ step
        converged = bool(change @ change < tolerance**2 * len(step))
        # a part of a step that is small enough is not worth another model
        trials = 1 if converged else _HALVINGS
        for _ in range(trials):
            new_residual, new_slopes = model(parameters + step)
            if new_residual @ new_residual < residual @ residual:
                break
            step = 0.5 * step
        else:
            converged = True  # nowhere lower along the step: the least there is, to rounding
            break
        parameters = parameters + step
        residual = new_residual
        slopes = new_slopes
        if converged:
            break
    return Fit(parameters, _covariance(slopes), residual, converged)


def _covariance(slopes: Floats) -> Floats:
    """Return the inverse of the normal matrix, by columns scaled alike.

    It is zero for a parameter that the model does not depend on.
    """
    scale = np.linalg.norm(slopes, axis=0)
    scale = np.where(scale > 0.0, scale, 1.0)
    normal = (slopes / scale).T @ (slopes / scale)
    inverse = np.linalg.pinv(normal, rcond=1e-13, hermitian=True)
    return np.asarray(inverse / np.outer(scale, scale))
