"""The bound of a population: the Bayes error for what may be measured of a fall.

It is computed beside what the same tells of the rock.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bayes_error.error_estimate import BayesError, bayes_error
from vibroimpact.bayes_error.falls import Falls, falls_of_study, falls_of_sweep
from vibroimpact.bayes_error.observations import OBSERVATIONS, Channel, Observation, measurable
from vibroimpact.errors import InputError
from vibroimpact.report.reported import Reported
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.sweep import Sweep

BANDWIDTHS = np.array([1e3, 2e3, 4e3, 8e3, 16e3, 32e3])
"""Bandwidths over which the error from one impact is mapped [Hz]."""

SIGNAL_TO_NOISE = np.array([0.0, 10.0, 20.0, 30.0, 40.0, 60.0])
"""Ratios of signal to noise over which it is mapped [dB]."""

PROPERTIES = ("radius", "density", "modulus", "speed")
"""What a bound says of the rock, besides its class."""

_BY_NAME = {observation.name: observation for observation in OBSERVATIONS}
_MAPPED = _BY_NAME["one impact"]
_TESTED = 2000  # falls whose posterior is computed
_TESTED_OF_MAP = 500
_FALLS_OF_MAP = 8000


@dataclass(frozen=True, eq=False)
class Bound(Reported, reported_in="vibroimpact.bayes_error.report"):
    """Lowest error of any classifier (Bayes error) for a population.

    It is the lowest error of a classifier that sees only the measured quantities, with the stated
    scatter.

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
    >>> bound = vi.bayes_error.bound_of(vi.studies.load_sweep("signals:coal-gangue", samples=100))
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
    """Return the Bayes error of a population for sets of measured quantities.

    It is the lowest error of a classifier that sees only these. A sensor hears the contact force
    through the plate, a linear system that is the same whatever falls. What it records of an impact
    therefore tells no more of the rock than the force itself. Of the force impulse and duration are
    counted. A signal contains more, the shape of the pulse, the position of the impact and further
    impacts; a classifier that uses it can have a lower error.

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
    >>> bound = bound_of(vi.studies.load_sweep("signals:coal-gangue", 1000))
    >>> bound.errors["contact time"].upper > 5 * bound.errors["one impact"].upper
    True
    """
    if isinstance(population, Study):
        falls = falls_of_study(population)
    else:
        falls = falls_of_sweep(population)
    names, counts = np.unique(falls.classes, return_counts=True)
    if len(names) < 2:
        raise InputError(
            "fewer than two classes have falls that were computed and touched the plate, so "
            "that there is nothing to classify"
        )
    channel = channel or Channel()
    steps = len(OBSERVATIONS) + BANDWIDTHS.size * SIGNAL_TO_NOISE.size + 1
    done = 0

    def count_step() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done / steps)

    errors = {}
    remaining = {}
    for observation in OBSERVATIONS:
        errors[observation.name] = _error(falls, channel, observation, _TESTED, seed)
        remaining[observation.name] = _remaining(falls, channel, observation)
        count_step()
    errors = _bounded_by_less(errors)
    error_map = _error_map(falls, channel, seed, count_step)
    without_scatter = _without_scatter(falls, channel, errors, seed)
    count_step()
    return Bound(
        name=population.name,
        falls=falls,
        channel=channel,
        errors=errors,
        majority=1.0 - counts.max() / counts.sum(),
        remaining=remaining,
        map=error_map,
        without_scatter=without_scatter,
        on_rigid_plate=not isinstance(population, Study),
    )


