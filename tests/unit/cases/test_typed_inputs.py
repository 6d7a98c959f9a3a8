"""The uncertainty of what is typed, such as a height of fall, is part of the intervals of
calibrations, which limit the digits printed.
"""

from __future__ import annotations

import json
import pickle
import re
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from ball_records import heard
from support import plain_case
from vibroimpact.calibration.bounces.report import impact_table, law_sentences
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.observed.inputs import BRIEF, EARTH
from vibroimpact.cli import main
from vibroimpact.units.display import known_text
from vibroimpact.units.written import read_written

GRAVITY = 9.80665
TWO_SIDED = 1.959964
RANDOM = vi.signals.Record("microphone", np.zeros(48000), 48e3, "Pa")
MATERIAL = {"density": 7800.0, "youngs_modulus": 200e9, "poissons_ratio": 0.3}
EXACT = {"radius": "20 mm +- 0", "material": {**MATERIAL, "density": "7800 kg/m^3 +- 0"}}


def bounced(
    restitution: float, height: float, gravity: float = GRAVITY, touches: int = 6
) -> vi.signals.Bounces:
    """Touches of a ball that falls from a height, known to a microsecond."""
    speed = np.sqrt(2.0 * gravity * height) * restitution ** np.arange(1, touches)
    time = np.concatenate([[0.0], np.cumsum(2.0 * speed / gravity)])
    return vi.signals.Bounces(
        RANDOM, time, np.full(touches, 1e-6), np.ones(touches), np.zeros(0), ()
    )


@pytest.mark.parametrize(
    ("text", "value", "deviation", "stated"),
    [
        ("0.6 m +- 5 mm", 0.6, 0.005, True),
        ("0.600 \u00b1 0.005 m", 0.6, 0.005, True),
        ("600 mm +/- 1 %", 0.6, 0.006, True),
        ("0.6 m +- 0", 0.6, 0.0, True),
        ("0.6 m", 0.6, 0.05 / 3.0**0.5, False),
        ("600 mm", 0.6, 0.0005 / 3.0**0.5, False),
        ("6.00e2 mm", 0.6, 0.0005 / 3.0**0.5, False),
        (4, 4.0, 0.5 / 3.0**0.5, False),
        (0.25, 0.25, 0.005 / 3.0**0.5, False),
    ],
)
def test_numbers_as_they_are_written(
    text: str | float, value: float, deviation: float, stated: bool
) -> None:
    found = read_written(text, "m")
    assert (found, found.stated) == (pytest.approx(value, rel=1e-12), stated)
    assert found.deviation == pytest.approx(deviation, rel=1e-9)
    kept = pickle.loads(pickle.dumps(found))
    assert (kept, kept.deviation, kept.text) == (found, found.deviation, found.text)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"drop": {"height": "0.6 m +- 5 s"}},
            r'the standard deviation in "0.6 m \+- 5 s": "5 s" is a time',
        ),
        ({"drop": {"height": "0.6 m +- -5 mm"}}, "negative"),
        ({"drop": {"height": "0 m +- 5 mm"}}, "must be greater than 0"),
        (
            {"plate": {"material": "steel", "radius": "1 m +- 1 mm"}},
            r'may stand at drop\.height, .*; write "1 m"',
        ),
    ],
)
def test_what_is_not_a_standard_deviation(changes: dict, message: str) -> None:
    with pytest.raises(vi.InputError, match=message) as refused:
        vi.case_of(plain_case(**changes))
    assert len(str(refused.value)) < 490


def test_the_height_is_in_the_interval_of_the_first_impact() -> None:
    """By e = g T / (2 (2 g h)^1/2): half the relative deviation of the height. It was
    1e-6 whatever the height was known to.
    """
    bounces = bounced(0.82, 0.6)
    for height, deviation in (
        ("0.6 m +- 5 mm", 0.005),
        ("0.60 m", 0.005 / 3.0**0.5),
        ("0.6 m", 0.05 / 3.0**0.5),
    ):
        found = vi.calibration.rebounds_of(bounces, gravity="9.80665 m/s^2 +- 0", height=height)
        assert found.deviation[0] == pytest.approx(0.5 * 0.82 * deviation / 0.6, rel=1e-4)
        assert found.deviation[1] < 1e-5
        assert found.approach_deviation[0] == pytest.approx(
            0.5 * found.approach_speed[0] * deviation / 0.6, rel=1e-4
        )
        assert any(
            "the interval of impact 1 is mostly that of height" in doubt for doubt in found.doubts
        ) == ("+-" not in height)
    exact = vi.calibration.rebounds_of(bounces, gravity=GRAVITY, height=0.6)
    assert exact.deviation[0] < 1e-5


