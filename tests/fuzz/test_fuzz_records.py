"""Damaged sound and universal files: each is read, or refused by one message, within
bounds of time and memory.
"""

from __future__ import annotations

import random
import struct
from collections.abc import Callable
from pathlib import Path

import pytest

import hostile_runs
import vibroimpact as vi
from mutations import damaged_bytes

RATES = (0, 1, 8000, 44100, 192_000, 2**31, 2**32 - 1)
SIZES = (0, 1, 2, 3, 4, 7, 8, 16, 17, 40, 2**16, 2**31 - 1, 2**31, 2**32 - 8, 2**32 - 1)
COMMENTS = (
    "1.0 is 2.5 V (voltage of a)", "1.0 is -- V", "1.0 is -- V (x of y)", "1.0 is e V ()", "1.0 is nan V (a)", "1.0 is 1e999 V (a)",
    "1.0 is 0 V (a)", "1.0 is 1e300 V (a)", "1.0 is 2.5 parsec (a)", "1.0 is 2.5 m^999999 (a)", "1.0 is " + "9" * 3000 + " V (a)",
    "1.0 is 1 " + "(" * 3000 + ")", "1.0 is 1 V (" + " of " * 900 + ")", "1.0 is 1 V (\x1b[31m of \x00\u202e)", "",
)  # fmt: skip
TAIL = bytes.fromhex("800000aa00389b71")


def chunk(order: str, name: bytes, content: bytes, size: int | None = None) -> bytes:
    return (
        struct.pack(f"{order}4sI", name, len(content) if size is None else size)
        + content
        + b"\0" * (len(content) % 2)
    )


def wave_file(choose: random.Random) -> bytes:
    """A sound file of any format, most with a hostile field or two."""

    def mostly(value: int, *others: int) -> int:
        return choose.choice(others) if choose.random() < 0.04 else value

    def size() -> int | None:
        return choose.choice(SIZES) if choose.random() < 0.08 else None

    order = choose.choice("<<<>")
    width, channels = choose.choice((1, 2, 3, 4, 5, 8)), choose.choice((1, 1, 2, 5))
    tag = choose.choice((1,) * 6 + (0xFFFE,) * 4 + (0, 2) + (3,) * 6 * (width in (4, 8)))
    wide, heard = mostly(width, 0, 9, 255), mostly(channels, 0, 255, 65535)
    frame, bits = mostly(wide * heard % 65536, 0, 1, 65535), mostly(8 * width, 0, 1, 12, 20, 65535)
    rate = mostly(8000, *RATES)
    form = struct.pack(
        f"{order}HHIIHH", tag, heard, rate, mostly(rate * frame % 2**32, 0), frame, bits
    )
    if tag == 0xFFFE:
        form += struct.pack(
            f"{order}HHIIHH", 22, bits, 0, choose.choice((1, 1, 3, 6)), 0, 16
        ) + choose.choice((TAIL, TAIL, TAIL, TAIL, b"", TAIL[::-1]))
    samples = choose.randbytes(choose.choice((0, 1, 2, 30, 2000, 100_001, 2000, 4000)))
    words = b"INFO" + chunk(
        order,
        b"ICMT",
        choose.choice(COMMENTS if choose.random() < 0.5 else COMMENTS[:1]).encode() + b"\0",
    )
    pieces = [
        chunk(order, b"fmt ", form, size()),
        chunk(order, b"data", samples, size()),
    ]
    if choose.random() < 0.6:
        pieces.insert(choose.randrange(3), chunk(order, b"LIST", words, size()))
    if choose.random() < 0.3:
        pieces.insert(
            choose.randrange(3), chunk(order, b"ds64", choose.randbytes(choose.choice((0, 8, 24))))
        )
    if choose.random() < 0.2:
        pieces = pieces * choose.choice((0, 1, 2, 2000 if len(samples) < 100 else 2))
    kind = choose.choice((b"RIFF", b"RIFF", b"RF64")) if order == "<" else b"RIFX"
    return (
        kind + struct.pack(f"{order}I", choose.choice((1000, *SIZES))) + b"WAVE" + b"".join(pieces)
    )


