"""The outputs of a measuring chain over the history of one drop, at a constant rate."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS, REACH, kernel
from vibroimpact.dynamics.sensors.filtered_chain import FilteredChain, filter_gains, filtered_chain
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain
from vibroimpact.dynamics.sensors.pole_pairs import PolePairs
from vibroimpact.dynamics.sensors.pulses import force_derivatives, pulses
from vibroimpact.dynamics.sensors.rest_chain import rest_chain, rest_pulses
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment

_BLOCK, _ROWS = 512, 128
"""Samples for which propagators are kept, the next block starting from where the last one ended; and blocks done at once, at most."""
_KEPT = 2000
"""Oscillators, at most, whose propagators are kept for the next drop on the same plate: 16 MB."""
_NEGLIGIBLE = 1e-20
"""Of the fastest mode: what moves less is left out."""
_WORTH = 0.9
"""Of the oscillators: leaving out fewer than a tenth takes longer than it saves."""
_BAND = 0.6
"""Of the rate: what the filter of a converter lets pass ends below it."""


@dataclass
class _Span:
    """A part of the history that is followed at once: where its oscillators are at its start, (2, n), and the impulses within it.

    Over the part in which a sphere lies on the plate the oscillators go on with it, as `lying` says.
    """

    start: float
    end: float
    place: Floats
    times: list[Floats] = field(default_factory=list)
    impulses: list[Floats] = field(default_factory=list)
    rest: RestMotion | None = None


def follow_filtered(filtered: FilteredChain, segments: Sequence[VibratingSegment], count: int, levels: Floats | None = None) -> Floats:
    """Return the outputs of a chain under a converter's filter, (S, count).

    Parameters
    ----------
    filtered : FilteredChain
        The chain.
    segments : sequence of VibratingSegment
        The history of one drop.
    count : int
        How many samples there are, from the start on.
    levels : array, shape (S,), optional
        Free vibration that stays below these magnitudes for good need not be followed: it is left zero.
    """
    rate, values = filtered.rate, np.zeros((len(filtered.outputs[0]), count))
    blocks = _blocks(filtered.chain.of, filtered.outputs, rate)
    for span in _spans(filtered.chain, segments, rate):
        if span.rest is not None:
            _lie(filtered, span.rest, span, values, levels)
            break
        first, last = _samples(span.start, rate), _samples(span.end, rate)
        if span.end >= segments[-1].end:
            last = max(last, count)
        to = min(last, count - REACH)
        if to > first:
            blocks.follow(values[:, first + REACH : to + REACH], span.place, first / rate - span.start, levels)
        if span.times:
            filtered.add(values, np.concatenate(span.times), np.concatenate(span.impulses), last + REACH)
    return values


def around_first_contact(filtered: FilteredChain, segments: Sequence[VibratingSegment]) -> Floats:
    """Return the outputs around the first contact, which finds everything still, as far as the filter reaches, (S, samples)."""
    rate = filtered.rate
    span = next((span for span in _spans(filtered.chain, segments, rate) if span.times), None)
    if span is None:
        return np.zeros((len(filtered.answers), 0))
    first = _samples(span.start, rate) - REACH
    values = np.zeros((len(filtered.answers), _samples(span.end, rate) + REACH - first))
    filtered.add(values, np.concatenate(span.times) - first / rate, np.concatenate(span.impulses), values.shape[1])
    return values


def follow_filtered_chain(
    chain: MeasuringChain, rate: float, segments: Sequence[VibratingSegment], count: int, levels: Floats | None = None
) -> Floats:
    """Return the outputs of a chain once a converter's filter is put behind it, (S, count); see `follow_filtered`."""
    return follow_filtered(filtered_chain(chain, rate, longest_span(segments, rate)), segments, count, levels)


