"""Measured modes beside those of a case, as a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple


class MeasuredTable(NamedTuple):
    """Measured modes beside those of a case.

    `headers` and `cells` are the table of the page, `texts` the headers of its columns of words;
    `columns` and `rows` the table of `measured.csv`; and `doubts` what is not sure.
    """

    headers: Sequence[str]
    cells: Sequence[Sequence[str]]
    texts: Sequence[str]
    columns: Sequence[str]
    rows: Sequence[Mapping[str, Any]]
    doubts: Sequence[str]
