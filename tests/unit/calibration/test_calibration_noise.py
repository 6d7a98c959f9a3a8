"""Intervals of what is calibrated to noisy measurements, by repeating them: the truth lies inside
as often as is stated.

Where only statistics are looked at, the model is a restitution: its impacts are exact and take no
time. How noise of a record becomes noise of a speed is looked at on records of Adams' IMPACT.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from scipy.stats import binom

import vibroimpact as vi
from support import plain_case
from vibroimpact.bodies.rigid_bodies import rigid_plate
from vibroimpact.calibration.contact_law.calibrate import calibrate
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.calibration.observed.observations import Observations, from_heights, from_table
from vibroimpact.calibration.records.force_record import impacts_in_force
from vibroimpact.calibration.records.joint_flights import _CONTACT_DEVIATION
from vibroimpact.calibration.records.position_record import impacts_in_position
from vibroimpact.contact.laws.newton import Newton

GRAVITY, RADIUS, TOP = 9.8, 0.025, 4.0
COEFFICIENTS = (0.5, 0.06, -0.003)
TIMES = 300
Floats = np.ndarray


def truth(speeds: Floats) -> Floats:
    """The restitution of the material that is measured."""
    return np.polynomial.polynomial.polyval(speeds, COEFFICIENTS)


def drop(impacts: int = 5) -> vi.Problem:
    ball = vi.Body(mass=0.09, contact_offset=RADIUS)
    return vi.Problem(
        sphere=ball,
        plate=rigid_plate(),
        laws=(Newton(restitution=0.7),),
        gravity=GRAVITY,
        height=TOP,
        impacts=impacts,
    )


def bounces(number: int = 5) -> tuple[Floats, Floats]:
    """Approach speeds and rebound heights of the material."""
    speeds = [np.sqrt(2.0 * GRAVITY * (TOP - RADIUS))]
    for _ in range(number):
        speeds.append(speeds[-1] * truth(speeds[-1]))
    return np.array(speeds[:-1]), RADIUS + np.array(speeds[1:]) ** 2 / (2.0 * GRAVITY)


SPEEDS, HEIGHTS = bounces()
RANGE = np.linspace(1.0, 9.0, 8)


def heights(random: np.random.Generator, *, known: bool, size: float = 2e-3) -> Observations:
    measured, deviation = (
        HEIGHTS + size * random.normal(size=5),
        np.full(5, size) if known else None,
    )
    return from_heights(
        measured, deviation, first_speed=float(SPEEDS[0]), radius=RADIUS, gravity=GRAVITY
    )


def restitutions(random: np.random.Generator, *, known: bool, part: float = 0.02) -> Observations:
    exact = RANGE * truth(RANGE)
    wanted = {"separation_speed": exact * (1.0 + part * random.normal(size=8))}
    return from_table(
        RANGE,
        wanted,
        {"separation_speed": part * exact} if known else None,
        tuple(f"row {row}" for row in range(8)),
    )


@cache  # several tests look at the same repetitions
def repeated(
    measure: Callable[..., Observations],
    *,
    known: bool,
    confidence: float = 0.95,
    times: int = TIMES,
) -> list[Calibration]:
    seen = (measure(np.random.default_rng(seed), known=known) for seed in range(times))
    return [calibrate(drop(), one, bootstrap=0, confidence=confidence) for one in seen]


def check_coverage(inside: Floats, confidence: float = 0.95, level: float = 1e-3) -> None:
    """As many of the repetitions (first axis) hold the truth as a binomial distribution
    allows, in each column.
    """
    times = len(inside)
    low, high = binom.ppf([level / 2.0, 1.0 - level / 2.0], times, confidence)
    assert high < times, "too few repetitions to see intervals that are too wide"
    count = np.sum(inside, axis=0)
    assert np.all(count >= low), (count, low)
    assert np.all(count <= high), (count, high)


def holds_values(found: list[Calibration], exact: Floats) -> Floats:
    return np.array(
        [(one.intervals[:, 0] <= exact) & (exact <= one.intervals[:, 1]) for one in found]
    )


def holds_coefficients(found: list[Calibration], confidence: float = 0.95) -> Floats:
    return np.array(
        [
            np.abs(np.array(one.fit.function.coefficients) - COEFFICIENTS)
            <= one.fit.half_widths(confidence)
            for one in found
        ]
    )


def scatter_over_stated(found: list[Calibration]) -> Floats:
    """Scatter of the coefficients over the repetitions, over their standard errors."""
    stated = np.sqrt(np.mean([np.diag(one.fit.covariance) for one in found], axis=0))
    return np.std([one.fit.function.coefficients for one in found], axis=0) / stated


@pytest.mark.slow
@pytest.mark.parametrize("confidence", [0.95, pytest.param(0.8, marks=pytest.mark.whole)])
@pytest.mark.parametrize(
    ("measure", "exact"),
    [
        pytest.param(heights, truth(SPEEDS), id="heights"),
        pytest.param(restitutions, truth(RANGE), id="restitutions", marks=pytest.mark.slow),
    ],
)
def test_known_deviations(
    measure: Callable[..., Observations], exact: Floats, confidence: float
) -> None:
    found = repeated(measure, known=True, confidence=confidence)
    check_coverage(holds_values(found, exact), confidence)
    check_coverage(holds_coefficients(found, confidence), confidence)
    np.testing.assert_allclose(scatter_over_stated(found), 1.0, atol=0.15)
    stated = np.mean([np.diff(one.intervals, axis=1)[:, 0] for one in found], axis=0)
    quantile = 2.0 * found[0].fit.quantile(confidence)
    np.testing.assert_allclose(
        np.std([one.values for one in found], axis=0) * quantile / stated, 1.0, atol=0.15
    )


@pytest.mark.parametrize("measure", [pytest.param(heights, marks=pytest.mark.slow), restitutions])
@pytest.mark.slow
def test_unknown_deviations(measure: Callable[..., Observations]) -> None:
    """The scatter about the polynomial tells their size, with the quantiles of Student's
    distribution.
    """
    found = repeated(measure, known=False)
    check_coverage(holds_coefficients(found))
    np.testing.assert_allclose(scatter_over_stated(found), 1.0, atol=0.15)
    freedom = (5 if measure is heights else 8) - 3
    assert all(one.fit.freedom == freedom for one in found)
    sizes = np.mean([one.fit.scatter**2 for one in found]) ** 0.5
    assert sizes == pytest.approx(2e-3 if measure is heights else 0.02, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("times", [120, TIMES])
def test_a_reading_that_two_impacts_share_counts_once(times: int) -> None:
    """A height is what one impact leaves with and the next comes with: the errors of
    their restitutions are opposite.
    """
    found = repeated(heights, known=True, confidence=0.95, times=times)
    values = np.array([one.values for one in found])
    assert np.all(
        np.array([np.corrcoef(values[:, row], values[:, row + 1])[0, 1] for row in range(4)]) < -0.3
    )


@pytest.mark.parametrize("known", [True, False])
def test_bootstrap_and_first_order_agree_where_both_hold(known: bool) -> None:
    """First order is a closed form; of noise whose size is estimated it has the quantiles
    of Student's distribution.
    """
    seen = heights(np.random.default_rng(1), known=known)
    first, drawn = (calibrate(drop(), seen, bootstrap=draws) for draws in (0, 4000))
    assert (first.bootstrap, drawn.bootstrap) == (0, 4000)
    assert first.fit.freedom == (np.inf if known else 2)
    np.testing.assert_allclose(np.diff(drawn.intervals), np.diff(first.intervals), rtol=0.08)
    np.testing.assert_allclose(
        drawn.intervals.mean(axis=1), first.intervals.mean(axis=1), rtol=1e-3
    )
    np.testing.assert_allclose(drawn.fit.half_widths(0.95), first.fit.half_widths(0.95), rtol=0.08)
    assert drawn.fit.function == first.fit.function


def test_the_same_seed_draws_the_same() -> None:
    seen = heights(np.random.default_rng(1), known=True)
    one, same, other = (
        calibrate(drop(), seen, bootstrap=50, seed=seed).intervals for seed in (3, 3, 4)
    )
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, other)


def nearly_elastic(random: np.random.Generator, damping: float) -> Observations:
    """Restitutions of Adams' IMPACT with a damping whose noise reaches below zero."""
    speeds = np.array([2.0, 4.0, 6.0])
    exact = speeds * (1.0 - damping * np.array([1.55e-3, 1.5e-3, 1.45e-3]))
    wanted = {"separation_speed": np.minimum(exact * (1.0 + 0.01 * random.normal(size=3)), speeds)}
    return from_table(
        speeds, wanted, {"separation_speed": 0.01 * exact}, ("slow", "medium", "fast")
    )


