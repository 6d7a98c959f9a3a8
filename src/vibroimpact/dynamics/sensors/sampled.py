"""Outputs of a measuring chain over the history of one drop, at a constant sampling rate."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS, HALF_LENGTH, kernel
from vibroimpact.dynamics.sensors.filtered_chain import FilteredChain, filter_gains, filtered_chain
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain
from vibroimpact.dynamics.sensors.pole_pairs import PolePairs
from vibroimpact.dynamics.sensors.ports import Ports
from vibroimpact.dynamics.sensors.pulses import Pulses, force_derivatives
from vibroimpact.dynamics.sensors.rest_chain import rest_chain, rest_pulses
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment

_BLOCK, _ROWS = 512, 128
"""Samples per block, for which propagators are cached, and the largest number of blocks
computed at once.
"""
_KEPT = 2000
"""Largest number of oscillators whose propagators are cached for the next drop on the
same plate: 16 MB.
"""
_NEGLIGIBLE = 1e-20
"""Peak speed, relative to that of the fastest oscillator, below which an oscillator is omitted."""
_WORTH = 0.9
"""Fraction of the oscillators above which omitting the others takes longer than it saves."""
_PASS_BAND = 0.6
"""Fraction of the rate above which a converter's filter passes nothing."""


@dataclass
class _Span:
    """A part of the history that is computed at once: state of its oscillators at its start, (2,
    n), and the pulses within it, by ports.

    For the part with the sphere at rest on the plate, `rest` is its motion.
    """

    start: float
    end: float
    initial: Floats
    pulses: dict[int, list[Pulses]] = field(default_factory=dict)
    rest: RestMotion | None = None

    def add(self, start: float, found: Sequence[tuple[int, Pulses]]) -> None:
        """Add pulses, with their ports, at times since a start [s]."""
        for port, (times, impulses) in found:
            self.pulses.setdefault(port, []).append((start + times, impulses))

    def joined(self) -> Iterator[tuple[int, Floats, Floats]]:
        """Yield the ports with all times and impulses."""
        for port, found in self.pulses.items():
            yield (
                port,
                np.concatenate([times for times, _ in found]),
                np.concatenate([impulses for _, impulses in found]),
            )


def sample_filtered(
    filtered: FilteredChain,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    samples: range,
    levels: Floats | None = None,
) -> Floats:
    """Return the outputs of a chain with a converter's filter, (S, samples).

    Parameters
    ----------
    filtered : FilteredChain
        The chain.
    ports : Ports
        Where the contact forces act.
    segments : sequence of VibratingSegment
        The history of one drop.
    samples : range
        Numbers of the samples, from 0 at the start of the run; everything is at rest before the
        first of them.
    levels : array, shape (S,), optional
        Free vibration whose magnitudes stay below these is left zero.
    """
    rate, values, origin = (
        filtered.rate,
        np.zeros((len(filtered.outputs[0]), len(samples))),
        samples.start,
    )
    blocks = blocks_of(filtered.chain.oscillators, filtered.outputs, rate)
    for span in _spans(filtered.chain, ports, segments, rate):
        if span.rest is not None:
            _add_rest(
                filtered,
                ports.of(span.rest.equilibrium.system),
                span.rest,
                span,
                values,
                origin,
                levels,
            )
            break
        first, last = _first_sample(span.start, rate), _first_sample(span.end, rate)
        if span.end >= segments[-1].end:
            last = max(last, samples.stop)
        to = min(last, samples.stop - HALF_LENGTH)
        later = HALF_LENGTH - origin
        if to > first and first + later >= 0:
            blocks.sample(
                values[:, first + later : to + later],
                span.initial,
                first / rate - span.start,
                levels,
            )
        for port, times, impulses in span.joined():
            filtered.add(values, port, times, impulses, last + HALF_LENGTH, origin)
    return values


def around_first_contact(segments: Sequence[VibratingSegment], rate: float) -> float:
    """Return a time before and after the first contact [s] in which its waves come to
    sensors: its own, or a filter's reach at a rate.
    """
    pressed = [isinstance(segment.trajectory, VibratingStretch) for segment in segments]
    if True not in pressed:
        return HALF_LENGTH / rate
    first = pressed.index(True)
    last = pressed.index(False, first) if False in pressed[first:] else len(pressed)
    return max(HALF_LENGTH / rate, segments[last - 1].end - segments[first].start)


