"""What numba does otherwise while it compiles the functions of this package."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from itertools import chain, count
from secrets import randbits
from typing import Any

from numba.core import config
from numba.core.bytecode import FunctionIdentity
from numba.core.runtime.context import NRTContext

BITS = 62
"""Of the random numbers by which functions of one name are told apart."""

_LEVEL = 1
"""Of optimisation: what the second and the third add takes a fifth of the time to compile, and
saves nothing here."""


@contextmanager
def compiling_as(number: int) -> Iterator[None]:
    """Let numba compile in the ways of this package a function that it numbers as given.

    Those compiled with it are numbered from a random number on. Numba tells functions of one name
    apart by these numbers, which begin with 1 in each process. Two of one name (made by a function,
    such as the forces of two laws) that had one number in two processes would be one function to
    the linker in a process that loads both.
    """
    numbers, level, references = FunctionIdentity._unique_ids, config.OPT, NRTContext.get_meminfos
    FunctionIdentity._unique_ids = chain([number], count(randbits(BITS)))
    config.OPT = config._OptLevel(_LEVEL)
    NRTContext.get_meminfos = _references
    try:
        yield
    finally:
        FunctionIdentity._unique_ids = numbers
        config.OPT = level
        NRTContext.get_meminfos = references


def _references(self: Any, builder: Any, kind: Any, value: Any) -> list[Any]:
    """Return the references in a value, each with its type, as numba's function does.

    That one takes all members of each array apart, which made a third of all code to compile.
    """
    model = self._context.data_model_manager[kind]
    references = []
    if model.has_nrt_meminfo():
        references.append((kind, model.get_nrt_meminfo(builder, value)))
    for member, read in model.traverse(builder):
        if _has_references(self._context.data_model_manager, member):
            references += self.get_meminfos(builder, member, read(value))
    return references


@cache
def _has_references(manager: Any, kind: Any) -> bool:
    return bool(manager[kind].contains_nrt_meminfo())
