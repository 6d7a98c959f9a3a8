"""HDF5 files whose damage shows: a check sum on every dataset, and a format that has them on all that describes the data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import FileIO
from math import prod
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from h5py import h5d, h5p, h5s, h5t
from numpy.typing import NDArray

from vibroimpact.files.check_sums import DamageError

FORMAT = ("v110", "v110")
"""Of HDF5 1.10 (2016): its headers have check sums, and a small dataset costs no more than its data."""

CHECKED: dict[str, Any] = {"fletcher32": True}
"""For arrays: HDF5's own check sum."""

PACKED: dict[str, Any] = {"compression": "gzip", "compression_opts": 1, "shuffle": True, **CHECKED}
"""For what is smooth: it gets several times smaller, in little time. Blocks of zeros, whose Fletcher sum is zero too, do not unpack."""

_CHUNK = 2**18  # bytes


class _Patient(FileIO):
    """A file whose writes never fail while HDF5 is at it, which would end the process: the first error waits in `error`."""

    error: OSError | None = None

    def write(self, data: Any) -> int:
        """Write all of it, or nothing more once that could not be done."""
        left = memoryview(data).cast("B")
        size = len(left)
        while left and self.error is None:
            try:
                left = left[super().write(left) :]
            except OSError as error:
                self.error = error
        return size

    def truncate(self, size: int | None = None) -> int:
        """Set the length, unless the file is given up."""
        try:
            return super().truncate(size)
        except OSError as error:
            self.error = self.error or error
            return size or 0


@contextmanager
def new_hdf5(path: Path) -> Iterator[h5py.File]:
    """Give an HDF5 file to fill, which goes to the disk as it grows; where that is full, an error says so, and the process lives.

    Raises
    ------
    OSError
        If it can't be written.
    """
    with _Patient(path, "w+") as disk:
        try:
            with h5py.File(disk, "w", track_order=True, libver=FORMAT) as file:
                yield file
        except Exception:
            if disk.error is None:  # else that is the cause of whatever HDF5 says
                raise
        if disk.error is not None:
            raise disk.error


def new_array(group: h5py.Group, name: str, values: Any, **packing: Any) -> h5py.Dataset:
    """Write an array, `packing` as CHECKED or PACKED; one number, or none at all, lies in its header, which has a check sum."""
    values = np.asarray(values)
    if values.size and values.ndim:
        return group.create_dataset(name, data=values, chunks=chunk_shape(values.shape, values.dtype.itemsize), **(packing or CHECKED))
    if values.ndim or values.dtype.kind not in "fiu":
        return group.create_dataset(name, data=values)
    properties = h5p.create(h5p.DATASET_CREATE)
    properties.set_layout(h5d.COMPACT)
    properties.set_obj_track_times(False)
    data = h5py.Dataset(h5d.create(group.id, name.encode(), h5t.py_create(values.dtype), h5s.create(h5s.SCALAR), properties))
    data[()] = values
    return data


def chunk_shape(shape: Sequence[int], itemsize: int) -> tuple[int, ...]:
    """Return the shape of the chunks of an array: runs of it as it lies in memory, so that what is written in order is written once.

    Examples
    --------
    >>> chunk_shape((10, 1000, 100), 8)
    (1, 250, 100)
    """
    found: list[int] = []
    for place, length in enumerate(shape):
        inner = itemsize * prod(shape[place + 1 :])
        most = max(1, min(length, _CHUNK // max(1, inner)))
        found.append(-(-length // -(-length // most)))  # as even as can be: the last is stored as large as the others
    return tuple(found)


def read_array(data: h5py.Dataset, place: Any = ()) -> NDArray[Any]:
    """Return an array, or a part of it.

    Raises
    ------
    DamageError
        If it is not as it was written.
    """
    try:
        return np.asarray(data[place])
    except Exception as error:  # of many kinds, as the file is damaged in many ways
        raise DamageError(f"{data.name.lstrip('/')} is damaged ({short_reason(error)})") from None


def short_reason(error: Exception) -> str:
    """Return in few words why HDF5 could not read."""
    text = " ".join(str(error).split())
    if any(word in text for word in ("checksum", "fletcher32", "inflate", "filter")):
        return "its check sum does not match"
    return text if len(text) < 120 else f"{text[:117]}..."
