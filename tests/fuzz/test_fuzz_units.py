"""Quantities and units made of hostile pieces: each is read or refused with a sentence,
in no time.
"""

from __future__ import annotations

import random

from hostile_runs import failures, number, seed
from vibroimpact.errors import InputError
from vibroimpact.units.reading import convert_units, dimension_of, parse_quantity, to_si

UNITS = [
    "m", "mm", "kg", "s", "N", "Pa", "GPa", "Hz", "J", "rad", "deg", "%", "degC", "dB", "byte", "lbf", "inch", "µm", "kkg", "e", "pi",
    "nan",
]  # fmt: skip
PIECES = [
    *UNITS, *UNITS, "/", "*", "**", "^", "^", " ", ".", "-", "+", "(", ")", "[", "]", ",", "1", "2", "9", "1.5", "0.5", "-1", "1/", "99",
    "999", "1e5", "1e400", "99999999", "9" * 30, "\u00b2", "\u00b7", "\u03bc", "\x00", "\x1b[31m", "\n", "'", '"', "{", "}", "$", "_",
    "__import__", "import os", "lambda", "per", "squared", "cubed", "delta_", "(" * 30, ")" * 30, "^9" * 9, "**9" * 9, "1/" * 1000,
    "m " * 1000, "m" * 1000, " " * 5000,
]  # fmt: skip
KNOWN = [
    "s^9^9^9", "s**9**9**9", "m**99999999", "m^(9^9^9)", "m^-(9^9^9)", "(((((((((m)))))))))", "m" + "(" * 38, "1/" * 1000, "m*9^9^9^9",
    "((m^99)^99)^99", "(m^99)^(99^99)", "km^99^99", "m^9.9^9.9^9.9", "999^999^999", "9**9**9**9", "m^(1/0)", "m/0", "1/0", "m%0", "m//0",
    "((km^9)^99)^99/((m^9)^99)^99*m",
]  # fmt: skip


def hostile(choose: random.Random) -> str:
    """A unit of some pieces, or one that is known to be hostile with a piece put in."""
    pieces = [choose.choice(KNOWN)] if choose.random() < 0.2 else []
    pieces += choose.choices(PIECES, k=choose.randint(1, 7))
    choose.shuffle(pieces)
    return "".join(pieces)


def test_hostile_units() -> None:
    def work(unit: str) -> None:
        choose = random.Random(unit)
        told: list[InputError] = []
        for action in (
            lambda: to_si(
                f"{choose.choice(['1', '1e300', '1e-300', '.5', '1e99999'])} {unit}",
                choose.choice(["m", "Pa", "N/m^1.5", ""]),
            ),
            lambda: to_si(unit, "m"),
            lambda: convert_units(1.0, unit, choose.choice(UNITS)),
            lambda: convert_units(1.0, choose.choice(UNITS), unit),
            lambda: dimension_of(unit),
            lambda: parse_quantity(f"1 {unit}"),
        ):
            try:
                action()
            except InputError as error:
                told.append(error)
        # the longest and the least printable of what was said is judged
        if told:
            raise max(told, key=lambda error: (not str(error).isprintable(), len(str(error))))

    units = [*KNOWN, *(hostile(random.Random(seed(one))) for one in range(number(150)))]
    told = failures(work, units)
    assert not told, told