@pytest.mark.slow
def test_at_the_end_of_the_range_it_bootstraps_by_itself() -> None:
    """First order ends at no damping, and is not believed there."""
    problem = vi.case_of(
        plain_case(contact={"law": "adams-impact", "damping_max": 5.0}, run={"impacts": 1})
    ).to_problem()
    seen = nearly_elastic(np.random.default_rng(2), 5.0)
    found, first = (
        calibrate(problem, seen, degree=0),
        calibrate(problem, seen, degree=0, bootstrap=0),
    )
    assert found.bootstrap >= 100
    assert first.intervals.min() == 0.0, "where the damping ends"
    assert np.all(found.intervals >= 0.0)
    assert np.all(found.intervals[:, 0] <= found.values)
    assert np.all(found.values <= found.intervals[:, 1])
    assert any("does not determine damping_max" in doubt for doubt in found.doubts)


def test_what_the_measurement_does_not_determine_is_told() -> None:
    vague = calibrate(
        drop(), restitutions(np.random.default_rng(3), known=True, part=0.6), degree=0, bootstrap=0
    )
    assert any("does not determine restitution" in doubt for doubt in vague.doubts)
    sharp = calibrate(
        drop(), restitutions(np.random.default_rng(3), known=True, part=0.001), bootstrap=0
    )
    assert not sharp.doubts


