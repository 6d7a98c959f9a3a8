"""Friction calibrated to measured oblique impacts: closed forms, data made with known
parameters, and what can't be determined.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import binom, norm
from scipy.stats import t as students_t

import vibroimpact as vi
from support import one_in
from vibroimpact.calibration.friction.friction_report import friction_sentences
from vibroimpact.calibration.friction.parameters import ImpactModel
from vibroimpact.charts.marks import Line, Points
from vibroimpact.errors import ComputationError
from vibroimpact.exporting.load_drop import load_drop

RADIUS, SPEED, RESTITUTION = 0.01, 3.0, 0.8
STEEP = np.array([55.0, 60.0, 65.0, 70.0, 75.0])
FLAT = np.array([2.0, 5.0, 8.0, 10.0])
ALL = np.concatenate([FLAT, [15.0, 20.0, 25.0, 30.0, 40.0, 50.0], STEEP[1::2]])


def case(friction: dict[str, Any], **changes: Any) -> dict[str, Any]:
    contact = changes.pop("contact", {"law": "newton", "restitution": RESTITUTION})
    return {
        "sphere": {
            "radius": RADIUS,
            "material": {"density": 2500, "youngs_modulus": "60 GPa", "poissons_ratio": 0.2},
        },
        "plate": {
            "material": {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
        },
        "drop": {"speed": SPEED, "angle": 0.5, "gravity": 0.0},
        "contact": {**contact, "friction": friction},
        "run": {"impacts": 1},
        **changes,
    }


def impacts(friction: dict[str, Any], angles: np.ndarray, **changes: Any) -> dict[str, np.ndarray]:
    """Simulated impacts at angles [deg], one a run of a sweep by hand."""
    drops = [
        {"speed": SPEED, "angle": float(np.radians(angle)), "gravity": 0.0} for angle in angles
    ]
    tables = [
        vi.simulate(vi.case_of(case(friction, **{**changes, "drop": drop}))) for drop in drops
    ]
    return {
        name: np.array([table.impacts[name][0] for table in tables]) for name in tables[0].impacts
    }


def table(folder: Path, angles: np.ndarray, **columns: Any) -> str:
    """A file of impacts at angles [deg], with columns of what else was measured."""
    rows = {"angle [deg]": angles, "speed [m/s]": np.full(len(angles), SPEED), **columns}
    text = ",".join(rows) + "\n"
    for values in zip(
        *(np.broadcast_to(column, angles.shape) for column in rows.values()), strict=True
    ):
        text += ",".join(f"{value:.12g}" for value in values) + "\n"
    file = folder / "measured.csv"
    file.write_text(text, encoding="utf-8")
    return str(file)


def calibrated(
    file: str, friction: dict[str, Any], parameter: Any = "friction.coefficient", **more: Any
) -> vi.calibration.FrictionCalibration:
    changes = {key: more.pop(key) for key in ("contact", "drop", "plate") if key in more}
    found = vi.calibration.calibrate_case(
        vi.calibration.calibration_of(
            {
                **case(friction, **changes),
                "calibrate": {"target": file, "parameter": parameter, **more},
            }
        )
    )
    assert isinstance(found, vi.calibration.FrictionCalibration)
    return found


def test_sliding_in_closed_form(tmp_path: Path) -> None:
    """1 - e_t = mu (1 + e) cot(theta) of impacts that slip throughout is linear in mu:
    value and interval of a line through zero.
    """
    noise = np.array([0.004, -0.006, 0.003, 0.005, -0.002])
    x = (1.0 + RESTITUTION) / np.tan(np.radians(STEEP))
    measured = 1.0 - 0.2 * x + noise
    slope = x @ (1.0 - measured) / (x @ x)
    scatter = np.sqrt(((1.0 - measured - slope * x) ** 2).sum() / 4.0)
    file = table(tmp_path, STEEP, tangential_restitution=measured)
    found = calibrated(file, {"law": "coulomb"})
    assert found.values == pytest.approx([slope], rel=1e-6)
    assert found.scatter == pytest.approx(scatter / np.abs(measured).max(), rel=1e-6)
    half = students_t.ppf(0.975, 4) * scatter / np.sqrt(x @ x)
    assert found.intervals == pytest.approx(np.array([[slope - half, slope + half]]), rel=2e-3)
    assert np.isnan(found.given).all(), "the case gives none"
    assert found.slips.all()
    assert not found.doubts
    known = table(
        tmp_path,
        STEEP,
        tangential_restitution=measured,
        tangential_restitution_standard_deviation=0.005,
    )
    half = norm.ppf(0.975) * 0.005 / np.sqrt(x @ x)
    assert calibrated(known, {"law": "coulomb"}).intervals == pytest.approx(
        np.array([[slope - half, slope + half]]), rel=2e-3
    )


def test_sticking_in_closed_form(tmp_path: Path) -> None:
    """Walton's impulse leaves 5/7 - 2/7 beta of the velocity; and the coefficient is
    bounded from below by the steepest that sticks.
    """
    beta, measured = 0.4, np.array([0.601, 0.596, 0.605, 0.598])
    file = table(
        tmp_path,
        FLAT,
        tangential_restitution=measured,
        tangential_restitution_standard_deviation=0.005,
    )
    found = calibrated(
        file,
        {"law": "rigid", "coefficient": 0.5},
        ["friction.slip_restitution", "friction.coefficient"],
    )
    assert found.values[0] == pytest.approx((5.0 - 7.0 * measured.mean()) / 2.0, abs=1e-6)
    half = norm.ppf(0.975) * 3.5 * 0.005 / 2.0
    assert found.intervals[0] == pytest.approx(
        [found.values[0] - half, found.values[0] + half], abs=2e-4
    )
    assert found.intervals[0, 0] < beta < found.intervals[0, 1]
    assert found.intervals[1, 1] == np.inf
    assert found.intervals[1, 0] == pytest.approx(
        0.4 / 1.8 * np.tan(np.radians(FLAT[-1])), rel=0.15
    )
    (doubt,) = found.doubts
    assert "only a lower bound of friction.coefficient, 0.03" in doubt
    assert "(they stick with more friction)" in doubt
    assert "at larger angles" in doubt
    assert not found.slips.any()


def test_what_has_no_influence_stays_as_given(tmp_path: Path) -> None:
    """Impacts that slip throughout do not know the restitution of the slip."""
    measured = 1.0 - 0.1 * (1.0 + RESTITUTION) / np.tan(np.radians(STEEP))
    file = table(
        tmp_path,
        STEEP,
        tangential_restitution=measured,
        tangential_restitution_standard_deviation=0.01,
    )
    found = calibrated(
        file,
        {"law": "rigid", "slip_restitution": 0.3},
        ["friction.coefficient", "friction.slip_restitution"],
    )
    assert found.values == pytest.approx([0.1, 0.3], rel=1e-6)
    assert found.intervals[1, 1] == 1.0
    assert any(
        "friction.slip_restitution" in doubt and "at smaller angles" in doubt
        for doubt in found.doubts
    ), found.doubts


def test_an_impact_that_could_not_be_computed_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One is enough that none of the values has a sum of squares."""
    computed = ImpactModel.__call__

    def without_the_second(model: ImpactModel, values: np.ndarray) -> dict[str, np.ndarray]:
        return {
            name: np.where(np.arange(column.shape[1]) == 1, np.nan, column)
            for name, column in computed(model, values).items()
        }

    monkeypatch.setattr(ImpactModel, "__call__", without_the_second)
    file = table(tmp_path, STEEP[:3], tangential_restitution=0.9)
    with pytest.raises(
        ComputationError,
        match="1 of these 3 impacts could not be computed, the first line 3; look at",
    ):
        calibrated(file, {"law": "coulomb"})


