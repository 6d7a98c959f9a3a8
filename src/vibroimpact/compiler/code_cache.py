"""The cache of one compiled function, which numba asks before it compiles and tells afterwards."""

from __future__ import annotations

import hashlib
import pickle
from typing import Any

from numba.core import caching, compiler, serialize

from vibroimpact.compiler.code_store import load_code, machine_folder, save_code


class CodeCache(caching._Cache):  # type: ignore[misc]
    """Compiled code of a function in the project's own folder, under its digest and signature; damage counts as absence.

    Numba's own cache looks at the file of a function and not at its callees, and does not survive damaged files.
    """

    def __init__(self, name: str, digest: str) -> None:
        self._name = name
        self._digest = digest

    @property
    def cache_path(self) -> str:
        """The folder, which depends on the processor, and is thus not known here."""
        return ""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled function for a signature, or None."""
        target_context.refresh()
        codegen = target_context.codegen()
        data = load_code(_folder(codegen), self._file(sig))
        if data is None:
            return None
        try:
            return compiler.CompileResult._rebuild(target_context, *pickle.loads(data))
        except Exception:  # whatever a pickle of another version raises
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled function."""
        if data.library.has_dynamic_globals or any(not inner.can_cache for inner in data.lifted):
            return
        save_code(_folder(data.codegen), self._file(sig), serialize.dumps(data._reduce()))

    def enable(self) -> None:
        """Do nothing: it is always enabled."""

    def disable(self) -> None:
        """Do nothing."""

    def flush(self) -> None:
        """Do nothing."""

    def _file(self, sig: Any) -> str:
        return f"{self._name}-{hashlib.sha256(f'{self._digest} {sig}'.encode()).hexdigest()[:32]}"


def _folder(codegen: Any) -> Any:
    return machine_folder(str(codegen.magic_tuple()))