def test_gravity_is_in_speeds_and_in_the_first_impact() -> None:
    found = vi.calibration.rebounds_of(bounced(0.82, 0.6), height=0.6)
    relative = EARTH.deviation / EARTH
    assert found.separation_deviation[1] / found.separation_speed[1] == pytest.approx(
        relative, rel=1e-2
    )
    assert found.deviation[0] == pytest.approx(0.41 * relative, rel=1e-2)
    assert found.deviation[1] < 1e-5


def test_a_contact_time_is_in_the_restitutions() -> None:
    """A contact that is part of the time between touches makes a restitution larger by (1
    - e) / T of it; it may fall with the speed to the power 1/5, of which the deviation is 1/5 over
    the root of 3.
    """
    bounces = bounced(0.7, 0.5)
    lasting = vi.signals.Bounces(
        RANDOM,
        bounces.time,
        bounces.deviation,
        bounces.peak,
        bounces.others,
        (),
        (),
        read_written("0 ms +- 0.5 ms", "s"),
    )
    found = vi.calibration.rebounds_of(lasting)
    flight = bounces.flight
    longer = -0.2 / np.sqrt(3.0) * (np.log(flight) - np.log(flight).mean())
    by_power = 0.7 * longer[:-1] / flight[:-1] - longer[1:] / flight[:-1]
    assert found.deviation[1:-1] == pytest.approx(
        5e-4 * np.hypot(0.3 / flight[:-1], by_power), rel=1e-4
    )


@pytest.mark.slow
@pytest.mark.parametrize("law", [0, 1, 2])
def test_intervals_hold_the_truth_with_inputs_that_are_off(law: int) -> None:
    """Height, gravity and contact are off by what is stated of them, and the contact falls with a
    power of the speed from 0 to 1/5; the restitution is linear in the speed or a power of it.
    """
    random, hits, first = np.random.default_rng(5), 0, 0
    slope = (0.0, -0.02, -0.05)[law]
    for _ in range(300):
        height, gravity, contact = (
            0.6 + random.normal(0.0, 0.01),
            GRAVITY + random.normal(0.0, 0.02),
            3e-4 + random.normal(0.0, 5e-5),
        )
        speed, speeds = np.sqrt(2.0 * gravity * height), []
        restitution = {
            0: lambda v: 0.8,
            1: lambda v: 0.85 + slope * v,
            2: lambda v: 0.8 * v**slope,
        }[law]
        for _ in range(6):
            speeds.append(speed)
            speed = restitution(speed) * speed
        left = np.array([*speeds[1:], speed])
        power = random.uniform(0.0, 0.2)
        contacts = contact * (left / np.exp(np.log(left).mean())) ** -power
        flights = 2.0 * left / gravity + contacts
        time = np.concatenate([[0.0], np.cumsum(flights)]) + random.normal(
            0.0, 1e-5, len(flights) + 1
        )
        given = read_written("0.3 ms +- 0.05 ms", "s")
        heard_touches = vi.signals.Bounces(
            RANDOM, time, np.full(len(time), 1e-5), np.ones(len(time)), np.zeros(0), (), (), given
        )
        found = vi.calibration.rebounds_of(
            heard_touches, gravity="9.80665 m/s^2 +- 0.02 m/s^2", height="0.6 m +- 10 mm"
        )
        low, high = found.intervals[0]
        first += low <= restitution(speeds[0]) <= high
        low, high = found.laws[law].intervals(0.95)[-1]
        hits += low <= (0.8, slope, slope)[law] <= high
    assert 0.92 <= first / 300 <= 0.98
    assert 0.92 <= hits / 300 <= 0.985


