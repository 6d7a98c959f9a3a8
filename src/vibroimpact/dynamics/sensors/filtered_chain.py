r"""A measuring chain under the linear-phase filter of a converter, exactly: nothing is sampled but the output.

With the kernel h of the filter, of reach T, and the chain's answer k to an impulse of force, an output is

.. math:: y(t) = \int h(\sigma)\, x(t - \sigma)\, d\sigma = y_0(t) - \int_{t - T} K(t - \tau)\, F(\tau)\, d\tau,\qquad K = h * k

where :math:`y_0` is what the oscillators would give of their state at t - T alone. For that each has its own gain. K is as smooth as
the filter is narrow, however fast the modes and however sharp the contact, so that a table of it serves for every contact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import FINENESS, REACH, kernel, kernel_derivatives
from vibroimpact.dynamics.sensors.measuring_chain import MeasuringChain
from vibroimpact.dynamics.sensors.pulses import gauss_rule
from vibroimpact.dynamics.vibrating.oscillators import Oscillators

_ROWS = 64
"""Points of the table that are made at once."""
_MOST_RADIANS = 5000.0
"""Of a mode between two points of the table that is followed: what is faster is far above the band, and hardly moves."""
_KEPT = 2_000_000
"""Numbers of a table of states that are kept for the next drop on the same plate: 16 MB."""
_WIDE = 1000
"""Points of impulses from which on transforms are quicker than sums."""
_LAGRANGE = np.arange(-2, 4)
"""Points of the table, beside one, between which it is interpolated."""
_CARDINAL = np.linalg.inv(np.vander(_LAGRANGE.astype(float)))
"""Coefficients of the polynomials that are one at one of these points and zero at the others, highest power first."""


@dataclass(frozen=True)
class FilteredChain:
    """A measuring chain with a converter's filter, at a rate.

    Parameters
    ----------
    chain : MeasuringChain
        What comes before the filter.
    rate : float
        Samples per second [Hz].
    outputs : array, shape (2, S, n)
        What displacements and velocities of the oscillators are worth in the outputs that are `REACH` samples later.
    answers : array, shape (S, points)
        The answer to an impulse of minus the force, `FINENESS` points a sample, from `REACH` samples before it on.
    """

    chain: MeasuringChain
    rate: float
    outputs: Floats
    answers: Floats

    def add(self, values: Floats, times: Floats, impulses: Floats, last: int) -> None:
        """Add what impulses [N s] at times [s] give to samples before the `last`; to `values` (S, samples), from the start on."""
        first, pushed = _on_points(times * (self.rate * FINENESS), impulses)
        width = len(pushed)
        begin = max(0, -((REACH * FINENESS - first) // FINENESS))  # the first sample that reaches so far ahead
        end = min(last, values.shape[1])
        if end <= begin:
            return
        at = begin * FINENESS - (first + width - 1) + REACH * FINENESS  # where in the answers the last point is, of the first sample
        before, after = max(0, -at), (end - 1 - begin) * FINENESS + at + width - self.answers.shape[1]
        answers = np.pad(self.answers, ((0, 0), (before, max(0, after))))
        answers = answers[:, at + before : at + before + (end - 1 - begin) * FINENESS + width]
        values[:, begin:end] -= _met(answers, pushed[::-1])


def filtered_chain(chain: MeasuringChain, rate: float, beyond: float) -> FilteredChain:
    """Return a chain under the filter of a converter.

    Parameters
    ----------
    chain : MeasuringChain
        What comes before the filter.
    rate : float
        Samples per second [Hz].
    beyond : float
        How long after the filter's reach the answer to an impulse is asked for [s].
    """
    of, pairs = chain.of, chain.pairs
    derivatives = kernel_derivatives()
    points, more = derivatives.shape[1], math.ceil(beyond * FINENESS * rate) + len(_LAGRANGE)
    weights = np.concatenate(list(chain.outputs * of.shape), axis=-1).T  # (2 n, S)
    answers = np.zeros((len(chain.direct), points + more))
    parts = (of.angular_frequency.tobytes(), of.damping_ratio.tobytes(), rate)
    kept = 2 * len(of.shape) * (points + more) <= _KEPT
    for begin, states in _kept_states(*parts, points + _rounded(more)) if kept else _states(*parts, points + more):
        rows = min(len(states), points + more - begin)
        if rows > 0:
            answers[:, begin : begin + rows] = (states[:rows] @ weights).T
    scaled = derivatives * rate ** np.arange(1.0, 4.0)[:, None]
    answers[:, :points] += chain.direct @ scaled
    return FilteredChain(chain, rate, pairs.product(chain.outputs, filter_gains(of, rate)), answers)


def _states(frequencies: bytes, ratios: bytes, rate: float, count: int) -> Iterator[tuple[int, Floats]]:
    """Yield displacements and velocities of oscillators of shape one, one after another (rows, 2 n), that a converter's kernel pushes.

    They are told at `FINENESS` points a sample, from the beginning of the kernel on; with the number of the first of each block.
    """
    of = Oscillators(np.frombuffer(frequencies), np.frombuffer(ratios), np.ones(len(frequencies) // 8))
    step, pushed = 1.0 / (FINENESS * rate), 2 * REACH * FINENESS
    later, drives = of.transition(np.array(step)), _drives(of, rate, step, pushed)
    state = np.zeros((2, len(of.shape)))
    for begin in range(0, count, _ROWS):
        states = np.empty((min(_ROWS, count - begin), 2 * len(of.shape)))
        for row in range(len(states)):
            cell = begin + row - 1
            if cell >= 0:
                state = later[:, 0] * state[0] + later[:, 1] * state[1]
                if cell < pushed:
                    state += drives[cell]
            states[row] = state.ravel()
        yield begin, states


@lru_cache(maxsize=8)
def _kept_states(frequencies: bytes, ratios: bytes, rate: float, count: int) -> tuple[tuple[int, Floats], ...]:
    """Return the same, which drops on the same plate have in common."""
    return tuple(_states(frequencies, ratios, rate, count))


def _rounded(number: int) -> int:
    """Return the next power of two, so that few lengths are kept."""
    return 1 << (number - 1).bit_length()


def filter_gains(of: Oscillators, rate: float) -> Floats:
    """Return what a converter's filter makes of the free motion of oscillators `REACH` samples later, (2, n) as in `pole_pairs`."""
    return _gains(of.angular_frequency.tobytes(), of.damping_ratio.tobytes(), rate)


