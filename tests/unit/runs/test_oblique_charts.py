"""Charts of oblique drops: the path over the plate, curves over the angle of incidence,
and the dimensionless map.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.charts.chart import Chart
from vibroimpact.charts.marks import Arrow, Label, Line, Outline, Points
from vibroimpact.runs.charts import chart_makers

CASE: dict[str, Any] = {
    "sphere": {
        "radius": "10 mm",
        "material": {"density": 2500, "youngs_modulus": "60 GPa", "poissons_ratio": 0.2},
    },
    "plate": {
        "size": ["600 mm", "400 mm", "20 mm"],
        "material": {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3},
    },
    "drop": {"height": "200 mm", "velocity": [0.3, 0.35, 0.0], "position": ["-200 mm", "-150 mm"]},
    "contact": {
        "law": "hunt-crossley",
        "restitution": 0.6,
        "friction": {"law": "mdr", "coefficient": 0.2},
    },
    "run": {"impacts": 3},
}


def result(**changes: Any) -> Any:
    return vi.result_of(vi.simulate(vi.case_of({**CASE, **changes})))


def test_the_path_over_the_plate() -> None:
    """To scale: the outline of the plate, where the sphere was, its impacts in their
    places, and the sphere where it is at the end.
    """
    found = result()
    (panel,) = chart_makers(found)["path"]().panels
    assert panel.picture
    plate, ball = (mark for mark in panel.marks if isinstance(mark, Outline))
    assert sorted(set(plate.x.tolist())) == [-0.3, 0.3]
    assert sorted(set(plate.y.tolist())) == [-0.2, 0.2]
    (path,) = (mark for mark in panel.marks if isinstance(mark, Line))
    assert (path.x[0], path.y[0]) == (-0.2, -0.15)
    (points,) = (mark for mark in panel.marks if isinstance(mark, Points))
    np.testing.assert_array_equal(
        [points.x, points.y], [found.impacts[f"position_{axis}_m"] for axis in "xy"]
    )
    numbers = [mark for mark in panel.marks if isinstance(mark, Label) and mark.anchor == "above"]
    assert [mark.words for mark in numbers] == ["1", "2", "3"]
    assert [mark.x for mark in numbers] == points.x.tolist()
    assert 0.5 * (ball.x.max() + ball.x.min()) == pytest.approx(path.x[-1], abs=1e-4)
    assert np.ptp(ball.x) == pytest.approx(0.02)
    assert [
        mark.words.replace("\u00a0", " ")
        for mark in panel.marks
        if isinstance(mark, Label) and mark.anchor in ("below", "left")
    ] == [
        "600 mm",
        "400 mm",
    ]


def test_a_path_over_a_plate_without_size() -> None:
    found = result(
        plate={"material": CASE["plate"]["material"]},
        drop={"height": "200 mm", "velocity": [0.5, 0.0, 0.0]},
    )
    chart = chart_makers(found)["path"]()
    (arrow,) = (mark for mark in chart.panels[0].marks if isinstance(mark, Arrow))
    x = found.history["position_x_m"]
    assert (arrow.start[0], arrow.end[0]) == (x.min(), x.max())
    assert "Seen from above, to scale" in chart.caption


def test_many_impacts_in_one_place_are_not_all_numbered() -> None:
    found = result(drop={"height": "200 mm", "velocity": [0.05, 0.0, 0.0]}, run={"impacts": 20})
    (panel,) = chart_makers(found)["path"]().panels
    labels = [
        mark.words for mark in panel.marks if isinstance(mark, Label) and mark.anchor == "above"
    ]
    assert labels[0] == "1"
    assert len(labels) < 8


def test_no_path_without_motion_along_the_plate() -> None:
    assert "path" not in chart_makers(result(drop={"height": "200 mm"}))
    assert "path" not in chart_makers(
        result(drop={"height": "200 mm"}, contact={"law": "hunt-crossley", "restitution": 0.6})
    )


# --- studies
#
#
#
# ----------------------------------------------------------------------------------------------------------------------------

ANGLES = [5.0, 20.0, 40.0, 60.0]


def charts_of(
    folder: Path, over: dict[str, Any], keep: tuple[str, ...] = (), **changes: Any
) -> dict[str, Chart]:
    table = {
        **CASE,
        "drop": {"speed": 2.0, "angle": 0.1, "gravity": 0.0},
        "run": {"impacts": 1},
        **changes,
    }
    study = vi.studies.load_study(
        vi.studies.run_sweep(
            vi.studies.sweep_of({**table, "sweep": {"over": over, "keep": ["peaks", *keep]}}),
            folder / "study",
        )
    )
    return study.charts


def test_a_study_over_the_angle_draws_what_the_plate_leaves_of_the_motion_along_it(
    tmp_path: Path,
) -> None:
    """With a line for each friction law, over the angle in degrees, as single runs have it."""
    angles = [f"{angle:g} deg" for angle in ANGLES]
    charts = charts_of(tmp_path, {"drop.angle": angles, "contact.friction.law": ["mdr", "coulomb"]})
    assert "slip_map" not in charts, "impacts were not kept"
    for title, column in (
        ("Tangential restitution, first impact", "tangential_restitution"),
        ("Rebound angle, first impact", "rebound_angle_deg"),
    ):
        (panel,) = (panel for panel in charts["curves"].panels if panel.title == title)
        assert (panel.x.label, panel.x.unit) == ("Angle of incidence from the normal", "deg")
        for line, law in zip(panel.marks, ("mdr", "coulomb"), strict=True):
            assert isinstance(line, Line)
            assert line.name == law
            assert line.x.tolist() == ANGLES
            contact = {**CASE["contact"], "friction": {"law": law, "coefficient": 0.2}}
            drops = (
                {"speed": 2.0, "angle": float(np.radians(angle)), "gravity": 0.0}
                for angle in ANGLES
            )
            alone = [
                result(drop=drop, contact=contact, run={"impacts": 1}).impacts[column][0]
                for drop in drops
            ]
            # the steps of both are within 1e-4
            np.testing.assert_allclose(line.y, alone, rtol=1e-5)


def test_a_study_of_vertical_drops_has_no_such_results(tmp_path: Path) -> None:
    contact = {"law": "hunt-crossley", "restitution": 0.6}
    charts = charts_of(
        tmp_path, {"drop.speed": [1.0, 2.0]}, ("impacts",), drop={"speed": 1.0}, contact=contact
    )
    assert not any("angle" in panel.title.lower() for panel in charts["curves"].panels)
    assert "slip_map" not in charts


PSI = np.array([0.25, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0])
REVERSED = np.array([-0.1665, -0.0957, 0.0597, 0.2853, 0.4186, 0.4649, 0.4599, 0.3591, 0.1529])
"""Slips before, and what of them is reversed, of Mindlin's contact without normal loss
for Poisson's ratio 0.3, by an own integration.
"""

ELASTIC = {
    "sphere": {
        "radius": "10 mm",
        "material": {"density": 2500, "youngs_modulus": "60 GPa", "poissons_ratio": 0.3},
    },
    "plate": {"material": "rigid"},
    "contact": {"law": "hertz", "friction": {"law": "mdr", "coefficient": 0.3}},
}


def test_the_dimensionless_map_of_a_study(tmp_path: Path) -> None:
    """Whatever the coefficient is; the line of sliding throughout is Maw, Barber and Fawcett's."""
    factor = 2.0 * 0.7 / 1.7
    drop = {"velocity": [0.0, 0.0, -2.0], "gravity": 0.0}
    for friction in (0.3, 0.1):
        contact = {**ELASTIC["contact"], "friction": {"law": "mdr", "coefficient": friction}}
        along = (PSI * friction * 2.0 / factor).tolist()
        folder = tmp_path / f"{friction}"
        folder.mkdir()
        case = {**ELASTIC, "drop": drop, "contact": contact}
        (panel,) = charts_of(folder, {"drop.velocity.x": along}, ("impacts",), **case)[
            "slip_map"
        ].panels
        (points,) = (mark for mark in panel.marks if isinstance(mark, Points))
        np.testing.assert_allclose(points.x, PSI, rtol=1e-9)
        np.testing.assert_allclose(points.y / points.x, -REVERSED, atol=1e-3)
        (line,) = (mark for mark in panel.marks if isinstance(mark, Line))
        np.testing.assert_allclose(line.y, line.x - 7.0 * factor, rtol=1e-6)


