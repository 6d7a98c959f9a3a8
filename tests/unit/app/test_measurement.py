"""A measurement on the live page: which sensor a record is of, and what is laid over what."""

from __future__ import annotations

import io
import wave
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.app import measurement
from vibroimpact.app.measurement import Compared, compared, read_measurement
from vibroimpact.arrays import Floats
from vibroimpact.charts.marks import Line, Points
from vibroimpact.errors import InputError
from vibroimpact.results.csv_files import signal_csv

BALL = {"radius": "10 mm", "material": "steel"}
PLATE = {"size": ["200 mm", "150 mm", "6 mm"], "material": "steel"}
VIBRATING = {
    "sphere": BALL,
    "plate": {
        **PLATE,
        "model": "elastic",
        "modes": 20,
        "damping": 0.02,
        "supports": "simply-supported",
    },
    "drop": {"height": "0.2 m", "position": ["10 mm", 0]},
    "contact": {"law": "hunt-crossley", "restitution": 0.6},
    "run": {"duration": "0.3 s"},
}


def sensor(name: str, quantity: str = "acceleration") -> dict[str, object]:
    return {
        "name": name,
        "position": ["30 mm", "20 mm"],
        "rate": "20 kHz",
        "quantity": quantity,
    }


@cache
def run(*sensors: tuple[str, str]) -> tuple[vi.Case, vi.Response]:
    case = vi.case_of({**VIBRATING, "sensors": [sensor(*one) for one in sensors]})
    return case, vi.simulate(case.to_problem())


@cache
def rigid_run(law: str = "hunt-crossley") -> tuple[vi.Case, vi.Response]:
    case = vi.case_of(
        {
            "sphere": BALL,
            "plate": PLATE,
            "drop": {"height": "0.2 m"},
            "contact": {"law": law, "restitution": 0.6},
            "run": {"impacts": 3},
        }
    )
    return case, vi.simulate(case.to_problem())


ONE = (("a1", "acceleration"),)


def table(time: Floats, **columns: Floats) -> bytes:
    """A CSV file with columns named `NAME in UNIT`."""
    header = ",".join(["time [s]", *(f"{name.replace(' in ', ' [')}]" for name in columns)])
    rows = np.stack([time, *columns.values()], axis=1)
    return "\n".join([header, *(",".join(map(repr, row)) for row in rows.tolist()), ""]).encode()


