"""Records from WAV files: integers of 8 to 32 bits as parts of full scale, and floating-point numbers as they are."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import numpy as np

from vibroimpact.errors import InputError
from vibroimpact.files.reading import FileKind, read_bytes, with_path
from vibroimpact.signals.reading.si_units import in_si
from vibroimpact.signals.record import Record

WAVE = FileKind("a WAV file begins with RIFF", 4_300_000_000, "keep the part with the impacts")
"""Requirements on a WAV file."""

_SCALE = re.compile(rb"ICMT....1\.0 is ([-+.e\d]+) (\S+) \((?:.*? of )?(.*?)\)\0", re.DOTALL)
"""The comment of this program, which says what 1.0 is."""


def wave_records(path: Path) -> Iterator[Record]:
    """Yield the channels of a WAV file: full scale is 1, or the value that the comment of an exported file says.

    Raises
    ------
    InputError
        If the file can't be read.
    """
    from scipy.io import wavfile

    try:
        raw = read_bytes(path, WAVE)
    except InputError as error:
        raise with_path(path, error) from None
    if not raw.startswith((b"RIFF", b"RIFX", b"RF64")):
        raise InputError(f"{path}: this is no WAV file; {WAVE.what}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of chunks that are no sound
            rate, samples = wavfile.read(BytesIO(raw))
    except Exception:  # of many types, by what is damaged
        raise InputError(f"{path}: the WAV file is damaged, or holds no samples of 8 to 64 bits without compression") from None
    said = _SCALE.search(raw, max(0, len(raw) - 1000))
    try:
        factor, unit = in_si(said[2].decode("ascii", "replace")) if said else (1.0, "1")
    except InputError as error:
        raise with_path(path, error) from None
    scale = factor * float(said[1]) if said else 1.0
    channels = samples.reshape(len(samples), -1).T
    for number, channel in enumerate(channels, 1):
        name = said[3].decode("utf-8", "replace") if said else path.stem
        yield Record(name if len(channels) == 1 else f"{name} {number}", _full_scale(channel) * scale, float(rate), unit)


def _full_scale(values: np.ndarray) -> np.ndarray:
    """Return samples with full scale as 1; those of 8 bits are around 128, those of 24 bits come as 32 bits."""
    if values.dtype.kind == "f":
        return values.astype(float)
    if values.dtype.kind == "u":
        return (values.astype(float) - 128.0) / 128.0
    return values.astype(float) / 2.0 ** (8 * values.dtype.itemsize - 1)