@pytest.mark.slow
@pytest.mark.parametrize("contact", [3e-5, 1e-4])
def test_intervals_hold_the_truth_where_contacts_take_longer_at_lower_speeds(
    contact: float,
) -> None:
    """As Hertz's do; of a record so clean that the contact time, of which nothing is typed, is all
    that is uncertain, the fitted constant was off by 14 standard deviations.
    """
    random = np.random.default_rng(8)
    hits = []
    for _ in range(300):
        speeds = 3.4 * 0.82 ** np.arange(7)
        flights = 2.0 * speeds[1:] / GRAVITY + contact * speeds[:-1] ** -0.2
        time = np.concatenate([[0.0], np.cumsum(flights)]) + random.normal(0.0, 3e-8, 7)
        series = vi.signals.Bounces(
            RANDOM, time, np.full(7, 3e-8), np.ones(7), np.zeros(0), (), (), BRIEF
        )
        found = vi.calibration.rebounds_of(series)
        low, high = found.laws[0].intervals(0.95)[0]
        hits.append(low <= 0.82 <= high)
        known = np.isfinite(found.restitution)
        assert np.all(np.abs(found.restitution - 0.82)[known] <= 2.0 * found.deviation[known])
    assert np.mean(hits) >= 0.92


def test_no_more_digits_than_the_interval_carries() -> None:
    assert [known_text(0.819860, spread) for spread in (0.02, 0.0031, 4e-7)] == [
        "0.820",
        "0.8199",
        "0.819860",
    ]
    assert [known_text(1988.56, spread) for spread in (80.0, 8.0)] == ["1989", "1988.6"]
    found = vi.calibration.rebounds_of(bounced(0.82, 0.6), height="0.6 m")
    restitution, interval = impact_table(found).columns[4:]
    assert (restitution.cells[0], interval.cells[0]) == ("0.820", "0.781 to 0.859")
    assert restitution.cells[1] == "0.820000"
    told = " ".join(
        law_sentences(vi.calibration.rebounds_of(bounced(0.82, 0.6, touches=3), height="0.60 m"))
    )
    for value, low, high in re.findall(r"([\d.]+) \(([\d.]+) to ([\d.]+)\)", told):
        assert 10.0 ** -len(value.partition(".")[2]) >= 0.005 * (float(high) - float(low))


def test_the_command_tells_what_it_takes(tmp_path: Path, monkeypatch, capsys) -> None:
    from scipy.io import wavfile

    value = heard(3, 0.8, 7, decibels=30.0).record.value
    wavfile.write(tmp_path / "b.wav", 48_000, (2e4 * value / np.abs(value).max()).astype(np.int16))
    monkeypatch.chdir(tmp_path)
    fall = 0.5 * (0.5 * GRAVITY * 0.4 / 0.8) ** 2 / GRAVITY
    for height in (f"{fall:.2f} m", f"{fall:.4f} m +- 2 mm"):
        monkeypatch.setattr(
            "sys.argv",
            ["vibroimpact", "calibrate", "b.wav", "--height", height, "--force", "-o", "out"],
        )
        with pytest.raises(SystemExit) as ended:
            main()
        assert not ended.value.code
        told = json.loads(Path("out/summary.json").read_text(encoding="utf-8"))["bounces"]
        inputs = {one["name"]: one for one in told["inputs"]}
        assert inputs["height"]["stated"] == ("+-" in height)
        assert inputs["height"]["as_typed"] == height
        assert inputs["gravity"]["standard_deviation"] == 0.015
        out = " ".join(capsys.readouterr().out.split())
        assert (
            "The intervals include the standard deviations of these inputs: gravity 9.80665" in out
        )


def calibrated(
    target: object, sphere: dict | None = None, drop: dict | None = None, **more: object
) -> Calibration:
    table = plain_case(contact={"law": "newton", "restitution": 0.5}, run={"impacts": 2})
    table |= {
        "sphere": sphere or EXACT,
        "drop": drop or {},
        "calibrate": {"target": target, "air": False, "degree": 0, **more},
    }
    return calibrate_case(calibration_of(table))


HEIGHTS = {"rebound_heights": ["0.4 m"], "standard_deviation": "1 um"}


