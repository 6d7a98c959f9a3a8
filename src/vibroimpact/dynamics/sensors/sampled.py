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
from vibroimpact.dynamics.sensors.instruments.pole_pairs import PolePairs
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain
from vibroimpact.dynamics.sensors.ports import Ports
from vibroimpact.dynamics.sensors.pulses import Pulses, force_derivatives
from vibroimpact.dynamics.sensors.rest_chain import rest_chain, rest_pulses
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment

_BLOCK = 512
"""Samples per block, for which propagators are cached."""
_MOST_BLOCKS = 128
"""Largest number of blocks computed at once."""
_MOST_CACHED = 2000
"""Largest number of oscillators whose propagators are cached for the next drop: 16 MB."""
_NEGLIGIBLE = 1e-20
"""Peak speed, relative to that of the fastest oscillator, below which an oscillator is omitted."""
_WORTH = 0.9
"""Fraction of the oscillators above which omitting the others takes longer than it saves."""
_PASS_BAND = 0.6
"""Fraction of the rate above which a converter's filter passes nothing."""


@dataclass
class _Span:
    """A part of the history that is computed at once.

    `initial`: state of its oscillators at its start, (2, n). `pulses`: those within it, by ports.
    `rest`: the motion with the sphere at rest on the plate, if that is the part.
    """

    start: float
    end: float
    initial: Floats
    pulses: dict[int, list[Pulses]] = field(default_factory=dict)
    rest: RestMotion | None = None

    def add(self, start: float, pulses_of_ports: Sequence[tuple[int, Pulses]]) -> None:
        """Add pulses, with their ports, at times since a start [s]."""
        for port, (times, impulses) in pulses_of_ports:
            self.pulses.setdefault(port, []).append((start + times, impulses))

    def joined(self) -> Iterator[tuple[int, Floats, Floats]]:
        """Yield the ports with all times and impulses."""
        for port, pulses in self.pulses.items():
            times = np.concatenate([times for times, _ in pulses])
            impulses = np.concatenate([impulses for _, impulses in pulses])
            yield port, times, impulses


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
    rate = filtered.rate
    origin = samples.start
    values = np.zeros((len(filtered.outputs[0]), len(samples)))
    blocks = blocks_of(filtered.chain.oscillators, filtered.outputs, rate)
    for span in _spans(filtered.chain, ports, segments, rate):
        if span.rest is not None:
            port = ports.of(span.rest.equilibrium.system)
            _add_rest(filtered, port, span.rest, span, values, origin, levels)
            break
        first = _first_sample(span.start, rate)
        last = _first_sample(span.end, rate)
        if span.end >= segments[-1].end:
            last = max(last, samples.stop)
        # the free motion from the start of the span on, which the filter passes on later
        end = min(last, samples.stop - HALF_LENGTH)
        delay = HALF_LENGTH - origin
        if end > first and first + delay >= 0:
            free_outputs = values[:, first + delay : end + delay]
            blocks.sample(free_outputs, span.initial, first / rate - span.start, levels)
        for port, times, impulses in span.joined():
            filtered.add(values, port, times, impulses, last + HALF_LENGTH, origin)
    return values


def around_first_contact(segments: Sequence[VibratingSegment], rate: float) -> float:
    """Return a time around the first contact in which its waves come to sensors [s].

    It is its own duration, or a filter's reach at a rate.
    """
    reach = HALF_LENGTH / rate
    in_contact = [isinstance(segment.trajectory, VibratingStretch) for segment in segments]
    if True not in in_contact:
        return reach
    first = in_contact.index(True)
    after = len(in_contact)
    if False in in_contact[first:]:
        after = in_contact.index(False, first)
    return max(reach, segments[after - 1].end - segments[first].start)


