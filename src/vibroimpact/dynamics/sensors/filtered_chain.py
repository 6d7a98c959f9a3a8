r"""A measuring chain with a converter's linear-phase filter, in closed form at the samples only.

With the kernel h of the filter, of half width T, and the response k of the chain to an impulse of
force, an output is

.. math::

    y(t) = \int h(\sigma)\, x(t - \sigma)\, d\sigma = y_0(t) - \int_{t - T} K(t - \tau)\, F(\tau)\,
    d\tau,\qquad K = h * k

where :math:`y_0` is the filtered free motion of the oscillators from their state at t - T, with one
gain per oscillator. K is as smooth as the filter is narrow, however fast the modes and however
sharp the contact, so one table of K serves for every contact.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS, HALF_LENGTH, kernel, kernel_derivatives
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain
from vibroimpact.dynamics.sensors.pulses import gauss_rule
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.structures.finite_elements.lagrange_shares import STENCIL, lagrange_shares

_ROWS = 64
"""Points of the table that are computed at once."""
_MOST_RADIANS = 5000.0
"""Largest phase of a mode between two points of the table that is resolved.

Faster modes are far above the band, and hardly respond.
"""
_CACHED_SIZE = 2_000_000
"""Largest table of states, in numbers, that is cached for the next drop on a plate: 16 MB."""
_WIDE = 1000
"""Number of impulse points from which on Fourier transforms are faster than sums."""


@dataclass(frozen=True)
class FilteredChain:
    """A measuring chain with a converter's filter, at a sampling rate.

    Parameters
    ----------
    chain : MeasuringChain
        The chain before the filter.
    rate : float
        Samples per second [Hz].
    answers : array, shape (P, S, points)
        Response to an impulse of minus the force at each port, `FINENESS` points per sample, from
        `HALF_LENGTH` samples before it on.
    """

    chain: MeasuringChain
    rate: float
    answers: Floats

    @cached_property
    def outputs(self) -> Floats:
        """Weights of displacements and velocities in the outputs, (2, S, n).

        The outputs are those `HALF_LENGTH` samples later.
        """
        return self.chain.pairs.product(
            self.chain.outputs, filter_gains(self.chain.oscillators, self.rate)
        )

    def add(
        self, values: Floats, port: int, times: Floats, impulses: Floats, last: int, origin: int = 0
    ) -> None:
        """Add the response to impulses at a port [N s] to `values` (S, samples).

        These begin with sample `origin`; the response is added to samples before `last`.
        """
        add_responses(values, self.answers[port], self.rate, times, -impulses, last, origin)


def add_responses(
    values: Floats,
    responses: Floats,
    rate: float,
    times: Floats,
    impulses: Floats,
    last: int,
    origin: int = 0,
) -> None:
    """Add responses to impulses.

    Parameters
    ----------
    values : array, shape (S, samples)
        Samples, to which is added.
    responses : array, shape (S, points)
        Responses to a unit impulse, `FINENESS` points per sample, from `HALF_LENGTH` samples before
        it on.
    rate : float
        Samples per second [Hz].
    times, impulses : array, shape (n,)
        The impulses and their times [s].
    last : int
        Samples before this one, counted from time zero, are added to.
    origin : int, default 0
        Number of the first of `values`, counted from time zero.
    """
    lead = HALF_LENGTH * FINENESS
    first_point, weights = _spread_on_grid(times * (rate * FINENESS), impulses)
    first_point -= origin * FINENESS
    # the first sample whose kernel reaches the impulses
    begin = max(0, -((lead - first_point) // FINENESS))
    end = min(last - origin, values.shape[1])
    if end <= begin:
        return
    # points of the responses from that of the first sample to the last impulse point, to that of
    # the last sample to the first one; the responses are zero beyond their ends
    start = begin * FINENESS - (first_point + len(weights) - 1) + lead
    stop = start + (end - 1 - begin) * FINENESS + len(weights)
    before = max(0, -start)
    after = max(0, stop - responses.shape[1])
    padded = np.pad(responses, ((0, 0), (before, after)))
    needed = padded[:, start + before : stop + before]
    values[:, begin:end] += _correlate(needed, weights[::-1])


def filtered_chain(chain: MeasuringChain, rate: float, beyond: float) -> FilteredChain:
    """Return a chain with the filter of a converter.

    Parameters
    ----------
    chain : MeasuringChain
        The chain before the filter.
    rate : float
        Samples per second [Hz].
    beyond : float
        Length of the impulse response after the filter's reach [s].
    """
    derivatives = kernel_derivatives()
    kernel_points = derivatives.shape[1]
    points_beyond = math.ceil(beyond * FINENESS * rate) + len(STENCIL)
    # few lengths are cached
    cached_points = kernel_points + _next_power_of_two(points_beyond)
    ports, sensors = chain.direct.shape[:2]
    answers = np.zeros((ports, sensors, kernel_points + points_beyond))

    plate_outputs = chain.outputs[:, None, :, : chain.modes] * chain.plate.shape[:, None]
    _add_oscillators(answers, chain.plate, plate_outputs, rate, cached_points)
    # each port drives poles of its own, and all of these move alike
    poles_of_ports = [chain.instrument_of(port) for port in range(ports)]
    instrument_outputs = np.stack(
        [chain.outputs[:, :, chain.modes :][:, :, poles] for poles in poles_of_ports], axis=1
    )
    poles = chain.instrument.pick(poles_of_ports[0])
    _add_oscillators(answers, poles, instrument_outputs, rate, cached_points)
    # the direct terms in the force and its derivatives
    scaled = derivatives * rate ** np.arange(1.0, 4.0)[:, None]
    answers[:, :, :kernel_points] += chain.direct @ scaled
    return FilteredChain(chain, rate, answers)


def _add_oscillators(
    answers: Floats, oscillators: Oscillators, weights: Floats, rate: float, cached_points: int
) -> None:
    """Add outputs of oscillators to answers (P, S, points).

    They have the weights of displacements and velocities in them, (2, P, S, n). Where they are few
    enough, the states at the first points are cached, for longer responses of the same oscillators.
    """
    if not oscillators.number:
        return
    points = answers.shape[2]
    frequencies = oscillators.angular_frequency.tobytes()
    ratios = oscillators.damping_ratio.tobytes()
    state_weights = np.concatenate(list(weights), axis=-1)  # (P, S, 2 n)
    # a port that a single mode moves needs the states of that alone
    states_of_ports = [np.flatnonzero(port) for port in np.asarray(state_weights.any(axis=1))]
    if 2 * oscillators.number * points <= _CACHED_SIZE:
        blocks: Iterable[tuple[int, Floats]] = [
            (0, _cached_states(frequencies, ratios, rate, cached_points))
        ]
    else:
        blocks = _states(frequencies, ratios, rate, points)
    for begin, states in blocks:
        count = min(states.shape[1], points - begin)
        for answer, weight, moving in zip(answers, state_weights, states_of_ports, strict=True):
            answer[:, begin : begin + count] += weight[:, moving] @ states[moving, :count]


def _states(
    frequencies: bytes, ratios: bytes, rate: float, count: int
) -> Iterator[tuple[int, Floats]]:
    """Yield the states (2 n, points) of oscillators of shape one driven by a converter's kernel.

    These are displacements, then velocities, at `FINENESS` points per sample from the beginning of
    the kernel on, in blocks with the index of the first point.
    """
    oscillators = Oscillators(
        np.frombuffer(frequencies), np.frombuffer(ratios), np.ones(len(frequencies) // 8)
    )
    step = 1.0 / (FINENESS * rate)
    kernel_cells = 2 * HALF_LENGTH * FINENESS
    increments = _kernel_increments(oscillators, rate, step, kernel_cells)
    transition = oscillators.transition(step * np.arange(1.0, _ROWS + 1.0))  # (2, 2, rows, n)
    state = np.zeros((2, oscillators.number))
    for begin in range(0, count, _ROWS):
        rows = min(_ROWS, count - begin)
        if begin > kernel_cells:  # free motion after the kernel
            states = transition[:, 0, :rows] * state[0] + transition[:, 1, :rows] * state[1]
        else:
            states = np.empty((2, rows, oscillators.number))
            for row in range(rows):
                cell = begin + row - 1
                if cell >= 0:
                    state = transition[:, 0, 0] * state[0] + transition[:, 1, 0] * state[1]
                    if cell < kernel_cells:
                        state += increments[cell]
                states[:, row] = state
        state = states[:, -1]
        yield begin, states.swapaxes(1, 2).reshape(2 * oscillators.number, rows)


@lru_cache(maxsize=8)
def _cached_states(frequencies: bytes, ratios: bytes, rate: float, count: int) -> Floats:
    """Return `_states` in one block, cached for drops on the same plate."""
    blocks = [states for _, states in _states(frequencies, ratios, rate, count)]
    return np.concatenate(blocks, axis=1)


def _next_power_of_two(number: int) -> int:
    """Return the least power of two that is not below a number."""
    return 1 << (number - 1).bit_length()


def filter_gains(oscillators: Oscillators, rate: float) -> Floats:
    """Return the gains of a converter's filter for the free motion of oscillators, (2, n).

    They give the output `HALF_LENGTH` samples later.
    """
    return _gains(
        oscillators.angular_frequency.tobytes(), oscillators.damping_ratio.tobytes(), rate
    )


@lru_cache(maxsize=64)
def _gains(frequencies: bytes, ratios: bytes, rate: float) -> Floats:
    """Return `filter_gains`, cached."""
    # the state at the end of the kernel
    *_, (_, states) = _states(frequencies, ratios, rate, 2 * HALF_LENGTH * FINENESS + 1)
    displacement, velocity = np.split(states[:, -1], 2)
    damping = 2.0 * np.frombuffer(ratios) * np.frombuffer(frequencies)
    return np.stack([velocity + damping * displacement, displacement])


def _correlate(responses: Floats, weights: Floats) -> Floats:
    """Return the correlation of responses (S, points) with weights (w,), (S, samples).

    It is given at every `FINENESS`-th point.
    """
    width = len(weights)
    points = responses.shape[1]
    if width < _WIDE:
        windows = sliding_window_view(responses, width, axis=1)
        return np.asarray(windows[:, ::FINENESS] @ weights)
    size = 1 << (points + width - 1).bit_length()
    spectrum = np.fft.rfft(responses, size) * np.fft.rfft(weights[::-1], size)
    return np.asarray(np.fft.irfft(spectrum, size)[:, width - 1 : points : FINENESS])


def _kernel_increments(oscillators: Oscillators, rate: float, step: float, cells: int) -> Floats:
    """Return the increments of the states of oscillators by the kernel, (cells, 2, n).

    The oscillators have shape one; the increments of displacement and velocity are those in each
    cell of the kernel between two points.
    """
    fastest = float(
        (oscillators.angular_frequency * np.maximum(1.0, 2.0 * oscillators.damping_ratio)).max()
    )
    x, weights = gauss_rule(min(fastest * step, _MOST_RADIANS))
    cosine, sine = oscillators.propagators(step * (1.0 - x))
    times = (np.arange(cells)[:, None] + x) / FINENESS - HALF_LENGTH  # in samples
    impulses = kernel(times) * (weights * step * rate)
    return np.stack([impulses @ sine, impulses @ (cosine - oscillators.damping * sine)], axis=1)


def _spread_on_grid(positions: Floats, amounts: Floats) -> tuple[int, Floats]:
    """Return amounts at positions spread over integer points: the first point, and the values.

    It is the transpose of Lagrange interpolation.
    """
    points, shares = lagrange_shares(positions)
    first = int(points.min())
    spread = np.bincount((points - first).ravel(), weights=(shares * amounts[:, None]).ravel())
    return first, np.asarray(spread, dtype=np.float64)