def universal_file(choose: random.Random) -> bytes:
    """A universal file with functions in text and bytes, most with a hostile field or two."""

    def field(value: object, width: int) -> str:
        if choose.random() < 0.02:
            value = choose.choice(
                (0, -1, 1, 5, 9, 10**9, 2**31, "nan", "inf", "1e999", "", "x", "9" * 30, "-0.0")
            )
        return str(value).rjust(width)

    pieces = []
    for number in range(choose.choice((0, 1, 1, 1, 2, 2, 5))):
        count, kind, double, even = (
            choose.choice((0, 1, 2, 2, 12, 12, 12, 50, 50, 500, 500)),
            choose.choice((8, 9, 12, 13, 0)),
            choose.random() < 0.5,
            choose.random() < 0.7,
        )
        ordinate, size = (4, 8) if double else (2, 4)
        binary = choose.random() < 0.4
        length = count * (size if even else size + 4)
        header = "    58"
        if binary:
            header += (
                "b"
                + field(choose.choice((1, 2)), 6)
                + field(2, 6)
                + field(11, 12)
                + field(length, 12)
                + "     0     0           0           0"
            )
        lines = [header, f"channel {number}", "NONE", "NONE", "NONE", "NONE"]
        lines.append(
            "    1         0    0         0  NONE               0   0  NONE               0   0"
        )
        lines.append(
            field(ordinate, 10)
            + field(count, 10)
            + field(int(even), 10)
            + field("0.0", 13)
            + field("1.0E-03", 13)
            + field("0.0", 13)
        )
        lines.append(field(17, 10) + "    0    0    0 Time                 s                   ")
        lines.append(
            field(kind, 10)
            + "    0    0    0 Signal               "
            + choose.choice(("V", "N", "m/s2", "NONE", "V", "N", "mV", "x" * 300)).ljust(20)
        )
        lines += ["         0    0    0    0 NONE                 NONE                "] * 2
        values = [choose.gauss(0.0, 1.0) for _ in range(count)]
        if binary:
            body = b"".join(
                (b"" if even else struct.pack("<f", 1e-3 * at))
                + struct.pack("<d" if double else "<f", one)
                for at, one in enumerate(values)
            )
        else:
            cells = [
                ("" if even else f"{1e-3 * at:13.5E}")
                + (f"{one:20.11E}" if double else f"{one:13.5E}")
                for at, one in enumerate(values)
            ]
            each = (4 if double else 6) if even else (2 if double else 3)
            body = "\n".join(
                "".join(cells[at : at + each]) for at in range(0, count, each)
            ).encode()
        if choose.random() < 0.1:
            body = choose.randbytes(length)
        pieces.append("\n".join(["    -1", *lines]).encode() + b"\n" + body + b"\n    -1\n")
    units = (
        "    -1\n   164\n"
        + field(1, 10)
        + "SI: Metre (newton)".rjust(20)
        + field(2, 10)
        + "\n"
        + "".join(field("1.0D+00", 25) for _ in range(3))
    )
    pieces.insert(
        choose.randrange(len(pieces) + 1),
        units.encode() + b"\n" + field("2.7D+02", 25).encode() + b"\n    -1\n",
    )
    return b"".join(pieces)


@pytest.mark.parametrize(("name", "make"), [("sound.wav", wave_file), ("test.uff", universal_file)])
@pytest.mark.parametrize("few", [40, pytest.param(400, marks=pytest.mark.slow)])
def test_damaged_records(
    name: str, make: Callable[[random.Random], bytes], few: int, tmp_path: Path
) -> None:
    choose = random.Random(hostile_runs.seed(58 + few))

    def read(content: bytes) -> None:
        (tmp_path / name).write_bytes(content)
        vi.signals.record_table(
            vi.signals.load_records(tmp_path / name), ["rms", "peak", "clipped_part"]
        )

    whole = [make(choose) for _ in range(hostile_runs.number(few))]
    files = [
        damaged_bytes(content, choose) if choose.random() < 0.5 else content for content in whole
    ]
    assert hostile_runs.failures(read, files) == ""
