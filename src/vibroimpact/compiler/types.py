"""The types of compiled functions, by the names that signatures use."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

from numba import types

from vibroimpact.compiler.lending import Lent

real = types.float64
integer = types.int64
boolean = types.boolean
vector = types.float64[::1]
matrix = types.float64[:, ::1]
cube = types.float64[:, :, ::1]
address = types.int64
integers = types.int64[::1]
booleans = types.boolean[::1]
void = types.void
complex = types.complex128
complexes = types.complex128[::1]

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


def tuple(*members: types.Type) -> types.Type:
    """Return the type of a tuple, from those of its members."""
    return types.Tuple(members)


def of(kind: type) -> types.Type:
    """Return the type of a named tuple.

    Its members are annotated with names of types, as `Vector`, or of other named tuples.
    """
    module = sys.modules[kind.__module__]
    members = [
        _member(annotation.__forward_arg__, module) for annotation in kind.__annotations__.values()
    ]
    if len(set(members)) == 1:
        return types.NamedUniTuple(members[0], len(members), kind)
    return types.NamedTuple(members, kind)


def lent(kind: type) -> types.Type:
    """Return the type of a named tuple that Python lends to a compiled function."""
    return Lent(of(kind))


def text_of(signature: Any) -> str:
    """Return a text of numba's signature, with all that it says of named tuples."""
    return " ".join([str(signature), *map(_fields, (signature.return_type, *signature.args))])


def _fields(kind: Any) -> str:
    """Return the names of the members of a named tuple, which the name of its type leaves out."""
    kind = getattr(kind, "kind", kind)  # of one that is lent
    members = [_fields(member) for member in getattr(kind, "types", ())]
    return " ".join([str(getattr(kind, "fields", "")), *members])


def _member(name: str, module: ModuleType) -> types.Type:
    member_type = globals().get(name.lower())
    if isinstance(member_type, types.Type):
        return member_type
    return of(getattr(module, name))
