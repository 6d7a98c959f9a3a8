"""A sphere that rides, or rests, on what vibrates: where its run ends, what is said of
it, and how both go on.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from balls_at_rest import random_drop
from support import one_in
from vibrating import STIFFNESS, drop_on, modes_of
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.jkr import JKR
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.motion.columns import LEDGER, VIBRATION_LEDGER
from vibroimpact.dynamics.vibrating import drop_at_start, drops
from vibroimpact.dynamics.vibrating.contact_equilibrium import ContactEquilibrium
from vibroimpact.dynamics.vibrating.drop_system import centre_of, system_of
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.rest_motion import bring_to_rest

LOSSY = LankaraniNikravesh(stiffness=STIFFNESS, restitution=0.5)
PAIR = ContactPair(2.4264724e9, 0.025, 0.09032078879, 8e7, 0.28)
LAWS = [law for law in contact_laws().values() if issubclass(law, CompliantLaw)]
SPRUNG = modes_of([6.0, 240.0, 900.0], [1.2, 1.5, -1.0], 0.03)


def unbalanced(response: vi.Response, history: dict[str, np.ndarray]) -> float:
    return float(
        np.abs(
            sum(history[name] for name in (*LEDGER, *VIBRATION_LEDGER)) / response.energy["input_J"]
            - 1.0
        ).max()
    )


@pytest.mark.parametrize("law", one_in(6, LAWS, lambda law: law.name))
def test_every_law_comes_to_rest_on_a_sprung_plate(law: type[CompliantLaw]) -> None:
    """It chatters, rides and lies; the ledger closes to the end, nothing is made, and the
    sphere is not seen to jump.
    """
    plate = modes_of([8.0, 240.0], [1.2, 1.5], 0.1)
    response = vi.simulate(
        drop_on(law.example(PAIR), plate, height=0.026, impacts=None, duration=0.8)
    )
    assert response.outcomes[0].at_rest
    history = response.history()
    assert unbalanced(response, history) < 1e-7
    assert response.energy["written_off_at_rest_J"] >= 0.0
    at_once = np.diff(history["time_s"]) <= 1e-15
    assert (
        np.abs(np.diff(history["position_m"])[at_once]).max()
        <= 2.0 * np.nan_to_num(np.abs(response.rest.sag[0])) + 1e-12
    )


def test_what_is_left_is_said() -> None:
    response = vi.simulate(drop_on(LOSSY, SPRUNG, height=0.2, impacts=None))
    assert response.outcomes == (vi.Outcome.CAPTURED,)
    left = float(response.rest.left[0])
    assert left > 1e-4
    assert (
        f"{left:.3g} J are left in vibration, too little at the contact to lift it."
        in response.status
    )


def test_a_batch_says_what_is_left() -> None:
    """Of the drops that rest, the most; and of those whose duration ends in a ride, how
    many these are.
    """
    batch = drop_on(
        LOSSY, SPRUNG, height=np.array([0.2, 0.03, 0.1, 0.5]), impacts=None, duration=0.3
    )
    response = vi.simulate(batch)
    left = [vi.simulate(batch.take(drop)).rest.left[0] for drop in range(4)]
    for found in (response.rest.left, vi.tabulate(batch).rest.left):
        # it is what is left when the sphere is seen to lie, at the end of a stretch: where these
        # end differs by rounding in a batch
        np.testing.assert_allclose(found, left, rtol=1e-6)
    riding = f"3 of 4 drops: duration (1 of them riding, at most {left[2]:.3g} J left in vibration)"
    assert (
        response.status
        == f"{riding}; 1 of 4 drops: at rest: contact without release (at most {left[1]:.3g} "
        "J left in vibration)"
    )


def test_plate_and_sphere_end_where_their_weight_puts_them() -> None:
    """The plate carries the sphere: twenty seconds later it lies C m g deeper than
    without, and the sphere in it.
    """
    response = vi.simulate(drop_on(LOSSY, SPRUNG, height=0.2, impacts=None, duration=20.0))
    end, weight = response.at(20.0), 0.09032078879 * 9.8
    compliance = float(((SPRUNG.contact / SPRUNG.angular_frequencies) ** 2).sum())
    sag = (weight / STIFFNESS) ** (2.0 / 3.0)
    assert end["plate_deflection_m"] == pytest.approx(-compliance * weight, rel=1e-3)
    assert end["position_m"] == pytest.approx(0.025 - compliance * weight - sag, rel=1e-6)
    assert end["force_N"] == pytest.approx(weight, rel=1e-3)
    assert unbalanced(response, response.history()) < 1e-7
    assert response.energy["plate_strain_J"] == pytest.approx(
        0.5 * compliance * weight**2, rel=1e-3
    )
    assert response.energy["potential_J"] == pytest.approx(
        -weight * (compliance * weight + sag), rel=1e-3
    )


def test_rest_is_the_motion_of_both_together() -> None:
    """scipy's LSODA goes on with the contact as it is; the closed form agrees with it to
    what is not linear in the contact.
    """
    response = vi.simulate(drop_on(LOSSY, SPRUNG, height=0.2, impacts=None, duration=2.0))
    lying, begun = response.rest.lying[0], float(response.rest.time[0])
    assert lying is not None
    start, speed, omega, shape = (
        lying.start,
        lying.equilibrium.local.approach_speed,
        SPRUNG.angular_frequencies,
        SPRUNG.contact,
    )

    def slopes(_: float, y: np.ndarray) -> np.ndarray:
        displacement, velocity = y[2:5], y[5:]
        force = float(
            sum(LOSSY.forces(max(y[0] + shape @ displacement, 0.0), y[1] + shape @ velocity, speed))
        )
        push = -omega * (0.06 * velocity + omega * displacement) - shape * force
        return np.concatenate([[y[1], 9.8 - force / 0.09032078879], velocity, push])

    times = np.linspace(0.0, 0.3, 400)
    fall = [float(part) for part in centre_of(start, 0.09032078879)]
    begins = np.concatenate([fall, start.displacement[1:], start.velocity[1:]])
    found = solve_ivp(slopes, (0.0, 0.3), begins, "LSODA", times, rtol=1e-8, atol=1e-14).y
    history = response.at(begun + times)
    for seen, expected in (
        (history["position_m"], 0.025 - found[0]),
        (history["plate_deflection_m"], shape @ found[2:5]),
    ):
        np.testing.assert_allclose(seen, expected, atol=0.02 * np.ptp(expected))


HEAVY = replace(
    drop_on(replace(LOSSY, stiffness=1e10), modes_of([3.0], [0.7]), height=1.18),
    sphere=vi.Body(mass=33.0, contact_offset=0.15),
)


def test_a_ride_ends_at_the_duration() -> None:
    """Not when the contact is over, as one of usual length does: this one takes 0.7 s."""
    response = vi.simulate(replace(HEAVY, duration=0.9))
    assert response.outcomes == (vi.Outcome.DURATION,)
    assert response.end_time[0] == pytest.approx(0.9, abs=1e-12)
    assert "the sphere rides on the plate and is not at rest" in response.status
    assert np.isnan(response.impacts["separation_speed_m_s"][-1])
    assert unbalanced(response, response.history()) < 1e-6


def test_a_ride_is_not_followed_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drop_at_start, "MOST_STEPS", 60)
    response = vi.simulate(HEAVY)
    assert response.outcomes == (vi.Outcome.RIDING,)
    assert not response.outcomes[0].at_rest
    assert "rides on the plate and is not at rest" in response.status
    assert f"{float(response.rest.left[0]):.3g} J left in vibration" in response.status
    assert unbalanced(response, response.history()) < 1e-6


def test_codes_in_files_stay() -> None:
    """New outcomes come last."""
    assert [outcome.name for outcome in vi.Outcome][:9] == [
        *(
            "IMPACTS",
            "DURATION",
            "REST_SPEED",
            "CAPTURED",
            "STUCK",
            "LEFT",
            "LIMIT",
            "FAILED",
            "RIDING",
        )
    ]


def test_a_sensor_on_a_plate_that_carries_the_sphere() -> None:
    """It reads what the history says, under the contact, before rest and after."""
    plate = SPRUNG
    sensor = vi.sensors.Sensor(name="a", rate=1e4, quantity="displacement", filter="none")
    response = vi.simulate(
        drop_on(LOSSY, plate, height=0.2, impacts=None, duration=2.0, sensors=(sensor,))
    )
    signal = response.signals()["a"]
    assert response.rest.time[0] < 1.5
    np.testing.assert_allclose(
        signal.value, response.at(signal.time)["plate_deflection_m"], atol=1e-13
    )


def test_a_contact_does_not_end_where_the_surfaces_do_not_part() -> None:
    """A first, rough solution of a stretch of this ride wobbles through zero, where once
    all was lost that the contact holds.
    """
    response = vi.simulate(replace(random_drop(29), duration=0.7))
    assert response.energy["closure_relative"] < 1e-10


def ball_on_modes(modes: int, seed: int) -> LinearSystem:
    random = np.random.default_rng(seed)
    omega = np.exp(random.uniform(3.0, 9.0, modes))
    plate = modes_of(omega / (2.0 * np.pi), random.normal(size=modes), 0.01)
    problem = vi.Problem(
        sphere=vi.Body(mass=0.1, contact_offset=0.01),
        plate=replace(vi.rigid_plate(), modes=plate),
        laws=LOSSY,
        speed=1.0,
    )
    return system_of(problem, 0.1, 9.81)


@pytest.mark.parametrize("seed", range(5))
def test_laying_down_makes_no_energy(seed: int) -> None:
    """Wherever everything is: far, fast, apart or deep."""
    random, system = np.random.default_rng(seed), ball_on_modes(5, seed)
    local = LocalContact(
        JKR.example(PAIR) if seed % 2 else Hertz(stiffness=1e9), QuasiStatic(), 1.0
    )
    equilibrium = ContactEquilibrium(system, local)
    for size in (1e-7, 1e-5, 1e-3):
        at = equilibrium.state
        moved = size * random.normal(size=(2, 6))
        moved[:, 0] *= 0.1**0.5
        state = State(at.displacement + moved[0], [1.0, *[100.0] * 5] * moved[1], at.local)
        approach = float(system.approach(state)[0])
        stored = (
            float(local.elastic_energy(np.array([approach]))[0])
            if approach > local.release_level
            else 0.0
        )
        lying = bring_to_rest(equilibrium, state, stored)
        assert lying.written_off >= -1e-12 * equilibrium.excess(state, stored)
        now = lying.state(np.zeros(1))
        kept = equilibrium.excess(now.take(0), float(lying.stored(np.zeros(1))[0]))
        assert kept + lying.written_off == pytest.approx(
            equilibrium.excess(state, stored), rel=1e-6
        )


def test_the_bound_of_the_force_is_met_and_not_passed() -> None:
    """By the linear motion, over many periods."""
    equilibrium = ContactEquilibrium(
        replace(ball_on_modes(4, 1), damping_ratio=np.zeros(5)),
        LocalContact(Hertz(stiffness=1e9), QuasiStatic(), 1.0),
    )
    at = equilibrium.state
    state = replace(
        at,
        displacement=at.displacement + 1e-8 * np.arange(5.0),
        velocity=1e-5 * np.array([0.0, 1.0, 1.0, 1.0, 1.0]),
    )
    lying = bring_to_rest(equilibrium, state, equilibrium.stored)
    bound = equilibrium.force_bound(lying.state(np.zeros(1)[0]))
    seen = np.abs(lying.force(np.linspace(0.0, 200.0, 400_001)) - equilibrium.weight).max()
    assert 0.9 * bound < seen <= bound * (1.0 + 1e-9)


def test_a_write_off_of_less_than_nothing_fails_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    entries_of = drops._entries

    def with_less(drop: object) -> tuple[dict[str, float], float]:
        entries, added = entries_of(drop)
        entries["written_off_at_rest_J"] -= 1.0
        entries["contact_dissipated_J"] += 1.0
        return entries, added

    monkeypatch.setattr(drops, "_entries", with_less)
    problem = vi.Problem(
        sphere=vi.Body(mass=1.0, contact_offset=0.1),
        plate=vi.rigid_plate(),
        laws=(LOSSY,),
        height=0.2,
        rest_speed=0.01,
        local_element=(1e9, 1e3),  # drops of rigid bodies call no function of Python
    )
    with pytest.raises(
        vi.ComputationError,
        match=r"was set to rest with .* J more than it and the bodies below it had left",
    ):
        vi.simulate(replace(problem, impacts=None))


def test_a_ledger_that_does_not_close_fails_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "vibroimpact.dynamics.rigid.drops._energy_of",
        lambda problem, drops, start: np.full(len(drops.phases), 1.0),
    )
    problem = vi.Problem(
        sphere=vi.Body(mass=1.0, contact_offset=0.1),
        plate=vi.rigid_plate(),
        laws=(LOSSY,),
        height=0.2,
    )
    with pytest.raises(vi.ComputationError, match="the energy ledger does not close"):
        vi.simulate(problem)


def test_a_sphere_that_rests_where_it_first_touches_says_so() -> None:
    """Without a time of flight there is nothing of which the time of rest could be uncertain."""
    response = vi.simulate(
        vi.Problem(
            sphere=vi.Body(mass=1.0, contact_offset=0.1),
            plate=vi.rigid_plate(),
            laws=(vi.laws.Newton(restitution=0.0),),
            speed=1.0,
        )
    )
    assert response.status.startswith("At rest after 1 impact")
