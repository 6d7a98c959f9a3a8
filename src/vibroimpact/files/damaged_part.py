"""Which part of an HDF5 file is damaged: looked for in a process of its own, for HDF5 may work on a damaged file for ever, or die of it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import h5py

from vibroimpact.files.check_sums import CHANGED, DamageError, check_file
from vibroimpact.files.hdf5 import read_array, short_reason

_PATIENCE = 20.0  # seconds


def check_hdf5(path: Path, expected: str | None) -> None:
    """Raise unless an HDF5 file is as it was written; None knows of no check sum.

    Raises
    ------
    OSError
        If it can't be read.
    DamageError
        If it is another; names the part of it, where that can be found.
    """
    try:
        check_file(path, expected)
    except DamageError:
        raise DamageError(damaged_part(path) or CHANGED) from None


def damaged_part(path: Path) -> str:
    """Return what is damaged in an HDF5 file, in words that begin with its name; "" if that can't be told."""
    command = [sys.executable, "-m", __name__, str(path)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_PATIENCE, check=False)
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def first_damaged(path: Path) -> str:
    """Return the same, in this process."""
    with h5py.File(path, "r") as file:
        return _in_group(file)


def _in_group(group: h5py.Group) -> str:
    for name in group:
        try:
            found = group[name]
        except Exception as error:  # of many kinds, as the file is damaged in many ways
            return f"{group.name.strip('/')}/{name}".lstrip("/") + f" is damaged ({short_reason(error)})"
        try:
            told = _in_group(found) if isinstance(found, h5py.Group) else ""
            if isinstance(found, h5py.Dataset):
                read_array(found)
        except DamageError as error:
            return str(error)
        if told:
            return told
    return ""


if __name__ == "__main__":
    print(first_damaged(Path(sys.argv[1])))
