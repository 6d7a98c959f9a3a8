"""Signals of many samples: their times are not kept, and figures look at them in parts."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.runs import figure_data
from vibroimpact.runs.figure_data import decimated, decimated_samples

COUNT = 3_000_000
RANDOM = np.random.default_rng(0).standard_normal(COUNT)
SIGNAL = Signal(Sensor("a", rate=50e3), RANDOM)


def test_times_are_those_of_the_rate() -> None:
    np.testing.assert_array_equal(SIGNAL.time, np.arange(COUNT) / 50e3)
    np.testing.assert_array_equal(SIGNAL.times(COUNT - 3, COUNT + 9), np.arange(COUNT - 3, COUNT) / 50e3)


@pytest.mark.parametrize("rate", [50e3, 48e3, 44100.0, 1e5 / 3.0])
def test_the_first_sample_at_a_time_is_the_one_that_a_search_finds(rate: float) -> None:
    signal = Signal(Sensor("a", rate=rate), np.zeros(5000))
    times = np.concatenate([[-1.0, 0.0, 1e-12, 1.0, 99.0], signal.time[::37], np.nextafter(signal.time[1::41], 1.0)])
    assert [signal.first_at(time) for time in times] == np.searchsorted(signal.time, times).tolist()


def test_the_largest_magnitude() -> None:
    assert SIGNAL.largest == np.abs(RANDOM).max()
    assert Signal(Sensor("a"), np.zeros(0)).largest == 0.0


def test_a_line_looked_at_in_parts_is_that_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    y = np.round(RANDOM[:100_000], 1)  # with many equal extremes
    x = np.sort(np.abs(RANDOM[:100_000]))
    whole = decimated(x, y)
    monkeypatch.setattr(figure_data, "_AT_ONCE", 1777)
    for ours, theirs in zip(decimated(x, y), whole, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert len(whole[0]) <= 4 * 1500


def test_what_a_figure_takes_does_not_grow_with_the_signal() -> None:
    """Columns, differences and orders of all samples at once took eight times the signal."""
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    decimated_samples(SIGNAL)
    peak = tracemalloc.get_traced_memory()[1] - before
    tracemalloc.stop()
    assert peak < 4.0 * RANDOM.nbytes
