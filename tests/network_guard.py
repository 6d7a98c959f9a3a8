"""A guard on sockets for other processes and what these start: it records, and refuses, every call
that leaves the machine.

In Python an audit hook sees them; where there is a C compiler, a library that is loaded before all
others sees those of compiled code too.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import vibroimpact

_HOOK = """
import os, sys

_LOCAL = {"", "localhost", "127.0.0.1", "::1", "0.0.0.0", "::", None, b"localhost", b"127.0.0.1"}


def _tell(event, given):
    with open(os.environ["GUARD_CALLS"], "a") as file:
        file.write(f"{event} {given!r} by {sys.argv[:3]}\\n")
    raise OSError(f"the guard refuses {event} {given!r}")


def _hook(event, arguments):
    if event in ("socket.connect", "socket.sendto", "socket.sendmsg"):
        address = arguments[1]
        if isinstance(address, tuple) and address[0] not in _LOCAL and not str(address[0]).startswith("127."):
            _tell(event, address)
    elif event in ("socket.getaddrinfo", "socket.gethostbyname", "socket.gethostbyaddr") and arguments[0] not in _LOCAL:
        if not str(arguments[0]).startswith("127."):
            _tell(event, arguments[0])


sys.addaudithook(_hook)
"""

_LIBRARY = r"""
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static void tell(const char *call, const char *where) {
    const char *file = getenv("GUARD_CALLS");
    int descriptor = file ? open(file, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600) : -1;
    if (descriptor >= 0) {
        dprintf(descriptor, "%s %s by compiled code\n", call, where);
        close(descriptor);
    }
}

static int leaves(const char *call, const struct sockaddr *address) {
    char where[INET6_ADDRSTRLEN] = "";
    if (address && address->sa_family == AF_INET) {
        const struct in_addr *place = &((const struct sockaddr_in *)address)->sin_addr;
        unsigned first = ntohl(place->s_addr) >> 24;
        if (first == 127 || first == 0) return 0;
        inet_ntop(AF_INET, place, where, sizeof where);
    } else if (address && address->sa_family == AF_INET6) {
        const struct in6_addr *place = &((const struct sockaddr_in6 *)address)->sin6_addr;
        if (IN6_IS_ADDR_LOOPBACK(place) || IN6_IS_ADDR_UNSPECIFIED(place)) return 0;
        inet_ntop(AF_INET6, place, where, sizeof where);
    } else {
        return 0;
    }
    tell(call, where);
    errno = ENETUNREACH;
    return 1;
}

int connect(int descriptor, const struct sockaddr *address, socklen_t size) {
    int (*real)(int, const struct sockaddr *, socklen_t) = dlsym(RTLD_NEXT, "connect");
    return leaves("connect", address) ? -1 : real(descriptor, address, size);
}

ssize_t sendto(int descriptor, const void *data, size_t length, int flags, const struct sockaddr *address, socklen_t size) {
    ssize_t (*real)(int, const void *, size_t, int, const struct sockaddr *, socklen_t) = dlsym(RTLD_NEXT, "sendto");
    return leaves("sendto", address) ? -1 : real(descriptor, data, length, flags, address, size);
}

int getaddrinfo(const char *name, const char *service, const struct addrinfo *hints, struct addrinfo **found) {
    int (*real)(const char *, const char *, const struct addrinfo *, struct addrinfo **) = dlsym(RTLD_NEXT, "getaddrinfo");
    if (name && *name && strcmp(name, "localhost") && strncmp(name, "127.", 4) && strcmp(name, "::1") && strcmp(name, "0.0.0.0")) {
        tell("getaddrinfo", name);
        return EAI_FAIL;
    }
    return real(name, service, hints, found);
}

struct hostent *gethostbyname(const char *name) {
    tell("gethostbyname", name);
    return NULL;
}
"""


class Guard:
    """A home of its own, and an environment in which processes are guarded.

    Parameters
    ----------
    folder : Path
        An empty folder, for the home, the guard and its record.
    """

    def __init__(self, folder: Path) -> None:
        self.home, self._record = folder / "home", folder / "calls"
        self.home.mkdir()
        (folder / "hook").mkdir()
        (folder / "hook" / "sitecustomize.py").write_text(_HOOK)
        ours = [
            str(folder / "hook"),
            str(Path(__file__).parent),
            str(Path(vibroimpact.__file__).parents[1]),
        ]
        names = ("PATH", "VIRTUAL_ENV", "LANG", "OPENBLAS_NUM_THREADS", "VIBROIMPACT_CODE_STORE")
        kept = {key: os.environ[key] for key in names if key in os.environ}
        # as on the machine of a user: some libraries are silent where they find that they are
        # tested
        self.environment = kept | {
            "HOME": str(self.home),
            "PYTHONPATH": os.pathsep.join(ours),
            "GUARD_CALLS": str(self._record),
        }
        compiler = shutil.which("cc")
        self.sees_compiled_code = compiler is not None and sys.platform.startswith("linux")
        if self.sees_compiled_code:
            source, library = folder / "guard.c", folder / "guard.so"
            source.write_text(_LIBRARY)
            subprocess.run(
                [str(compiler), "-shared", "-fPIC", "-o", str(library), str(source), "-ldl"],
                check=True,
            )
            self.environment["LD_PRELOAD"] = str(library)

    @property
    def calls(self) -> list[str]:
        """What was called, a line each."""
        return self._record.read_text().splitlines() if self._record.exists() else []

    def run(self, program: str, *arguments: str, folder: Path) -> str:
        """Run a program in Python, and return what it printed; its exit status must be 0."""
        command = [sys.executable, "-c", program, *arguments]
        done = subprocess.run(
            command,
            env=self.environment,
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=900,
            check=False,
        )
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
        return done.stdout

    def written(self) -> set[str]:
        """Return the files in the home, as paths relative to it."""
        return {
            path.relative_to(self.home).as_posix()
            for path in self.home.rglob("*")
            if not path.is_dir()
        }
