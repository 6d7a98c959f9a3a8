"""Records of acceleration: told from others; the sphere's own is a force."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.contact_law.calibration import Calibration

CONTACT = {"law": "adams-impact", "damping_max": 200.0}


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return vi.simulate(vi.case_of(plain_case(contact=CONTACT, run={"impacts": 3})))


def calibrated(file: Path) -> Calibration:
    return calibrate_case(
        calibration_of(
            plain_case(
                contact={"law": "newton", "restitution": 0.5},
                run={"impacts": 3},
                calibrate={"target": str(file), "degree": 0, "air": False},
            )
        )
    )


def written(
    response: vi.Response,
    file: Path,
    header: str,
    column: str,
    offset: float = 0.0,
    factor: float = 1.0,
) -> Path:
    time = np.arange(0.0, float(response.end_time[0]), 2e-5)
    values = factor * (response.at(time)[column] + offset)
    file.write_text(
        f"time [s],{header}\n"
        + "\n".join(f"{at:.9g},{value:.9g}" for at, value in zip(time, values, strict=True))
    )
    return file


@pytest.mark.parametrize(
    ("offset", "unit", "factor"),
    [(0.0, "m/s^2", 1.0), (9.80665, "m/s^2", 1.0), (0.0, "mm/s^2", 1e3)],
)
def test_the_spheres_own_is_a_force(
    response: vi.Response, tmp_path: Path, offset: float, unit: str, factor: float
) -> None:
    """Of a track, -g in flight, or of an accelerometer, which reads nothing there."""
    column = f"sphere_acceleration [{unit}]"
    found = calibrated(
        written(response, tmp_path / "a.csv", column, "acceleration_m_s2", offset, factor)
    )
    np.testing.assert_allclose(found.values, response.impacts["restitution_achieved"], rtol=5e-3)
    np.testing.assert_allclose(
        found.observations.wanted["max_force"], response.impacts["max_force_N"], rtol=3e-3
    )


@pytest.mark.parametrize(
    "header", ["acceleration [m/s^2]", "force [m/s^2]", "position [m/s^2]", "Acceleration [mm/s^2]"]
)
def test_anothers_is_told_with_what_to_do(
    response: vi.Response, tmp_path: Path, header: str
) -> None:
    with pytest.raises(vi.InputError) as caught:
        calibrated(written(response, tmp_path / "a.csv", header, "acceleration_m_s2"))
    told = str(caught.value)
    assert "a.csv" in told
    assert told.startswith("calibrate.target: ")
    assert "call the column sphere_acceleration" in told
    assert "give rebound heights or restitutions instead" in told
    assert len(told) <= 500 + len(str(tmp_path))
