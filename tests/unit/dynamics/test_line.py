"""The contact of two rigid bodies as the core follows it: the order of its steps, their
events, and the motion within them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import DOP853

import vibroimpact as vi
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.core import dormand_prince
from vibroimpact.dynamics.core.line import CAPTURED, line_under
from vibroimpact.dynamics.core.line_records import LineState
from vibroimpact.dynamics.core.line_step import BY_FLOW, BY_RATE, BY_ROOT, IMPLICIT, advance
from vibroimpact.dynamics.motion.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.rigid.line_contact import RecordedContact

PAIR = ContactPair(
    effective_modulus=1e11,
    effective_radius=0.01,
    effective_mass=0.1,
    yield_strength=3e8,
    poissons_ratio=0.3,
)
LAWS = sorted(name for name, law in contact_laws().items() if issubclass(law, CompliantLaw))


def contact(
    law: CompliantLaw, speed: float = 1.0, gravity: float = 9.8, tolerance: float = 1e-12
) -> RecordedContact:
    return RecordedContact.of(
        impact_conditions_of(law, np.array([0.1]), np.array([gravity]), np.array([speed])),
        tolerance,
    )


def test_coefficients_are_those_of_scipy() -> None:
    np.testing.assert_allclose(dormand_prince.STAGE_WEIGHTS[:-1], DOP853.A, rtol=1e-15)
    np.testing.assert_allclose(dormand_prince.STAGE_WEIGHTS[-1], DOP853.B, rtol=1e-15)
    np.testing.assert_allclose(dormand_prince.ERROR_OF_ORDER_5, DOP853.E5, rtol=1e-15)
    np.testing.assert_allclose(dormand_prince.ERROR_OF_ORDER_3, DOP853.E3, rtol=1e-15)


@pytest.mark.parametrize("variable", [BY_FLOW, BY_ROOT, BY_RATE])
def test_a_step_has_order_8(variable: int) -> None:
    """The error of a motion of given length in 1 to 8 steps, against 64 steps; Lankarani
    and Nikravesh's force is damped.
    """
    recorded = contact(
        vi.laws.find_contact_law("lankarani-nikravesh")(stiffness=1.0, restitution=0.5),
        gravity=1e-3,
    )
    line, stages = line_under(recorded.law, recorded.manner), np.empty((4, 13))

    def march(steps: int) -> LineState:
        state = LineState(0.0, 0.2, 0.4, 0.0)
        for _ in range(steps):
            state = advance(
                line,
                variable,
                state,
                {BY_FLOW: 0.08, BY_ROOT: 0.02, BY_RATE: -0.2}[variable] / steps,
                stages,
            ).state
        return state

    exact, counts = march(64), np.array([1, 2, 4, 8])
    for quantity in range(4):
        errors = np.array([abs(march(int(count))[quantity] - exact[quantity]) for count in counts])
        seen = errors > 1e-14
        if seen.sum() >= 2:
            order = -np.polyfit(np.log(counts[seen]), np.log(errors[seen]), 1)[0]
            assert order > 6.9, (quantity, errors)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("speed", [0.01, 5.0])
def test_the_tolerance_is_kept(name: str, speed: float) -> None:
    law = vi.laws.find_contact_law(name).example(PAIR)
    exact = contact(law, speed, tolerance=1e-13).contact
    for tolerance in (1e-6, 1e-9, 1e-11):
        found = contact(law, speed, tolerance=tolerance).contact
        assert found.outcome == exact.outcome
        allowed = 3.0 * tolerance + 1e-12
        assert found.end.time == pytest.approx(exact.end.time, rel=allowed)
        assert found.deepest == pytest.approx(exact.deepest, rel=allowed)
        assert found.peak_force == pytest.approx(exact.peak_force, rel=3.0 * allowed)
        assert found.end.rate == pytest.approx(
            exact.end.rate, rel=10.0 * allowed, abs=10.0 * allowed * speed
        )
        assert found.end.lost == pytest.approx(exact.end.lost, abs=10.0 * allowed * 0.05 * speed**2)


@pytest.mark.parametrize("name", LAWS)
def test_motion_between_events_obeys_the_equation_of_motion(name: str) -> None:
    """By differences, at times of all parts of the contact, in any order."""
    law = vi.laws.find_contact_law(name).example(PAIR)
    recorded = contact(law, 2.0)
    span = recorded.contact.end.time
    times = np.random.default_rng(1).permutation(span * np.linspace(0.05, 0.95, 37))
    aside = 1e-4 * span
    delta, rate, _ = recorded.motion(times)
    before, after = recorded.motion(times - aside), recorded.motion(times + aside)
    scale = np.abs(rate).max()
    np.testing.assert_allclose(
        (after[0] - before[0]) / (2.0 * aside), rate, rtol=0, atol=1e-6 * scale
    )
    laws = law, law.after_compression(recorded.contact.deepest)
    loading = times < recorded.contact.time_of_deepest
    static, dissipative = (
        np.where(loading, *parts)
        for parts in zip(*(one.forces(delta, rate, 2.0) for one in laws), strict=True)
    )
    force = static + dissipative
    if law.tension == "cut":
        force = np.maximum(force, 0.0)
    # a law with a memory has a corner there
    away = np.abs(times - recorded.contact.time_of_deepest) > 2.0 * aside
    for corner in recorded.corners():
        away &= np.abs(times - corner) > 2.0 * aside
    acceleration = (after[1] - before[1]) / (2.0 * aside)
    np.testing.assert_allclose(
        acceleration[away],
        (9.8 - force / 0.1)[away],
        rtol=0,
        atol=2e-6 * np.abs(acceleration).max(),
    )


@pytest.mark.parametrize(
    "name", ["hunt-crossley", "kuwabara-kono", "krijt", "adams-poisson", "linear-spring-dashpot"]
)
def test_the_moment_of_capture_depends_on_no_step(name: str) -> None:
    law = vi.laws.find_contact_law(name).example(PAIR)
    found = [contact(law, 1e-3, tolerance=tolerance).contact for tolerance in (1e-8, 1e-10, 1e-12)]
    assert {one.outcome for one in found} == {CAPTURED}
    np.testing.assert_allclose([one.end.time for one in found], found[-1].end.time, rtol=1e-6)


def test_a_force_that_hardly_lets_go_takes_more_steps() -> None:
    """Of a restitution of 1e-3 the bodies creep apart a thousand times more slowly than
    they came.
    """
    law = vi.laws.find_contact_law("hunt-crossley")(stiffness=1e9, dissipation=200.0)
    recorded = contact(law, 1.0, gravity=0.0, tolerance=1e-9)
    exact = contact(law, 1.0, gravity=0.0, tolerance=1e-12)
    assert recorded.contact.end.rate == pytest.approx(exact.contact.end.rate, rel=1e-6)
    assert -recorded.contact.end.rate < 0.01
    assert (
        recorded.steps.written[0]
        > 1.5
        * contact(vi.laws.find_contact_law("hertz")(stiffness=1e9), tolerance=1e-9).steps.written[0]
    )


def test_creep_is_followed_in_implicit_steps() -> None:
    """Against the closed form of an overdamped oscillator that sinks to its static
    indentation in a time of 20 s.
    """
    stiffness, damping, mass, gravity, speed = 50.0, 1e3, 0.1, 9.8, 1.0
    recorded = contact(
        vi.laws.find_contact_law("linear-spring-dashpot")(stiffness=stiffness, damping=damping),
        speed,
        tolerance=1e-9,
    )
    steps = int(recorded.steps.written[0])
    assert IMPLICIT in recorded.steps.variable[:steps]
    assert steps < 10_000
    times = np.concatenate([np.geomspace(1e-6, 1e-3, 20), np.linspace(0.01, 100.0, 40)])
    delta, rate, lost = recorded.motion(times)
    middle = damping / (2.0 * mass)
    half = np.sqrt(middle**2 - stiffness / mass)
    slow, fast = -stiffness / mass / (middle + half), -middle - half
    sag = mass * gravity / stiffness
    of_slow = (speed + fast * sag) / (slow - fast)
    exact = sag + of_slow * np.exp(slow * times) - (of_slow + sag) * np.exp(fast * times)
    np.testing.assert_allclose(delta, exact, rtol=0, atol=1e-8 * sag)
    brought = 0.5 * mass * speed**2 + mass * gravity * delta
    np.testing.assert_allclose(
        lost + 0.5 * mass * rate**2 + 0.5 * stiffness * delta**2, brought, rtol=1e-8
    )
    assert recorded.contact.outcome == CAPTURED
    assert recorded.contact.deepest == pytest.approx(sag, rel=1e-6)


def test_a_single_drop_is_that_of_a_batch() -> None:
    """Which is solved in the phase plane, by other mathematics."""
    law = vi.laws.find_contact_law("lankarani-nikravesh")(stiffness=1e9, restitution=0.7)
    ball = vi.Body(mass=0.1, contact_offset=0.02)
    stated = vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(law,), height=1.0, impacts=4)
    alone = vi.simulate(stated).impacts
    together = vi.tabulate(replace(stated, height=np.array([1.0, 2.0]))).impacts
    for name, column in alone.items():
        np.testing.assert_allclose(
            column, together[name][0], rtol=1e-6 if "time_of_max" in name else 1e-9, err_msg=name
        )