def follow_at_instants(chain: MeasuringChain, rate: float, segments: Sequence[VibratingSegment], count: int) -> Floats:
    """Return the outputs of a chain at the instants of samples, (S, count), with nothing behind it."""
    values, blocks = np.zeros((len(chain.direct), count)), _blocks(chain.of, chain.outputs, rate)
    own = np.zeros((2, len(chain.of.shape) - chain.modes))
    for segment in segments:
        first, last = _samples(segment.start, rate), min(_samples(segment.end, rate), count)
        last = count if segment is segments[-1] else last
        place = np.concatenate([_place(segment), own], axis=1)
        if last > first:
            offset = first / rate - segment.start
            if isinstance(segment.trajectory, VibratingStretch):
                values[:, first:last] = _in_contact(chain, segment.trajectory, own, offset + np.arange(last - first) / rate)
                segment.trajectory.clear_cache()
            elif isinstance(segment.trajectory, RestMotion):
                chained = rest_chain(chain, segment.trajectory, own + _laid_down(segments)[:, None])
                _blocks(chained.of, chained.outputs, rate).follow(values[:, first:last], chained.place, offset)
                values[:, first:last] += chained.constant[:, None]
            else:
                blocks.follow(values[:, first:last], place, offset)
        own = _own_later(chain, segment, own)
    return values


def longest_span(segments: Sequence[VibratingSegment], rate: float) -> float:
    """Return how long a part of the history with contact lasts at most [s] that is followed at once."""
    stretches = (segment.end - segment.start for segment in segments if isinstance(segment.trajectory, VibratingStretch))
    return max(REACH / rate, *stretches, 0.0)


def _lie(filtered: FilteredChain, rest: RestMotion, span: _Span, values: Floats, levels: Floats | None) -> None:
    """Add the outputs from where a sphere lies on the plate on, to the end of `values` (S, samples).

    What the filter looks back on is of the same motion once it has reached beyond its beginning. Until then the force of that motion
    adds to what the chain gives of all before.
    """
    rate, chain = filtered.rate, filtered.chain
    first = _samples(span.start, rate)
    times, impulses = rest_pulses(rest, 2.0 * np.pi * _BAND * rate, (first + 2 * REACH) / rate - span.start)
    filtered.add(values, span.start + times, impulses, first + REACH)
    later = values[:, first + REACH :]
    if not later.shape[1]:
        return
    chained = rest_chain(chain, rest, span.place[:, chain.modes :])
    pairs = PolePairs(chained.of.angular_frequency**2, chained.of.damping)
    outputs = pairs.product(chained.outputs, filter_gains(chained.of, rate))
    _blocks(chained.of, outputs, rate).follow(later, chained.place, first / rate - span.start, levels)
    passed = float(kernel(np.arange(-REACH * FINENESS, REACH * FINENESS + 1) / FINENESS).sum()) / FINENESS
    later += passed * chained.constant[:, None]


def _laid_down(segments: Sequence[VibratingSegment]) -> Floats:
    """Return what laying a sphere down, as the last segment begins, does to displacement and velocity of an oscillator of shape one.

    It is an impulse of the contact, which makes surface and sphere move as one.
    """
    before, rest = segments[-2] if len(segments) > 1 else None, segments[-1].trajectory
    if before is None:
        return np.zeros(2)
    of = segments[-1].system
    shape, velocity = of.shape[0, of.ground], before.state(np.array([before.end - before.start])).velocity[0, of.ground]
    change = rest.start.velocity[of.ground] - velocity
    return np.array([0.0, float(shape @ change) / float(shape @ shape) if shape.any() else 0.0])


def _samples(time: float, rate: float) -> int:
    """Return the number of the first sample that is not before a time."""
    return math.ceil(time * rate - 1e-9)


def _place(segment: VibratingSegment) -> Floats:
    """Return displacements and velocities of the plate's modes at the start of a segment, (2, modes)."""
    trajectory = segment.trajectory
    ground = segment.system.ground
    return np.stack([trajectory.start.displacement[ground], trajectory.start.velocity[ground]])


