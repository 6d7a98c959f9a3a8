"""Exchange two names of a file system in one step, where the system can."""

from __future__ import annotations

import ctypes
import os
import sys
from functools import cache
from pathlib import Path
from typing import Any

_HERE = -100  # AT_FDCWD of Linux: paths are as the process sees them
_EXCHANGE = 2  # RENAME_EXCHANGE of renameat2(2)


def exchange(first: Path, second: Path) -> bool:
    """Exchange what two names stand for, so that no process ever finds one of them missing.

    Returns
    -------
    bool
        False where the system or the file system can't, or one of the names is not there; then nothing has changed.

    Examples
    --------
    >>> exchange(Path("neither of these"), Path("is there"))
    False
    """
    rename = _renameat2()
    return rename is not None and rename(_HERE, os.fsencode(first), _HERE, os.fsencode(second), _EXCHANGE) == 0


@cache
def _renameat2() -> Any:
    """Return the function of the C library; None where there is none."""
    if not sys.platform.startswith("linux"):
        return None
    function = getattr(ctypes.CDLL(None), "renameat2", None)
    if function is not None:
        function.argtypes = (ctypes.c_int, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_uint)
    return function
