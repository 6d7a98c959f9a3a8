"""The bound of a population: the Bayes error for what may be measured of a fall, and what
it tells of the rock.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bayes_error.error_estimate import BayesError, bayes_error
from vibroimpact.bayes_error.falls import Falls, falls_of_study, falls_of_sweep
from vibroimpact.bayes_error.observations import OBSERVATIONS, Channel, Observation, measurable
from vibroimpact.errors import InputError
from vibroimpact.report.reported import Reported
from vibroimpact.studies.study import Study
from vibroimpact.studies.sweep import Sweep

BANDWIDTHS = np.array([1e3, 2e3, 4e3, 8e3, 16e3, 32e3])
SIGNAL_TO_NOISE = np.array([0.0, 10.0, 20.0, 30.0, 40.0, 60.0])
"""Bandwidths [Hz] and ratios of signal to noise [dB] over which the error from one impact
is mapped.
"""

PROPERTIES = ("radius", "density", "modulus", "speed")
"""What a bound says of the rock, besides its class."""

_NAMED = {one.name: one for one in OBSERVATIONS}
_MAPPED = _NAMED["one impact"]
_TESTED, _TESTED_OF_MAP, _FALLS_OF_MAP = 2000, 500, 8000


@dataclass(frozen=True, eq=False)
class Bound(Reported, reported_in="vibroimpact.bayes_error.report"):
    """The Bayes error of a population: the lowest error of a classifier that sees only the measured
    quantities, with the stated scatter.

    Parameters
    ----------
    name : str
        Title of the population.
    falls : Falls
        Its falls.
    channel : Channel
        What hears them.
    errors : dict of str to BayesError
        The Bayes error, by the name of what is measured.
    majority : float
        Error of naming the more frequent class always.
    remaining : dict of str to array
        Of each of `PROPERTIES`, the standard deviation of its logarithm that remains after the best
        linear estimate from what is measured, over that before.
    map : array, shape (bandwidths, ratios)
        The Bayes error from one impact over `BANDWIDTHS` and `SIGNAL_TO_NOISE`: the upper bounds.
    without_scatter : dict of str to BayesError
        The Bayes error if the assumed scatter of the amplitude is zero, that of sensitivity and of
        the position: `Channel.gain` and `Channel.place`.
    on_rigid_plate : bool, default False
        Whether the falls were computed on the plate as a rigid body, as those of a stated
        population are.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> bound = vi.bound_of(vi.load_sweep("signals:coal-gangue", samples=100))
    >>> float(bound.majority), bound.map.shape, list(bound.errors)[:3]
    (0.36, (6, 6), ['impulse', 'contact time', 'one impact'])
    """

    name: str
    falls: Falls
    channel: Channel
    errors: dict[str, BayesError]
    majority: float
    remaining: dict[str, Floats]
    map: Floats
    without_scatter: dict[str, BayesError]
    on_rigid_plate: bool = False


def bound_of(
    population: Study | Sweep,
    channel: Channel | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> Bound:
    """Return the Bayes error of a population for sets of measured quantities: the lowest error of a
    classifier that sees only these.

    A sensor hears the contact force through the plate, a linear system that is the same whatever
    falls. What it records of an impact therefore tells no more of the rock than the force itself.
    Of the force impulse and duration are counted. A signal contains more, the shape of the pulse,
    the position of the impact and further impacts; a classifier that uses it can have a lower
    error.

    Parameters
    ----------
    population : Study or Sweep
        A computed data set, or a stated population, whose falls are then computed on its plate as a
        rigid body.
    channel : Channel, optional
        Band, noise and assumed scatter of what hears it.
    seed : int, default 0
        Of the noise.
    progress : callable, optional
        Called with the fraction that is done.

    Raises
    ------
    InputError
        If it has no classes, or fewer than two of them touched the plate.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> bound = bound_of(vi.load_sweep("signals:coal-gangue", 1000))
    >>> bound.errors["contact time"].upper > 5 * bound.errors["one impact"].upper
    True
    """
    falls = (
        falls_of_study(population) if isinstance(population, Study) else falls_of_sweep(population)
    )
    names, counts = np.unique(falls.classes, return_counts=True)
    if len(names) < 2:
        raise InputError(
            "fewer than two classes have falls that were computed and touched the plate, so "
            "that there is nothing to classify"
        )
    heard, steps = (
        channel or Channel(),
        len(OBSERVATIONS) + BANDWIDTHS.size * SIGNAL_TO_NOISE.size + 1,
    )

    def tell(done: int) -> None:
        if progress is not None:
            progress(done / steps)

    errors, remaining = {}, {}
    for number, one in enumerate(OBSERVATIONS):
        errors[one.name] = _error(falls, heard, one, _TESTED, seed)
        remaining[one.name] = _remaining(falls, heard, one)
        tell(number + 1)
    errors = _bounded_by_less(errors)
    few, found = _some(falls, _FALLS_OF_MAP), np.empty((BANDWIDTHS.size, SIGNAL_TO_NOISE.size))
    for place, (bandwidth, ratio) in enumerate(
        (one, other) for one in BANDWIDTHS for other in SIGNAL_TO_NOISE
    ):
        there = replace(heard, bandwidth=float(bandwidth), signal_to_noise=float(ratio))
        found.flat[place] = _error(few, there, _MAPPED, _TESTED_OF_MAP, seed).upper
        tell(len(OBSERVATIONS) + place + 1)
    without = _without_scatter(falls, heard, errors, seed)
    tell(steps)
    majority, rigid = 1.0 - counts.max() / counts.sum(), not isinstance(population, Study)
    return Bound(population.name, falls, heard, errors, majority, remaining, found, without, rigid)


SEEN_AT_BEST = "impulse, contact time and the time to the next impact"
"""What a classifier sees whose error has the bound `least_error`."""


def least_error(falls: Falls, seed: int = 0) -> float:
    """Return the lower bound on the error of a classifier that sees `SEEN_AT_BEST` of single falls.

    Impulse and contact time are measured up to 50 kHz, 80 dB above the noise, with a sensitivity
    known to 0.1 %. A classifier that sees more, as the shape of the pulse, the position of the
    impact or further impacts, can have a lower error.

    Parameters
    ----------
    falls : Falls
        Falls of the population.
    seed : int, default 0
        Of the noise.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> least_error(falls_of_sweep(vi.load_sweep("signals:coal-gangue", 2000))) < 0.01
    True
    """
    # the scatter of the time to the next impact is the default
    heard = Channel(bandwidth=50e3, signal_to_noise=80.0, gain=0.001)
    return _error(falls, heard, _NAMED["with the bounce"], _TESTED, seed).lower


def _some(falls: Falls, number: int) -> Falls:
    """Return the first falls."""
    parts = (
        falls.classes,
        falls.radius,
        falls.density,
        falls.modulus,
        falls.speed,
        falls.restitution,
        falls.duration,
    )
    return Falls(*(one[:number] for one in parts))


def _error(falls: Falls, channel: Channel, one: Observation, tested: int, seed: int) -> BayesError:
    values, noise = measurable(falls, channel)
    classes = np.unique(falls.classes, return_inverse=True)[1]
    measured, deviation = (
        np.stack([part[name] for name in one.quantities], axis=1) for part in (values, noise)
    )
    return bayes_error(measured, deviation, classes, tested, seed)


def _without_scatter(
    falls: Falls, channel: Channel, errors: dict[str, BayesError], seed: int
) -> dict[str, BayesError]:
    """Return the Bayes errors without scatter of the amplitude, which are not larger than
    those with it.
    """
    exact, found = replace(channel, gain=0.0, place=0.0), {}
    for one in OBSERVATIONS:
        quantities = _exact_quantities(one)
        # with a known position and with an unknown one
        alike = [other for other in OBSERVATIONS if _exact_quantities(other) == quantities]
        if "impulse" not in quantities:
            found[one.name] = errors[one.name]
        elif alike[0].name in found:
            found[one.name] = found[alike[0].name]
        else:
            error = _error(falls, exact, one, _TESTED, seed)
            upper = min(error.upper, *(errors[other.name].upper for other in alike))
            found[one.name] = error._replace(lower=min(error.lower, upper), upper=upper)
    return _bounded_by_less(found)


def _bounded_by_less(errors: dict[str, BayesError]) -> dict[str, BayesError]:
    """Return Bayes errors whose upper bounds are not above those of observations that contain less.

    A further quantity can be disregarded. The estimate does not do so: the more is measured, the
    fewer falls are as likely as the one tested.
    """
    found = {}
    for one in OBSERVATIONS:
        least = min(
            (errors[other.name] for other in OBSERVATIONS if _contains(one, other)),
            key=lambda error: error.upper,
        )
        own = errors[one.name]
        if least.upper < own.upper:
            own = own._replace(
                lower=min(own.lower, least.upper),
                upper=least.upper,
                standard_error=least.standard_error,
            )
        found[one.name] = own
    return found


def _contains(one: Observation, other: Observation) -> bool:
    """Return whether one observation contains what another does; an impulse at a known
    position contains that at an unknown one.
    """
    seen = {*one.quantities, "far impulse"} if "impulse" in one.quantities else {*one.quantities}
    return seen >= {*other.quantities}


def _exact_quantities(one: Observation) -> tuple[str, ...]:
    """Return the quantities of an observation with an exact amplitude, to which the
    position does not matter.
    """
    return tuple("impulse" if name == "far impulse" else name for name in one.quantities)


def _remaining(falls: Falls, channel: Channel, one: Observation) -> Floats:
    r"""Return the remaining standard deviations of the properties, :math:`\sqrt{1 -
    C_{py} (C_{yy} + N)^{-1} C_{yp} / C_{pp}}`.
    """
    values, noise = measurable(falls, channel)
    y = np.stack([values[name] for name in one.quantities])
    p = np.log(np.stack([getattr(falls, name) for name in PROPERTIES]))
    both = np.cov(np.concatenate([p, y]))
    number = len(p)
    inner = both[number:, number:] + np.diag([np.mean(noise[name] ** 2) for name in one.quantities])
    told = np.einsum(
        "pk,kp->p", both[:number, number:], np.linalg.solve(inner, both[number:, :number])
    )
    before = np.diagonal(both)[:number]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(
            np.where(before > 0.0, np.sqrt(np.clip(1.0 - told / before, 0.0, 1.0)), np.nan)
        )
