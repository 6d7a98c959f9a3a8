"""The onset of a record, and its alignment there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.packets import find_packets
from vibroimpact.signals.record import Record


def from_onset(
    record: Record, duration: float, before: float = 0.0, threshold: float | None = None
) -> Record:
    """Cut a record to a window around its onset, the first touch.

    That is where its magnitude first reaches a threshold, once its baseline is removed. Windows of
    equal duration and rate have equal numbers of samples. Before the record and after it, they are
    filled with zeros.

    Parameters
    ----------
    record : Record
        The record.
    duration : float
        Length of the window [s].
    before : float, default 0
        The part of it that lies before the onset [s].
    threshold : float, optional
        Threshold of the envelope, in the unit of the record; by default a tenth of the largest
        value of the envelope.

    Returns
    -------
    Record
        The window. Of a record whose envelope stays below the threshold it is as if the onset was
        its first sample.

    Raises
    ------
    InputError
        If a sample is not finite, the window has no sample or the threshold is not above 0.

    Examples
    --------
    >>> tap = Record("geophone", [0.0, 0.0, 0.0, 8.0, -5.0, 2.0], 10e3, "V")
    >>> found = from_onset(tap, duration=4e-4, before=1e-4, threshold=6.0)
    >>> found.value.tolist(), found.start
    ([0.0, 8.0, -5.0, 2.0], 0.0002)
    """
    if not 0.0 < duration < np.inf:
        raise InputError(
            f"a window of {duration:g} s is not allowed; it must be greater than 0 and finite"
        )
    samples = round(duration * record.rate)
    if not 1 <= samples <= 2**31:
        raise InputError(
            f"a window of {duration:g} s has {samples} samples at {record.rate:g} Hz; it "
            "needs 1 to 2^31"
        )
    if not 0.0 <= before <= duration:
        raise InputError(f"{before:g} s before the onset do not lie in a window of {duration:g} s")
    clean = without_baseline(record)
    packets = find_packets(clean, threshold)
    onset = 0
    if len(packets.onset):
        onset = int(packets.onset[0])
    first = onset - round(before * record.rate)
    recorded = clean.recorded
    if recorded is not None:
        recorded = _window(recorded, first, samples)
    return replace(
        clean,
        value=_window(clean.value, first, samples),
        recorded=recorded,
        start=clean.start + first / clean.rate,
    )


def _window(value: Floats, first: int, samples: int) -> Floats:
    """Return so many samples from a first one on, with zeros before the record and after it."""
    inside = value[max(first, 0) : max(first + samples, 0)]
    zeros_before = max(-first, 0)
    return np.pad(inside, (zeros_before, samples - zeros_before - len(inside)))


def onset_time(record: Record, threshold: float | None = None) -> float:
    """Return the time at which the magnitude of a record first reaches a threshold [s].

    Its baseline is removed. The time is within the first of its `Packets`: the envelope tells that
    there is one, the signal when it begins.

    Parameters
    ----------
    record : Record
        The record.
    threshold : float, optional
        Threshold of the envelope, in the unit of the record; by default a tenth of the largest
        value of the envelope.

    Raises
    ------
    InputError
        If it never does, a sample is not finite or the threshold is not above 0.

    Examples
    --------
    >>> onset_time(Record("geophone", [0.0, 0.0, 0.0, 8.0, -5.0, 2.0], 10e3, "V"), threshold=6.0)
    0.0003
    """
    packets = find_packets(record, threshold)
    name = quoted(record.name)
    if len(packets.onset):
        return record.start + float(packets.onset[0]) / record.rate
    if threshold is not None:
        unit = "" if record.unit in ("", "1") else f" {record.unit}"
        raise InputError(f"the envelope of {name} stays below {threshold:g}{unit}; it has no onset")
    if not len(record.value):
        raise InputError(f"{name} has no samples; it has no onset")
    raise InputError(f"{name} is zero throughout; it has no onset")
