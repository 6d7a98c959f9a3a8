"""Packets, onset and windows of trains made by hand."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi

RATE = 10e3


def train(*bursts: tuple[int, int, float], samples: int = 3000) -> vi.signals.Record:
    """Return a record of 1 kHz bursts: first sample, periods of ten samples, amplitude."""
    value = np.zeros(samples + 100)
    for first, periods, amplitude in bursts:
        value[first : first + 10 * periods] += amplitude * np.sin(
            2.0 * np.pi * np.arange(10 * periods) / 10.0
        )
    return vi.signals.Record("geophone", value[:samples], RATE, "V", start=2.0)


def test_packets_are_counted_with_peaks_and_impulses() -> None:
    found = vi.signals.find_packets(
        train((500, 8, 1.0), (1200, 5, 0.4), (2000, 12, 0.7)), threshold=0.1
    )
    assert found.signal.tolist() == [0, 0, 0]
    assert found.onset.tolist() == [501, 1201, 2001]
    assert found.peak == pytest.approx(np.sin(0.4 * np.pi) * np.array([1.0, 0.4, 0.7]))
    assert found.impulses.tolist() == [8, 5, 12]
    assert np.all((found.first <= found.onset) & (found.onset - found.first < 10))
    assert np.all(np.abs(found.last - [579, 1249, 2119]) < 10)


def test_what_stays_below_the_threshold_is_no_packet() -> None:
    assert vi.signals.find_packets(
        train((500, 8, 1.0), (1200, 5, 0.05)), threshold=0.1
    ).impulses.tolist() == [8]
    assert len(vi.signals.find_packets(train((500, 8, 1.0)), threshold=1.5).first) == 0


@pytest.mark.parametrize(("dead_time", "packets"), [(0.0, 2), (3e-3, 2), (6e-3, 1)])
def test_packets_within_the_dead_time_are_one(dead_time: float, packets: int) -> None:
    # 5 ms between them
    found = vi.signals.find_packets(
        train((500, 8, 1.0), (630, 8, 1.0)), threshold=0.3, dead_time=dead_time
    )
    assert len(found.first) == packets
    assert found.impulses.sum() == 16


def test_a_record_that_begins_and_ends_loud() -> None:
    found = vi.signals.find_packets(vi.signals.Record("x", np.ones(100), RATE, "V"), threshold=0.5)
    assert (
        found.first.tolist(),
        found.last.tolist(),
        found.impulses.tolist(),
        found.peak.tolist(),
    ) == ([0], [99], [1], [1.0])


@pytest.mark.parametrize("value", [[], [0.0], np.zeros(50)])
def test_silence_has_no_packets(value: list[float]) -> None:
    assert len(vi.signals.find_packets(vi.signals.Record("x", value, RATE, "V")).first) == 0
    with pytest.raises(
        vi.InputError, match=r'x" (is zero throughout|has no samples); it has no onset'
    ):
        vi.signals.onset_time(vi.signals.Record("x", value, RATE, "V"))


def test_without_a_threshold_it_is_a_tenth_of_the_envelope() -> None:
    assert len(vi.signals.find_packets(train((500, 8, 10.0), (1500, 8, 1.5))).first) == 2
    assert len(vi.signals.find_packets(train((500, 8, 10.0), (1500, 8, 0.5))).first) == 1


def test_packets_as_records() -> None:
    one, other = vi.signals.packet_records(train((500, 8, 1.0), (1200, 5, 0.4)), threshold=0.1)
    assert one.start == pytest.approx(2.0 + 0.05, abs=1e-3)
    assert other.start == pytest.approx(2.0 + 0.12, abs=1e-3)
    assert np.abs(other.value).max() == pytest.approx(0.4 * np.sin(0.4 * np.pi))
    assert (one.unit, one.rate, one.name) == ("V", RATE, "geophone")


@pytest.mark.parametrize("before", [0.0, 5e-3])
def test_windows_are_aligned_at_the_onset(before: float) -> None:
    windows = [
        vi.signals.from_onset(train((first, 8, 1.0)), 20e-3, before, threshold=0.1)
        for first in (0, 500, 2950)
    ]
    assert [len(one.value) for one in windows] == 3 * [200]
    assert vi.signals.onset_time(windows[1], threshold=0.1) == pytest.approx(2.0501)
    np.testing.assert_array_equal(windows[0].value, windows[1].value)
    np.testing.assert_array_equal(
        windows[2].value[: int(before * RATE) + 49], windows[1].value[: int(before * RATE) + 49]
    )
    assert not windows[2].value[int(before * RATE) + 50 :].any()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda record: vi.signals.find_packets(record, threshold=0.0),
            "must be finite and above 0",
        ),
        (lambda record: vi.signals.find_packets(record, dead_time=-1.0), "the dead time is -1 s"),
        (
            lambda record: vi.signals.from_onset(record, 0.0),
            "a window of 0 s is not allowed; it must be greater than 0 and finite",
        ),
        (lambda record: vi.signals.from_onset(record, 1e-9), "has 0 samples"),
        (lambda record: vi.signals.from_onset(record, 1e300), "samples at 10000 Hz"),
        (lambda record: vi.signals.from_onset(record, 0.1, before=0.2), "do not lie in a window"),
    ],
)
def test_what_is_not_allowed_is_said(call: object, message: str) -> None:
    with pytest.raises(vi.InputError, match=message):
        call(train((500, 8, 1.0)))


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_samples_must_be_finite(wrong: float) -> None:
    with pytest.raises(vi.InputError, match="not a finite number"):
        vi.signals.find_packets(vi.signals.Record("x", [0.0, wrong], RATE, "V"))


@pytest.mark.parametrize(
    ("value", "rate", "message"),
    [
        ([[1.0]], 1.0, "have 2 dimensions"),
        (["a"], 1.0, "real numbers"),
        ([1.0], -1.0, "the rate is"),
        ([1.0], np.inf, "the rate is"),
    ],
)
def test_a_record_is_a_row_of_numbers_at_a_rate(value: object, rate: float, message: str) -> None:
    with pytest.raises(vi.InputError, match=message):
        vi.signals.Record("x", value, rate, "V")
