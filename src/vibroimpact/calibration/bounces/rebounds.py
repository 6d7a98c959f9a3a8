"""Impacts heard in a record: speeds, restitutions and their fit over the speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.bounces.speed_laws import SpeedLaw, speed_laws
from vibroimpact.calibration.fitting import half_width
from vibroimpact.calibration.inputs import EARTH, Input, as_input, guessed_doubt
from vibroimpact.errors import InputError
from vibroimpact.report.reported import Reported
from vibroimpact.signals.bounces.find import Bounces

_UNLIKE = 1.25  # ratio of the first restitution to the second one above which a doubt is raised


@dataclass(frozen=True)
class Rebounds(Reported, reported_in="vibroimpact.calibration.bounces.report"):
    """The impacts of a bouncing ball in a record, n touches, in vacuum.

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
    >>> microphone = vi.Record("microphone", np.zeros(48000), 48e3, "Pa")
    >>> heard = vi.Bounces(
    ...     microphone,
    ...     np.array([0.0, 0.4, 0.72, 0.976]),
    ...     np.full(4, 1e-5),
    ...     np.ones(4),
    ...     np.zeros(0),
    ...     (),
    ... )
    >>> found = vi.rebounds_of(heard, gravity=9.81, height=0.3)
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
    >>> touches = np.array([0.0, 0.4, 0.72, 0.976])
    >>> heard = Bounces(
    ...     Record("microphone", np.zeros(48000), 48e3, "Pa"),
    ...     touches,
    ...     np.full(4, 1e-5),
    ...     np.ones(4),
    ...     np.zeros(0),
    ...     (),
    ... )
    >>> found = rebounds_of(heard, gravity=9.81)
    >>> (
    ...     found.approach_speed.round(3).tolist(),
    ...     found.restitution.round(3).tolist(),
    ...     round(found.drop_height, 3),
    ... )
    ([nan, 1.962, 1.57, 1.256], [nan, 0.8, 0.8, nan], 0.307)
    >>> found = rebounds_of(heard, gravity=9.81, height="0.3 m +- 5 mm")
    >>> found.restitution[:2].round(3).tolist(), found.deviation[:2].round(5).tolist()
    ([0.809, 0.8], [0.00674, 6e-05])
    """
    pull = as_input("gravity", EARTH if gravity is None else gravity, "m/s^2")
    fall = None if height is None else as_input("height", height, "m")
    lasting = as_input("contact time", bounces.contact, "s")
    for name, value, unit in (
        ("gravity", pull.value, "m/s^2"),
        ("height", None if fall is None else fall.value, "m"),
    ):
        if value is not None and not 0.0 < value < np.inf:
            raise InputError(f"the {name} is {value:g} {unit}; it must be above 0 and finite")
    g = float(pull.value)
    flown = 0.5 * g * bounces.flight
    approach, separation = np.append(np.nan, flown), np.append(flown, np.nan)
    slope, doubts = bounces.by_time, list(bounces.doubts)
    inner = np.arange(1, len(flown))
    if fall is not None:
        approach[0] = np.sqrt(2.0 * g * fall.value)
        first = np.zeros(len(bounces.time))
        first[:2] = np.array([-0.5, 0.5]) * g / approach[0]
        slope, inner = np.vstack([first, slope]), np.arange(len(flown))
    restitution = separation / approach
    of_approach, of_separation = _shared(pull, fall, lasting, approach, separation)
    of_restitution = restitution * (of_separation / separation - of_approach / approach)
    noise = slope * bounces.deviation
    covariance = noise @ noise.T
    deviation = np.full(len(restitution), np.nan)
    deviation[inner] = np.sqrt(np.diag(covariance) + np.sum(of_restitution[:, inner] ** 2, axis=0))
    by_times = 0.5 * g * np.hypot(bounces.deviation[1:], bounces.deviation[:-1])
    arrives, leaves = (np.sqrt(np.sum(part**2, axis=0)) for part in (of_approach, of_separation))
    if fall is not None:
        if restitution[0] > 1.0 + 3.0 * deviation[0]:
            risen = 0.5 * flown[0] ** 2 / g
            words = (
                f"after the first touch the ball rises by {risen:.4g} m, more than the height "
                f"of {fall.value:g} m from which it fell"
            )
            raise InputError(
                f"{words}; look at height and gravity and their units, and whether the "
                "first touch is that of the fall"
            )
        if abs(np.log(restitution[0] / restitution[1])) > np.log(_UNLIKE):
            words = (
                f"the height gives the first touch a restitution of {restitution[0]:.3g}, and "
                f"the next one has {restitution[1]:.3g}"
            )
            doubts.append(
                f"{words}: the height may be wrong, or it is not the first impact of the "
                "fall; it is left out of the fits"
            )
            inner, covariance = inner[1:], covariance[1:, 1:]
        if (
            not fall.value.stated
            and fall.value.deviation**2 * (0.5 * restitution[0] / fall.value) ** 2
            > 0.5 * deviation[0] ** 2
        ):
            doubts.append(guessed_doubt(fall, "impact 1"))
    shared = np.stack([of_restitution, of_approach], axis=1)[:, :, inner]
    laws = speed_laws(approach[inner], restitution[inner], covariance, shared=shared)
    mean, spread = float(laws[0].coefficients[0]), float(np.sqrt(laws[0].covariance[0, 0]))
    fallen = 0.5 * (flown[0] / mean) ** 2 / g
    leaving = np.hypot(2.0 * spread / mean, pull.value.deviation / g)
    drop = (fallen, fallen * leaving) if fall is None else (fall.value, fall.value.deviation)
    return Rebounds(
        bounces,
        g,
        None if fall is None else float(fall.value),
        approach,
        separation,
        restitution,
        deviation,
        laws,
        float(drop[0]),
        float(drop[1]),
        confidence,
        tuple(doubts),
        np.append(arrives[0], np.hypot(arrives[1:], by_times)),
        np.append(np.hypot(leaves[:-1], by_times), np.nan),
        tuple(
            one
            for one in (pull, fall, lasting)
            if one is not None and (one is not lasting or one.value or one.value.deviation)
        ),
    )


def _shared(
    pull: Input, fall: Input | None, lasting: Input, approach: Floats, separation: Floats
) -> tuple[Floats, Floats]:
    """Return what one standard deviation of gravity, height and contact time changes in
    the speeds before and after, (3, n) [m/s].
    """
    first = np.zeros(len(approach))
    first[0] = approach[0] if fall is not None else 0.0
    later = np.append(0.0, approach[1:])
    g, height = pull.value, 0.0 if fall is None else fall.value.deviation / fall.value
    shorter = -0.5 * g * lasting.value.deviation
    before = [
        (later + 0.5 * first) * pull.value.deviation / g,
        0.5 * height * first,
        np.append(0.0, np.full(len(later) - 1, shorter)),
    ]
    after = [separation * pull.value.deviation / g, 0.0 * separation, shorter + 0.0 * separation]
    return np.array(before), np.array(after)
