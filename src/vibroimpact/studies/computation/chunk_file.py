"""The results of one chunk of drops, and the HDF5 file that stores them.

The file is kept until the study is complete.
"""

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
from vibroimpact.studies.computation.ledger import Span

FOLDER = "chunks"
"""Subfolder of the chunk files in the folder of a study."""

CHUNK = ".h5"
"""Suffix of chunk files."""


@dataclass(frozen=True)
class ChunkResult:
    """The results of the drops of one chunk.

    Parameters
    ----------
    arrays : mapping of str to array
        Results by name; the drop is the first axis.
    failures : mapping of int to str
        Reason of each failed drop, by its index in the chunk.
    """

    arrays: Mapping[str, NDArray[Any]]
    failures: Mapping[int, str]


def chunk_path(folder: Path, number: int) -> Path:
    """Return the path of a chunk file."""
    return folder / FOLDER / f"{number:06d}{CHUNK}"


def write_chunk(folder: Path, chunk: Span, result: ChunkResult, study: str) -> str:
    """Write a chunk atomically, and return its SHA-256 checksum.

    Parameters
    ----------
    folder : Path
        Folder of the study.
    chunk : Span
        The chunk.
    result : ChunkResult
        Its results.
    study : str
        Fingerprint of the study.

    Raises
    ------
    ComputationError
        If it can't be written.
    """
    memory = BytesIO()
    # a format with checksums in its headers
    with h5py.File(memory, "w", libver=("v110", "v110")) as file:
        file.attrs["study"] = study
        file.attrs["first"] = chunk.first
        file.attrs["size"] = chunk.size
        file.create_group("arrays")  # present even if all drops failed
        for name, values in result.arrays.items():
            _write_array(file, f"arrays/{name}", values)
        indices = np.array(list(result.failures), dtype=np.int64)
        reasons = [reason.encode() for reason in result.failures.values()]
        _write_array(file, "failures/place", indices)
        _write_array(file, "failures/reason", np.array(reasons, dtype=bytes))
    data = memory.getvalue()
    target = chunk_path(folder, chunk.number)
    try:
        target.parent.mkdir(exist_ok=True)
        write_file(target, data, durable=True)
    except OSError as error:
        remedy = "see to the disk, then go on with --resume; the chunks that are done stay"
        raise ComputationError(
            f"{target}: the chunk can't be written: {error.strerror}; {remedy}"
        ) from None
    return sha256(data).hexdigest()


def _write_array(file: h5py.File, name: str, values: NDArray[Any]) -> None:
    """Write an array with checksums, which reveal damage on reading even without a ledger.

    HDF5 allows none for an empty array.
    """
    if values.size:
        file.create_dataset(name, data=values, fletcher32=True)
    else:
        file.create_dataset(name, data=values)


def checksum(folder: Path, number: int) -> str | None:
    """Return the checksum of a chunk file; None if it is missing or can't be read."""
    try:
        return sha256(chunk_path(folder, number).read_bytes()).hexdigest()
    except OSError:
        return None


def chunk_layout(folder: Path, number: int) -> dict[str, tuple[tuple[int, ...], np.dtype[Any]]]:
    """Return shape and type of each array of a chunk without reading the data."""
    with h5py.File(chunk_path(folder, number), "r") as file:
        return {name: (values.shape, values.dtype) for name, values in file["arrays"].items()}


def read_chunk(
    folder: Path, chunk: Span, study: str, names: Collection[str] | None = None
) -> ChunkResult:
    """Return the results of a chunk, read from its file.

    Parameters
    ----------
    folder : Path
        Folder of the study.
    chunk : Span
        The chunk.
    study : str
        Fingerprint of the study.
    names : collection of str, optional
        The arrays to read, if present; by default all.

    Raises
    ------
    OSError, KeyError, ValueError
        If the file is damaged, or belongs to another study or other drops.
    """
    with h5py.File(chunk_path(folder, chunk.number), "r") as file:
        stored = (file.attrs["study"], file.attrs["first"], file.attrs["size"])
        if stored != (study, chunk.first, chunk.size):
            raise ValueError("it is of another study, or has other drops")
        stored_arrays = file["arrays"]
        arrays = {}
        for name in stored_arrays:
            if names is None or name in names:
                # by name and with [()], which raise errors for damage: items() would return None,
                # and np.asarray an object array
                arrays[name] = np.asarray(stored_arrays[name][()])
        reasons = [reason.decode() for reason in file["failures/reason"][()]]
        indices = file["failures/place"][()].tolist()
        return ChunkResult(arrays, dict(zip(indices, reasons, strict=True)))
