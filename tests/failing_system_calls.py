"""Kill a process before its n-th file operation, or have that fail: at the system calls, so that
those of C libraries count too.

The work runs in a child, forked so that what is imported is there. A filter of the kernel (seccomp)
stops it before each system call that changes a file; the one who watches it (ptrace) lets it go on,
kills it, or has the call return an error.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
import signal
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

_CALLS = {
    1: "write", 2: "open", 18: "pwrite64", 20: "writev", 73: "flock", 74: "fsync", 75: "fdatasync", 76: "truncate", 77: "ftruncate",
    82: "rename", 83: "mkdir", 84: "rmdir", 85: "creat", 86: "link", 87: "unlink", 88: "symlink", 90: "chmod", 91: "fchmod",
    257: "openat", 258: "mkdirat", 263: "unlinkat", 264: "renameat", 265: "linkat", 266: "symlinkat", 268: "fchmodat",
    280: "utimensat", 285: "fallocate", 296: "pwritev", 316: "renameat2",
}  # fmt: skip
"""Of x86-64."""

_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
_TRACEME, _PEEK, _CONT, _GETREGS, _SETREGS, _SETOPTIONS, _MESSAGE = 0, 1, 7, 12, 13, 0x4200, 0x4201
_SECCOMP_STOP = signal.SIGTRAP | 7 << 8
# end with the one who watches; stop at the filter; watch forks, vforks, threads
_OPTIONS = 0x100000 | 1 << 7 | 1 << 1 | 1 << 2 | 1 << 3
_RAX, _RDI, _RSI, _RDX, _ORIG_RAX, _WORDS = 10, 14, 13, 12, 15, 27  # of user_regs_struct
_WALL = 0x40000000


class Ended(NamedTuple):
    """How a child ended: its exit status, or None if it was killed; how many file
    operations there were; what it wrote; the last one.
    """

    status: int | None
    operations: int
    told: str
    last: str


def traced(
    work: Callable[[], object],
    folder: Path,
    *,
    kill: int = 0,
    fail: int = 0,
    error: int = errno.ENOSPC,
) -> Ended:
    """Run a function in a child; kill it before file operation `kill`, or have the operation `fail`
    return an error (both from 1).

    Parameters
    ----------
    work : callable
        May end with SystemExit.
    folder : Path
        Where what the child prints is kept, in `told`.
    kill, fail : int
        0 is never.
    error : int
        Which error.
    """
    child = os.fork()
    if child == 0:
        _work(work, folder / "told")
    os.waitpid(child, 0)  # it stops itself
    _ptrace(_SETOPTIONS, child, 0, _OPTIONS)
    _ptrace(_CONT, child, 0, 0)
    count, last = 0, ""
    while True:
        process, status = os.waitpid(-1, _WALL)
        if os.WIFEXITED(status) or os.WIFSIGNALED(status):
            if process != child:
                continue
            told = (folder / "told").read_text(encoding="utf-8", errors="replace")
            (folder / "told").unlink()
            return Ended(
                os.WEXITSTATUS(status) if os.WIFEXITED(status) else None, count, told, last
            )
        event, stopped_by = status >> 8, os.WSTOPSIG(status)
        if event == _SECCOMP_STOP:
            registers = list(struct.unpack(f"{_WORDS}Q", _registers(process)))
            name = _changes_a_file(registers)
            if name:
                count, last = count + 1, f"{name} {_text(process, registers)}"
                if count == kill:
                    os.kill(child, signal.SIGKILL)
                    continue
                if count == fail:
                    registers[_ORIG_RAX], registers[_RAX] = 2**64 - 1, 2**64 - error
                    buffer = ctypes.create_string_buffer(struct.pack(f"{_WORDS}Q", *registers))
                    _ptrace(_SETREGS, process, 0, ctypes.addressof(buffer))
        forwarded = 0 if stopped_by in (signal.SIGTRAP, signal.SIGSTOP) else stopped_by
        _ptrace(_CONT, process, 0, forwarded)


def can_trace() -> bool:
    """Can a child be watched here?"""
    if platform.machine() != "x86_64" or not sys.platform.startswith("linux"):
        return False
    child = os.fork()
    if child == 0:
        os._exit(0 if _ptrace(_TRACEME, 0, 0, 0) == 0 and _filter() else 1)
    return os.waitpid(child, 0)[1] == 0


def _work(work: Callable[[], object], told: Path) -> None:
    """Do the work in the child; never returns."""
    status = 70
    try:
        output = os.open(told, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(output, 1)
        os.dup2(output, 2)
        sys.stdout, sys.stderr = os.fdopen(1, "w", closefd=False), os.fdopen(2, "w", closefd=False)
        _ptrace(_TRACEME, 0, 0, 0)
        assert _filter()
        os.kill(os.getpid(), signal.SIGSTOP)
        try:
            work()
            status = 0
        except SystemExit as left:
            status = left.code if isinstance(left.code, int) else 0 if left.code is None else 1
        except BaseException:
            import traceback

            traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _changes_a_file(registers: list[int]) -> str:
    """Return the name of a system call that changes a file; "" of one that does not."""
    name = _CALLS.get(registers[_ORIG_RAX], "")
    if name in ("write", "writev") and registers[_RDI] <= 2:
        return ""
    if (name == "open" and not registers[_RSI] & _WRITES) or (
        name == "openat" and not registers[_RDX] & _WRITES
    ):
        return ""
    return name


def _text(process: int, registers: list[int]) -> str:
    """Return the path that a system call is given, as far as it is one."""
    name = _CALLS[registers[_ORIG_RAX]]
    if name in (
        "write",
        "writev",
        "pwrite64",
        "pwritev",
        "fsync",
        "fdatasync",
        "ftruncate",
        "fallocate",
        "fchmod",
        "flock",
    ):
        try:
            return os.readlink(f"/proc/{process}/fd/{registers[_RDI]}")
        except OSError:
            return ""
    try:
        with open(f"/proc/{process}/mem", "rb", 0) as memory:
            memory.seek(registers[_RSI] if name.endswith(("at", "at2")) else registers[_RDI])
            return memory.read(200).split(b"\0")[0].decode(errors="replace")
    except (OSError, ValueError, OverflowError):
        return ""


def _registers(process: int) -> bytes:
    buffer = ctypes.create_string_buffer(8 * _WORDS)
    _ptrace(_GETREGS, process, 0, ctypes.addressof(buffer))
    return buffer.raw[: 8 * _WORDS]


def _filter() -> bool:
    """Have the kernel stop this process before each of the calls."""
    numbers = sorted(_CALLS)
    load, equal, give = 0x20, 0x15, 0x06
    program = [struct.pack("HBBI", load, 0, 0, 0)]
    for place, number in enumerate(numbers):
        program.append(struct.pack("HBBI", equal, len(numbers) - place, 0, number))
    # allow; trace
    program += [
        struct.pack("HBBI", give, 0, 0, 0x7FFF0000),
        struct.pack("HBBI", give, 0, 0, 0x7FF00000),
    ]
    code = ctypes.create_string_buffer(b"".join(program))
    header = ctypes.create_string_buffer(
        struct.pack("HxxxxxxQ", len(program), ctypes.addressof(code))
    )
    libc = ctypes.CDLL(None)
    return (
        libc.prctl(38, 1, 0, 0, 0) == 0
        and libc.prctl(22, 2, ctypes.c_void_p(ctypes.addressof(header)), 0, 0) == 0
    )


def _ptrace(request: int, process: int, address: int, data: int) -> int:
    function = ctypes.CDLL(None, use_errno=True).ptrace
    function.argtypes, function.restype = (
        (ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p),
        ctypes.c_long,
    )
    return int(function(request, process, address, data))
