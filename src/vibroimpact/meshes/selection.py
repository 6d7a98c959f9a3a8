"""Selections of node or element numbers of a mesh file."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vibroimpact.arrays import Bools, Integers


@dataclass
class Selection:
    """A selection of node or element numbers: single numbers, and ranges (first, last, step).

    Ranges are expanded only against the existing numbers, so that "1 to 10^12" costs nothing.

    Parameters
    ----------
    numbers : set of int
        Single numbers.
    ranges : set of (int, int, int)
        Ranges.
    unsorted : bool
        Whether the file gives the order of its members a meaning, which is not kept.

    Examples
    --------
    >>> Selection({7}, {(2, 10**12, 2)}).places(np.array([1, 2, 3, 4, 7])).tolist()
    [1, 3, 4]
    """

    numbers: set[int] = field(default_factory=set)
    ranges: set[tuple[int, int, int]] = field(default_factory=set)
    unsorted: bool = False

    def places(self, known: Integers) -> Integers:
        """Return the indices of the selected numbers in `known`, which is sorted."""
        numbers = np.fromiter(self.numbers, np.int64, len(self.numbers))
        places = np.minimum(np.searchsorted(known, numbers), len(known) - 1).astype(np.int64)
        places = np.sort(places[known[places] == numbers])
        if not self.ranges:  # avoid arrays of the size of `known`: there may be many small sets
            return places
        is_selected = self._in_ranges(known)
        is_selected[places] = True
        return np.flatnonzero(is_selected)

    def _in_ranges(self, known: Integers) -> Bools:
        """Return which of some numbers, sorted, the ranges select."""
        ranges = np.array(list(self.ranges), dtype=np.int64)
        first, last, step = ranges.T
        starts = np.searchsorted(known, first)
        stops = np.searchsorted(known, last, side="right")
        # ranges of step 1 by the cumulative sum of their starts and ends: thousands cost as much as
        # one
        has_unit_step = step == 1
        number = len(known) + 1
        begun = np.bincount(starts[has_unit_step], minlength=number)
        ended = np.bincount(stops[has_unit_step], minlength=number)
        open_ranges = np.cumsum(begun - ended)[:-1]
        is_selected = open_ranges > 0
        for index in np.flatnonzero(~has_unit_step).tolist():
            within = slice(starts[index], stops[index])
            steps_from_first = known[within] - first[index]
            is_selected[within] |= steps_from_first % step[index] == 0
        return is_selected

    def update(self, other: Selection) -> None:
        """Add another selection."""
        self.numbers |= other.numbers
        self.ranges |= other.ranges
