"""The table `drops.csv` of a study: scalar results, one row per drop."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.cases.limits.limit import limits
from vibroimpact.dynamics.statement.outcome import OUTCOMES, Outcome
from vibroimpact.files.atomic_write import atomic_file
from vibroimpact.studies.computation.chunk_file import ChunkResult, chunk_layout, read_chunk
from vibroimpact.studies.computation.ledger import Span
from vibroimpact.studies.computation.write_dataset import Meanings, as_text
from vibroimpact.studies.planning.drop_variables import DOUBTS, OUTCOME, PEAKS, SENSOR_PEAK
from vibroimpact.studies.planning.plan import Plan

TABLE = "drops.csv"
MOST_ROWS = 1_000_000
"""Number of drops above which no table is written, as no program could display it."""


def write_drops(
    folder: Path, chunks: Sequence[Span], study: str, plan: Plan, meanings: Meanings
) -> None:
    """Write one row per drop.

    It holds the number, the values of the swept keys, the peaks, the outcome, the exceeded limits
    and the reason of failure.

    Parameters
    ----------
    folder, chunks, study, plan, meanings
        As for `write_dataset`.

    Raises
    ------
    OSError
        If it can't be written, such as on a full disk.
    """
    kept = {name for chunk in chunks for name in chunk_layout(folder, chunk.number)}
    peaks = [
        name for name in meanings if name in kept and (name in PEAKS or name.endswith(SENSOR_PEAK))
    ]
    headers = []
    for key in plan.columns:
        unit, _ = meanings[key]
        headers.append(key if unit == "1" else f"{key} [{unit}]")
    with (
        atomic_file(folder / TABLE) as working,
        working.open("w", newline="", encoding="utf-8") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["drop", *headers, *peaks, OUTCOME, DOUBTS, "reason"])
        for chunk in chunks:
            result = read_chunk(folder, chunk, study, {*peaks, OUTCOME, DOUBTS})
            writer.writerows(_rows(chunk, plan, result, peaks))


def _rows(
    chunk: Span, plan: Plan, result: ChunkResult, peaks: Sequence[str]
) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of the drops of a chunk."""
    # a chunk has no array of what none of its drops has, as where all of them failed
    arrays = {
        **dict.fromkeys(peaks, np.full(chunk.size, np.nan)),
        OUTCOME: np.full(chunk.size, Outcome.FAILED.code),
        DOUBTS: np.zeros(chunk.size, dtype=np.int32),
        **result.arrays,
    }
    columns: list[Sequence[Any]] = [range(chunk.first, chunk.first + chunk.size)]
    for values in plan.points(chunk.first, chunk.size).values():
        columns.append([as_text(value) for value in values.tolist()])
    for name in peaks:
        columns.append(_cells(arrays[name]))
    columns.append([OUTCOMES[code].value for code in arrays[OUTCOME]])
    columns.append(_exceeded_limits(arrays[DOUBTS].tolist()))
    columns.append([result.failures.get(drop, "") for drop in range(chunk.size)])
    yield from zip(*columns, strict=True)


def _exceeded_limits(masks: Sequence[int]) -> list[str]:
    """Return the names of the limits that each drop is beyond, whose bits are set."""
    names = {mask: _names_of_limits(mask) for mask in set(masks)}
    return [names[mask] for mask in masks]


def _names_of_limits(mask: int) -> str:
    return " ".join(name for bit, name in enumerate(limits()) if mask >> bit & 1)


def _cells(values: NDArray[Any]) -> list[Any]:
    """Return values as cells of the table; NaN, which differs from itself, is an empty cell."""
    return ["" if value != value else value for value in values.tolist()]