def test_impacts_that_slip_need_no_larger_angles(tmp_path: Path) -> None:
    """They leave the coefficient open because they contradict each other."""
    measured = 1.0 - np.array([0.05, 0.3]) * (1.0 + RESTITUTION) / np.tan(np.radians(STEEP[-2:]))
    file = table(
        tmp_path,
        STEEP[-2:],
        tangential_restitution=measured,
        tangential_restitution_standard_deviation=0.001,
    )
    found = calibrated(file, {"law": "coulomb"})
    assert found.slips.all()
    assert not any("at larger angles" in doubt for doubt in found.doubts), found.doubts
    assert any("is left at its first value, 0.3" in doubt for doubt in found.doubts), found.doubts
    assert any(
        "the given standard deviations and the scatter beyond them" in sentence
        for sentence in friction_sentences(found)
    )


@pytest.mark.parametrize("law", ["mdr", "mindlin", "coulomb", "rigid"])
@pytest.mark.parametrize(
    "column",
    one_in(
        4,
        [
            "tangential_restitution",
            "rebound_angle_deg",
            "spin_y_after_rad_s",
            "separation_velocity_x_m_s",
        ],
    ),
)
def test_what_was_simulated_is_found_again(law: str, column: str, tmp_path: Path) -> None:
    contact = {"law": "hunt-crossley", "restitution": 0.7}
    friction = {"law": law, "coefficient": 0.15}
    made = impacts(friction, ALL[2:], contact=contact)
    file = table(tmp_path, ALL[2:], **{column: made[column]})
    found = calibrated(
        file,
        {**friction, "coefficient": 0.3},
        contact=contact,
        drop={"speed": 1.0, "angle": 0.1, "gravity": 0.0},
    )
    assert found.values == pytest.approx([0.15], rel=1e-4)
    assert found.given == pytest.approx([0.3])