def outputs_around_first_contact(
    filtered: FilteredChain, ports: Ports, segments: Sequence[VibratingSegment], around: float
) -> Floats:
    """Return the outputs from a time before to a time after the first contact [s], (S, samples).

    Everything is at rest before it. All of the contact counts: a part of it would end with a jump
    of the force, which excites the highest frequencies.
    """
    rate = filtered.rate
    sensors = filtered.answers.shape[1]
    margin = _first_sample(around, rate)
    for span in _spans(filtered.chain, ports, segments, rate, around):
        if span.pulses:
            break
    else:
        return np.zeros((sensors, 0))
    first = _first_sample(span.start, rate) - margin
    last = _first_sample(span.end, rate) + margin
    values = np.zeros((sensors, last - first))
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
    """Return the outputs of a chain followed by a converter's filter, (S, samples).

    See `sample_filtered`.
    """
    filtered = filtered_chain(chain, rate, longest_span(segments, rate))
    return sample_filtered(filtered, ports, segments, samples, levels)


def first_motion(segments: Sequence[VibratingSegment], rate: float) -> int:
    """Return the number of a sample before which the plate is at rest.

    So is the output of a converter's filter.
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
    """Return the outputs of a chain at the sampling instants, (S, count), without a filter."""
    values = np.zeros((len(chain.shapes), count))
    blocks = blocks_of(chain.oscillators, chain.outputs, rate)
    instrument_state = np.zeros((2, chain.oscillators.number - chain.modes))
    for segment in segments:
        trajectory = segment.trajectory
        first = _first_sample(segment.start, rate)
        last = min(_first_sample(segment.end, rate), count)
        if segment is segments[-1]:
            last = count
        if last > first:
            outputs = values[:, first:last]
            offset = first / rate - segment.start
            if isinstance(trajectory, VibratingStretch):
                times = offset + np.arange(last - first) / rate
                outputs[:] = _in_contact(chain, ports, trajectory, instrument_state, times)
            elif isinstance(trajectory, RestMotion):
                port = ports.of(segment.system)
                state = instrument_state + _instrument_jump(chain, port, segments)
                resting = rest_chain(chain, port, trajectory, state)
                blocks_of(resting.oscillators, resting.outputs, rate).sample(
                    outputs, resting.initial, offset
                )
                outputs += resting.constant[:, None]
            else:
                state = np.concatenate([_initial_plate_state(segment), instrument_state], axis=1)
                blocks.sample(outputs, state, offset)
        instrument_state = _instrument_state_after(chain, ports, segment, instrument_state)
    return values


def longest_span(segments: Sequence[VibratingSegment], rate: float) -> float:
    """Return the largest length of a part of the history with contact [s].

    The parts are those that are computed at once.
    """
    stretches = (
        segment.end - segment.start
        for segment in segments
        if isinstance(segment.trajectory, VibratingStretch)
    )
    return max(HALF_LENGTH / rate, *stretches, 0.0)


def response_length(segments: Sequence[VibratingSegment], rate: float, around: float) -> float:
    """Return the length of impulse responses beyond a filter's reach that samples need [s].

    It suffices for those up to a time around the first contact, too.
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
    """Add the outputs from the instant of rest on to `values` (S, samples).

    These begin with sample `origin`. Samples whose kernel lies wholly after that instant see the
    oscillations at rest alone. For earlier ones the force of these oscillations adds to the
    response to all previous motion.
    """
    rate = filtered.rate
    first = _first_sample(span.start, rate)
    length = (first + 2 * HALF_LENGTH) / rate - span.start
    times, impulses = rest_pulses(rest, 2.0 * np.pi * _PASS_BAND * rate, length)
    filtered.add(values, port, span.start + times, impulses, first + HALF_LENGTH, origin)
    resting_values = values[:, first + HALF_LENGTH - origin :]
    if not resting_values.shape[1]:
        return
    chain = rest_chain(filtered.chain, port, rest, span.initial[:, filtered.chain.modes :])
    oscillators = chain.oscillators
    poles = PolePairs(oscillators.angular_frequency**2, oscillators.damping)
    outputs = poles.product(chain.outputs, filter_gains(oscillators, rate))
    blocks_of(oscillators, outputs, rate).sample(
        resting_values, chain.initial, first / rate - span.start, levels
    )
    lead = HALF_LENGTH * FINENESS
    static_gain = float(kernel(np.arange(-lead, lead + 1) / FINENESS).sum()) / FINENESS
    resting_values += static_gain * chain.constant[:, None]


