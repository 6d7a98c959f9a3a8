"""Phases of a contact collocated as a whole, in the core."""

from __future__ import annotations

import math

import numpy as np
import pytest

from vibroimpact.arrays import Cube, Matrix
from vibroimpact.compiled import compiled, law_addresses, law_coefficients, multiply_row
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.power_law import HERTZ_TIME
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.core.law import law_at_touch
from vibroimpact.dynamics.core.line_records import LineContact
from vibroimpact.dynamics.core.normal_records import FORCE, IMPULSE, PACE, TIME
from vibroimpact.dynamics.core.phase_contact import collocate_contact
from vibroimpact.dynamics.core.phase_records import ROWS
from vibroimpact.dynamics.motion.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.rigid.line_contact import RecordedContact, _manner
from vibroimpact.dynamics.rigid.phase_rules import normal_grid, phase_rules

SOLVED = sorted(
    law.name
    for law in contact_laws().values()
    if issubclass(law, CompliantLaw) and law.contact_end != "pull-off"
)


def collocated(
    law: CompliantLaw, speed: float, gravity: float = 9.8, tolerance: float = 1e-10
) -> tuple[bool, LineContact, LineContact]:
    """Return whether a contact of 0.1 kg is solved, that contact, and the one that is
    followed in steps.
    """
    solved, contact, recorded, _ = with_normal_motion(law, speed, gravity, tolerance, 0)
    return solved, contact, recorded.contact


def with_normal_motion(
    law: CompliantLaw, speed: float, gravity: float, tolerance: float, steps: int
) -> tuple[bool, LineContact, RecordedContact, np.ndarray]:
    """Return the same with the steps, and the normal motion with some steps in each
    segment (6, G).
    """
    conditions = impact_conditions_of(law, np.array([0.1]), np.array([gravity]), np.array([speed]))
    rules, grid = phase_rules(law.root, tolerance), normal_grid(steps)
    at_touch = law_at_touch(law_addresses(type(law)), law_coefficients(law), np.zeros(7), speed)
    room = np.zeros((ROWS, rules.vectors.shape[2]))
    solved, contact = collocate_contact(
        at_touch, _manner(conditions, 0, tolerance), rules, grid, room
    )
    return solved, contact, RecordedContact.of(conditions, 1e-13), grid.motion[:, : grid.points[0]]


@compiled
def multiply(room: Matrix, matrices: Cube, width: int, columns: int) -> None:
    multiply_row(room, 1, matrices, 2, width, columns, 3)


@pytest.mark.parametrize("width", [8, 16, 24])
@pytest.mark.parametrize("columns", [8, 24, 32])
def test_a_row_times_a_matrix(width: int, columns: int) -> None:
    random = np.random.default_rng(width)
    room, matrices = random.normal(size=(5, 32)), random.normal(size=(3, 24, 32))
    before = room.copy()
    multiply(room, matrices, width, columns)
    np.testing.assert_allclose(
        room[3, :columns], before[1, :width] @ matrices[2, :width, :columns], rtol=0, atol=1e-13
    )
    room[3, :columns] = before[3, :columns]
    np.testing.assert_array_equal(room, before)


def test_hertz_without_gravity() -> None:
    solved, contact, _ = collocated(Hertz(stiffness=1e9), speed=2.0, gravity=0.0)
    deepest = (1.25 * 0.1 * 2.0**2 / 1e9) ** 0.4
    assert solved
    assert contact.deepest == pytest.approx(deepest, rel=1e-12)
    assert contact.end.time == pytest.approx(HERTZ_TIME * deepest / 2.0, rel=1e-12)
    assert contact.end.rate == pytest.approx(-2.0, rel=1e-12)
    assert contact.peak_force == pytest.approx(1e9 * deepest**1.5, rel=1e-12)
    assert contact.end.lost == 0.0