@pytest.mark.slow
def test_shear_modulus_and_coefficient_together(tmp_path: Path) -> None:
    contact = {"law": "hunt-crossley", "restitution": 0.7}
    friction = {"law": "mdr", "coefficient": 0.15, "effective_shear_modulus": "30 GPa"}
    made = impacts(friction, ALL, contact=contact)
    file = table(tmp_path, ALL, tangential_restitution=made["tangential_restitution"])
    names = ["friction.coefficient", "friction.effective_shear_modulus"]
    found = calibrated(file, {"law": "mdr"}, names, contact=contact)
    assert found.values == pytest.approx([0.15, 30e9], rel=1e-3)


def test_the_measured_normal_rebound_is_met_by_the_contact_law(tmp_path: Path) -> None:
    """Its restitution differs from impact to impact, and the impulse of friction with it."""
    restitution = np.linspace(0.6, 0.9, len(STEEP))
    measured = 1.0 - 0.2 * (1.0 + restitution) / np.tan(np.radians(STEEP))
    file = table(tmp_path, STEEP, tangential_restitution=measured, restitution=restitution)
    found = calibrated(
        file, {"law": "coulomb"}, contact={"law": "hunt-crossley", "restitution": 0.5}
    )
    assert found.values == pytest.approx([0.2], rel=1e-6)
    assert found.outcomes["separation_speed"] == pytest.approx(
        restitution * found.impacts.seen.speeds, rel=1e-8
    )


def test_spin_before_counts(tmp_path: Path) -> None:
    """A sphere with backspin that slips throughout: the spin changes by 5/2 of what the
    velocity does, over the radius.
    """
    normal = SPEED * np.cos(np.radians(STEEP))
    after = -200.0 + 2.5 * 0.2 * (1.0 + RESTITUTION) * normal / RADIUS
    file = table(tmp_path, STEEP, spin_y_before_rad_s=-200.0, spin_y_after_rad_s=after)
    assert calibrated(file, {"law": "coulomb"}).values == pytest.approx([0.2], rel=1e-6)


def inside(
    law: str,
    angles: np.ndarray,
    truth: dict[str, float],
    times: int,
    folder: Path,
    *,
    known: bool,
    **more: Any,
) -> np.ndarray:
    """Whether the intervals of repeated measurements hold the truth, (times, parameters)."""
    friction, size = {"law": law, **truth}, 0.01
    exact = impacts(friction, angles, **more)["tangential_restitution"]
    found = []
    for seed in range(times):
        noisy = exact + size * np.random.default_rng(seed).normal(size=len(angles))
        columns = {
            "tangential_restitution": noisy,
            **({"tangential_restitution_standard_deviation": size} if known else {}),
        }
        one = calibrated(
            table(folder, angles, **columns),
            friction,
            [f"friction.{name}" for name in truth],
            **more,
        )
        ends, values = one.intervals, np.array(list(truth.values()))
        assert ends is not None
        found.append((ends[:, 0] <= values) & (values <= ends[:, 1]))
    return np.array(found)