def outputs_around_first_contact(
    filtered: FilteredChain, ports: Ports, segments: Sequence[VibratingSegment], around: float
) -> Floats:
    """Return the outputs around the first contact, before which everything is at rest, to a time
    before and after it [s], (S, samples).

    All of the contact counts: a part of it would end with a jump of the force, which excites the
    highest frequencies.
    """
    rate, reach = filtered.rate, _first_sample(around, filtered.rate)
    span = next(
        (span for span in _spans(filtered.chain, ports, segments, rate, around) if span.pulses),
        None,
    )
    if span is None:
        return np.zeros((filtered.answers.shape[1], 0))
    first = _first_sample(span.start, rate) - reach
    values = np.zeros((filtered.answers.shape[1], _first_sample(span.end, rate) + reach - first))
    for port, times, impulses in span.joined():
        filtered.add(values, port, times - first / rate, impulses, values.shape[1])
    return values


def sample_filtered_chain(
    chain: MeasuringChain,
    ports: Ports,
    rate: float,
    segments: Sequence[VibratingSegment],
    samples: range,
    levels: Floats | None = None,
) -> Floats:
    """Return the outputs of a chain followed by a converter's filter, (S, samples); see
    `sample_filtered`.
    """
    return sample_filtered(
        filtered_chain(chain, rate, longest_span(segments, rate)), ports, segments, samples, levels
    )


def first_motion(segments: Sequence[VibratingSegment], rate: float) -> int:
    """Return the number of a sample before which the plate is at rest, and so is the
    output of a converter's filter.
    """
    touch = next((segment.start for segment in segments if segment.in_contact), segments[-1].end)
    return max(_first_sample(touch, rate) - HALF_LENGTH, 0)


def sample_at_instants(
    chain: MeasuringChain,
    ports: Ports,
    rate: float,
    segments: Sequence[VibratingSegment],
    count: int,
) -> Floats:
    """Return the outputs of a chain at the sampling instants, (S, count), without a
    further filter.
    """
    values, blocks = (
        np.zeros((len(chain.shapes), count)),
        blocks_of(chain.oscillators, chain.outputs, rate),
    )
    instrument_state = np.zeros((2, chain.oscillators.number - chain.modes))
    for segment in segments:
        first, last = (
            _first_sample(segment.start, rate),
            min(_first_sample(segment.end, rate), count),
        )
        last = count if segment is segments[-1] else last
        motion_state = np.concatenate([_initial_plate_state(segment), instrument_state], axis=1)
        if last > first:
            offset = first / rate - segment.start
            if isinstance(segment.trajectory, VibratingStretch):
                times = offset + np.arange(last - first) / rate
                values[:, first:last] = _in_contact(
                    chain, ports, segment.trajectory, instrument_state, times
                )
            elif isinstance(segment.trajectory, RestMotion):
                port = ports.of(segment.system)
                chained = rest_chain(
                    chain,
                    port,
                    segment.trajectory,
                    instrument_state + _instrument_jump(chain, port, segments),
                )
                blocks_of(chained.oscillators, chained.outputs, rate).sample(
                    values[:, first:last], chained.initial, offset
                )
                values[:, first:last] += chained.constant[:, None]
            else:
                blocks.sample(values[:, first:last], motion_state, offset)
        instrument_state = _instrument_later(chain, ports, segment, instrument_state)
    return values


def longest_span(segments: Sequence[VibratingSegment], rate: float) -> float:
    """Return the largest length of a part of the history with contact that is computed at
    once [s].
    """
    stretches = (
        segment.end - segment.start
        for segment in segments
        if isinstance(segment.trajectory, VibratingStretch)
    )
    return max(HALF_LENGTH / rate, *stretches, 0.0)


def response_length(segments: Sequence[VibratingSegment], rate: float, around: float) -> float:
    """Return the length of impulse responses beyond a filter's reach [s] for samples, and
    for those to a time around the first contact.
    """
    return max(longest_span(segments, rate), 2.0 * around - HALF_LENGTH / rate)


