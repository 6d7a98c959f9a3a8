"""Force records whose level at rest drifts: the stated interval of a rebound covers the
truth as often as it says.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import binom

import vibroimpact as vi
from support import one_in, plain_case
from vibroimpact.calibration.observed.noise import standard_deviations
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.calibration.records.force_record import impacts_in_force

TIMES = 120
PART = 0.02  # of the largest force, that a drift comes to
Floats = np.ndarray


@pytest.fixture(scope="module")
def response() -> vi.Response:
    return vi.simulate(
        vi.case_of(
            plain_case(
                contact={"law": "adams-impact", "damping_max": 200.0},
                drop={"height": 1.0},
                run={"impacts": 3},
            )
        )
    )


@pytest.fixture(scope="module")
def force(response: vi.Response) -> Callable[[Floats], Floats]:
    """The force over time from before the first impact until after it, interpolated in
    steps of 0.1 us, a 3000th of the contact.
    """
    begin, duration = float(response.impacts["time_s"][0]), float(response.impacts["duration_s"][0])
    time = np.arange(begin - 6.0 * duration, begin + 12.0 * duration, 1e-7)
    return partial(np.interp, xp=time, fp=response.at(time)["force_N"])


def ramp(time: Floats, force: Floats, _: np.random.Generator) -> Floats:
    """A charge amplifier that is not yet warm."""
    return force + PART * force.max() * (time - time[0]) / (time[-1] - time[0])


def settling(time: Floats, force: Floats, _: np.random.Generator) -> Floats:
    """One that was reset shortly before."""
    return force + PART * force.max() * np.exp(-(time - time[0]) / (0.3 * (time[-1] - time[0])))


def discharge(time: Floats, force: Floats, _: np.random.Generator) -> Floats:
    """Its time constant, of 30 contacts: the level is lower by 2 % after the impact, by
    what the impact itself discharged.
    """
    decay = np.exp(-(time[1] - time[0]) / (30.0 * 3.1e-4))
    return lfilter([decay, -decay], [1.0, -decay], force)


def wander(time: Floats, force: Floats, random: np.random.Generator) -> Floats:
    """Hum, of a period of 20 contacts."""
    return force + PART * force.max() * np.sin(
        2.0 * np.pi * (time / (20.0 * 3.1e-4) + random.uniform())
    )


def none(_: Floats, force: Floats, __: np.random.Generator) -> Floats:
    return force


def measured(
    response: vi.Response,
    exact: Callable[[Floats], Floats],
    drift: Callable[..., Floats],
    seed: int,
) -> Observations:
    """The first impact, with noise of 0.5 % of its largest force, five contacts before
    it, and ten after.
    """
    impacts, random = response.impacts, np.random.default_rng(seed)
    begin, duration = float(impacts["time_s"][0]), float(impacts["duration_s"][0])
    time = np.arange(
        begin - 5.0 * duration + random.uniform() * 1e-5, begin + 11.0 * duration, 1e-5
    )
    force = drift(time, exact(time), random) + 20.0 * random.normal(size=len(time))
    given = {
        "mass": float(response.problem.sphere.mass),
        "gravity": float(response.problem.gravity),
    }
    return impacts_in_force(
        time, force, **given, first_speed=float(impacts["approach_speed_m_s"][0])
    )


@pytest.mark.parametrize(
    "drift", one_in(2, [none, ramp, settling, discharge, wander], lambda drift: drift.__name__)
)
def test_the_interval_covers_the_truth(
    response: vi.Response, force: Callable[[Floats], Floats], drift: Callable[..., Floats]
) -> None:
    """At least as often as a binomial distribution of 95 % allows once in a thousand
    times; and it is no wider than twice the scatter.
    """
    exact, found = (
        float(response.impacts["separation_speed_m_s"][0]),
        [measured(response, force, drift, seed) for seed in range(TIMES)],
    )
    off = np.array([seen.wanted["separation_speed"][0] - exact for seen in found])
    stated = np.array([standard_deviations(seen.noise["separation_speed"])[0] for seen in found])
    assert np.count_nonzero(np.abs(off) <= 1.96 * stated) >= binom.ppf(1e-3, TIMES, 0.95)
    assert stated.mean() < 2.0 * np.sqrt(np.mean(off**2))
    forces = np.array([seen.wanted["max_force"][0] for seen in found]) / float(
        response.impacts["max_force_N"][0]
    )
    assert np.mean(forces) == pytest.approx(1.0, abs=6e-3)


def test_a_level_that_no_parabola_follows_is_told(
    response: vi.Response, force: Callable[[Floats], Floats]
) -> None:
    def steps(time: Floats, force: Floats, random: np.random.Generator) -> Floats:
        return force + 2.0 * PART * force.max() * np.sin(
            2.0 * np.pi * (time / (2.0 * 3.1e-4) + random.uniform())
        )

    seen = measured(response, force, steps, 3)
    assert any("the force at rest wanders by" in doubt for doubt in seen.doubts)
    assert not any("wanders" in doubt for doubt in measured(response, force, ramp, 3).doubts)


def test_a_drift_over_a_long_record(response: vi.Response) -> None:
    """Three impacts in a record whose level rises by 6 % of the largest force; the offset
    is no impact.
    """
    impacts = response.impacts
    time = np.arange(0.0, float(impacts["time_s"][2]) + 0.05, 2e-5)
    force = response.at(time)["force_N"] * (time < impacts["time_s"][2] + 0.01)
    force = (
        force
        + 0.06 * force.max() * (time / time[-1])
        + 10.0 * np.random.default_rng(0).normal(size=len(time))
    )
    given = {
        "mass": float(response.problem.sphere.mass),
        "gravity": float(response.problem.gravity),
        "first_speed": 4.3726,
    }
    seen = impacts_in_force(time, force, **given)
    assert len(seen.speeds) == 3
    np.testing.assert_allclose(
        seen.wanted["separation_speed"], impacts["separation_speed_m_s"], rtol=0.02
    )
    np.testing.assert_allclose(seen.wanted["max_force"], impacts["max_force_N"], rtol=0.01)


def test_a_record_that_breaks_off_in_an_impact_still_tells_the_flight_before(
    response: vi.Response,
) -> None:
    impacts = response.impacts
    time = np.arange(0.0, float(impacts["time_s"][2]) + 1e-4, 2e-5)
    given = {
        "mass": float(response.problem.sphere.mass),
        "gravity": float(response.problem.gravity),
        "first_speed": 4.3726,
    }
    seen = impacts_in_force(time, response.at(time)["force_N"], **given)
    assert len(seen.speeds) == 2
    np.testing.assert_allclose(
        seen.wanted["separation_speed"], impacts["separation_speed_m_s"][:2], rtol=5e-4
    )
