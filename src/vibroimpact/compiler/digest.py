"""The digest of a function: its code, and everything that compiled code takes from outside of it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

_OWN_VERSIONS = ("numpy", "math", "numba", "builtins", "cmath", "operator")
"""Packages whose versions are in the name of the folder, so that their functions need only be named."""


class NotDigestible(Exception):
    """A function refers to something whose content is not known."""


def digest(function: Callable[..., Any], replaced: Mapping[Any, Callable[..., Any]]) -> str:
    """Return a hash that changes whenever the compiled code of a function may: with it, its callees, or the constants that they use.

    Parameters
    ----------
    function : callable
        A Python function, or a compiled one.
    replaced : mapping
        The functions that compiled code calls in place of others.

    Raises
    ------
    NotDigestible
        If it refers to something other than functions, modules, numbers, strings, arrays, and tuples of them.
    """
    words: list[str] = []
    _add(function, words, {}, replaced)
    return hashlib.sha256("\n".join(words).encode()).hexdigest()[:32]


def _add(value: Any, words: list[str], seen: dict[int, int], replaced: Mapping[Any, Callable[..., Any]]) -> None:
    """Append words that describe a value; a function that was described before is named by its number."""
    value = getattr(value, "py_func", getattr(value, "_defn", value))  # of a compiled function, of an intrinsic one
    if isinstance(value, FunctionType):
        value = replaced.get(value, value)
        if _package(value) in _OWN_VERSIONS:
            words.append(f"{value.__module__}.{value.__qualname__}")
        elif id(value) in seen:
            words.append(f"function {seen[id(value)]}")
        else:
            seen[id(value)] = len(seen)
            _add_code(value.__code__, words)
            for name, used in _used(value):
                words.append(name)
                _add(used, words, seen, replaced)
            words.append(repr(value.__defaults__))
    elif isinstance(value, np.ndarray):
        words.append(f"array {value.dtype} {value.shape} {hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()}")
    elif isinstance(value, tuple):
        words.append(f"{type(value).__qualname__} of {len(value)}")
        for member in value:
            _add(member, words, seen, replaced)
    elif isinstance(value, bool | int | float | complex | str | bytes | np.generic) or value is None:
        words.append(f"{type(value).__qualname__} {value!r}")
    elif isinstance(value, ModuleType):
        words.append(f"module {value.__name__}")
    elif isinstance(value, type | BuiltinFunctionType | np.ufunc) or _package(value) in _OWN_VERSIONS:
        words.append(f"{_package(value)} {getattr(value, '__qualname__', value)!r}")
    else:
        raise NotDigestible(f"{type(value).__qualname__} {value!r}")


def _package(value: Any) -> str:
    return str(getattr(value, "__module__", None) or type(value).__module__).partition(".")[0]


def _add_code(code: CodeType, words: list[str]) -> None:
    words.append(f"code {code.co_code.hex()} {code.co_varnames} {code.co_names} {code.co_cellvars} {code.co_freevars} {code.co_flags}")
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            _add_code(constant, words)
        else:
            words.append(repr(constant))


def _used(function: FunctionType) -> list[tuple[str, Any]]:
    """Return what a function takes from outside: globals, variables of functions around it, and members of modules."""
    names = set(_names(function.__code__))
    values = {name: function.__globals__[name] for name in names if name in function.__globals__}
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        values[name] = cell.cell_contents
    modules = [value for value in values.values() if isinstance(value, ModuleType) and value.__name__ not in _OWN_VERSIONS]
    for module in modules:
        values |= {f"{module.__name__}.{name}": getattr(module, name) for name in names if hasattr(module, name)}
    return sorted(values.items(), key=lambda item: item[0])


def _names(code: CodeType) -> list[str]:
    inner = [name for constant in code.co_consts if isinstance(constant, CodeType) for name in _names(constant)]
    return [*code.co_names, *inner]
