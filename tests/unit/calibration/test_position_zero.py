"""Position records whose zero, drift and clock are off: what the record itself determines
is corrected, and is part of the intervals.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import tomli_w

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.observed.noise import scaled, standard_deviations
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.calibration.records.position_record import impacts_in_position

GRAVITY, RADIUS = 9.80665, 0.008
HERTZ = 5.5e-5  # s, of steel on steel at 1 m/s
TIMES = 300
Floats = np.ndarray


class Track(NamedTuple):
    """Times on the clock of the record [s], positions [m], and the speeds of the impacts [m/s]."""

    time: Floats
    position: Floats
    speeds: Floats

    @property
    def restitution(self) -> Floats:
        return self.speeds[1:] / self.speeds[:-1]


def track(
    number: int = 4,
    *,
    restitution: float = 0.7,
    height: float = 0.5,
    rate: float = 240.0,
    contact: float = 0.0,
    held: float = 0.0,
    zero: Callable[[Floats], Floats] | float = 0.0,
    clock: float = 1.0,
    phase: float = 0.0,
) -> Track:
    """A drop by Galilei's law, with contacts of Hertz's duration over the speed in which
    the sphere dips; the last flight is cut short.
    """
    fall = float(np.sqrt(2.0 * (height - RADIUS) / GRAVITY))
    speeds, pieces, begin = [GRAVITY * fall], [], fall
    for _ in range(number):
        before, after = speeds[-1], restitution * speeds[-1]
        touch, leave = begin, begin + contact * before**-0.2
        pieces.append((touch, leave, before, after))
        begin = leave + 2.0 * after / GRAVITY
        speeds.append(after)
    time = np.arange(phase / rate - held, begin - 0.6 * speeds[-1] / GRAVITY, 1.0 / rate)
    position = height - 0.5 * GRAVITY * np.maximum(time, 0.0) ** 2
    for touch, leave, before, after in pieces:
        since = time - leave
        position = np.where(
            since >= 0.0, RADIUS + after * since - 0.5 * GRAVITY * since**2, position
        )
        inside = (time >= touch) & (time < leave)
        part = (time[inside] - touch) / max(leave - touch, 1e-30)
        position[inside] = RADIUS - np.sin(np.pi * part) * (leave - touch) / np.pi * (
            before + (after - before) * part
        )
    return Track(
        clock * time, position + (zero(time) if callable(zero) else zero), np.array(speeds)
    )


def seen_in(
    made: Track, noise: Floats | float = 0.0, contact: float | None = HERTZ
) -> Observations:
    return impacts_in_position(
        made.time,
        made.position + noise,
        radius=RADIUS,
        gravity=GRAVITY,
        first_speed=float(made.speeds[0]),
        contact_duration=contact,
    )


def restitutions(seen: Observations) -> tuple[Floats, Floats]:
    """Restitutions and their standard deviations, from the heights, the speeds and their
    common noise.
    """
    left = np.sqrt(2.0 * GRAVITY * (seen.wanted["rebound_height"] - RADIUS))
    found = left / seen.speeds
    noise = scaled(GRAVITY / left / seen.speeds, seen.noise["rebound_height"]) - scaled(
        found / seen.speeds, seen.speed_noise
    )
    return found, standard_deviations(noise)


def random_track(random: np.random.Generator) -> tuple[Track, Observations]:
    """A record with zero, drift, clock, contacts, noise and everything else at random."""
    zero, drift = random.uniform(-2e-3, 2e-3), random.uniform(-1e-3, 1e-3)
    made = track(
        int(random.integers(2, 6)),
        restitution=random.uniform(0.55, 0.85),
        height=random.uniform(0.3, 1.0),
        rate=float(random.choice([120.0, 240.0, 500.0, 1000.0])),
        contact=HERTZ * random.uniform(0.5, 2.0),
        zero=lambda time: zero + drift * time,
        clock=1.0 + 3e-3 * random.normal(),
        phase=random.uniform(),
    )
    return made, seen_in(
        made,
        np.exp(random.uniform(np.log(3e-5), np.log(4e-4))) * random.normal(size=len(made.time)),
    )


def deviates() -> Floats:
    """How far restitutions of random records are off, in standard deviations, one of each
    record.
    """
    found = []
    for seed in range(TIMES):
        random = np.random.default_rng(seed)
        made, seen = random_track(random)
        values, deviations = restitutions(seen)
        off = (values - made.restitution[: len(values)]) / deviations
        found.append(off[random.integers(len(off))])
    return np.array(found)


@pytest.mark.parametrize("zero", [1e-3, -1e-3])
def test_a_zero_that_is_off(zero: float) -> None:
    """The restitutions were 0.7007 to 0.7062, and 0.6993 to 0.6936, with intervals of 1e-9."""
    seen = seen_in(track(zero=zero))
    values, deviations = restitutions(seen)
    np.testing.assert_allclose(values, 0.7, rtol=1e-7)
    assert np.all(np.abs(values - 0.7) <= 1.96 * deviations)
    assert seen.corrections["zero"].value == pytest.approx(zero, abs=1e-8)
    assert any("Successive flights meet" in note for note in seen.notes)
    assert any("the zero of the positions is off by" in doubt for doubt in seen.doubts)


@pytest.mark.parametrize("zero", [1e-3, -1e-3])
def test_a_zero_that_is_off_under_noise(zero: float) -> None:
    values, deviations = restitutions(
        seen_in(track(zero=zero), 3e-4 * np.random.default_rng(7).normal(size=len(track().time)))
    )
    assert np.all(np.abs(values - 0.7) <= 2.6 * deviations)
    assert np.all(deviations < 0.02)


def test_a_zero_that_drifts() -> None:
    """By 1.3 mm in a second, as a floor in the picture of a camera that tilts."""
    seen = seen_in(track(zero=lambda time: 1.3e-3 * time))
    np.testing.assert_allclose(restitutions(seen)[0], 0.7, rtol=1e-7)
    assert seen.corrections["drift"].value == pytest.approx(1.3e-3, abs=1e-8)


def test_one_impact_determines_the_zero_and_says_that_it_takes_it_as_constant() -> None:
    seen = seen_in(track(1, zero=1e-3), contact=0.0)
    np.testing.assert_allclose(restitutions(seen)[0], 0.7, rtol=1e-7)
    assert any("one impact does not tell whether it drifts" in note for note in seen.notes)


def test_one_flight_alone_takes_the_zero_as_right_and_says_so() -> None:
    """The record begins two samples before the first touch, so that nothing meets the
    flight after it.
    """
    made = track(1, restitution=0.9, contact=HERTZ)
    begin = int(np.argmin(made.position[:100])) - 2
    seen = seen_in(made._replace(time=made.time[begin:], position=made.position[begin:]))
    assert seen.corrections["zero"] == (0.0, 0.0, "m")
    (doubt,) = (doubt for doubt in seen.doubts if "one flight alone" in doubt)
    assert "1 mm changes the restitution by 0.13 %" in doubt
    assert restitutions(seen)[0] == pytest.approx(0.9, rel=1e-6)


def test_a_clock_that_runs_fast() -> None:
    """By 3 %: such a record was refused. Heights of rebound do not depend on the clock,
    and speeds follow from them.
    """
    made = track(zero=1e-3, clock=1.03)
    seen = seen_in(made)
    np.testing.assert_allclose(restitutions(seen)[0], 0.7, rtol=1e-7)
    np.testing.assert_allclose(seen.speeds, made.speeds[:4], rtol=1e-7)
    assert seen.corrections["clock"].value == pytest.approx(1.03, abs=1e-7)
    (doubt,) = (doubt for doubt in seen.doubts if "curve as under" in doubt)
    assert "9.244 m/s^2, not 9.807 m/s^2" in doubt
    assert "3 % too fast" in doubt


def test_lengths_that_are_wrong_make_the_speeds_wrong_by_what_is_said() -> None:
    """A scale that is 2 % too large looks like a clock that runs 1 % too slowly, and
    makes the speeds 1 % too high.
    """
    made = track(zero=1e-3)
    seen = impacts_in_position(
        made.time,
        1.02 * made.position,
        radius=1.02 * RADIUS,
        gravity=GRAVITY,
        first_speed=float(made.speeds[0]),
        contact_duration=HERTZ,
    )
    too_fast = 100.0 * float(np.mean(seen.speeds / made.speeds[:4]) - 1.0)
    (doubt,) = (doubt for doubt in seen.doubts if "curve as under" in doubt)
    assert too_fast == pytest.approx(1.0, abs=0.02)
    assert f"all speeds taken from it are {too_fast:+.2g} % off" in doubt


def test_a_clock_in_another_unit_is_refused() -> None:
    made = track()
    with pytest.raises(
        vi.InputError, match=r"curve as under .* its unit, time and gravity those of the record"
    ):
        seen_in(made._replace(time=1.5 * made.time))


def test_a_sphere_that_is_held_before_it_falls() -> None:
    """The fall begins where it is released; such a record was refused."""
    made = track(held=0.5, zero=1e-3)
    values, deviations = restitutions(
        seen_in(made, 1e-4 * np.random.default_rng(0).normal(size=len(made.time)))
    )
    assert np.all(np.abs(values - 0.7) <= 2.6 * deviations)
    assert values[0] == pytest.approx(0.7, abs=3e-4)


@pytest.mark.parametrize("zero", [1e-3, -1e-3])
def test_a_sphere_that_comes_to_rest(zero: float) -> None:
    """What lies beyond the last rebound that stands out is no flight, wherever the zero is."""
    made = track(14, restitution=0.6)
    rest = np.full(200, RADIUS)
    time = np.concatenate([made.time, made.time[-1] + np.arange(1, 201) / 240.0])
    noise = 1e-4 * np.random.default_rng(1).normal(size=len(time))
    seen = seen_in(Track(time, np.concatenate([made.position, rest]) + zero, made.speeds), noise)
    values, deviations = restitutions(seen)
    assert np.all(np.abs(values - 0.6) <= 2.6 * deviations)


def test_contacts_that_are_long() -> None:
    """Rubber: successive flights cross below the plate; if that is taken as the zero, the
    fourth restitution is off by 0.02.
    """
    made = track(contact=3e-3)
    seen = seen_in(made, 1e-5 * np.random.default_rng(2).normal(size=len(made.time)), contact=4e-3)
    values, deviations = restitutions(seen)
    assert np.all(np.abs(values - 0.7) <= 2.6 * deviations)
    assert abs(seen.corrections["zero"].value) <= 2.6 * seen.corrections["zero"].deviation


def test_many_samples_in_a_contact() -> None:
    made = track(contact=HERTZ, rate=1e5, zero=1e-3)
    values, deviations = restitutions(
        seen_in(made, 1e-4 * np.random.default_rng(3).normal(size=len(made.time)))
    )
    assert np.all(np.abs(values - 0.7) <= 2.6 * deviations)
    assert np.all(deviations < 1e-4)


def test_levels_that_no_line_follows_are_told_and_widen_the_intervals() -> None:
    made = track(5, zero=lambda time: 1.3e-3 * np.sin(2.0 * np.pi * time))
    seen = seen_in(made, 1e-4 * np.random.default_rng(4).normal(size=len(made.time)))
    values, deviations = restitutions(seen)
    assert any("scatter by" in doubt for doubt in seen.doubts)
    assert np.all(np.abs(values - 0.7) <= 2.6 * deviations)


@pytest.mark.slow
def test_intervals_with_zero_drift_and_clock_free() -> None:
    """Of 300 random records 93 to 98 % hold the truth within the interval of 95 %."""
    off = deviates()
    assert 0.93 <= np.mean(np.abs(off) <= 1.96) <= 0.98
    assert abs(np.mean(off)) < 4.0 / np.sqrt(TIMES)


@pytest.mark.slow
def test_no_dependence_on_speed_appears() -> None:
    """Under noise of 0.3 mm and a zero that is off by 1 mm, the slope of the restitution
    over the speed is 0 within 95 % as often.
    """
    inside = []
    for seed in range(TIMES):
        random = np.random.default_rng(seed)
        made = track(zero=random.choice([-1e-3, 1e-3]), phase=random.uniform())
        seen = seen_in(made, 3e-4 * random.normal(size=len(made.time)))
        left = np.sqrt(2.0 * GRAVITY * (seen.wanted["rebound_height"] - RADIUS))
        values = left / seen.speeds
        noise = scaled(GRAVITY / left / seen.speeds, seen.noise["rebound_height"]) - scaled(
            values / seen.speeds, seen.speed_noise
        )
        covariance = (noise @ noise.T).toarray()
        powers, weights = np.vander(seen.speeds, 2), np.linalg.inv(covariance)
        spread = np.linalg.inv(powers.T @ weights @ powers)
        slope = (spread @ powers.T @ weights @ values)[0]
        inside.append(abs(slope) <= 1.96 * np.sqrt(spread[0, 0]))
    assert 0.91 <= np.mean(inside) <= 0.98


def calibrated(
    folder: Path, made: Track, noise: Floats | float = 0.0, height: float = 0.5
) -> tuple[Calibration, dict]:
    rows = "".join(
        f"{at:.9g},{value:.9g}\n"
        for at, value in zip(made.time, made.position + noise, strict=True)
    )
    (folder / "track.csv").write_text("time_s,position_m\n" + rows)
    case = plain_case(
        sphere={"radius": RADIUS, "material": "steel"},
        plate={"material": "steel"},
        drop={"height": height},
        contact={"law": "newton", "restitution": 0.5},
        calibrate={"target": str(folder / "track.csv"), "degree": 0, "air": False},
    )
    what = calibration_of(case)
    found = calibrate_case(what)
    assert isinstance(found, Calibration)
    place = found.save(folder / "out")
    return found, json.loads((place / "calibration.json").read_text())


def test_calibration_to_a_record_whose_zero_is_off(tmp_path: Path) -> None:
    found, document = calibrated(tmp_path, track(zero=1e-3))
    np.testing.assert_allclose(found.values, 0.7, rtol=1e-5)
    assert np.all((found.intervals[:, 0] <= 0.7) & (found.intervals[:, 1] >= 0.7))
    assert document["corrections"]["zero"]["value"] == pytest.approx(1e-3, abs=1e-6)
    assert document["corrections"]["zero"]["unit"] == "m"
    assert "meet 1.000" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    apart = found.overlays[0].measured[1] - found.overlays[0].simulated[1]
    assert np.nanmax(np.abs(apart)) < 1e-6, (
        "what is drawn over the simulation is the corrected record"
    )


def test_what_remains_is_of_the_drop_that_was_measured(tmp_path: Path) -> None:
    """The first touch is at 1.40 m/s, and the case says 0.3 m: up to 165 % remained of a
    record without a flaw.
    """
    found, document = calibrated(tmp_path, track(height=0.108), height=0.3)
    assert found.observations.speeds[0] == pytest.approx(1.4005, abs=1e-4)
    off = document["differences"]["rebound_height_m"]
    assert set(off) == {"constant", "variable", "function"}
    assert all(len(values) == 4 and np.max(np.abs(values)) < 1e-6 for values in off.values())
    (doubt,) = (doubt for doubt in found.doubts if "first impact that was measured" in doubt)
    assert "is at 1.4 m/s, and that of the drop at 2.393 m/s" in doubt
    speeds = [row["approach_speed_m_s"] for row in document["impacts"]]
    assert speeds[0] == pytest.approx(2.393, abs=1e-3), (
        "the case that is written is the drop of the case"
    )


def test_what_remains_of_the_same_drop(tmp_path: Path) -> None:
    """A record of the drop of the case, with noise, is of that drop."""
    made = track()
    found, document = calibrated(
        tmp_path, made, 3e-4 * np.random.default_rng(5).normal(size=len(made.time))
    )
    assert not any("first impact that was measured" in doubt for doubt in found.doubts)
    assert [row["value"] for row in document["impacts"]] == found.values.tolist()
    assert np.max(np.abs(document["differences"]["rebound_height_m"]["variable"])) < 1e-6


def test_calibration_on_the_command_line(
    tmp_path: Path, command: Callable[..., tuple[int, str, str]]
) -> None:
    calibrated(tmp_path, track(zero=-1e-3))
    case = plain_case(
        contact={"law": "newton", "restitution": 0.5},
        calibrate={"target": "track.csv", "degree": 0, "air": False},
    )
    case["sphere"] = {"radius": RADIUS, "material": "steel"}
    (tmp_path / "case.toml").write_text(tomli_w.dumps(case))
    status, out, _ = command("calibrate", "case.toml", "-o", "found")
    assert status == 0
    assert "1.000" in out
    assert "Successive flights meet" in " ".join(out.split())