def _rest_jump(segments: Sequence[VibratingSegment]) -> Floats:
    """Return the jump of an oscillator of shape one at the instant of rest, (2,).

    The jump of displacement and velocity comes from the contact impulse that makes surface and
    sphere move as one. The last segment begins at that instant.
    """
    if len(segments) == 1:
        return np.zeros(2)
    last, resting = segments[-2:]
    system = resting.system
    ground = system.ground
    shape = system.shape[0, ground]
    end = last.state(np.array([last.end - last.start]))
    velocity_change = resting.trajectory.start.velocity[ground] - end.velocity[0, ground]
    if not shape.any():
        return np.zeros(2)
    return np.array([0.0, float(shape @ velocity_change) / float(shape @ shape)])


def _instrument_jump(
    chain: MeasuringChain, port: int, segments: Sequence[VibratingSegment]
) -> Floats:
    """Return the jumps of the instruments' pairs of poles at the instant of rest, (2, n)."""
    return np.asarray(_rest_jump(segments)[:, None] * chain.instrument.shape[port])


def _first_sample(time: float, rate: float) -> int:
    """Return the number of the first sample that is not before a time."""
    return math.ceil(time * rate - 1e-9)


def _initial_plate_state(segment: VibratingSegment) -> Floats:
    """Return the states of the plate's modes at the start of a segment, (2, modes)."""
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
    """Yield the history in parts that are computed at once.

    Neighbouring contacts are combined up to a length [s], by default the filter's reach.
    """
    reach = longest
    if reach is None:
        reach = HALF_LENGTH / rate
    instrument_state = np.zeros((2, chain.oscillators.number - chain.modes))
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
            state = np.concatenate([_initial_plate_state(segment), instrument_state + jump], axis=1)
            yield _Span(segment.start, segment.end, state, rest=segment.trajectory)
            return
        # a part grows only while it has contacts, stays within the filter's reach, and the last
        # segment is not reached
        if span is not None and not (
            span.pulses and segment.end - span.start <= reach and segment is not segments[-1]
        ):
            yield span
            span = None
        if span is None:
            state = np.concatenate([_initial_plate_state(segment), instrument_state], axis=1)
            span = _Span(segment.start, segment.end, state)
        span.end = segment.end
        force_pulses = None
        if isinstance(segment.trajectory, VibratingStretch):
            force_pulses = ports.pulses(segment.trajectory, fastest)
            span.add(segment.start, force_pulses)
        instrument_state = _instrument_state_after(
            chain, ports, segment, instrument_state, force_pulses
        )
    if span is not None:
        yield span


def _instrument_state_after(
    chain: MeasuringChain,
    ports: Ports,
    segment: VibratingSegment,
    instrument_state: Floats,
    force_pulses: list[tuple[int, Pulses]] | None = None,
) -> Floats:
    """Return the state of the instruments' oscillators at the end of a segment.

    `instrument_state`: at its start. `force_pulses`: the forces of a stretch, if they are known.
    """
    if not instrument_state.shape[1]:
        return instrument_state
    oscillators = chain.instrument
    length = segment.end - segment.start
    state = _free(oscillators, instrument_state, np.array(length))
    if isinstance(segment.trajectory, VibratingStretch):
        if not force_pulses:
            fastest = float(oscillators.angular_frequency.max())
            force_pulses = ports.pulses(segment.trajectory, fastest)
        for port, (times, impulses) in force_pulses:
            responses = _impulse_responses(oscillators, length - times)
            state = state - oscillators.shape[port] * np.tensordot(responses, impulses, (1, 0))
    return state


