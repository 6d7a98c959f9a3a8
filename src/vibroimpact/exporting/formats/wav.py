"""WAV: the signals of the sensors as audio files."""

from __future__ import annotations

import struct
from io import BytesIO

import numpy as np

from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat
from vibroimpact.files.plain_names import one_line, plain_names

_HIGHEST_RATE = 2**32 // 4 - 1
"""Largest sampling rate [Hz]: the header stores bytes per second in 32 bits."""
_MOST_BYTES = 2**32 - 1024


def write(drop: Drop) -> dict[str, bytes]:
    """Return one file per sensor.

    Raises
    ------
    InputError
        If there is no sensor, or WAV can't represent its rate or its length.
    """
    if not drop.signals:
        needed = "[[sensors]]"
        if "plate" not in drop.elastic:
            needed = f'an elastic plate (plate.model = "elastic") and {needed}'
        raise InputError(
            f'"{one_line(drop.name)}" has no sensors, and a WAV file holds the signal of '
            f"one; give the case {needed}"
        )
    return {
        f"{plain}.wav": _file(drop.signals[name])
        for name, plain in plain_names(list(drop.signals)).items()
    }


def full_scale(signal: Signal) -> float:
    """Return the value scaled to 1 in the file: the largest magnitude of the signal; 1 if
    the signal is zero throughout.
    """
    return float(np.abs(signal.value).max(initial=0.0)) or 1.0


def _file(signal: Signal) -> bytes:
    from scipy.io import wavfile

    rate = round(signal.sensor.rate)
    if not 1 <= rate <= _HIGHEST_RATE:
        raise InputError(
            f'{signal.sensor.rate:g} Hz of "{one_line(signal.sensor.name)}" is not allowed '
            f"in a WAV file; it must be 1 to {_HIGHEST_RATE}"
        )
    if 4 * len(signal.value) > _MOST_BYTES:
        raise InputError(
            f'the {len(signal.value)} samples of "{one_line(signal.sensor.name)}" do not '
            "fit into a WAV file, which holds 4 GB"
        )
    scale = full_scale(signal)
    file = BytesIO()
    wavfile.write(file, rate, (signal.value / scale).astype(np.float32))
    return _with_comment(
        file.getvalue(),
        f"1.0 is {scale!r} {signal.sensor.unit} ({signal.sensor.quantity} of "
        f"{one_line(signal.sensor.name)})",
    )


def _with_comment(wave: bytes, phrase: str) -> bytes:
    """Return a WAV file with a comment, as the chunk LIST INFO ICMT at its end."""
    text = phrase.encode("utf-8") + b"\0"
    text += b"\0" * (len(text) % 2)  # chunks start at even offsets
    chunk = b"INFO" + b"ICMT" + struct.pack("<I", len(text)) + text
    content = wave[8:] + b"\0" * (len(wave) % 2) + b"LIST" + struct.pack("<I", len(chunk)) + chunk
    return b"RIFF" + struct.pack("<I", len(content)) + content


def _notes(drop: Drop) -> list[str]:
    notes = []
    for name, plain in plain_names(list(drop.signals)).items():
        sensor = drop.signals[name].sensor
        notes.append(
            f"1.0 in {plain}.wav is {full_scale(drop.signals[name]):.9g} {sensor.unit}; "
            "the comment in the file says so too."
        )
        if sensor.rate != round(sensor.rate):
            notes.append(
                f"The header of {plain}.wav states {round(sensor.rate)} samples a second; "
                f"the signal has {sensor.rate!r}."
            )
        if sensor.rate > 192e3:
            notes.append(f"Players may not play the {sensor.rate:g} Hz of {plain}.wav.")
    return notes


FORMAT = ExportFormat(
    name="wav",
    program="players and programs that analyse sound",
    files="NAME.wav of each sensor: 32-bit floating point at the sensor's rate, scaled to 1.0",
    tested="read back with scipy.io.wavfile of SciPy 1.17, samples and rate the same",
    write=write,
    notes=_notes,
)