@pytest.mark.slow
def test_the_dimensionless_map_of_a_calibration(tmp_path: Path) -> None:
    """By measured velocities, angles or spins the same points, which lie on the curve of
    the law that made them.
    """
    drops = [{"speed": 2.0, "angle": float(np.radians(angle)), "gravity": 0.0} for angle in ANGLES]
    made = [result(**{**ELASTIC, "drop": drop, "run": {"impacts": 1}}).impacts for drop in drops]
    drawn = []
    for column in (
        "tangential_restitution",
        "separation_velocity_x_m_s",
        "rebound_angle_deg",
        "spin_y_after_rad_s",
    ):
        file = tmp_path / f"{column}.csv"
        rows = [
            f"{angle},2,{impacts[column][0]:.15g}"
            for angle, impacts in zip(ANGLES, made, strict=True)
        ]
        file.write_text("\n".join([f"angle [deg],speed [m/s],{column}", *rows]), encoding="utf-8")
        section = {"target": str(file), "parameter": "friction.coefficient"}
        found = vi.calibration.calibrate_case(
            vi.calibration.calibration_of(
                {**ELASTIC, "drop": drops[0], "run": {"impacts": 1}, "calibrate": section}
            )
        )
        (panel,) = found.charts["slip_map"].panels
        (points,) = (mark for mark in panel.marks if isinstance(mark, Points))
        curve = next(
            mark for mark in panel.marks if isinstance(mark, Line) and mark.name == "computed"
        )
        np.testing.assert_allclose(np.interp(points.x, curve.x, curve.y), points.y, atol=0.02)
        drawn.append((points.x, points.y))
    for one in drawn[1:]:
        np.testing.assert_allclose(one, drawn[0], rtol=1e-4)