def _free(oscillators: Oscillators, state: Floats, time: Floats) -> Floats:
    """Return displacements and velocities after a free motion of some time [s], (2, ..., n)."""
    transition = oscillators.transition(time)
    displacement, velocity = state
    return np.asarray(transition[:, 0] * displacement + transition[:, 1] * velocity)


def _impulse_responses(oscillators: Oscillators, time: Floats) -> Floats:
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
    plate_state = stretch.state(times)
    ground = stretch.system.ground
    displacement = plate_state.displacement[:, ground]
    velocity = plate_state.velocity[:, ground]
    states = np.stack([displacement, velocity])
    if instrument_state.shape[1]:
        instrument_states = _instrument_states(chain, ports, stretch, instrument_state, times)
        states = np.concatenate([states, instrument_states], axis=-1)
    outputs = np.einsum("ksn,ktn->st", chain.outputs, states)
    port = ports.of(stretch.system)
    outputs -= chain.direct[port] @ force_derivatives(stretch, times)
    # there is no residual compliance to friction: its derivatives do not count
    if stretch.sliding is not None:
        _, _, friction, _ = stretch.sliding.at(times)
        of_friction = slice(port + 1, port + 1 + len(friction))
        outputs -= np.einsum("ps,pt->st", chain.direct[of_friction, :, 0], friction)
    return np.asarray(outputs)


def _instrument_states(
    chain: MeasuringChain,
    ports: Ports,
    stretch: VibratingStretch,
    instrument_state: Floats,
    times: Floats,
) -> Floats:
    """Return the states of the instruments' oscillators through a stretch, (2, T, n).

    `instrument_state`: at its start. `times`: since then [s] (T,).
    """
    oscillators = chain.instrument
    # what the forces between each time and the previous one contribute
    increments = np.zeros((2, len(times), oscillators.number))
    fastest = float(oscillators.angular_frequency.max())
    for port, (pulse_times, impulses) in ports.pulses(stretch, fastest, times):
        responses = _impulse_responses(oscillators, times[:, None] - pulse_times)
        increments += oscillators.shape[port] * np.einsum("ktjn,tj->ktn", responses, impulses)
    states = np.empty((2, len(times), instrument_state.shape[1]))
    state = instrument_state
    for number, step in enumerate(np.diff(times, prepend=0.0)):
        state = _free(oscillators, state, np.array(step)) - increments[:, number]
        states[:, number] = state
    return states


