"""The types of compiled functions, by the names that signatures use."""

from __future__ import annotations

import sys
from types import ModuleType

from numba import types

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
"""The force of a contact law: indentation, its rate, approach speed and coefficients give
static and dissipative force.
"""

energies = types.FunctionType(pair(real, vector))
"""Of a contact law: indentation and coefficients give elastic energy and plastic work."""

levels = types.FunctionType(types.UniTuple(real, 5)(vector))
"""Of a contact law: coefficients give the indentations at touch, release, change of
memory, and two breakpoints.
"""

compressed = types.FunctionType(real(real, vector, vector))
"""Of a contact law: what a deepest indentation changes in the coefficients is written into a copy
of them, the last argument.

It returns the indentation beyond which compression changes the memory again.
"""

slip_after = types.FunctionType(real(real, real, real, real, vector))
"""Of a friction law: slip without friction, normal impulse so far and as a whole, effective mass
and coefficients give the slip.
"""

friction = types.FunctionType(real(real, real, vector))
"""Of a friction law: slip, normal force and coefficients give the friction force against the slip.
"""


def tuple(*members: types.Type) -> types.Type:
    """Return the type of a tuple, from those of its members."""
    return types.Tuple(members)


def of(kind: type) -> types.Type:
    """Return the type of a named tuple whose members are annotated with names of types,
    as `Vector`, or of other named tuples.
    """
    module = sys.modules[kind.__module__]
    members = [
        _member(annotation.__forward_arg__, module) for annotation in kind.__annotations__.values()
    ]
    alike = len(set(members)) == 1
    return (
        types.NamedUniTuple(members[0], len(members), kind)
        if alike
        else types.NamedTuple(members, kind)
    )


def _member(name: str, module: ModuleType) -> types.Type:
    found = globals().get(name.lower())
    return found if isinstance(found, types.Type) else of(getattr(module, name))
