"""The header of a WAV file: its format, where its samples lie, and what its comment says.

Samples are not read for it.
"""

from __future__ import annotations

import re
import struct
from io import BytesIO, FileIO
from os import SEEK_END
from typing import NamedTuple

from vibroimpact.errors import InputError

_PCM = 1
_FLOAT = 3
_EXTENSIBLE = 0xFFFE
"""Numbers of formats: integers, floating-point numbers, and those with an identifier."""
_TAIL = bytes.fromhex("800000aa00389b71")
"""End of the identifier of a format in an extensible header.

Before it stand its number, 0 and 16, in the order of the file.
"""

_MOST_CHUNKS = 1000
_LONGEST_LIST = 4000  # bytes of a comment that are looked at
_UNKNOWN = 0xFFFFFFFF
"""Length of the samples where the writer did not know it, or gives it in the chunk ds64."""

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


def read_wave_header(file: FileIO | BytesIO) -> WaveHeader:
    """Read the header of a WAV file, by its chunks.

    Raises
    ------
    InputError
        If it is none, it is damaged, or its samples are compressed.
    """
    length = file.seek(0, SEEK_END)
    form_type = _bytes_at(file, 0, 12)
    if not form_type.startswith((b"RIFF", b"RIFX", b"RF64")):
        raise InputError("this is no WAV file, which would begin with RIFF, RIFX or RF64")
    order = ">" if form_type.startswith(b"RIFX") else "<"
    form: _Format | None = None
    long_size: int | None = None
    data: tuple[int, int] | None = None
    full_scale: FullScale | None = None
    offset = 12
    for _ in range(_MOST_CHUNKS):
        if offset > length - 8:  # a length that a chunk states may lead far beyond the end
            break
        name, size = struct.unpack(f"{order}4sI", _bytes_at(file, offset, 8))
        start = offset + 8
        if name == b"ds64":
            (long_size,) = struct.unpack("<Q", _bytes_at(file, start, 16)[8:].ljust(8, b"\0"))
        elif name == b"fmt ":
            form = _format(_bytes_at(file, start, min(size, 40)), order)
        elif name == b"data" and data is None:
            size = _data_size(size, long_size, length - start)
            data = (start, size)
        elif name == b"LIST":
            comment = _COMMENT.search(_bytes_at(file, start, min(size, _LONGEST_LIST)))
            if comment is not None:
                full_scale = FullScale(*comment.groups())
        # chunks begin at even offsets
        offset = start + size + size % 2
    if form is None or data is None:
        raise InputError(DAMAGED)
    start, size = data
    frame = form.channels * form.width
    samples = min(size, length - start) // frame
    return WaveHeader(*form, order, start, samples, size // frame, full_scale)


def _bytes_at(file: FileIO | BytesIO, offset: int, size: int) -> bytes:
    file.seek(offset)
    return file.read(size) or b""


def _data_size(size: int, long_size: int | None, rest: int) -> int:
    """Return the bytes of the samples: as stated, by the chunk ds64, or the rest of the file."""
    if size != _UNKNOWN:
        return size
    return rest if long_size is None else long_size


def _format(content: bytes, order: str) -> _Format:
    """Return the format that a chunk states."""
    if len(content) < 16:
        raise InputError(DAMAGED)
    tag, channels, rate, _, frame, bits = struct.unpack(f"{order}HHIIHH", content[:16])
    tail = struct.pack(f"{order}HH", 0, 16) + _TAIL
    if tag == _EXTENSIBLE and len(content) == 40 and content[28:] == tail:
        (tag,) = struct.unpack(f"{order}I", content[24:28])
    width = frame // channels if channels else 0
    floating = tag == _FLOAT
    if floating:
        fits = width in (4, 8) and bits == 8 * width
    else:
        fits = 1 <= width <= 8 and 1 <= bits <= 8 * width
    if tag not in (_PCM, _FLOAT) or not fits or frame != width * channels:
        raise InputError(DAMAGED)
    return _Format(rate, channels, width, floating)