@dataclass(frozen=True)
class _Blocks:
    """Oscillators in free motion with their weights in the outputs, by blocks of samples.

    `cosine`, `sine`: propagators C and S over a block (samples + 1, n). `transition`: transition
    matrices of displacements and velocities over a block, (2, 2, n).
    """

    oscillators: Oscillators
    outputs: Floats
    cosine: Floats
    sine: Floats
    transition: Floats

    def pick(self, mask: Bools) -> _Blocks:
        """Return a subset of the oscillators."""
        return _Blocks(
            self.oscillators.pick(np.flatnonzero(mask)),
            self.outputs[..., mask],
            self.cosine[:, mask],
            self.sine[:, mask],
            self.transition[..., mask],
        )

    def sample(
        self, values: Floats, state: Floats, offset: float, levels: Floats | None = None
    ) -> None:
        """Write the outputs of a free motion from a state on into `values` (S, samples).

        The first sample is `offset` [s] after the state.
        """
        blocks = self
        state = _free(self.oscillators, state, np.array(offset))
        negligible = _NEGLIGIBLE * _peak_speeds(self.oscillators, state).max(initial=0.0)
        count = values.shape[1]
        first = 0
        most_blocks = 1
        while first < count:
            peak_speeds = _peak_speeds(blocks.oscillators, state)
            if levels is not None and np.all(blocks.bound(peak_speeds) <= levels):
                break
            lasting = peak_speeds > negligible  # omit oscillators that damping has stopped
            if np.count_nonzero(lasting) < _WORTH * len(lasting):
                blocks = blocks.pick(lasting)
                state = state[:, lasting]
            last = min(first + _BLOCK * most_blocks, count)
            states = np.empty((math.ceil((last - first) / _BLOCK), *state.shape))
            for number in range(len(states)):
                states[number] = state
                state = blocks.transition[:, 0] * state[0] + blocks.transition[:, 1] * state[1]
            blocks.write(values[:, first:last], states)
            first = last
            # few blocks at first, as the motion may decay soon
            most_blocks = min(2 * most_blocks, _MOST_BLOCKS)

    def write(self, values: Floats, states: Floats) -> None:
        """Write the outputs over blocks that begin with states (blocks, 2, n).

        The last block may be cut short.
        """
        displacement = states[:, 0]
        velocity = states[:, 1]
        acceleration = (
            -(self.oscillators.angular_frequency**2) * displacement
            - self.oscillators.damping * velocity
        )
        full_blocks, remainder = divmod(values.shape[1], _BLOCK)
        samples = _BLOCK if full_blocks else remainder
        propagators = np.concatenate([self.cosine[:samples].T, self.sine[:samples].T])
        for value, a, b in zip(values, *self.outputs, strict=True):
            # the output is C times this output of each oscillator, plus S times its derivative
            output = a * displacement + b * velocity
            output_rate = a * velocity + b * acceleration
            outputs = np.concatenate([output, output_rate], axis=1)
            if full_blocks:
                np.matmul(
                    outputs[:full_blocks],
                    propagators,
                    out=value[: full_blocks * _BLOCK].reshape(full_blocks, _BLOCK),
                )
            if remainder:
                value[full_blocks * _BLOCK :] = outputs[-1] @ propagators[:, :remainder]

    def bound(self, peak_speeds: Floats) -> Floats:
        """Return upper bounds of the magnitudes of the outputs (S,)."""
        omega = self.oscillators.angular_frequency
        if not omega.all():  # rigid motions are unbounded
            return np.full(self.outputs.shape[1], np.inf)
        displacement_weights, velocity_weights = np.abs(self.outputs)
        return np.asarray((displacement_weights / omega + velocity_weights) @ peak_speeds)


def blocks_of(oscillators: Oscillators, outputs: Floats, rate: float) -> _Blocks:
    """Return oscillators with propagators over a block of samples, cached for few oscillators."""
    frequencies = oscillators.angular_frequency.tobytes()
    ratios = oscillators.damping_ratio.tobytes()
    if oscillators.number <= _MOST_CACHED:
        cosine, sine, transition = _block_propagators(frequencies, ratios, rate)
    else:
        cosine, sine, transition = _block_propagators.__wrapped__(frequencies, ratios, rate)
    return _Blocks(oscillators, outputs, cosine, sine, transition)


@lru_cache(maxsize=8)
def _block_propagators(
    frequencies: bytes, ratios: bytes, rate: float
) -> tuple[Floats, Floats, Floats]:
    """Return the propagators and the transition over a block of samples.

    They are cached for drops on the same plate.
    """
    oscillators = Oscillators(
        np.frombuffer(frequencies), np.frombuffer(ratios), np.zeros(len(frequencies) // 8)
    )
    cosine, sine = oscillators.propagators(np.arange(_BLOCK + 1) / rate)
    return cosine, sine, oscillators.transition(np.array(_BLOCK / rate))


def _peak_speeds(oscillators: Oscillators, state: Floats) -> Floats:
    """Return upper bounds of the future speed of each oscillator [m/s].

    `state`: displacements and velocities (2, n).
    """
    displacement, velocity = state
    return np.asarray(np.hypot(oscillators.angular_frequency * displacement, velocity))
