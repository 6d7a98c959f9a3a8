"""The header of a WAV file: its format, where its samples lie, and what its comment says;
samples are not read for it.
"""

from __future__ import annotations

import re
import struct
from io import FileIO
from os import SEEK_END
from typing import NamedTuple

from vibroimpact.errors import InputError

_PCM, _FLOAT, _EXTENSIBLE = 1, 3, 0xFFFE
_TAIL = bytes.fromhex("800000aa00389b71")
"""End of the identifier of a format in an extensible header; before it stand its number,
0 and 16, in the order of the file.
"""

_MOST_CHUNKS = 1000
_LONGEST_LIST = 4000  # bytes of a comment that are looked at
_UNKNOWN = 0xFFFFFFFF
"""Length of the samples where the writer did not know it, or gives it as 64 bits in the
chunk ds64.
"""

_COMMENT = re.compile(rb"ICMT....1\.0 is (\S+) (\S+) \((?:.*? of )?(.*?)\)\0", re.DOTALL)
"""The comment of this program, which says what 1.0 is."""

DAMAGED = "the WAV file is damaged, or holds no samples of 8 to 64 bits without compression"


class FullScale(NamedTuple):
    """What 1.0 is: its value and unit, and the name of the channel."""

    value: bytes
    unit: bytes
    name: bytes


class WaveHeader(NamedTuple):
    """How the samples of a WAV file are to be read.

    Parameters
    ----------
    rate : int
        Sampling rate [Hz].
    channels : int
        Number of channels.
    width : int
        Bytes of a sample.
    floating : bool
        Whether samples are floating-point numbers.
    order : str
        "<" or ">", the order of their bytes.
    start : int
        Place of the first sample in the file [bytes].
    samples : int
        Complete samples of each channel in the file.
    stated : int
        Samples of each channel by the header.
    full_scale : FullScale, optional
        What the comment says of full scale.
    """

    rate: int
    channels: int
    width: int
    floating: bool
    order: str
    start: int
    samples: int
    stated: int
    full_scale: FullScale | None


class _Format(NamedTuple):
    rate: int
    channels: int
    width: int
    floating: bool


def read_wave_header(file: FileIO) -> WaveHeader:
    """Read the header of a WAV file, by its chunks.

    Raises
    ------
    InputError
        If it is none, it is damaged, or its samples are compressed.
    """
    length = file.seek(0, SEEK_END)
    kind = _at(file, 0, 12)
    if not kind.startswith((b"RIFF", b"RIFX", b"RF64")):
        raise InputError("this is no WAV file, which would begin with RIFF, RIFX or RF64")
    order = ">" if kind.startswith(b"RIFX") else "<"
    form: _Format | None = None
    long_size: int | None = None
    data: tuple[int, int] | None = None
    full_scale: FullScale | None = None
    place = 12
    for _ in range(_MOST_CHUNKS):
        if place > length - 8:  # a length that a chunk states may lead far beyond the end
            break
        head = _at(file, place, 8)
        name, size = struct.unpack(f"{order}4sI", head)
        start = place + 8
        if name == b"ds64":
            long_size = struct.unpack("<Q", _at(file, start, 16)[8:].ljust(8, b"\0"))[0]
        elif name == b"fmt ":
            form = _format(_at(file, start, min(size, 40)), order)
        elif name == b"data" and data is None:
            size = _data_size(size, long_size, length - start)
            data = (start, size)
        elif name == b"LIST" and (
            found := _COMMENT.search(_at(file, start, min(size, _LONGEST_LIST)))
        ):
            full_scale = FullScale(*found.groups())
        place = start + size + size % 2
    if form is None or data is None:
        raise InputError(DAMAGED)
    start, size = data
    frame = form.channels * form.width
    there = min(size, length - start) // frame
    return WaveHeader(*form, order, start, there, size // frame, full_scale)


def _at(file: FileIO, place: int, size: int) -> bytes:
    file.seek(place)
    return file.read(size) or b""


def _data_size(size: int, long_size: int | None, rest: int) -> int:
    if size != _UNKNOWN:
        return size
    return rest if long_size is None else long_size


def _format(content: bytes, order: str) -> _Format:
    if len(content) < 16:
        raise InputError(DAMAGED)
    tag, channels, rate, _, frame, bits = struct.unpack(f"{order}HHIIHH", content[:16])
    if (
        tag == _EXTENSIBLE
        and len(content) == 40
        and content[28:] == struct.pack(f"{order}HH", 0, 16) + _TAIL
    ):
        (tag,) = struct.unpack(f"{order}I", content[24:28])
    width = frame // channels if channels else 0
    floating = tag == _FLOAT
    fits = (
        (width in (4, 8) and bits == 8 * width)
        if floating
        else (1 <= width <= 8 and 1 <= bits <= 8 * width)
    )
    if tag not in (_PCM, _FLOAT) or not fits or frame != width * channels:
        raise InputError(DAMAGED)
    return _Format(rate, channels, width, floating)
