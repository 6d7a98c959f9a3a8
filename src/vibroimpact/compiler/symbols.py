"""Large compiled functions, which compiled code calls by the names of their symbols.

Numba copies the code of a function into every function that calls it, directly or not, and there it
is optimised and translated again. For a small function that is what makes its calls free. For a
large one a call costs nothing beside it, and the copies most of the time that compiling takes; such
a function therefore keeps its code to itself, and the linker of the process finds it by name.
"""

from __future__ import annotations

from typing import Any

LARGE = 8000
"""Size of the machine code from which a function is called by its symbol [bytes]."""

_FUNCTIONS: dict[str, Any] = {}
"""The functions that are called by their symbols."""


def is_large(size: int) -> bool:
    """Is a function with machine code of a size [bytes] called by its symbol?"""
    return size >= LARGE


def call_by_symbol(function: Any, result: Any) -> None:
    """Let compiled code call a function by its symbol, and no longer copy its code.

    Parameters
    ----------
    function : CompiledFunction
        The function.
    result : numba's CompileResult
        What it was compiled to, or loaded.
    """
    _FUNCTIONS[result.fndesc.mangled_name] = function
    context = result.target_context
    context.remove_user_function(result.entry_point)
    context.insert_user_function(result.entry_point, result.fndesc, [])


def called_by_symbol(library: Any) -> list[tuple[str, Any]]:
    """Return the symbols that the code of a library calls, each with its function."""
    names = [
        function.name for function in library._final_module.functions if function.is_declaration
    ]
    return [(name, _FUNCTIONS[name]) for name in names if name in _FUNCTIONS]


def are_linked(called: list[tuple[str, Any]]) -> bool:
    """Make functions ready that code calls by their symbols; does the linker find them?

    If it does not, it would end the process.
    """
    for _, function in called:
        function.ready()
    return all(symbol in _FUNCTIONS for symbol, _ in called)
