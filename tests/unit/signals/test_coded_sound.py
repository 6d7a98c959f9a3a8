"""Sound as phones keep it: files of known sound, coded by FFmpeg, give its samples, or
its bounces within what coding leaves of them.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.signals.reading.record_files import load_records

RATE, GRAVITY, HEIGHT, RESTITUTION = 48_000, 9.81, 0.3, 0.8
LOSSY = {
    "a.m4a": ("aac", "ipod"),
    "a.mp3": ("libmp3lame", "mp3"),
    "a.ogg": ("libopus", "ogg"),
    "a.opus": ("libopus", "ogg"),
}
LOSSLESS = {"a.flac": ("flac", "flac"), "a.m4a": ("alac", "ipod")}


def bounces(seed: int, noise: float = 3e-4) -> tuple[np.ndarray, np.ndarray]:
    """Return the sound of seven bounces of a restitution, and their times [s]."""
    flights = 2.0 * np.sqrt(2.0 * HEIGHT / GRAVITY) * RESTITUTION ** np.arange(1, 7)
    touches = 0.1 + np.concatenate([[0.0], np.cumsum(flights)])
    time = np.arange(round((touches[-1] + 0.3) * RATE)) / RATE
    sound = noise * np.random.default_rng(seed).standard_normal(len(time))
    for number, touch in enumerate(touches):
        since = (time - touch).clip(0.0)
        ringing = sum(
            np.exp(-since / fade) * np.sin(2.0 * np.pi * pitch * since)
            for pitch, fade in ((1800, 0.02), (4300, 0.012), (9100, 6e-3))
        )
        sound += np.where(time >= touch, 0.24 * RESTITUTION**number * ringing, 0.0)
    return sound, touches


def coded(
    path: Path, sound: np.ndarray, codec: str, container: str, bit_rate: int = 64_000
) -> Path:
    """Write a sound, (samples,) or (channels, samples), with a codec."""
    channels = np.atleast_2d(sound)
    layout = {1: "mono", 2: "stereo"}[len(channels)]
    whole = np.round(channels.clip(-1.0, 1.0) * 32767.0).astype(np.int16)
    frame = av.AudioFrame.from_ndarray(whole.T.reshape(1, -1).copy(), format="s16", layout=layout)
    frame.sample_rate, frame.pts, frame.time_base = RATE, 0, Fraction(1, RATE)
    with av.open(str(path), "w", format=container) as file:
        stream = file.add_stream(codec, rate=RATE)
        stream.layout = layout
        stream.bit_rate = bit_rate
        for part in (frame, None):
            file.mux(stream.encode(part))
    return path


@pytest.mark.parametrize("name", LOSSLESS)
def test_without_losses_the_samples_are_kept(tmp_path: Path, name: str) -> None:
    left, _ = bounces(1)
    both = np.stack([left, 0.5 * left[::-1]])
    found = list(load_records(coded(tmp_path / name, both, *LOSSLESS[name])))
    assert [(one.name, one.rate, one.unit, one.doubts, one.blur) for one in found] == [
        (f"a {n}", RATE, "1", (), 0.0) for n in (1, 2)
    ]
    for one, sent in zip(found, both, strict=True):
        np.testing.assert_allclose(one.value, sent.clip(-1.0, 1.0), atol=1.1 / 32768)


@pytest.mark.parametrize("name", LOSSY)
@pytest.mark.parametrize("bit_rate", [32_000, 64_000, 128_000])
def test_restitutions_hold_whatever_the_coder_lost(
    tmp_path: Path, name: str, bit_rate: int
) -> None:
    """All five restitutions lie within three and a half of their standard deviations;
    those of the WAV file are exact to 1e-6.
    """
    sound, touches = bounces(2)
    (record,) = load_records(coded(tmp_path / name, sound, *LOSSY[name], bit_rate))
    found = vi.signals.find_bounces(record)
    assert len(found.time) == len(touches)
    off = found.restitution - RESTITUTION
    assert (np.abs(off) < 3.5 * np.sqrt(np.diag(found.covariance)) + 1e-5).all()
    assert any("coded with losses" in doubt and "WAV or FLAC" in doubt for doubt in found.doubts)


def test_calibrate_takes_a_phone_recording(tmp_path: Path) -> None:
    file = coded(tmp_path / "bounces.mp3", bounces(3)[0], *LOSSY["a.mp3"])
    case = {
        "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"material": "steel"},
        "drop": {"height": HEIGHT + 0.01, "gravity": GRAVITY},
        "contact": {"law": "adams-impact", "damping_max": 100},
        "calibrate": {"target": {"file": str(file)}},
    }
    found = calibrate_case(calibration_of({"schema_version": 1, **case}))
    assert any("coded with losses" in doubt for doubt in found.doubts)


@pytest.mark.parametrize("name", [*LOSSY, "a.flac"])
@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"#EXTM3U\nhttp://127.0.0.1:9/a.mp3\n",
        b"RIFF\x10\0\0\0WAVEfmt ",
        bytes(range(256)) * 40,
    ],
)
def test_what_is_no_sound_is_refused(
    tmp_path: Path, name: str, content: bytes, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(vi.InputError) as error:
        list(load_records(file))
    assert str(error.value).startswith(f"{file}: ")
    assert len(str(error.value)) - len(str(file)) < 300
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", ["a.mp3", "a.flac", "a.ogg"])
def test_a_file_that_is_cut_off_is_read_as_far_as_it_goes(tmp_path: Path, name: str) -> None:
    file = coded(tmp_path / name, bounces(4)[0], *{**LOSSY, **LOSSLESS}[name])
    (whole,) = load_records(file)
    file.write_bytes(file.read_bytes()[: file.stat().st_size * 2 // 3])
    (cut,) = load_records(file)
    assert 0.5 < len(cut.value) / len(whole.value) < 0.8


def test_the_extra_is_named_where_it_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.m4a").write_bytes(b"\0" * 100)
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(
        vi.InputError,
        match=r"sound in \.m4a needs PyAV, which is not installed: pip install "
        r'"vibroimpact\[audio\]"',
    ):
        list(load_records(tmp_path / "a.m4a"))