def _add_rest(
    filtered: FilteredChain,
    port: int,
    rest: RestMotion,
    span: _Span,
    values: Floats,
    origin: int,
    levels: Floats | None,
) -> None:
    """Add the outputs from the instant of rest on, to the end of `values` (S, samples) from sample
    `origin` on.

    Samples whose kernel lies wholly after that instant see the oscillations at rest alone. For
    earlier ones the force of these oscillations adds to the response to all previous motion.
    """
    rate, chain = filtered.rate, filtered.chain
    first = _first_sample(span.start, rate)
    times, impulses = rest_pulses(
        rest, 2.0 * np.pi * _PASS_BAND * rate, (first + 2 * HALF_LENGTH) / rate - span.start
    )
    filtered.add(values, port, span.start + times, impulses, first + HALF_LENGTH, origin)
    later = values[:, first + HALF_LENGTH - origin :]
    if not later.shape[1]:
        return
    chained = rest_chain(chain, port, rest, span.initial[:, chain.modes :])
    pairs = PolePairs(chained.oscillators.angular_frequency**2, chained.oscillators.damping)
    outputs = pairs.product(chained.outputs, filter_gains(chained.oscillators, rate))
    blocks_of(chained.oscillators, outputs, rate).sample(
        later, chained.initial, first / rate - span.start, levels
    )
    passed = (
        float(
            kernel(np.arange(-HALF_LENGTH * FINENESS, HALF_LENGTH * FINENESS + 1) / FINENESS).sum()
        )
        / FINENESS
    )
    later += passed * chained.constant[:, None]


def _rest_jump(segments: Sequence[VibratingSegment]) -> Floats:
    """Return the jump of displacement and velocity of an oscillator of shape one at the instant of
    rest.

    It comes from the contact impulse that makes surface and sphere move as one. The last segment
    begins at that instant.
    """
    before, rest = segments[-2] if len(segments) > 1 else None, segments[-1].trajectory
    if before is None:
        return np.zeros(2)
    oscillators = segments[-1].system
    shape, velocity = (
        oscillators.shape[0, oscillators.ground],
        before.state(np.array([before.end - before.start])).velocity[0, oscillators.ground],
    )
    change = rest.start.velocity[oscillators.ground] - velocity
    return np.array([0.0, float(shape @ change) / float(shape @ shape) if shape.any() else 0.0])


def _instrument_jump(
    chain: MeasuringChain, port: int, segments: Sequence[VibratingSegment]
) -> Floats:
    """Return the jumps of the instruments' pairs of poles at the instant of rest, (2, n)."""
    return np.asarray(_rest_jump(segments)[:, None] * chain.instrument.shape[port])


def _first_sample(time: float, rate: float) -> int:
    """Return the number of the first sample that is not before a time."""
    return math.ceil(time * rate - 1e-9)


def _initial_plate_state(segment: VibratingSegment) -> Floats:
    """Return displacements and velocities of the plate's modes at the start of a segment,
    (2, modes).
    """
    trajectory = segment.trajectory
    ground = segment.system.ground
    return np.stack([trajectory.start.displacement[ground], trajectory.start.velocity[ground]])


def _spans(
    chain: MeasuringChain,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    rate: float,
    longest: float | None = None,
) -> Iterator[_Span]:
    """Yield the history in parts; neighbouring contacts are combined up to a length [s],
    by default the filter's reach.
    """
    instrument_state, reach = (
        np.zeros((2, chain.oscillators.number - chain.modes)),
        HALF_LENGTH / rate if longest is None else longest,
    )
    fastest = max(
        2.0 * np.pi * _PASS_BAND * rate,
        float(chain.oscillators.angular_frequency[chain.modes :].max(initial=0.0)),
    )
    span: _Span | None = None
    for segment in segments:
        if isinstance(segment.trajectory, RestMotion):
            # rest ends the history: its jump is also an impulse on the motion before
            port = ports.of(segment.system)
            if span is not None:
                span.add(segment.start, [(port, (np.zeros(1), -_rest_jump(segments)[1:]))])
                yield span
            jump = _instrument_jump(chain, port, segments)
            motion_state = np.concatenate(
                [_initial_plate_state(segment), instrument_state + jump], axis=1
            )
            yield _Span(segment.start, segment.end, motion_state, rest=segment.trajectory)
            return
        # a part grows only while it has contacts, stays within the filter's reach, and the last
        # segment is not reached
        if span is not None and not (
            span.pulses and segment.end - span.start <= reach and segment is not segments[-1]
        ):
            yield span
            span = None
        if span is None:
            span = _Span(
                segment.start,
                segment.end,
                np.concatenate([_initial_plate_state(segment), instrument_state], axis=1),
            )
        span.end = segment.end
        force_pulses = None
        if isinstance(segment.trajectory, VibratingStretch):
            force_pulses = ports.pulses(segment.trajectory, fastest)
            span.add(segment.start, force_pulses)
        instrument_state = _instrument_later(chain, ports, segment, instrument_state, force_pulses)
    if span is not None:
        yield span