def _spans(chain: MeasuringChain, segments: Sequence[VibratingSegment], rate: float) -> Iterator[_Span]:
    """Yield the history in parts: neighbouring contacts together, as long as that is not longer than the filter reaches."""
    own, reach = np.zeros((2, len(chain.of.shape) - chain.modes)), REACH / rate
    fastest = max(2.0 * np.pi * _BAND * rate, float(chain.of.angular_frequency[chain.modes :].max(initial=0.0)))
    span: _Span | None = None
    for segment in segments:
        if isinstance(segment.trajectory, RestMotion):
            laid = _laid_down(segments)
            if span is not None:
                span.times.append(np.array([segment.start]))
                span.impulses.append(-laid[1:])
                yield span
            place = np.concatenate([_place(segment), own + laid[:, None]], axis=1)
            yield _Span(segment.start, segment.end, place, rest=segment.trajectory)
            return
        if span is not None and not (span.times and segment.end - span.start <= reach and segment is not segments[-1]):
            yield span
            span = None
        if span is None:
            span = _Span(segment.start, segment.end, np.concatenate([_place(segment), own], axis=1))
        span.end = segment.end
        pushed = None
        if isinstance(segment.trajectory, VibratingStretch):
            times, impulses = pushed = pulses(segment.trajectory, fastest)
            span.times.append(segment.start + times)
            span.impulses.append(impulses)
        own = _own_later(chain, segment, own, pushed)
    if span is not None:
        yield span


def _own_later(chain: MeasuringChain, segment: VibratingSegment, own: Floats, pushed: tuple[Floats, Floats] | None = None) -> Floats:
    """Return where the oscillators of the chain itself are at the end of a segment, from where they are at its start."""
    if not own.shape[1]:
        return own
    of = chain.own
    length = segment.end - segment.start
    later = _free(of, own, np.array(length))
    if isinstance(segment.trajectory, VibratingStretch):
        times, impulses = pushed or pulses(segment.trajectory, float(of.angular_frequency.max()))
        later = later - np.tensordot(_impulse_answers(of, length - times), impulses, (1, 0))
    return later


def _free(of: Oscillators, place: Floats, time: Floats) -> Floats:
    """Return displacements and velocities after a free motion of some time [s], (2, ..., n)."""
    later = of.transition(time)
    return np.asarray(later[:, 0] * place[0] + later[:, 1] * place[1])


def _impulse_answers(of: Oscillators, time: Floats) -> Floats:
    """Return displacements and velocities at times since a unit impulse, (2, times, n)."""
    cosine, sine = of.propagators(time)
    return np.stack([sine, cosine - of.damping * sine])


def _in_contact(chain: MeasuringChain, stretch: VibratingStretch, own: Floats, times: Floats) -> Floats:
    """Return the outputs at times since the start of a stretch of contact, (S, T)."""
    times = np.clip(times, 0.0, stretch.length)
    state, ground = stretch.state(times), stretch.system.ground
    places = np.stack([state.displacement[:, ground], state.velocity[:, ground]])
    if own.shape[1]:
        of = chain.own
        since, impulses = pulses(stretch, float(of.angular_frequency.max()), times)
        gained = np.einsum("ktjn,tj->ktn", _impulse_answers(of, times[:, None] - since), impulses)
        there, reached = np.empty((2, len(times), own.shape[1])), own
        for number, passed in enumerate(np.diff(times, prepend=0.0)):
            reached = _free(of, reached, np.array(passed)) - gained[:, number]
            there[:, number] = reached
        places = np.concatenate([places, there], axis=-1)
    moved = np.einsum("ksn,ktn->st", chain.outputs, places)
    return np.asarray(moved - chain.direct @ force_derivatives(stretch, times))


