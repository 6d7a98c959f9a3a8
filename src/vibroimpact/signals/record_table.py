"""Features of records of any lengths, rates and units: what `vibroimpact features` writes."""

from __future__ import annotations

import csv
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from io import StringIO

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.registry import find_named
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.feature_table import features_at_rest
from vibroimpact.signals.packets import DEAD_TIME, check_settings
from vibroimpact.signals.reasons import Reason
from vibroimpact.signals.record import Record, Removed, recorded_samples
from vibroimpact.signals.registry import find_feature, signal_features

_SAMPLES_AT_ONCE = 2**20
"""Samples that are put together for one table."""
_ROWS_AT_ONCE = 1000
"""Rows that are written at once."""
_NOTHING = Removed(0.0, 0.0)
"""The baseline of a record from which none was removed."""


@dataclass(frozen=True)
class RecordTable:
    """Features of records, a row each.

    Parameters
    ----------
    records : list of Record
        The records, without their samples; `removed` of each has the mean and the span of the
        baseline that was removed.
    names : tuple of str
        Names of the features.
    values : array, shape (records, features)
        The values, in the units `signal_features()[name].unit_for(record.unit)`; NaN where there is
        none.
    reasons : array of int, shape (records, features)
        Why there is none, as members of `Reason`; 0 where there is one.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> table = vi.signals.record_table(
    ...     [vi.signals.Record("a", np.sin(np.arange(100)), 1e3, "V")], ["rms", "peak"]
    ... )
    >>> table.names, table.values.round(2).tolist()
    (('rms', 'peak'), [[0.71, 1.0]])
    >>> table["peak"].round(2).tolist()
    [1.0]
    """

    records: list[Record]
    names: tuple[str, ...]
    values: Floats
    reasons: NDArray[np.int8]

    def __getitem__(self, name: str) -> Floats:
        """Return the values of a feature, (records,)."""
        columns = {feature: column for column, feature in enumerate(self.names)}
        return self.values[:, find_named("feature", name, columns)]

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the features, with their units at the end if these are not of the signals."""
        return tuple(column_name(name) for name in self.names)

    def lacking(self, record: int) -> str:
        """Return why a record has no value of some features, in words.

        For instance: "there are fewer than two packets: peak_ratio".
        """
        by_reason: dict[int, list[str]] = {}
        for name, code in zip(self.names, self.reasons[record], strict=True):
            if code:
                by_reason.setdefault(int(code), []).append(name)
        sentences = []
        for code, names in by_reason.items():
            which = " ".join(names)
            if len(names) == len(self.names):
                which = "all"
            sentences.append(f"{Reason(code).text}: {which}")
        return "; ".join(sentences)

    @property
    def offset(self) -> list[float]:
        """Mean of the baseline that was removed from each record, in its unit."""
        return [(record.removed or _NOTHING).offset for record in self.records]

    @property
    def drift(self) -> list[float]:
        """Span of the baseline that was removed from each record, in its unit."""
        return [(record.removed or _NOTHING).drift for record in self.records]

    @property
    def numbers(self) -> list[int]:
        """Number of each record among those of its file and channel, from 1."""
        counts: Counter[tuple[str, str]] = Counter()
        numbers = []
        for record in self.records:
            channel = (record.source, record.name)
            counts[channel] += 1
            numbers.append(counts[channel])
        return numbers

    def csv_text(self) -> Iterator[bytes]:
        """Yield the table as CSV, many rows at a time.

        A cell is empty where there is no value, and the last one has the reasons.
        """
        header = (
            "file",
            "channel",
            "signal",
            "start_s",
            "rate_Hz",
            "unit",
            *self.columns,
            "offset",
            "drift",
            "lacking",
        )
        yield (",".join(header) + "\n").encode()
        numbers = self.numbers
        offset = self.offset
        drift = self.drift
        for first in range(0, len(self.records), _ROWS_AT_ONCE):
            text = StringIO()
            writer = csv.writer(text, lineterminator="\n")
            for row, record in enumerate(self.records[first : first + _ROWS_AT_ONCE], first):
                cells = [_cell(value) for value in self.values[row].tolist()]
                writer.writerow(
                    (
                        record.source,
                        record.name,
                        numbers[row],
                        record.start,
                        record.rate,
                        record.unit,
                        *cells,
                        repr(offset[row]),
                        repr(drift[row]),
                        self.lacking(row),
                    )
                )
            yield text.getvalue().encode()


def column_name(name: str) -> str:
    """Return the header of a column: the name of the feature with its unit at the end.

    The unit of the signal is left out.

    Examples
    --------
    >>> (
    ...     column_name("rise_time"),
    ...     column_name("zero_crossing_rate"),
    ...     column_name("peak"),
    ...     column_name("energy"),
    ... )
    ('rise_time_s', 'zero_crossing_rate_1_s', 'peak', 'energy')
    """
    feature = find_feature(name)
    if feature.degree or feature.unit == "1":
        return name
    return f"{name}_{feature.unit.replace('/', '_')}"


def _cell(value: float) -> str:
    return "" if math.isnan(value) else repr(value)


def record_table(
    records: Iterable[Record],
    names: Sequence[str] | None = None,
    *,
    threshold: float | None = None,
    dead_time: float = DEAD_TIME,
    progress: Callable[[int], None] | None = None,
) -> RecordTable:
    """Return the features of records without their baselines, a row each.

    Neighbours of one length and rate are computed together.

    Parameters
    ----------
    records : iterable of Record
        The records; their samples are not kept.
    names, threshold, dead_time
        As those of `feature_table`.
    progress : callable, optional
        Called with the number of records that are done.

    Raises
    ------
    InputError
        If a name or a setting is not allowed, or a record can't be read.

    Examples
    --------
    >>> table = record_table(
    ...     [Record("a", np.sin(np.arange(100)), 1e3, "V"), Record("b", [], 1e3, "N")],
    ...     ["rms", "kurtosis"],
    ... )
    >>> table.values.round(2).tolist(), table.lacking(1)
    ([[0.71, 1.5], [nan, nan]], 'there are no samples: all')
    """
    if names is None:
        names = list(signal_features())
    wanted = {name: find_feature(name) for name in names}
    check_settings(threshold, dead_time)
    rows: list[Record] = []
    values = [np.empty((0, len(wanted)))]
    reasons = [np.empty((0, len(wanted)), dtype=np.int8)]
    for block in _blocks(without_baseline(record) for record in records):
        signals = np.array([record.value for record in block])
        recorded = np.array([recorded_samples(record) for record in block])
        block_values, block_reasons = features_at_rest(
            signals, recorded, block[0].rate, wanted, threshold, dead_time
        )
        values.append(block_values)
        reasons.append(block_reasons)
        rows += [replace(record, value=np.empty(0), recorded=None) for record in block]
        if progress is not None:
            progress(len(rows))
    return RecordTable(rows, tuple(wanted), np.concatenate(values), np.concatenate(reasons))


def _blocks(records: Iterable[Record]) -> Iterator[list[Record]]:
    """Yield neighbours of one length and rate, so many samples at once."""
    block: list[Record] = []
    for record in records:
        samples = len(record.value)
        if block and (samples != len(block[0].value) or record.rate != block[0].rate):
            yield block
            block = []
        block.append(record)
        if len(block) >= max(1, _SAMPLES_AT_ONCE // max(1, samples)):
            yield block
            block = []
    if block:
        yield block
