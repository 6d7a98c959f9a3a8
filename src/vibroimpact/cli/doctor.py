"""Diagnosis of the installation: versions, what is kept on disk, and a reference computation."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.compiled import why_not_compiled
from vibroimpact.compiler.code_store import code_files, code_folder, code_size
from vibroimpact.recognition.onnx_runtime import SWITCH
from vibroimpact.structures.finite_elements.free_memory import free_memory
from vibroimpact.structures.store import entries, store_folder, store_size

_SWITCHES = {"onnxruntime": SWITCH}
"""Packages that send usage data to their makers, and the variable that switches that off."""

_FIRST_REBOUND = 6.8386265  # m/s: PAPER, section 4, theory, integrated independently at 1e-12


def diagnose() -> dict[str, Any]:
    """Return the state of the installation as data.

    The version of a package that is not installed is None.

    Examples
    --------
    >>> sorted(diagnose())
    ['compiler', 'packages', 'platform', 'python', 'resources', 'store', 'usage_data', 'version']
    """
    folder = store_folder()
    usable = _is_usable(folder)
    entry_count = len(entries()) if usable else 0
    size = store_size() if usable else 0
    return {
        "version": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "resources": {"processors": os.cpu_count(), "free_memory_byte": free_memory()},
        "store": {
            "folder": str(folder),
            "usable": usable,
            "entries": entry_count,
            "size_byte": size,
        },
        "compiler": _compiler(),
        "usage_data": {
            name: {"sent": False, "switch": switch}
            for name, switch in _SWITCHES.items()
            if _installed(name)
        },
        "packages": {name: _installed(name) for name in _requirements()},
    }


def diagnosis_rows(diagnosis: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return a diagnosis as rows (name, version or how to install it).

    Examples
    --------
    >>> diagnosis_rows(diagnose())[0][0]
    'vibroimpact'
    """
    resources = diagnosis["resources"]
    extras = _requirements()
    packages = [
        (name, version or _missing(extras[name])) for name, version in diagnosis["packages"].items()
    ]
    return [
        ("vibroimpact", diagnosis["version"]),
        ("python", diagnosis["python"]),
        ("platform", diagnosis["platform"]),
        ("processors", str(resources["processors"])),
        ("memory free", f"{resources['free_memory_byte'] / 1e9:.3g} GB"),
        ("compiled code", _compiler_state(diagnosis["compiler"])),
        ("store of modes", _store_state(diagnosis["store"])),
        ("usage data", _usage_state(diagnosis["usage_data"])),
        *packages,
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
    existing = folder
    while not os.path.lexists(existing) and existing != existing.parent:
        existing = existing.parent
    return existing.is_dir() and os.access(existing, os.W_OK | os.X_OK)


def _requirements() -> dict[str, str]:
    """Return the packages that this one requires, each with the extra that it belongs to, or ""."""
    extras = {}
    for requirement in requires("vibroimpact") or []:
        specifier, _, marker = requirement.partition(";")
        name = re.split(r"[\[><=~]", specifier)[0].strip()
        extras[name] = marker.partition("extra ==")[2].strip(" '\"")
    return extras


def _installed(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _missing(extra: str) -> str:
    if not extra:
        return "missing"
    return f'not installed; pip install "vibroimpact[{extra}]"'


def _usage_state(usage: Mapping[str, Any]) -> str:
    if not usage:
        return "none is sent"
    switches = [f"that of {name} by {usage[name]['switch']}=1" for name in usage]
    return f"none is sent; {', '.join(switches)}, before it is loaded"


def _compiler_state(compiler: Mapping[str, Any]) -> str:
    if not compiler["compiled"]:
        return (
            "none: the solver runs in plain Python, some thirty to a hundred times slower: "
            f"{compiler['reason']}"
        )
    if not compiler["usable"]:
        state = (
            f"{compiler['folder']} is not a folder that can be written to: the solver is compiled "
            "again by each command"
        )
        if compiler["entries"]:
            state += f", but for the {compiler['entries']} functions that it has"
        return state
    return f"{compiler['entries']} functions, {_size_and_folder(compiler)}"


def _store_state(store: Mapping[str, Any]) -> str:
    if not store["usable"]:
        return f"{store['folder']} is not a folder that can be written to: modes are not kept"
    return f"{store['entries']} entries, {_size_and_folder(store)}"


def _size_and_folder(kept: Mapping[str, Any]) -> str:
    return f"{kept['size_byte'] / 1e6:.3g} MB, in {kept['folder']}"


@cache
def first_rebound_error() -> float:
    """Return the relative error of the first rebound speed of the paper's theory."""
    from vibroimpact.cases.reader import load_case
    from vibroimpact.dynamics.simulate import simulate

    speed = float(simulate(load_case("paper:type1-theory")).impacts["separation_speed_m_s"][0])
    return abs(speed / _FIRST_REBOUND - 1.0)
