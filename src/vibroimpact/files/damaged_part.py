"""Look at HDF5 files in a separate process, since HDF5 may hang or crash on a damaged file."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import h5py

from vibroimpact.files.check_sums import CHANGED, DamageError, check_file
from vibroimpact.files.hdf5 import read_array, short_reason

_TIMEOUT = 20.0  # seconds
# bytes up to which an array is read as a trial; of larger ones its chunks are looked up
_READ_AS_TRIAL = 32_000_000
_OTHER_PROCESS = (
    "import sys; from pathlib import Path; from vibroimpact.files.damaged_part import {0}; "
    "print({0}(Path(sys.argv[1])))"
)


def check_hdf5(path: Path, expected: str | None) -> None:
    """Verify the SHA-256 of an HDF5 file.

    Where none is known, verify that HDF5 neither hangs nor crashes on it.

    Raises
    ------
    OSError
        If it can't be read.
    DamageError
        If it does not match; the message names the damaged part, if it can be located. If HDF5
        crashes, or does not end in time.
    """
    if expected is None:
        if not endures(path):
            raise DamageError("the file is damaged: HDF5 crashes on it; make or copy it anew")
        return
    try:
        check_file(path, expected)
    except DamageError:
        raise DamageError(damaged_part(path) or CHANGED) from None


def damaged_part(path: Path) -> str:
    """Return a description of the damaged part of an HDF5 file, beginning with its name.

    "" if it can't be located.
    """
    process = _in_other_process(first_damaged, path)
    if process is None or process.returncode != 0:
        return ""
    return process.stdout.strip()


def endures(path: Path) -> bool:
    """Return whether a process that reads an HDF5 file lives.

    True where no process can be started.

    Raises
    ------
    DamageError
        If it does not end in time.
    """
    try:
        process = _in_other_process(try_all, path)
    except OSError:
        return True
    if process is None:
        raise DamageError(
            f"HDF5 did not get through the file within {_TIMEOUT:g} s: it is damaged, or its disk "
            "or this computer is too slow for it; copy it to another disk, or make it anew"
        )
    return process.returncode >= 0  # a negative one is that of a signal, as of a crash


def _in_other_process(
    function: Callable[[Path], object], path: Path
) -> subprocess.CompletedProcess[str] | None:
    """Run a function of this module on a file in another process; None if it takes too long."""
    command = [sys.executable, "-c", _OTHER_PROCESS.format(function.__name__), str(path)]
    try:
        return subprocess.run(
            command, capture_output=True, text=True, timeout=_TIMEOUT, check=False
        )
    except subprocess.TimeoutExpired:
        return None


def first_damaged(path: Path) -> str:
    """Return the description of the first damaged group or dataset; "" if there is none.

    It is found in this process.
    """
    with h5py.File(path, "r") as file:
        for name, member in _all_members(file, set()):
            if isinstance(member, Exception):
                return f"{name} is damaged ({short_reason(member)})"
            try:
                if isinstance(member, h5py.Dataset):
                    read_array(member)
            except DamageError as error:
                return str(error)
    return ""


def try_all(path: Path) -> None:
    """Open all groups, attributes and arrays of a file.

    A fault that raises an error is left to who reads the file.
    """
    with suppress(Exception), h5py.File(path, "r") as file:
        _try(file)
        for _, member in _all_members(file, set()):
            _try(member)


def _try(member: Any) -> None:
    """Read the attributes and the values of a group or a dataset, ignoring errors."""
    with suppress(Exception):
        dict(member.attrs)
    with suppress(Exception):
        if member.nbytes <= _READ_AS_TRIAL:
            read_array(member)
        elif member.chunks:
            member.id.get_num_chunks()


def _all_members(group: h5py.Group, seen: set[int]) -> Iterator[tuple[str, Any]]:
    """Yield the path and the content of all members of a group, or the error that they raise.

    Links to other files are left out.
    """
    for name in group:
        path = f"{group.name.strip('/')}/{name}".lstrip("/")
        try:
            if isinstance(group.get(name, getlink=True), h5py.ExternalLink):
                continue
            member = group[name]
            address = h5py.h5o.get_info(member.id).addr
        except Exception as error:  # of any type, depending on the damage
            yield path, error
            continue
        if address in seen:  # links may lead in circles
            continue
        seen.add(address)
        yield path, member
        if isinstance(member, h5py.Group):
            yield from _all_members(member, seen)
