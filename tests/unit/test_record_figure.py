"""What is drawn over a record: the same impacts, simulated with the values found."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, read_calibration
from vibroimpact.calibration.calibration import Calibration
from vibroimpact.calibration.figures import draw_calibration
from vibroimpact.calibration.folder import save_calibration

CONTACT = {"law": "adams-impact", "damping_max": 200.0}


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return vi.simulate(vi.read_case(plain_case(contact=CONTACT, run={"impacts": 3})))


def found_in(response: vi.Response, file: Path, column: str, header: str, step: float) -> Calibration:
    time = np.arange(0.0, float(response.end_time[0]), step)
    rows = "\n".join(f"{at:.9g},{value:.9g}" for at, value in zip(time, response.at(time)[column], strict=True))
    file.write_text(f"time_s,{header}\n{rows}\n")
    table = plain_case(contact=CONTACT, run={"impacts": 3}, calibrate={"target": str(file), "degree": 0, "air": False})
    return calibrate_case(read_calibration(table))


def test_forces(response: vi.Response, tmp_path: Path) -> None:
    """Contact by contact, as near as the record tells; and the page has the picture."""
    found = found_in(response, tmp_path / "force.csv", "force_N", "force_N", 1e-5)
    assert [one.quantity for one in found.overlays] == ["force"] * 3
    for number, one in enumerate(found.overlays):
        simulated = np.interp(*one.measured[:1], *one.simulated, left=0.0, right=0.0)
        largest = response.impacts["max_force_N"][number]
        assert np.abs(one.measured[1] - simulated).max() < 0.06 * largest
        assert one.simulated[1].max() == pytest.approx(largest, rel=5e-3)
    figure = draw_calibration(found)["record"]
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["Impact 1", "Impact 2", "Impact 3"]
    assert [line.get_label() for line in figure.axes[0].lines] == ["measured", "simulated"]
    case = vi.read_case(plain_case(contact=CONTACT, run={"impacts": 3}))
    folder = save_calibration(case, found, tmp_path / "out")
    assert (folder / "figures" / "record.png").is_file()
    assert "Measured and simulated" in (folder / "report.html").read_text()


def test_positions(response: vi.Response, tmp_path: Path) -> None:
    found = found_in(response, tmp_path / "height.csv", "position_m", "position_m", 1e-3)
    (one,) = found.overlays
    apart = (one.measured[1] - one.simulated[1])[np.isfinite(one.simulated[1])]
    assert np.abs(apart).max() < 2e-5
    assert np.isnan(one.simulated[1][one.measured[0] < response.impacts["time_s"][0]]).all()
    assert len(draw_calibration(found)["record"].axes) == 2


def test_no_record_no_picture() -> None:
    table = plain_case(contact={"law": "newton", "restitution": 0.5}, calibrate={"target": {"rebound_heights": [0.3]}, "air": False})
    found = calibrate_case(read_calibration(table))
    assert found.overlays == ()
    assert "record" not in draw_calibration(found)


def test_a_law_without_a_force_has_none_to_draw(response: vi.Response, tmp_path: Path) -> None:
    time = np.arange(0.0, float(response.end_time[0]), 2e-5)
    (tmp_path / "f.csv").write_text(
        "time_s,force_N\n" + "\n".join(f"{at:.9g},{value:.9g}" for at, value in zip(time, response.at(time)["force_N"], strict=True))
    )
    table = plain_case(contact={"law": "newton", "restitution": 0.5}, calibrate={"target": str(tmp_path / "f.csv"), "air": False})
    assert calibrate_case(read_calibration(table)).overlays == ()