def check_coverage(found: np.ndarray, confidence: float = 0.95, level: float = 1e-3) -> None:
    low, high = binom.ppf([level / 2.0, 1.0 - level / 2.0], len(found), confidence)
    assert (found.sum(axis=0) >= low).all()
    assert (found.sum(axis=0) <= high).all() or high == len(found)


@pytest.mark.slow
@pytest.mark.parametrize("known", [True, False])
def test_intervals_hold_the_truth_as_often_as_is_stated(known: bool, tmp_path: Path) -> None:
    check_coverage(
        inside(
            "rigid", ALL, {"coefficient": 0.15, "slip_restitution": 0.2}, 60, tmp_path, known=known
        )
    )


@pytest.mark.slow
@pytest.mark.parametrize("known", [True, pytest.param(False, marks=pytest.mark.whole)])
def test_intervals_of_microslip_hold_the_truth_as_often_as_is_stated(
    known: bool, tmp_path: Path, population: Callable[[int], int]
) -> None:
    contact = {"law": "hunt-crossley", "restitution": 0.7}
    check_coverage(
        inside(
            "mdr",
            ALL,
            {"coefficient": 0.15},
            population(80),
            tmp_path,
            known=known,
            contact=contact,
        )
    )


@pytest.mark.parametrize("known", [True, False])
def test_a_bootstrap_agrees_with_the_profile(known: bool, tmp_path: Path) -> None:
    x = (1.0 + RESTITUTION) / np.tan(np.radians(STEEP))
    measured = 1.0 - 0.2 * x + np.array([0.004, -0.006, 0.003, 0.005, -0.002])
    deviations = {"tangential_restitution_standard_deviation": 0.005} if known else {}
    file = table(tmp_path, STEEP, tangential_restitution=measured, **deviations)
    profile, drawn = (calibrated(file, {"law": "coulomb"}, bootstrap=draws) for draws in (0, 2000))
    assert drawn.bootstrap == 2000
    assert np.diff(drawn.intervals) == pytest.approx(np.diff(profile.intervals), rel=0.1)


def test_residuals_larger_than_their_deviations_widen_the_intervals(tmp_path: Path) -> None:
    measured = (
        1.0
        - 0.2 * (1.0 + RESTITUTION) / np.tan(np.radians(STEEP))
        + np.array([0.04, -0.06, 0.03, 0.05, -0.02])
    )
    file = table(
        tmp_path,
        STEEP,
        tangential_restitution=measured,
        tangential_restitution_standard_deviation=0.005,
    )
    found = calibrated(file, {"law": "coulomb"})
    assert np.isfinite(found.freedom)
    assert any("times as large as their standard deviations" in doubt for doubt in found.doubts)


def test_one_impact_tells_a_value_and_no_interval(tmp_path: Path) -> None:
    file = table(tmp_path, np.array([50.0]), tangential_restitution=np.array([0.8]))
    found = calibrated(file, {"law": "coulomb"})
    assert found.intervals is None
    assert "their uncertainty is unknown" in found.doubts[0]


