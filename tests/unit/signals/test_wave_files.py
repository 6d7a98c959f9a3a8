"""WAV files: every format as SciPy reads it, headers before samples, and what a file that
is cut off says.
"""

from __future__ import annotations

import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

import vibroimpact as vi
from vibroimpact.cli import main

TAIL = bytes.fromhex("800000aa00389b71")
RATE = 8000


def chunk(order: str, name: bytes, content: bytes, size: int | None = None) -> bytes:
    return (
        struct.pack(f"{order}4sI", name, len(content) if size is None else size)
        + content
        + b"\0" * (len(content) % 2)
    )


def wave(
    data: bytes,
    width: int = 2,
    channels: int = 1,
    *,
    tag: int = 1,
    order: str = "<",
    stated: int | None = None,
    more: bytes = b"",
    extended: bool = False,
) -> bytes:
    frame = channels * width
    form = struct.pack(
        f"{order}HHIIHH",
        0xFFFE if extended else tag,
        channels,
        RATE,
        RATE * frame,
        frame,
        8 * width,
    )
    if extended:
        form += struct.pack(f"{order}HHIIHH", 22, 8 * width, 0, tag, 0, 16) + TAIL
    content = b"WAVE" + chunk(order, b"fmt ", form) + more + chunk(order, b"data", data, stated)
    return struct.pack(f"{order}4sI", b"RIFF" if order == "<" else b"RIFX", len(content)) + content


def written(folder: Path, content: bytes, name: str = "sound.wav") -> Path:
    (folder / name).write_bytes(content)
    return folder / name


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("extended", [False, True])
@pytest.mark.parametrize(("width", "tag"), [(1, 1), (2, 1), (3, 1), (4, 1), (8, 1), (4, 3), (8, 3)])
def test_formats_as_scipy_reads_them(
    width: int, tag: int, extended: bool, order: str, tmp_path: Path
) -> None:
    random = np.random.default_rng(width)
    data = (
        random.normal(size=(500, 3)).astype(f"{order}f{width}").tobytes()
        if tag == 3
        else random.bytes(1500 * width)
    )
    path = written(tmp_path, wave(data, width, 3, tag=tag, order=order, extended=extended))
    rate, expected = wavfile.read(path)
    if tag == 1:
        middle, size = (
            (128.0, 128.0) if width == 1 else (0.0, 2.0 ** (8 * expected.dtype.itemsize - 1))
        )
        expected = (expected.astype(float) - middle) / size
    found = list(vi.signals.load_records(path))
    assert [one.name for one in found] == ["sound 1", "sound 2", "sound 3"]
    assert all(one.rate == rate == RATE and one.doubts == () for one in found)
    assert np.array_equal(np.stack([one.value for one in found], axis=1), expected.astype(float))


