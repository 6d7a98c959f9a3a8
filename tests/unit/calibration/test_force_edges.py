"""Force records: when contacts begin and end, the largest force between samples, and
records that are clipped.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import vibroimpact as vi
from contact_forces import force_over_time
from support import plain_case
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.calibration.records.force_record import impacts_in_force

LAWS = {
    "adams-impact": {"law": "adams-impact", "damping_max": 200.0},
    "lankarani-nikravesh": {"law": "lankarani-nikravesh", "restitution": 0.7},
    "hertz": {"law": "hertz"},
}
Floats = np.ndarray


@cache
def forces(law: str) -> tuple[vi.Response, Floats, Floats]:
    """Four impacts, and the force over time in steps of a 3000th of the contacts."""
    response = vi.simulate(
        vi.case_of(plain_case(contact=LAWS[law], drop={"height": 1.0}, run={"impacts": 4}))
    )
    return response, *force_over_time(response, 3001)


def seen_in(
    law: str,
    rate: float,
    noise: float,
    seed: int,
    most: float = np.inf,
    first_speed: float | None = None,
) -> Observations:
    response, times, force = forces(law)
    random = np.random.default_rng(seed)
    time = np.arange(random.uniform() / rate, times[-1], 1.0 / rate)
    sampled = np.interp(time, times, force) + noise * force.max() * random.normal(size=len(time))
    given = {
        "mass": float(response.problem.sphere.mass),
        "gravity": float(response.problem.gravity),
    }
    record = np.minimum(sampled, most * force.max())
    if first_speed is None:
        first_speed = float(response.impacts["approach_speed_m_s"][0])
    return impacts_in_force(time, record, **given, first_speed=first_speed)


def off(
    law: str, rate: float, noise: float, times: int, name: str, column: str
) -> tuple[Floats, Floats]:
    """Relative errors and standard deviations of the impacts but the last, one row per record."""
    exact = forces(law)[0].impacts[column][:3]
    seen = [seen_in(law, rate, noise, seed) for seed in range(times)]
    return (
        np.array([one.wanted[name][:3] for one in seen]) / exact - 1.0,
        np.array([standard_deviations(one.noise[name])[:3] for one in seen]) / exact,
    )


@pytest.mark.slow
@pytest.mark.parametrize("law", list(LAWS))
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_flights_begin_and_end_with_the_contacts(law: str, noise: float) -> None:
    """With the contacts cut at a threshold the speeds were up to 0.04 % too high, and
    with noise of 2 % no interval held.
    """
    apart, deviations = off(
        law, 1e5, noise, 60 if noise else 6, "separation_speed", "separation_speed_m_s"
    )
    assert np.all(np.abs(apart.mean(axis=0)) < 1e-4)
    assert np.all(np.mean(np.abs(apart) <= 1.96 * deviations, axis=0) >= 0.85)
    assert np.mean(np.abs(apart) <= 1.96 * deviations) >= 0.93


def test_edges_at_once() -> None:
    seen = seen_in("adams-impact", 1e5, 0.02, 1)
    exact = forces("adams-impact")[0].impacts["separation_speed_m_s"][:3]
    np.testing.assert_allclose(seen.wanted["separation_speed"][:3], exact, rtol=1.5e-4)


@pytest.mark.parametrize("factor", [0.8, 2.0])
def test_a_record_of_another_drop_than_the_case_has(factor: float) -> None:
    """Its first restitution was wrong by that factor, and the last was scaled with it; what was
    doubted was the scale of the force.
    """
    response = forces("adams-impact")[0]
    speeds = response.impacts["approach_speed_m_s"]
    seen = seen_in("adams-impact", 1e5, 0.002, 3, first_speed=factor * float(speeds[0]))
    assert not seen.of_the_drop
    assert len(seen.labels) == len(seen.speeds) == len(seen.record.pieces)
    assert seen.labels[0].startswith("impact 2, ")
    np.testing.assert_allclose(seen.speeds, speeds[1 : len(seen.speeds) + 1], rtol=3e-4)
    exact = response.impacts["separation_speed_m_s"][1 : len(seen.speeds) + 1]
    deviations = standard_deviations(seen.noise["separation_speed"])
    assert np.all(np.abs(seen.wanted["separation_speed"] - exact) <= 2.6 * deviations)
    (doubt,) = seen.doubts
    by_impulse = float(doubt.partition("an approach speed of ")[2].partition(" m/s")[0])
    assert by_impulse == pytest.approx(speeds[0], rel=5e-3)
    assert f"the drop of the case reaches {factor * speeds[0]:.3g} m/s" in doubt


def test_a_record_of_the_same_drop_keeps_its_first_impact() -> None:
    """Though the height is typed with few digits, and the gain is off."""
    speed = float(forces("adams-impact")[0].impacts["approach_speed_m_s"][0])
    seen = seen_in("adams-impact", 1e5, 0.02, 4, first_speed=1.05 * speed)
    assert seen.of_the_drop
    assert seen.speeds[0] == 1.05 * speed


def test_the_noise_is_part_of_the_deviation() -> None:
    quiet, noisy = (
        standard_deviations(seen_in("hertz", 1e5, noise, 1).noise["separation_speed"])[0]
        for noise in (0.0, 0.04)
    )
    assert noisy > 1.02 * quiet


@pytest.mark.parametrize("law", list(LAWS))
def test_the_largest_force_between_few_samples(law: str) -> None:
    """At 20 kHz a contact of 0.3 ms has six samples: the largest force was 1.6 % too
    small, and half of the intervals held.
    """
    apart, deviations = off(law, 2e4, 0.0, 20, "max_force", "max_force_N")
    assert np.all(np.abs(apart.mean(axis=0)) < 4e-3)
    assert np.mean(np.abs(apart) <= 1.96 * deviations) >= 0.93
    assert any("sample faster" in doubt for doubt in seen_in(law, 2e4, 0.0, 0).doubts)
    assert not any("sample faster" in doubt for doubt in seen_in(law, 1e5, 0.0, 0).doubts)


def test_a_clipped_record() -> None:
    """At 0.8 of the largest force: the first forces were 9 % too small, and mass or
    gravity was doubted.
    """
    seen, exact = (
        seen_in("hertz", 1e5, 0.005, 1, most=0.8),
        forces("hertz")[0].impacts["separation_speed_m_s"],
    )
    assert "max_force" not in seen.wanted
    np.testing.assert_allclose(
        seen.wanted["separation_speed"], exact[: len(seen.speeds)], rtol=2e-4
    )
    (doubt,) = seen.doubts
    assert doubt.startswith("the force is clipped in ")
    assert not any("clipped" in doubt for doubt in seen_in("hertz", 1e5, 0.005, 1).doubts)


def test_one_clipped_impact_is_refused() -> None:
    time = np.arange(0.0, 2e-3, 1e-5)
    pulse = np.minimum(
        np.where((time > 5e-4) & (time < 1e-3), 100.0 * np.sin(np.pi * (time - 5e-4) / 5e-4), 0.0),
        80.0,
    )
    with pytest.raises(
        vi.InputError, match=r"the force is clipped at sample 5.*record again with a larger range$"
    ):
        # from which the sphere does not come back
        impacts_in_force(time, pulse, mass=0.01, gravity=0.0, first_speed=2.0)
    with pytest.raises(
        vi.InputError,
        match=r"the force is clipped at sample 5.*, or up to the next impact, from whose time",
    ):
        impacts_in_force(time, pulse, mass=0.01, gravity=9.8, first_speed=2.0)


def test_a_flight_too_long_is_none_of_the_force() -> None:
    """Speeds that follow from the times of flight do not depend on force and mass."""
    time = np.arange(0.0, 1.0, 1e-5)
    pulse = sum(
        np.where((time > at) & (time < at + 5e-4), 100.0 * np.sin(np.pi * (time - at) / 5e-4), 0.0)
        for at in (0.1, 0.3, 0.8)
    )
    with pytest.raises(
        vi.InputError,
        match=r"impact at sample 300.*; the times can't be right, an impact is missing or is none",
    ) as told:
        impacts_in_force(time, pulse, mass=0.01, gravity=9.8, first_speed=2.0)
    assert "the mass" not in str(told.value)


def test_a_coarse_converter_is_not_clipped() -> None:
    response, times, force = forces("hertz")
    time = np.arange(0.0, times[-1], 1e-5)
    step = force.max() / 128.0
    record = step * np.round(np.interp(time, times, force) / step)
    given = {
        "mass": float(response.problem.sphere.mass),
        "gravity": float(response.problem.gravity),
    }
    seen = impacts_in_force(
        time, record, **given, first_speed=float(response.impacts["approach_speed_m_s"][0])
    )
    assert not any("clipped" in doubt for doubt in seen.doubts)
