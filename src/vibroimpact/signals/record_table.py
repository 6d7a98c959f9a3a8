"""Features of records of any lengths, rates and units: what `vibroimpact features` writes."""

from __future__ import annotations

import csv
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from io import StringIO
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.registry import find_named
from vibroimpact.signals.baseline import without_baseline
from vibroimpact.signals.feature_table import features_at_rest
from vibroimpact.signals.packets import DEAD_TIME, check_settings
from vibroimpact.signals.reasons import Reason
from vibroimpact.signals.record import Record
from vibroimpact.signals.registry import features, find_feature

_AT_ONCE = 2**20
"""Samples that are put together for one table."""


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
        The values, in the units `features()[name].unit_for(record.unit)`; NaN where there is none.
    reasons : array of int, shape (records, features)
        Why there is none, as members of `Reason`; 0 where there is one.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> table = vi.record_table([vi.Record("a", np.sin(np.arange(100)), 1e3, "V")], ["rms", "peak"])
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
        return self.values[
            :, find_named("feature", name, {one: place for place, one in enumerate(self.names)})
        ]

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the features with their units at the end, where these are not those of
        the signals.
        """
        return tuple(column_name(name) for name in self.names)

    def lacking(self, record: int) -> str:
        """Return why a record has no value of some features, in words: "there are fewer
        than two packets: peak_ratio".
        """
        by_reason: dict[int, list[str]] = {}
        for name, code in zip(self.names, self.reasons[record], strict=True):
            if code:
                by_reason.setdefault(int(code), []).append(name)
        return "; ".join(
            f"{Reason(code).text}: {'all' if len(names) == len(self.names) else ' '.join(names)}"
            for code, names in by_reason.items()
        )

    @property
    def offset(self) -> list[float]:
        """Mean of the baseline that was removed from each record, in its unit."""
        return [0.0 if one.removed is None else one.removed.offset for one in self.records]

    @property
    def drift(self) -> list[float]:
        """Span of the baseline that was removed from each record, in its unit."""
        return [0.0 if one.removed is None else one.removed.drift for one in self.records]

    @property
    def numbers(self) -> list[int]:
        """Number of each record among those of its file and channel, from 1."""
        counts: Counter[tuple[str, str]] = Counter()
        found = []
        for record in self.records:
            counts[record.source, record.name] += 1
            found.append(counts[record.source, record.name])
        return found

    def csv_text(self) -> Iterator[bytes]:
        """Yield the table as CSV, many rows at a time: an empty cell where there is no
        value, and the reasons in the last one.
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
        for first in range(0, len(self.records), 1000):
            text = StringIO()
            writer = csv.writer(text, lineterminator="\n")
            for row, one in enumerate(self.records[first : first + 1000], first):
                cells = [
                    "" if math.isnan(value) else repr(value) for value in self.values[row].tolist()
                ]
                removed = [repr(value) for value in (self.offset[row], self.drift[row])]
                writer.writerow(
                    (
                        one.source,
                        one.name,
                        numbers[row],
                        one.start,
                        one.rate,
                        one.unit,
                        *cells,
                        *removed,
                        self.lacking(row),
                    )
                )
            yield text.getvalue().encode()


def column_name(name: str) -> str:
    """Return the header of a column: the name of the feature with its unit at the end, apart from
    that of the signal.

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
    return (
        name
        if feature.degree or feature.unit == "1"
        else f"{name}_{feature.unit.replace('/', '_')}"
    )


def record_table(
    records: Iterable[Record],
    names: Sequence[str] | None = None,
    *,
    threshold: float | None = None,
    dead_time: float = DEAD_TIME,
    progress: Callable[[int], None] | None = None,
) -> RecordTable:
    """Return the features of records without their baselines, a row each; neighbours of one length
    and rate are computed together.

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
    wanted = {name: find_feature(name) for name in (features() if names is None else names)}
    check_settings(threshold, dead_time)
    rows: list[Record] = []
    values, reasons = [np.empty((0, len(wanted)))], [np.empty((0, len(wanted)), dtype=np.int8)]
    clean = (without_baseline(one) for one in records)
    for (length, rate), alike in groupby(clean, key=lambda one: (len(one.value), one.rate)):
        for some in _parts(alike, max(1, _AT_ONCE // max(1, length))):
            signals = np.array([one.value for one in some])
            recorded = np.array(
                [one.value if one.recorded is None else one.recorded for one in some]
            )
            found, why = features_at_rest(signals, recorded, rate, wanted, threshold, dead_time)
            values.append(found)
            reasons.append(why)
            rows += [replace(one, value=np.empty(0), recorded=None) for one in some]
            if progress is not None:
                progress(len(rows))
    return RecordTable(rows, tuple(wanted), np.concatenate(values), np.concatenate(reasons))


def _parts(records: Iterator[Record], most: int) -> Iterator[list[Record]]:
    """Yield records by so many at once."""
    some: list[Record] = []
    for record in records:
        some.append(record)
        if len(some) == most:
            yield some
            some = []
    if some:
        yield some
