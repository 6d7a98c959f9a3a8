"""Baselines of records: found, removed, told, and not found where there is none."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from hammer_test import RATE as HAMMERED_RATE
from hammer_test import a_case as hammered_case
from hammer_test import hammered, records
from identifying import an_impact, plate, records_of
from vibroimpact.identification.identify import identify_on
from vibroimpact.recognition.labelled_signals import LabelledSignals, SensorSignals
from vibroimpact.recognition.signal_features import baseline_doubts
from vibroimpact.signals.baseline import baseline_of, without_baseline
from vibroimpact.signals.record import Record

RATE, RESTITUTION = 20e3, 0.75
TIME = np.arange(32000) / RATE


def tap(
    at: float, peak: float, frequency: float = 1500.0, decay: float = 3e-3, time: np.ndarray = TIME
) -> np.ndarray:
    since = (time - at).clip(0.0)
    return peak * np.exp(-since / decay) * np.sin(2.0 * np.pi * frequency * since)


@cache
def bouncing() -> np.ndarray:
    """Return six bursts of 100 m/s^2 and less, as a ball of restitution 0.75 makes them;
    the first touch is at 0.10005 s.
    """
    touches = 0.10005 + np.append(0.0, np.cumsum(0.4 * RESTITUTION ** np.arange(5)))
    return np.sum(
        [tap(at, 100.0 * RESTITUTION**number) for number, at in enumerate(touches)], axis=0
    )


BASELINES = {
    "offset": np.full(len(TIME), 5.0),
    "ramp": np.linspace(-5.0, 5.0, len(TIME)),
    "exponential": 8.0 * np.exp(-TIME / 0.5),
    "larger than the bursts": np.full(len(TIME), -500.0),
    "ramp larger than the bursts": np.linspace(0.0, 300.0, len(TIME)),
}


@pytest.mark.parametrize("noise", [0.0, 0.5])
@pytest.mark.parametrize("kind", BASELINES)
def test_bursts_are_told_through_a_baseline(kind: str, noise: float) -> None:
    value = bouncing() + noise * np.random.default_rng(1).standard_normal(len(TIME))
    clean, shifted = (
        vi.signals.feature_table([one], RATE, unit="m/s2")
        for one in (value, value + BASELINES[kind])
    )
    assert clean.offset.tolist() == clean.drift.tolist() == [0.0]
    assert shifted["packets"][0] == 6.0
    assert shifted["bounce_restitution"][0] == pytest.approx(RESTITUTION, abs=1e-3)
    assert shifted["peak_frequency"][0] == clean["peak_frequency"][0]
    assert shifted["peak"][0] == pytest.approx(clean["peak"][0], abs=0.1)
    assert shifted.offset[0] == pytest.approx(BASELINES[kind].mean(), abs=0.02)
    assert shifted.drift[0] == pytest.approx(np.ptp(BASELINES[kind]), abs=0.05)


@pytest.mark.parametrize("kind", BASELINES)
def test_a_window_cuts_the_piece_from_the_first_touch_on(kind: str) -> None:
    record = Record("plate", bouncing() + BASELINES[kind], RATE, "m/s2")
    clean = vi.signals.from_onset(Record("plate", bouncing(), RATE, "m/s2"), 0.02, before=1e-3)
    found = vi.signals.from_onset(record, 0.02, before=1e-3)
    assert vi.signals.onset_time(record) == pytest.approx(0.10005, abs=1e-4)
    assert found.start == clean.start
    np.testing.assert_allclose(found.value, clean.value, atol=0.01)
    # the row of a window tells what was removed from its record, and nothing is removed from it
    # again
    table = vi.signals.record_table([found], ["peak"])
    assert table.offset[0] == pytest.approx(BASELINES[kind].mean(), abs=0.01)
    assert table["peak"][0] == pytest.approx(np.abs(clean.value).max(), abs=0.01)


def test_packets_are_pieces_of_the_record_without_its_baseline() -> None:
    record = Record("plate", bouncing() + BASELINES["ramp"], RATE, "m/s2")
    clean, found = (
        vi.signals.packet_records(one)
        for one in (Record("plate", bouncing(), RATE, "m/s2"), record)
    )
    assert [one.start for one in found] == [one.start for one in clean]
    np.testing.assert_allclose(
        vi.signals.record_table(found, ["peak"])["peak"],
        vi.signals.record_table(clean, ["peak"])["peak"],
        atol=0.01,
    )
    assert len(vi.signals.find_packets(record, threshold=20.0).onset) == 6


PART = np.arange(2000) / 2000
NOISE = np.random.default_rng(2).standard_normal(2000)
AT_REST = {
    "a half sine": np.sin(np.pi * PART),
    "the force of Hertz": np.sin(np.pi * PART) ** 1.5,
    "a force that fills half of its record": np.sin(np.pi * (2.0 * PART).clip(0.0, 1.0)),
    "a force after a rest": np.sin(np.pi * ((PART - 0.2) / 0.1).clip(0.0, 1.0)),
    "one and a half periods": np.sin(3.0 * np.pi * PART),
    "a decaying tone": np.exp(-8.0 * PART) * np.sin(200.0 * PART),
    "a slow decaying tone": np.exp(-2.0 * PART) * np.sin(37.0 * PART),
    "two tones": np.sin(9.0 * PART) + np.sin(300.0 * PART),
    "noise": NOISE,
    "a velocity that a free plate keeps": (PART > 0.1)
    * (1.0 + 5.0 * np.exp(-20.0 * PART) * np.sin(300.0 * PART)),
    "an undershoot": (PART > 0.1)
    * (5.0 * np.exp(-20.0 * PART) * np.sin(300.0 * PART) - 0.05 * np.exp(-2.0 * PART)),
    "a ramp": PART,
    "a quarter of a sine": np.sin(0.5 * np.pi * PART),
    "an exponential": np.exp(-5.0 * PART),
    "a constant": np.full(2000, 3.0),
    "silence": np.zeros(2000),
    "few samples": np.append(np.full(50, 5.0), [9.0, 3.0]),
}


@pytest.mark.parametrize("kind", AT_REST)
def test_of_a_signal_that_rests_at_zero_nothing_is_removed(kind: str) -> None:
    assert not baseline_of(AT_REST[kind]).any()


@pytest.mark.parametrize(
    "kind", ["an undershoot", "a velocity that a free plate keeps", "a force after a rest"]
)
def test_the_rest_before_the_first_touch_decides(kind: str) -> None:
    np.testing.assert_allclose(baseline_of(AT_REST[kind] + 0.02), 0.02, rtol=1e-6)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_samples_that_are_not_finite_have_no_baseline(wrong: float) -> None:
    assert not baseline_of(np.append(bouncing() + 5.0, wrong)).any()


@pytest.mark.parametrize("scale", [1e-300, 1e-12, 1e290])
def test_a_baseline_scales_with_the_signal(scale: float) -> None:
    value = bouncing() + BASELINES["ramp"]
    np.testing.assert_allclose(
        baseline_of(scale * value) / scale, baseline_of(value), rtol=1e-9, atol=1e-9
    )


def test_baselines_of_random_records() -> None:
    """Of 300 records with an offset, a ramp or an exponential, 97 % are levelled to
    within the noise of an eighth of a block, or 2 %.
    """
    random = np.random.default_rng(3)
    levelled = []
    for _ in range(300):
        samples = int(10.0 ** random.uniform(2.8, 4.4))
        part = np.arange(samples) / samples
        value, at = np.zeros(samples), random.uniform(0.05, 0.3)
        for number in range(random.integers(1, 7)):
            value += tap(
                at,
                0.7**number,
                random.uniform(20.0, samples / 8),
                random.uniform(0.005, 0.03),
                part,
            )
            at += random.uniform(0.08, 0.2)
        value += (noise := 10.0 ** random.uniform(-4.0, -1.3)) * random.standard_normal(samples)
        drifts = (0.0, part, np.exp(-part / random.uniform(0.1, 1.0)))
        baseline = (
            random.uniform(-0.5, 0.5) + random.uniform(-0.5, 0.5) * drifts[random.integers(3)]
        )
        left = baseline_of(value + baseline) - baseline
        levelled.append(np.sqrt(np.mean(left**2)) < max(0.02, 3.0 * noise / np.sqrt(samples / 64)))
        assert not baseline_of(value).any()
    assert np.mean(levelled) >= 0.97


def test_tones_rest_at_zero() -> None:
    """Of 500 tones with 0.5 periods to half as many as samples, decaying or not, at most
    1 % are taken for a baseline in part.
    """
    random = np.random.default_rng(0)
    wrong = []
    for _ in range(500):
        samples = int(10.0 ** random.uniform(1.8, 4.0))
        period, phase = (
            np.exp(random.uniform(np.log(2.1), np.log(2.0 * samples))),
            random.uniform(0.0, 2.0 * np.pi),
        )
        place = np.arange(samples)
        value = np.sin(2.0 * np.pi * place / period + phase) * np.exp(
            -random.choice([0.0, 0.0, 4.0]) * place / samples
        )
        wrong.append(np.abs(baseline_of(value)).max() > 1e-3)
    assert np.mean(wrong) <= 0.01


def test_a_clipped_record_that_drifts_is_seen_to_be_clipped() -> None:
    value = np.clip(bouncing() + BASELINES["ramp"], -60.0, 60.0)
    assert vi.signals.feature_table([value], RATE, ["clipped_part"])["clipped_part"][0] > 1e-4
    # a force that rests below zero is not at an end of a converter's range there
    force = 100.0 * np.sin(np.pi * ((TIME - 0.5) / 0.01).clip(0.0, 1.0))
    assert vi.signals.feature_table([force - 5.0], RATE, ["clipped_part"])["clipped_part"][0] == 0.0


def written(path: Path, **channels: np.ndarray) -> Path:
    np.savetxt(
        path,
        np.stack([TIME, *channels.values()], axis=1),
        "%.9g",
        ",",
        header=f"time [s],{','.join(channels)}",
        comments="",
    )
    return path


def test_the_command_tells_what_it_removed(
    command: Callable[..., tuple[int, str, str]], tmp_path: Path
) -> None:
    table = written(
        tmp_path / "t.csv",
        **{"a [m/s^2]": bouncing() + 5.0, "b [m/s^2]": bouncing(), "c [m/s^2]": bouncing() - 20.0},
    )
    status, out, err = command("features", table, "--only", "packets", "-o", tmp_path / "out.csv")
    assert status == 0
    with (tmp_path / "out.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["packets"]) for row in rows] == [6.0, 6.0, 6.0]
    assert [round(float(row["offset"]), 3) for row in rows] == [5.0, 0.0, -20.0]
    assert [float(row["drift"]) for row in rows] == [0.0, 0.0, 0.0]
    assert "offset removed" in out
    # a twentieth of the peak is no doubt, a fifth is
    assert err.count("warning:") == 1
    assert (
        'an offset of -20 m/s2 was removed from "c", 0.21 times the largest magnitude of '
        "the rest of the record" in " ".join(err.split())
    )
    shown = json.loads(command("features", table, "--only", "packets", "--json")[1])["signals"]
    assert shown[0]["offset"] == pytest.approx(5.0, abs=1e-3)
    many = {f"x{number} [m/s^2]": bouncing() + 50.0 for number in range(12)}
    _, _, err = command("features", written(tmp_path / "many.csv", **many), "--only", "packets")
    assert err.count("warning:") == 11
    assert "there are 2 further warnings" in err


def test_bounces_of_a_microphone_with_an_offset() -> None:
    clean, shifted = (
        vi.signals.find_bounces(Record("microphone", bouncing() + one, RATE, "Pa"))
        for one in (0.0, 30.0)
    )
    np.testing.assert_allclose(shifted.restitution, clean.restitution, atol=1e-6)
    np.testing.assert_allclose(shifted.peak, clean.peak, atol=1e-3)
    assert "an offset of 30 Pa was removed" in shifted.doubts[0]


@pytest.mark.slow
def test_an_identification_through_offsets() -> None:
    heard = records_of(an_impact(0.02, 3.0, (0.06, -0.04)), 40.0, 4)
    shift = {
        one.name: part * float(np.abs(one.value).max())
        for one, part in zip(heard, (0.1, -0.2, 0.05), strict=True)
    }
    clean, shifted = (
        identify_on(
            plate(), [replace(one, value=one.value + share * shift[one.name]) for one in heard]
        )
        for share in (0.0, 1.0)
    )
    for name in ("speed_m_s", "radius_m", "place_x_m", "place_y_m", "max_force_N"):
        deviation = clean.estimates[name].deviation * (
            clean.estimates[name].value if clean.estimates[name].logarithmic else 1.0
        )
        assert abs(shifted.estimates[name].value - clean.estimates[name].value) < 0.2 * deviation, (
            name
        )
    assert [one.offset for one in shifted.measured.removed] == pytest.approx(
        list(shift.values()), rel=0.01
    )
    assert sum("was removed from" in doubt for doubt in shifted.doubts) >= 1


def test_a_correlation_through_offsets_and_drifts() -> None:
    force, value = hammered((0.02, 0.24), 0.45)
    part = np.arange(len(force)) / len(force)
    baselines = np.abs(value).max() * np.stack([0.2 + 0.0 * part, 0.3 * part - 0.1])
    clean = [*records(value), Record("hammer", force, HAMMERED_RATE, "N")]
    shifted = [
        replace(one, value=one.value + shift)
        for one, shift in zip(clean, (*baselines, 20.0), strict=True)
    ]
    found = [
        vi.test_analysis.correlate(hammered_case(), heard[:2], force=heard[2])
        for heard in (clean, shifted)
    ]
    assert found[1].hits == 2
    np.testing.assert_allclose(found[1].frac, found[0].frac, atol=5e-4)
    assert found[1].removed["hammer"].offset == pytest.approx(20.0, abs=0.1)
    assert sum("was removed from" in doubt for doubt in found[1].doubts) == 3


def test_signals_to_be_recognised_are_doubted_where_they_have_offsets() -> None:
    values = np.stack([bouncing()[:4000], bouncing()[:4000] + 20.0, bouncing()[:4000] + 30.0])
    signals: Any = LabelledSignals.__new__(LabelledSignals)
    object.__setattr__(signals, "sensors", {"a1": SensorSignals(values, RATE, "m/s2")})
    (doubt,) = baseline_doubts(signals)
    assert doubt.startswith(
        'from 2 of 3 signals of "a1" baselines with offsets of up to 30 m/s2 were removed, '
        "more than a tenth"
    )


def test_a_record_without_its_baseline_is_left_as_it_is() -> None:
    clean = without_baseline(Record("plate", bouncing() + 5.0, RATE, "m/s2"))
    assert without_baseline(clean) is clean
    assert clean.removed is not None
    np.testing.assert_array_equal(clean.recorded, bouncing() + 5.0)
