"""What can be read off samples, and what the printed errors tell of their spacing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from vibroimpact.paper.runs import IMPACTS, Runs
from vibroimpact.paper.sampling import (
    CONTACTS,
    contact_pulses,
    error_range,
    grid_error,
    grid_samples,
    implied_instants,
    output_step,
    sampling_section,
    spacing_bound,
    unsampled_gaps,
)


@pytest.fixture(scope="module")
def runs() -> Runs:
    return Runs()


@pytest.mark.parametrize(
    ("quantity", "damping", "errors"),
    [
        ("compression", "constant", [0.376, 0.668, 1.693, 3.399, 5.683]),
        ("compression", "variable", [0.376, 0.277, 0.149, -0.013, -0.189]),
        ("force", "constant", [5.178, 5.504, 6.860, 9.158, 12.231]),
        ("force", "variable", [5.178, 5.019, 4.814, 4.551, 4.256]),
    ],
)
def test_with_no_time_between_samples_the_errors_are_exact(
    runs: Runs, quantity: str, damping: str, errors: list[float]
) -> None:
    for impact, error in zip(IMPACTS, errors, strict=True):
        low, high = error_range(runs, 0.0, quantity, damping, impact)
        assert low == high == pytest.approx(error, abs=6e-4)


def test_the_range_grows_with_the_step(runs: Runs) -> None:
    ranges = [error_range(runs, step, "force", "constant", 2) for step in (0.0, 1e-5, 5e-5, 2.5e-4)]
    lows, highs = zip(*ranges, strict=True)
    assert np.all(np.diff(lows) < 0.0)
    assert np.all(np.diff(highs) > 0.0)
    assert error_range(runs, 1.0, "force", "constant", 2) == (-math.inf, 100.0), (
        "no sample need fall on either contact"
    )


def test_the_range_is_what_samples_at_many_phases_give(runs: Runs) -> None:
    step = 5e-5
    readings = {}
    for name in ("theory", "variable"):
        peak = contact_pulses(runs)[name, "compression", 4]
        phases = np.linspace(0.0, step, 2001)[:, None]
        samples = phases + step * np.arange(10)
        readings[name] = np.interp(samples, peak.times, peak.values, right=0.0).max(axis=1)
    low = 100.0 * (1.0 - readings["variable"].max() / readings["theory"].min())
    high = 100.0 * (1.0 - readings["variable"].min() / readings["theory"].max())
    assert error_range(runs, step, "compression", "variable", 4) == pytest.approx(
        (low, high), abs=0.01
    )


def test_the_spacing(runs: Runs) -> None:
    free = unsampled_gaps(runs)
    assert len(free) == len(CONTACTS) == 9
    assert free.max() == pytest.approx(37e-6, abs=0.5e-6)
    assert spacing_bound(runs) == pytest.approx(free.max() * 20.0 ** (1.0 / 9.0))
    assert spacing_bound(runs) < 0.25 * output_step() == 0.25 * 2.5e-4


def test_the_printed_output_step_gives_other_errors(runs: Runs) -> None:
    times, forces = grid_samples(runs, "constant", output_step(), "force", 1)
    assert len(times) == 1
    assert forces == pytest.approx(7426.0, rel=1e-3)
    assert grid_error(runs, output_step(), "force", "constant", 1) == pytest.approx(13.1, abs=0.05)
    assert (
        max(grid_error(runs, output_step(), "force", "constant", impact) for impact in IMPACTS)
        > 50.0
    )
    assert math.isnan(grid_error(runs, 10.0, "force", "constant", 1)), "no sample in the contact"


def test_a_level_above_the_peak_is_never_passed(runs: Runs) -> None:
    """The third and the fifth impact: what the printed force errors imply is more than
    there was.
    """
    assert np.isnan(implied_instants(runs, "force", "constant", 5)).all()
    peak = contact_pulses(runs)["constant", "force", 5]
    up, down = peak.instants(0.5 * peak.value)
    assert up < peak.times[peak.top] < down
    assert peak.lowest(down - up) == pytest.approx(0.5 * peak.value, rel=1e-4)


def test_the_section_is_computed(runs: Runs) -> None:
    section = sampling_section(runs)
    errors, instants = section.tables
    assert len(errors.cells) == 20
    assert len(instants.cells) == 9
    assert "20 of 20" in section.conclusion[0]
    assert "10234.556 N" in section.conclusion[1]
