r"""Samples of a microphone: the accelerations of the modes, each through its paths of sound and the
anti-alias filter.

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
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH, kernel
from vibroimpact.dynamics.sensors.filtered_chain import FilteredChain, filtered_chain
from vibroimpact.dynamics.sensors.left_out import next_octave
from vibroimpact.dynamics.sensors.measuring_chain import measuring_chain
from vibroimpact.dynamics.sensors.ports import Ports
from vibroimpact.dynamics.sensors.sampled import (
    around_first_contact,
    outputs_around_first_contact,
    response_length,
    sample_filtered,
)
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.dynamics.vibrating.oscillators import Oscillators
from vibroimpact.dynamics.vibrating.vibrating_bodies import bases_of_plate

if TYPE_CHECKING:
    from vibroimpact.dynamics.vibrating.segments import VibratingSegment

_FINER = 2
"""Rate of the accelerations over that of the samples: their images then lie beyond the filter."""
_KEPT = 1e-9
"""Least singular value that is kept, relative to the largest."""
_AT_ONCE = 16
"""Combinations of modes that are sampled at once, for memory."""


@dataclass(frozen=True)
class _Kernels:
    """Kernels of the modes as products: weights of the modes (r, modes), and kernels (r,
    lags) from a first lag on, in finer samples.
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
    """Return the samples of a microphone over the gain of its instrument, (count,), and their
    relative error by the modes left out.

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
    kernels, rate = _kernels(problem, sensor), _FINER * sensor.rate
    # a sample of acceleration sees a little of what comes later: the samples begin before the run
    late = HALF_LENGTH / rate
    later = [
        replace(segment, start=segment.start + late, end=segment.end + late) for segment in segments
    ]
    finer = max(0, _FINER * (count - 1) - kernels.first + HALF_LENGTH + 1)
    sum_of_all = np.zeros(finer + kernels.lags.shape[1] - 1)
    for begin in range(0, len(kernels.shapes) if finer else 0, _AT_ONCE):
        part = slice(begin, begin + _AT_ONCE)
        accelerations = sample_filtered(
            _chain(plate, kernels.shapes[part], rate, later), ports, later, range(finer)
        )
        sum_of_all += _through(accelerations, kernels.lags[part])
    ahead = HALF_LENGTH - kernels.first
    samples = np.pad(sum_of_all, (max(0, -ahead), 0))[max(0, ahead) :: _FINER][:count]
    return np.pad(samples, (0, count - len(samples))), _uncertainty(
        kernels, plate, ports, segments, rate
    )


def _uncertainty(
    kernels: _Kernels,
    plate: Oscillators,
    ports: Ports,
    segments: Sequence[VibratingSegment],
    rate: float,
) -> float:
    """Return the sound of the modes left out of the next octave, as an estimate, relative
    to that of the modes around the first contact.
    """
    norms, around = [], around_first_contact(segments, rate)
    for modes, shapes in ((plate, kernels.shapes), next_octave(plate, kernels.shapes)):
        accelerations = outputs_around_first_contact(
            _chain(modes, shapes, rate, segments), ports, segments, around
        )
        norms.append(
            float(np.linalg.norm(_through(accelerations, kernels.lags)))
            if accelerations.size
            else 0.0
        )
    return norms[1] / norms[0] if norms[0] else 0.0


def _chain(
    plate: Oscillators, shapes: Floats, rate: float, segments: Sequence[VibratingSegment]
) -> FilteredChain:
    """Return the chain to accelerations of combinations of modes behind a converter's filter.

    What the modes left out do quasi-statically has no part in it: next to the contact, it moves
    hardly any air.
    """
    chain = measuring_chain(
        plate, shapes, np.zeros((len(plate.shape), len(shapes))), [2] * len(shapes), ()
    )
    return filtered_chain(
        chain, rate, response_length(segments, rate, around_first_contact(segments, rate))
    )


def _kernels(problem: Problem, sensor: Sensor) -> _Kernels:
    """Return the kernels of the modes for a microphone."""
    paths = [basis.sounds[sensor.name] for basis in bases_of_plate(problem)]
    delays = paths[0].delays * sensor.rate  # in samples
    first, last = (
        round(_FINER * (end + side * HALF_LENGTH))
        for end, side in ((delays[0], -1.0), (delays[-1], 1.0))
    )
    lags = np.arange(first, last + 1) / _FINER
    whole = (
        np.concatenate([path.weights for path in paths]) @ kernel(lags - delays[:, None]) / _FINER
    )
    modes, sizes, parts = np.linalg.svd(whole, full_matrices=False)
    kept = sizes > _KEPT * sizes[0]
    return _Kernels((modes[:, kept] * sizes[kept]).T, parts[kept], first)


def _through(accelerations: Floats, lags: Floats) -> Floats:
    """Return the sum of accelerations (r, samples) convolved with kernels (r, lags)."""
    from scipy.signal import fftconvolve

    return np.asarray(
        sum(fftconvolve(one, kernel) for one, kernel in zip(accelerations, lags, strict=True))
    )
