"""Adams' function expressions, parsed and evaluated as its manual describes them; nothing here
knows how the package writes them.

Precedence: `**` binds tighter than a sign on its left and looser than one on its right, and from
right to left; then `*` and `/`; then `+` and `-`. Functions that are not in this file, wrong counts
of arguments and references to nothing are refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field


class Refused(Exception):
    """The file is not what the manual describes."""


@dataclass
class State:
    """Height and velocity of each marker, what each sensor holds, and VX, VY, WX, WY and
    WZ of each marker.
    """

    heights: Mapping[str, float]
    velocities: Mapping[str, float]
    held: Mapping[str, float]
    along: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


Value = Callable[[State], float]


@dataclass
class Scope:
    """What an expression may refer to. `touches` gathers what changes its sign, from
    above, when a contact begins.
    """

    markers: Mapping[str, object]
    sensors: Mapping[str, object]
    variables: Mapping[str, Value]
    forces: Mapping[str, Value] = field(default_factory=dict)
    touches: list[Value] = field(default_factory=list)


_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+)?)|(?P<path>\.[A-Za-z_]\w*(?:\.\w+)*)|(?P<word>[A-Za-z_]\w*)|(?P<sign>\*\*|[-+*/(),:]))"
)

_MARKERS = {"DZ": 3, "VZ": 4, "VX": 4, "VY": 4, "WX": 3, "WY": 3, "WZ": 3}
"""How many markers a measure takes at most: of what, from what, along whose axis, seen
from where.
"""

_PLAIN: dict[str, tuple[int, Callable[..., float]]] = {
    "SQRT": (1, math.sqrt),
    "ABS": (1, abs),
    "EXP": (1, math.exp),
    "MAX": (2, max),
    "MIN": (2, min),
}


def step(x: float, x0: float, h0: float, x1: float, h1: float) -> float:
    """STEP, the cubic between two levels."""
    s = min(max((x - x0) / (x1 - x0), 0.0), 1.0)
    return h0 + (h1 - h0) * s * s * (3.0 - 2.0 * s)


def impact(x: float, rate: float, x1: float, k: float, e: float, cmax: float, d: float) -> float:
    """IMPACT, never negative."""
    if not (x1 > 0 and k >= 0 and e > 0 and cmax >= 0 and d > 0):
        raise Refused(f"IMPACT does not take x1 = {x1}, k = {k}, e = {e}, cmax = {cmax}, d = {d}")
    if x >= x1:
        return 0.0
    return max(0.0, k * (x1 - x) ** e - cmax * rate * step(x, x1 - d, 1.0, x1, 0.0))


def parse_function(text: str, scope: Scope) -> Value:
    """Return what evaluates an expression."""
    tokens: list[tuple[str, str]] = []
    position, text = 0, text.rstrip()
    while position < len(text):
        found = _TOKEN.match(text, position)
        if not found or found.lastgroup is None:
            raise Refused(f"no function expression: {text[position:]!r}")
        tokens.append((found.lastgroup, found[found.lastgroup]))
        position = found.end()
    parser = _Parser(tokens, scope)
    value = parser.sum()
    if parser.tokens:
        raise Refused(f"{parser.tokens[0][1]!r} is too much in {text!r}")
    return value


class _Parser:
    def __init__(self, tokens: list[tuple[str, str]], scope: Scope) -> None:
        self.tokens, self.scope = tokens, scope

    def take(self, *wanted: str) -> str:
        if not self.tokens or (wanted and self.tokens[0][1] not in wanted):
            raise Refused(
                f"{' or '.join(wanted) or 'something'} is missing before {self.tokens[:1]}"
            )
        return self.tokens.pop(0)[1]

    def next_is(self, *signs: str) -> bool:
        return bool(self.tokens) and self.tokens[0][1] in signs

    def sum(self) -> Value:
        value = self.product()
        while self.next_is("+", "-"):
            sign, left, right = self.take(), value, self.product()
            value = (
                (lambda s, a=left, b=right: a(s) + b(s))
                if sign == "+"
                else (lambda s, a=left, b=right: a(s) - b(s))
            )
        return value

    def product(self) -> Value:
        value = self.signed()
        while self.next_is("*", "/"):
            sign, left, right = self.take(), value, self.signed()
            value = (
                (lambda s, a=left, b=right: a(s) * b(s))
                if sign == "*"
                else (lambda s, a=left, b=right: a(s) / b(s))
            )
        return value

    def signed(self) -> Value:
        if self.next_is("-"):
            self.take()
            inner = self.signed()
            return lambda s: -inner(s)
        if self.next_is("+"):
            self.take()
            return self.signed()
        return self.power()

    def power(self) -> Value:
        base = self.primary()
        if not self.next_is("**"):
            return base
        self.take()
        exponent = self.signed()
        return lambda s: base(s) ** exponent(s)

    def primary(self) -> Value:
        if self.next_is("("):
            self.take()
            value = self.sum()
            self.take(")")
            return value
        if not self.tokens:
            raise Refused("an expression ends too early")
        kind, text = self.tokens.pop(0)
        if kind == "number":
            number = float(text.upper().replace("D", "E"))
            return lambda s: number
        if kind != "word":
            raise Refused(f"{text!r} can't stand here")
        return self.function(text.upper())

    def function(self, name: str) -> Value:
        self.take("(")
        if name == "IF":
            return self.arithmetic_if()
        value = (
            self.measure(name)
            if name in (*_MARKERS, "SENVAL", "VARVAL", "SFORCE")
            else self.general(name)
        )
        self.take(")")
        return value

    def arithmetic_if(self) -> Value:
        test = self.sum()
        self.take(":")
        below, _, at, _, above = self.sum(), self.take(","), self.sum(), self.take(","), self.sum()
        self.take(")")

        def chosen(s: State) -> float:
            number = test(s)
            return (below if number < 0 else above if number > 0 else at)(s)

        return chosen

    def references(self) -> list[str]:
        found = []
        while True:
            kind, text = self.tokens.pop(0) if self.tokens else ("", "")
            if kind not in ("number", "path") or (kind == "number" and not text.isdigit()):
                raise Refused(f"{text!r} names no element")
            found.append(text)
            if not self.next_is(","):
                return found
            self.take(",")

    def measure(self, name: str) -> Value:
        ids = self.references()
        scope = self.scope
        if name in _MARKERS:
            if not 1 <= len(ids) <= _MARKERS[name]:
                raise Refused(f"{name} of {len(ids)} markers")
            if missing := [one for one in ids if one not in scope.markers]:
                raise Refused(f"{name}: there is no marker {missing[0]}")
            first, second = ids[0], ids[1] if len(ids) > 1 else None
            plain = {"DZ": lambda s: s.heights, "VZ": lambda s: s.velocities}
            of = plain.get(name, lambda s: s.along[name])
            return lambda s: of(s)[first] - (of(s)[second] if second is not None else 0.0)
        known: Mapping[str, object] = {
            "SENVAL": scope.sensors,
            "VARVAL": scope.variables,
            "SFORCE": scope.forces,
        }[name]
        if ids[0] not in known:
            raise Refused(f"{name}: there is no {ids[0]}")
        if name == "SFORCE":
            # of the I marker, along z, seen from a marker
            if len(ids) != 4 or ids[1] != "0" or ids[2] != "4" or ids[3] not in scope.markers:
                raise Refused(f"SFORCE({', '.join(ids)})")
            return scope.forces[ids[0]]
        if len(ids) != 1:
            raise Refused(f"{name} takes one argument")
        if name == "SENVAL":
            return lambda s: s.held[ids[0]]
        return scope.variables[ids[0]]

    def general(self, name: str) -> Value:
        arguments = [self.sum()]
        while self.next_is(","):
            self.take(",")
            arguments.append(self.sum())
        counts = {"STEP": (5, step), "IMPACT": (7, impact), **_PLAIN}
        if name not in counts:
            raise Refused(f"there is no function {name}")
        count, of = counts[name]
        if len(arguments) != count:
            raise Refused(f"{name} takes {count} arguments, not {len(arguments)}")
        if name == "IMPACT":
            x, free = arguments[0], arguments[2]
            self.scope.touches.append(lambda s: x(s) - free(s))
        if name == "MAX":
            first, second = arguments
            self.scope.touches.append(lambda s: second(s) - first(s))
        return lambda s: of(*(argument(s) for argument in arguments))
