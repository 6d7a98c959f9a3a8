"""Packets: the parts of a record that stand above a threshold.

Those who measure bedload with plate geophones count them. A packet begins at the first sample at
which the envelope reaches the threshold, and ends with the last one before the envelope stays below
for a dead time. An envelope rises before the signal does, by a part of its period; the onset is
where the signal itself reaches the threshold, and its impulses are the upward crossings of the
signal. Rickenmann and McArdell (2007, Earth Surf. Process. Landforms 32:1362) count impulses; Wyss
and others (2016, Water Resour. Res. 52:7744) and Chen and others (2022, Earth Surf. Dynam. 10:279)
take packets, by the Hilbert envelope.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Bools, Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.envelope import hilbert_envelope
from vibroimpact.signals.record import Record

THRESHOLD = 0.1
"""Threshold where none is given, as part of the largest value of the envelope."""

DEAD_TIME = 5e-3
"""Dead time where none is given [s]."""


class Packets(NamedTuple):
    """Bursts (packets) of signals, in the order of signals and time, as arrays (packets,).

    Parameters
    ----------
    signal : array of int
        Number of the signal, from 0.
    first, last : array of int
        First and last sample at which the envelope reaches the threshold.
    onset : array of int
        First sample at which the magnitude of the signal does; that of the envelope if the samples
        miss it.
    peak : array
        Largest magnitude of the signal within it, in the unit of the signal.
    impulses : array of int
        Upward crossings of the threshold by the signal within it; a signal that begins above the
        threshold crosses it there.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> taps = vi.signals.Record(
    ...     "geophone", [0.0, 9.0, -9.0] + 200 * [0.0] + [0.0, 4.0, -4.0], 10e3, "V"
    ... )
    >>> found = vi.signals.find_packets(taps, threshold=2.0)
    >>> found.onset.tolist(), found.peak.round(1).tolist()
    ([1, 204], [9.0, 4.0])
    """

    signal: Integers
    first: Integers
    last: Integers
    onset: Integers
    peak: Floats
    impulses: Integers


def find_packets(
    record: Record, threshold: float | None = None, dead_time: float = DEAD_TIME
) -> Packets:
    """Find the bursts (packets) in a record whose baseline was removed.

    Parameters
    ----------
    record : Record
        The record.
    threshold : float, optional
        Threshold of the envelope, in the unit of the record; by default a tenth of the largest
        value of the envelope.
    dead_time : float, default 5e-3
        How long the envelope is below the threshold before a packet is over [s].

    Raises
    ------
    InputError
        If a sample is not finite, the threshold is not above 0, or the dead time is below 0.

    Examples
    --------
    >>> time = np.arange(2000) / 10e3
    >>> bursts = sum(
    ...     peak * np.sin(2e3 * np.pi * time) * ((time >= at) & (time < at + 0.01))
    ...     for peak, at in [(1.0, 0.02), (0.5, 0.1)]
    ... )
    >>> found = find_packets(Record("geophone", bursts, 10e3, "V"), threshold=0.2)
    >>> found.peak.round(2).tolist(), found.impulses.tolist()
    ([0.95, 0.48], [10, 10])
    """
    if not np.isfinite(record.value).all():
        raise InputError("a sample is not a finite number; packets are sought among finite ones")
    check_settings(threshold, dead_time)
    if not len(record.value):
        no_samples = record.value[None]
        return packets_in(no_samples, no_samples, np.ones(1), record.rate, dead_time)
    value = without_baseline(record).value[None]
    envelope = hilbert_envelope(value)
    level = threshold
    if level is None:
        level = THRESHOLD * float(envelope.max())
    return packets_in(value, envelope, np.array([level]), record.rate, dead_time)


def packet_records(
    record: Record, threshold: float | None = None, dead_time: float = DEAD_TIME
) -> list[Record]:
    """Return the packets of a record, without its baseline, as records of their own.

    Each reaches from the first sample of the packet to its last.

    Parameters
    ----------
    record, threshold, dead_time
        As those of `find_packets`.

    Raises
    ------
    InputError
        As `find_packets`.

    Examples
    --------
    >>> taps = Record(
    ...     "geophone", [0.0, 9.0, -9.0] + 200 * [0.0] + [0.0, 4.0, -4.0], 10e3, "V", start=1.0
    ... )
    >>> [round(packet.start, 6) for packet in packet_records(taps, threshold=2.0)]
    [1.0, 1.0203]
    """
    clean = without_baseline(record)
    packets = find_packets(clean, threshold, dead_time)
    records = []
    for first, last in zip(packets.first.tolist(), packets.last.tolist(), strict=True):
        samples = slice(first, last + 1)
        recorded = clean.recorded
        if recorded is not None:
            recorded = recorded[samples]
        start = clean.start + first / clean.rate
        records.append(replace(clean, value=clean.value[samples], recorded=recorded, start=start))
    return records


def check_settings(threshold: float | None, dead_time: float) -> None:
    """Raise InputError unless a threshold is above 0 (or None), and a dead time 0 or more."""
    if threshold is not None and not 0.0 < threshold < np.inf:
        raise InputError(
            f"the threshold is {threshold:g}; it must be finite and above 0, "
            "in the unit of the signal"
        )
    if not 0.0 <= dead_time < np.inf:
        raise InputError(f"the dead time is {dead_time:g} s; it must be finite, and 0 or more")


def packets_in(
    value: Floats, envelope: Floats, threshold: Floats, rate: float, dead_time: float
) -> Packets:
    """Return the packets of signals (n, samples) with their envelopes, by a threshold of each (n,).

    Envelopes that stay below the threshold for longer than the dead time [s] end a packet.
    """
    level = threshold[:, None]
    # a threshold of zero, of a signal that is zero throughout, is reached by nothing
    loud = (envelope >= level) & (level > 0.0)
    signal, first, last = _loud_spans(loud, rate, dead_time)

    # from here on samples are counted through all signals, one after the other
    samples = value.shape[1]
    begin = samples * signal + first
    end = samples * signal + last + 1

    magnitude = np.abs(value)
    reached = np.flatnonzero(magnitude >= level)
    first_reached = np.append(reached, value.size)[np.searchsorted(reached, begin)]
    onset = np.where(first_reached < end, first_reached - begin, 0) + first

    peak = np.empty(0)
    if len(begin):
        # the maxima within packets alternate with those between them; the zero behind the last
        # sample lets a packet end there
        edges = np.stack([begin, end], axis=1).ravel()
        peak = np.maximum.reduceat(np.append(magnitude, 0.0), edges)[::2]

    above = value >= level
    upward = above.copy()
    upward[:, 1:] &= ~above[:, :-1]
    crossings_before = np.append(0, np.cumsum(upward))
    impulses = crossings_before[end] - crossings_before[begin]
    return Packets(signal, first, last, onset, peak, impulses)


def _loud_spans(loud: Bools, rate: float, dead_time: float) -> tuple[Integers, Integers, Integers]:
    """Return signal, first and last sample of each packet of loud samples (n, samples).

    Loud samples of one signal that are no further apart than the dead time [s] are of one packet.
    """
    signal, sample = np.nonzero(loud)
    most_apart = max(1.0, round(min(dead_time * rate, loud.shape[1])))
    ends_before = (np.diff(sample) > most_apart) | (np.diff(signal) > 0)
    begins = np.append(True, ends_before)[: len(signal)]
    firsts = np.flatnonzero(begins)
    lasts = np.append(firsts[1:], len(signal))[: len(firsts)] - 1
    return signal[firsts], sample[firsts], sample[lasts]