@lru_cache(maxsize=64)
def _gains(frequencies: bytes, ratios: bytes, rate: float) -> Floats:
    *_, (_, states) = _states(frequencies, ratios, rate, 2 * REACH * FINENESS + 1)
    displacement, velocity = np.split(states[-1], 2)
    return np.stack([velocity + 2.0 * np.frombuffer(ratios) * np.frombuffer(frequencies) * displacement, displacement])


def _met(answers: Floats, weights: Floats) -> Floats:
    """Return the sums of neighbouring points of answers (S, points) by weights (w,), from every `FINENESS`-th point on: (S, samples)."""
    width, points = len(weights), answers.shape[1]
    if width < _WIDE:
        return np.asarray(sliding_window_view(answers, width, axis=1)[:, ::FINENESS] @ weights)
    size = 1 << (points + width - 1).bit_length()
    whole = np.fft.irfft(np.fft.rfft(answers, size) * np.fft.rfft(weights[::-1], size), size)
    return np.asarray(whole[:, width - 1 : points : FINENESS])


def _drives(of: Oscillators, rate: float, step: float, cells: int) -> Floats:
    """Return what the kernel adds to displacement and velocity of each oscillator of shape one in each of its cells, (cells, 2, n)."""
    fastest = float((of.angular_frequency * np.maximum(1.0, 2.0 * of.damping_ratio)).max())
    x, weights = gauss_rule(min(fastest * step, _MOST_RADIANS))
    cosine, sine = of.propagators(step * (1.0 - x))
    places = (np.arange(cells)[:, None] + x) / FINENESS - REACH
    pushes = kernel(places) * (weights * step * rate)
    return np.stack([pushes @ sine, pushes @ (cosine - of.damping * sine)], axis=1)


def _on_points(places: Floats, amounts: Floats) -> tuple[int, Floats]:
    """Return amounts at places shared out between whole numbers, as Lagrange's interpolation of what they meet: the first, and shares."""
    whole = np.floor(places).astype(int)
    shares = np.vander(places - whole, len(_LAGRANGE)) @ _CARDINAL
    first = int(whole.min()) + int(_LAGRANGE[0])
    shared = np.bincount((whole[:, None] + _LAGRANGE - first).ravel(), weights=(shares * amounts[:, None]).ravel())
    return first, np.asarray(shared, dtype=np.float64)
