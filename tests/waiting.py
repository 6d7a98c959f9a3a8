"""Wait for other processes, however busy the machine is."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable


def wait_until(so: Callable[[], bool], *processes: subprocess.Popen) -> None:
    """Wait until something is so; fail if a process that is to bring it about has ended before."""
    while not so():
        assert all(process.poll() is None for process in processes), (
            "a process ended before its time"
        )
        time.sleep(0.005)