@pytest.mark.parametrize("name", SOLVED)
@pytest.mark.parametrize("speed", [0.5, 5.0])
def test_contact_is_that_followed_in_steps(name: str, speed: float) -> None:
    law = contact_laws()[name].example(ContactPair(2.4e9, 0.02, 0.1, 8e7, 0.3))
    solved, contact, exact = collocated(law, speed)
    # whose force is another function of the rate at once after the deepest point
    assert solved or name == "adams-poisson"
    if solved:
        energy = 0.05 * speed**2
        assert contact.end.rate == pytest.approx(exact.end.rate, rel=0, abs=1e-10 * speed)
        assert contact.end.time == pytest.approx(exact.end.time, rel=1e-9)
        assert contact.end.delta == pytest.approx(exact.end.delta, rel=0, abs=1e-9 * exact.deepest)
        assert contact.end.lost == pytest.approx(exact.end.lost, rel=0, abs=1e-9 * energy)
        assert contact.deepest == pytest.approx(exact.deepest, rel=1e-9)
        assert contact.time_of_deepest == pytest.approx(exact.time_of_deepest, rel=1e-9)
        assert contact.peak_force == pytest.approx(exact.peak_force, rel=1e-9)
        assert contact.time_of_peak_force == pytest.approx(
            exact.time_of_peak_force, rel=0, abs=1e-6 * exact.end.time
        )
        assert contact.plastic == pytest.approx(exact.plastic, rel=0, abs=1e-9 * energy)
        assert contact.stored == pytest.approx(exact.stored, rel=0, abs=1e-9 * energy)


@pytest.mark.parametrize("name", SOLVED)
@pytest.mark.parametrize("speed", [0.5, 5.0])
def test_the_normal_motion_is_that_followed_in_steps(name: str, speed: float) -> None:
    law = contact_laws()[name].example(ContactPair(2.4e9, 0.02, 0.1, 8e7, 0.3))
    solved, contact, recorded, motion = with_normal_motion(law, speed, 9.8, 1e-10, 16)
    if not solved:
        return
    time, force, impulse = motion[TIME], motion[FORCE], motion[IMPULSE]
    assert time[0] == impulse[0] == 0.0
    assert time[-1] == pytest.approx(contact.end.time, rel=1e-9)
    assert (np.diff(time) >= -1e-12 * time[-1]).all()
    assert (motion[PACE] >= -1e-7 * time[-1]).all()
    rate = speed + 9.8 * time - impulse / 0.1
    np.testing.assert_allclose(
        rate,
        recorded.motion(np.minimum(time, recorded.contact.end.time))[1],
        rtol=0,
        atol=1e-7 * speed,
    )
    assert force.max() == pytest.approx(contact.peak_force, rel=0.02)


def test_what_is_not_smooth_is_not_taken_for_solved() -> None:
    """A law that says more energy than its force stores: the work of the force is not
    that energy.
    """
    law = Hertz(stiffness=1e9, exponent=1.5)
    addresses = np.array(
        [
            law_addresses(Hertz)[0],
            law_addresses(contact_laws()["linear-spring-dashpot"])[1],
            *law_addresses(Hertz)[2:],
        ]
    )
    conditions = impact_conditions_of(law, np.array([0.1]), np.array([9.8]), np.array([1.0]))
    rules = phase_rules(2, 1e-9)
    at_touch = law_at_touch(addresses, law_coefficients(law), np.zeros(7), 1.0)
    solved, _ = collocate_contact(
        at_touch,
        _manner(conditions, 0, 1e-9),
        rules,
        normal_grid(0),
        np.zeros((ROWS, rules.vectors.shape[2])),
    )
    assert not solved


def test_a_soft_touch_is_left_to_steps() -> None:
    """It is captured."""
    solved, contact, _ = collocated(
        contact_laws()["hunt-crossley"](stiffness=1e5, restitution=0.05), speed=1e-4
    )
    assert not solved
    assert math.isfinite(contact.deepest)
