"""Workers of a Dask scheduler: an existing one, or a local cluster."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from importlib.util import find_spec
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.errors import InputError
from vibroimpact.studies.computation.workers import Setup, WorkerPool

LOCAL = "local"
"""Value in place of an address: a local cluster is started for the study."""

_PATIENCE = 30  # timeout of the connection to a scheduler [s]


def check_scheduler(address: str) -> None:
    """Check that a scheduler can compute chunks.

    Parameters
    ----------
    address : str
        Such as "tcp://10.0.0.5:8786", or "local".

    Raises
    ------
    InputError
        If Dask is not installed, no scheduler answers at the address, it has no workers, or they
        run another version of this package.
    """
    if find_spec("distributed") is None:
        raise InputError(
            'a Dask scheduler needs Dask; install it with: pip install "vibroimpact[cluster]"',
            "--scheduler",
        )
    if address != LOCAL:
        _client(address).close()


@contextmanager
def dask_workers(address: str, number: int, setup: Setup) -> Iterator[WorkerPool]:
    """Provide the workers of a scheduler that `check_scheduler` has checked.

    Parameters
    ----------
    address : str
        Such as "tcp://10.0.0.5:8786"; "local" starts a scheduler and workers on this machine.
    number : int
        Number of workers of a local cluster; an existing scheduler has its own.
    setup : callable
        Called once in each worker, including those that join later.
    """
    from distributed import Client, LocalCluster, WorkerPlugin

    class Setting(WorkerPlugin):  # type: ignore[misc]
        name = "vibroimpact"

        def setup(self, worker: object) -> None:
            setup()

    # the scheduler serves its health page even without a dashboard; choose a free port, as 8787 may
    # be in use
    options = {
        "n_workers": number,
        "threads_per_worker": 1,
        "scheduler_kwargs": {"dashboard": False, "dashboard_address": "localhost:0"},
        "silence_logs": logging.CRITICAL,
    }
    scheduler: Any = nullcontext(address)
    if address == LOCAL:
        scheduler = LocalCluster(**options)
    with scheduler as cluster, Client(cluster) as client:
        client.register_plugin(Setting())

        def in_flight() -> int:
            threads: int = sum(client.nthreads().values())
            return 2 * max(1, threads)

        yield WorkerPool(client.get_executor(pure=False), in_flight)


def _client(address: str) -> Any:
    """Return a client of the scheduler at an address."""
    from distributed import Client

    try:
        client = Client(address, timeout=_PATIENCE)
    except (OSError, ValueError, TimeoutError) as error:
        reason = next(iter(str(error).splitlines()), type(error).__name__)
        raise InputError(
            f"{address}: no Dask scheduler answers there ({reason}); the address of a scheduler "
            'is such as tcp://10.0.0.5:8786, or "local" for one of this machine',
            "--scheduler",
        ) from None
    versions = client.run(_version)
    if not versions:
        client.close()
        raise InputError(
            f"{address}: this scheduler has no workers; start some, such as: dask worker {address}",
            "--scheduler",
        )
    for worker, version in versions.items():
        if version != __version__:
            client.close()
            raise InputError(
                f"the worker {worker} has vibroimpact {version}, and this is "
                f"{__version__}; install the same version",
                "--scheduler",
            )
    return client


def _version() -> str:
    return __version__
