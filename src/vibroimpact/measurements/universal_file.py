"""Reading of universal files (UFF): functions of time, frequency responses, and units.

Functions are those of datasets 58, text or binary; units those of dataset 164.
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
"""The motion of the sphere as this program writes and recognizes it.

First identification line, data type, unit.
"""

_LARGEST = 1e30
"""Bound of measured values, so that their powers do not overflow."""

_BEGINNING = 4000
"""Bytes at the beginning in which the first line of -1 stands; the rest is not read else."""

_MARK = b"-1"
# at the current position: binary data does not end with a line break
_HERE = re.compile(rb"[ \t]*-1[ \t\r]*(?:\n|\Z)")
_MARKED = re.compile(rb"^" + _HERE.pattern, re.MULTILINE)
_HEADER_LINES = 11
_REAL = (2, 4)
_COMPLEX = (5, 6)
"""Types of the ordinate: real and complex, in single and in double precision."""
_SINGLE = (2, 5)
_TIME = 17
_FREQUENCY = 18
_UNSTATED = (0, 1)
"""Types of the abscissa."""
_HERTZ = "hz"
FREQUENCY_RESPONSE = 4
COHERENCE = 6
"""Types of functions of frequency that are read."""

_WIDTHS = {2: 13, 4: 20, 5: 13, 6: 20}
"""Columns of a number in text, in single and double precision."""
_WIDTH_OF_VARIABLE = 13
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
    """A degree of freedom.

    The name of its entity, "" if there is none; its node, 0 if there is none; and its direction, 1
    to 3 along x, y, z, negative against the axis, 4 to 6 of rotations, 0 if it is not stated.
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
    """Content of a universal file.

    Its functions of time; the divisors that convert its lengths ("m") and forces ("N") to SI, None
    if the file does not state them; and its frequency responses and coherences.
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
    factors = None
    number = 0
    for header, offset in _datasets(raw):
        dataset = header.split()[0] if header.split() else b""
        try:
            if dataset == b"164":
                factors = _factors(raw, offset)
            elif dataset in (b"58", b"58b"):
                number += 1
                function = _function(raw, header, offset, number)
                if isinstance(function, Function):
                    functions.append(function)
                elif function is not None:
                    of_frequency.append(function)
        except (ValueError, IndexError, KeyError, OverflowError):
            cause = "the file is damaged, or not of the format stated in its first lines"
            if dataset == b"164":
                what = "dataset 164, with the units,"
            else:
                what = f"function {number}"
                cause += f", or a number there is not finite or not below {_LARGEST:g} in size"
            raise InputError(f"{file}: {what} can't be read; {cause}") from None
    return UniversalFile(functions, factors, of_frequency)


def _datasets(raw: bytes) -> Iterator[tuple[bytes, int]]:
    """Yield the first line of each dataset, and the offset after it."""
    offset = 0
    inside = False
    while True:
        mark = _HERE.match(raw, offset) or _MARKED.search(raw, offset)
        if mark is None:
            return
        inside = not inside
        offset = mark.end()
        if not inside:
            continue
        header, offset = _line(raw, offset)
        yield header, offset
        fields = header.split()
        # skip binary data, which may contain the bytes of a mark
        if fields and fields[0] == b"58b":
            offset = _binary_end(raw, fields, offset)


def _binary_end(raw: bytes, fields: list[bytes], offset: int) -> int:
    """Return the offset after the binary data of a dataset, by the fields of its first line."""
    for _ in range(_HEADER_LINES):
        _, offset = _line(raw, offset)
    size = 0
    if len(fields) > 4 and fields[4].isdigit():
        size = int(fields[4])
    return min(offset + size, len(raw))


def _line(raw: bytes, offset: int) -> tuple[bytes, int]:
    """Return the line at an offset, and the offset after it."""
    end = raw.find(b"\n", offset)
    if end < 0:
        return raw[offset:], len(raw)
    return raw[offset:end].rstrip(b"\r"), end + 1


def _lines(raw: bytes, offset: int, count: int) -> tuple[list[str], int]:
    """Return the lines of a header at an offset, and the offset after them."""
    lines = []
    for _ in range(count):
        line, offset = _line(raw, offset)
        lines.append(_text_of(line[:200]))
    return lines, offset


def _text_of(line: bytes) -> str:
    """Return a line of a header, which is ASCII by the format, and in practice UTF-8 or Latin-1."""
    try:
        return line.decode("utf-8")
    except UnicodeDecodeError:
        return line.decode("latin-1")


def _factors(raw: bytes, offset: int) -> dict[str, float]:
    """Return the divisors of dataset 164, in fields of 25 characters with D for the exponent."""
    lines, _ = _lines(raw, offset, 2)
    fields = [lines[1][start : start + 25] for start in (0, 25)]
    length, force = (float(field.replace("D", "E").replace("d", "e")) for field in fields)
    if not 0.0 < length < np.inf or not 0.0 < force < np.inf:
        raise ValueError
    return {"m": length, "N": force}


def _function(
    raw: bytes, header: bytes, offset: int, number: int
) -> Function | FunctionOfFrequency | None:
    """Return a function of time, a frequency response or a coherence; None of another function."""
    lines, offset = _lines(raw, offset, _HEADER_LINES)
    # the fields of these lines have fixed columns
    form = _OrdinateForm(
        ordinate=int(lines[6][0:10]), length=int(lines[6][10:20]), even=int(lines[6][20:30]) == 1
    )
    start = float(lines[6][30:43])
    step = float(lines[6][43:56])
    function_type = _whole(lines[5][:5])
    abscissa = int(lines[7][:10])
    of_time = form.ordinate in _REAL and abscissa == _TIME
    unit = lines[7][47:67]
    if not of_time and not _is_of_frequency(function_type, abscissa, form.ordinate, unit):
        return None
    if not 0 < form.length <= len(raw):
        raise ValueError
    if form.even and not abs(start) < _LARGEST > abs(step):  # nor are they NaN
        raise ValueError
    if header.split()[0] == b"58b":
        with np.errstate(invalid="ignore"):  # of bytes that are no number, which are refused below
            uneven, values = _binary(raw, header, offset, form)
    else:
        uneven, values = _text(raw, offset, form)
    variable = uneven
    if variable is None:
        variable = start + step * np.arange(form.length, dtype=float)
    identification = "".join(letter for letter in lines[0] if letter.isprintable()).strip()
    if not (np.abs(variable) < _LARGEST).all():  # nor are they NaN
        raise ValueError
    if of_time:
        if not (np.abs(values) < _LARGEST).all():
            raise ValueError
        kind = int(lines[8][:10])
        label = _unit_label(lines[8])
        return Function(number, identification, kind, label, variable, values.real)
    if (np.abs(values) >= _LARGEST).any():
        raise ValueError
    return FunctionOfFrequency(
        number=number,
        identification=identification,
        function_type=function_type,
        kinds=(_whole(lines[8][:10]), _whole(lines[9][:10])),
        units=(_unit_label(lines[8]), _unit_label(lines[9])),
        response=_freedom(lines[5], 30),
        reference=_freedom(lines[5], 55),
        frequency=variable,
        values=values,
    )


class _OrdinateForm(NamedTuple):
    """Form of the numbers of a function: type of the ordinate, how many, and even spacing."""

    ordinate: int
    length: int
    even: bool

    @property
    def parts(self) -> int:
        """Numbers of a value: two of a complex one."""
        return 2 if self.ordinate in _COMPLEX else 1

    @property
    def is_single(self) -> bool:
        """Whether they have single precision."""
        return self.ordinate in _SINGLE


def _is_of_frequency(function_type: int, abscissa: int, ordinate: int, unit: str) -> bool:
    """Return whether a function is a frequency response or a coherence that is read.

    Programs leave the type of the abscissa out; then its unit tells it.
    """
    is_hertz = abscissa in _UNSTATED and unit.strip().lower() == _HERTZ
    if abscissa != _FREQUENCY and not is_hertz:
        return False
    if function_type == FREQUENCY_RESPONSE:
        return ordinate in _COMPLEX
    return function_type == COHERENCE and ordinate in _REAL


def _whole(text: str) -> int:
    """Return a number of a header; 0 where programs leave it out or write something else."""
    if not text.strip().lstrip("+-").isdigit():
        return 0
    return int(text)


def _unit_label(line: str) -> str:
    unit = line[47:67].strip()
    return "" if unit == "NONE" else unit


def _freedom(line: str, at: int) -> Freedom:
    """Return the degree of freedom whose fields begin at a column of the sixth line of a header."""
    entity = line[at + 1 : at + 11].strip()
    if entity == "NONE":
        entity = ""
    node = _whole(line[at + 11 : at + 21])
    direction = _whole(line[at + 21 : at + 25])
    return Freedom(entity, node, direction)


def _binary(
    raw: bytes, header: bytes, offset: int, form: _OrdinateForm
) -> tuple[Floats | None, Floats | Complex]:
    """Return the variables, None if they are even, and the values of a binary function."""
    byte_order, floating_format, _, size = (int(field) for field in header.split()[1:5])
    order = _ENDS[byte_order]
    if floating_format != _IEEE or offset + size > len(raw):
        raise ValueError
    single = np.dtype(f"{order}f4")
    double = np.dtype(f"{order}f8")
    ordinate = single if form.is_single else double
    if form.even:
        numbers = np.frombuffer(raw, ordinate, form.parts * form.length, offset)
        return None, _joined(numbers.astype(float), form.parts)
    # with double-precision values, times occur in single and in double precision, and the stated
    # size may omit them: the mark of the end lies behind them if they are double
    row_if_double = double.itemsize + form.parts * ordinate.itemsize
    end_if_double = offset + row_if_double * form.length
    is_double = raw[end_if_double : end_if_double + 12].lstrip().startswith(_MARK)
    abscissa = double if is_double else single
    row = np.dtype([("x", abscissa), ("y", ordinate, (form.parts,))])
    rows = np.frombuffer(raw, row, form.length, offset)
    return rows["x"].astype(float), _joined(rows["y"].astype(float).ravel(), form.parts)


def _text(raw: bytes, offset: int, form: _OrdinateForm) -> tuple[Floats | None, Floats | Complex]:
    """Return the variables, None if they are even, and the values of a function in text."""
    width = _WIDTHS[form.ordinate]
    in_line = 6 if form.is_single else 4
    # columns of fixed width, not necessarily separated by blanks
    if form.even:
        row = form.parts
        widths = [width] * in_line
    else:
        row = 1 + form.parts
        widths = [_WIDTH_OF_VARIABLE, *[width] * form.parts] * (in_line // row)
    edges = np.concatenate([[0], np.cumsum(widths)])
    numbers: list[float] = []
    while len(numbers) < row * form.length:
        if offset >= len(raw):
            raise ValueError
        line, offset = _line(raw, offset)
        text = line.decode("ascii").upper().replace("D", "E")
        cells = [text[start:end].strip() for start, end in itertools.pairwise(edges)]
        numbers += [float(cell) for cell in cells if cell]
    values = np.array(numbers[: row * form.length])
    if form.even:
        return None, _joined(values, form.parts)
    rows = values.reshape(form.length, row)
    return rows[:, 0], _joined(rows[:, 1:].ravel(), form.parts)


def _joined(numbers: Floats, parts: int) -> Floats | Complex:
    """Return numbers, or the complex values of which they are real and imaginary parts in turn."""
    if parts == 1:
        return numbers
    return numbers[::2] + 1j * numbers[1::2]
