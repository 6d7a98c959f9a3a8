"""What the guide on the plate geophone of rivers says."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from river_plate import amplitudes, class_limit
from stated_numbers import says
from vibroimpact.cases.reader import load_table
from vibroimpact.runs.case_document import case_document

PAGE = "docs/guides/river-geophone.md"
SIZES = (10.0, 12.3, 17.4, 21.8, 28.0, 37.6)  # mm


def row(size: float) -> tuple[float, ...]:
    """Return class limit, median at 1 m/s, its deviation [%], largest over smallest, and
    median at 0.3 m/s.
    """
    fast = amplitudes(size, 1.0)
    median = float(np.median(fast))
    return (
        class_limit(size),
        median,
        100.0 * (median / class_limit(size) - 1.0),
        fast.max() / fast.min(),
        float(np.median(amplitudes(size, 0.3))),
    )


@pytest.mark.slow
def test_the_table_and_its_conclusions() -> None:
    says(PAGE, "| 10 | {} | {} | {} % | {} times | {} |", *row(10.0))
    says(PAGE, "| 12.3 | {} | {} | {} % | {} | {} |", *row(12.3))
    says(PAGE, "| 17.4 | {} | {} | {} % | {} | {} |", *row(17.4))
    says(PAGE, "| 21.8 | {} | {} | {} % | {} | {} |", *row(21.8))
    says(PAGE, "| 28 | {} | {} | {} % | {} | {} |", *row(28.0))
    says(PAGE, "| 37.6 | {} | {} | {} % | {} | {} |", *row(37.6))
    _, fast, deviation, ratio, slow = np.array([row(size) for size in SIZES]).T
    assert deviation[1] < 0.0 < deviation[2], "the lines cross between 12 and 17 mm"
    exponents = np.log(fast / slow) / np.log(1.0 / 0.3)
    at_limit = dict(
        zip(
            SIZES,
            (np.array([class_limit(size) for size in SIZES]) / fast) ** (1.0 / exponents),
            strict=True,
        )
    )
    says(
        PAGE,
        "one of 17 mm at {} m/s, one of 28 mm at {} m/s, one of 38 mm at {} m/s",
        at_limit[17.4],
        at_limit[28.0],
        at_limit[37.6],
    )
    says(PAGE, "(exponents of {} to {})", exponents.min(), exponents.max())
    says(PAGE, "at 1 m/s differs by {} to {} times", ratio.min(), ratio.max())
    says(
        PAGE,
        "with D^3 that is a factor of {} to {} in size",
        ratio.min() ** (1 / 3),
        ratio.max() ** (1 / 3),
    )
    for computed in (fast, slow):
        slope = np.polyfit(np.log(SIZES), np.log(computed), 1)[0]
        assert 2.9 < slope < 3.1, "at constant speed the computed amplitude grows as D^3"


@pytest.mark.slow
def test_what_yielding_does() -> None:
    lower = [
        100.0 * (1.0 - np.median(amplitudes(size, 1.0, 235e6)) / np.median(amplitudes(size, 1.0)))
        for size in (10.0, 17.4, 37.6)
    ]
    says(
        PAGE,
        "medians of grains of 10, 17.4 and 37.6 mm at 1 m/s are {} to {} % lower",
        min(lower),
        max(lower),
    )


def test_the_plate_yields() -> None:
    for speed, words in (
        (1.0, "1.44 GPa is 3.8 times that at which"),
        (0.3, "2.4 times that at which"),
    ):
        case = vi.load_case(
            "signals:river-plate", {"drop": {"speed": speed, "position": [0.0, 0.0]}}
        )
        assert any(words in doubt for doubt in case_document(case)["doubts"])
    says(
        PAGE,
        "Hertz's peak pressure is {} GPa for every size, {} times that at which steel",
        1.44,
        3.8,
    )
    says(PAGE, "begins to yield, and at 0.3 m/s {} times", 2.4)


def test_water_takes_a_hundredth_of_the_rebound() -> None:
    achieved = []
    for liquid in (True, False):
        table = load_table("signals:river-plate")
        del table["sweep"], table["sensors"]
        table["plate"], table["drop"], table["run"] = (
            {"material": "steel"},
            {"speed": 1.0},
            {"impacts": 1},
        )
        table["sphere"]["radius"], table["contact"]["liquid"] = 0.005, liquid
        achieved.append(float(vi.simulate(vi.case_of(table)).impacts["restitution_achieved"][0]))
    says(
        PAGE,
        "a quartz grain of 10 mm at 1 m/s is lower by {} %",
        100.0 * (1.0 - achieved[0] / achieved[1]),
    )


@pytest.mark.slow
def test_the_packets_of_one_grain() -> None:
    one_grain = {
        "sphere.radius": "14 mm",
        "drop": {"speed": 0.5, "position": [0.1, 0.05]},
        "run.duration": "60 ms",
        "plate.modes": 30,
    }
    signal = vi.simulate(vi.load_case("signals:river-plate", one_grain)).signals()["geophone"]
    packets = vi.signals.find_packets(
        vi.signals.Record("geophone", signal.value, signal.sensor.rate, "V")
    )
    says(PAGE, "one packet with {} impulses above the threshold", packets.impulses[0])
    says(PAGE, "signal.largest # {} V", signal.largest)
