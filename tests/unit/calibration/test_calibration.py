"""What a calibration matches, and what it says of it, where nothing is noisy."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import ToCalibrate
from vibroimpact.calibration.contact_law.adams_dialog import DIALOG_TITLE
from vibroimpact.calibration.contact_law.differences import differences
from vibroimpact.charts.marks import Band, Line, Points
from vibroimpact.exporting.load_drop import load_drop
from vibroimpact.report.report import Report, Table

ADAMS = {"law": "adams-impact"}
PAPER = {"drop": {"height": 4.0, "gravity": 9.8}, "contact": ADAMS}


def dialogs(report: Report) -> list[Table]:
    """Return the tables for the dialog of a contact in Adams View."""
    blocks = [block for section in report.sections for block in section.blocks]
    return [block for block in blocks if isinstance(block, Table) and block.title == DIALOG_TITLE]


def to_calibrate(section: dict, **changes: object) -> ToCalibrate:
    return vi.calibration.calibration_of(
        {**plain_case(**{"run": {"impacts": 5}, **PAPER, **changes}), "calibrate": section}
    )


def calibrated(section: dict, **changes: object) -> tuple[vi.calibration.Calibration, vi.Response]:
    what = to_calibrate(section, **changes)
    found = vi.calibration.calibrate_case(what)
    return found, vi.simulate(found.calibrated_case)


@pytest.mark.parametrize(
    ("changes", "number"),
    [
        ({"run": {"duration": 1.2}}, 1),
        pytest.param({"run": {"impacts": "all"}}, 6, marks=pytest.mark.slow),
        ({"drop": {"speed": 3.0, "gravity": 0.0}}, 1),
        pytest.param({"drop": {"speed": 3.0, "gravity": 9.8}}, 5, marks=pytest.mark.slow),
    ],
)
def test_the_impacts_of_the_drop_are_matched_as_far_as_it_goes(changes: dict, number: int) -> None:
    found, response = calibrated({"target": {"restitution": 0.3}}, **changes)
    assert len(found.values) == len(found.impacts[0]) == number
    assert response.impacts["restitution_achieved"][:number] == pytest.approx(0.3, rel=1e-8)


def test_no_loss_needs_no_damping() -> None:
    found, _ = calibrated({"target": {"restitution": 1.0}})
    assert found.values == pytest.approx(0.0, abs=1e-6)


def test_one_restitution_an_impact() -> None:
    wanted = [0.7, 0.6, 0.5]
    found, response = calibrated(
        {"target": {"law": "newton", "restitution": wanted}}, run={"impacts": 3}
    )
    assert response.impacts["restitution_achieved"] == pytest.approx(wanted, rel=1e-8)
    assert found.curve is None, "there is no one restitution at another speed"
    with pytest.raises(vi.InputError, match="has one value per impact"):
        calibrated(
            {"target": {"law": "newton", "restitution": wanted}, "speeds": {"from": 1, "to": 5}}
        )


def test_as_many_speeds_as_impacts_are_speeds_all_the_same() -> None:
    speeds = {"from": 1.0, "to": 9.0, "number": 5}
    found, _ = calibrated(
        {"target": {"law": "lankarani-nikravesh", "restitution": 0.65}, "speeds": speeds}
    )
    assert found.fit.function.slowest == 1.0
    assert found.fit.function.fastest == 9.0


def test_of_two_dampings_with_the_same_force_the_smaller_counts() -> None:
    """With damping the largest force falls at first, and rises when the dashpot alone makes it."""
    found, response = calibrated({"target": {"max_force": 8000.0}})
    assert found.values[0] == pytest.approx(540.0, rel=1e-3)
    assert response.impacts["max_force_N"][0] == pytest.approx(8000.0, rel=1e-9)
    stronger = {"law": "adams-impact", "damping_max": 1e3}
    assert (
        vi.simulate(vi.case_of(plain_case(**{**PAPER, "contact": stronger}))).impacts[
            "max_force_N"
        ][0]
        > 8000.0
    )


def test_several_outcomes_are_met_as_nearly_as_one_number_can() -> None:
    section = {
        "target": {"law": "lankarani-nikravesh", "restitution": 0.65},
        "match": {"separation_speed": 1, "max_force": 0.5},
    }
    found, _ = calibrated(section, run={"impacts": 1})

    def cost(value: float) -> float:
        contact = {"law": "adams-impact", "damping_max": value}
        impact = vi.simulate(
            vi.case_of(plain_case(**{**PAPER, "contact": contact, "run": {"impacts": 1}}))
        ).impacts
        wanted = found.observations.wanted
        rebound = (
            impact["separation_speed_m_s"][0] - wanted["separation_speed"][0]
        ) / found.observations.speeds[0]
        return float(
            rebound**2 + 0.5 * (impact["max_force_N"][0] / wanted["max_force"][0] - 1.0) ** 2
        )

    best = float(found.values[0])
    assert cost(best) < min(cost(0.999 * best), cost(1.001 * best))


def test_a_rebound_height_is_met_by_a_law_that_lets_go_early() -> None:
    """At zero force, before the overlap is gone: the height is what was measured, not the
    speed at release.
    """
    _, response = calibrated(
        {"target": {"rebound_heights": [2.4, 1.4]}},
        contact={"law": "kuwabara-kono", "dissipation_time": 1e-5},
    )
    assert response.impacts["rebound_height_m"][:2] == pytest.approx([2.4, 1.4], rel=1e-9)


def test_one_measured_impact_at_another_speed_is_not_the_first_of_the_drop() -> None:
    found, _ = calibrated({"target": {"restitution": [0.7], "approach_speed": [2.0]}, "degree": 0})
    assert not found.observations.of_the_drop
    assert found.impacts[0][0] == pytest.approx(8.826664149, rel=1e-9)


def test_beyond_the_speeds_that_were_measured_is_told() -> None:
    found, _ = calibrated(
        {
            "target": {"restitution": [0.8, 0.79, 0.78], "approach_speed": [1.0, 1.5, 2.0]},
            "degree": 1,
        }
    )
    assert any("there it is an extrapolation" in doubt for doubt in found.doubts)


@pytest.mark.slow
def test_a_jump_is_not_taken_for_a_solution() -> None:
    """A sphere that yields easily enough stays down; in between there is nothing."""
    case = {
        "sphere": {"radius": 0.02463, "material": "steel-paper"},
        "plate": {"material": "rock-paper"},
        "drop": {"height": 1.956, "gravity": 3.71, "same_spot": False},
        "contact": {"law": "storakers", "yield_strength": 1e8},
        "run": {"impacts": 4},
    }
    with pytest.raises(vi.InputError, match="jumps over this one"):
        vi.calibration.calibrate_case(
            vi.calibration.calibration_of(
                {**case, "calibrate": {"target": {"restitution": 0.2346}}}
            )
        )


def test_a_refusal_is_quick_and_says_what_would_do() -> None:
    words = (
        r"gives 7859.* with damping_max = 150 N s/m and the rest as given it would take "
        r"stiffness = 4\.06"
    )
    with pytest.raises(vi.InputError, match=words) as refused:
        calibrated({"target": {"max_force": 3000.0}})
    assert "or exponent" in str(refused.value)


def test_a_run_takes_no_notice(tmp_path: Path) -> None:
    """A case with the section runs, is saved with it, and reads back."""
    case = vi.load_case("paper:calibration")
    vi.simulate(case).save(tmp_path / "run")
    again = vi.load_case(tmp_path / "run" / "case.toml")
    assert again.calibrate == case.calibrate


def test_the_folder(damping: vi.calibration.Calibration, tmp_path: Path) -> None:
    folder = damping.save(tmp_path / "calibrated", figures=("png",))
    table = json.loads((folder / "calibration.json").read_text())
    assert table["parameter"] == "damping_max"
    assert [row["impact"] for row in table["impacts"]] == [1, 2, 3, 4, 5]
    assert [row["value"] for row in table["impacts"]] == damping.values.tolist()
    assert table["fit"]["coefficients"] == list(damping.fit.function.coefficients)
    assert vi.load_case(folder / "case.toml").contact.parameters["damping_max"] == tuple(
        damping.values
    )
    assert {file.name for file in (folder / "figures").iterdir()} == {
        "parameter.png",
        "differences.png",
    }
    assert "139.408" in (folder / "report.html").read_text()
    drop = load_drop(folder)
    assert drop.function is not None
    assert drop.function[1](5.0) == pytest.approx(damping.fit.function(5.0), rel=1e-15)
    with pytest.raises(vi.InputError, match="this is a calibration"):
        vi.load_result(folder)
    with pytest.raises(vi.InputError, match="is there already"):
        damping.save(folder)


def test_the_charts_hold_the_values(damping: vi.calibration.Calibration) -> None:
    """Each impact with its interval, the fit, and the remaining differences in per cent;
    the parameter in words.
    """
    found, _ = calibrated(
        {
            "target": {
                "restitution": [0.8, 0.78, 0.77, 0.75],
                "approach_speed": [1.0, 2.0, 3.0, 4.0],
            },
            "degree": 1,
        }
    )
    (chart,) = found.charts.values()
    (panel,) = chart.panels
    assert panel.y.label == "Largest damping C"
    assert "damping_max" in chart.caption
    band, fit, points, *_ = panel.marks
    assert isinstance(band, Band)
    assert isinstance(fit, Line)
    assert isinstance(points, Points)
    np.testing.assert_array_equal(fit.y, found.fit.function(fit.x))
    np.testing.assert_allclose(0.5 * (band.low + band.high), fit.y, rtol=1e-9)
    np.testing.assert_array_equal(points.y, found.values)
    assert found.intervals is not None
    np.testing.assert_array_equal(np.transpose([points.low, points.high]), found.intervals)
    last = list(damping.charts.values())[-1]
    assert [panel.title for panel in last.panels] == [
        "Largest indentation",
        "Largest force",
        "Contact duration",
        "Rebound height",
    ]
    for panel, column in zip(
        last.panels,
        ("max_indentation_m", "max_force_N", "duration_s", "rebound_height_m"),
        strict=True,
    ):
        drawn = {mark.name: mark.y for mark in panel.marks if isinstance(mark, Line)}
        for way, values in differences(damping)[column].items():
            np.testing.assert_array_equal(drawn[way], 100.0 * values)


@pytest.mark.slow
def test_the_damping_of_modes_is_found_again_and_is_no_function_of_the_law(tmp_path: Path) -> None:
    """From the rebound that it gives; and an export of it does not hold it."""
    sphere = {
        "radius": 0.025,
        "material": "rock-paper",
        "model": "elastic",
        "modes": 20,
        "damping": 0.3,
    }
    run = vi.simulate(
        vi.case_of(plain_case(**{**PAPER, "sphere": sphere, "contact": {"law": "hertz"}}))
    ).impacts
    section = {
        "target": {"separation_speed": float(run["separation_speed_m_s"][0])},
        "parameter": "sphere.damping",
        "degree": 0,
    }
    what = to_calibrate(
        section, sphere={**sphere, "damping": 0.02}, contact={"law": "hertz"}, run={"impacts": 1}
    )
    found = vi.calibration.calibrate_case(what)
    assert found.values[0] == pytest.approx(0.3, rel=1e-5)
    folder = found.save(tmp_path / "calibrated")
    assert vi.load_case(folder / "case.toml").sphere.damping.ratio == pytest.approx(0.3, rel=1e-5)
    assert load_drop(folder).function is None


@pytest.mark.slow
def test_what_has_no_influence_is_told() -> None:
    """The first modes of a sphere only twist it."""
    sphere = {
        "radius": 0.025,
        "material": "rock-paper",
        "model": "elastic",
        "modes": 5,
        "damping": 0.3,
    }
    section = {"target": {"separation_speed": 8.0}, "parameter": "sphere.damping"}
    with pytest.raises(vi.InputError, match=r"whatever sphere\.damping is|has no influence"):
        vi.calibration.calibrate_case(
            to_calibrate(section, sphere=sphere, contact={"law": "hertz"}, run={"impacts": 1})
        )


def test_the_curve_is_exact(theory: vi.Response) -> None:
    found = vi.calibration.calibrate(
        vi.load_case("paper:type1-constant"), vi.load_case("paper:type1-theory")
    )
    assert found.curve is not None
    speeds, values = found.curve
    speed, value = speeds[20], values[20]
    contact = {"law": "adams-impact", "damping_max": float(value)}
    one = {"drop": {"speed": float(speed), "gravity": 9.8}, "run": {"impacts": 1}}
    adams = vi.simulate(vi.case_of(plain_case(**{**one, "contact": contact}))).impacts[
        "separation_speed_m_s"
    ]
    law = {"law": "lankarani-nikravesh", "restitution": 0.65}
    wanted = vi.simulate(vi.case_of(plain_case(**{**one, "contact": law}))).impacts[
        "separation_speed_m_s"
    ]
    assert adams == pytest.approx(wanted, rel=1e-9)
    assert np.all(np.diff(speeds) > 0.0)


def test_the_dialog_of_adams_has_its_units(damping: vi.calibration.Calibration) -> None:
    """Stiffness, exponent, damping and penetration in newtons, millimetres and seconds,
    as the exported force has them.
    """
    case = vi.load_case("paper:calibration")
    stiffness = float(case.to_problem().laws[0].stiffness)
    (dialog,) = dialogs(damping.report)
    rows = list(zip(*(column.cells for column in dialog.columns), strict=True))
    assert [(column.heading, column.unit) for column in dialog.columns[1:]] == [
        ("Stiffness", "N/mm^n"),
        ("Force Exponent", ""),
        ("Damping", "N s/mm"),
        ("Penetration Depth", "mm"),
    ]
    for row, value in zip(rows, damping.values, strict=True):
        shown = [float(cell) for cell in row[1:]]
        assert shown == pytest.approx(
            [vi.units.convert_units(stiffness, "N/m^1.5", "N/mm^1.5"), 1.5, value / 1000.0, 0.1],
            rel=1e-5,
        )


def test_the_dialog_is_that_of_adams_alone() -> None:
    what = to_calibrate(
        {"target": {"restitution": 0.7}}, contact={"law": "tsuji"}, run={"impacts": 2}
    )
    assert dialogs(vi.calibration.calibrate_case(what).report) == []