def test_samples_in_blocks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks of a few frames, and channels one after another, give the same."""
    data = np.random.default_rng(1).bytes(600 * 3 * 5)
    path = written(tmp_path, wave(data, 3, 5))
    whole = [one.value for one in vi.signals.load_records(path)]
    monkeypatch.setattr("vibroimpact.signals.reading.wave._BLOCK", 70)
    monkeypatch.setattr("vibroimpact.signals.reading.wave._TOGETHER", 2 * 8 * 600)
    assert np.array_equal([one.value for one in vi.signals.load_records(path)], whole)


def test_streamed_and_long_files(tmp_path: Path) -> None:
    """Of unknown length: to the end of the file; and with the length in 64 bits."""
    data = bytes(2000)
    (streamed,) = vi.signals.load_records(written(tmp_path, wave(data, stated=0xFFFFFFFF)))
    assert (len(streamed.value), streamed.doubts) == (1000, ())
    long = wave(
        data + b"LISTjunk",
        stated=0xFFFFFFFF,
        more=chunk("<", b"ds64", struct.pack("<QQQ", 0, len(data), 1000)),
    )
    (found,) = vi.signals.load_records(written(tmp_path, b"RF64" + long[4:]))
    assert (len(found.value), found.doubts) == (1000, ())


def test_a_file_that_is_cut_off_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    sound = np.random.default_rng(1).integers(-9000, 9000, 400, dtype=np.int16).tobytes()
    path = written(tmp_path, wave(sound, stated=3000))
    words = (
        "the file is cut off, or its header is wrong: it has 400 of the 1,500 samples of a "
        "channel that its header states"
    )
    (record,) = vi.signals.load_records(path)
    assert (len(record.value), record.doubts) == (400, (words,))
    monkeypatch.setattr("sys.argv", ["vibroimpact", "features", str(path), "--only", "rms"])
    with pytest.raises(SystemExit, match="0"):
        main()
    told = "".join(capsys.readouterr().err.split())
    assert f"vibroimpact: warning: {path}: {words}".replace(" ", "") in told


def comment(words: str) -> bytes:
    return chunk("<", b"LIST", b"INFO" + chunk("<", b"ICMT", words.encode() + b"\0"))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (wave(b""), "there are no samples in this WAV file"),
        (wave(b"\0"), "there are no samples in this WAV file"),
        (
            wave(bytes(40), more=comment("1.0 is -- V (voltage of a)")),
            'by its comment 1.0 is "--" V; it must be a finite number',
        ),
        (
            wave(bytes(40), more=comment("1.0 is 1e999 V (voltage of a)")),
            'by its comment 1.0 is "1e999" V',
        ),
        (
            wave(bytes(40), more=comment("1.0 is 1 eggs (number of a)")),
            '"eggs" is no unit of a signal',
        ),
        (wave(bytes(40), tag=2), "holds no samples of 8 to 64 bits without compression"),
        (wave(bytes(40), 2, 0), "the WAV file is damaged"),
        (wave(bytes(40))[:30], "the WAV file is damaged"),
        (b"RIFF\0\0\0\0WAVE" + chunk("<", b"junk", b"") * 100_000, "the WAV file is damaged"),
        (b"OggS" + bytes(100), "this is no WAV file"),
    ],
    ids=[
        "empty",
        "less-than-a-sample",
        "no-number",
        "too-large",
        "no-unit",
        "compressed",
        "no-channels",
        "cut-off",
        "many-chunks",
        "ogg",
    ],
)
def test_refused(content: bytes, words: str, tmp_path: Path) -> None:
    path = written(tmp_path, content)
    with pytest.raises(vi.InputError) as error:
        list(vi.signals.load_records(path))
    assert str(error.value).startswith(f"{path}: ")
    assert words in str(error.value)


def test_the_comment_before_or_after_the_samples(tmp_path: Path) -> None:
    data = np.array([16384, -8192], dtype="<i2").tobytes()
    for content in (
        wave(data, more=comment("1.0 is 2.5 mV (voltage of a)")),
        wave(data) + comment("1.0 is 2.5 mV (voltage of a)"),
    ):
        (record,) = vi.signals.load_records(written(tmp_path, content))
        assert (record.name, record.unit, record.value.tolist()) == ("a", "V", [1.25e-3, -0.625e-3])


def test_what_is_no_wave_is_not_read(tmp_path: Path) -> None:
    """Two gigabytes of zeros are refused by their first bytes; a sound takes little more
    memory than its samples.
    """
    zeros = tmp_path / "zeros.wav"
    with zeros.open("wb") as file:
        file.truncate(2_000_000_000)
    samples = 2_000_000
    sound = written(tmp_path, wave(bytes(2 * samples)))
    tracemalloc.start()
    try:
        with pytest.raises(vi.InputError, match="this is no WAV file"):
            list(vi.signals.load_records(zeros))
        assert tracemalloc.get_traced_memory()[1] < 1_000_000
        (record,) = vi.signals.load_records(sound)
        assert tracemalloc.get_traced_memory()[1] < 8 * samples + 30_000_000
    finally:
        tracemalloc.stop()
    assert len(record.value) == samples


def test_a_record_that_needs_too_much_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "vibroimpact.structures.finite_elements.free_memory.free_memory", lambda: 5000.0
    )
    with pytest.raises(
        vi.InputError, match="the samples of a channel need about 8e-06 GB of memory"
    ):
        list(vi.signals.load_records(written(tmp_path, wave(bytes(2000)))))