def _error_map(falls: Falls, channel: Channel, seed: int, count_step: Callable[[], None]) -> Floats:
    """Return the upper bounds of the error from one impact, (bandwidths, ratios).

    `count_step` is called after each.
    """
    falls = _first_falls(falls, _FALLS_OF_MAP)
    upper = np.empty((BANDWIDTHS.size, SIGNAL_TO_NOISE.size))
    for row, bandwidth in enumerate(BANDWIDTHS):
        for column, ratio in enumerate(SIGNAL_TO_NOISE):
            mapped = replace(channel, bandwidth=float(bandwidth), signal_to_noise=float(ratio))
            upper[row, column] = _error(falls, mapped, _MAPPED, _TESTED_OF_MAP, seed).upper
            count_step()
    return upper


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
    >>> least_error(falls_of_sweep(vi.studies.load_sweep("signals:coal-gangue", 2000))) < 0.01
    True
    """
    # the scatter of the time to the next impact is the default
    channel = Channel(bandwidth=50e3, signal_to_noise=80.0, gain=0.001)
    return _error(falls, channel, _BY_NAME["with the bounce"], _TESTED, seed).lower


def _first_falls(falls: Falls, number: int) -> Falls:
    columns = {field.name: getattr(falls, field.name)[:number] for field in fields(falls)}
    return Falls(**columns)


def _error(
    falls: Falls, channel: Channel, observation: Observation, tested: int, seed: int
) -> BayesError:
    """Return the Bayes error for what is measured in one observation."""
    values, noise = measurable(falls, channel)
    classes = np.unique(falls.classes, return_inverse=True)[1]
    measured = np.stack([values[name] for name in observation.quantities], axis=1)
    deviation = np.stack([noise[name] for name in observation.quantities], axis=1)
    return bayes_error(measured, deviation, classes, falls.rocks, tested, seed)


def _without_scatter(
    falls: Falls, channel: Channel, errors: dict[str, BayesError], seed: int
) -> dict[str, BayesError]:
    """Return the Bayes errors without scatter of the amplitude.

    They are not larger than those with it.
    """
    exact = replace(channel, gain=0.0, place=0.0)
    exact_errors: dict[str, BayesError] = {}
    for observation in OBSERVATIONS:
        quantities = _exact_quantities(observation)
        # with a known position and with an unknown one
        equivalent = [other for other in OBSERVATIONS if _exact_quantities(other) == quantities]
        if "impulse" not in quantities:
            error = errors[observation.name]
        elif equivalent[0].name in exact_errors:
            error = exact_errors[equivalent[0].name]
        else:
            error = _error(falls, exact, observation, _TESTED, seed)
            upper = min(error.upper, *(errors[other.name].upper for other in equivalent))
            error = error._replace(lower=min(error.lower, upper), upper=upper)
        exact_errors[observation.name] = error
    return _bounded_by_less(exact_errors)


def _bounded_by_less(errors: dict[str, BayesError]) -> dict[str, BayesError]:
    """Return Bayes errors whose upper bounds are not above those of observations that contain less.

    A further quantity can be disregarded. The estimate does not do so: the more is measured, the
    fewer falls are as likely as the one tested.
    """
    bounded = {}
    for observation in OBSERVATIONS:
        contained = [errors[other.name] for other in OBSERVATIONS if _contains(observation, other)]
        least = min(contained, key=lambda error: error.upper)
        error = errors[observation.name]
        if least.upper < error.upper:
            error = error._replace(
                lower=min(error.lower, least.upper),
                upper=least.upper,
                standard_error=least.standard_error,
            )
        bounded[observation.name] = error
    return bounded


def _contains(observation: Observation, other: Observation) -> bool:
    """Return whether one observation contains what another does.

    An impulse at a known position contains that at an unknown one.
    """
    quantities = set(observation.quantities)
    if "impulse" in quantities:
        quantities.add("far impulse")
    return quantities >= set(other.quantities)


def _exact_quantities(observation: Observation) -> tuple[str, ...]:
    """Return the quantities of an observation with an exact amplitude.

    The position does not matter to it.
    """
    same_as = {"far impulse": "impulse"}
    return tuple(same_as.get(name, name) for name in observation.quantities)


def _remaining(falls: Falls, channel: Channel, observation: Observation) -> Floats:
    r"""Return the remaining standard deviations of the properties, relative to those before.

    They are :math:`\sqrt{1 - C_{py} (C_{yy} + N)^{-1} C_{yp} / C_{pp}}`, of the properties p and
    what is measured, y, with noise of the variance N.
    """
    values, noise = measurable(falls, channel)
    measured = np.stack([values[name] for name in observation.quantities])
    properties = np.log(np.stack([getattr(falls, name) for name in PROPERTIES]))
    covariance = np.cov(np.concatenate([properties, measured]))
    count = len(properties)
    noise_variance = [np.mean(noise[name] ** 2) for name in observation.quantities]
    noisy_covariance = covariance[count:, count:] + np.diag(noise_variance)
    with_measured = covariance[:count, count:]
    coefficients = np.linalg.solve(noisy_covariance, covariance[count:, :count])
    explained = np.einsum("pk,kp->p", with_measured, coefficients)
    variance = np.diagonal(covariance)[:count]
    with np.errstate(invalid="ignore", divide="ignore"):
        remaining = np.sqrt(np.clip(1.0 - explained / variance, 0.0, 1.0))
    return np.asarray(np.where(variance > 0.0, remaining, np.nan))
