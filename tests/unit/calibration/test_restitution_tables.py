"""Tables of restitutions over the approach speed: `vibroimpact calibrate ev.csv`, and
means of several impacts as a target of a case.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from support import outcome, plain_case
from vibroimpact.calibration.bounces.speed_laws import speed_laws
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.restitutions.report import noise_sentence

SPEED = np.array([0.5, 1.0, 1.5, 2.0, 3.0, 4.0])
RESTITUTION = np.array([0.86, 0.82, 0.80, 0.79, 0.75, 0.74])
COUNT = np.array([12, 3, 8, 8, 5, 2])


def table(path: Path, header: str = "speed [m/s],restitution,count") -> Path:
    rows = zip(SPEED, RESTITUTION, COUNT, strict=True)
    path.write_text(
        f"{header}\n" + "".join(f"{speed:g},{e:g},{n}\n" for speed, e, n in rows), encoding="utf-8"
    )
    return path


def test_the_fit_is_the_weighted_least_squares() -> None:
    """Means of n impacts have weights n; NumPy's polyfit takes their roots, and scales
    the covariance by the scatter.
    """
    _, linear, power = speed_laws(SPEED, RESTITUTION, 1e-20 * np.eye(6), COUNT)
    expected, covariance = np.polyfit(SPEED, RESTITUTION, 1, w=np.sqrt(COUNT), cov=True)
    np.testing.assert_allclose(linear.coefficients, expected[::-1], rtol=1e-9)
    np.testing.assert_allclose(linear.covariance, covariance[::-1, ::-1], rtol=1e-9)
    assert linear.freedom == 4
    expected, covariance = np.polyfit(
        np.log(SPEED), np.log(RESTITUTION), 1, w=np.sqrt(COUNT), cov=True
    )
    np.testing.assert_allclose(
        [np.log(power.coefficients[0]), power.coefficients[1]], expected[::-1], rtol=1e-9
    )
    np.testing.assert_allclose(power.covariance, covariance[::-1, ::-1], rtol=1e-9)


def test_rounding_widens_the_intervals(tmp_path: Path) -> None:
    found = vi.calibration.load_restitutions(table(tmp_path / "ev.csv"))
    assert found.rounding == 0.01
    exact = speed_laws(SPEED, RESTITUTION, 1e-20 * np.eye(6), COUNT)[1]
    np.testing.assert_allclose(found.laws[1].coefficients, exact.coefficients, atol=1e-3)


@pytest.mark.parametrize(
    "header",
    [
        "approach_speed_m_s,restitution,count",
        "impact velocity [m/s],COR,n",
        "v [m·s⁻¹],e [-],number",
        "velocity (m/s),coefficient of restitution,counts",
    ],
)
def test_the_columns_as_people_name_them(header: str, tmp_path: Path) -> None:
    found, expected = (
        vi.calibration.load_restitutions(table(tmp_path / "a.csv", header)),
        vi.calibration.load_restitutions(table(tmp_path / "b.csv")),
    )
    for one, other in zip(found.laws, expected.laws, strict=True):
        np.testing.assert_array_equal(one.coefficients, other.coefficients)


def test_separation_speeds_tell_the_restitution(tmp_path: Path) -> None:
    path = tmp_path / "ev.csv"
    path.write_text("speed [m/s];rebound speed [m/s]\n1;0,8\n2;1,5\n4;2,8\n", encoding="utf-8")
    np.testing.assert_allclose(
        vi.calibration.load_restitutions(path).restitution, [0.8, 0.75, 0.7], rtol=1e-15
    )


def test_a_given_deviation_is_that_of_one_impact(tmp_path: Path) -> None:
    path = tmp_path / "ev.csv"
    path.write_text(
        "speed_m_s,e,e_standard_deviation,count\n1,0.8,0.02,4\n2,0.75,0.02,16\n", encoding="utf-8"
    )
    found = vi.calibration.load_restitutions(path)
    np.testing.assert_allclose(found.deviation, [0.01, 0.005], rtol=1e-15)
    np.testing.assert_allclose(
        np.diff(found.intervals, axis=1)[:, 0], 2.0 * 1.959964 * found.deviation, rtol=1e-6
    )


@pytest.mark.slow
@pytest.mark.parametrize("noise", [0.02, 0.0])
def test_intervals_hold_the_truth(noise: float) -> None:
    """Of 2000 tables with means of 2 to 12 impacts, in steps of 0.01: of scatter, and of
    rounding alone.
    """
    random, within = np.random.default_rng(7), []
    for _ in range(2000):
        speed, true = np.sort(random.uniform(0.5, 5.0, 6)), random.uniform(-0.04, 0.0)
        restitution = np.round(
            0.85 + true * speed + noise * random.normal(size=6) / np.sqrt(COUNT), 2
        )
        law = speed_laws(speed, restitution, np.eye(6) * 0.01**2 / 12.0, COUNT)[1]
        low, high = law.intervals(0.95)[1]
        within.append(low <= true <= high)
    assert 0.93 <= np.mean(within) <= (0.975 if noise else 0.995)


def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    status, printed = outcome(monkeypatch, capsys, "calibrate", str(table(tmp_path / "ev.csv")))
    assert status == 0, printed
    assert "6 restitutions over the approach speed, means of 38 impacts." in printed
    assert "Linear: e = a + b v with a = 0.8" in printed
    assert "rounded; speeds are taken as exact. A scatter is that of single impacts." in printed
    folder = tmp_path / "ev-calibrated"
    assert sorted(one.name for one in folder.iterdir()) == [
        "report.html",
        "restitutions.csv",
        "summary.json",
    ]
    rows = list(
        csv.DictReader((folder / "restitutions.csv").read_text(encoding="utf-8").splitlines())
    )
    assert [float(row["restitution"]) for row in rows] == RESTITUTION.tolist()
    fits = json.loads((folder / "summary.json").read_text())["restitutions"]["fits"]
    assert float(rows[1]["linear"]) == pytest.approx(
        np.dot(fits["linear"]["coefficients"], [1.0, SPEED[1]])
    )
    assert "Restitutions of ev.csv" in (folder / "report.html").read_text(encoding="utf-8")
    with pytest.raises(vi.InputError, match="restitutions of a table, not the result of a run"):
        vi.load_result(folder)
    assert (
        outcome(monkeypatch, capsys, "calibrate", str(tmp_path / "ev.csv"))[0] == 2
    )  # the folder is there


def test_what_the_intervals_are_from(tmp_path: Path) -> None:
    """One restitution has no scatter, and of separation speeds it is these that are rounded."""
    (tmp_path / "one.csv").write_text("v [m/s],e\n1,0.81\n", encoding="utf-8")
    assert "follow from the step of 0.01 to which the values are rounded" in noise_sentence(
        vi.calibration.load_restitutions(tmp_path / "one.csv")
    )
    (tmp_path / "speeds.csv").write_text(
        "v [m/s],separation_speed [m/s]\n1,0.81\n2,1.5\n", encoding="utf-8"
    )
    told = noise_sentence(vi.calibration.load_restitutions(tmp_path / "speeds.csv"))
    assert (
        "the scatter about each fit, and from the step of 0.01 m/s to which the separation "
        "speeds are rounded" in told
    )


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (
            "speed [m/s],restitution\n1,82\n2,80\n",
            (),
            "line 2: the restitution is 82, more than 1.1, which is not taken "
            "for noise; if it is in per",
        ),
        ("speed [m/s],e\n1,82\n2,80\n", (), "name its unit: e [%]"),
        ("speed [m/s],e\n1,1.5\n2,0.8\n", (), "which is not taken for noise; look at the value"),
        (
            "speed [m/s],rebound_speed [m/s]\n1,82\n2,80\n",
            (),
            "which is not taken for noise; look at the speeds and their units",
        ),
        (
            "speed [m/s],restitution\n1,0.8\n2,-0.1\n",
            (),
            "line 3: restitution is -0.1; it must be greater than 0",
        ),
        (
            "speed [m/s],restitution\n0,0.8\n2,0.7\n",
            (),
            "line 2: speed is 0 m/s; it must be greater than 0",
        ),
        ("speed,restitution\n1,0.8\n2,0.7\n", (), 'column "speed": the unit is missing'),
        (
            "speed [m/s],e,count\n1,0.8,2.5\n",
            (),
            "line 2: count is 2.5; it must be a whole number, 1 or more",
        ),
        (
            "speed [m/s],v [m/s],e\n1,1,0.8\n",
            (),
            "the columns speed and v both mean approach_speed; keep one of them",
        ),
        (
            "speed [m/s],separation_speed "
            "[m/s],restitution_standard_deviation\n1,0.8,0.01\n2,1.5,0.01\n",
            (),
            "restitutions are those of separation_speed; give separation_speed_standard_deviation",
        ),
        ("speed [m/s],e\n1,0.8\n", ("--height", "1 m"), "--height goes with a record of bounces"),
        ("speed [m/s],e\n1,0.8\n", ("--channel", "e"), "--channel goes with a record of bounces"),
    ],
)
def test_what_is_refused(
    text: str,
    options: tuple[str, ...],
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ev.csv").write_text(text, encoding="utf-8")
    status, printed = outcome(monkeypatch, capsys, "calibrate", "ev.csv", *options)
    assert (status, words in printed) == (2, True), printed


def test_a_record_with_times_is_still_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.csv").write_text(
        "time [s],velocity [m/s],e [V]\n" + "".join(f"{n / 1000},{n % 3},0\n" for n in range(2000)),
        encoding="utf-8",
    )
    status, printed = outcome(monkeypatch, capsys, "calibrate", "a.csv")
    assert status == 2
    assert "it has several channels" in printed


def test_few_speeds_are_said_and_one_row_is_read(tmp_path: Path) -> None:
    path = tmp_path / "ev.csv"
    path.write_text("speed [m/s],e\n1,0.8\n", encoding="utf-8")
    found = vi.calibration.load_restitutions(path)
    assert [law.name for law in found.laws] == ["constant"]
    assert "only a constant is fitted" in found.doubts[0]
    path.write_text("speed [m/s],e\n1,0.8\n2,0.7\n2,0.71\n", encoding="utf-8")
    found = vi.calibration.load_restitutions(path)
    assert [law.name for law in found.laws] == ["constant", "linear", "power"]
    assert not found.doubts


def test_counts_weight_the_target_of_a_case(tmp_path: Path) -> None:
    """Rows that are means of many impacts weigh more: as if each impact were a row of its
    own, with the same mean.
    """
    contact = {"law": "lankarani-nikravesh", "restitution": 0.7}

    def calibrated(text: str) -> np.ndarray:
        (path := tmp_path / "ev.csv").write_text(text, encoding="utf-8")
        calibrate = {"target": str(path), "degree": 1, "air": False}
        return np.array(
            calibrate_case(
                calibration_of(plain_case(contact=contact, calibrate=calibrate))
            ).fit.function.coefficients
        )

    means = "".join(
        f"{speed:g},{e:g},{n}\n" for speed, e, n in zip(SPEED, RESTITUTION, COUNT, strict=True)
    )
    each = "".join(
        f"{speed:g},{e:g}\n" * n for speed, e, n in zip(SPEED, RESTITUTION, COUNT, strict=True)
    )
    alike = "".join(f"{speed:g},{e:g}\n" for speed, e in zip(SPEED, RESTITUTION, strict=True))
    weighted = calibrated(f"speed [m/s],e,n\n{means}")
    np.testing.assert_allclose(weighted, calibrated(f"speed [m/s],e\n{each}"), rtol=1e-6)
    assert np.abs(weighted / calibrated(f"speed [m/s],e\n{alike}") - 1.0).max() > 1e-3
