"""The fraction of a class in a stream of impacts, corrected by what the classifier confuses.

A classifier that recognises a part t of a class and takes a part f of the others for it counts q =
f + (t - f) p where the fraction is p, so that p = (q - f) / (t - f): the adjusted count of Forman
(2008), Data Mining and Knowledge Discovery 17:164, doi 10.1007/s10618-008-0097-y. Its interval has
the error of the count and that of t and f, which are known from finitely many rocks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices

FRACTIONS = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)
"""The true fractions of the streams that are tried."""

LENGTHS = (100, 1000)
"""The numbers of impacts of these streams."""

_STREAMS = 100
_DRAWS = 400
_STREAM_DRAWS = 200
_INTERVAL = (2.5, 97.5)  # percentiles


@dataclass(frozen=True, eq=False)
class Rates:
    """The parts of a class and of the others that are taken for the class.

    Parameters
    ----------
    true, false : array, shape (draws,)
        Part of the class, and part of the others, of groups drawn with replacement.
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
    """How well the fraction of a class is estimated in streams of impacts.

    They are of rocks other than those that the confusion was learned from.

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
    names, group_number = np.unique(groups, return_inverse=True)
    # how often each group is drawn, (draws, groups)
    counts = generator.multinomial(len(names), np.full(len(names), 1.0 / len(names)), draws)

    def rate(counted: Bools) -> Floats:
        hits = counts @ np.bincount(group_number, counted & taken, len(names))
        signals = counts @ np.bincount(group_number, counted, len(names))
        # half a signal taken and half a signal not: Jeffreys' prior, so that none taken of few is
        # not read as never
        return np.asarray((hits + 0.5) / (signals + 1.0))

    return Rates(true=rate(of_class), false=rate(~of_class))


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
    >>> fraction = estimate_fraction(410, 1000, rates, np.random.default_rng(0))
    >>> round(fraction.value, 3), fraction.low < 0.3 < fraction.high
    (0.3, True)
    """
    # the error of the count: a beta distribution, from Jeffreys' prior
    counted_fractions = generator.beta(counted + 0.5, impacts - counted + 0.5, len(rates.true))
    drawn = _adjusted_count(counted_fractions, rates.true, rates.false)
    low, high = np.percentile(drawn, _INTERVAL)
    (value,) = _adjusted_count(
        np.array([counted / impacts]),
        np.array([rates.true.mean()]),
        np.array([rates.false.mean()]),
    )
    return Estimate(float(value), float(low), float(high))


def _adjusted_count(counted: Floats, true: Floats, false: Floats) -> Floats:
    """Return corrected fractions p = (q - f) / (t - f), within 0 and 1.

    A classifier that confuses everything gives either end, and so an interval of all.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        fractions = (counted - false) / (true - false)
    bounded = np.nan_to_num(fractions, nan=0.5, posinf=1.0, neginf=0.0)
    return np.asarray(np.clip(bounded, 0.0, 1.0))


def try_streams(
    guessed: Indices, classes: Indices, class_names: tuple[str, ...], groups: Indices, seed: int
) -> list[Streams]:
    """Return how well fractions are estimated in streams, drawn many times.

    The confusion is learned from one half of the groups, and the streams are drawn from the other
    half.

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
    present = list(np.unique(classes))
    # of two classes the fraction of one tells that of the other
    tried_classes = present if len(present) > 2 else present[1:]
    streams = []
    for number in tried_classes:
        trials = _trials(guessed == number, classes == number, groups, generator)
        for (fraction, length), estimates in trials.items():
            if estimates:
                streams.append(_summary(class_names[number], fraction, length, estimates))
    return streams


_Trials = dict[tuple[float, int], list[tuple[float, Estimate]]]
"""By true fraction and number of impacts: the counted fraction and the estimate of each stream."""


def _trials(
    taken: Bools, of_class: Bools, groups: Indices, generator: np.random.Generator
) -> _Trials:
    """Return the estimates of the fraction of a class in many streams of each kind.

    Parameters
    ----------
    taken, of_class : array of bool
        Whether each signal is taken for the class, and whether it is of it.
    groups : array of int
        Group of each signal.
    generator : numpy.random.Generator
        Draws the halves and the streams.
    """
    names = np.unique(groups)
    trials: _Trials = {(fraction, length): [] for length in LENGTHS for fraction in FRACTIONS}
    for _ in range(_STREAMS):
        learned = np.isin(groups, generator.permutation(names)[: len(names) // 2])
        own_pool = np.flatnonzero(~learned & of_class)
        other_pool = np.flatnonzero(~learned & ~of_class)
        is_learned = (learned & of_class).any() and (learned & ~of_class).any()
        if not (len(own_pool) and len(other_pool) and is_learned):
            continue  # by chance one half has all groups of a class
        # the streams are of as few groups as the confusion is learned from: both have that error
        drawn_rates = [
            draw_rates(taken[learned], of_class[learned], groups[learned], generator, _STREAM_DRAWS)
            for _ in range(2)
        ]
        rates = Rates(
            true=_with_error_of([drawn.true for drawn in drawn_rates]),
            false=_with_error_of([drawn.false for drawn in drawn_rates]),
        )
        for (fraction, length), estimates in trials.items():
            # impacts fall one by one, so that a stream has the true fraction only in the mean
            own_impacts = int(generator.binomial(length, fraction))
            own = generator.choice(own_pool, own_impacts)
            others = generator.choice(other_pool, length - own_impacts)
            counted = int(taken[np.concatenate([own, others])].sum())
            estimate = estimate_fraction(counted, length, rates, generator)
            estimates.append((counted / length, estimate))
    return trials


def _with_error_of(draws: list[Floats]) -> Floats:
    """Return draws of one rate with the deviations of others added."""
    deviations = sum(other - other.mean() for other in draws[1:])
    return np.asarray(np.clip(draws[0] + deviations, 0.0, 1.0))


def _summary(
    class_name: str, fraction: float, impacts: int, estimates: list[tuple[float, Estimate]]
) -> Streams:
    """Return the mean of the estimates, their error, and how often their intervals are right."""
    counted = np.array([counted_fraction for counted_fraction, _ in estimates])
    values = np.array([estimate.value for _, estimate in estimates])
    low = np.array([estimate.low for _, estimate in estimates])
    high = np.array([estimate.high for _, estimate in estimates])
    return Streams(
        class_name=class_name,
        fraction=fraction,
        impacts=impacts,
        counted=float(np.mean(counted)),
        adjusted=float(values.mean()),
        error=float(np.sqrt(np.mean(np.square(values - fraction)))),
        low=float(low.mean()),
        high=float(high.mean()),
        covered=float(((low <= fraction) & (fraction <= high)).mean()),
    )
