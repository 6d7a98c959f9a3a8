"""The code of a compiled function on the disk, as numba asks for it and keeps it."""

from __future__ import annotations

import hashlib
import io
import pickle
import sys
from functools import cache
from pathlib import Path
from typing import Any

from numba.core import caching, environment, serialize
from numba.core.codegen import ll
from numba.core.runtime import _nrt_python, rtsys

from vibroimpact.compiler.code_store import has_code, load_code, machine_folder, save_code
from vibroimpact.compiler.loaded_code import loaded_function
from vibroimpact.compiler.symbols import are_linked, called_by_symbol


class CodeCache(caching._Cache):  # type: ignore[misc]
    """Compiled code of a function in a folder of this project, under its digest.

    Damaged code counts as absent. Numba's own cache looks at the file of a function and not at its
    callees, does not survive damaged files, and takes a folder for all that use numba in this
    process.

    Parameters
    ----------
    name : str
        Name of the function.
    digest : str
        What it is compiled from, with its callees, its signature and the options.
    is_own : bool
        Are it and its callees functions of this package?
    is_inner : bool
        Does only compiled code call it?
    """

    def __init__(self, name: str, digest: str, *, is_own: bool, is_inner: bool) -> None:
        code = hashlib.sha256(digest.encode()).hexdigest()
        self._file = f"{name}-{code[:32]}"
        self.number = int(code[:15], 16)
        """A number that only this code has."""
        self._is_own = is_own
        self._is_inner = is_inner
        self.trouble = ""
        """Why the code is not on the disk, or ""."""
        self.size = 0
        """Size of the machine code [bytes]; 0 before it is compiled or loaded, or if not kept."""

    @property
    def cache_path(self) -> str:
        """No path: the folder depends on the processor."""
        return ""

    def folder(self, target_context: Any) -> Path:
        """Return the folder of the code."""
        return machine_folder(_processor_of(target_context))

    def has_code(self, target_context: Any) -> bool:
        """Is the code on the disk? It may be damaged."""
        return has_code(self.folder(target_context), self._file)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled function, or None."""
        data = load_code(self.folder(target_context), self._file)
        if data is None:
            return None
        try:
            if self._is_own:
                _register_runtime(target_context)
                callees, compiled = _Unpickler(io.BytesIO(data)).load()
            else:
                target_context.refresh()  # packages that extend numba may be needed
                callees, compiled = pickle.loads(data)
            if not are_linked(callees):
                return None
            self.size = _machine_code_size(compiled)
            return loaded_function(target_context, compiled, inner=self._is_inner)
        except Exception:  # whatever a pickle raises
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled function, unless its code holds addresses of this process."""
        if data.library.has_dynamic_globals or not all(lifted.can_cache for lifted in data.lifted):
            return
        compiled = data._reduce()
        self.size = _machine_code_size(compiled)
        content = serialize.dumps((called_by_symbol(data.library), compiled))
        self.trouble = save_code(self.folder(data.target_context), self._file, content)

    def enable(self) -> None:
        """Do nothing: it is always enabled."""

    def disable(self) -> None:
        """Do nothing."""

    def flush(self) -> None:
        """Do nothing."""


@cache
def _processor_of(target_context: Any) -> str:
    """Return what tells processors apart."""
    return str(target_context.codegen().magic_tuple())


def _machine_code_size(compiled: tuple[Any, ...]) -> int:
    """Return the size of the machine code in what numba keeps of a compiled function [bytes]."""
    library = compiled[0]
    _name, _kind, (machine_code, _bitcode) = library
    return len(machine_code)


@cache
def _register_runtime(target_context: Any) -> None:
    """Make numba's memory manager known to the linker, which is all that loading needs.

    `refresh`, which numba calls here, loads the modules with all that it can compile, for a tenth
    of a second or two.
    """
    try:
        for name, address in _nrt_python.c_helpers.items():
            symbol = name if name.startswith("_") else f"NRT_{name}"
            ll.add_symbol(symbol, address)
    except Exception:  # of another version of numba
        rtsys.initialize(target_context)


class _Unpickler(pickle.Unpickler):
    """Reads code without the modules of numba that made it, which saves a tenth of a second."""

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == (environment.__name__, "_rebuild_env"):
            return _environment
        return super().find_class(module, name)


def _environment(module: str, constants: list[Any], name: str) -> Any:
    """Return what numba keeps for a function: its globals and its constants.

    Only interpreted code reads the globals.
    """
    if module in sys.modules or not module.startswith("numba."):
        return environment._rebuild_env(module, constants, name)
    kept = environment.lookup_environment(name)
    if kept is None:
        kept = environment.Environment({"__name__": module})
        kept.consts[:] = constants
        kept.env_name = name
        environment.Environment._memo[name] = kept
    return kept