def test_folder_page_and_charts(tmp_path: Path) -> None:
    made = impacts({"law": "coulomb", "coefficient": 0.15}, ALL)
    columns = {
        name: made[name]
        for name in ("tangential_restitution", "rebound_angle_deg", "spin_y_after_rad_s")
    }
    deviations = {
        "tangential_restitution_standard_deviation": 0.01,
        "spin_y_after_standard_deviation [rad/s]": 5.0,
    }
    file = table(tmp_path, ALL, **columns, **deviations)
    what = vi.calibration.calibration_of(
        {
            **case({"law": "coulomb"}),
            "calibrate": {"target": file, "parameter": "friction.coefficient"},
        }
    )
    found = vi.calibration.calibrate_case(what)
    folder = found.save(tmp_path / "calibrated", figures=("png",))
    document = json.loads((folder / "calibration.json").read_text(encoding="utf-8"))
    (one,) = document["parameters"]
    assert one["parameter"] == "friction.coefficient"
    assert one["given"] is None
    assert one["low"] < one["value"] < one["high"]
    assert list(document["match"]) == ["tangential_restitution", "spin_y_after"], (
        "the rebound angle says the same again"
    )
    assert [row["slips_throughout"] for row in document["matched"]] == found.slips.tolist()
    assert (
        vi.load_case(folder / "case.toml").contact.friction.parameters["coefficient"]
        == found.values[0]
    )
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "friction.coefficient" in page
    chart = next(iter(found.charts.values()))
    assert chart.name == "angle"
    assert [panel.y.label for panel in chart.panels] == [
        "Tangential restitution",
        "Rebound angle",
        "Angular velocity after the impact",
    ]
    for panel, name in zip(chart.panels, columns, strict=True):
        curve, points = (
            next(mark for mark in panel.marks if isinstance(mark, kind)) for kind in (Line, Points)
        )
        np.testing.assert_allclose(points.y, columns[name], rtol=1e-11)
        np.testing.assert_allclose(
            np.interp(ALL[1:-1], curve.x, curve.y), points.y[1:-1], atol=0.02 * np.ptp(points.y)
        )
        assert (points.low is None) == (name == "rebound_angle_deg")
    assert load_drop(folder).function is None


FAULTS = [
    ({"parameter": "friction.coeficient"}, 'Did you mean "friction.coefficient"?'),
    ({"parameter": "friction.slip_restitution"}, 'coulomb has no parameter "slip_restitution"'),
    (
        {"parameter": ["friction.coefficient", "damping_max"]},
        "damping_max is not fitted together with friction",
    ),
    (
        {"parameter": ["friction.coefficient", "friction.coefficient"]},
        "calibrate.parameter: a parameter is named twice",
    ),
    (
        {"target": {"restitution": 0.7}},
        "calibrate.target: friction.coefficient is fitted to a table of measured oblique impacts",
    ),
    ({"degree": 1}, "calibrate.degree: friction.coefficient is one number"),
    ({"air": True}, "calibrate.air: friction.coefficient is one number"),
    (
        {"match": "spin_y_after"},
        "calibrate.match: the file has no column spin_y_after; there is tangential_restitution",
    ),
    (
        {"match": "max_force"},
        "calibrate.match: friction is not fitted to max_force; match tangential_restitution",
    ),
    (
        {"match": {"tangential_restitution": 1, "rebound_angle": 1}},
        "tangential_restitution and rebound_angle are equivalent",
    ),
    ({"bootstrap": 5}, "calibrate.bootstrap: 5 draws give no interval"),
]


@pytest.mark.parametrize(("changes", "words"), FAULTS, ids=[str(fault[0]) for fault in FAULTS])
def test_faults_of_the_section(changes: dict[str, Any], words: str, tmp_path: Path) -> None:
    section = {
        "target": table(tmp_path, STEEP, tangential_restitution=0.8),
        "parameter": "friction.coefficient",
        **changes,
    }
    with pytest.raises(vi.InputError) as refused:
        vi.calibration.calibrate_case(
            vi.calibration.calibration_of({**case({"law": "coulomb"}), "calibrate": section})
        )
    assert words in str(refused.value)


