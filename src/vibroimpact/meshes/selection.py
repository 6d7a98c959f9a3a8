"""Selections of node or element numbers of a mesh file."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vibroimpact.arrays import Integers


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
        ranges = np.array(list(self.ranges), dtype=np.int64)
        starts, stops = (
            np.searchsorted(known, ranges[:, 0]),
            np.searchsorted(known, ranges[:, 1], side="right"),
        )
        unit_step = ranges[:, 2] == 1
        # ranges of step 1 by the cumulative sum of their starts and ends: thousands cost as much as
        # one
        ends = np.bincount(starts[unit_step], minlength=len(known) + 1) - np.bincount(
            stops[unit_step], minlength=len(known) + 1
        )
        chosen = np.cumsum(ends[:-1]) > 0
        chosen[places] = True
        others = (part[~unit_step].tolist() for part in (ranges, starts, stops))
        for (first, _, step), start, stop in zip(*others, strict=True):
            chosen[start:stop] |= (known[start:stop] - first) % step == 0
        return np.flatnonzero(chosen)

    def update(self, other: Selection) -> None:
        """Add another selection."""
        self.numbers |= other.numbers
        self.ranges |= other.ranges
