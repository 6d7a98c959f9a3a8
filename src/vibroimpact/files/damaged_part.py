"""Locate the damaged part of an HDF5 file, in a separate process, since HDF5 may hang or crash on a damaged file."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import h5py

from vibroimpact.files.check_sums import CHANGED, DamageError, check_file
from vibroimpact.files.hdf5 import read_array, short_reason

_TIMEOUT = 20.0  # seconds


def check_hdf5(path: Path, expected: str | None) -> None:
    """Verify the SHA-256 of an HDF5 file; None skips the check.

    Raises
    ------
    OSError
        If it can't be read.
    DamageError
        If it does not match; the message names the damaged part, if it can be located.
    """
    try:
        check_file(path, expected)
    except DamageError:
        raise DamageError(damaged_part(path) or CHANGED) from None


def damaged_part(path: Path) -> str:
    """Return a description of the damaged part of an HDF5 file, beginning with its name; "" if it can't be located."""
    command = [sys.executable, "-m", __name__, str(path)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_TIMEOUT, check=False)
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def first_damaged(path: Path) -> str:
    """Return the description of the first damaged group or dataset, found in this process; "" if there is none."""
    with h5py.File(path, "r") as file:
        return _in_group(file)


def _in_group(group: h5py.Group) -> str:
    """Return the description of the first damaged part of a group, searched recursively; "" if there is none."""
    for name in group:
        try:
            found = group[name]
        except Exception as error:  # of any type, depending on the damage
            return f"{group.name.strip('/')}/{name}".lstrip("/") + f" is damaged ({short_reason(error)})"
        try:
            description = _in_group(found) if isinstance(found, h5py.Group) else ""
            if isinstance(found, h5py.Dataset):
                read_array(found)
        except DamageError as error:
            return str(error)
        if description:
            return description
    return ""


if __name__ == "__main__":
    print(first_damaged(Path(sys.argv[1])))