def test_a_degree_that_the_measurement_does_not_call_for_is_told() -> None:
    seen = restitutions(np.random.default_rng(4), known=True, part=0.02)
    assert any(
        "does not justify degree 5" in doubt
        for doubt in calibrate(drop(), seen, degree=5, bootstrap=0).doubts
    )
    assert not calibrate(drop(), seen, degree=2, bootstrap=0).doubts


def test_a_degree_that_does_not_follow_the_measurement_is_told_and_widens_the_intervals() -> None:
    seen = restitutions(np.random.default_rng(4), known=True, part=0.02)
    line, parabola = (calibrate(drop(), seen, degree=degree, bootstrap=0) for degree in (1, 2))
    assert any("does not fit the measurement" in doubt for doubt in line.doubts)
    assert line.fit.freedom == 6
    assert parabola.fit.freedom == np.inf


def test_as_many_impacts_as_coefficients_and_no_deviation() -> None:
    found = calibrate(drop(), heights(np.random.default_rng(5), known=False), degree=4)
    assert any("their uncertainty is unknown" in doubt for doubt in found.doubts)
    assert found.intervals is None
    assert np.isnan(found.fit.covariance).all()


@pytest.mark.slow
def test_weighted_set_with_known_deviations() -> None:
    """Force and rebound of Adams' IMPACT, both noisy: the damping of each impact is as
    uncertain as it scatters.
    """
    problem = vi.case_of(
        plain_case(contact={"law": "adams-impact", "damping_max": 150.0}, run={"impacts": 1})
    ).to_problem()
    run, random = vi.simulate(problem).impacts, np.random.default_rng(6)
    exact = {"separation_speed": run["separation_speed_m_s"], "max_force": run["max_force_N"]}
    sizes, number = {"separation_speed": 0.01, "max_force": 0.01}, 120
    wanted = {
        name: value[0] * (1.0 + sizes[name] * random.normal(size=number))
        for name, value in exact.items()
    }
    deviations = {name: np.full(number, sizes[name] * value[0]) for name, value in exact.items()}
    seen = from_table(
        np.full(number, run["approach_speed_m_s"][0]),
        wanted,
        deviations,
        tuple(f"{row}" for row in range(number)),
    )
    found = calibrate(
        problem, seen, weights={"separation_speed": 1.0, "max_force": 1.0}, degree=0, bootstrap=0
    )
    low, high = binom.ppf([5e-4, 1.0 - 5e-4], number, 0.95)
    inside = np.sum((found.intervals[:, 0] <= 150.0) & (found.intervals[:, 1] >= 150.0))
    assert low <= inside <= high
    assert np.std(found.values) == pytest.approx(
        np.mean(np.diff(found.intervals)) / (2.0 * 1.96), rel=0.25
    )
    # 3.3 standard deviations
    assert abs(found.fit.function.coefficients[0] - 150.0) <= 1.7 * found.fit.half_widths(0.95)[0]
    np.testing.assert_allclose(
        found.fit.half_widths(0.95)[0] * np.sqrt(number),
        np.mean(np.diff(found.intervals)) / 2.0,
        rtol=0.25,
    )


