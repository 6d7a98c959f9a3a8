"""The table `drops.csv` of a study: scalar results, one row per drop."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.cases.limit import limits
from vibroimpact.dynamics.outcome import OUTCOMES, Outcome
from vibroimpact.files.atomic_write import atomic_file
from vibroimpact.studies.chunk_file import ChunkResult, chunk_layout, read_chunk
from vibroimpact.studies.drop_variables import DOUBTS, OUTCOME, PEAKS, SENSOR_PEAK
from vibroimpact.studies.ledger import Span
from vibroimpact.studies.plan import Plan
from vibroimpact.studies.write_dataset import Meanings, as_text

TABLE = "drops.csv"
MOST_ROWS = 1_000_000
"""Number of drops above which no table is written, as no program could display it."""


def write_drops(
    folder: Path, chunks: Sequence[Span], study: str, plan: Plan, meanings: Meanings
) -> None:
    """Write one row per drop: number, values of the swept keys, peaks, outcome, exceeded limits and
    reason of failure.

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
    keys = [
        key if meanings[key][0] == "1" else f"{key} [{meanings[key][0]}]" for key in plan.columns
    ]
    with (
        atomic_file(folder / TABLE) as working,
        working.open("w", newline="", encoding="utf-8") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["drop", *keys, *peaks, OUTCOME, DOUBTS, "reason"])
        for chunk in chunks:
            result = read_chunk(folder, chunk, study, {*peaks, OUTCOME, DOUBTS})
            writer.writerows(_rows(chunk, plan, result, peaks))


def _rows(
    chunk: Span, plan: Plan, result: ChunkResult, peaks: Sequence[str]
) -> Iterator[tuple[Any, ...]]:
    ended = result.arrays.get(OUTCOME, np.full(chunk.size, Outcome.FAILED.code))
    columns = [_cells(result.arrays.get(name, np.full(chunk.size, np.nan))) for name in peaks]
    points = [
        [as_text(value) for value in values.tolist()]
        for values in plan.points(chunk.first, chunk.size).values()
    ]
    numbers = range(chunk.first, chunk.first + chunk.size)
    reasons = [result.failures.get(place, "") for place in range(chunk.size)]
    beyond = result.arrays.get(DOUBTS, np.zeros(chunk.size, dtype=np.int32)).tolist()
    doubts = {
        mask: " ".join(name for bit, name in enumerate(limits()) if mask >> bit & 1)
        for mask in set(beyond)
    }
    outcomes = [OUTCOMES[code].value for code in ended]
    yield from zip(
        numbers,
        *points,
        *columns,
        outcomes,
        [doubts[mask] for mask in beyond],
        reasons,
        strict=True,
    )


def _cells(values: NDArray[Any]) -> list[Any]:
    return ["" if value != value else value for value in values.tolist()]
