"""Records from WAV files: integers as parts of full scale, floating-point numbers as they are.

Integers have 8 to 64 bits. The header is read first; the samples follow in blocks, for as many
channels at once as need little memory.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO, FileIO
from math import isfinite
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.files.reading import FileKind, opened, with_path
from vibroimpact.quoting import quoted
from vibroimpact.signals.reading.si_units import in_si
from vibroimpact.signals.reading.wave_header import FullScale, WaveHeader, read_wave_header
from vibroimpact.signals.record import Record, checked_rate
from vibroimpact.structures.finite_elements.free_memory import check_memory

WAVE = FileKind(
    "a WAV file begins with RIFF, RIFX or RF64", 4_300_000_000, "keep the part with the impacts"
)
"""Requirements on a WAV file."""

_BLOCK = 2**22
"""Bytes that are read at once."""

_TOGETHER = 2**28
"""Bytes of the samples of channels that are read together."""


def wave_records(path: Path) -> Iterator[Record]:
    """Yield the channels of a WAV file.

    Full scale is 1, or the value that the comment of an exported file says.

    Raises
    ------
    InputError
        If the file can't be read, or has no samples.
    """
    try:
        with opened(path, WAVE) as file:
            header = read_wave_header(file)
            factor, unit, name = _scale(header.full_scale, path.stem)
            checked_rate(header.rate)
            if not header.samples:
                raise InputError("there are no samples in this WAV file")
            doubts = _doubts(header)
            check_memory(8.0 * header.samples, "the samples of a channel need", WAVE.smaller)
            together = max(1, _TOGETHER // (8 * header.samples))
            for first in range(0, header.channels, together):
                channels = range(first, min(first + together, header.channels))
                for number, value in zip(channels, _samples(file, header, channels), strict=True):
                    channel_name = name
                    if header.channels > 1:
                        channel_name = f"{name} {number + 1}"
                    # of floating-point numbers that are no sound
                    with np.errstate(over="ignore", invalid="ignore"):
                        value *= factor
                    yield Record(channel_name, value, float(header.rate), unit, doubts=doubts)
    except InputError as error:
        raise with_path(path, error) from None


def _scale(full_scale: FullScale | None, stem: str) -> tuple[float, str, str]:
    """Return the value of full scale in SI, the unit, and the name of the channels."""
    if full_scale is None:
        return 1.0, "1", stem
    text, unit, name = (field.decode("utf-8", "replace") for field in full_scale)
    factor, si_unit = in_si(unit)
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not isfinite(value) or value == 0.0:
        raise InputError(
            f"by its comment 1.0 is {quoted(text)} {unit}; it must be a finite number "
            f"other than 0, such as 2.5 {unit}"
        )
    return factor * value, si_unit, name


def _doubts(header: WaveHeader) -> tuple[str, ...]:
    """Return the doubt about a file that is shorter than its header states."""
    if header.samples >= header.stated:
        return ()
    doubt = (
        f"the file is cut off, or its header is wrong: it has {header.samples:,} of the "
        f"{header.stated:,} samples of a channel that its header states"
    )
    return (doubt,)


def _samples(file: FileIO | BytesIO, header: WaveHeader, channels: range) -> Floats:
    """Return the samples of some channels, (channels, samples), with full scale as 1."""
    samples = np.empty((len(channels), header.samples))
    frame = header.channels * header.width
    frames_at_once = max(1, _BLOCK // frame)
    for first in range(0, header.samples, frames_at_once):
        frames = min(frames_at_once, header.samples - first)
        file.seek(header.start + first * frame)
        raw = file.read(frames * frame) or b""
        if len(raw) < frames * frame:
            raise InputError("the file became shorter while it was read")
        block = np.frombuffer(raw, dtype=np.uint8).reshape(frames, header.channels, header.width)
        chosen = block[:, channels.start : channels.stop]
        samples[:, first : first + frames] = _full_scale(chosen, header).T
    return samples


def _full_scale(block: NDArray[np.uint8], header: WaveHeader) -> Floats:
    """Return samples, given by their bytes (frames, channels, width), with full scale as 1."""
    if header.floating:
        return _numbers(block, f"{header.order}f{header.width}")
    if header.width == 1:  # unsigned, as no other width is
        return (block[:, :, 0].astype(float) - 128.0) / 128.0
    # the next width that integers have
    size = next(size for size in (2, 4, 8) if size >= header.width)
    if header.width < size:
        block = _padded(block, size, header.order)
    return _numbers(block, f"{header.order}i{size}") / 2.0 ** (8 * size - 1)


def _padded(block: NDArray[np.uint8], size: int, order: str) -> NDArray[np.uint8]:
    """Return samples with as many bytes as integers have; those that are missing are the lowest."""
    padded = np.zeros((*block.shape[:2], size), dtype=np.uint8)
    width = block.shape[2]
    if order == "<":
        padded[:, :, size - width :] = block
    else:
        padded[:, :, :width] = block
    return padded


def _numbers(block: NDArray[np.uint8], number_type: str) -> Floats:
    """Return the numbers of a type, such as "<i2", that samples are by their bytes."""
    with np.errstate(invalid="ignore"):  # of bytes that are no floating-point number
        return np.ascontiguousarray(block).view(number_type)[:, :, 0].astype(float)
