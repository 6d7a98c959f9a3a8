"""The results of one chunk of drops, and the file that keeps them until the study is whole."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from vibroimpact.errors import ComputationError
from vibroimpact.files.atomic_write import write_file
from vibroimpact.studies.ledger import Span

FOLDER, CHUNK = "chunks", ".h5"
"""Where chunks are in the folder of a study, and how their names end."""


@dataclass(frozen=True)
class ChunkResult:
    """What came of the drops of one chunk.

    Parameters
    ----------
    arrays : mapping of str to array
        By names, the drop along the first axis.
    failures : mapping of int to str
        Why a drop failed, by its place in the chunk.
    """

    arrays: Mapping[str, NDArray[Any]]
    failures: Mapping[int, str]


def chunk_path(folder: Path, number: int) -> Path:
    """Return where a chunk of a study is kept."""
    return folder / FOLDER / f"{number:06d}{CHUNK}"


def write_chunk(folder: Path, chunk: Span, result: ChunkResult, study: str) -> str:
    """Write a chunk, whole or not at all; return its checksum.

    Parameters
    ----------
    folder : Path
        That of the study.
    chunk : Span
        Which it is.
    result : ChunkResult
        What came of it.
    study : str
        The fingerprint of the study that it belongs to.

    Raises
    ------
    ComputationError
        If there is no room for it.
    """
    memory = BytesIO()
    with h5py.File(memory, "w", libver=("v110", "v110")) as file:  # whose headers have check sums
        file.attrs["study"], file.attrs["first"], file.attrs["size"] = study, chunk.first, chunk.size
        file.create_group("arrays")  # there also if nothing came of any drop
        for name, values in result.arrays.items():
            checked = {"fletcher32": True} if values.size else {}  # so that damage shows when it is read, also without a ledger
            file.create_dataset(f"arrays/{name}", data=values, **checked)
        reasons = [reason.encode() for reason in result.failures.values()]
        for name, given in (("place", np.array(list(result.failures), dtype=np.int64)), ("reason", np.array(reasons, dtype=bytes))):
            file.create_dataset(f"failures/{name}", data=given, **({"fletcher32": True} if reasons else {}))
    data, target = memory.getvalue(), chunk_path(folder, chunk.number)
    try:
        target.parent.mkdir(exist_ok=True)
        write_file(target, data, durable=True)
    except OSError as error:
        words = "see to the disk, then go on with --resume; the chunks that are done stay"
        raise ComputationError(f"{target}: the chunk can't be written: {error.strerror}; {words}") from None
    return sha256(data).hexdigest()


def checksum(folder: Path, number: int) -> str | None:
    """Return the checksum of a chunk as it is on disk; None if it is not there or can't be read."""
    try:
        return sha256(chunk_path(folder, number).read_bytes()).hexdigest()
    except OSError:
        return None


def chunk_layout(folder: Path, number: int) -> dict[str, tuple[tuple[int, ...], np.dtype[Any]]]:
    """Return the shape and the type of each array of a chunk, which are not read."""
    with h5py.File(chunk_path(folder, number), "r") as file:
        return {name: (values.shape, values.dtype) for name, values in file["arrays"].items()}


def read_chunk(folder: Path, chunk: Span, study: str, names: Collection[str] | None = None) -> ChunkResult:
    """Read a chunk.

    Parameters
    ----------
    folder : Path
        That of the study.
    chunk : Span
        Which it is.
    study : str
        The fingerprint of the study.
    names : collection of str, optional
        The arrays to read, where they are there; by default all.

    Raises
    ------
    OSError, KeyError, ValueError
        If it is damaged, of another study, or has other drops.
    """
    with h5py.File(chunk_path(folder, chunk.number), "r") as file:
        told = (file.attrs["study"], file.attrs["first"], file.attrs["size"])
        if told != (study, chunk.first, chunk.size):
            raise ValueError("it is of another study, or has other drops")
        wanted = [name for name in file["arrays"] if names is None or name in names]
        # by name and with [()]: items() gives None for what can't be opened, and np.asarray makes an object of what can't be read
        arrays = {name: np.asarray(file["arrays"][name][()]) for name in wanted}
        reasons = [reason.decode() for reason in file["failures/reason"][()]]
        return ChunkResult(arrays, dict(zip(file["failures/place"][()].tolist(), reasons, strict=True)))
