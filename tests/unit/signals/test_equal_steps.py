"""Times that are rounded or jitter: the rate behind them, and samples at equal steps with
the error that resampling adds.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.signals.reading.equal_steps import at_equal_steps, rate_of

RATE, SAMPLES = 200.0, 2000
TIME = 3.0 + np.arange(SAMPLES) / RATE


def swing(time: np.ndarray, frequency: float = 7.0) -> np.ndarray:
    return np.sin(2.0 * np.pi * frequency * time) + 0.3 * np.cos(
        2.0 * np.pi * 2.2 * frequency * time
    )


@pytest.mark.parametrize("digits", [2, 1])
def test_rounded_times(digits: int) -> None:
    found = at_equal_steps(np.round(TIME, digits), [swing(TIME)])
    assert found.rate == pytest.approx(RATE, rel=10.0**-digits / 10.0)
    assert found.start == pytest.approx(3.0, abs=10.0**-digits)
    np.testing.assert_array_equal(found.values[0], swing(TIME))
    assert found.doubts[0].startswith(
        f"its times are rounded to {10.0**-digits:g} s, {RATE * 10.0**-digits:g} steps"
    )


@pytest.mark.parametrize(("rate", "decimals"), [(400.0, 3), (300.0, 3), (30.0, 2), (7000.0, 4)])
def test_times_of_steps_that_are_no_multiple_of_the_last_digit(rate: float, decimals: int) -> None:
    """Steps of 2.5 ms in times with three decimals are 2 ms and 3 ms: those of rounding,
    and no jitter.
    """
    time = 0.00013 + np.arange(SAMPLES) / rate
    found = at_equal_steps(np.round(time, decimals), [swing(time)])
    assert found.rate == pytest.approx(rate, rel=1e-4)
    np.testing.assert_array_equal(found.values[0], swing(time))
    assert found.doubts[0].startswith(
        f"its times are rounded to {10.0**-decimals:g} s, {rate * 10.0**-decimals:.3g} steps"
    )


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("jitter", [0.05, 0.2, 0.4])
def test_times_that_jitter(jitter: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    step = np.maximum(1.0 + jitter * random.standard_normal(SAMPLES), 0.2) / RATE
    time = np.cumsum(step)
    found = at_equal_steps(time, [swing(time), 0.0 * time])
    there = found.start + np.arange(SAMPLES) / found.rate
    error = np.sqrt(np.mean((found.values[0] - swing(there)) ** 2)) / np.std(swing(there))
    stated = float(found.doubts[0].partition("up to ")[2].partition(" %")[0]) / 100.0
    assert error < stated < 0.1
    assert "0 % of its standard deviation" in found.doubts[1]


def test_a_phone_s_table_is_read_with_a_doubt(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    time = TIME + 0.2 / RATE * random.standard_normal(SAMPLES)
    rows = "\n".join(f"{at:.6f},{value:.6f}" for at, value in zip(time, swing(time), strict=True))
    (tmp_path / "phone.csv").write_text(f'"Time (s)","Acceleration x (m/s^2)"\n{rows}\n')
    (record,) = vi.signals.load_records(tmp_path / "phone.csv")
    assert record.rate == pytest.approx(RATE, rel=1e-3)
    assert record.doubts[0].startswith('"acceleration_x": its times jitter by ')
    assert vi.signals.feature_table([record.value], record.rate)["peak_frequency"][
        0
    ] == pytest.approx(7.0, abs=0.11)


@pytest.mark.parametrize(
    "time",
    [
        np.append(TIME, TIME[-1] + 1.0),  # a gap
        np.append(TIME[:1000], TIME[1000:] + 0.1),
        # a history, dense in a contact
        np.append(np.arange(50) * 1e-6, 1e-3 + np.arange(50) * 1e-2),
        np.append(TIME[::-1], 10.0),
    ],
)
def test_other_steps_are_refused(time: np.ndarray) -> None:
    with pytest.raises(vi.InputError, match="do not rise"):
        at_equal_steps(time, [time])


@pytest.mark.parametrize("form", ["%.6g", "%.5g", "%.4g"])
def test_times_with_a_number_of_digits(form: str) -> None:
    """As C, MATLAB and numpy.savetxt write them by default: the step of the rounding
    grows with the time, here beyond 1 s.
    """
    rate = 2.0 * 10.0 ** (int(form[2]) - 1)
    time = np.arange(int(2.0 * rate) + 1) / rate
    written = np.array([float(form % at) for at in time])
    found = at_equal_steps(written, [swing(time)])
    assert found.rate == pytest.approx(rate, rel=1e-3)
    np.testing.assert_array_equal(found.values[0], swing(time))
    assert found.doubts[0].startswith(
        f"its times are rounded to {form[2]} significant digits, up to "
    )


@pytest.mark.parametrize(
    ("time", "words"),
    [
        ([0.0, 0.0, 0.0], "the times do not rise: all are 0 s; they must rise by equal steps"),
        (
            [0.0, -1.0, -2.0],
            "the times do not rise: sample 2 is 1 s before the previous one, at -1 s; they "
            "must rise by equal steps",
        ),
    ],
)
def test_times_without_lines_have_no_remedy_of_a_table(time: list[float], words: str) -> None:
    """They follow from the header of a universal file, which has no more digits, and no
    second record below.
    """
    with pytest.raises(vi.InputError) as refused:
        rate_of(np.array(time))
    assert str(refused.value) == words
