"""Compiled code on disk, in a folder for each combination of processor, Python, NumPy and compiler.

A file is a SHA-256 followed by code; one that is damaged counts as absent. Files are named by a
digest of what they were compiled from, so that none is ever out of date, and the least recently
used are removed where all take more room than `LARGEST`.
"""

from __future__ import annotations

import hashlib
import os
import platform
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path

from vibroimpact._version import __version__
from vibroimpact.files.atomic_write import write_file
from vibroimpact.files.recover import clear
from vibroimpact.files.working_files import alone

PLACE = "VIBROIMPACT_CODE_STORE"
"""Environment variable with the folder of compiled code."""

FORMAT = 3
"""Part of the names of folders; to be increased with the files or the options of the compiler."""

LARGEST = 100_000_000
"""Largest size of the store [bytes]."""
_CHECKSUM = 32  # bytes
_SUFFIX = ".code"
_DAY = 86_400.0  # seconds
_LONGEST_WAIT = 300.0  # seconds


def code_folder() -> Path:
    """Return the folder of compiled code: of VIBROIMPACT_CODE_STORE, else in the user's cache."""
    from platformdirs import user_cache_path

    given = os.environ.get(PLACE)
    if given:
        return Path(given)
    return user_cache_path("vibroimpact") / "compiled"


def machine_folder(processor: str) -> Path:
    """Return the folder for this Python, its packages, and a processor."""
    return code_folder() / _machine_digest(processor)


@cache
def _machine_digest(processor: str) -> str:
    packages = [f"{name} {version(name)}" for name in ("numba", "llvmlite", "numpy")]
    machine = (str(FORMAT), __version__, sys.version, *packages, platform.machine(), processor)
    return hashlib.sha256("|".join(machine).encode()).hexdigest()[:16]


def has_code(folder: Path, name: str) -> bool:
    """Is there code under a name? It may be damaged."""
    return _path(folder, name).is_file()


def load_code(folder: Path, name: str) -> bytes | None:
    """Return the code under a name; None if there is none, or if its file is damaged."""
    path = _path(folder, name)
    try:
        content = path.read_bytes()
    except OSError:
        return None
    data = content[_CHECKSUM:]
    if hashlib.sha256(data).digest() != content[:_CHECKSUM]:
        return None
    with suppress(OSError):  # its time of use, by which files are removed, to a day
        if time.time() - path.stat().st_mtime > _DAY:
            os.utime(path)
    return data


def save_code(folder: Path, name: str, data: bytes) -> str:
    """Keep code under a name; return why that failed, or ""."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _clear_once(folder)
        write_file(_path(folder, name), [hashlib.sha256(data).digest(), data])
        _make_room()
    except OSError as error:
        return f"{folder} can't be written to: {error.strerror}"
    return ""


@contextmanager
def compiling_alone(folder: Path) -> Iterator[None]:
    """Wait while another process compiles, so that its code is found afterwards."""
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
    with alone(folder, _LONGEST_WAIT):
        yield


def code_files() -> list[Path]:
    """Return the files of compiled code, the least recently used first."""
    times = {}
    for path in code_folder().glob(f"*/*{_SUFFIX}"):
        with suppress(OSError):  # another process may remove it
            times[path] = path.stat().st_mtime
    return sorted(times, key=lambda path: times[path])


def code_size() -> int:
    """Return the size of compiled code on the disk [bytes]."""
    return sum(_size(path) for path in code_files())


def clear_code() -> int:
    """Remove all compiled code; return the number of files."""
    paths = code_files()
    for path in paths:
        path.unlink(missing_ok=True)
    _remove_empty_folders()
    return len(paths)


def _path(folder: Path, name: str) -> Path:
    return folder / f"{name}{_SUFFIX}"


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


@cache
def _clear_once(folder: Path) -> None:
    """Remove the working files of killed processes, once per process."""
    clear(folder)


def _make_room() -> None:
    """Remove the least recently used files beyond the limit."""
    paths = code_files()
    total = sum(_size(path) for path in paths)
    if total <= LARGEST:
        return
    for path in paths[:-1]:
        if total <= LARGEST:
            break
        total -= _size(path)
        path.unlink(missing_ok=True)
    _remove_empty_folders()


def _remove_empty_folders() -> None:
    # of all folders below: the store itself may not have been made yet
    for folder in code_folder().glob("*/"):
        with suppress(OSError):  # it has files
            folder.rmdir()
