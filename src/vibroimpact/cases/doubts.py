"""What to doubt of a drop: where its assumptions are strained, said by numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from vibroimpact.cases.conditions import Conditions, Seen
from vibroimpact.cases.limit import limits, numbers_of
from vibroimpact.dynamics.recording import Signal

_TRUNCATED = 0.05  # of the largest force
_CYCLES, _ENOUGH = 1.5, 3.0  # periods of the highest mode in a contact: too few, and enough


def doubts(case: Mapping[str, Any], seen: Seen) -> list[str]:
    """Return what to doubt of a drop of a case: the limits that it is beyond, each with a number, its cause and a remedy.

    Parameters
    ----------
    case : mapping
        A resolved case; an empty one gives no doubts.
    seen : Seen
        What came of the drop, or is expected of it.

    Examples
    --------
    >>> doubts({}, Seen())
    []
    """
    if not case:
        return []
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


def truncation_doubts(truncation: Mapping[str, float], frequencies: Mapping[str, Sequence[float]], duration: float) -> list[str]:
    """Return which bodies have too few modes for a contact.

    Parameters
    ----------
    truncation : mapping of str to float
        About how far the largest force is off, as a part of it, by the name of the body.
    frequencies : mapping of str to sequence of float
        Of the modes of each [Hz], ascending.
    duration : float
        Of the contact [s]; NaN where there is none.
    """
    found = []
    for body, part in truncation.items():
        highest = frequencies[body][-1]
        if part > _TRUNCATED or highest * duration < _CYCLES:
            found.append(
                f"the modes of the {body} end at {highest:.4g} Hz, and the contact lasts {duration:.3g} s: those left out may change the "
                f"largest force by up to {100.0 * part:.2g} %, and rebound and vibration by more; ask for "
                f'max_frequency = "{_ENOUGH / duration / 1e3:.3g} kHz" or so'
            )
    return found


def range_doubts(sensors: Sequence[Mapping[str, Any]], signals: Mapping[str, Signal]) -> list[str]:
    """Return which accelerometers were driven to the end of their range; `sensors` are those of a resolved case."""
    found = []
    for sensor in sensors:
        end, name = sensor.get("accelerometer", {}).get("range"), sensor["name"]
        clipped = int((abs(signals[name].value) >= end).sum()) if end is not None and name in signals else 0
        if clipped:
            found.append(f'the accelerometer of sensor "{name}" is driven to the end of its range, {end:g} m/s2, in {clipped} samples')
    return found
