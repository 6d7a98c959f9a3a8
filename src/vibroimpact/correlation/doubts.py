"""What is not sure about a correlation, and why."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vibroimpact.correlation.acquired import Acquired
from vibroimpact.dynamics.problem import Problem
from vibroimpact.shown import shown
from vibroimpact.signals.block import Block
from vibroimpact.signals.delay import Delay
from vibroimpact.signals.features.clipping import FAMILY as CLIPPING

_ALIKE = 0.7
"""Correlation coefficient below which the delay may be off by a period."""
_TOGETHER = 0.5
"""Delay behind a force of the same acquisition that is none, in samples."""
_SOFT = 0.1
"""Part of the force's spectrum at low frequencies below which it excites nothing."""


def doubts_about(problem: Problem, acquired: Acquired, delay: Delay, band: tuple[float, float], over: float) -> Iterator[str]:
    """Yield the doubts about a correlation, one sentence each without its full stop.

    Parameters
    ----------
    problem : Problem
        The problem of the case.
    acquired : Acquired
        The records.
    delay : Delay
        How they were aligned.
    band : tuple of two floats
        The band of frequencies [Hz].
    over : float
        How long the force acts [s].
    """
    rates = {sensor.rate for sensor in problem.sensors if sensor.name in {one.name for one in acquired.sensors}} - {acquired.rate}
    if rates:
        others = ", ".join(f"{rate:g}" for rate in sorted(rates))
        words = "it was simulated at the rate of the records"
        yield f"the records have {acquired.rate:g} samples per second, and the case specifies {others}: {words}"
    of_sensors = acquired.recorded[: len(acquired.sensors)]
    parts = zip(acquired.sensors, acquired.value, of_sensors, delay.polarity, delay.correlation, strict=True)
    for sensor, value, recorded, sign, alike in parts:
        name = shown(sensor.name)
        if sign < 0.0:
            yield f"the record {name} has inverted polarity; its sign is changed"
        if alike < _ALIKE:
            yield f"the first parts of {name} and of its simulation differ (correlation {alike:.2f}): the delay may be wrong by a period"
        yield from _clipped(f"the record {name}", value, recorded, acquired.rate)
    if acquired.force is not None:
        yield from _of_force(acquired, delay, band, over)
    assert problem.plate.modes is not None
    highest = float(problem.plate.modes.frequencies[-1])
    if highest < band[1]:
        yield f"the modes of the case end at {highest:.5g} Hz, and the band at {band[1]:.5g} Hz: ask for more modes"


def _clipped(what: str, value: np.ndarray, recorded: np.ndarray, rate: float) -> Iterator[str]:
    part = float(CLIPPING.of(Block(value[None], rate, recorded=recorded[None]))[0, 0])
    if part > 0.0:
        yield f"{what} is clipped: {max(1, round(part * len(value)))} samples lie at its extremes; damping is estimated from what follows"


def _of_force(acquired: Acquired, delay: Delay, band: tuple[float, float], over: float) -> Iterator[str]:
    """Yield the doubts about the force of a hammer."""
    assert acquired.force is not None
    yield from _clipped("the force", acquired.force, acquired.recorded[-1], acquired.rate)
    if (delay.polarity < 0.0).all():
        yield "all records have inverted polarity: the sign of the force may be wrong"
    samples = delay.time * acquired.rate
    if abs(samples) > _TOGETHER:
        yield f"the records come {samples:.3g} samples later than computed from the force: the channels were not sampled simultaneously"
    if acquired.pulses > len(acquired.onsets):
        yield f"double hit of the hammer: there are {acquired.pulses} pulses of force in {len(acquired.onsets)} hits"
    begin = acquired.onsets[0]
    pulse = acquired.force[begin : begin + max(4, int(np.ceil(over * acquired.rate)) + 2)]
    spectrum = np.abs(np.fft.rfft(pulse, 4096))
    frequency = np.fft.rfftfreq(4096, 1.0 / acquired.rate)
    weak = frequency[(spectrum < _SOFT * spectrum[0]) & (frequency <= band[1])]
    if len(weak):
        yield f"the spectrum of the force has fallen by 20 dB at {weak[0]:.4g} Hz; use a harder tip, or a band that ends there"
