"""The digest of a function: its code, and everything that compiled code takes from
outside of it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any, cast

import numpy as np

_KNOWN_PACKAGES = ("numpy", "math", "cmath", "operator", "builtins", "numba", "llvmlite")
"""Packages whose versions are in the name of the folder, so that their functions need
only be named.
"""


_OWN_PACKAGE = "vibroimpact"


class NotDigestible(Exception):
    """A function refers to something whose content is not known."""


class Digest:
    """What a function is compiled from.

    Parameters
    ----------
    function : callable
        The Python function.
    replaced : mapping
        The functions that compiled code calls in place of others.

    Raises
    ------
    NotDigestible
        If it refers to something other than functions, modules, types, numbers, strings, arrays,
        and tuples of them.
    """

    def __init__(
        self, function: Callable[..., Any], replaced: Mapping[Any, Callable[..., Any]]
    ) -> None:
        self.is_own = True
        """Are all functions those of this package, or of NumPy and the like?"""
        self._replaced = replaced
        self._words: list[str] = []
        self._numbers: dict[int, int] = {}
        self._add(function)

    @property
    def text(self) -> str:
        """A hash that changes whenever the compiled code may: with the function, its
        callees, or the constants that they use.
        """
        return hashlib.sha256("\n".join(self._words).encode()).hexdigest()[:32]

    def _add(self, value: Any) -> None:
        if isinstance(getattr(value, "py_func", None), FunctionType):
            self._words.append(getattr(getattr(value, "compiled", value), "signature_text", ""))
            value = value.py_func
        if isinstance(value, FunctionType):
            self._add_function(cast(FunctionType, self._replaced.get(value, value)))
        elif isinstance(value, np.ndarray):
            content = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
            self._words.append(f"array {value.dtype} {value.shape} {content}")
        elif isinstance(value, tuple):
            self._words.append(f"{type(value).__qualname__} of {len(value)}")
            for member in value:
                self._add(member)
        elif (
            isinstance(value, bool | int | float | complex | str | bytes | np.generic)
            or value is None
        ):
            self._words.append(f"{type(value).__qualname__} {value!r}")
        elif isinstance(value, ModuleType):
            self._words.append(f"module {value.__name__}")
        elif isinstance(value, type) and issubclass(value, tuple):
            self._words.append(f"{value.__qualname__} {getattr(value, '_fields', ())}")
        elif (
            isinstance(value, type | BuiltinFunctionType | np.ufunc)
            or _package(value) in _KNOWN_PACKAGES
        ):
            self._words.append(f"{_package(value)} {getattr(value, '__qualname__', value)!r}")
        else:
            raise NotDigestible(f"{type(value).__qualname__} {value!r}")

    def _add_function(self, function: FunctionType) -> None:
        if _package(function) in _KNOWN_PACKAGES:
            self._words.append(f"{function.__module__}.{function.__qualname__}")
            return
        if id(function) in self._numbers:
            self._words.append(f"function {self._numbers[id(function)]}")
            return
        self._numbers[id(function)] = len(self._numbers)
        self.is_own &= _package(function) == _OWN_PACKAGE
        self._add_code(function.__code__, function.__doc__)
        self._add(function.__defaults__)
        for name, value in _used(function):
            self._words.append(name)
            self._add(value)

    def _add_code(self, code: CodeType, docstring: str | None) -> None:
        names = (code.co_varnames, code.co_names, code.co_cellvars, code.co_freevars)
        self._words.append(f"code {code.co_code.hex()} {names} {code.co_argcount} {code.co_flags}")
        for constant in code.co_consts:
            if isinstance(constant, CodeType):
                self._add_code(constant, None)
            elif isinstance(constant, frozenset):  # in an order that differs between processes
                self._words.append(repr(sorted(map(repr, constant))))
            elif constant != docstring:
                self._words.append(repr(constant))


def _package(value: Any) -> str:
    return str(getattr(value, "__module__", None) or type(value).__module__).partition(".")[0]


def _used(function: FunctionType) -> list[tuple[str, Any]]:
    """Return what a function takes from outside: globals, variables of functions around
    it, and members of modules.
    """
    names = set(_names(function.__code__))
    values = {name: function.__globals__[name] for name in names if name in function.__globals__}
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        values[name] = cell.cell_contents
    new = values
    while modules := [
        value
        for value in new.values()
        if isinstance(value, ModuleType) and value.__name__ not in _KNOWN_PACKAGES
    ]:
        members = {
            f"{module.__name__}.{name}": getattr(module, name)
            for module in modules
            for name in names
            if hasattr(module, name)
        }
        new = {name: member for name, member in members.items() if name not in values}
        values = values | new
    return sorted(values.items(), key=lambda item: item[0])


def _names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)
