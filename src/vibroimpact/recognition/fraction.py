"""The fraction of a class in a stream of impacts, with its error: what is counted is corrected by
what the classifier confuses.

A classifier that recognises a part t of a class and takes a part f of the others for it counts q =
f + (t - f) p where the fraction is p, so that p = (q - f) / (t - f): the adjusted count of Forman
(2008), Data Mining and Knowledge Discovery 17:164, doi 10.1007/s10618-008-0097-y. Its interval has
the error of the count and that of t and f, which are known from finitely many rocks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices

FRACTIONS, LENGTHS = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0), (100, 1000)
"""The true fractions, and the numbers of impacts, of the streams that are tried."""

_STREAMS, _DRAWS = 100, 400
_INTERVAL = (2.5, 97.5)


@dataclass(frozen=True, eq=False)
class Rates:
    """The parts of a class and of the others that are taken for the class, of groups
    drawn with replacement: arrays, shape (draws,).
    """

    true: Floats
    false: Floats


@dataclass(frozen=True, eq=False)
class Estimate:
    """A fraction with its interval of 95 %."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Streams:
    """How well the fraction of a class is estimated in streams of rocks other than those that the
    confusion was learned from.

    Parameters
    ----------
    class_name : str
        The class.
    fraction : float
        Its true fraction.
    impacts : int
        Number of impacts in a stream.
    counted, adjusted : float
        Mean of what is counted, and of the corrected estimate.
    error : float
        Root of the mean square of the estimate's error.
    low, high : float
        Mean ends of its intervals.
    covered : float
        Part of the intervals that hold the true fraction.
    """

    class_name: str
    fraction: float
    impacts: int
    counted: float
    adjusted: float
    error: float
    low: float
    high: float
    covered: float


def draw_rates(
    taken: Bools,
    of_class: Bools,
    groups: Indices,
    generator: np.random.Generator,
    draws: int = _DRAWS,
) -> Rates:
    """Return how often signals are taken for a class, of groups drawn with replacement.

    Parameters
    ----------
    taken, of_class : array of bool
        Whether each signal is taken for the class, and whether it is of it.
    groups : array of int
        Group of each signal.
    generator : numpy.random.Generator
        Draws the groups.
    draws : int
        Number of draws.
    """
    names, place = np.unique(groups, return_inverse=True)
    weights = generator.multinomial(len(names), np.full(len(names), 1.0 / len(names)), draws)

    def rate(own: Bools) -> Floats:
        # half a signal taken and half a signal not: Jeffreys' prior, so that none taken of few is
        # not read as never
        hits = weights @ np.bincount(place, own & taken, len(names))
        return np.asarray((hits + 0.5) / (weights @ np.bincount(place, own, len(names)) + 1.0))

    return Rates(rate(of_class), rate(~of_class))


def estimate_fraction(
    counted: int, impacts: int, rates: Rates, generator: np.random.Generator
) -> Estimate:
    """Return the fraction of a class in a stream of impacts.

    Parameters
    ----------
    counted : int
        Number of impacts taken for the class.
    impacts : int
        Number of impacts.
    rates : Rates
        What the classifier confuses.
    generator : numpy.random.Generator
        Draws the error of the count.

    Examples
    --------
    >>> rates = Rates(np.full(400, 0.9), np.full(400, 0.2))
    >>> found = estimate_fraction(410, 1000, rates, np.random.default_rng(0))
    >>> round(found.value, 3), found.low < 0.3 < found.high
    (0.3, True)
    """
    counts = generator.beta(counted + 0.5, impacts - counted + 0.5, len(rates.true))
    low, high = np.percentile(_adjusted(counts, rates.true, rates.false), _INTERVAL)
    value = _adjusted(
        np.array([counted / impacts]), np.array([rates.true.mean()]), np.array([rates.false.mean()])
    )[0]
    return Estimate(float(value), float(low), float(high))


def _adjusted(counted: Floats, true: Floats, false: Floats) -> Floats:
    """Return corrected fractions, within 0 and 1; a classifier that confuses everything
    gives either end, and so an interval of all.
    """
    apart = true - false
    with np.errstate(divide="ignore", invalid="ignore"):
        found = (counted - false) / apart
    return np.asarray(np.clip(np.nan_to_num(found, nan=0.5, posinf=1.0, neginf=0.0), 0.0, 1.0))


def try_streams(
    guessed: Indices, classes: Indices, class_names: tuple[str, ...], groups: Indices, seed: int
) -> list[Streams]:
    """Return how well fractions are estimated: confusion from one half of the groups, streams drawn
    from the other half, many times.

    Parameters
    ----------
    guessed, classes : array of int
        The class that each signal is taken for by a model that did not see it, and its true class.
    class_names : tuple of str
        Names of the classes.
    groups : array of int
        Group of each signal.
    seed : int
        Seed of the halves and streams.
    """
    generator = np.random.default_rng(seed)
    names = np.unique(groups)
    found = []
    present = list(np.unique(classes))
    for one in present if len(present) > 2 else present[1:]:
        taken, own = guessed == one, classes == one
        tried: dict[tuple[float, int], list[tuple[float, Estimate]]] = {
            (part, length): [] for length in LENGTHS for part in FRACTIONS
        }
        for _ in range(_STREAMS):
            learned = np.isin(groups, generator.permutation(names)[: len(names) // 2])
            pools = [np.flatnonzero(~learned & mask) for mask in (own, ~own)]
            if not (all(map(len, pools)) and (learned & own).any() and (learned & ~own).any()):
                continue  # by chance one half has all groups of a class
            # the streams are of as few groups as the confusion is learned from: both have that
            # error
            both = [
                draw_rates(taken[learned], own[learned], groups[learned], generator, 200)
                for _ in range(2)
            ]
            rates = Rates(
                _with_error_of([one.true for one in both]),
                _with_error_of([one.false for one in both]),
            )
            for (part, length), rows in tried.items():
                of_class = int(generator.binomial(length, part))
                stream = np.concatenate(
                    [
                        generator.choice(pools[0], of_class),
                        generator.choice(pools[1], length - of_class),
                    ]
                )
                counted = int(taken[stream].sum())
                rows.append(
                    (counted / length, estimate_fraction(counted, length, rates, generator))
                )
        for (part, length), rows in tried.items():
            if rows:
                found.append(_summed(class_names[one], part, length, rows))
    return found


def _with_error_of(draws: list[Floats]) -> Floats:
    """Return draws of one rate with the deviations of others added."""
    return np.asarray(np.clip(draws[0] + sum(one - one.mean() for one in draws[1:]), 0.0, 1.0))


def _summed(
    name: str, fraction: float, impacts: int, rows: list[tuple[float, Estimate]]
) -> Streams:
    values, low, high = (
        np.array(column)
        for column in zip(*((one.value, one.low, one.high) for _, one in rows), strict=True)
    )
    counted = float(np.mean([count for count, _ in rows]))
    covered = float(((low <= fraction) & (fraction <= high)).mean())
    error = float(np.sqrt(np.mean(np.square(values - fraction))))
    return Streams(
        name,
        fraction,
        impacts,
        counted,
        float(values.mean()),
        error,
        float(low.mean()),
        float(high.mean()),
        covered,
    )
