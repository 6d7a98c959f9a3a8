"""Against the geometric series of a hard ball's bounces: t_inf = sqrt(2h/g) (1+e)/(1-e).
Tolerance 1e-6.
"""

from __future__ import annotations

import math

import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.newton import Newton

AGAINST = Against(
    "bouncing ball with constant coefficient of restitution, geometric series",
    "closed form",
    "flight, bounces and shaken plates",
    "total time t = sqrt(2 h/g) (1 + e)/(1 - e); ratio of successive heights e²",
)


@pytest.mark.parametrize(("restitution", "expected"), [(0.5, 1.354571), (0.9, 8.578949)])
def test_infinitely_many_bounces(agrees: Agrees, restitution: float, expected: float) -> None:
    ball = vi.Body(mass=1.0, contact_offset=0.1)
    law = Newton(restitution=restitution)
    response = vi.simulate(
        vi.Problem(
            sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=1.1, gravity=9.81, impacts=None
        )
    )
    assert response.outcomes == (vi.Outcome.REST_SPEED,)
    series = math.sqrt(2 / 9.81) * (1 + restitution) / (1 - restitution)
    agrees(
        "infinitely many bounces",
        "time to rest",
        response.rest.time[0],
        series,
        unit="s",
        relative=1e-12,
    )
    agrees(
        "infinitely many bounces",
        "time to rest, printed value",
        response.rest.time[0],
        expected,
        unit="s",
        absolute=1e-6,
    )
    assert "(rest-speed rule)" in response.status
    assert response.energy["closure_relative"] <= 1e-9


def test_heights_fall_by_the_square(agrees: Agrees) -> None:
    ball = vi.Body(mass=1.0, contact_offset=0.1)
    response = vi.simulate(
        vi.Problem(
            sphere=ball,
            plate=vi.rigid_plate(),
            laws=(Newton(restitution=0.8),),
            height=1.1,
            impacts=20,
        )
    )
    heights = response.impacts["rebound_height_m"] - 0.1
    agrees(
        "coefficient of restitution 0.8, 20 bounces",
        "rebound height",
        heights,
        [0.64**k for k in range(1, 21)],
        unit="m",
        relative=1e-12,
    )