@pytest.mark.parametrize(
    ("drop", "sphere", "half"),
    [
        ({"height": "1 m +- 10 mm"}, EXACT, 0.5 * 0.01 / 0.98),
        ({"height": "1.00 m"}, EXACT, 0.5 * 0.005 / 3.0**0.5 / 0.98),
        (
            {"height": "1 m +- 0"},
            {**EXACT, "radius": "20 mm +- 2 mm"},
            0.5 * 2e-3 * (1.0 / 0.38 - 1.0 / 0.98),
        ),
        ({"speed": "4 m/s +- 1 %"}, EXACT, 0.01),
    ],
)
def test_inputs_of_a_case_in_the_intervals_of_heights(
    drop: dict, sphere: dict, half: float
) -> None:
    """Of e^2 = (h - R) / (H - R), in a vacuum: gravity does not matter with a height, and
    the mass never.
    """
    found = calibrated(HEIGHTS, sphere, {**drop, "gravity": "9.80665 m/s^2 +- 0"})
    low, high = found.intervals[0] / found.values[0]
    assert 0.5 * (high - low) == pytest.approx(TWO_SIDED * half, rel=2e-3)
    (one,) = found.observations.effects.inputs
    assert one.name == (f"drop.{next(iter(drop))}" if sphere is EXACT else "sphere.radius")
    stated = "1.00 m" not in drop.values()
    assert any("is mostly that of drop.height, 1.00 m" in doubt for doubt in found.doubts) != stated


def test_gravity_counts_with_a_speed() -> None:
    """The rebound speed is (2 g h)^1/2, and the speed of approach is given: half the
    relative deviation of gravity.
    """
    found = calibrated(HEIGHTS, EXACT, {"speed": "4 m/s +- 0"})
    low, high = found.intervals[0] / found.values[0]
    assert 0.5 * (high - low) == pytest.approx(TWO_SIDED * 0.5 * 0.015 / GRAVITY, rel=2e-3)


def test_the_mass_is_in_the_intervals_of_a_force(tmp_path: Path) -> None:
    """The impulse J of a single contact gives e = J / (m v) - 1."""
    time = np.arange(0.0, 4e-3, 2e-6)
    mass, speed = 7800.0 * 4.0 / 3.0 * np.pi * 0.02**3, 2.0
    inside = (time > 1.5e-3) & (time < 2.5e-3)
    force = np.where(inside, np.sin(np.pi * (time - 1.5e-3) / 1e-3), 0.0)
    force *= 1.7 * mass * speed / (force.sum() * 2e-6)
    np.savetxt(
        tmp_path / "force.csv",
        np.column_stack([time, force]),
        delimiter=",",
        header="time [s],force [N]",
        comments="",
    )
    sphere = {**EXACT, "material": {**MATERIAL, "density": "7800 kg/m^3 +- 2 %"}}
    drop = {"speed": "2 m/s +- 0", "gravity": "9.80665 m/s^2 +- 0"}
    widths = []
    for body in (EXACT, sphere):
        found = calibrated(str(tmp_path / "force.csv"), body, drop)
        assert found.values[0] == pytest.approx(0.7, abs=0.01)
        widths.append(0.5 * float(np.ptp(found.intervals[0])))
    assert np.sqrt(widths[1] ** 2 - widths[0] ** 2) == pytest.approx(
        TWO_SIDED * 1.7 * 0.02, rel=0.02
    )


def test_a_material_by_its_name_has_a_stated_default() -> None:
    """A dashpot that is to leave a given rebound grows with the mass, of which the
    density has 1 %.
    """
    contact = {"law": "linear-spring-dashpot", "stiffness": 1e6, "damping": 1.0}
    table = plain_case(
        contact=contact,
        sphere={"radius": "20 mm +- 0", "material": "steel"},
        drop={"speed": "2 m/s +- 0"},
        run={"impacts": 1},
    )
    target = {"separation_speed": 1.4, "relative_deviation": 1e-6}
    table["drop"]["gravity"] = "9.80665 m/s^2 +- 0"
    found = calibrate_case(
        calibration_of(
            {**table, "calibrate": {"target": target, "parameter": "damping", "air": False}}
        )
    )
    (one,) = found.observations.effects.inputs
    assert (one.name, one.value.deviation, one.value.stated) == (
        "sphere.material.density",
        pytest.approx(78.5),
        False,
    )
    assert "as of a material by its name, steel" in one.why
    # c = 2 zeta (k m)^1/2
    assert 0.5 * np.ptp(found.intervals[0]) / found.values[0] == pytest.approx(
        TWO_SIDED * 0.5 * 0.01, rel=0.01
    )


