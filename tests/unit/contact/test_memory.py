"""Contacts that remember: how deep they get, where they rest, when they end."""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from support import one_in
from vibroimpact.contact.laws.adams_poisson import AdamsPoisson
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.contact.laws.storakers import Storakers
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.contact.laws.walton_braun import WaltonBraun
from vibroimpact.contact.roots import find_root

NUMBER = 200


def random_laws(random: np.random.Generator) -> list[vi.laws.ContactLaw]:
    modulus, radius = 10 ** random.uniform(6, 11, NUMBER), 10 ** random.uniform(-3, -1, NUMBER)
    strength = modulus * 10 ** random.uniform(-5, -2, NUMBER)
    return [
        Thornton(effective_modulus=modulus, effective_radius=radius, yield_pressure=strength),
        Storakers(
            effective_modulus=modulus,
            effective_radius=radius,
            yield_strength=strength,
            hardening_exponent=random.uniform(1.1, 50, NUMBER),
        ),
        WaltonBraun(
            stiffness=10 ** random.uniform(2, 7, NUMBER), restitution=random.uniform(0.1, 1, NUMBER)
        ),
    ]


@pytest.mark.parametrize("tolerance", one_in(2, [1e-9, 1e-12]))
def test_depth_under_gravity_is_that_of_the_energy_put_in(tolerance: float) -> None:
    """The closure of the ledger can't see a contact that is stopped too early; the
    balance at its deepest point can.
    """
    random = np.random.default_rng(1)
    for law in random_laws(random):
        mass, speed, gravity = (
            10 ** random.uniform(-6, 1, NUMBER),
            10 ** random.uniform(-4, 1, NUMBER),
            10 ** random.uniform(-1, 3, NUMBER),
        )
        ball = vi.Body(mass=mass, contact_offset=0.1)
        problem = vi.Problem(
            sphere=ball,
            plate=vi.rigid_plate(),
            laws=(law,),
            speed=speed,
            gravity=gravity,
            impacts=1,
            tolerance=tolerance,
        )
        found = vi.simulate(problem).impacts["max_indentation_m"][:, 0]

        energy, weight = 0.5 * mass * speed**2, mass * gravity

        def excess(delta: np.ndarray, law=law, energy=energy, weight=weight) -> np.ndarray:
            return law.loading_work(delta) - weight * delta - energy

        high = np.full(NUMBER, 1e-12)
        while (short := excess(high) < 0.0).any():
            high = np.where(short, 2.0 * high, high)
        np.testing.assert_allclose(found, find_root(excess, 0.5 * high, high), rtol=1e-7)


def test_a_drop_of_a_batch_does_not_feel_its_neighbours() -> None:
    law, ball = (
        WaltonBraun(stiffness=437.0, restitution=0.27),
        vi.Body(mass=9.3e-7, contact_offset=1e-3),
    )
    weight = 9.3e-7 * vi.Problem.gravity
    expected = (weight + np.sqrt(weight**2 + 437.0 * 9.3e-7 * 1e-10)) / 437.0
    for neighbour in (1e-2, 1e-3, 3e-4, 1e-5):
        problem = vi.Problem(
            sphere=ball, plate=vi.rigid_plate(), laws=(law,), speed=[1e-5, neighbour], impacts=1
        )
        assert vi.simulate(problem).impacts["max_indentation_m"][0, 0] == pytest.approx(
            expected, rel=1e-9
        )


@pytest.mark.parametrize("time", [1e-10, 2e-9, 5e-9, 1e-7])
def test_a_zero_of_the_force_next_to_the_end_is_found(time: float) -> None:
    ball, law = (
        vi.Body(mass=0.05, contact_offset=0.02),
        KuwabaraKono(stiffness=1e9, dissipation_time=time),
    )
    response = vi.simulate(
        vi.Problem(
            sphere=ball,
            plate=vi.rigid_plate(),
            laws=(law,),
            speed=1.0,
            gravity=0.0,
            impacts=1,
            duration=1.0,
        )
    )
    row = response.impacts
    end = 1.5 * time * row["separation_speed_m_s"][0]  # where delta^1.5 = 1.5 A sqrt(delta) v
    assert -(response.at([row["duration_s"][0]])["position_m"][0] - 0.02) == pytest.approx(
        end, rel=1e-5
    )


def test_a_ball_that_its_law_can_not_lift_rests_in_its_penalty() -> None:
    law = AdamsPoisson(penalty=1e4, restitution=0.1)
    response = vi.simulate(
        vi.Problem(
            sphere=vi.Body(mass=1.0, contact_offset=0.1),
            plate=vi.rigid_plate(),
            laws=(law,),
            speed=0.2,
            impacts=None,
        )
    )
    assert response.outcomes == (vi.Outcome.CAPTURED,)
    assert response.rest.sag[0] == pytest.approx(9.80665e-4, rel=1e-9)
    assert response.history()["indentation_m"].max() == pytest.approx(
        response.impacts["max_indentation_m"][0], rel=1e-12
    )
    assert response.energy["closure_relative"] < 1e-9
