"""Signals of many samples: their times are not kept, and charts look at them in parts."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.recording import Signal
from vibroimpact.runs.chart_data import MOST_POINTS, drawn_signal

COUNT = 3_000_000
RANDOM = np.random.default_rng(0).standard_normal(COUNT)
SIGNAL = Signal(Sensor("a", rate=50e3), RANDOM)


def test_times_are_those_of_the_rate() -> None:
    np.testing.assert_array_equal(SIGNAL.time, np.arange(COUNT) / 50e3)
    np.testing.assert_array_equal(
        SIGNAL.times(COUNT - 3, COUNT + 9), np.arange(COUNT - 3, COUNT) / 50e3
    )


@pytest.mark.parametrize("rate", [50e3, 48e3, 44100.0, 1e5 / 3.0])
def test_the_first_sample_at_a_time_is_the_one_that_a_search_finds(rate: float) -> None:
    signal = Signal(Sensor("a", rate=rate), np.zeros(5000))
    times = np.concatenate(
        [[-1.0, 0.0, 1e-12, 1.0, 99.0], signal.time[::37], np.nextafter(signal.time[1::41], 1.0)]
    )
    assert [signal.first_at(time) for time in times] == np.searchsorted(signal.time, times).tolist()


def test_the_largest_magnitude() -> None:
    assert SIGNAL.largest == np.abs(RANDOM).max()
    assert Signal(Sensor("a"), np.zeros(0)).largest == 0.0


def test_what_a_chart_takes_does_not_grow_with_the_signal() -> None:
    """Columns, differences and orders of all samples at once took eight times the signal."""
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    drawn_signal(SIGNAL, 0, 1000)
    peak = tracemalloc.get_traced_memory()[1] - before
    tracemalloc.stop()
    assert peak < 4.0 * RANDOM.nbytes


def test_a_long_signal_is_drawn_whole_and_its_first_response_in_full() -> None:
    time, value = drawn_signal(SIGNAL, 2_000_000, 2_000_500)
    assert len(time) < 10_000
    assert (value.max(), value.min()) == (RANDOM.max(), RANDOM.min())
    inside = (time >= 2_000_000 / 50e3) & (time < 2_000_500 / 50e3)
    np.testing.assert_array_equal(value[inside], RANDOM[2_000_000:2_000_500])
    np.testing.assert_array_equal(time[inside], SIGNAL.time[2_000_000:2_000_500])


def test_a_first_response_without_end_is_cut() -> None:
    time, _ = drawn_signal(SIGNAL, 0, COUNT)
    assert MOST_POINTS <= len(time) < 1.2 * MOST_POINTS


def test_a_signal_that_is_not_long_is_drawn_with_all_samples() -> None:
    short = Signal(Sensor("a", rate=50e3), RANDOM[: 2 * MOST_POINTS])
    time, value = drawn_signal(short, 0, 10)
    assert value is short.value
    np.testing.assert_array_equal(time, short.time)
