"""Measured restitutions near 1: noise is believed, within limits, and no interval leaves
what a restitution can be.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.contact_law.law_report import match_words

NEWTON = {"law": "newton", "restitution": 0.9}
SPEEDS = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]


def calibrated(target: object, contact: object = NEWTON, **section: object) -> Calibration:
    return calibrate_case(
        calibration_of(plain_case(contact=contact, calibrate={"target": target, **section}))
    )


def refused(target: object, **section: object) -> str:
    with pytest.raises(vi.InputError) as caught:
        calibrated(target, **section)
    return str(caught.value)


def file_of(folder: Path, values: list[float], header: str = "restitution") -> str:
    path = folder / "measured.csv"
    rows = "\n".join(f"{speed},{value}" for speed, value in zip(SPEEDS, values, strict=False))
    path.write_text(f"approach_speed_m_s,{header}\n{rows}\n")
    return str(path)


@pytest.mark.parametrize(
    "contact", [NEWTON, {"law": "adams-impact", "damping_max": 20.0}], ids=["newton", "adams"]
)
def test_1_003_is_noise(tmp_path: Path, contact: dict) -> None:
    """In a file, in the case, and of a law whose damping can't be negative."""
    values = [1.003, 0.97, 0.96, 0.96, 0.94, 0.93]
    file = calibrated(file_of(tmp_path, values), contact, degree=1, bootstrap=0)
    case = calibrated(
        {"restitution": values, "approach_speed": SPEEDS}, contact, degree=1, bootstrap=0
    )
    np.testing.assert_allclose(file.values, case.values, rtol=1e-9)
    assert file.values[0] == (1.0 if contact is NEWTON else 0.0)
    assert np.all(file.outcomes["separation_speed"] <= file.observations.speeds * (1.0 + 1e-12))
    assert any(
        "line 2" in doubt and "though one does within the noise" in doubt and "is taken" in doubt
        for doubt in file.doubts
    )
    assert match_words(file).endswith(
        "matches the target, or comes nearest to it where noise puts it out of reach"
    )


def test_as_a_separation_speed(tmp_path: Path) -> None:
    speeds = [1.003, 1.94, 2.88]
    assert calibrated(file_of(tmp_path, speeds, "separation_speed_m_s"), degree=0).values[0] == 1.0


def test_as_a_height() -> None:
    """From 0.5 m back to 0.501 m."""
    assert calibrated({"rebound_heights": [0.501, 0.45]}, degree=0, air=False).values[0] == 1.0
    assert "is higher than the 0.5 m from which the sphere fell" in refused(
        {"rebound_heights": [0.52, 0.45]}, air=False
    )


def test_1_3_is_refused_with_how_far_is_believed(tmp_path: Path) -> None:
    values = [1.3, 0.97, 0.96, 0.96, 0.94, 0.93]
    for target, where in (
        (file_of(tmp_path, values), "measured.csv, line 2"),
        ({"restitution": values, "approach_speed": SPEEDS}, "restitution 1"),
    ):
        told = refused(target)
        assert (
            f"{where}: restitution is 1.3; it is 1 at most, and 1.3 is more than the 1.01" in told
        )
        assert "that is attributed to noise (three times the scatter of the others)" in told
        assert "check speeds, heights and their units" in told
        assert len(told) < 500


def test_standard_deviations_say_how_far() -> None:
    """Three of them."""
    section = {"restitution": [1.02, 0.97, 0.96], "approach_speed": [1, 2, 3]}
    assert calibrated({**section, "standard_deviation": 0.008}, degree=0).values[0] == 1.0
    assert "the 1.018 that is attributed to noise (three standard deviations)" in refused(
        {**section, "standard_deviation": 0.006}
    )
    assert (
        "the 1.01 that is attributed to noise (1 %, as no standard deviation is given)"
        in refused(section)
    )


@pytest.mark.parametrize(
    ("speed", "restitution", "bootstrap"),
    [(5.0, 0.98, 0), (5.0, 0.98, 400), (5.0, 0.02, 0), (5.0, 0.02, 400)],
)
def test_intervals_end_at_the_limits(speed: float, restitution: float, bootstrap: int) -> None:
    """Of a restitution at 0 and 1, however wide its noise."""
    target = {
        "restitution": [restitution] * 3,
        "approach_speed": [speed, 1.2 * speed, 1.5 * speed],
        "standard_deviation": 0.03,
    }
    found = calibrated(target, degree=0, bootstrap=bootstrap)
    low, high = found.intervals.T
    assert np.all((low >= 0.0) & (high <= 1.0))
    assert np.all((low <= found.values) & (found.values <= high))
    assert np.all(high == 1.0) if restitution > 0.5 else np.all(low == 0.0)


def test_damping_is_not_negative() -> None:
    target = {"restitution": [0.99, 0.985], "approach_speed": [3, 5], "standard_deviation": 0.02}
    found = calibrated(target, {"law": "adams-impact", "damping_max": 10.0}, degree=0, bootstrap=0)
    assert np.all(found.intervals[:, 0] == 0.0)


def test_a_bootstrap_widens_a_polynomial_that_does_not_fit() -> None:
    """By the scatter of the residuals, as to first order: its samples have the noise that
    is given.
    """
    target = {
        "restitution": [0.7, 0.65, 0.75, 0.8, 0.7],
        "approach_speed": SPEEDS[:5],
        "standard_deviation": 0.001,
    }
    first, drawn = (calibrated(target, degree=1, bootstrap=draws) for draws in (0, 1000))
    assert any(
        "the intervals of the polynomial are widened accordingly" in doubt for doubt in drawn.doubts
    )
    np.testing.assert_allclose(drawn.fit.half_widths(0.95), first.fit.half_widths(0.95), rtol=0.1)
