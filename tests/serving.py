"""The live page as a process of its own."""

from __future__ import annotations

import re
import subprocess
import sys
from types import TracebackType


class Server:
    """`vibroimpact serve` on a free port, or on one that is given; it ends with its block."""

    def __init__(self, *arguments: str, port: int = 0) -> None:
        command = [
            sys.executable,
            "-m",
            "vibroimpact",
            "serve",
            "--port",
            str(port),
            "--no-browser",
            *arguments,
        ]
        self.stopped = False
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        self.said = self.process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/", self.said)
        if found is None:
            raise AssertionError(f"the server did not start: {self.said}{self.stop()}")
        self.address, self.port = found.group(), int(found.group(1))

    def stop(self) -> str:
        """End it, and return what it wrote to standard error."""
        self.stopped = True
        self.process.terminate()
        return self.process.communicate(timeout=60)[1]

    def __enter__(self) -> Server:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self.stopped:
            return
        died = self.process.poll()
        wrote = self.stop()
        assert died is None, f"the server died of {died}: {wrote}"
        assert "Traceback" not in wrote
