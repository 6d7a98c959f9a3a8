"""Numbers of the page on calibration."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from ball_records import heard
from oblique_measured import (
    ALL,
    ALUMINA,
    ANGLES,
    FRICTION,
    GLASS,
    MEASURED,
    SLIPPING,
    fitted_friction,
)
from stated_numbers import says
from support import blocks, module_at, plain_case
from vibroimpact.calibration.fit.calibrated_drops import MOST_IMPACTS
from vibroimpact.calibration.fit.typed_inputs import _NAMED
from vibroimpact.calibration.observed.inputs import BRIEF, EARTH
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.calibration.records import bounce_record, force_record, position_record
from vibroimpact.calibration.records.evaluate_measurement import _MATTERS
from vibroimpact.contact.pair import effective_shear_modulus
from vibroimpact.measurements.table_file import TABLE
from vibroimpact.signals.bounces import chain, touches
from vibroimpact.units.written import read_written

PAGE = "docs/calibration.md"


@cache
def paper() -> vi.calibration.Calibration:
    found = vi.calibration.calibrate_case(vi.calibration.load_calibration("paper:calibration"))
    assert isinstance(found, vi.calibration.Calibration)
    return found


def test_the_first_impact_of_a_record() -> None:
    says(PAGE, "differs from the second one by a factor of {} at most", bounce_record._UNLIKE)


def test_dampings() -> None:
    """Those found, and those printed, which the case gives."""
    rows = list(zip(paper().observations.speeds, paper().values, paper().given, strict=True))
    says(PAGE, "| 1 | {} | {} | {} |", *rows[0])
    says(PAGE, "| 2 | {} | {} | {} |", *rows[1])
    says(PAGE, "| 3 | {} | {} | {} |", *rows[2])
    says(PAGE, "| 4 | {} | {} | {} |", *rows[3])
    says(PAGE, "| 5 | {} | {} | {} |", *rows[4])
    function = paper().fit.function
    constant, slope, curvature = function.coefficients
    says(
        PAGE,
        "| function of the speed | {} to {} | {} + {} v - {} v²",
        function.slowest,
        function.fastest,
        constant,
        slope,
        -curvature,
    )
    says(PAGE, "found.values # [{}, {}, {}, {}, {}]", *paper().values)


def test_what_remains() -> None:
    off = {way: paper().drops[way] for way in ("target", "variable", "constant")}
    force = 100.0 * (1.0 - off["variable"]["max_force_N"] / off["target"]["max_force_N"])
    says(PAGE, "the largest force is {} to {} % below the target", force.min(), force.max())
    height = 100.0 * (1.0 - off["constant"]["rebound_height_m"] / off["target"]["rebound_height_m"])
    says(PAGE, "constant damping the fifth rebound is {} % too low", height[4])


def test_sizes_of_files() -> None:
    says(PAGE, "A table has at most {} MB", 1e-6 * TABLE.largest)


def test_impacts_that_are_matched() -> None:
    says(PAGE, "at most the first {} impacts", MOST_IMPACTS)


@pytest.mark.slow
def test_drifting_forces() -> None:
    """The records of the test of that name, counted."""
    drifts = module_at("tests/unit/calibration/test_force_drift.py")
    contact = {"law": "adams-impact", "damping_max": 200.0}
    response = vi.simulate(
        vi.case_of(plain_case(contact=contact, drop={"height": 1.0}, run={"impacts": 3}))
    )
    begin, duration = float(response.impacts["time_s"][0]), float(response.impacts["duration_s"][0])
    time = np.arange(begin - 6.0 * duration, begin + 12.0 * duration, 1e-7)
    force, exact = response.at(time)["force_N"], float(response.impacts["separation_speed_m_s"][0])

    def covered(drift: Any) -> float:
        seen = [
            drifts.measured(response, lambda at: np.interp(at, time, force), drift, seed)
            for seed in range(drifts.TIMES)
        ]
        off = np.array([one.wanted["separation_speed"][0] for one in seen]) - exact
        stated = np.array([standard_deviations(one.noise["separation_speed"])[0] for one in seen])
        return 100.0 * float(np.mean(np.abs(off) <= 1.96 * stated))

    parts = [
        covered(drift) for drift in (drifts.ramp, drifts.settling, drifts.discharge, drifts.wander)
    ]
    says(
        PAGE,
        "noise of {} % and drifts of {} %",
        100.0 * 20.0 / float(force.max()),
        100.0 * drifts.PART,
    )
    says(
        PAGE,
        "hum), {} of each kind, the 95 % interval contains the true rebound in {} to {} %",
        drifts.TIMES,
        min(parts),
        max(parts),
    )


def test_coarse_forces() -> None:
    says(PAGE, "fewer than {} samples in a contact", force_record._COARSE)


def test_zero_of_a_record_of_positions() -> None:
    says(PAGE, "or a clock by more than {} %, is refused", 100.0 * position_record._CLOCK_OFF)
    says(
        PAGE,
        "a tenth of the radius, or the clock by more than {} %",
        100.0 * position_record._LARGE_CLOCK,
    )
    assert position_record._LARGE_ZERO == 0.1
    assert position_record._SURE == 3.0
    assert position_record._FAR == 0.5


@pytest.mark.slow
def test_intervals_of_records_of_positions() -> None:
    zeros = module_at("tests/unit/calibration/test_position_zero.py")
    inside = 100.0 * float(np.mean(np.abs(zeros.deviates()) <= 1.96))
    says(
        PAGE,
        "In {} random records with zeros up to {} mm and drifts up to {} mm/s",
        zeros.TIMES,
        2.0,
        1.0,
    )
    says(PAGE, "noise of {} to {} mm, and clocks that are off by {} % (standard", 0.03, 0.4, 0.3)
    says(PAGE, "the {} % interval contains the true restitution in {} %.", 95.0, inside)


def test_a_contact_in_a_flight() -> None:
    says(
        PAGE,
        "{} for 0.2 ms, 300 ms and 0.5, but {} for 5 ms and 100 ms",
        0.5 * 0.2 / 300.0,
        0.5 * 5.0 / 100.0,
    )


def test_how_bounces_are_found() -> None:
    says(PAGE, "a sudden rise of the power above {} Hz", touches._HUM_CUT_OFF)
    says(PAGE, "by a factor between {} and {} that changes slowly", chain.LOWEST, chain.HIGHEST)


@pytest.mark.slow
def test_intervals_of_bounces() -> None:
    """The records of the test of bounces, counted."""
    bounces = module_at("tests/unit/calibration/test_bounces.py")
    off, wide, level = [], [], []
    for seed in range(100):
        condition = bounces.CONDITIONS[seed // 5 % 5]
        made = heard(seed, *bounces.BALLS[seed % 5], **condition)
        found = vi.signals.find_bounces(made.record)
        off += (found.restitution - made.restitution[: len(found.restitution)]).tolist()
        wide += (bounces.SAID * np.sqrt(np.diag(found.covariance))).tolist()
        level += [condition["decibels"]] * len(found.restitution)
    within, noise = np.abs(off) <= wide, np.array(level)
    parts = [
        100.0 * float(part.mean()) for part in (within, within[noise == 0.0], within[noise == 20.0])
    ]
    says(
        PAGE,
        "they contain the true restitution of {} % of {} impacts ({} % at 0 dB, {} % at 20 "
        "dB), and the largest error is {}.",
        parts[0],
        len(off),
        *parts[1:],
        float(np.abs(off).max()),
    )


@pytest.mark.slow
def test_flights_in_air() -> None:
    (case,) = (
        table
        for table in map(tomllib.loads, blocks(PAGE, "toml"))
        if "air" in table.get("calibrate", {})
    )

    def first(**changes: Any) -> tuple[float, vi.calibration.Calibration]:
        found = vi.calibration.calibrate_case(
            vi.calibration.calibration_of({**case, "calibrate": {**case["calibrate"], **changes}})
        )
        assert isinstance(found, vi.calibration.Calibration)
        return float(found.outcomes["separation_speed"][0] / found.observations.speeds[0]), found

    in_air, found = first()
    assert any("strains" in doubt for doubt in found.doubts)  # the ball is too soft for Hertz
    says(PAGE, "A rubber ball of {} mm", 2.0 * 13.0)
    says(
        PAGE,
        "has {} at its first impact if its heights are treated as those in a vacuum",
        first(air=False)[0],
    )
    says(PAGE, "and the result is {}.", in_air)
    says(
        PAGE,
        "a warning states the largest change of a restitution if it exceeds {} %",
        100.0 * _MATTERS,
    )
    says(PAGE, "drag (air of {} kg/m³", float(vi.Air().density))


def test_the_penetration_of_the_paper() -> None:
    what = vi.calibration.load_calibration("paper:full-damping-penetration")
    found = vi.calibration.calibrate_case(what)
    assert isinstance(found, vi.calibration.Calibration)
    radius, gravity = what.case.sphere.radius, what.case.drop.gravity
    given, wanted = (float(one["separation_speed"][0]) for one in (found.as_given, found.outcomes))
    heights = [radius + speed**2 / (2.0 * gravity) for speed in (given, wanted)]
    says(
        PAGE,
        "the first rebound height is {} m instead of {} m; {} mm matches it",
        *heights,
        1e3 * float(found.values[0]),
    )
    says(PAGE, "prints a full-damping penetration of {} m", float(found.given[0]))


@cache
def fitted(
    friction: str, steep: bool, *more: str
) -> tuple[vi.calibration.FrictionCalibration, float]:
    """The fit to the measured impacts, all or the steep ones, and the mean error of the
    tangential restitution.
    """
    rows = SLIPPING if steep else ALL
    found = fitted_friction(friction, rows, *more)
    return found, float(np.abs(found.outcomes["tangential_restitution"] - MEASURED[rows]).mean())


def row(friction: str) -> list[float]:
    """A row of the table: coefficient and interval, mean error; coefficient and interval
    of the steep impacts.
    """
    (found, error), (steep, _) = fitted(friction, False), fitted(friction, True)
    assert found.intervals is not None
    assert steep.intervals is not None
    return [found.values[0], *found.intervals[0], error, steep.values[0], *steep.intervals[0]]


@pytest.mark.slow
def test_measured_friction() -> None:
    says(PAGE, "who determined {} from those that slide throughout", FRICTION)
    says(PAGE, "from {}° on: coefficient", float(np.degrees(ANGLES[SLIPPING][0])))
    says(PAGE, "| mdr | {} ({} to {}) | {} | {} ({} to {}) |", *row("mdr"))
    says(PAGE, "| coulomb | {} ({} to {}) | {} | {} ({} to {}) |", *row("coulomb"))
    says(PAGE, "| mindlin | {} ({} to {}) | {} | {} ({} to {}) |", *row("mindlin"))
    found, error = fitted("mdr", False, "friction.effective_shear_modulus")
    assert found.intervals is not None
    modulus = [
        1e-9 * float(one)
        for one in (found.values[1], *found.intervals[1], effective_shear_modulus(ALUMINA, GLASS))
    ]
    says(
        PAGE,
        "| mdr with the shear modulus: {} GPa ({} to {}), {} from the materials | {} ({} to "
        "{}) | {} |",
        *modulus,
        found.values[0],
        *found.intervals[0],
        error,
    )


def test_typed_inputs() -> None:
    """What is typed has the standard deviations of the table."""
    stated = [read_written(text, "m").deviation for text in ("0.6 m +- 5 mm", "0.6 m +- 1 %")]
    says(PAGE, "as given, here {} mm and {} mm", *(1e3 * one for one in stated))
    half = 3.0**0.5 * read_written("0.6 m", "m").deviation
    whole = read_written("600 mm", "m").deviation
    sizes = 1e3 * half, 577.35 * half, 1e3 * whole
    says(
        PAGE,
        "half a unit of its last digit: within {} mm, {} mm as a standard deviation; {} mm for",
        *sizes,
    )
    says(
        PAGE,
        "nothing, for gravity | {} m/s², as it varies over the Earth: {} m/s²",
        EARTH,
        EARTH.deviation,
    )
    says(PAGE, "the name of a material | {} % of its density", 100.0 * _NAMED)
    says(PAGE, "for `--contact` of a record of bounces | {} ms", 1e3 * BRIEF.deviation)
    flight = 2.0 * 0.82 * np.sqrt(2.0 * 0.6 / EARTH)
    time = np.append(0.0, np.cumsum(flight * 0.82 ** np.arange(5)))
    touches = vi.signals.Bounces(
        vi.signals.Record("microphone", np.zeros(48000), 48e3, "Pa"),
        time,
        np.full(6, 1e-6),
        np.ones(6),
        np.zeros(0),
        (),
    )
    found = vi.calibration.rebounds_of(touches, height="0.6 m")
    says(
        PAGE,
        "with the height typed as 0.6 m is {} ({} to {})",
        found.restitution[0],
        *found.intervals[0],
    )