def sound(value: Floats, rate: int) -> bytes:
    file = io.BytesIO()
    with wave.open(file, "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(rate)
        out.writeframes((32767 * value / np.abs(value).max()).astype("<i2").tobytes())
    return file.getvalue()


def lines_of(shown: Compared, chart: str) -> dict[str, tuple[Floats, Floats]]:
    """The lines of the last panel of the first row of a chart, by their names."""
    (found,) = [one for one in shown.charts if one.name == chart]
    return {
        mark.name: (np.asarray(mark.x), np.asarray(mark.y))
        for mark in found.rows[0][-1].marks
        if isinstance(mark, (Line, Points))
    }


def test_the_signal_of_a_run_lies_on_itself_wherever_its_time_begins() -> None:
    case, response = run(*ONE)
    signal = response.signals()["a1"]
    early, late = (
        compared(read_measurement("a1.csv", content), case, response)
        for content in (
            signal_csv(signal).encode(),
            table(signal.time + 7.0, **{"a1 in m/s2": signal.value}),
        )
    )
    for shown in (early, late):
        lines = lines_of(shown, "overlay")
        (time, measured), (_, simulated) = lines["measured"], lines["simulated"]
        assert np.abs(measured - simulated).max() < 0.05 * np.abs(measured).max()
        # it is the first touch that both times begin with
        assert time[0] < 0.0 < 0.01 < time[-1]
    np.testing.assert_allclose(
        lines_of(early, "overlay")["measured"][1],
        lines_of(late, "overlay")["measured"][1],
        rtol=0,
        atol=1e-6 * np.abs(signal.value).max(),
    )
    assert early.tables[0].rows[0][0] == "a1"


@pytest.mark.parametrize(
    ("file", "columns", "sensors", "matched"),
    [
        ("test.csv", ["a1 in m/s2"], ["a1", "a2"], ["a1"]),
        ("a2.csv", ["acceleration in m/s2"], ["a1", "a2"], ["a2"]),
        ("test.csv", ["channel 3 in g"], ["a1"], ["a1"]),
        ("test.csv", ["a1 in m/s2", "trigger in 1"], ["a1"], ["a1"]),
        ("test.csv", ["a2 in m/s2", "a1 in m/s2"], ["a1", "a2"], ["a1", "a2"]),
    ],
    ids=["name", "name of the file", "only one of its unit", "another channel", "two"],
)
def test_a_record_is_of_the_sensor_that_it_matches(
    file: str, columns: list[str], sensors: list[str], matched: list[str]
) -> None:
    case, response = run(*((name, "acceleration") for name in sensors))
    signal = response.signals()[matched[0]]
    content = table(signal.time, **dict.fromkeys(columns, signal.value))
    shown = compared(read_measurement(file, content), case, response)
    assert sorted(row[0] for row in shown.tables[0].rows) == matched
    left_out = [note for note in shown.notes if note.startswith("not compared")]
    assert len(left_out) == len(columns) - len(matched)


def test_sound_is_drawn_with_the_scale_that_fits() -> None:
    case, response = run(*ONE)
    signal = response.signals()["a1"]
    records = read_measurement("tap.wav", sound(signal.value, 20_000))
    shown = compared(records, case, response)
    lines = lines_of(shown, "overlay")
    assert np.abs(lines["measured"][1]).max() == pytest.approx(
        np.abs(lines["simulated"][1]).max(), rel=0.02
    )
    largest = np.abs(signal.value).max()
    note = next(note for note in shown.notes if "without a unit" in note)
    scale = float(note.split(", ")[1].split()[0])
    assert scale == pytest.approx(largest, rel=0.02)


def test_a_force_lies_on_the_contact_force_of_each_impact() -> None:
    case, response = rigid_run()
    time = np.arange(0.15, 0.74, 2e-6)
    force = 1.2 * response.at(time, ["force_N"])["force_N"] + 0.5
    shown = compared(
        read_measurement("force.csv", table(time + 3.0, **{"impact in N": force})), case, response
    )
    (chart,) = shown.charts
    largest = response.impacts["max_force_N"]
    assert chart.name == "record"
    assert [float(row[3]) for row in shown.tables[0].rows] == pytest.approx([1.2] * 3, rel=0.01)
    assert [float(row[2]) for row in shown.tables[0].rows] == pytest.approx(largest, rel=1e-3)
    views = chart.rows[0][0].x.views
    touches = [3.0 + touch for touch in response.impacts["time_s"]]
    assert [view.origin for view in views] == pytest.approx(touches, abs=2e-6)
    assert shown.notes == []


def test_contacts_beyond_those_of_the_run_are_told() -> None:
    case, response = rigid_run()
    time = np.arange(0.15, 0.45, 2e-6)
    force = response.at(time, ["force_N"])["force_N"]
    records = read_measurement("force.csv", table(time, **{"impact in N": force}))
    assert compared(records, case, response).notes == [
        "the record has 1 contact and the run 3; only those that both have are compared"
    ]


def test_contacts_that_follow_at_once_are_one() -> None:
    """On a plate that vibrates a visit may have several; a record does not part them."""
    _, response = run(*ONE)
    contacts = measurement._computed_contacts(response)
    begins = response.impacts["time_s"]
    assert 0 < len(contacts) <= len(begins)
    peaks = [force.max() for _, force in contacts]
    assert max(peaks) == pytest.approx(response.impacts["max_force_N"].max(), rel=1e-3)


@pytest.mark.parametrize(
    ("file", "content", "words"),
    [
        ("a1.m4a", b"", "a1.m4a: its format does not follow from its name; read here are files"),
        ("a1.wav", b"RIFX", "a1.wav: "),
        ("a1.wav", b"no sound", "this is no WAV file, which would begin with RIFF"),
        ("a1.csv", b"", "a1.csv: the file is empty"),
        ("a1.csv", b"\xff\xfe\x00", "a1.csv: "),
        ("a1.csv", b"time [s],a1\n0,1\n1,2\n", "the unit is missing"),
        ("a1.csv", b"time [s],a1 [m/s2]\n0,1\n1,x\n", "a1.csv, line 3"),
    ],
)
def test_a_file_that_is_not_understood_is_told_with_its_name(
    file: str, content: bytes, words: str
) -> None:
    with pytest.raises(InputError) as refused:
        read_measurement(file, content)
    (line,) = refused.value.lines
    assert words in line
    assert line.startswith(file)


def test_nothing_of_its_name_is_read_from_the_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a1.csv").write_bytes(table(np.arange(3.0), **{"secret in N": np.arange(3.0)}))
    content = table(np.arange(3.0), **{"a1 in m/s2": np.arange(3.0)})
    (record,) = read_measurement("a1.csv", content)
    assert record.name == "a1"
    assert [file.name for file in tmp_path.iterdir()] == ["a1.csv"]
    with pytest.raises(InputError):
        read_measurement("a1.csv", b"")


def test_there_is_a_largest_number_of_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measurement, "MOST_RECORDED", 3)
    read_measurement("a1.csv", table(np.arange(3.0), **{"a1 in N": np.arange(3.0)}))
    with pytest.raises(InputError, match=r"a1\.csv: there are 4 samples .* than the 3 of the"):
        read_measurement("a1.csv", table(np.arange(4.0), **{"a1 in N": np.arange(4.0)}))


def test_a_record_of_no_sensor_is_refused_with_a_remedy() -> None:
    time = np.arange(3.0)
    records = read_measurement("test.csv", table(time, **{"p in Pa": time}))
    with pytest.raises(InputError) as refused:
        compared(records, *run(*ONE))
    assert str(refused.value) == (
        'test.csv: it has "p", which is of none of the sensors "a1"; name a column after its '
        'sensor with its unit, such as "a1 [m/s2]", or open a record of the contact force in N'
    )
    with pytest.raises(InputError, match="the case has no sensors; add the sensor to the case"):
        compared(records, *rigid_run())


def test_a_law_without_a_force_is_refused_with_a_remedy() -> None:
    time = np.arange(0.0, 0.1, 1e-4)
    records = read_measurement(
        "force.csv", table(time, **{"f in N": np.exp(-(((time - 0.05) / 1e-3) ** 2))})
    )
    with pytest.raises(InputError, match="this law has no force over time") as refused:
        compared(records, *rigid_run("newton"))
    assert refused.value.key == "contact.law"


def test_a_record_within_an_impact_is_refused_with_a_remedy() -> None:
    case, response = rigid_run()
    touch = float(response.impacts["time_s"][0])
    time = np.arange(touch + 2e-5, touch + 1e-2, 2e-6)
    force = response.at(time, ["force_N"])["force_N"]
    records = read_measurement("force.csv", table(time, **{"f in N": force}))
    with pytest.raises(InputError, match="in the middle of its only impact; record some time"):
        compared(records, case, response)
