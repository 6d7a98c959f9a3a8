"""Reading of universal files (UFF): functions of time and frequency responses in datasets
58, text or binary, and units of dataset 164.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.errors import InputError
from vibroimpact.files.reading import FileKind, beginning, read_bytes, with_path

UNIVERSAL = FileKind(
    "a universal file holds datasets between lines of -1",
    100_000_000,
    "keep the functions that are needed",
)
"""Requirements on a universal file."""

SPHERE_FUNCTIONS = {
    "position_m": ("height of the sphere's centre", 8, "m"),
    "velocity_m_s": ("velocity of the sphere", 11, "m/s"),
    "acceleration_m_s2": ("acceleration of the sphere", 12, "m/s2"),
    "force_N": ("contact force on the sphere", 13, "N"),
}
"""The motion of the sphere as this program writes and recognizes it: first identification
line, data type, unit.
"""

_LARGEST = 1e30
"""Bound of measured values, so that their powers do not overflow."""

_BEGINNING = 4000
"""Bytes at the beginning in which the first line of -1 stands; the rest of another file
is not read.
"""

_MARK = b"-1"
# at the current position: binary data does not end with a line break
_HERE = re.compile(rb"[ \t]*-1[ \t\r]*(?:\n|\Z)")
_MARKED = re.compile(rb"^" + _HERE.pattern, re.MULTILINE)
_HEADER_LINES = 11
_REAL, _COMPLEX = (2, 4), (5, 6)
_SINGLE = (2, 5)
_TIME, _FREQUENCY, _UNSTATED = 17, 18, (0, 1)
_HERTZ = "hz"
FREQUENCY_RESPONSE, COHERENCE = 4, 6
"""Types of functions of frequency that are read."""

_WIDTHS = {2: 13, 4: 20, 5: 13, 6: 20}  # columns of a number in text, single and double precision
_ENDS = {1: "<", 2: ">"}
_IEEE = 2


@dataclass(frozen=True)
class Function:
    """A function of time.

    Parameters
    ----------
    number : int
        Number of the function in the file, from 1.
    identification : str
        First identification line.
    kind : int
        Data type of the ordinate in dataset 58: 8 displacement, 9 and 13 force, 11 velocity, 12
        acceleration.
    unit : str
        Unit label; "" if there is none.
    time, values : array, shape (n,)
        Times [s], and values in the units of the file.
    """

    number: int
    identification: str
    kind: int
    unit: str
    time: Floats
    values: Floats


class Freedom(NamedTuple):
    """A degree of freedom: name of its entity, "" if there is none; node, 0 if there is none; and
    direction, 1 to 3 along x, y, z, negative against the axis, 4 to 6 of rotations, 0 if it is not
    stated.
    """

    entity: str
    node: int
    direction: int


@dataclass(frozen=True)
class FunctionOfFrequency:
    """A frequency response, or a coherence.

    Parameters
    ----------
    number : int
        Number of the function in the file, from 1.
    identification : str
        First identification line.
    function_type : int
        `FREQUENCY_RESPONSE` or `COHERENCE`.
    kinds : tuple of two ints
        Data types of numerator and denominator in dataset 58, as those of `Function`.
    units : tuple of two str
        Unit labels of numerator and denominator; "" if there is none.
    response, reference : Freedom
        What was measured, and where the force acts.
    frequency : array, shape (n,)
        Frequencies [Hz].
    values : array, shape (n,)
        Values in the units of the file; NaN where the file has no number, as many have at 0 Hz.
    """

    number: int
    identification: str
    function_type: int
    kinds: tuple[int, int]
    units: tuple[str, str]
    response: Freedom
    reference: Freedom
    frequency: Floats
    values: Complex | Floats


class UniversalFile(NamedTuple):
    """Functions of time of a universal file, the divisors that convert its lengths ("m") and forces
    ("N") to SI, None if the file does not state them, and its frequency responses and coherences.
    """

    functions: list[Function]
    factors: dict[str, float] | None
    of_frequency: list[FunctionOfFrequency]


def is_universal(path: str | Path) -> bool:
    """Return whether a file begins with a line of -1, as universal files do."""
    try:
        return beginning(path, UNIVERSAL, 200).lstrip().split(b"\n")[0].strip() == _MARK
    except InputError:  # the reader of the file reports the error
        return False


def read_universal_file(path: str | Path) -> UniversalFile:
    """Read the functions of time of a universal file, and its frequency responses and coherences.

    Parameters
    ----------
    path : path
        The file.

    Raises
    ------
    InputError
        If it can't be read, or a dataset is incomplete.
    """
    file = Path(path)
    try:
        if not _MARKED.search(beginning(file, UNIVERSAL, _BEGINNING)):
            raise InputError("this is no universal file, which would begin with a line of -1")
        raw = read_bytes(file, UNIVERSAL)
    except InputError as error:
        raise with_path(file, error) from None
    functions: list[Function] = []
    of_frequency: list[FunctionOfFrequency] = []
    factors, number = None, 0
    for header, place in _datasets(raw):
        kind = header.split()[0] if header.split() else b""
        try:
            if kind == b"164":
                factors = _factors(raw, place)
            elif kind in (b"58", b"58b"):
                number += 1
                found = _function(raw, header, place, number)
                if isinstance(found, Function):
                    functions.append(found)
                elif found is not None:
                    of_frequency.append(found)
        except (ValueError, IndexError, KeyError, OverflowError):
            what = f"function {number}" if kind != b"164" else "dataset 164, with the units,"
            size = (
                ""
                if kind == b"164"
                else f", or a number there is not finite or not below {_LARGEST:g} in size"
            )
            words = f"the file is damaged, or not of the format stated in its first lines{size}"
            raise InputError(f"{file}: {what} can't be read; {words}") from None
    return UniversalFile(functions, factors, of_frequency)


def _datasets(raw: bytes) -> Iterator[tuple[bytes, int]]:
    """Yield the first line of each dataset, and the offset after it."""
    place, inside = 0, False
    while (mark := _HERE.match(raw, place) or _MARKED.search(raw, place)) is not None:
        inside, place = not inside, mark.end()
        if inside:
            header, place = _line(raw, place)
            yield header, place
            words = header.split()
            # skip binary data, which may contain the bytes of a mark
            if words and words[0] == b"58b":
                place = _binary_end(raw, words, place)


def _binary_end(raw: bytes, words: list[bytes], place: int) -> int:
    for _ in range(_HEADER_LINES):
        _, place = _line(raw, place)
    size = int(words[4]) if len(words) > 4 and words[4].isdigit() else 0
    return min(place + size, len(raw))


def _line(raw: bytes, place: int) -> tuple[bytes, int]:
    """Return the line at an offset, and the offset after it."""
    end = raw.find(b"\n", place)
    return (raw[place:], len(raw)) if end < 0 else (raw[place:end].rstrip(b"\r"), end + 1)


def _lines(raw: bytes, place: int, number: int) -> tuple[list[str], int]:
    lines = []
    for _ in range(number):
        line, place = _line(raw, place)
        lines.append(_text_of(line[:200]))
    return lines, place


def _text_of(line: bytes) -> str:
    """Return a line of a header, which is ASCII by the format, and in practice UTF-8 or Latin-1."""
    try:
        return line.decode("utf-8")
    except UnicodeDecodeError:
        return line.decode("latin-1")


def _factors(raw: bytes, place: int) -> dict[str, float]:
    lines, _ = _lines(raw, place, 2)
    numbers = [float(lines[1][at : at + 25].replace("D", "E").replace("d", "e")) for at in (0, 25)]
    if not all(0.0 < number < np.inf for number in numbers):
        raise ValueError
    return {"m": numbers[0], "N": numbers[1]}


def _function(
    raw: bytes, header: bytes, place: int, number: int
) -> Function | FunctionOfFrequency | None:
    """Return a function of time, a frequency response or a coherence; None of any other
    function.
    """
    lines, place = _lines(raw, place, _HEADER_LINES)
    ordinate, count, even = (int(lines[6][at : at + 10]) for at in (0, 10, 20))
    start, step = (float(lines[6][at : at + 13]) for at in (30, 43))
    function_type, variable = _whole(lines[5][:5]), int(lines[7][:10])
    of_time = ordinate in _REAL and variable == _TIME
    if not of_time and not _is_of_frequency(function_type, variable, ordinate, lines[7][47:67]):
        return None
    if not 0 < count <= len(raw):
        raise ValueError
    if even == 1 and not abs(start) < _LARGEST > abs(step):  # nor are they NaN
        raise ValueError
    if header.split()[0] == b"58b":
        with np.errstate(invalid="ignore"):  # of bytes that are no number, which are refused below
            given, values = _binary(raw, header, place, ordinate, count, even == 1)
    else:
        given, values = _text(raw, place, ordinate, count, even == 1)
    variables = start + step * np.arange(count, dtype=float) if given is None else given
    words = "".join(letter for letter in lines[0] if letter.isprintable()).strip()
    if not (np.abs(variables) < _LARGEST).all():  # nor are they NaN
        raise ValueError
    if not of_time:
        if (np.abs(values) >= _LARGEST).any():
            raise ValueError
        kinds, units = (
            (_whole(lines[8][:10]), _whole(lines[9][:10])),
            (_unit_label(lines[8]), _unit_label(lines[9])),
        )
        ends = _freedom(lines[5], 30), _freedom(lines[5], 55)
        return FunctionOfFrequency(
            number, words, function_type, kinds, units, *ends, variables, values
        )
    if not (np.abs(values) < _LARGEST).all():
        raise ValueError
    return Function(
        number, words, int(lines[8][:10]), _unit_label(lines[8]), variables, values.real
    )


def _is_of_frequency(function_type: int, variable: int, ordinate: int, unit: str) -> bool:
    """Return whether a function is a frequency response or a coherence that is read:
    programs leave the kind of the abscissa out.
    """
    if variable != _FREQUENCY and not (variable in _UNSTATED and unit.strip().lower() == _HERTZ):
        return False
    return (function_type, ordinate in _COMPLEX, ordinate in _REAL) in (
        (FREQUENCY_RESPONSE, True, False),
        (COHERENCE, False, True),
    )


def _whole(text: str) -> int:
    """Return a number of a header that programs leave out, or fill with something else: 0."""
    return int(text) if text.strip().lstrip("+-").isdigit() else 0


def _unit_label(line: str) -> str:
    unit = line[47:67].strip()
    return "" if unit == "NONE" else unit


def _freedom(line: str, at: int) -> Freedom:
    """Return the degree of freedom whose fields begin at a column of the sixth line of a header."""
    entity = line[at + 1 : at + 11].strip()
    return Freedom(
        "" if entity == "NONE" else entity,
        _whole(line[at + 11 : at + 21]),
        _whole(line[at + 21 : at + 25]),
    )


def _binary(
    raw: bytes, header: bytes, place: int, ordinate: int, count: int, even: bool
) -> tuple[Floats | None, Floats | Complex]:
    order, form, _, size = (int(word) for word in header.split()[1:5])
    end, values, parts = (
        _ENDS[order],
        "f4" if ordinate in _SINGLE else "f8",
        2 if ordinate in _COMPLEX else 1,
    )
    if form != _IEEE or place + size > len(raw):
        raise ValueError
    if even:
        return None, _joined(
            np.frombuffer(raw, f"{end}{values}", parts * count, place).astype(float), parts
        )
    # with double-precision values, times occur in single and in double precision, and the stated
    # size may omit them
    after = place + (8 + parts * int(values[1])) * count
    wide = raw[after : after + 12].lstrip().startswith(_MARK)
    times = "f8" if wide else "f4"
    pairs = np.frombuffer(
        raw, [("x", f"{end}{times}"), ("y", f"{end}{values}", (parts,))], count, place
    )
    return pairs["x"].astype(float), _joined(pairs["y"].astype(float).ravel(), parts)


def _text(
    raw: bytes, place: int, ordinate: int, count: int, even: bool
) -> tuple[Floats | None, Floats | Complex]:
    width, parts = _WIDTHS[ordinate], 2 if ordinate in _COMPLEX else 1
    single = ordinate in _SINGLE
    # columns of fixed width, not necessarily separated by blanks
    widths = (
        [width] * (6 if single else 4)
        if even
        else [13, *[width] * parts] * ((6 if single else 4) // (1 + parts))
    )
    edges = np.concatenate([[0], np.cumsum(widths)])
    found: list[float] = []
    wanted = (parts if even else 1 + parts) * count
    while len(found) < wanted:
        if place >= len(raw):
            raise ValueError
        line, place = _line(raw, place)
        text = line.decode("ascii").upper().replace("D", "E")
        cells = [text[begin:stop].strip() for begin, stop in itertools.pairwise(edges)]
        found += [float(cell) for cell in cells if cell]
    numbers = np.array(found[:wanted])
    if even:
        return None, _joined(numbers, parts)
    rows = numbers.reshape(count, 1 + parts)
    return rows[:, 0], _joined(rows[:, 1:].ravel(), parts)


def _joined(numbers: Floats, parts: int) -> Floats | Complex:
    """Return numbers, or the complex values of which they are real and imaginary parts in turn."""
    return numbers if parts == 1 else numbers[::2] + 1j * numbers[1::2]
