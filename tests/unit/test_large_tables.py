"""Calibrations from large tables, and from starts out of proportion, stay within bounds of time and memory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import attack
import vibroimpact as vi
from support import plain_case


def calibrated(case: dict[str, Any]) -> None:
    vi.calibrate_case(vi.read_calibration(case))


def test_a_table_of_many_rows(tmp_path: Path) -> None:
    """Within a gigabyte and ten seconds; a dense matrix of its noise would take half a gigabyte, and there were several."""
    rows = 8000
    random = np.random.default_rng(1)
    speed = random.uniform(1.0, 8.0, rows)
    restitution = 0.8 - 0.02 * speed + 0.01 * random.standard_normal(rows)
    table = "".join(f"{fast},{value}\n" for fast, value in zip(speed, restitution, strict=True))
    (tmp_path / "table.csv").write_text("approach_speed_m_s,restitution\n" + table)
    section = {"model": "hunt-crossley", "target": {"file": str(tmp_path / "table.csv")}}
    assert attack.failures(calibrated, [plain_case(contact={"law": "hunt-crossley", "restitution": 0.7}, calibrate=section)]) == ""


@pytest.mark.parametrize("law", ["flores", "gonthier"])
def test_a_start_out_of_proportion(law: str) -> None:
    section = {"model": {"law": law, "restitution": 2e-11}, "target": {"restitution": 0.7}}
    case = plain_case(contact={"law": "newton", "restitution": 0.7}, run={"impacts": 1}, calibrate=section)
    assert attack.failures(calibrated, [case]) == ""
