"""Impacts heard in a record: speeds, restitutions and their fit over the speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.bounces.speed_laws import SpeedLaw, speed_laws
from vibroimpact.calibration.fit.fitting import half_width
from vibroimpact.calibration.observed.inputs import EARTH, Input, as_input, guessed_doubt
from vibroimpact.errors import InputError
from vibroimpact.report.reported import Reported
from vibroimpact.signals.bounces.find import Bounces

_UNLIKE = 1.25
"""Ratio of the first restitution to the second one, or its inverse, above which a doubt is raised.
"""

_CONTACT_POWER = 0.2 / np.sqrt(3.0)
"""Standard deviation of the power of the speed with which the contact time falls: anywhere from 0,
of a linear spring, to 1/5, of Hertz's contact.
"""


@dataclass(frozen=True)
class Rebounds(Reported, reported_in="vibroimpact.calibration.bounces.report"):
    """Impacts of a bouncing ball from the n touches in a record, in a vacuum.

    Parameters
    ----------
    bounces : Bounces
        The touches.
    gravity : float
        Acceleration of gravity [m/s^2].
    height : float or None
        Height through which the ball fell before the first touch [m], if it is given.
    approach_speed, separation_speed : array, shape (n,)
        Speeds before and after [m/s]; NaN where no flight tells them: before the first touch
        without the height, and after the last.
    restitution, deviation : array, shape (n,)
        Separation speed over approach speed and its standard deviation, from the times and the
        inputs; NaN as these.
    laws : list of SpeedLaw
        Fits of the restitution over the approach speed.
    drop_height : float
        Height through which the ball fell before the first touch, with the mean restitution at it
        [m]; the given one, if it is.
    drop_deviation : float
        Standard deviation of that; 0 if it is given.
    confidence : float
        Confidence level of intervals.
    doubts : tuple of str
        Warnings, as sentences.
    approach_deviation, separation_deviation : array, shape (n,)
        Standard deviations of the speeds [m/s]; NaN as these.
    inputs : tuple of Input
        Gravity, and the height and the contact time where they are given, with the standard
        deviations that are part of those above.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> microphone = vi.signals.Record("microphone", np.zeros(48000), 48e3, "Pa")
    >>> time = np.array([0.0, 0.4, 0.72, 0.976])
    >>> heard = vi.signals.Bounces(microphone, time, np.full(4, 1e-5), np.ones(4), np.zeros(0), ())
    >>> found = vi.calibration.rebounds_of(heard, gravity=9.81, height=0.3)
    >>> found.approach_speed.round(2).tolist(), found.intervals.shape
    ([2.43, 1.96, 1.57, 1.26], (4, 2))
    """

    bounces: Bounces
    gravity: float
    height: float | None
    approach_speed: Floats
    separation_speed: Floats
    restitution: Floats
    deviation: Floats
    laws: list[SpeedLaw]
    drop_height: float
    drop_deviation: float
    confidence: float
    doubts: tuple[str, ...]
    approach_deviation: Floats
    separation_deviation: Floats
    inputs: tuple[Input, ...]

    @property
    def intervals(self) -> Floats:
        """Confidence intervals of the restitutions, (n, 2)."""
        half = half_width(self.confidence, np.inf) * self.deviation
        return np.stack([self.restitution - half, self.restitution + half], axis=1)


def rebounds_of(
    bounces: Bounces,
    *,
    gravity: float | str | None = None,
    height: float | str | None = None,
    confidence: float = 0.95,
) -> Rebounds:
    r"""Return speeds and restitutions of the impacts of a bouncing ball.

    A ball that flies for a time T in vacuum leaves and comes back at :math:`g T / 2`; restitutions
    do not depend on g.

    Parameters
    ----------
    bounces : Bounces
        The touches, as `find_bounces` returns them.
    gravity : float or str, optional
        Acceleration of gravity along the flights [m/s^2]; by default 9.80665 m/s^2, with a standard
        deviation of 0.015 m/s^2, as it varies over the Earth. A number is exact; a text has the
        standard deviation that is given, "9.81 m/s^2 +- 0.005 m/s^2", or else may lie anywhere
        within half a unit of its last digit.
    height : float or str, optional
        Height through which the ball fell before the first touch that is heard [m], for the
        restitution of that impact; likewise.
    confidence : float, default 0.95
        Confidence level of intervals.

    Raises
    ------
    InputError
        If gravity or height are not above 0, or the ball rebounds from the first touch higher than
        it fell.

    Examples
    --------
    >>> from vibroimpact.signals.record import Record
    >>> microphone = Record("microphone", np.zeros(48000), 48e3, "Pa")
    >>> time = np.array([0.0, 0.4, 0.72, 0.976])
    >>> heard = Bounces(microphone, time, np.full(4, 1e-5), np.ones(4), np.zeros(0), ())
    >>> rebounds = rebounds_of(heard, gravity=9.81)
    >>> (
    ...     rebounds.approach_speed.round(3).tolist(),
    ...     rebounds.restitution.round(3).tolist(),
    ...     round(rebounds.drop_height, 3),
    ... )
    ([nan, 1.962, 1.57, 1.256], [nan, 0.8, 0.8, nan], 0.307)
    >>> rebounds = rebounds_of(heard, gravity=9.81, height="0.3 m +- 5 mm")
    >>> rebounds.restitution[:2].round(3).tolist(), rebounds.deviation[:2].round(5).tolist()
    ([0.809, 0.8], [0.00674, 6e-05])
    """
    if gravity is None:
        gravity = EARTH
    gravity_input = as_input("gravity", gravity, "m/s^2")
    height_input = None
    height_value = None
    if height is not None:
        height_input = as_input("height", height, "m")
        height_value = float(height_input.value)
    contact_time = as_input("contact time", bounces.contact, "s")
    _check_positive(gravity_input)
    if height_input is not None:
        _check_positive(height_input)
    g = float(gravity_input.value)
    flight_speed = 0.5 * g * bounces.flight
    approach = np.append(np.nan, flight_speed)
    separation = np.append(flight_speed, np.nan)
    # derivatives by the times of the touches of the restitutions of the impacts `known`
    by_time = bounces.by_time
    known = np.arange(1, len(flight_speed))
    if height_input is not None:
        approach[0] = np.sqrt(2.0 * g * height_input.value)
        # of the first impact, e = g (t_1 - t_0) / (2 v)
        first_by_time = np.zeros(len(bounces.time))
        first_by_time[:2] = np.array([-0.5, 0.5]) * g / approach[0]
        by_time = np.vstack([first_by_time, by_time])
        known = np.arange(len(flight_speed))
    restitution = separation / approach
    of_approach, of_separation = _input_effects(
        gravity_input, height_input, contact_time, approach, separation
    )
    # an input that changes both speeds alike, as gravity in flights, leaves their ratio
    of_restitution = restitution * (of_separation / separation - of_approach / approach)
    # successive restitutions share touches: their errors by times are correlated
    noise = by_time * bounces.deviation
    covariance = noise @ noise.T
    variance_by_inputs = np.sum(of_restitution[:, known] ** 2, axis=0)
    deviation = np.full(len(restitution), np.nan)
    deviation[known] = np.sqrt(np.diag(covariance) + variance_by_inputs)
    doubts = list(bounces.doubts)
    fitted = known
    if height_input is not None:
        _check_first_rise(flight_speed[0], g, restitution[0], deviation[0], height_input)
        if abs(np.log(restitution[0] / restitution[1])) > np.log(_UNLIKE):
            doubts.append(
                f"the height gives the first touch a restitution of {restitution[0]:.3g}, and "
                f"the next one has {restitution[1]:.3g}: the height may be wrong, or it is not "
                "the first impact of the fall; it is left out of the fits"
            )
            fitted = known[1:]
            covariance = covariance[1:, 1:]
        if _mostly_of_guess(height_input, restitution[0], deviation[0]):
            doubts.append(guessed_doubt(height_input, "impact 1"))
    shared = np.stack([of_restitution, of_approach], axis=1)[:, :, fitted]
    laws = speed_laws(approach[fitted], restitution[fitted], covariance, shared=shared)
    drop_height, drop_deviation = _drop_height(
        flight_speed[0], gravity_input, height_input, mean_restitution=laws[0]
    )
    # of a flight, g T / 2, by both of its touches
    by_times = 0.5 * g * np.hypot(bounces.deviation[1:], bounces.deviation[:-1])
    approach_by_inputs = np.sqrt(np.sum(of_approach**2, axis=0))
    separation_by_inputs = np.sqrt(np.sum(of_separation**2, axis=0))
    inputs = [gravity_input]
    if height_input is not None:
        inputs.append(height_input)
    if contact_time.value or contact_time.value.deviation:
        inputs.append(contact_time)
    return Rebounds(
        bounces=bounces,
        gravity=g,
        height=height_value,
        approach_speed=approach,
        separation_speed=separation,
        restitution=restitution,
        deviation=deviation,
        laws=laws,
        drop_height=drop_height,
        drop_deviation=drop_deviation,
        confidence=confidence,
        doubts=tuple(doubts),
        approach_deviation=np.append(
            approach_by_inputs[0], np.hypot(approach_by_inputs[1:], by_times)
        ),
        separation_deviation=np.append(np.hypot(separation_by_inputs[:-1], by_times), np.nan),
        inputs=tuple(inputs),
    )


def _check_positive(quantity: Input) -> None:
    if not 0.0 < quantity.value < np.inf:
        raise InputError(
            f"the {quantity.name} is {quantity.value:g} {quantity.unit}; it must be above 0 and "
            "finite"
        )


def _check_first_rise(
    speed: float, gravity: float, restitution: float, deviation: float, height: Input
) -> None:
    """Check that the ball does not rise higher from the first touch than it fell.

    `speed` is that after the first touch [m/s].
    """
    if restitution > 1.0 + 3.0 * deviation:
        rise = 0.5 * speed**2 / gravity
        raise InputError(
            f"after the first touch the ball rises by {rise:.4g} m, more than the height "
            f"of {height.value:g} m from which it fell; look at height and gravity and their "
            "units, and whether the first touch is that of the fall"
        )


def _mostly_of_guess(height: Input, restitution: float, deviation: float) -> bool:
    """Return whether most of the variance of the first restitution is that of the height.

    False if the standard deviation of the height was given.
    """
    if height.value.stated:
        return False
    # the restitution is proportional to the height to the power -1/2
    by_height = height.value.deviation**2 * (0.5 * restitution / height.value) ** 2
    return bool(by_height > 0.5 * deviation**2)


def _drop_height(
    speed: float, gravity: Input, height: Input | None, *, mean_restitution: SpeedLaw
) -> tuple[float, float]:
    """Return the height of the fall before the first touch and its standard deviation [m].

    Where it is not given, it follows from the speed after the first touch [m/s] and the mean
    restitution.
    """
    if height is not None:
        return float(height.value), float(height.value.deviation)
    mean = float(mean_restitution.coefficients[0])
    spread = float(np.sqrt(mean_restitution.covariance[0, 0]))
    # the speed is proportional to gravity, so that the height is, too
    drop_height = 0.5 * (speed / mean) ** 2 / float(gravity.value)
    relative_deviation = np.hypot(
        2.0 * spread / mean, gravity.value.deviation / float(gravity.value)
    )
    return float(drop_height), float(drop_height * relative_deviation)


def _input_effects(
    gravity: Input,
    height: Input | None,
    contact_time: Input,
    approach: Floats,
    separation: Floats,
) -> tuple[Floats, Floats]:
    """Return what one standard deviation of each input changes in the speeds, (4, n) [m/s].

    The inputs are gravity, height, contact time and how that goes with the speed; the speeds are
    those before and after.
    """
    # the first speed is that after the fall, sqrt(2 g h); the others are those of flights, g T / 2
    after_fall = np.zeros(len(approach))
    relative_height_deviation = 0.0
    if height is not None:
        after_fall[0] = approach[0]
        relative_height_deviation = height.value.deviation / height.value
    after_flight = np.append(0.0, approach[1:])
    g = gravity.value
    # a longer contact leaves less time for the flight
    by_contact = np.full(len(separation), -0.5 * g * contact_time.value.deviation)
    # the contact of each impact differs from the one that is given for all
    longest = float(np.hypot(contact_time.value, contact_time.value.deviation))
    logarithm = np.log(separation[:-1])
    part = _CONTACT_POWER * np.append(logarithm - logarithm.mean(), np.nan)
    by_power = -0.5 * g * longest * part
    of_approach = [
        (after_flight + 0.5 * after_fall) * gravity.value.deviation / g,
        0.5 * relative_height_deviation * after_fall,
        np.append(0.0, by_contact[:-1]),
        np.append(0.0, by_power[:-1]),
    ]
    of_separation = [
        separation * gravity.value.deviation / g,
        0.0 * separation,
        by_contact,
        by_power,
    ]
    return np.array(of_approach), np.array(of_separation)
