r"""Samples of a microphone: accelerations of modes through paths of sound and a filter.

With the paths of sound w of the modes, by delay, and the kernel h of the filter, the samples over
the density of the air are

.. math::

    y(t) = \sum_i \int k_i(\sigma)\,\ddot q_i(t - \sigma)\,d\sigma,\qquad
    k_i(\sigma) = \sum_g w_{ig}\,h(\sigma - \tau_g).

The kernels k are those of the filter, and as narrow in frequency: sums over accelerations sampled
`_FINER` times as often, behind a filter of that rate, are these integrals, and no delay has to lie
on a sample. As the delays are few, so are the k that are independent: by a singular value
decomposition they are combinations of a few, each with a combination of the modes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH, kernel
from vibroimpact.dynamics.sensors.filtered_chain import FilteredChain, filtered_chain
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.measuring_chain import measuring_chain, next_octave
from vibroimpact.dynamics.sensors.ports import Ports
from vibroimpact.dynamics.sensors.sampled import (
    around_first_contact,
    outputs_around_first_contact,
    response_length,
    sample_filtered,
)
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import bases_of_plate
from vibroimpact.dynamics.vibrating.oscillators import Oscillators

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment

_FINER = 2
"""Rate of the accelerations over that of the samples: their images then lie beyond the filter."""
_NEGLIGIBLE = 1e-9
"""Singular value, relative to the largest, below which a combination is left out."""
_AT_ONCE = 16
"""Combinations of modes that are sampled at once, for memory."""


@dataclass(frozen=True)
class _Kernels:
    """Kernels of the modes as products.

    `shapes`: weights of the modes (r, modes). `lags`: kernels (r, lags) from a first lag `first`
    on, in finer samples.
    """

    shapes: Floats
    lags: Floats
    first: int


def heard(
    problem: Problem,
    plate: Oscillators,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    sensor: Sensor,
    count: int,
) -> tuple[Floats, float]:
    """Return the samples of a microphone over the gain of its instrument, (count,).

    With their relative error by the modes left out.

    Parameters
    ----------
    problem : Problem
        The problem, whose modes know the paths of sound.
    plate : Oscillators
        The modes of the plate.
    ports, segments
        Where the contact forces act, and the history of one drop.
    sensor : Sensor
        The microphone.
    count : int
        Number of samples from the start on.
    """
    kernels = _kernels(problem, sensor)
    rate = _FINER * sensor.rate
    # a sample of acceleration sees a little of what comes later: the samples begin before the run
    lead = HALF_LENGTH / rate
    delayed = [
        replace(segment, start=segment.start + lead, end=segment.end + lead) for segment in segments
    ]
    finer_count = max(0, _FINER * (count - 1) - kernels.first + HALF_LENGTH + 1)
    pressure = np.zeros(finer_count + kernels.lags.shape[1] - 1)
    number = len(kernels.shapes) if finer_count else 0
    for begin in range(0, number, _AT_ONCE):
        combinations = slice(begin, begin + _AT_ONCE)
        chain = _chain(plate, kernels.shapes[combinations], rate, delayed)
        accelerations = sample_filtered(chain, ports, delayed, range(finer_count))
        pressure += _convolved(accelerations, kernels.lags[combinations])
    # number of the finer sample at the start of the run
    start = HALF_LENGTH - kernels.first
    samples = np.pad(pressure, (max(0, -start), 0))[max(0, start) :: _FINER][:count]
    samples = np.pad(samples, (0, count - len(samples)))
    return samples, _uncertainty(kernels, plate, ports, segments, rate)


def _uncertainty(
    kernels: _Kernels,
    plate: Oscillators,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    rate: float,
) -> float:
    """Return the sound of the modes left out of the next octave, as an estimate.

    It is relative to that of the modes around the first contact.
    """
    around = around_first_contact(segments, rate)

    def norm(modes: Oscillators, shapes: Floats) -> float:
        chain = _chain(modes, shapes, rate, segments)
        accelerations = outputs_around_first_contact(chain, ports, segments, around)
        if not accelerations.size:
            return 0.0
        return float(np.linalg.norm(_convolved(accelerations, kernels.lags)))

    norm_of_kept = norm(plate, kernels.shapes)
    norm_of_left_out = norm(*next_octave(plate, kernels.shapes))
    if not norm_of_kept:
        return 0.0
    return norm_of_left_out / norm_of_kept


def _chain(
    plate: Oscillators, shapes: Floats, rate: float, segments: Sequence[VibratingSegment]
) -> FilteredChain:
    """Return the chain to accelerations of combinations of modes behind a converter's filter.

    What the modes left out do quasi-statically has no part in it: next to the contact, it moves
    hardly any air.
    """
    ports = len(plate.shape)
    combinations = len(shapes)
    chain = measuring_chain(
        plate, shapes, np.zeros((ports, combinations)), [2] * combinations, sections=()
    )
    length = response_length(segments, rate, around_first_contact(segments, rate))
    return filtered_chain(chain, rate, length)


def _kernels(problem: Problem, sensor: Sensor) -> _Kernels:
    """Return the kernels of the modes for a microphone."""
    paths = [basis.sounds[sensor.name] for basis in bases_of_plate(problem)]
    weights = np.concatenate([path.weights for path in paths])
    delays = paths[0].delays * sensor.rate  # in samples
    first = round(_FINER * (delays[0] - HALF_LENGTH))
    last = round(_FINER * (delays[-1] + HALF_LENGTH))
    lags = np.arange(first, last + 1) / _FINER
    # k of the module, whose integrals are sums over finer samples
    of_delays = kernel(lags - delays[:, None])
    of_modes = weights @ of_delays / _FINER
    # as few of them are independent as there are delays
    modes, singular_values, combinations = np.linalg.svd(of_modes, full_matrices=False)
    kept = singular_values > _NEGLIGIBLE * singular_values[0]
    shapes = (modes[:, kept] * singular_values[kept]).T
    return _Kernels(shapes, combinations[kept], first)


def _convolved(accelerations: Floats, lags: Floats) -> Floats:
    """Return the sum of accelerations (r, samples) convolved with kernels (r, lags)."""
    from scipy.signal import fftconvolve

    return np.asarray(
        sum(
            fftconvolve(acceleration, kernel)
            for acceleration, kernel in zip(accelerations, lags, strict=True)
        )
    )