def _instrument_later(
    chain: MeasuringChain,
    ports: Ports,
    segment: VibratingSegment,
    instrument_state: Floats,
    force_pulses: list[tuple[int, Pulses]] | None = None,
) -> Floats:
    """Return the state of the instruments' oscillators at the end of a segment, from that
    at its start.
    """
    if not instrument_state.shape[1]:
        return instrument_state
    oscillators = chain.instrument
    length = segment.end - segment.start
    later = _free(oscillators, instrument_state, np.array(length))
    if isinstance(segment.trajectory, VibratingStretch):
        for port, (times, impulses) in force_pulses or ports.pulses(
            segment.trajectory, float(oscillators.angular_frequency.max())
        ):
            later = later - oscillators.shape[port] * np.tensordot(
                _impulse_answers(oscillators, length - times), impulses, (1, 0)
            )
    return later


def _free(oscillators: Oscillators, motion_state: Floats, time: Floats) -> Floats:
    """Return displacements and velocities after a free motion of some time [s], (2, ..., n)."""
    later = oscillators.transition(time)
    return np.asarray(later[:, 0] * motion_state[0] + later[:, 1] * motion_state[1])


def _impulse_answers(oscillators: Oscillators, time: Floats) -> Floats:
    """Return displacements and velocities at times since a unit impulse, (2, times, n)."""
    cosine, sine = oscillators.propagators(time)
    return np.stack([sine, cosine - oscillators.damping * sine])


def _in_contact(
    chain: MeasuringChain,
    ports: Ports,
    stretch: VibratingStretch,
    instrument_state: Floats,
    times: Floats,
) -> Floats:
    """Return the outputs at times since the start of a stretch of contact, (S, T)."""
    times = np.clip(times, 0.0, stretch.length)
    state, ground = stretch.state(times), stretch.system.ground
    places = np.stack([state.displacement[:, ground], state.velocity[:, ground]])
    if instrument_state.shape[1]:
        oscillators = chain.instrument
        gained = np.zeros((2, len(times), oscillators.number))
        for port, (since, impulses) in ports.pulses(
            stretch, float(oscillators.angular_frequency.max()), times
        ):
            answers = np.einsum(
                "ktjn,tj->ktn", _impulse_answers(oscillators, times[:, None] - since), impulses
            )
            gained += oscillators.shape[port] * answers
        instrument_states, instrument_now = (
            np.empty((2, len(times), instrument_state.shape[1])),
            instrument_state,
        )
        for number, passed in enumerate(np.diff(times, prepend=0.0)):
            instrument_now = (
                _free(oscillators, instrument_now, np.array(passed)) - gained[:, number]
            )
            instrument_states[:, number] = instrument_now
        places = np.concatenate([places, instrument_states], axis=-1)
    moved = np.einsum("ksn,ktn->st", chain.outputs, places)
    port = ports.of(stretch.system)
    moved -= chain.direct[port] @ force_derivatives(stretch, times)
    # there is no residual compliance to friction: its derivatives do not count
    if stretch.sliding is not None:
        forces = stretch.sliding.at(times)[2]
        moved -= np.einsum(
            "ps,pt->st", chain.direct[port + 1 : port + 1 + len(forces), :, 0], forces
        )
    return np.asarray(moved)


