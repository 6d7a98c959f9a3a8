"""The code of one compiled function on the disk, which numba asks for before it compiles, and keeps afterwards."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba.core import caching, compiler, serialize
from numba.core.codegen import ll
from numba.core.runtime import _nrt_python, rtsys

from vibroimpact.compiler.code_store import has_code, load_code, machine_folder, save_code

_OWN_PACKAGE = "vibroimpact."


class CodeCache(caching._Cache):  # type: ignore[misc]
    """Compiled code of a function in the project's own folder, under its digest; damage counts as absence.

    Numba's own cache looks at the file of a function and not at its callees, does not survive damaged files, and takes a folder for all
    that use numba in this process.

    Parameters
    ----------
    function : callable
        The Python function.
    digest : str
        What it is compiled from, with its callees, its signature and the options.
    """

    def __init__(self, function: Callable[..., Any], digest: str) -> None:
        self._file = f"{function.__name__}-{hashlib.sha256(digest.encode()).hexdigest()[:32]}"
        self._is_own = function.__module__.startswith(_OWN_PACKAGE)
        self.trouble = ""
        """Why the code is not on the disk, or ""."""

    @property
    def cache_path(self) -> str:
        """No path: the folder depends on the processor."""
        return ""

    def folder(self, target_context: Any) -> Path:
        """Return the folder of the code."""
        return machine_folder(str(target_context.codegen().magic_tuple()))

    def has_code(self, target_context: Any) -> bool:
        """Is the code on the disk? It may be damaged."""
        return has_code(self.folder(target_context), self._file)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled function, or None."""
        data = load_code(self.folder(target_context), self._file)
        if data is None:
            return None
        if self._is_own:
            _register_runtime(target_context)
        else:
            target_context.refresh()  # packages that extend numba may be needed
        try:
            return compiler.CompileResult._rebuild(target_context, *pickle.loads(data))
        except Exception:  # of whatever a pickle raises
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled function, unless its code holds addresses of this process."""
        if data.library.has_dynamic_globals or not all(lifted.can_cache for lifted in data.lifted):
            return
        self.trouble = save_code(self.folder(data.target_context), self._file, serialize.dumps(data._reduce()))

    def enable(self) -> None:
        """Do nothing: it is always enabled."""

    def disable(self) -> None:
        """Do nothing."""

    def flush(self) -> None:
        """Do nothing."""


def _register_runtime(target_context: Any) -> None:
    """Make numba's memory manager known to the linker, which is all that loading needs.

    `refresh`, which numba calls here, loads the modules with all that it can compile, for a tenth of a second or two.
    """
    try:
        for name, address in _nrt_python.c_helpers.items():
            ll.add_symbol(name if name.startswith("_") else f"NRT_{name}", address)
    except Exception:  # of another version of numba
        rtsys.initialize(target_context)
