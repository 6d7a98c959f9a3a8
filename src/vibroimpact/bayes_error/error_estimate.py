"""Bayes error of a population.

It is the share of wrong answers of the best classifier that sees only what is measured of each
fall.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats, Integers

_PAIRS_IN_MEMORY = 4_000_000  # of a fall that is tested and another one


class BayesError(NamedTuple):
    """Bounds of a Bayes error.

    Attributes
    ----------
    lower, upper : float
        Between these it lies, but for the errors of sampling.
    standard_error : float
        Of the upper bound, from the number of falls tested.
    neighbours : float
        Median number of falls that are as likely as the one tested; a bracket is wide where there
        are few.
    """

    lower: float
    upper: float
    standard_error: float
    neighbours: float


def bayes_error(
    measured: Floats,
    noise: Floats,
    classes: Integers,
    rocks: Integers | None = None,
    tested: int = 2000,
    seed: int = 0,
) -> BayesError:
    r"""Return bounds of the Bayes error of telling the class of a fall from what is measured of it.

    The posterior of the classes, given a noisy measurement y of fall i, follows from the falls j of
    all other rocks of the population, which are draws of the prior:

    .. math::

        P(c \mid y) \propto \sum_{r_j \ne r_i,\; c_j = c} \prod_k \mathcal{N}(y_k;\, s_{jk},
        \sigma_{jk})

    The mean of :math:`1 - \max_c P(c \mid y)` is below the Bayes error, as each posterior is fitted
    to its own neighbours; the share of
    falls whose most likely class is wrong is not below it, as no decision is better than that of
    Bayes (Devroye, Györfi and Lugosi, A Probabilistic Theory of Pattern Recognition, 1996, chapter
    2). Both tend to it as falls are added.

    Parameters
    ----------
    measured : array, shape (falls, quantities)
        What is measured, without noise.
    noise : array, shape (falls, quantities)
        Standard deviation of the noise of each.
    classes : array of int, shape (falls,)
        Class of each fall.
    rocks : array of int, shape (falls,), optional
        Number of the rock of each fall; without it each fall is of another rock.
    tested : int, default 2000
        Number of falls, drawn at random, for which the posterior is computed.
    seed : int, default 0
        Of the noise, and of the falls tested.

    Examples
    --------
    Two normal distributions of unit variance, 2 apart, half of which is noise: the error is that
    beyond 1 standard deviation, 0.159.

    >>> rng = np.random.default_rng(1)
    >>> classes = np.repeat([0, 1], 20_000)
    >>> clean = 2.0 * classes[:, None] + np.sqrt(0.5) * rng.standard_normal((40_000, 1))
    >>> error = bayes_error(clean, np.full_like(clean, np.sqrt(0.5)), classes)
    >>> abs(error.lower - 0.1587) < 0.01, abs(error.upper - 0.1587) < 3 * error.standard_error
    (True, True)
    """
    rng = np.random.default_rng(seed)
    falls = len(classes)
    rock_numbers = rocks
    if rock_numbers is None:
        rock_numbers = np.arange(falls)
    chosen = rng.choice(falls, min(tested, falls), replace=False)
    draws = rng.standard_normal((len(chosen), measured.shape[1]))
    noisy = measured[chosen] + noise[chosen] * draws
    names, codes = np.unique(classes, return_inverse=True)
    is_of_class = np.eye(len(names))[codes]  # (falls, classes)
    least_errors = []
    wrong = []
    neighbours = []
    block = max(1, _PAIRS_IN_MEMORY // falls)
    for first in range(0, len(chosen), block):
        in_block = chosen[first : first + block]
        # falls of the same rock would tell what is to be found out
        of_other_rocks = rock_numbers[in_block, None] != rock_numbers
        weight = _likelihoods(noisy[first : first + block], measured, noise, of_other_rocks)
        posterior = weight @ is_of_class / weight.sum(axis=1, keepdims=True)
        least_errors.append(1.0 - posterior.max(axis=1))
        wrong.append(posterior.argmax(axis=1) != codes[in_block])
        # number of equal weights of the same variance, after Kish
        neighbours.append(weight.sum(axis=1) ** 2 / (weight**2).sum(axis=1))
    upper = float(np.concatenate(wrong).mean())
    # of a share, and not zero where none is wrong
    variance = max(upper * (1.0 - upper), 0.25 / len(chosen))
    standard_error = float(np.sqrt(variance / len(chosen)))
    return BayesError(
        lower=min(float(np.concatenate(least_errors).mean()), upper),
        upper=upper,
        standard_error=standard_error,
        neighbours=float(np.median(np.concatenate(neighbours))),
    )


def _likelihoods(noisy: Floats, measured: Floats, noise: Floats, counted: Bools) -> Floats:
    """Return how likely measurements are for each fall, relative to the likeliest one.

    Parameters
    ----------
    noisy : array, shape (tested, quantities)
        The measurements.
    measured, noise : array, shape (falls, quantities)
        What is measured of each fall without noise, and the standard deviation of the noise.
    counted : array of bool, shape (tested, falls)
        Whether a fall is a neighbour of the one measured; those of the same rock are none.

    Returns
    -------
    array, shape (tested, falls)
    """
    logarithm = np.zeros((len(noisy), len(measured)))
    for clean, deviation, value in zip(measured.T, noise.T, noisy.T, strict=True):
        logarithm -= 0.5 * ((value[:, None] - clean) / deviation) ** 2 + np.log(deviation)
    logarithm[~counted] = -np.inf
    return np.asarray(np.exp(logarithm - logarithm.max(axis=1, keepdims=True)))
