"""Impacts heard in a record: speeds, restitutions and their fit over the speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.bounces.speed_laws import SpeedLaw, speed_laws
from vibroimpact.calibration.fitting import half_width
from vibroimpact.dynamics.problem import STANDARD_GRAVITY
from vibroimpact.errors import InputError
from vibroimpact.signals.bounces.find import Bounces

_UNLIKE = 1.25  # ratio of the first restitution to the second one above which a doubt is raised


@dataclass(frozen=True)
class Rebounds:
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
        Speeds before and after [m/s]; NaN where no flight tells them: before the first touch without the height, and after the last.
    restitution, deviation : array, shape (n,)
        Separation speed over approach speed and its standard deviation; NaN as these.
    laws : list of SpeedLaw
        Fits of the restitution over the approach speed.
    drop_height : float
        Height through which the ball fell before the first touch, with the mean restitution at it [m]; the given one, if it is.
    drop_deviation : float
        Standard deviation of that; 0 if it is given.
    confidence : float
        Confidence level of intervals.
    doubts : tuple of str
        Warnings, as sentences.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> microphone = vi.Record("microphone", np.zeros(48000), 48e3, "Pa")
    >>> heard = vi.Bounces(microphone, np.array([0.0, 0.4, 0.72, 0.976]), np.full(4, 1e-5), np.ones(4), np.zeros(0), ())
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

    @property
    def intervals(self) -> Floats:
        """Confidence intervals of the restitutions, (n, 2)."""
        half = half_width(self.confidence, np.inf) * self.deviation
        return np.stack([self.restitution - half, self.restitution + half], axis=1)


def rebounds_of(bounces: Bounces, *, gravity: float = STANDARD_GRAVITY, height: float | None = None, confidence: float = 0.95) -> Rebounds:
    r"""Return speeds and restitutions of the impacts of a bouncing ball.

    A ball that flies for a time T in vacuum leaves and comes back at :math:`g T / 2`; restitutions do not depend on g.

    Parameters
    ----------
    bounces : Bounces
        The touches, as `find_bounces` returns them.
    gravity : float, default 9.80665
        Acceleration of gravity along the flights [m/s^2].
    height : float, optional
        Height through which the ball fell before the first touch that is heard [m], for the restitution of that impact.
    confidence : float, default 0.95
        Confidence level of intervals.

    Raises
    ------
    InputError
        If gravity or height are not above 0, or the ball rebounds from the first touch higher than it fell.

    Examples
    --------
    >>> from vibroimpact.signals.record import Record
    >>> touches = np.array([0.0, 0.4, 0.72, 0.976])
    >>> heard = Bounces(Record("microphone", np.zeros(48000), 48e3, "Pa"), touches, np.full(4, 1e-5), np.ones(4), np.zeros(0), ())
    >>> found = rebounds_of(heard, gravity=9.81)
    >>> found.approach_speed.round(3).tolist(), found.restitution.round(3).tolist(), round(found.drop_height, 3)
    ([nan, 1.962, 1.57, 1.256], [nan, 0.8, 0.8, nan], 0.307)
    """
    for name, value, unit in (("gravity", gravity, "m/s^2"), ("height", height, "m")):
        if value is not None and not 0.0 < value < np.inf:
            raise InputError(f"the {name} is {value:g} {unit}; it must be above 0")
    flown = 0.5 * gravity * bounces.flight
    approach, separation = np.append(np.nan, flown), np.append(flown, np.nan)
    slope, doubts = bounces.by_time, list(bounces.doubts)
    inner = np.arange(1, len(flown))
    if height is not None:
        approach[0] = np.sqrt(2.0 * gravity * height)
        first = np.zeros(len(bounces.time))
        first[:2] = np.array([-0.5, 0.5]) * gravity / approach[0]
        slope, inner = np.vstack([first, slope]), np.arange(len(flown))
    restitution = separation / approach
    noise = slope * bounces.deviation
    covariance = noise @ noise.T
    deviation = np.full(len(restitution), np.nan)
    deviation[inner] = np.sqrt(np.diag(covariance))
    if height is not None:
        if restitution[0] > 1.0 + 3.0 * deviation[0]:
            risen = 0.5 * flown[0] ** 2 / gravity
            words = f"after the first touch the ball rises by {risen:.4g} m, more than the height of {height:g} m from which it fell"
            raise InputError(f"{words}; look at its unit, and whether the first touch is that of the fall")
        if abs(np.log(restitution[0] / restitution[1])) > np.log(_UNLIKE):
            words = f"the height gives the first touch a restitution of {restitution[0]:.3g}, and the next one has {restitution[1]:.3g}"
            doubts.append(f"{words}: it may not be the first impact of the fall, and is left out of the fits")
            inner, covariance = inner[1:], covariance[1:, 1:]
    laws = speed_laws(approach[inner], restitution[inner], covariance)
    mean, spread = float(laws[0].coefficients[0]), float(np.sqrt(laws[0].covariance[0, 0]))
    fallen = 0.5 * (flown[0] / mean) ** 2 / gravity
    drop = (fallen, 2.0 * fallen * spread / mean) if height is None else (height, 0.0)
    return Rebounds(
        bounces,
        gravity,
        height,
        approach,
        separation,
        restitution,
        deviation,
        laws,
        float(drop[0]),
        float(drop[1]),
        confidence,
        tuple(doubts),
    )