FILES = [
    (
        "angle [deg],tangential_restitution\n30,0.7\n",
        "the columns angle, tangential_restitution do not give the approach of the sphere",
    ),
    (
        "angle [deg],speed [m/s]\n30,3\n",
        "what was measured after the impacts is missing; give one of tangential_restitution",
    ),
    ("angle [deg],speed [m/s],tangential_restitution\n95,3,0.7\n", "line 2: angle is 95 deg"),
    (
        "angle [deg],speed [m/s],tangential_restitution\n30,-3,0.7\n",
        "line 2: speed is -3 m/s; it must be greater than 0",
    ),
    (
        "angle [deg],speed [m/s],tangential_restitution\n30,3,0.7\n0,3,0.7\n",
        "line 3: a sphere that does not move along the plate has no",
    ),
    ("angle [m],speed [m/s],tangential_restitution\n30,3,0.7\n", 'column "angle [m]"'),
    ("angle,speed [m/s],tangential_restitution\n30,3,0.7\n", 'column "angle": the unit is missing'),
    (
        "angle [deg],speed [m/s],tangential_restitution,restitution\n30,3,0.7,1.5\n",
        "line 2: restitution is 1.5; it is 1 at most",
    ),
    (
        "angle [deg],speed "
        "[m/s],tangential_restitution,tangential_restitution_standard_deviation\n30,3,0.7,0\n",
        "tangential_restitution_standard_deviation is 0",
    ),
    (
        "angle [deg],speed "
        "[m/s],tangential_restitution,spin_y_after_rad_s,tangential_restitution_standard_deviation\n30,3,0.7,5,0.1\n",
        "tangential_restitution has a standard deviation and spin_y_after has none",
    ),
]


@pytest.mark.parametrize(("text", "words"), FILES)
def test_faults_of_the_file(text: str, words: str, tmp_path: Path) -> None:
    file = tmp_path / "measured.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(vi.InputError) as refused:
        calibrated(str(file), {"law": "coulomb"})
    assert words in str(refused.value)
    assert "measured.csv" in str(refused.value)


def test_faults_of_the_case(tmp_path: Path) -> None:
    section = {
        "target": table(tmp_path, STEEP, tangential_restitution=0.8),
        "parameter": "friction.coefficient",
    }
    with pytest.raises(vi.InputError, match="the case has no friction"):
        vi.calibration.calibrate_case(
            vi.calibration.calibration_of({**case({"law": "none"}), "calibrate": section})
        )
    with pytest.raises(vi.InputError, match=r"it is missing; friction\.coefficient is fitted to"):
        vi.calibration.calibration_of(
            {**case({"law": "coulomb"}), "calibrate": {"parameter": "friction.coefficient"}}
        )
    contact = {
        "law": "hunt-crossley",
        "restitution": 0.7,
        "local_compliance": "identified",
        "local_stiffness": 1e9,
        "local_damping": 10.0,
    }
    with pytest.raises(vi.InputError, match="friction is fitted to single impacts of rigid bodies"):
        calibrated(section["target"], {"law": "mdr"}, contact=contact)
    force = {"law": "hunt-crossley", "restitution": 0.7}
    shaken = {**case({})["plate"], "motion": {"amplitude": "1 mm", "frequency": "25 Hz"}}
    with pytest.raises(vi.InputError, match="only impacts on a plate at rest can be matched"):
        calibrated(
            section["target"],
            {"law": "mdr"},
            plate=shaken,
            drop={"speed": SPEED, "angle": 0.5},
            contact=force,
        )
    file = table(tmp_path, STEEP, tangential_restitution=0.8, restitution=0.8)
    with pytest.raises(vi.InputError, match="hertz has no parameter to meet it with"):
        calibrated(file, {"law": "coulomb"}, contact={"law": "hertz"})


@pytest.mark.parametrize(("law", "reached"), [("lankarani-nikravesh", False), ("flores", True)])
def test_a_rebound_that_the_contact_law_does_not_reach(law: str, reached: bool) -> None:
    """Lankarani and Nikravesh's law has no restitution below 0.66."""
    stated = vi.case_of(
        case({"law": "coulomb", "coefficient": 0.1}, contact={"law": law, "restitution": 0.8})
    )
    along = {"separation_velocity_x": np.array([3.92, 4.93, 5.91])}
    seen = vi.calibration.Observations(
        speeds=np.full(3, 3.0),
        wanted=along,
        speed_noise=np.zeros((3, 3)),
        noise={name: 0.02 * np.eye(3) for name in along},
    )
    measured = vi.calibration.ObliqueImpacts(
        seen,
        np.array([5.0, 6.0, 7.0]),
        np.zeros(3),
        along,
        separation_speed=np.array([1.8, 1.8, 2.4]),
    )
    doubts = " ".join(
        vi.calibration.calibrate_friction(stated, measured, ["friction.coefficient"]).doubts
    )
    assert ("does not reach the normal rebound of 2 of 3 impacts" in doubts) is not reached
