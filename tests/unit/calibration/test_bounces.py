"""Bounces heard in records: found among noise, clicks, hum and second contacts, with
intervals that hold the truth; refused otherwise.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile

import vibroimpact as vi
from ball_records import RATE, burst, heard, music
from support import plain_case
from vibroimpact.calibration.bounces.speed_laws import speed_laws
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.signals.bounces.chain import longest_chain

SAID = 1.96
CONDITIONS = [
    {"decibels": 20.0},
    {"decibels": 20.0, "hum": 0.5, "clicks": 3},
    {"decibels": 10.0, "hum": 1.0, "clicks": 4},
    {"decibels": 5.0},
    {"decibels": 0.0, "hum": 0.5},
]
BALLS = [(0.3, 5), (0.45, 6), (0.6, 7), (0.75, 8), (0.9, 9)]


def place_of(found: vi.signals.Bounces, touches: np.ndarray) -> int:
    """Return the touch that the first one found is; each of the others is the one after."""
    first = int(np.argmin(np.abs(touches - found.time[0])))
    np.testing.assert_allclose(found.time, touches[first : first + len(found.time)], atol=5e-4)
    return first


@pytest.mark.slow
def test_intervals_hold_the_truth() -> None:
    """Of 100 records at five levels of noise and five restitutions."""
    off, wide = [], []
    for seed in range(100):
        ball, condition = BALLS[seed % 5], CONDITIONS[seed // 5 % 5]
        made = heard(seed, *ball, **condition)
        found = vi.signals.find_bounces(made.record)
        first = place_of(found, made.touches)
        assert first == 0
        errors = found.restitution - made.restitution[: len(found.restitution)]
        if condition["decibels"] == 20.0:
            assert np.abs(errors).max() < 0.01
        off += errors.tolist()
        wide += (SAID * np.sqrt(np.diag(found.covariance))).tolist()
    within = np.abs(off) <= wide
    assert len(off) > 350
    assert 0.90 <= within.mean() <= 0.99
    assert np.abs(off).max() < 1e-3


@pytest.mark.parametrize("seed", range(6))
def test_second_contacts_are_told(seed: int) -> None:
    made = heard(seed, *BALLS[seed % 5], decibels=15.0, doubles=2, clicks=2)
    found = vi.signals.find_bounces(made.record)
    place_of(found, made.touches)
    errors = found.restitution - made.restitution[: len(found.restitution)]
    np.testing.assert_allclose(errors, 0.0, atol=2e-3)
    assert all(
        reason.startswith(("it is a click", "it is a second contact")) for reason in found.reasons
    )


def test_a_loud_second_contact_and_another_noise_are_told() -> None:
    made = heard(1, 0.7, 7, decibels=30.0)
    value = (
        made.record.value
        + 3.0 * burst(made.record.time, made.touches[2] + 4e-3)
        + burst(made.record.time, 0.5)
    )
    found = vi.signals.find_bounces(vi.signals.Record("microphone", value, RATE, "Pa"))
    place_of(found, made.touches)
    assert found.others.round(3).tolist() == [0.5, round(made.touches[2] + 4e-3, 3)]
    assert found.reasons == ("its time is not that of a bounce", "it is a second contact")


def test_scale_and_offset_and_start_do_not_matter() -> None:
    made = heard(2, 0.6, 6, decibels=20.0).record
    found = vi.signals.find_bounces(made)
    moved = vi.signals.find_bounces(
        vi.signals.Record(made.name, 3.0 - 1e-6 * made.value, made.rate, "V", start=7.0)
    )
    np.testing.assert_allclose(moved.time, found.time + 7.0, atol=1e-9)
    np.testing.assert_allclose(moved.restitution, found.restitution, rtol=1e-7)
    np.testing.assert_allclose(moved.deviation, found.deviation, rtol=1e-3)


@pytest.mark.parametrize("rate", [8e3, 10e3, 44_100.0, 192e3])
def test_any_rate(rate: float) -> None:
    made = heard(3, 0.7, 6, decibels=25.0, rate=rate)
    found = vi.signals.find_bounces(made.record)
    assert len(found.time) == 6
    np.testing.assert_allclose(found.restitution, made.restitution, atol=0.01)


def test_the_first_drop_and_the_last_bounces_may_be_missing() -> None:
    made = heard(4, 0.7, 8, decibels=20.0)
    inside = made.record.time > made.touches[1] - 0.1
    inside &= made.record.time < made.touches[6] - 0.01
    found = vi.signals.find_bounces(
        vi.signals.Record(
            "microphone", made.record.value[inside], RATE, "Pa", start=made.record.time[inside][0]
        )
    )
    np.testing.assert_allclose(found.time, made.touches[1:6], atol=5e-4)


@pytest.mark.parametrize("seed", range(12))
def test_music_is_refused(seed: int) -> None:
    with pytest.raises(vi.InputError, match="it holds no "):
        vi.signals.find_bounces(music(seed))


@pytest.mark.parametrize("seed", range(6))
def test_noise_is_refused(seed: int) -> None:
    value = np.random.default_rng(seed).standard_normal(96_000)
    with pytest.raises(vi.InputError, match=r"detected in it|holds no"):
        vi.signals.find_bounces(vi.signals.Record("microphone", value, RATE, "Pa"))


def record_of(*touches: float, duration: float = 1.0) -> vi.signals.Record:
    time = np.arange(int(duration * RATE)) / RATE
    return vi.signals.Record(
        "microphone", sum((burst(time, at) for at in touches), np.zeros_like(time)), RATE, "Pa"
    )


@pytest.mark.parametrize(
    ("record", "message"),
    [
        (record_of(), "it is silent: all samples are the same"),
        (vi.signals.Record("m", np.full(48_000, 3.0), RATE, "V"), "it is silent"),
        (record_of(0.3), "one touch is detected in it, and a restitution needs three"),
        (record_of(0.3, 0.6), "two touches are detected in it"),
        (record_of(0.2, 0.4, 0.7), "the times between 3 touches do not decrease"),
        (
            record_of(0.2, 0.5, 0.65, 0.85),
            "of its 4 touches 3 at best have intervals that shrink as those of bounces, "
            "which three touches may have by chance",
        ),
        (
            record_of(0.2, 0.5, 0.65, 0.75, 0.95),
            "of its 5 touches 4 at best have intervals that shrink as those of bounces, as "
            "some of as many",
        ),
        (vi.signals.Record("m", np.zeros(0), RATE, "V"), "it has no samples"),
        (
            vi.signals.Record("m", np.arange(100.0), RATE, "V"),
            "it is too short: it has 100 samples, and at 48000 Hz three touches take 288",
        ),
        (
            vi.signals.Record("m", np.array([0.0, np.nan]), RATE, "V"),
            "a sample is not a finite number",
        ),
        (
            vi.signals.Record(
                "m", np.clip(20.0 * heard(0, 0.8, 8, hum=0.3).record.value, -1.0, 1.0), RATE, "V"
            ),
            "it is clipped: ",
        ),
    ],
)
def test_what_tells_no_restitution_is_refused(record: vi.signals.Record, message: str) -> None:
    with pytest.raises(vi.InputError) as caught:
        vi.signals.find_bounces(record)
    assert message in str(caught.value)


def test_little_clipping_is_a_doubt() -> None:
    made = heard(0, 0.7, 7)
    found = vi.signals.find_bounces(
        vi.signals.Record("m", made.record.value.clip(-0.8, 0.8), RATE, "V")
    )
    np.testing.assert_allclose(found.restitution, made.restitution, atol=5e-4)
    assert "of the samples are clipped" in found.doubts[0]


def test_three_touches_are_taken_with_a_doubt() -> None:
    found = vi.signals.find_bounces(record_of(0.2, 0.5, 0.65))
    np.testing.assert_allclose(found.restitution, [0.5], atol=1e-5)
    assert found.doubts == (
        "the series has only three touches: they need not be bounces of one ball",
    )


@pytest.mark.parametrize("seed", range(40))
def test_hostile_records_are_read_or_refused(seed: int) -> None:
    random = np.random.default_rng(seed)
    value = random.standard_normal(int(random.integers(1, 3000))) * 10.0 ** random.uniform(
        -300.0, 150.0
    )
    value[random.random(len(value)) < random.random()] = 0.0
    if seed % 4 == 0:
        value = np.round(random.uniform(-3.0, 3.0, len(value)))
    record = vi.signals.Record("m", value, float(10.0 ** random.uniform(-3.0, 9.0)), "V")
    try:
        found = vi.signals.find_bounces(record)
    except vi.InputError:
        return
    assert np.isfinite(found.restitution).all()
    assert np.isfinite(found.covariance).all()


def test_the_chain_is_that_of_all_bounces() -> None:
    """Not every second one of them, and by no chance with others."""
    times = np.concatenate([[0.0], np.cumsum(0.9 ** np.arange(10))])
    among = np.sort(np.concatenate([times, [0.31, 2.2, 5.55]]))
    found = longest_chain(among, np.ones(len(among)), 1e-4)
    np.testing.assert_array_equal(among[found], times)


def test_speeds_are_those_of_the_flights() -> None:
    made = heard(5, 0.7, 7, decibels=30.0)
    found = vi.calibration.rebounds_of(
        vi.signals.find_bounces(made.record),
        gravity=9.81,
        height=0.5 * (0.5 * 9.81 * 0.4 / 0.7) ** 2 / 9.81,
    )
    np.testing.assert_allclose(
        found.separation_speed[:-1], 0.5 * 9.81 * np.diff(made.touches), rtol=1e-3
    )
    np.testing.assert_allclose(found.approach_speed[1:], found.separation_speed[:-1], rtol=1e-12)
    np.testing.assert_allclose(found.restitution[:-1], 0.7, atol=1e-3)
    assert np.isnan(found.restitution[-1])
    guessed = vi.calibration.rebounds_of(vi.signals.find_bounces(made.record), gravity=9.81)
    assert guessed.drop_height == pytest.approx(found.height, rel=1e-3)
    assert np.isnan(guessed.approach_speed[0])


def test_a_height_that_is_not_that_of_the_first_touch() -> None:
    bounces = vi.signals.find_bounces(record_of(0.2, 0.5, 0.68, 0.788))
    with pytest.raises(vi.InputError, match=r"rises by 0\.1103 m, more than the height of 0\.1 m"):
        vi.calibration.rebounds_of(bounces, height=0.1)
    found = vi.calibration.rebounds_of(bounces, height=3.0)
    assert "left out of the fits" in found.doubts[-1]
    assert found.laws[0].coefficients[0] == pytest.approx(0.6, abs=1e-4)
    with pytest.raises(vi.InputError, match="the gravity is 0 m/s"):
        vi.calibration.rebounds_of(bounces, gravity=0.0)


def test_a_contact_is_no_part_of_a_flight() -> None:
    touches = np.concatenate([[0.2], 0.2 + np.cumsum(0.3 * 0.6 ** np.arange(5) + 4e-3)])
    found = vi.signals.find_bounces(record_of(*touches), contact=4e-3)
    np.testing.assert_allclose(found.restitution, 0.6, atol=1e-4)
    too_large = vi.signals.find_bounces(record_of(*touches)).restitution - 0.6
    np.testing.assert_allclose(too_large, 0.4 * 4e-3 / (np.diff(touches)[:-1]), atol=1e-4)
    with pytest.raises(vi.InputError, match="within the contact"):
        vi.signals.find_bounces(record_of(*touches), contact=0.5)


@pytest.mark.slow
def test_fits_over_the_speed_hold_the_truth() -> None:
    """Of 300 series that scatter by more than their uncertainty."""
    random = np.random.default_rng(0)
    speed, covariance = np.array([2.5, 1.8, 1.4, 1.0, 0.8, 0.6, 0.5]), 1e-8 * np.eye(7)
    inside = np.zeros((300, 2))
    for number in range(300):
        restitution = 0.7 * speed**-0.1 * np.exp(random.normal(scale=0.01, size=7))
        _, _, power = speed_laws(speed, restitution, covariance)
        low, high = power.intervals(0.95).T
        inside[number] = (low <= (0.7, -0.1)) & (high >= (0.7, -0.1))
    assert np.all((inside.mean(axis=0) > 0.92) & (inside.mean(axis=0) < 0.98))


def test_fits_without_scatter_are_least_squares() -> None:
    speed = np.array([2.0, 1.5, 1.1, 0.7])
    restitution = np.array([0.61, 0.62, 0.64, 0.65])
    _, linear, _ = speed_laws(speed, restitution, 0.02**2 * np.eye(4))
    fitted, covariance = np.polyfit(speed, restitution, 1, cov="unscaled", w=np.full(4, 50.0))
    np.testing.assert_allclose(linear.coefficients, fitted[::-1], rtol=1e-9)
    np.testing.assert_allclose(linear.covariance, covariance[::-1, ::-1], rtol=1e-9)
    assert linear.scatter == 0.0


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "bounces.wav"
    value = heard(7, 0.72, 7, decibels=20.0, clicks=2).record.value
    wavfile.write(path, int(RATE), (0.5 * value / np.abs(value).max()).astype("f4"))
    return path


@pytest.fixture
def call(command: Callable[..., tuple[int, str, str]]) -> Callable[..., tuple[int, str, str]]:
    return partial(command, "calibrate")


def test_a_record_is_calibrated(call, file: Path, tmp_path: Path) -> None:
    status, out, err = call(file)
    assert (status, err) == (0, "")
    folder = tmp_path / "bounces-calibrated"
    assert sorted(one.name for one in folder.iterdir()) == [
        "bounces.csv",
        "report.html",
        "summary.json",
    ]
    summary = json.loads((folder / "summary.json").read_text())["bounces"]
    with (folder / "bounces.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    assert [row["impact"] for row in rows] == list("1234567")
    assert rows[0]["restitution"] == rows[-1]["restitution"] == ""
    assert [float(row["restitution"]) for row in rows[1:-1]] == pytest.approx(5 * [0.72], abs=1e-3)
    assert float(rows[1]["restitution"]) == summary["impacts"][1]["restitution"]
    low, high = summary["fits"]["constant"]["intervals"][0]
    assert low < 0.72 < high
    assert [one["reason"][:13] for one in summary["others"]] == 2 * ["it is a click"]
    assert "Constant: e = 0.7" in out
    assert "Bounces in bounces" in (folder / "report.html").read_text(encoding="utf-8")
    assert call(file)[0] == 2
    assert call(file, "--force", "--figures")[0] == 0
    assert sorted(one.name for one in (folder / "figures").iterdir()) == [
        "record.png",
        "restitution.png",
    ]


def test_json_and_options(call, file: Path) -> None:
    status, out, _ = call(
        file,
        "--json",
        "--gravity",
        "1.62",
        "--height",
        "20 cm",
        "--contact",
        "0.1 ms",
        "-o",
        "moon",
    )
    assert status == 0
    told = json.loads(out)
    assert told["folder"] == "moon"
    assert (
        told["bounces"]["gravity_m_s2"],
        told["bounces"]["drop_height_m"],
        told["bounces"]["contact_duration_s"],
    ) == (1.62, 0.2, 1e-4)
    assert told["bounces"]["impacts"][0]["approach_speed_m_s"] == pytest.approx(
        np.sqrt(2.0 * 1.62 * 0.2)
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("bounces.wav", "--gravity", "9.81 m"), "--gravity: "),
        (("bounces.wav", "--height", "-1"), "the height is -1 m; it must be above 0"),
        (
            ("bounces.wav", "--set", "run.impacts=3"),
            "--set changes the keys of a case, and a record or a table has none",
        ),
        (
            ("bounces.wav", "--channel", "bounce"),
            'there is no channel "bounce"; it has "bounces". Did you mean "bounces"?',
        ),
        (("none.wav",), "there is no such file"),
        (("paper:calibration", "--height", "1 m"), "--height goes with a record of bounces"),
        (
            ("stereo.wav",),
            'it has several channels, "stereo 1", "stereo 2"; name one by --channel (in a '
            "case the key channel)",
        ),
        (("stereo.wav", "--channel", "stereo 2"), "stereo.wav: it is silent"),
    ],
)
def test_what_is_not_allowed(call, file: Path, words: tuple[str, ...], message: str) -> None:
    rate, left = wavfile.read(file)
    wavfile.write(file.with_name("stereo.wav"), rate, np.stack([left, 0.0 * left], axis=1))
    status, out, err = call(*words)
    assert (status, out) == (2, "")
    assert message in err
    assert not file.with_name("bounces-calibrated").exists()


def calibrated(target: object, **changes: object):
    case = plain_case(
        contact={"law": "newton", "restitution": 0.5},
        calibrate={"target": target, "degree": 0, "air": False},
        **changes,
    )
    return calibrate_case(calibration_of(case))


def test_a_case_is_calibrated_to_what_is_heard(file: Path) -> None:
    speed = 0.5 * 9.80665 * 0.4 / 0.72
    found = calibrated({"file": str(file)}, drop={"speed": speed})
    np.testing.assert_allclose(found.values, 0.72, atol=1e-3)
    assert found.observations.of_the_drop
    assert len(found.values) == 6
    np.testing.assert_allclose(found.observations.speeds, speed * 0.72 ** np.arange(6), rtol=1e-3)
    later = calibrated({"file": str(file)}, drop={"speed": 2.0 * speed})
    assert (len(later.values), later.observations.of_the_drop) == (5, False)
    assert "the first is not taken for that of the drop" in later.observations.notes[0]


def test_a_channel_of_a_table_is_heard(tmp_path: Path) -> None:
    made = heard(8, 0.6, 5, decibels=30.0, flight=0.2, rate=8e3).record
    table = tmp_path / "plate.csv"
    lines = (
        f"{at!r},{value!r},1"
        for at, value in zip(made.time.tolist(), made.value.tolist(), strict=True)
    )
    table.write_text("time [s],geophone [V],force [N]\n" + "\n".join(lines))
    found = calibrated(
        {"file": str(table), "channel": "geophone"}, drop={"speed": 0.5 * 9.80665 * 0.2 / 0.6}
    )
    np.testing.assert_allclose(found.values, 0.6, atol=0.01)
    for target, message in (
        ({"file": str(table), "channel": "force"}, "it is silent"),
        (
            {"file": str(table), "channel": "geophone", "function": "1"},
            "the record is selected by its channel",
        ),
        ({"file": str(table), "contact_duration": "1 ms"}, "it applies to a record of bounces"),
    ):
        with pytest.raises(vi.InputError, match=message):
            calibrated(target)
