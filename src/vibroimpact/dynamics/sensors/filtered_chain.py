r"""A measuring chain with a converter's linear-phase filter, evaluated in closed form at the
samples only.

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
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS, HALF_LENGTH, kernel, kernel_derivatives
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain
from vibroimpact.dynamics.sensors.pulses import gauss_rule
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.structures.lagrange_shares import STENCIL, lagrange_shares

_ROWS = 64
"""Points of the table that are computed at once."""
_MOST_RADIANS = 5000.0
"""Largest phase of a mode between two points of the table that is resolved; faster modes
are far above the band, and hardly respond.
"""
_KEPT = 2_000_000
"""Largest table of states, in numbers, that is cached for the next drop on the same
plate: 16 MB.
"""
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
        """Weights of displacements and velocities of the oscillators in the outputs
        `HALF_LENGTH` samples later, (2, S, n).
        """
        return self.chain.pairs.product(
            self.chain.outputs, filter_gains(self.chain.oscillators, self.rate)
        )

    def add(
        self, values: Floats, port: int, times: Floats, impulses: Floats, last: int, origin: int = 0
    ) -> None:
        """Add the response to impulses at a port [N s] to `values` (S, samples) from
        sample `origin` on, for samples before `last`.
        """
        add_responses(values, self.answers[port], self.rate, times, -impulses, last, origin)


def add_responses(
    values: Floats,
    whole: Floats,
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
    whole : array, shape (S, points)
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
    first, spread = _spread_on_grid(times * (rate * FINENESS), impulses)
    first, last, width = first - origin * FINENESS, last - origin, len(spread)
    # the first sample whose kernel reaches the impulses
    begin = max(0, -((HALF_LENGTH * FINENESS - first) // FINENESS))
    end = min(last, values.shape[1])
    if end <= begin:
        return
    # index of the last impulse point in the responses
    at = begin * FINENESS - (first + width - 1) + HALF_LENGTH * FINENESS
    before, after = max(0, -at), (end - 1 - begin) * FINENESS + at + width - whole.shape[1]
    answers = np.pad(whole, ((0, 0), (before, max(0, after))))
    answers = answers[:, at + before : at + before + (end - 1 - begin) * FINENESS + width]
    values[:, begin:end] += _correlate(answers, spread[::-1])


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
    points, more = derivatives.shape[1], math.ceil(beyond * FINENESS * rate) + len(STENCIL)
    answers = np.zeros((*chain.direct.shape[:2], points + more))
    own = [chain.instrument_of(port) for port in range(len(answers))]
    of_plate = chain.outputs[:, None, :, : chain.modes] * chain.plate.shape[:, None]
    of_instrument = np.stack([chain.outputs[:, :, chain.modes :][:, :, one] for one in own], axis=1)
    _add_oscillators(answers, chain.plate, of_plate, rate, points + _rounded(more))
    # each port drives poles of its own, and all of these move alike
    _add_oscillators(
        answers, chain.instrument.pick(own[0]), of_instrument, rate, points + _rounded(more)
    )
    scaled = derivatives * rate ** np.arange(1.0, 4.0)[:, None]
    answers[:, :, :points] += chain.direct @ scaled
    return FilteredChain(chain, rate, answers)


def _add_oscillators(
    answers: Floats, oscillators: Oscillators, weights: Floats, rate: float, count: int
) -> None:
    """Add outputs of oscillators to answers (P, S, points), by the weights of displacements and
    velocities in them, (2, P, S, n).

    Where they are few enough, the states at the first `count` points are kept, for longer responses
    of the same oscillators.
    """
    if not oscillators.number:
        return
    parts = (oscillators.angular_frequency.tobytes(), oscillators.damping_ratio.tobytes(), rate)
    kept, points = 2 * oscillators.number * answers.shape[2] <= _KEPT, answers.shape[2]
    of_ports = np.concatenate(list(weights), axis=-1)  # (P, S, 2 n)
    # a port that a single mode sees needs that alone
    seen = [np.flatnonzero(one) for one in np.asarray(of_ports.any(axis=1))]
    for begin, states in _kept_states(*parts, count) if kept else _states(*parts, points):
        rows = min(states.shape[1], points - begin)
        for answer, weight, which in zip(answers, of_ports, seen, strict=True):
            answer[:, begin : begin + rows] += weight[:, which] @ states[which, :rows]


def _states(
    frequencies: bytes, ratios: bytes, rate: float, count: int
) -> Iterator[tuple[int, Floats]]:
    """Yield the states (2 n, points), displacements then velocities, of oscillators of shape one
    driven by a converter's kernel.

    They are given at `FINENESS` points per sample from the beginning of the kernel on, in blocks
    with the index of the first point.
    """
    oscillators = Oscillators(
        np.frombuffer(frequencies), np.frombuffer(ratios), np.ones(len(frequencies) // 8)
    )
    step, kernel_cells = 1.0 / (FINENESS * rate), 2 * HALF_LENGTH * FINENESS
    drives = _drives(oscillators, rate, step, kernel_cells)
    later = oscillators.transition(step * np.arange(1.0, _ROWS + 1.0))  # (2, 2, rows, n)
    state = np.zeros((2, oscillators.number))
    for begin in range(0, count, _ROWS):
        rows = min(_ROWS, count - begin)
        if begin > kernel_cells:  # the kernel has passed
            states = later[:, 0, :rows] * state[0] + later[:, 1, :rows] * state[1]
        else:
            states = np.empty((2, rows, oscillators.number))
            for row in range(rows):
                cell = begin + row - 1
                if cell >= 0:
                    state = later[:, 0, 0] * state[0] + later[:, 1, 0] * state[1]
                    if cell < kernel_cells:
                        state += drives[cell]
                states[:, row] = state
        state = states[:, -1]
        yield begin, states.swapaxes(1, 2).reshape(2 * oscillators.number, rows)


@lru_cache(maxsize=8)
def _kept_states(
    frequencies: bytes, ratios: bytes, rate: float, count: int
) -> tuple[tuple[int, Floats]]:
    """Return `_states` in one block, cached for drops on the same plate."""
    return (
        (
            0,
            np.concatenate(
                [states for _, states in _states(frequencies, ratios, rate, count)], axis=1
            ),
        ),
    )


def _rounded(number: int) -> int:
    """Return the next power of two, so that few lengths are cached."""
    return 1 << (number - 1).bit_length()


def filter_gains(oscillators: Oscillators, rate: float) -> Floats:
    """Return the gains of a converter's filter for the free motion of oscillators,
    `HALF_LENGTH` samples later, (2, n).
    """
    return _gains(
        oscillators.angular_frequency.tobytes(), oscillators.damping_ratio.tobytes(), rate
    )


@lru_cache(maxsize=64)
def _gains(frequencies: bytes, ratios: bytes, rate: float) -> Floats:
    """Return `filter_gains`, cached."""
    *_, (_, states) = _states(frequencies, ratios, rate, 2 * HALF_LENGTH * FINENESS + 1)
    displacement, velocity = np.split(states[:, -1], 2)
    return np.stack(
        [
            velocity + 2.0 * np.frombuffer(ratios) * np.frombuffer(frequencies) * displacement,
            displacement,
        ]
    )


def _correlate(answers: Floats, weights: Floats) -> Floats:
    """Return the correlation of responses (S, points) with weights (w,) at every
    `FINENESS`-th point, (S, samples).
    """
    width, points = len(weights), answers.shape[1]
    if width < _WIDE:
        return np.asarray(sliding_window_view(answers, width, axis=1)[:, ::FINENESS] @ weights)
    size = 1 << (points + width - 1).bit_length()
    transformed = np.fft.irfft(np.fft.rfft(answers, size) * np.fft.rfft(weights[::-1], size), size)
    return np.asarray(transformed[:, width - 1 : points : FINENESS])


def _drives(oscillators: Oscillators, rate: float, step: float, cells: int) -> Floats:
    """Return the increments of displacement and velocity of oscillators of shape one by
    the kernel in each of its cells, (cells, 2, n).
    """
    fastest = float(
        (oscillators.angular_frequency * np.maximum(1.0, 2.0 * oscillators.damping_ratio)).max()
    )
    x, weights = gauss_rule(min(fastest * step, _MOST_RADIANS))
    cosine, sine = oscillators.propagators(step * (1.0 - x))
    places = (np.arange(cells)[:, None] + x) / FINENESS - HALF_LENGTH
    pushes = kernel(places) * (weights * step * rate)
    return np.stack([pushes @ sine, pushes @ (cosine - oscillators.damping * sine)], axis=1)


def _spread_on_grid(places: Floats, amounts: Floats) -> tuple[int, Floats]:
    """Return amounts at places spread over integer points, as the transpose of Lagrange
    interpolation: the first point, and the values.
    """
    points, shares = lagrange_shares(places)
    first = int(points.min())
    shared = np.bincount((points - first).ravel(), weights=(shares * amounts[:, None]).ravel())
    return first, np.asarray(shared, dtype=np.float64)
