"""Compiled code on disk, in a folder for each combination of processor, Python, NumPy and compiler."""

from __future__ import annotations

import hashlib
import os
import platform
import sys
from functools import cache
from importlib.metadata import version
from pathlib import Path

from vibroimpact._version import __version__
from vibroimpact.files.atomic_write import write_file

PLACE = "VIBROIMPACT_COMPILED"
"""Environment variable with the folder of compiled code."""

FORMAT = 1
"""Part of every folder's name: to be increased when the files, or the options of the compiler, change."""

_CHECKSUM = 32  # bytes
_SUFFIX = ".code"


def code_folder() -> Path:
    """Return the folder of compiled code: that of the environment variable VIBROIMPACT_COMPILED, else one in the user's cache."""
    from platformdirs import user_cache_path

    given = os.environ.get(PLACE)
    return Path(given) if given else user_cache_path("vibroimpact") / "compiled"


@cache
def machine_folder(processor: str) -> Path:
    """Return the folder for this Python, its packages, and a processor."""
    packages = [f"{name} {version(name)}" for name in ("numba", "llvmlite", "numpy")]
    kind = "|".join((str(FORMAT), __version__, sys.version, *packages, platform.machine(), processor))
    return code_folder() / hashlib.sha256(kind.encode()).hexdigest()[:16]


def load_code(folder: Path, name: str) -> bytes | None:
    """Return the code under a name; None if there is none, or if its file is damaged."""
    try:
        content = (folder / f"{name}{_SUFFIX}").read_bytes()
    except OSError:
        return None
    data = content[_CHECKSUM:]
    return data if hashlib.sha256(data).digest() == content[:_CHECKSUM] else None


def save_code(folder: Path, name: str, data: bytes) -> str:
    """Keep code under a name; return why that failed, or ""."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_file(folder / f"{name}{_SUFFIX}", [hashlib.sha256(data).digest(), data])
    except OSError as error:
        return f"compiled code can't be kept in {folder} ({error.strerror})"
    return ""