def test_a_poor_height_does_not_spoil_the_others() -> None:
    """The height is typed 5 % too high, within what its digits leave open: the other
    impacts tell the restitution.
    """
    true, radius = 0.8, 0.02
    heights = radius + (0.62 - radius) * true ** (2.0 * np.arange(1, 7))
    target = {"rebound_heights": heights.tolist(), "standard_deviation": "10 um"}
    found = calibrated(
        target, EXACT, {"height": "0.65 m +- 0.03 m", "gravity": "9.80665 m/s^2 +- 0"}
    )
    assert found.fit.function.coefficients[0] == pytest.approx(true, abs=1e-4)
    low, high = found.intervals[0]
    assert low < true < high
    assert not any("residuals are" in doubt for doubt in found.doubts)
    exact = calibrated(target, EXACT, {"height": "0.65 m +- 0", "gravity": "9.80665 m/s^2 +- 0"})
    assert abs(exact.fit.function.coefficients[0] - true) > 1e-3


@pytest.mark.slow
def test_intervals_of_a_case_hold_the_truth() -> None:
    random, hits = np.random.default_rng(2), 0
    for _ in range(200):
        height, radius = 0.6 + random.normal(0.0, 5e-3), 0.02 + random.normal(0.0, 2e-4)
        rises = (height - radius) * 0.8 ** (2.0 * np.arange(1, 4))
        heights = radius + rises + random.normal(0.0, 5e-4, 3)
        sphere = {**EXACT, "radius": "20 mm +- 0.2 mm"}
        drop = {"height": "0.6 m +- 5 mm"}
        found = calibrated(
            {"rebound_heights": heights.tolist(), "standard_deviation": "0.5 mm"}, sphere, drop
        )
        low, high = found.intervals[0]
        hits += low <= 0.8 <= high
    assert 0.92 <= hits / 200 <= 0.98


def test_a_bootstrap_draws_the_inputs() -> None:
    drop = {"height": "1 m +- 10 mm", "gravity": "9.80665 m/s^2 +- 0"}
    first, drawn = (calibrated(HEIGHTS, EXACT, drop, bootstrap=draws) for draws in (0, 4000))
    np.testing.assert_allclose(drawn.intervals, first.intervals, rtol=2e-3)
    assert drawn.bootstrap == 4000


def test_friction_says_that_it_leaves_them_out(tmp_path: Path) -> None:
    (tmp_path / "o.csv").write_text(
        "angle [deg],speed [m/s],tangential_restitution\n50,4,0.75\n60,4,0.83\n70,4,0.9\n",
        encoding="utf-8",
    )
    contact = {
        "law": "lankarani-nikravesh",
        "restitution": 0.9,
        "friction": {"law": "coulomb", "coefficient": 0.1},
    }
    table = plain_case(
        contact=contact,
        sphere={"radius": "20 mm +- 1 mm", "material": "steel"},
        drop={"speed": 4.0},
        run={"impacts": 1},
    )
    section = {"target": str(tmp_path / "o.csv"), "parameter": "friction.coefficient"}
    found = calibrate_case(calibration_of({**table, "calibrate": section}))
    assert any(
        doubt == "the standard deviation of sphere.radius is no part of these intervals"
        for doubt in found.doubts
    )


def test_a_report_states_the_inputs() -> None:
    table = plain_case(
        contact={"law": "newton", "restitution": 0.5}, sphere=EXACT, drop={"height": "1 m"}
    )
    what = calibration_of({**table, "calibrate": {"target": HEIGHTS, "air": False, "degree": 0}})
    calibration = calibrate_case(what)
    report = calibration.report
    assert [one["name"] for one in report.document["inputs"]] == ["drop.height", "drop.gravity"]
    assert any("drop.height 1" in sentence for sentence in report.sentences)
    (value,) = report.sections[0].blocks[0].columns[2].cells
    assert len(value.partition(".")[2]) <= 3
    # a run does not need them, and what is written has the numbers alone
    assert vi.case_of(calibration.calibrated_case.to_problem().source).drop.height == 1.0
