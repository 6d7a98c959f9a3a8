"""The points of a study: the values of its drops and their arrangement."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from math import prod

import numpy as np

from vibroimpact.studies.planning.axes import Values

SAMPLE = "sample"
"""The dimension of a study whose points do not form a grid."""


@dataclass(frozen=True, eq=False)
class Plan:
    """The points of a study.

    Parameters
    ----------
    design : str
        The name of the design that made them.
    columns : mapping of str to array
        By swept key the levels of a grid, with the last key varying fastest, else one value per
        point.
    is_grid : bool
        Whether the points are all combinations of the levels.
    labels : mapping of str to array, optional
        What else is known of each point, such as its class; it does not enter into the case.

    Examples
    --------
    >>> plan = Plan("grid", {"a": np.array([1.0, 2.0]), "b": np.array([5.0, 6.0, 7.0])}, True)
    >>> plan.dimensions, plan.size
    ({'a': 2, 'b': 3}, 6)
    >>> {key: values.tolist() for key, values in plan.points(2, 3).items()}
    {'a': [1.0, 2.0, 2.0], 'b': [7.0, 5.0, 6.0]}
    """

    design: str
    columns: Mapping[str, Values]
    is_grid: bool
    labels: Mapping[str, Values] = field(default_factory=dict)

    @property
    def dimensions(self) -> dict[str, int]:
        """The dimensions of the results and their lengths."""
        if self.is_grid:
            return {key: len(levels) for key, levels in self.columns.items()}
        return {SAMPLE: len(next(iter(self.columns.values())))}

    @property
    def size(self) -> int:
        """The number of points."""
        return prod(self.dimensions.values())

    def points(self, first: int, count: int) -> dict[str, Values]:
        """Return the values of `count` points from `first` on by swept key, (count,) each."""
        if not self.is_grid:
            return {key: values[first : first + count] for key, values in self.columns.items()}
        shape = tuple(self.dimensions.values())
        # for each key the index of its level at each point
        indices = np.unravel_index(np.arange(first, first + count), shape)
        points = {}
        for (key, levels), index in zip(self.columns.items(), indices, strict=True):
            points[key] = levels[index]
        return points

    def digest(self) -> str:
        """Return a fingerprint (SHA-256) of all points."""
        fingerprint = sha256(f"{self.design} {self.is_grid}".encode())
        for key, values in {**self.columns, **self.labels}.items():
            fingerprint.update(key.encode())
            if values.dtype == object:
                fingerprint.update(json.dumps(values.tolist()).encode())
            else:
                fingerprint.update(np.ascontiguousarray(values).tobytes())
        return fingerprint.hexdigest()
