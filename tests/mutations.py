"""Hostile versions of case files: of the tables that they hold, and of their text."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable, Iterator
from typing import Any

import tomli_w

from seeds import ELASTIC, Table, seeds, study_seeds
from support import plain_case

TEXTS = (
    "", " ", "x" * 300, "y" * 20_000, "\x1b[31mred", "\x1b]0;title\x07", "a\nb", "a\r\nb", "a\x00b", "[red]b[/red]",
    "[/]", "a$\\frac{$b", "&lt;<b>",
    "../../etc/passwd", "/", "/dev/zero", "/dev/null", "/proc/self/mem", "~", ".", "nan", "inf", "-inf", "1e999 m",
    "1e-400 m", "9" * 60 + " m",
    "1e300 km", "25 mm mm", "s^9^9^9", "5 s^9^9^9", "5 m^999999", "5 " + "(" * 30 + "m", "25 kg", "25 mm", "2.26 GPa",
    "1 mm/s", "0 m", "-3 m",
    "rigid", "elastic", "hertz", "newton", "adams-default", "loss-factor", "free", "clamped", "all", "\u202egnp.exe",
    "\u0000", "\ud7ff",
    "\U0001f600" * 50, "\u0663 m", "e\u0301" * 200, "%s%n", "{0}", "${HOME}", "`id`", "consistent", "superposed",
    "identified", "solid", "linear",
)  # fmt: skip
NUMBERS = (
    0, 1, -1, 2, 3, 10, 0.0, -0.0, 0.5, 1.0, 1e-3, 1e-6, 1e-12, 1e-100, 5e-324, 1e-308, 1e3, 1e6, 1e9, 1e12, 1e100,
    1e154, 1e308, -1e308,
    float("nan"), float("inf"), float("-inf"), 2**31, 2**63 - 1, -(2**63), 10**9, 10**18, 100_000, 20_000,
)  # fmt: skip


def deep(levels: int, table: bool = False) -> Any:
    """Return lists or tables that lie so deep in one another."""
    found: Any = 1
    for _ in range(levels):
        found = {"a": found} if table else [found]
    return found


OTHERS: tuple[Callable[[], Any], ...] = (
    lambda: True, lambda: False, list, dict, lambda: [[]], lambda: [{}], lambda: [1, 2], lambda: [1.0, "2 m", True], lambda: deep(12),
    lambda: deep(150), lambda: deep(150, table=True), lambda: [0.5] * 5000, lambda: ["a"] * 5000,
    lambda: {str(number): 1 for number in range(3000)},
    lambda: {"a": 1}, lambda: {"type": "patch"}, lambda: {"file": "/dev/zero"}, lambda: {"file": ""}, lambda: {"law": "hertz"},
    lambda: {"from": 0, "to": 1e300, "number": 9_000_000}, lambda: [{"type": "point", "position": [0, 0]}] * 2000,
    lambda: {"distribution": "normal", "mean": 1e300, "standard_deviation": 1e300}, lambda: {"element_size": 1e-9},
    lambda: {"layers": 10**9},
    lambda: {"elements": 10**12}, lambda: {"elements_across": 10**6}, lambda: {"\x1b[0m": 1}, lambda: {"x" * 5000: 1},
)  # fmt: skip


def mutated_table(table: Table, choose: random.Random) -> Table:
    """Return a table with a few hostile changes."""
    found = copy.deepcopy(table)
    for _ in range(choose.choice((1, 1, 1, 2, 3))):
        choose.choice(_CHANGES)(found, choose)
    return found


def mutated_text(text: str, choose: random.Random) -> bytes:
    """Return a file with a few faults of the kinds that editors, disks and people make."""
    data = text.encode()
    for _ in range(choose.choice((1, 1, 2, 3))):
        data = choose.choice(_DAMAGES)(data, choose)
    return data


def damaged_bytes(data: bytes, choose: random.Random) -> bytes:
    """Return a binary file with bytes changed, lost, doubled or cut off."""
    changed = bytearray(data)
    for _ in range(choose.choice((1, 1, 2, 8))):
        at = choose.randrange(len(changed) + 1)
        early = min(at, choose.randrange(200))  # where headers are
        number = choose.choice((1, 2, 4, 100))
        kind = choose.randrange(5)
        if kind == 0:
            changed[early : early + number] = choose.randbytes(number)
        elif kind == 1:
            changed[at : at + number] = b""
        elif kind == 2:
            changed[early:early] = changed[early : early + number]
        elif kind == 3:
            changed[early : early + number] = (
                choose.choice((b"\0", b"\xff", b"\x7f", b"\n", b"-1\n")) * number
            )
        else:
            del changed[at:]
    return bytes(changed)


def case_files(count: int, seed: int) -> Iterator[bytes]:
    """Yield hostile case files: two of three by their tables, the others by their text."""
    choose = random.Random(seed)
    while count > 0:
        table = choose.choice(seeds())
        try:
            yield (
                tomli_w.dumps(mutated_table(table, choose)).encode()
                if choose.random() < 2 / 3
                else mutated_text(tomli_w.dumps(table), choose)
            )
        except (UnicodeEncodeError, RecursionError):
            continue  # no file can hold it
        count -= 1


def elastic_cases(count: int, seed: int) -> Iterator[Table]:
    """Yield hostile cases of vibrating bodies, whose modes are quick to compute: most by
    their numbers, which are accepted most easily.
    """
    choose = random.Random(seed)
    for _ in range(count):
        table = plain_case(**copy.deepcopy(ELASTIC))
        for _ in range(choose.choice((1, 1, 2, 3))):
            choose.choice((_scale, _scale, _scale, *_CHANGES))(table, choose)
        yield table


def studies(count: int, seed: int) -> Iterator[Table]:
    """Yield hostile studies."""
    choose = random.Random(seed)
    for _ in range(count):
        yield mutated_table(choose.choice(study_seeds()), choose)


def _places(inside: Any) -> Iterator[tuple[Any, Any]]:
    """Yield every place in a table: what holds it, and its key or number there."""
    for key in list(inside) if isinstance(inside, dict) else range(len(inside)):
        yield inside, key
        if isinstance(inside[key], (dict, list)):
            yield from _places(inside[key])


def _place(table: Table, choose: random.Random) -> tuple[Any, Any]:
    return choose.choice(list(_places(table)) or [(table, "sphere")])


def _hostile(choose: random.Random) -> Any:
    return choose.choice(
        (lambda: choose.choice(TEXTS), lambda: choose.choice(NUMBERS), choose.choice(OTHERS))
    )()


def _replace(table: Table, choose: random.Random) -> None:
    holder, key = _place(table, choose)
    holder[key] = _hostile(choose)


def _scale(table: Table, choose: random.Random) -> None:
    """Change a number by powers of ten: the slip that is accepted most easily."""
    numbers = [(holder, key) for holder, key in _places(table) if type(holder[key]) in (int, float)]
    if numbers:
        holder, key = choose.choice(numbers)
        holder[key] = holder[key] * 10.0 ** choose.choice(
            (-300, -30, -12, -6, -3, -1, 1, 3, 6, 12, 30, 300)
        )


def _remove(table: Table, choose: random.Random) -> None:
    holder, key = _place(table, choose)
    del holder[key]


def _add(table: Table, choose: random.Random) -> None:
    holder, _ = _place(table, choose)
    keys = (
        *TEXTS,
        "name",
        "mesh",
        "damping",
        "supports",
        "modes",
        "sensors",
        "run",
        "duration",
        "impacts",
        "tolerance",
        "position",
        "size",
        "model",
    )
    value = _hostile(choose)
    if isinstance(holder, dict):
        holder[choose.choice(keys)] = value
    else:
        holder.append(value)


def _swap(table: Table, choose: random.Random) -> None:
    (one, here), (other, there) = _place(table, choose), _place(table, choose)
    one[here], other[there] = copy.deepcopy(other[there]), copy.deepcopy(one[here])


def _repeat(table: Table, choose: random.Random) -> None:
    lists = [
        (holder, key)
        for holder, key in _places(table)
        if isinstance(holder[key], list) and holder[key]
    ]
    if lists:
        holder, key = choose.choice(lists)
        times = choose.choice((2, 50, 3000))
        # beyond, and that is refused by the bytes of the file
        if len(repr(holder[key])) * times < 1_000_000:
            holder[key] = holder[key] * times


_CHANGES = (_replace, _replace, _replace, _scale, _remove, _add, _swap, _repeat)


def _edit(data: bytes, choose: random.Random) -> bytes:
    changed = bytearray(data)
    for _ in range(choose.randint(1, 4)):
        changed[choose.randrange(len(changed))] = choose.choice(
            (choose.randrange(256), *b'0123456789"[]{}=.,#\n\\')
        )
    return bytes(changed)


def _cut(data: bytes, choose: random.Random) -> bytes:
    start = choose.randrange(len(data))
    return data[:start] + data[start + choose.choice((1, 5, 40, 4000)) :] + b"\n"


_TOKENS = (
    b"[" * 50, b"[" * 900, b"a = " + b"[" * 900 + b"]" * 900, b"a = " + b"{a=" * 300 + b"1" + b"}" * 300, b"9" * 5000,
    b"1e999", b"0x" + b"f" * 3000,
    b"a." * 3000 + b"b = 1", b'"' + b"x" * 90_000 + b'" = 1', b"\x1b[2J", b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b'"""',
    b"'''", b" " * 90_000, b"#" * 90_000,
    b"[[sensors]]\nname='a'\nposition=[0,0]\n" * 400, b"1979-05-27T07:32:00Z", b"07:32:00", b"1_000", b"0b1", b"nan",
    b"-inf", b"\\u001b", b"\\U0010ffff",
    b"[sphere]", b"[[sphere]]", b"\r", b"\n" * 5000, b"[a.b.c]", b"= =",
)  # fmt: skip


def _insert(data: bytes, choose: random.Random) -> bytes:
    at, token = choose.randrange(len(data)), choose.choice(_TOKENS)
    around = choose.choice((b"", b" ", b"\n", b'"'))
    return data[:at] + around + token + around + data[at:]


def _line(data: bytes, choose: random.Random) -> bytes:
    lines = data.split(b"\n")
    at = choose.randrange(len(lines))
    lines[at : at + 1] = choose.choice(
        ([], [lines[at]] * 2, [lines[at]] * 2000, [choose.choice(_TOKENS)], [choose.choice(lines)])
    )
    return b"\n".join(lines) + b"\n"


def _value(data: bytes, choose: random.Random) -> bytes:
    lines = data.split(b"\n")
    places = [number for number, line in enumerate(lines) if b"=" in line]
    if places:
        at = choose.choice(places)
        lines[at] = lines[at].partition(b"=")[0] + b"= " + choose.choice(_TOKENS)
    return b"\n".join(lines) + b"\n"


_DAMAGES = (_edit, _cut, _insert, _line, _value)
