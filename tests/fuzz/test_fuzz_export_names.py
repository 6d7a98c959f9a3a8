"""Random names of cases, sensors and materials in every export format: each says what it
says under plain names.
"""

from __future__ import annotations

import random
from functools import cache
from typing import Any

import pytest

from deck_values import named, said
from hostile_runs import failures, number, seed
from vibroimpact.exporting.export_format import export_formats, find_export_format

PIECES = [
    *"$&#!;%'\"`\\/<>{}[]()*?-_=+,.:|~^@ \t\n\r\0\x1b\x7f\x85\u2028\u202e\ud800",
    *(
        "${",
        "$(",
        '"""',
        "-->",
        "--",
        "*/",
        "]]>",
        "&#",
        "\\n",
        "../",
        "    -1\n",
        " &\n",
        "adams_view_name='",
        "coding:",
        "END\n",
        "run 9\n",
    ),
    *("a", "Z", "0", "é", "岩", "𝛿", "e\u0301", "con", "nul", "sphere", "model", "x" * 90),
]


def some_name(chance: random.Random) -> str:
    return "".join(chance.choice(PIECES) for _ in range(chance.choice((1, 2, 3, 5, 9, 40))))


@cache
def plainly(format: str) -> Any:
    return said(find_export_format(format), named("plain", ["s0", "s1", "s2"], ("rock", "steel")))


def write_and_read(given: tuple[str, str, list[str], tuple[str, str]]) -> None:
    format, case, sensors, materials = given
    assert said(find_export_format(format), named(case, sensors, materials)) == plainly(format)


# where no name goes
@pytest.mark.parametrize("format", [name for name in export_formats() if name != "vtu"])
def test_random_names_do_nothing(format: str) -> None:
    if format == "parquet":
        pytest.importorskip("pyarrow")
    if format == "uff58":
        pytest.importorskip("pyuff")
    chance = random.Random(f"names for {format} {seed(0)}")
    names = [[some_name(chance) for _ in range(6)] for _ in range(number(10))]
    inputs = [
        (format, one[0], [*one[1:3], one[3] + "3"], (one[4], one[5]))
        for one in names
        if len({one[1], one[2], one[3] + "3"}) == 3
    ]
    plainly(format)  # for all
    found = failures(write_and_read, inputs)
    assert not found, found
