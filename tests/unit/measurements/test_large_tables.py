"""Calibrations from large tables, and from starts out of proportion, stay within bounds
of time and memory.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hostile_runs
import vibroimpact as vi
from support import plain_case


def calibrated(case: dict[str, Any]) -> None:
    vi.calibration.calibrate_case(vi.calibration.calibration_of(case))


@pytest.mark.slow
def test_a_table_of_many_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Within a gigabyte; a dense matrix of its noise would take half a gigabyte, and there were
    several.

    And within 25 seconds: it takes some 6 on an idle machine, and took 29 where each row was
    followed alone.
    """
    monkeypatch.setattr(hostile_runs, "SECONDS", 25)
    rows = 8000
    random = np.random.default_rng(1)
    speed = random.uniform(1.0, 8.0, rows)
    restitution = 0.8 - 0.02 * speed + 0.01 * random.standard_normal(rows)
    table = "".join(f"{fast},{value}\n" for fast, value in zip(speed, restitution, strict=True))
    (tmp_path / "table.csv").write_text("approach_speed_m_s,restitution\n" + table)
    section = {"model": "hunt-crossley", "target": {"file": str(tmp_path / "table.csv")}}
    assert (
        hostile_runs.failures(
            calibrated,
            [plain_case(contact={"law": "hunt-crossley", "restitution": 0.7}, calibrate=section)],
        )
        == ""
    )


@pytest.mark.slow
def test_friction_from_a_table_of_many_rows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In blocks of impacts, together with its file of results: all impacts of all starts
    at once would take 700 MB.
    """
    monkeypatch.setattr(hostile_runs, "MEMORY", 400_000_000)
    rows = 20_000
    random = np.random.default_rng(1)
    speed, along = random.uniform(1.0, 8.0, rows), random.uniform(0.5, 6.0, rows)
    after = np.maximum(along - 0.34 * speed, 5.0 / 7.0 * along) + 0.02 * random.standard_normal(
        rows
    )
    table = "".join(
        f"{row[0]},{row[1]},{row[2]}\n" for row in zip(speed, along, after, strict=True)
    )
    (tmp_path / "table.csv").write_text(
        "approach_speed_m_s,approach_velocity_x_m_s,separation_velocity_x_m_s\n" + table
    )

    def calibrated_and_saved(case: dict[str, Any]) -> None:
        what = vi.calibration.calibration_of(case)
        vi.calibration.calibrate_case(what).save(tmp_path / "found")

    section = {
        "parameter": ["friction.coefficient"],
        "target": {"file": str(tmp_path / "table.csv")},
    }
    contact = {
        "law": "newton",
        "restitution": 0.7,
        "friction": {"law": "coulomb", "coefficient": 0.1},
    }
    case = plain_case(
        contact=contact, drop={"speed": 3.0, "angle": 0.5}, run={"impacts": 1}, calibrate=section
    )
    assert hostile_runs.failures(calibrated_and_saved, [case]) == ""


@pytest.mark.parametrize("law", ["flores", "gonthier"])
def test_a_start_out_of_proportion(law: str) -> None:
    section = {"model": {"law": law, "restitution": 2e-11}, "target": {"restitution": 0.7}}
    case = plain_case(
        contact={"law": "newton", "restitution": 0.7}, run={"impacts": 1}, calibrate=section
    )
    assert hostile_runs.failures(calibrated, [case]) == ""