@dataclass(frozen=True)
class _Blocks:
    """Oscillators in free motion with their weights in the outputs, and their propagators C and S
    over a block of samples (samples + 1, n).

    `later`: transition matrices of displacements and velocities over a block, (2, 2, n).
    """

    oscillators: Oscillators
    outputs: Floats
    cosine: Floats
    sine: Floats
    later: Floats

    def pick(self, which: Bools) -> _Blocks:
        """Return a subset of the oscillators."""
        oscillators = self.oscillators.pick(np.flatnonzero(which))
        return _Blocks(
            oscillators,
            self.outputs[..., which],
            self.cosine[:, which],
            self.sine[:, which],
            self.later[..., which],
        )

    def sample(
        self, values: Floats, motion_state: Floats, offset: float, levels: Floats | None = None
    ) -> None:
        """Write the outputs of a free motion from a state on into `values` (S, samples),
        with the first sample `offset` [s] later.
        """
        blocks, motion_state, count = (
            self,
            _free(self.oscillators, motion_state, np.array(offset)),
            values.shape[1],
        )
        least, first, rows = (
            _NEGLIGIBLE * _peak_speeds(self.oscillators, motion_state).max(initial=0.0),
            0,
            1,
        )
        while first < count:
            peak_speeds = _peak_speeds(blocks.oscillators, motion_state)
            if levels is not None and np.all(blocks.bound(peak_speeds) <= levels):
                break
            lasting = peak_speeds > least  # omit oscillators that damping has stopped
            if np.count_nonzero(lasting) < _WORTH * len(lasting):
                blocks, motion_state = blocks.pick(lasting), motion_state[:, lasting]
            part = min(_BLOCK * rows, count - first)
            places = np.empty((-(-part // _BLOCK), *motion_state.shape))
            for number in range(len(places)):
                places[number] = motion_state
                motion_state = (
                    blocks.later[:, 0] * motion_state[0] + blocks.later[:, 1] * motion_state[1]
                )
            blocks.write(values[:, first : first + part], places)
            first, rows = first + part, min(2 * rows, _ROWS)

    def write(self, values: Floats, places: Floats) -> None:
        """Write the outputs over blocks that begin with states `places` (blocks, 2, n);
        the last block may be cut short.
        """
        displacement, velocity = places[:, 0], places[:, 1]
        push = (
            -(self.oscillators.angular_frequency**2) * displacement
            - self.oscillators.damping * velocity
        )
        full_blocks, rest = divmod(values.shape[1], _BLOCK)
        samples = _BLOCK if full_blocks else rest
        ahead = np.concatenate([self.cosine[:samples].T, self.sine[:samples].T])  # (2 n, samples)
        for value, a, b in zip(values, *self.outputs, strict=True):
            of_each = np.concatenate(
                [a * displacement + b * velocity, a * velocity + b * push], axis=1
            )
            if full_blocks:
                np.matmul(
                    of_each[:full_blocks],
                    ahead,
                    out=value[: full_blocks * _BLOCK].reshape(full_blocks, _BLOCK),
                )
            if rest:
                value[full_blocks * _BLOCK :] = of_each[-1] @ ahead[:, :rest]

    def bound(self, peak_speeds: Floats) -> Floats:
        """Return upper bounds of the magnitudes of the outputs (S,)."""
        if not self.oscillators.angular_frequency.all():  # rigid motions are unbounded
            return np.full(self.outputs.shape[1], np.inf)
        return np.asarray(
            (np.abs(self.outputs[0]) / self.oscillators.angular_frequency + np.abs(self.outputs[1]))
            @ peak_speeds
        )


def blocks_of(oscillators: Oscillators, outputs: Floats, rate: float) -> _Blocks:
    """Return oscillators with propagators over a block of samples, cached for few oscillators."""
    propagators = (
        _kept_propagators
        if len(oscillators.angular_frequency) <= _KEPT
        else _kept_propagators.__wrapped__
    )
    return _Blocks(
        oscillators,
        outputs,
        *propagators(
            oscillators.angular_frequency.tobytes(), oscillators.damping_ratio.tobytes(), rate
        ),
    )


@lru_cache(maxsize=8)
def _kept_propagators(
    frequencies: bytes, ratios: bytes, rate: float
) -> tuple[Floats, Floats, Floats]:
    """Return the propagators and the transition over a block of samples, cached for drops
    on the same plate.
    """
    oscillators = Oscillators(
        np.frombuffer(frequencies), np.frombuffer(ratios), np.zeros(len(frequencies) // 8)
    )
    return *oscillators.propagators(np.arange(_BLOCK + 1) / rate), oscillators.transition(
        np.array(_BLOCK / rate)
    )


def _peak_speeds(oscillators: Oscillators, motion_state: Floats) -> Floats:
    """Return upper bounds of the future speed of each oscillator [m/s], from
    displacements and velocities (2, n).
    """
    return np.asarray(np.hypot(oscillators.angular_frequency * motion_state[0], motion_state[1]))
