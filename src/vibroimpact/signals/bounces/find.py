"""Bounces found in a record, with their times and restitutions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import comb

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.errors import InputError
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.bounces.alignment import aligned
from vibroimpact.signals.bounces.chain import HIGHEST, LOWEST, longest_chain
from vibroimpact.signals.bounces.touches import FEWEST, WINDOW, Touches, find_touches, without_hum
from vibroimpact.signals.clipped import clipped_samples
from vibroimpact.signals.record import Record
from vibroimpact.signals.record_table import record_table

_CLEAR = 3.0
"""Rise, in thresholds, from which on a touch is as clear as can be."""

_JITTER = 2e-4
"""Standard deviation of the times at which touches are found, before they are aligned [s]."""

_SECOND_CONTACT = 6e-3
"""Time after a bounce in which a further touch is a second contact of it [s]."""

_OVERDRIVEN = 0.01
"""Part of clipped samples above which a record is refused."""

_CHANCE = 0.1
"""Expected number of such chains by chance from which on a chain is refused.

It is that among as many touches at random times.
"""

_BOUNCES_PER_OTHER = 3
"""Number of bounces that each other touch between them needs."""

_LEAST_SCATTER = 0.005
"""Least scatter of the logarithm of the restitution that counts for that."""

_NO_BOUNCE = "its time is not that of a bounce"


@dataclass(frozen=True)
class Bounces:
    """Bounces of a ball in a record.

    Parameters
    ----------
    record : Record
        The record.
    time : array, shape (n,)
        When the ball touches, n >= 3 [s].
    deviation : array, shape (n,)
        Standard deviations of these times, of differences between them, from noise and differences
        in sound [s].
    peak : array, shape (n,)
        The value of largest magnitude within 2 ms of each, in the unit of the record.
    others : array, shape (m,)
        Times of touches that are no bounces of this ball [s].
    reasons : tuple of str
        Why each of those is none.
    doubts : tuple of str
        Warnings, as sentences.
    contact : float, default 0
        Duration of the contacts, which is no part of the flights between the touches [s].

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> microphone = vi.signals.Record("microphone", np.zeros(48000), 48e3, "Pa")
    >>> time = np.array([0.0, 0.4, 0.72, 0.976])
    >>> heard = vi.signals.Bounces(microphone, time, np.full(4, 1e-5), np.ones(4), np.zeros(0), ())
    >>> heard.flight.round(3).tolist(), heard.restitution.round(3).tolist()
    ([0.4, 0.32, 0.256], [0.8, 0.8])
    """

    record: Record
    time: Floats
    deviation: Floats
    peak: Floats
    others: Floats
    reasons: tuple[str, ...]
    doubts: tuple[str, ...] = ()
    contact: float = 0.0

    @property
    def flight(self) -> Floats:
        """Durations of the flights, (n - 1,) [s]: times between touches, less that of a contact."""
        return np.diff(self.time) - self.contact

    @property
    def restitution(self) -> Floats:
        r"""Restitution of each impact but the first and the last, (n - 2,).

        It is the ratio :math:`e_n = T_n / T_{n-1}` of the flights after and before the impact.
        """
        return self.flight[1:] / self.flight[:-1]

    @property
    def by_time(self) -> Floats:
        """Derivatives of the restitutions with respect to the times, (n - 2, n) [1/s]."""
        slope = np.zeros((len(self.time) - 2, len(self.time)))
        row = np.arange(len(slope))
        before = self.flight[:-1]
        slope[row, row] = self.restitution / before
        slope[row, row + 1] = -(1.0 + self.restitution) / before
        slope[row, row + 2] = 1.0 / before
        return slope

    @property
    def covariance(self) -> Floats:
        """Covariance of the restitutions, (n - 2, n - 2): successive ones share two times."""
        noise = self.by_time * self.deviation
        return np.asarray(noise @ noise.T)


def find_bounces(record: Record, contact: float = 0.0) -> Bounces:
    """Return the bounces of a ball in a record of sound, of a vibration or of a force.

    Touches are sudden rises of the power above 500 Hz. Those are bounces whose intervals shrink by
    a factor that changes slowly; clicks, second contacts and other noises are told as others.
    Bounces that are too quiet at the end, and what comes before the first that is heard, may be
    missing. The times are refined by what the sounds have in common.

    Parameters
    ----------
    record : Record
        The record.
    contact : float, default 0
        Duration of the contacts [s], if it is known; without it restitutions are too large by
        :math:`1 - e` times the contact over the flight.

    Raises
    ------
    InputError
        If it contains no bounces, or they can't be identified: the message gives the reason.

    References
    ----------
    Bernstein, A. D. (1977). Listening to the coefficient of restitution. Am. J. Phys. 45, 41-44.

    Examples
    --------
    >>> time = np.arange(48000) / 48e3
    >>> def tap(at):
    ...     return np.where(
    ...         time >= at, np.exp(-(time - at).clip(0.0) / 1e-3) * np.sin(2e4 * (time - at)), 0.0
    ...     )
    >>> found = find_bounces(
    ...     Record(
    ...         "microphone", tap(0.1) + tap(0.4) + tap(0.43) + tap(0.55) + tap(0.625), 48e3, "Pa"
    ...     )
    ... )
    >>> found.restitution.round(4).tolist(), found.others.round(3).tolist()
    ([0.5, 0.5], [0.43])
    """
    record = without_baseline(record)
    doubts = _checked(record)
    value = without_hum(replace(record, value=record.value / np.abs(record.value).max()))
    touches = find_touches(value, record.rate, record.blur)
    touch_time = touches.sample / record.rate
    chain = _chain(touches, touch_time)
    others = np.setdiff1d(np.arange(len(touch_time)), chain)
    reasons = _reasons(touches, touch_time, chain, others)
    unexplained = touch_time[others[[reason == _NO_BOUNCE for reason in reasons]]]
    doubts += _chance_doubts(touch_time[chain], unexplained, record.duration)
    bounce_sample, deviation = aligned(
        value, record.rate, touches.sample[chain], record.blur, clipped_samples(record)
    )
    if not np.all(np.diff(bounce_sample) > max(contact * record.rate, 0.0)):
        within = "the contact" if contact else "their sounds"
        raise InputError(
            f"the last bounces follow each other within {within}; end the record sooner"
        )
    return Bounces(
        record=record,
        time=record.start + bounce_sample / record.rate,
        deviation=deviation / record.rate,
        peak=_peaks(record, touches.sample[chain]),
        others=record.start + touch_time[others],
        reasons=reasons,
        doubts=doubts,
        contact=contact,
    )


def _chain(touches: Touches, time: Floats) -> Indices:
    """Return which touches are bounces.

    Raises
    ------
    InputError
        If there are fewer than three, or none of them are in a chain.
    """
    clear_touches = np.flatnonzero(~touches.click)
    if len(clear_touches) < 3:
        touches_are = ("no touch is", "one touch is", "two touches are")[len(clear_touches)]
        raise InputError(
            f"{touches_are} detected in it, and a restitution needs three: two times of flight"
        )
    clearness = np.minimum(touches.rise[clear_touches] / touches.threshold, _CLEAR)
    chain = clear_touches[longest_chain(time[clear_touches], clearness, _JITTER)]
    if not len(chain):
        raise InputError(
            f"it holds no bounces: the times between {len(clear_touches)} touches do not decrease "
            f"as those of bounces do, by factors of {LOWEST:g} to {HIGHEST:g}"
        )
    return chain


def _peaks(record: Record, samples: Indices) -> Floats:
    """Return the value of largest magnitude in the window after each of some samples."""
    window = max(FEWEST, round(WINDOW * record.rate))
    sounds = [record.value[sample : sample + window] for sample in samples]
    return np.array([sound[np.argmax(np.abs(sound))] for sound in sounds])


def _checked(record: Record) -> tuple[str, ...]:
    """Return doubts about a record in which bounces are to be sought.

    Raises
    ------
    InputError
        If none can be found in it.
    """
    value = record.value
    if not len(value):
        raise InputError("it has no samples")
    if not np.isfinite(value).all():
        raise InputError("a sample is not a finite number")
    if value.min() == value.max():
        raise InputError("it is silent: all samples are the same")
    shortest = 3 * max(FEWEST, round(WINDOW * record.rate))
    if len(value) < shortest:
        raise InputError(
            f"it is too short: it has {len(value)} samples, and at {record.rate:g} Hz "
            f"three touches take {shortest} at least"
        )
    clipped_part = float(record_table([record], ["clipped_part"])["clipped_part"][0])
    if clipped_part > _OVERDRIVEN:
        raise InputError(
            f"it is clipped: {100.0 * clipped_part:.2g} % of its samples are at its largest or "
            "lowest value; record it at a lower gain"
        )
    if not clipped_part:
        return record.doubts
    doubt = (
        f"{100.0 * clipped_part:.2g} % of the samples are clipped, at the largest or the lowest "
        "value"
    )
    return (*record.doubts, doubt)


def _reasons(touches: Touches, time: Floats, chain: Indices, others: Indices) -> tuple[str, ...]:
    """Return why each of the other touches is no bounce."""
    last_bounce = np.clip(np.searchsorted(time[chain], time[others]) - 1, 0, None)
    since_bounce = time[others] - time[chain][last_bounce]
    reasons = []
    for touch, late in zip(others, since_bounce, strict=True):
        if touches.click[touch]:
            reasons.append("it is a click, of a few samples")
        elif 0.0 < late <= _SECOND_CONTACT:
            reasons.append("it is a second contact")
        else:
            reasons.append(_NO_BOUNCE)
    return tuple(reasons)


def _chance_doubts(chain: Floats, unexplained: Floats, duration: float) -> tuple[str, ...]:
    """Return doubts whether the times of a chain are those of bounces, and not of chance.

    Raises
    ------
    InputError
        If touches at random times, or those of music, would have such chains too.
    """
    if len(chain) == 3 and not len(unexplained):
        return ("the series has only three touches: they need not be bounces of one ball",)
    touch_count = len(chain) + len(unexplained)
    between = np.count_nonzero((unexplained > chain[0]) & (unexplained < chain[-1]))
    if len(chain) == 3:
        cause = "which three touches may have by chance; among other touches four are needed"
    elif _chains_by_chance(chain, touch_count, duration) > _CHANCE:
        cause = "as some of as many touches at random times would"
    elif _BOUNCES_PER_OTHER * between > len(chain):
        cause = "and too many lie between them"
    else:
        return ()
    raise InputError(
        f"it holds no series of bounces: of its {touch_count} touches {len(chain)} at best have "
        f"intervals that shrink as those of bounces, {cause}"
    )


def _chains_by_chance(chain: Floats, touch_count: int, duration: float) -> float:
    """Return how many chains as regular as one are expected among touches at random times.

    Any three touches begin a chain; each further one must lie where the restitution, with the
    scatter that its logarithm has in this chain, leads.
    """
    interval = np.diff(chain)
    change = np.diff(np.log(interval[1:] / interval[:-1]))
    scatter = float(np.hypot(np.sqrt(np.mean(change**2)), _LEAST_SCATTER))
    # in a span of two standard deviations to either side, by the mean rate of touches: a Poisson
    # process has at least one there with the probability 1 - exp(-rate span)
    hit = -np.expm1(-touch_count / duration * 4.0 * scatter * interval[2:])
    return comb(touch_count, 3) * float(np.prod(hit))
