"""Charts of oblique drops: the path over the plate, curves over the angle of incidence, and the dimensionless map."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.charts.marks import Arrow, Label, Line, Outline, Points
from vibroimpact.runs.charts import chart_makers

CASE: dict[str, Any] = {
    "sphere": {"radius": "10 mm", "material": {"density": 2500, "youngs_modulus": "60 GPa", "poissons_ratio": 0.2}},
    "plate": {"size": ["600 mm", "400 mm", "20 mm"], "material": {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3}},
    "drop": {"height": "200 mm", "velocity": [0.3, 0.35, 0.0], "position": ["-200 mm", "-150 mm"]},
    "contact": {"law": "hunt-crossley", "restitution": 0.6, "friction": {"law": "mdr", "coefficient": 0.2}},
    "run": {"impacts": 3},
}


def result(**changes: Any) -> Any:
    return vi.result_of(vi.simulate(vi.read_case({**CASE, **changes})))


def test_the_path_over_the_plate() -> None:
    """To scale: the outline of the plate, where the sphere was, its impacts in their places, and the sphere where it is at the end."""
    found = result()
    (panel,) = chart_makers(found)["path"]().panels
    assert panel.picture
    plate, ball = (mark for mark in panel.marks if isinstance(mark, Outline))
    assert sorted(set(plate.x.tolist())) == [-0.3, 0.3]
    assert sorted(set(plate.y.tolist())) == [-0.2, 0.2]
    (path,) = (mark for mark in panel.marks if isinstance(mark, Line))
    assert (path.x[0], path.y[0]) == (-0.2, -0.15)
    (points,) = (mark for mark in panel.marks if isinstance(mark, Points))
    np.testing.assert_array_equal([points.x, points.y], [found.impacts[f"position_{axis}_m"] for axis in "xy"])
    numbers = [mark for mark in panel.marks if isinstance(mark, Label) and mark.anchor == "above"]
    assert [mark.words for mark in numbers] == ["1", "2", "3"]
    assert [mark.x for mark in numbers] == points.x.tolist()
    assert 0.5 * (ball.x.max() + ball.x.min()) == pytest.approx(path.x[-1], abs=1e-4)
    assert np.ptp(ball.x) == pytest.approx(0.02)
    assert [mark.words.replace("\u00a0", " ") for mark in panel.marks if isinstance(mark, Label) and mark.anchor in ("below", "left")] == [
        "600 mm",
        "400 mm",
    ]


def test_a_path_over_a_plate_without_size() -> None:
    found = result(plate={"material": CASE["plate"]["material"]}, drop={"height": "200 mm", "velocity": [0.5, 0.0, 0.0]})
    chart = chart_makers(found)["path"]()
    (arrow,) = (mark for mark in chart.panels[0].marks if isinstance(mark, Arrow))
    x = found.history["position_x_m"]
    assert (arrow.start[0], arrow.end[0]) == (x.min(), x.max())
    assert "Seen from above, to scale" in chart.caption


def test_many_impacts_in_one_place_are_not_all_numbered() -> None:
    found = result(drop={"height": "200 mm", "velocity": [0.05, 0.0, 0.0]}, run={"impacts": 20})
    (panel,) = chart_makers(found)["path"]().panels
    labels = [mark.words for mark in panel.marks if isinstance(mark, Label) and mark.anchor == "above"]
    assert labels[0] == "1"
    assert len(labels) < 8


def test_no_path_without_motion_along_the_plate() -> None:
    assert "path" not in chart_makers(result(drop={"height": "200 mm"}))
    assert "path" not in chart_makers(result(drop={"height": "200 mm"}, contact={"law": "hunt-crossley", "restitution": 0.6}))