# --- records
#
#
#
# -----------------------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return vi.simulate(
        vi.case_of(
            plain_case(
                contact={"law": "adams-impact", "damping_max": 200.0},
                drop={"height": 1.0},
                run={"impacts": 4},
            )
        )
    )


@pytest.mark.slow
@pytest.mark.parametrize(("rate", "size"), [(1000.0, 1e-4), (200.0, 1e-3)])
def test_position_records(response: vi.Response, rate: float, size: float) -> None:
    """The tops of three flights, and the speed of the first impact; the duration of
    contact is expected with the error that is assumed.
    """
    record, impacts, inside = response.sample(rate), response.impacts, []
    given = {"radius": RADIUS, "gravity": float(response.problem.gravity), "first_speed": 1.0}
    contact = float(impacts["duration_s"][0] * impacts["approach_speed_m_s"][0] ** 0.2)
    for seed in range(TIMES):
        random = np.random.default_rng(seed)
        noisy = record["position_m"] + size * random.normal(size=len(record["time_s"]))
        expected = contact / max(1.0 + _CONTACT_DEVIATION * random.normal(), 0.2)
        seen = impacts_in_position(record["time_s"], noisy, **given, contact_duration=expected)
        found = np.append(seen.speeds[0], seen.wanted["rebound_height"][:3])
        noise = np.vstack(
            [seen.speed_noise.toarray()[0], seen.noise["rebound_height"].toarray()[:3]]
        )
        exact = np.append(impacts["approach_speed_m_s"][0], impacts["rebound_height_m"][:3])
        inside.append(np.abs(found - exact) <= 1.96 * np.linalg.norm(noise, axis=1))
    check_coverage(np.array(inside))


def test_impulse_of_a_force_record_of_one_impact(response: vi.Response) -> None:
    """Slow enough a sampling for noise not to end the pulse early."""
    impacts, inside, forces = response.impacts, [], []
    begin, duration = float(impacts["time_s"][0]), float(impacts["duration_s"][0])
    given = {
        "mass": float(response.problem.sphere.mass),
        "gravity": float(response.problem.gravity),
    }
    fine = np.arange(begin - 6.0 * duration, begin + 7.0 * duration, 1e-7)
    force = response.at(fine)["force_N"]
    for seed in range(TIMES):
        random = np.random.default_rng(seed)
        time = np.arange(
            begin - 5.0 * duration + random.uniform() * 2e-5, begin + 6.0 * duration, 2e-5
        )
        noisy = np.interp(time, fine, force) + 20.0 * random.normal(size=len(time))
        seen = impacts_in_force(
            time, noisy, **given, first_speed=float(impacts["approach_speed_m_s"][0])
        )
        off = seen.wanted["separation_speed"][0] - impacts["separation_speed_m_s"][0]
        inside.append(abs(off) <= 1.96 * standard_deviations(seen.noise["separation_speed"])[0])
        forces.append(seen.wanted["max_force"][0] / impacts["max_force_N"][0] - 1.0)
    check_coverage(np.array(inside)[:, None])
    assert np.mean(forces) == pytest.approx(0.0, abs=3e-3)