@dataclass(frozen=True)
class _Blocks:
    """The oscillators that still move, what they are worth over a block of samples, C and S (samples + 1, n), and in the outputs.

    `later`: the matrix that takes displacements and velocities a block on, (2, 2, n).
    """

    of: Oscillators
    outputs: Floats
    cosine: Floats
    sine: Floats
    later: Floats

    def pick(self, which: Bools) -> _Blocks:
        """Return some of the oscillators."""
        of = self.of.pick(np.flatnonzero(which))
        return _Blocks(of, self.outputs[..., which], self.cosine[:, which], self.sine[:, which], self.later[..., which])

    def follow(self, values: Floats, place: Floats, offset: float, levels: Floats | None = None) -> None:
        """Write the outputs of a free motion from a place on into `values` (S, samples), the first sample `offset` [s] later."""
        blocks, place, count = self, _free(self.of, place, np.array(offset)), values.shape[1]
        least, first, rows = _NEGLIGIBLE * _swing(self.of, place).max(initial=0.0), 0, 1
        while first < count:
            swing = _swing(blocks.of, place)
            if levels is not None and np.all(blocks.bound(swing) <= levels):
                break
            lasting = swing > least  # what damping has taken away need not be followed
            if np.count_nonzero(lasting) < _WORTH * len(lasting):
                blocks, place = blocks.pick(lasting), place[:, lasting]
            part = min(_BLOCK * rows, count - first)
            places = np.empty((-(-part // _BLOCK), *place.shape))
            for number in range(len(places)):
                places[number] = place
                place = blocks.later[:, 0] * place[0] + blocks.later[:, 1] * place[1]
            blocks.write(values[:, first : first + part], places)
            first, rows = first + part, min(2 * rows, _ROWS)

    def write(self, values: Floats, places: Floats) -> None:
        """Write the outputs over blocks that begin at places (blocks, 2, n); the last one may be cut short."""
        displacement, velocity = places[:, 0], places[:, 1]
        push = -(self.of.angular_frequency**2) * displacement - self.of.damping * velocity
        whole, rest = divmod(values.shape[1], _BLOCK)
        samples = _BLOCK if whole else rest
        ahead = np.concatenate([self.cosine[:samples].T, self.sine[:samples].T])  # (2 n, samples)
        for value, a, b in zip(values, *self.outputs, strict=True):
            of_each = np.concatenate([a * displacement + b * velocity, a * velocity + b * push], axis=1)
            if whole:
                np.matmul(of_each[:whole], ahead, out=value[: whole * _BLOCK].reshape(whole, _BLOCK))
            if rest:
                value[whole * _BLOCK :] = of_each[-1] @ ahead[:, :rest]

    def bound(self, swing: Floats) -> Floats:
        """Return what the outputs can become at most (S,)."""
        if not self.of.angular_frequency.all():  # what moves as a rigid body goes on for ever
            return np.full(self.outputs.shape[1], np.inf)
        return np.asarray((np.abs(self.outputs[0]) / self.of.angular_frequency + np.abs(self.outputs[1])) @ swing)


def _blocks(of: Oscillators, outputs: Floats, rate: float) -> _Blocks:
    propagators = _kept_propagators if len(of.angular_frequency) <= _KEPT else _kept_propagators.__wrapped__
    return _Blocks(of, outputs, *propagators(of.angular_frequency.tobytes(), of.damping_ratio.tobytes(), rate))


@lru_cache(maxsize=8)
def _kept_propagators(frequencies: bytes, ratios: bytes, rate: float) -> tuple[Floats, Floats, Floats]:
    """Return the propagators of a block of samples, and the transition over it, which drops on the same plate have in common."""
    of = Oscillators(np.frombuffer(frequencies), np.frombuffer(ratios), np.zeros(len(frequencies) // 8))
    return *of.propagators(np.arange(_BLOCK + 1) / rate), of.transition(np.array(_BLOCK / rate))


def _swing(of: Oscillators, place: Floats) -> Floats:
    """Return how fast each oscillator can ever become [m/s], from displacements and velocities (2, n)."""
    return np.asarray(np.hypot(of.angular_frequency * place[0], place[1]))
