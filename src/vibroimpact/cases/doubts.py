"""What to doubt of a drop: where its assumptions are strained, said by numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from vibroimpact.cases.conditions import Conditions, Seen
from vibroimpact.cases.limit import limits, numbers_of
from vibroimpact.dynamics.recording import Signal


def doubts(case: Mapping[str, Any], seen: Seen) -> list[str]:
    """Return what to doubt of a drop of a case: the limits that it is beyond, each with a number, its cause and a remedy.

    Parameters
    ----------
    case : mapping
        A resolved case; empty of a problem made in Python, of which less can be told.
    seen : Seen
        What came of the drop, or is expected of it.

    Examples
    --------
    >>> doubts({}, Seen())
    []
    """
    drop = Conditions(case, seen)
    found = {name: float(number) for name, number in numbers_of(drop).items()}
    return [limits()[name].sentence(drop, number) for name, number in found.items() if number > limits()[name].threshold]


def sensor_doubts(signals: Iterable[Signal], frequencies: Sequence[float]) -> list[str]:
    """Return what to doubt of signals: which of them hold fewer modes than the plate has.

    Parameters
    ----------
    signals : iterable of Signal
        What sensors on the plate recorded.
    frequencies : sequence of float
        Of the modes of the plate [Hz], ascending.
    """
    return [
        f'sensor "{signal.sensor.name}" takes {signal.sensor.rate:g} samples per second, and the highest mode kept, of '
        f"{frequencies[-1]:.5g} Hz, needs more than {2.0 * frequencies[-1]:.5g}: {signal.left_out} of the {len(frequencies)} modes are "
        "left out of its signal"
        for signal in signals
        if signal.left_out
    ]


def range_doubts(sensors: Sequence[Mapping[str, Any]], signals: Mapping[str, Signal]) -> list[str]:
    """Return which accelerometers were driven to the end of their range; `sensors` are those of a resolved case."""
    found = []
    for sensor in sensors:
        end, name = sensor.get("accelerometer", {}).get("range"), sensor["name"]
        clipped = int((abs(signals[name].value) >= end).sum()) if end is not None and name in signals else 0
        if clipped:
            found.append(f'the accelerometer of sensor "{name}" is driven to the end of its range, {end:g} m/s2, in {clipped} samples')
    return found
