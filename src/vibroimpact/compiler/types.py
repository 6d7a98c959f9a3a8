"""Numba's types of compiled functions, from their annotations, and of the functions of laws."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np
from numba import from_dtype, types
from numba.core.typing.templates import Signature
from numpy.typing import NDArray

from vibroimpact.compiler.lending import Lent

_SCALARS = {
    float: types.float64,
    int: types.int64,
    bool: types.boolean,
    complex: types.complex128,
    type(None): types.void,
}

real = types.float64
address = types.int64
vector = types.float64[::1]
pair = types.UniTuple(real, 2)

force = types.FunctionType(pair(real, real, real, vector))
"""Of a contact law: the static and the dissipative force.

The arguments are indentation, its rate, approach speed and coefficients.
"""

energies = types.FunctionType(pair(real, vector))
"""Of a contact law: elastic energy and plastic work, from indentation and coefficients."""

levels = types.FunctionType(types.UniTuple(real, 5)(vector))
"""Of a contact law: indentations at touch, release, change of memory, and two breakpoints."""

compressed = types.FunctionType(real(real, vector, vector))
"""Of a contact law: its coefficients after a deepest indentation.

They are written into a copy of them, the last argument. It returns the indentation beyond which
compression changes the memory again.
"""

slip_after = types.FunctionType(real(real, real, real, real, vector))
"""Of a friction law: the slip.

The arguments are slip without friction, normal impulse so far and as a whole, effective mass and
coefficients.
"""

friction = types.FunctionType(real(real, real, vector))
"""Of a friction law: the friction force against the slip, from it, normal force, coefficients."""


def signature_of(function: Callable[..., Any]) -> Signature:
    """Return numba's signature of a function, from its annotations.

    Raises
    ------
    TypeError
        If an annotation is missing, or not among those that `vibroimpact.compiled.compiled` takes.
    """
    annotations = get_type_hints(function, include_extras=True)
    code = function.__code__
    members = []
    for name in ["return", *code.co_varnames[: code.co_argcount]]:
        if name not in annotations:
            raise TypeError(f"{function.__qualname__}: {name}: it is not annotated")
        try:
            members.append(type_of(annotations[name]))
        except (KeyError, TypeError, ValueError) as error:
            raise TypeError(f"{function.__qualname__}: {name}: {error}") from None
    returned, *parameters = members
    return returned(*parameters)


@cache
def type_of(annotation: Any) -> types.Type:
    """Return numba's type of an annotation."""
    if annotation in _SCALARS:
        return _SCALARS[annotation]
    if get_origin(annotation) is tuple:
        return types.Tuple([type_of(member) for member in get_args(annotation)])
    if get_origin(annotation) in (np.ndarray, NDArray):
        return _array(annotation, dimensions=1)
    if get_origin(annotation) is Annotated:
        described, description = get_args(annotation)
        if description == "lent":
            return Lent(type_of(described))
        return _array(described, dimensions=description)
    if hasattr(annotation, "_fields"):
        return _named_tuple(annotation)
    raise TypeError(f"no type of compiled functions is {annotation}")


def _array(annotation: Any, dimensions: int) -> types.Type:
    """Return the type of a C-contiguous array, from an annotation by `numpy.typing.NDArray`."""
    *_, element = get_args(annotation)
    if get_origin(element) is np.dtype:  # NumPy before 2.5 expands its alias
        (element,) = get_args(element)
    return types.Array(from_dtype(np.dtype(element)), dimensions, "C")


def _named_tuple(kind: Any) -> types.Type:
    annotations = get_type_hints(kind, include_extras=True)
    members = [type_of(annotations[name]) for name in kind._fields]
    if len(set(members)) == 1:
        return types.NamedUniTuple(members[0], len(members), kind)
    return types.NamedTuple(members, kind)


def text_of(signature: Signature) -> str:
    """Return a text of numba's signature, with all that it says of named tuples."""
    return " ".join([str(signature), *map(_fields, (signature.return_type, *signature.args))])


def _fields(kind: Any) -> str:
    """Return the names of the members of a named tuple, which the name of its type leaves out."""
    kind = getattr(kind, "kind", kind)  # of one that is lent
    members = [_fields(member) for member in getattr(kind, "types", ())]
    return " ".join([str(getattr(kind, "fields", "")), *members])
