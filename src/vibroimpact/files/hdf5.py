"""HDF5 files with checksums on every dataset and on all metadata, so that damage is detected."""

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

from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import DamageError

FORMAT = ("v110", "v110")
"""File format of HDF5 1.10 (2016).

Object headers have checksums, and small datasets have little overhead.
"""

CHECKED: dict[str, Any] = {"fletcher32": True}
"""Dataset options of arrays: HDF5's Fletcher-32 checksum."""

PACKED: dict[str, Any] = {"compression": "gzip", "compression_opts": 1, "shuffle": True, **CHECKED}
"""Dataset options of smooth data: fast compression.

It also reveals a block overwritten by zeros, whose Fletcher sum is zero too.
"""

_CHUNK = 2**18  # bytes
_PACKING = 1100  # the most that gzip reduces data by
_UNPACKED = 100_000_000  # bytes that any array may take, however few of them are stored
_FAILED_CHECKS = ("checksum", "fletcher32", "inflate", "filter returned failure")
"""Words by which HDF5 says that what it read is not what was written."""
_LACKING_FILTERS = ("is not registered", "can't open directory")
"""Words by which it says that a filter of a file is neither built in nor among its plugins."""


class _ErrorStoringFile(FileIO):
    """A file that stores its first write error in `error` instead of raising it.

    Raised inside HDF5, it would end the process.
    """

    error: OSError | None = None

    def write(self, data: Any) -> int:
        """Write all data; after the first error, write nothing more."""
        remaining = memoryview(data).cast("B")
        size = len(remaining)
        while remaining and self.error is None:
            try:
                written = super().write(remaining)
            except OSError as error:
                self.error = error
            else:
                remaining = remaining[written:]
        return size

    def truncate(self, size: int | None = None) -> int:
        """Set the length of the file; an error is stored."""
        try:
            return super().truncate(size)
        except OSError as error:
            self.error = self.error or error
            return size or 0


@contextmanager
def new_hdf5(path: Path) -> Iterator[h5py.File]:
    """Yield a new HDF5 file, written to the disk as it grows.

    A full disk raises OSError instead of ending the process.

    Raises
    ------
    OSError
        If it can't be written.
    """
    with _ErrorStoringFile(path, "w+") as disk:
        try:
            with h5py.File(disk, "w", track_order=True, libver=FORMAT) as file:
                yield file
        except Exception:
            if disk.error is None:  # otherwise the stored error is the cause
                raise
        if disk.error is not None:
            raise disk.error


def new_array(group: h5py.Group, name: str, values: Any, **packing: Any) -> h5py.Dataset:
    """Write an array with the dataset options CHECKED or PACKED.

    Scalars are stored in the object header, which has a checksum.
    """
    values = np.asarray(values)
    if values.size and values.ndim:
        return group.create_dataset(
            name,
            data=values,
            chunks=chunk_shape(values.shape, values.dtype.itemsize),
            **(packing or CHECKED),
        )
    if values.ndim or values.dtype.kind not in "fiu":
        return group.create_dataset(name, data=values)
    properties = h5p.create(h5p.DATASET_CREATE)
    properties.set_layout(h5d.COMPACT)
    properties.set_obj_track_times(False)
    data = h5py.Dataset(
        h5d.create(
            group.id, name.encode(), h5t.py_create(values.dtype), h5s.create(h5s.SCALAR), properties
        )
    )
    data[()] = values
    return data


def chunk_shape(shape: Sequence[int], itemsize: int) -> tuple[int, ...]:
    """Return the chunk shape of an array: contiguous in memory.

    So data written in order touch each chunk once.

    Examples
    --------
    >>> chunk_shape((10, 1000, 100), 8)
    (1, 250, 100)
    """
    chunk: list[int] = []
    for axis, length in enumerate(shape):
        bytes_of_row = itemsize * prod(shape[axis + 1 :])
        most_rows = max(1, min(length, _CHUNK // max(1, bytes_of_row)))
        # chunks of even size, since the last one is stored in full size
        chunks = -(-length // most_rows)
        chunk.append(-(-length // chunks))
    return tuple(chunk)


def read_array(data: h5py.Dataset, place: Any = ()) -> NDArray[Any]:
    """Return a dataset, or a part of it, as an array.

    Raises
    ------
    DamageError
        If it can't be read, because its checksum does not match for instance, or the file does not
        hold so many values.
    InputError
        If there is too little memory for it, or it is packed by a filter that HDF5 does not have.
    """
    try:
        stored = int(data.id.get_storage_size())
        size = int(data.size or 0) * data.dtype.itemsize
        if size > _UNPACKED and size > _PACKING * stored:
            raise ValueError(
                f"its shape {data.shape} is of {size / 1e9:.3g} GB, of which the file "
                f"holds {stored} bytes"
            )
        return np.asarray(data[place])
    except MemoryError:
        raise InputError(
            f"{data.name.lstrip('/')} needs more memory than there is, for its shape "
            f"{data.shape}; split the file"
        ) from None
    except Exception as error:  # of any type, depending on the damage
        if any(sign in str(error) for sign in _LACKING_FILTERS):
            raise InputError(
                f"{data.name.lstrip('/')} is packed by a filter that HDF5 lacks here; where it is "
                "installed, pack the file by h5repack -f GZIP=1"
            ) from None
        raise DamageError(f"{data.name.lstrip('/')} is damaged ({short_reason(error)})") from None


def members(group: h5py.Group) -> dict[str, h5py.Dataset | h5py.Group]:
    """Return what a group holds by name, without following a link to another file.

    Raises
    ------
    DamageError
        If a link leads nowhere or out of the file, or the data of a member lie in other files.
    """
    by_name: dict[str, h5py.Dataset | h5py.Group] = {}
    for name in group:
        path = f"{group.name.strip('/')}/{name}".lstrip("/")
        if isinstance(group.get(name, getlink=True), h5py.ExternalLink):
            raise DamageError(f"{path} is a link that leads out of the file")
        try:
            member = group[name]
        except Exception as error:  # of any type, depending on the damage
            raise DamageError(
                f"{path} is a link that leads nowhere, or is damaged ({short_reason(error)})"
            ) from None
        if isinstance(member, h5py.Dataset) and (member.is_virtual or member.external):
            raise DamageError(f"the values of {path} lie in another file")
        by_name[name] = member
    return by_name


def attribute(owner: h5py.Dataset | h5py.Group, name: str, otherwise: Any = None) -> Any:
    """Return an attribute as numbers, texts and lists of them; `otherwise` if there is none.

    Raises
    ------
    DamageError
        If it can't be read.
    """
    try:
        value = owner.attrs.get(name, otherwise)
    except Exception as error:  # of any type, depending on the damage
        raise DamageError(f"the attribute {name} is damaged ({short_reason(error)})") from None
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value


def short_reason(error: Exception) -> str:
    """Return a short reason why HDF5 could not read."""
    text = " ".join(str(error).split())
    if any(sign in text for sign in _FAILED_CHECKS):
        return "its check sum does not match"
    if len(text) < 120:
        return text
    return f"{text[:117]}..."
