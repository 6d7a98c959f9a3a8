"""Spheres that come to rest on what vibrates, or do not, against scipy's DOP853 on the same modal
equations: two files of oracles.

oracles/modal_integration.py follows a drop from contact to contact; oracles/riding_integration.py
takes spheres on that were said to rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from balls_at_rest import at_rest, random_drop, random_held_drop
from oracles.riding_integration import largest_gaps
from vibrating import drop_on, modes_of, oracle
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh

AGAINST = Against(
    "SciPy's DOP853, spheres in persistent contact with a vibrating plate",
    "own independent computation",
    "impacts on vibrating bodies",
    "tests/oracles/modal_integration.py and riding_integration.py, tolerance 1e-12",
)


THIN = {
    "sphere": {"radius": "47.9 mm", "material": "rock-paper"},
    "plate": {
        "size": [0.477, 0.765, 0.0025],
        "material": "steel-paper",
        "model": "elastic",
        "modes": 40,
        "damping": 0.001,
        "supports": "simply-supported",
    },
    "drop": {"height": 0.18, "position": [-0.014, 0.041]},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.5},
    "run": {"impacts": 5},
}


@pytest.mark.slow
def test_a_thin_plate_throws_its_ball_again(agrees: Agrees) -> None:
    """It has nine tenths of the energy when the ball leaves it at 5 mm/s for the first
    time; 11 ms later the ball leaves it at 1 m/s.
    """
    problem = replace(vi.case_of(THIN).to_problem(), tolerance=1e-11)
    response = vi.simulate(problem)
    assert response.outcomes == (vi.Outcome.IMPACTS,)
    contacts = int(response.impacts["contacts"][0])
    visit = oracle(problem).run(contacts)
    assert len(visit) == contacts == 3
    assert visit[0].separation_speed < 0.005  # where it was once said to rest
    found = (
        response.impacts[name][0] for name in ("duration_s", "separation_speed_m_s", "max_force_N")
    )
    expected = (visit[-1].end, visit[-1].separation_speed, max(touch.max_force for touch in visit))
    for quantity, unit, ours, theirs in zip(
        ("contact duration", "separation speed", "maximum contact force"),
        ("s", "m/s", "N"),
        found,
        expected,
        strict=True,
    ):
        agrees(
            "repeated contacts with a thin vibrating plate",
            quantity,
            ours,
            theirs,
            unit=unit,
            relative=1e-6,
        )
    assert response.impacts["separation_speed_m_s"][0] == pytest.approx(0.98468, rel=1e-4)


@pytest.mark.slow
def test_springs_of_3_hz_give_a_heavy_ball_back(agrees: Agrees) -> None:
    """33 kg on a plate of 2 kg: ten contacts, the last of 0.7 s in which the springs are
    wound up and let go.
    """
    law = LankaraniNikravesh(stiffness=1e10, restitution=0.2)
    plate, ball = modes_of([3.0], [2.0**-0.5]), vi.Body(mass=33.0, contact_offset=0.15)
    # at 1e-12 as at 1e-13, 1e-10 and 1e-9; at 1e-11 the moment at which they part, without any
    # speed, adds 2e-8
    problem = replace(drop_on(law, plate, height=1.18, impacts=1, tolerance=1e-12), sphere=ball)
    response = vi.simulate(problem)
    visit = oracle(problem, longest=2.0, step=1e-2).run(10)
    assert response.impacts["contacts"].tolist() == [10]
    duration, speed = (
        float(response.impacts[name][0]) for name in ("duration_s", "separation_speed_m_s")
    )
    # they part without any speed between them, so that the moment is known less well than the
    # flight that begins there
    case, exact = (
        "heavy sphere on a spring-supported plate of 3 Hz, ten contacts",
        visit[-1].separation_speed + 9.8 * visit[-1].end,
    )
    agrees(
        case,
        "separation speed, extrapolated ballistically to the start of the impact",
        speed + 9.8 * duration,
        exact,
        unit="m/s",
        relative=1e-8,
    )
    agrees(case, "separation speed", speed, visit[-1].separation_speed, unit="m/s", relative=2e-6)
    agrees(case, "contact duration", duration, visit[-1].end, unit="s", relative=2e-6)
    assert visit[-1].separation_speed == pytest.approx(4.0449, rel=1e-4)


def at_rest_of(agrees: Agrees, drops: dict[str, vi.Problem]) -> int:
    """Nothing is made, what is left is said, and in a second none that rests leaves by
    more than its static indentation; how many rest.
    """
    balls = {}
    for seed, problem in drops.items():
        response = vi.simulate(problem)
        outcome = response.outcomes[0]
        assert response.energy["written_off_at_rest_J"] >= -1e-12 * response.energy["input_J"], seed
        assert response.energy["closure_relative"] < 1e-7, seed
        if outcome.at_rest:
            assert (
                "J are left in vibration, too little at the contact to lift it" in response.status
            ), seed
            assert response.rest.left[0] >= 0.0, seed
            balls[seed] = at_rest(response)
    slowest_first = sorted(balls, key=lambda seed: float(balls[seed].omega.max()))
    # the fastest mode sets the steps of all that are integrated together
    for first in range(0, len(balls), 10):
        some = slowest_first[first : first + 10]
        gaps = largest_gaps([balls[seed] for seed in some], 1.0)
        assert not [seed for seed, gap in zip(some, gaps, strict=True) if gap > balls[seed].sag]
        parts = [max(gap, 0.0) / balls[seed].sag for seed, gap in zip(some, gaps, strict=True)]
        agrees(
            "random drops, one second after the detection of rest",
            "maximum gap, normalized by the static indentation",
            parts,
            0.0,
            absolute=1.0,
        )
    return len(balls)


@pytest.mark.slow
def test_a_drop_at_random_on_a_plate_on_one_patch(agrees: Agrees) -> None:
    assert at_rest_of(agrees, {"held 291": random_held_drop(291)}) == 1


@pytest.mark.slow
def test_three_hundred_drops_at_random(agrees: Agrees, population: Callable[..., int]) -> None:
    drops = {f"any {seed}": random_drop(seed) for seed in range(population(276, share=20))}
    drops |= {
        f"held {seed}": random_held_drop(seed)
        for seed in range(276, 276 + population(24, share=20))
    }
    assert at_rest_of(agrees, drops) >= population(80, share=20)
