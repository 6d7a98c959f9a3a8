"""Diagnosis of the installation: versions, compiled code, the store of modes, and a
reference computation.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.compiled import why_not_compiled
from vibroimpact.compiler.code_store import code_files, code_folder, code_size
from vibroimpact.recognition.onnx_runtime import SWITCH
from vibroimpact.structures.free_memory import free_memory
from vibroimpact.structures.store import entries, store_folder, store_size

_SWITCHES = {"onnxruntime": SWITCH}
"""Packages that send usage data to their makers unless they are told not to, and the
environment variable by which they are.
"""

_FIRST_REBOUND = 6.8386265  # m/s: PAPER, section 4, theory, integrated independently at 1e-12


def diagnose() -> dict[str, Any]:
    """Return the state of the installation as data; the version of a package that is not installed
    is None.

    Examples
    --------
    >>> sorted(diagnose())
    ['compiler', 'packages', 'platform', 'python', 'resources', 'store', 'usage_data', 'version']
    """
    folder = store_folder()
    usable = _is_usable(folder)
    return {
        "version": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "resources": {"processors": os.cpu_count(), "free_memory_byte": free_memory()},
        "store": {
            "folder": str(folder),
            "usable": usable,
            "entries": len(entries()) if usable else 0,
            "size_byte": store_size() if usable else 0,
        },
        "compiler": _compiler(),
        "usage_data": {
            name: {"sent": False, "switch": switch}
            for name, switch in _SWITCHES.items()
            if _installed(name)
        },
        "packages": {name: _installed(name) for name in _requirements()},
    }


def diagnosis_rows(found: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return a diagnosis as rows (name, version or how to install it).

    Examples
    --------
    >>> diagnosis_rows(diagnose())[0][0]
    'vibroimpact'
    """
    extras, memory = _requirements(), found["resources"]["free_memory_byte"]
    return [
        ("vibroimpact", found["version"]),
        ("python", found["python"]),
        ("platform", found["platform"]),
        ("processors", str(found["resources"]["processors"])),
        ("memory free", f"{memory / 1e9:.3g} GB"),
        ("compiled code", _compiler_words(found["compiler"])),
        ("store of modes", _store_words(found["store"])),
        ("usage data", _usage_words(found["usage_data"])),
        *((name, version or _missing(extras[name])) for name, version in found["packages"].items()),
    ]


def _compiler() -> dict[str, Any]:
    """Return whether the solver is compiled, and what is kept of it."""
    folder = code_folder()
    reason = why_not_compiled()
    return {
        "compiled": not reason,
        "reason": reason,
        "folder": str(folder),
        "usable": _is_usable(folder),
        "entries": len(code_files()),
        "size_byte": code_size(),
    }


def _is_usable(folder: Path) -> bool:
    """Can files be written to a folder, or can it be made?"""
    there = folder
    while not os.path.lexists(there) and there != there.parent:
        there = there.parent
    return there.is_dir() and os.access(there, os.W_OK | os.X_OK)


def _requirements() -> dict[str, str]:
    """Return the packages that this one requires, each with the extra that it belongs to, or ""."""
    found = {}
    for requirement in requires("vibroimpact") or []:
        name, _, marker = requirement.partition(";")
        name = name.split("[")[0].split(">")[0].split("=")[0].split("<")[0].split("~")[0].strip()
        found[name] = marker.partition("extra ==")[2].strip(" '\"")
    return found


def _installed(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _missing(extra: str) -> str:
    return f'not installed; pip install "vibroimpact[{extra}]"' if extra else "missing"


def _usage_words(usage: Mapping[str, Any]) -> str:
    switches = ", ".join(f"that of {name} by {one['switch']}=1" for name, one in usage.items())
    return f"none is sent; {switches}, before it is loaded" if switches else "none is sent"


def _compiler_words(compiler: Mapping[str, Any]) -> str:
    if not compiler["compiled"]:
        slower = "some ten times slower, where bodies vibrate one to two hundred times"
        return f"none: the solver runs in plain Python, {slower}: {compiler['reason']}"
    if not compiler["usable"]:
        where = f"{compiler['folder']} is not a folder that can be written to"
        kept = (
            f", but for the {compiler['entries']} functions that it has"
            if compiler["entries"]
            else ""
        )
        return f"{where}: the solver is compiled again by each command{kept}"
    return (
        f"{compiler['entries']} functions, {compiler['size_byte'] / 1e6:.3g} MB, in "
        f"{compiler['folder']}"
    )


def _store_words(store: Mapping[str, Any]) -> str:
    if not store["usable"]:
        return f"{store['folder']} is not a folder that can be written to: modes are not kept"
    return f"{store['entries']} entries, {store['size_byte'] / 1e6:.3g} MB, in {store['folder']}"


@cache
def first_rebound_error() -> float:
    """Return the relative error of the first rebound speed of the paper's theory."""
    from vibroimpact.cases.reader import load_case
    from vibroimpact.dynamics.simulate import simulate

    speed = float(simulate(load_case("paper:type1-theory")).impacts["separation_speed_m_s"][0])
    return abs(speed / _FIRST_REBOUND - 1.0)
