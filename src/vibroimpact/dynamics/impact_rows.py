"""The impact table of a run while it grows, one row per impact."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vibroimpact.arrays import Floats

_FIRST = 4  # rows of the first block; each further block doubles the capacity


class ImpactRows:
    """Impact table of B drops; entries that a drop does not have are NaN.

    Parameters
    ----------
    columns : iterable of str
        The names of the columns.
    size : int
        Number of drops, B.

    Examples
    --------
    >>> rows = ImpactRows(["time_s"], 2)
    >>> rows.add()["time_s"][0] = 0.5
    >>> len(rows), rows.table()["time_s"].tolist()
    (1, [[0.5], [nan]])
    """

    def __init__(self, columns: Iterable[str], size: int) -> None:
        self._columns = tuple(columns)
        self._size = size
        self._blocks: list[Floats] = []  # (columns, rows, B)
        self._count = 0
        self._room = 0  # rows in all blocks

    def __len__(self) -> int:
        return self._count

    def add(self) -> dict[str, Floats]:
        """Append a row of NaN and return its columns (B,) for writing."""
        if self._count == self._room:
            rows = max(_FIRST, self._room)
            self._blocks.append(np.full((len(self._columns), rows, self._size), np.nan))
            self._room += rows
        self._count += 1
        return self._row(self._blocks[-1], self._count - 1 - self._room)

    @property
    def first(self) -> dict[str, Floats]:
        """The columns of the first row (B,)."""
        return self._row(self._blocks[0], 0)

    @property
    def last(self) -> dict[str, Floats]:
        """The columns of the last row (B,)."""
        return self._row(self._blocks[-1], self._count - 1 - self._room)

    def table(self) -> dict[str, Floats]:
        """Return the columns of all rows, (B, impacts)."""
        no_rows = np.zeros((len(self._columns), 0, self._size))
        table = np.concatenate([no_rows, *self._blocks], axis=1)[:, : self._count]
        return {name: column.T for name, column in zip(self._columns, table, strict=True)}

    def _row(self, block: Floats, number: int) -> dict[str, Floats]:
        return dict(zip(self._columns, block[:, number], strict=True))
