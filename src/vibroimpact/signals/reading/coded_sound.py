"""Records from the sound files of phones, by PyAV (FFmpeg): M4A, MP3, Ogg and FLAC.

The format is that of the name, and the file is handed over opened: nothing that a file refers to is
opened besides it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from io import SEEK_CUR, SEEK_END, SEEK_SET, BytesIO, FileIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.files.reading import FileKind, opened, with_path
from vibroimpact.quoting import shortened
from vibroimpact.signals.record import Record, checked_rate
from vibroimpact.structures.finite_elements.free_memory import check_memory

if TYPE_CHECKING:
    from av import AudioStream
    from av.container import InputContainer

FORMATS = {".m4a": "mp4", ".mp3": "mp3", ".ogg": "ogg", ".opus": "ogg", ".flac": "flac"}
"""Endings of files with coded sound, and FFmpeg's names of their formats."""

SOUND = FileKind(
    "sound is read from WAV, M4A, MP3, Ogg, Opus and FLAC files",
    1_000_000_000,
    "keep the part with the impacts",
)
"""Requirements on a file with coded sound."""

_BLUR = 4e-3
"""Time over which coders with losses spread what begins suddenly [s].

Of a beat, up to 4 ms were measured (`test_coded_sound.py`).
"""

_LONGEST = 6 * 3600.0
"""Longest sound [s].

A block of silence takes a few bytes, so that the size of a file does not bound it.
"""


def coded_records(path: Path) -> Iterator[Record]:
    """Yield the channels of a file with coded sound, with full scale as 1.

    A coding with losses is a doubt.

    Raises
    ------
    InputError
        If the file can't be read or has no sound, or PyAV is not installed.
    """
    try:
        with opened(path, SOUND) as file:
            yield from _records(file, path)
    except InputError as error:
        raise with_path(path, error) from None


def _records(file: FileIO | BytesIO, path: Path) -> Iterator[Record]:
    """Yield the channels of an opened file."""
    _check_pyav(path.suffix)
    import av
    from av import logging

    logging.set_level(None)  # what FFmpeg has to say is an error here, or of no account
    try:
        with av.open(_Opened(file), "r", format=FORMATS[path.suffix.lower()]) as container:
            if not container.streams.audio:
                raise InputError(f"there is no sound in it; {SOUND.what}")
            stream = container.streams.audio[0]
            rate = checked_rate(float(stream.codec_context.sample_rate or 0.0))
            value, faults = _samples(container, stream, rate)
    except InputError:
        raise
    except UnicodeDecodeError:
        raise InputError(f"its labels are damaged; {SOUND.what}") from None
    except (av.FFmpegError, ValueError) as error:
        raise InputError(
            f"it can't be read as its name says ({_cause(error)}); {SOUND.what}"
        ) from None
    if not value.shape[1]:
        raise InputError("there are no samples in it")
    codec = stream.codec_context.codec
    doubts = faults
    blur = 0.0
    if codec.lossy and not codec.lossless:
        doubts = (*faults, _loss_doubt(stream))
        blur = _BLUR
    for number, channel in enumerate(value):
        name = path.stem
        if len(value) > 1:
            name = f"{path.stem} {number + 1}"
        yield Record(name, channel, rate, "1", doubts=doubts, blur=blur)


def _check_pyav(suffix: str) -> None:
    """Raise InputError unless PyAV can be loaded, for a file whose name ends so."""
    try:
        import av.logging  # noqa: F401
    except ImportError as error:
        if isinstance(error, ModuleNotFoundError) and error.name == "av":
            raise InputError(
                f"sound in {suffix} needs PyAV, which is not installed: pip install "
                '"vibroimpact[audio]"'
            ) from None
        raise InputError(
            f"sound in {suffix} needs PyAV, which can't be loaded ({shortened(str(error), 200)}); "
            "install it anew, or convert the file to WAV"
        ) from None


class _Opened:
    """An opened file for FFmpeg.

    FFmpeg seeks before the begin of files that are too short: there this stays at it.
    """

    def __init__(self, file: FileIO | BytesIO) -> None:
        self.read = file.read
        self.tell = file.tell
        self._file = file

    def seek(self, offset: int, whence: int = SEEK_SET) -> int:
        """Move to an offset [byte] from the begin, from here or the end; return the new one."""
        origin = {
            SEEK_SET: 0,
            SEEK_CUR: self._file.tell(),
            SEEK_END: os.fstat(self._file.fileno()).st_size,
        }[whence]
        return self._file.seek(max(origin + offset, 0))


def _samples(
    container: InputContainer, stream: AudioStream, rate: float
) -> tuple[Floats, tuple[str, ...]]:
    """Return the samples, (channels, samples), with full scale as 1.

    With them comes a doubt where the file ends in a fault.
    """
    import av

    plain = av.AudioResampler(format="dblp")
    channels = stream.codec_context.channels
    blocks: list[Floats] = [np.empty((channels, 0))]
    samples = 0
    faults: tuple[str, ...] = ()
    try:
        for frame in container.decode(stream):
            for block in plain.resample(frame):
                samples += block.samples
                if samples > _LONGEST * rate:
                    raise InputError(
                        f"it lasts longer than {_LONGEST / 3600.0:g} hours; {SOUND.smaller}"
                    )
                if block.layout.nb_channels != channels or block.sample_rate != rate:
                    raise InputError(
                        "its rate or its number of channels changes on the way; keep one part"
                    )
                check_memory(16.0 * channels * samples, "its samples need", SOUND.smaller)
                blocks.append(block.to_ndarray().astype(np.float64, copy=False))
    except av.FFmpegError as error:
        if not samples:
            raise
        faults = (
            f"it is damaged, or cut off, {samples / rate:.4g} s after its start "
            f"({_cause(error)}); what comes after is left out",
        )
    blocks += [block.to_ndarray().astype(np.float64, copy=False) for block in plain.resample(None)]
    return np.concatenate(blocks, axis=1), faults


def _cause(error: Exception) -> str:
    """Return what FFmpeg or Python says of a fault, without numbers and names of their own."""
    return str(getattr(error, "strerror", None) or error)


def _loss_doubt(stream: AudioStream) -> str:
    """Return the doubt about sound that is coded with losses."""
    bit_rate = stream.codec_context.bit_rate or stream.bit_rate
    size = ""
    if bit_rate:
        size = f" at {bit_rate / 1000.0:.0f} kbit/s"
    codec = f"{stream.codec_context.codec.canonical_name}{size}"
    return (
        f"its sound is coded with losses ({codec}): what begins suddenly is spread over some "
        "milliseconds, more at low rates of samples or bits, and what is not heard is left out; "
        f"intervals of times of touches allow for {1e3 * _BLUR:g} ms of it, amplitudes, spectra "
        "and other features for none: record in WAV or FLAC where these count"
    )
