"""Compiled functions made from the code that was kept on the disk.

Numba reads the code that callers copy with it, of each function, although few of them are called by
functions that are still to be compiled. Here it is read when one is.
"""

from __future__ import annotations

from typing import Any

from numba.core import codegen, compiler
from numba.core.codegen import ll


class _LoadedLibrary(codegen.JITCodeLibrary):  # type: ignore[misc]
    """Machine code of a function, and in `_bitcode` what callers copy."""

    _bitcode: bytes | None = None
    _parsed: Any = None

    @property
    def _shared_module(self) -> Any:
        """What callers copy, as numba asks for it."""
        if self._parsed is None and self._bitcode is not None:
            self._parsed = ll.parse_bitcode(self._bitcode)
        return self._parsed

    @_shared_module.setter
    def _shared_module(self, module: Any) -> None:
        self._parsed = module


def loaded_function(target_context: Any, compiled: tuple[Any, ...], *, inner: bool) -> Any:
    """Return a compiled function, as numba's `CompileResult._rebuild` does.

    Parameters
    ----------
    target_context : numba's context
        That of the processor.
    compiled : tuple
        What numba keeps of the function.
    inner : bool
        Does only compiled code call it?
    """
    state, fndesc, env, signature, objectmode, lifted, annotation, reload_init, others = compiled
    for reload in reload_init:
        reload()
    names = [fndesc.llvm_func_name]
    if not inner:
        names += [fndesc.llvm_cpython_wrapper_name, fndesc.llvm_cfunc_wrapper_name]
    library = _library_of(target_context.codegen(), state, names)
    result = compiler.CompileResult(
        target_context=target_context,
        typing_context=target_context.typing_context,
        library=library,
        environment=env,
        entry_point=target_context.get_executable(library, fndesc, env),
        fndesc=fndesc,
        type_annotation=annotation,
        signature=signature,
        objectmode=objectmode,
        lifted=lifted,
        typing_error=None,
        call_helper=None,
        metadata=None,
        reload_init=reload_init,
        referenced_envs=others,
    )
    for other in others:
        library.codegen.set_env(other.env_name, other)
    return result


def _library_of(generator: Any, state: tuple[Any, ...], names: list[str]) -> _LoadedLibrary:
    """Return the library of kept code that defines functions with some names."""
    name, _kind, (machine_code, bitcode) = state
    library = _LoadedLibrary(generator, name)
    library._bitcode = bitcode
    library.enable_object_caching()
    library._set_compiled_object(machine_code)
    library._finalize_final_module()
    generator._engine._defined_symbols.update(names)
    return library
