"""Diagnosis of the installation: versions, the store of modes, and a reference computation."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, requires, version

from vibroimpact._version import __version__
from vibroimpact.structures.factor import free_memory
from vibroimpact.structures.store import entries, store_folder, store_size

_FIRST_REBOUND = 6.8386265  # m/s: PAPER, section 4, theory, integrated independently at 1e-12


def diagnose() -> list[tuple[str, str]]:
    """Return the state of the installation as rows (name, version or how to install it).

    Examples
    --------
    >>> diagnose()[0][0]
    'vibroimpact'
    """
    rows = [
        ("vibroimpact", __version__),
        ("python", platform.python_version()),
        ("platform", platform.platform()),
        ("processors", str(os.cpu_count())),
        ("memory free", f"{free_memory() / 1e9:.3g} GB"),
        ("store of modes", _store()),
    ]
    for requirement in requires("vibroimpact") or []:
        name, _, marker = requirement.partition(";")
        name = name.split("[")[0].split(">")[0].split("=")[0].split("<")[0].split("~")[0].strip()
        extra = marker.partition("extra ==")[2].strip(" '\"")
        try:
            rows.append((name, version(name)))
        except PackageNotFoundError:
            rows.append((name, f'not installed; pip install "vibroimpact[{extra}]"' if extra else "missing"))
    return rows


def _store() -> str:
    folder = store_folder()
    if os.path.lexists(folder) and not (folder.is_dir() and os.access(folder, os.W_OK)):
        return f"{folder} is not a folder that can be written to: modes are not kept"
    return f"{len(entries())} entries, {store_size() / 1e6:.3g} MB, in {folder}"


def first_rebound_error() -> float:
    """Return the relative error of the first rebound speed of the paper's theory."""
    from vibroimpact.cases.reader import load_case
    from vibroimpact.dynamics.simulate import simulate

    speed = float(simulate(load_case("paper:type1-theory")).impacts["separation_speed_m_s"][0])
    return abs(speed / _FIRST_REBOUND - 1.0)
