"""vibroimpact features: tables of files, the list, and what is not allowed."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

import vibroimpact as vi


@pytest.fixture
def call(command: Callable[..., tuple[int, str, str]]) -> Callable[..., tuple[int, str, str]]:
    return partial(command, "features")


@pytest.fixture
def taps(tmp_path: Path) -> Path:
    """Return a WAV file with two taps on the left, and silence on the right."""
    time = np.arange(8000) / 8000
    left = sum(
        peak
        * np.where(
            time >= at,
            np.exp(-(time - at).clip(0.0) / 5e-3) * np.sin(1e3 * np.pi * (time - at)),
            0.0,
        )
        for at, peak in ((0.2, 0.9), (0.6, 0.45))
    )
    path = tmp_path / "taps.wav"
    wavfile.write(path, 8000, np.stack([left, 0.0 * left], axis=1).astype("f4"))
    return path


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_a_table_is_written(call, taps: Path, tmp_path: Path) -> None:
    status, out, err = call(taps, "-o", tmp_path / "table.csv")
    assert (status, err) == (0, "")
    assert "wrote" in out
    left, right = rows_of(tmp_path / "table.csv")
    expected = vi.signals.feature_table([next(vi.signals.load_records(taps)).value], 8000.0)
    assert (left["channel"], left["signal"], left["unit"], left["file"]) == (
        "taps 1",
        "1",
        "1",
        str(taps),
    )
    assert float(left["packets"]) == 2.0
    assert float(left["peak_ratio"]) == pytest.approx(0.5, abs=1e-3)
    assert float(left["bounce_interval_s"]) == pytest.approx(0.4, abs=2e-4)
    assert [left[name] for name in ("rms", "kurtosis")] == [
        repr(float(expected[name][0])) for name in ("rms", "kurtosis")
    ]
    assert left["lacking"] == "there are fewer than three packets: bounce_restitution"
    assert (right["peak"], right["kurtosis"]) == ("0.0", "")
    assert right["lacking"].startswith("all samples are the same: crest_factor ")
    header = list(left)
    assert [left[name] for name in header[-3:-1]] == ["0.0", "0.0"]
    assert [
        name.startswith(one)
        for name, one in zip(header[6:-3], vi.signals.signal_features(), strict=True)
    ] == len(vi.signals.signal_features()) * [True]


def test_an_existing_file_stays(call, taps: Path, tmp_path: Path) -> None:
    target = tmp_path / "table.csv"
    target.write_text("mine")
    status, _, err = call(taps, "-o", target)
    assert status == 2
    assert "exists; take another name, or --force" in err
    assert target.read_text() == "mine"
    assert call(taps, "-o", target, "--force", "--only", "rms")[0] == 0
    assert target.read_text().startswith(
        "file,channel,signal,start_s,rate_Hz,unit,rms,offset,drift,lacking\n"
    )


def test_json_is_the_table(call, taps: Path, tmp_path: Path) -> None:
    status, out, err = call(
        taps, "--only", "kurtosis,peak,rise_time", "--json", "-o", tmp_path / "t.csv"
    )
    assert status == 0
    assert "wrote" in err
    left, right = json.loads(out)["signals"]
    row = rows_of(tmp_path / "t.csv")[0]
    assert left["peak"] == float(row["peak"])
    assert left["rise_time_s"] == float(row["rise_time_s"])
    assert left["lacking"] == ""
    assert right["kurtosis"] is None
    assert "all samples are the same" in right["lacking"]


def test_it_is_shown(call, taps: Path) -> None:
    _, out, _ = call(taps, "--only", "peak,kurtosis")
    lines = out.splitlines()
    assert lines[0].split() == [
        "feature",
        "least",
        "median",
        "largest",
        "unit",
        "signals",
        "without",
        "it",
    ]
    assert "1: all samples are the same" in lines[2]
    _, alone, _ = call(taps.parent, "--packets", "--only", "peak", "--threshold", "0.6")
    assert alone.splitlines()[0].split() == ["feature", "value", "unit"]


def test_packets_are_rows(call, taps: Path, tmp_path: Path) -> None:
    assert call(taps, "--packets", "--only", "peak,duration", "-o", tmp_path / "p.csv")[0] == 0
    one, other = rows_of(tmp_path / "p.csv")
    assert float(one["start_s"]) == pytest.approx(0.2, abs=2e-3)
    assert float(other["start_s"]) == pytest.approx(0.6, abs=2e-3)
    assert float(one["peak"]) == pytest.approx(2.0 * float(other["peak"]), rel=1e-3)
    assert (one["signal"], other["signal"]) == ("1", "2")


def test_windows_begin_at_the_onset(call, taps: Path, tmp_path: Path) -> None:
    assert (
        call(taps, "--window", "50 ms", "--only", "packets,energy", "-o", tmp_path / "w.csv")[0]
        == 0
    )
    left, _ = rows_of(tmp_path / "w.csv")
    assert float(left["start_s"]) == pytest.approx(0.2, abs=1e-3)
    assert float(left["packets"]) == 1.0


def test_the_list(call) -> None:
    status, out, _ = call("--list")
    assert status == 0
    assert all(f" {name} " in out for name in vi.signals.signal_features())
    listed = json.loads(call("--list", "--json")[1])["features"]
    assert listed.keys() == vi.signals.signal_features().keys()
    assert listed["energy"]["unit"] == "x^2 s"
    assert listed["kurtosis"]["offset_free"] is True


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ((), "name the files or folders with signals"),
        (("nothing.wav",), "there is no such file"),
        (("TAPS", "--only", "kurtossis"), 'Did you mean "kurtosis"'),
        (("TAPS", "--only", ","), "--only names no feature"),
        (("TAPS", "--threshold", "-1"), "the threshold is -1; it must be finite and above 0"),
        (("TAPS", "--dead-time", "5 mm"), "5 mm"),
        (("TAPS", "--dead-time", "-5 ms"), "the dead time is -0.005 s"),
        (("TAPS", "--window", "0 s"), "a window of 0 s is not allowed; it must be greater than 0"),
        (("TAPS", "--window", "5 ms", "--packets"), "give one of them"),
        (("TAPS", "--packets", "--threshold", "5"), "no signals with a packet above the threshold"),
        (("TAPS", "--list"), "takes no files"),
    ],
)
def test_what_is_not_allowed_is_said(
    words: tuple[str, ...], message: str, call, taps: Path, tmp_path: Path
) -> None:
    status, out, err = call(
        *(taps if word == "TAPS" else word for word in words),
        *(() if "--list" in words else ("-o", tmp_path / "t.csv")),
    )
    assert (status, out) == (2, "")
    assert message in err.replace("\n", " ")
    assert not (tmp_path / "t.csv").exists()
