"""The digest of a function: its code, and all that compiled code takes from outside of it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any, cast

import numpy as np

_KNOWN_PACKAGES = ("numpy", "math", "cmath", "operator", "builtins", "numba", "llvmlite")
"""Packages whose functions need only be named: their versions are in the name of the folder."""

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
        """A hash that changes with the function, its callees, and the constants that they use."""
        return hashlib.sha256("\n".join(self._words).encode()).hexdigest()[:32]

    def _add(self, value: Any) -> None:
        if isinstance(getattr(value, "py_func", None), FunctionType):
            self._words.append(getattr(value, "signature_text", ""))
            value = value.py_func
        if isinstance(value, FunctionType):
            self._add_function(cast(FunctionType, self._replaced.get(value, value)))
        elif isinstance(value, tuple):
            self._words.append(f"{type(value).__qualname__} of {len(value)}")
            for member in value:
                self._add(member)
        else:
            self._words.append(_text_of(value))

    def _add_function(self, function: FunctionType) -> None:
        if _package(function) in _KNOWN_PACKAGES:
            self._words.append(f"{function.__module__}.{function.__qualname__}")
            return
        if id(function) in self._numbers:
            self._words.append(f"function {self._numbers[id(function)]}")
            return
        self._numbers[id(function)] = len(self._numbers)
        self.is_own &= _package(function) == _OWN_PACKAGE
        words, used = _content_of(function)
        self._words += words
        self._add(function.__defaults__)
        for name, value in used:
            self._words.append(name)
            self._add(value)


_PLAIN_TYPES = bool | int | float | complex | str | bytes | np.generic | None
_NAMED_TYPES = type | BuiltinFunctionType | np.ufunc


def _text_of(value: Any) -> str:
    """Return a text of a value that is neither a function nor a tuple."""
    if isinstance(value, np.ndarray):
        content = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
        return f"array {value.dtype} {value.shape} {content}"
    if isinstance(value, _PLAIN_TYPES):
        return f"{type(value).__qualname__} {value!r}"
    if isinstance(value, ModuleType):
        return f"module {value.__name__}"
    if isinstance(value, type) and issubclass(value, tuple):
        return f"{value.__qualname__} {getattr(value, '_fields', ())}"
    if isinstance(value, _NAMED_TYPES) or _package(value) in _KNOWN_PACKAGES:
        return f"{_package(value)} {getattr(value, '__qualname__', value)!r}"
    raise NotDigestible(f"{type(value).__qualname__} {value!r}")


def _package(value: Any) -> str:
    return str(getattr(value, "__module__", None) or type(value).__module__).partition(".")[0]


@cache
def _content_of(function: FunctionType) -> tuple[list[str], list[tuple[str, Any]]]:
    """Return the text of a function's code, and what it takes from outside.

    It is read once: many functions call it, directly or not, and each of them has a digest.
    """
    return list(_words_of(function.__code__, function.__doc__)), _used(function)


def _words_of(code: CodeType, docstring: str | None) -> Iterator[str]:
    """Yield the text of code, without its docstring."""
    names = (code.co_varnames, code.co_names, code.co_cellvars, code.co_freevars)
    yield f"code {code.co_code.hex()} {names} {code.co_argcount} {code.co_flags}"
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _words_of(constant, None)
        elif isinstance(constant, frozenset):  # in an order that differs between processes
            yield repr(sorted(map(repr, constant)))
        elif constant != docstring:
            yield repr(constant)


def _used(function: FunctionType) -> list[tuple[str, Any]]:
    """Return what a function takes from outside, sorted by name.

    That are globals, variables of functions around it, and members of modules.
    """
    code = function.__code__
    names = set(_names(code))
    values = {name: function.__globals__[name] for name in names if name in function.__globals__}
    for name, cell in zip(code.co_freevars, function.__closure__ or (), strict=True):
        values[name] = cell.cell_contents
    # members of modules may be modules with members
    new_values = values
    while new_values:
        members = _members_of_modules(new_values, names)
        new_values = {name: member for name, member in members.items() if name not in values}
        values = values | new_values
    return sorted(values.items(), key=lambda item: item[0])


def _members_of_modules(values: Mapping[str, Any], names: set[str]) -> dict[str, Any]:
    """Return the members with these names of the modules among values."""
    members = {}
    for module in values.values():
        if not isinstance(module, ModuleType) or module.__name__ in _KNOWN_PACKAGES:
            continue
        for name in names:
            if hasattr(module, name):
                members[f"{module.__name__}.{name}"] = getattr(module, name)
    return members


def _names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)
