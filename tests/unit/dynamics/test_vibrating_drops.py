"""Drops whose bodies vibrate, from start to end: the room that their parts take, what is told of
how far they have come, and numbers that rounding does not reach.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import vibroimpact as vi
from vibrating import STIFFNESS, drop_on, modes_of, random_modes
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics.vibrating import recorded_motion, room

PAIR = ContactPair(2.4264724e9, 0.025, 0.09032078879, 8e7, 0.28)
SOFT_PLATE = {"frequencies": [69.8, 800.0], "contact": [2.5, 2.0], "damping": 0.01}


def chattering(impacts: int | None, **more: object) -> vi.Problem:
    """A drop onto a plate that throws it several times in an impact."""
    law = HuntCrossley(stiffness=STIFFNESS, restitution=0.4)
    return drop_on(law, modes_of(**SOFT_PLATE), height=0.06, impacts=impacts, **more)


@pytest.mark.parametrize("parts", [2, 3, 4, 5, 7])
@pytest.mark.parametrize("laws", [4, 5, 6, 7])
def test_numbers_do_not_depend_on_the_room_for_parts(
    monkeypatch: pytest.MonkeyPatch, parts: int, laws: int
) -> None:
    problem = chattering(4)
    expected = vi.simulate(problem)
    assert expected.impacts["contacts"].max() > 1
    monkeypatch.setattr(recorded_motion, "_FIRST_PARTS", parts)
    monkeypatch.setattr(recorded_motion, "_FIRST_LAWS", laws)
    response = vi.simulate(problem)
    for name, values in expected.impacts.items():
        np.testing.assert_array_equal(response.impacts[name], values, err_msg=name)
    times = np.linspace(0.0, expected.end_time[0], 301)
    for name, values in expected.at(times).items():
        np.testing.assert_array_equal(response.at(times)[name], values, err_msg=name)


def test_parts_are_never_written_beyond_their_room(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where an impact of several contacts just fills it."""
    law = HuntCrossley(stiffness=STIFFNESS, restitution=0.4)
    rooms = []
    more = room.with_more_room

    def noted(parts: recorded_motion.Parts) -> recorded_motion.Parts:
        rooms.append((int(parts.written[0]), len(parts.start)))
        return more(parts)

    monkeypatch.setattr("vibroimpact.dynamics.vibrating.followed_drop.with_more_room", noted)
    for frequency in np.linspace(20.0, 90.0, 40):
        plate = modes_of([frequency, 800.0], [2.5, 2.0], 0.01)
        drop = drop_on(law, plate, height=0.06, impacts=12, sensitivity=False)
        parts = vi.simulate(drop).bounces.recorded.parts  # type: ignore[union-attr]
        assert parts.written[0] == len(parts.start)
    assert len(rooms) > 10
    assert all(written <= room for written, room in rooms)


def test_progress_to_rest_grows_and_tells_of_each_impact() -> None:
    law = HuntCrossley(stiffness=STIFFNESS, restitution=0.2)
    drop = drop_on(law, random_modes(1, 8, 100.0, 2e4, 0.3, 0.01), height=0.05, impacts=None)
    fractions: list[float] = []
    response = vi.simulate(drop, fractions.append)
    assert response.outcomes[0].at_rest
    impacts = len(response.impacts["impact"])
    assert impacts <= len(fractions) <= impacts + 1
    assert fractions == sorted(fractions)
    assert 0.0 < fractions[0] < 0.9
    assert fractions[-1] == 1.0


@pytest.mark.parametrize("name", ["storakers", "thornton", "meyer", "walton-braun"])
def test_the_growth_after_dents_does_not_depend_on_rounding(name: str) -> None:
    """Coefficients that are zero but for rounding have no part in it."""
    law = contact_laws()[name].example(PAIR)
    plate = random_modes(2, 6, 300.0, 2e4, 0.3, 0.01)
    drop = drop_on(law, plate, height=0.3, impacts=4)
    expected = vi.simulate(drop).impacts["sensitivity"]
    for change in (1e-13, 2e-13, -1e-13):
        changed = vi.simulate(replace(drop, height=0.3 * (1.0 + change)))
        np.testing.assert_allclose(changed.impacts["sensitivity"], expected, rtol=2e-6)


def test_the_last_rebound_in_a_liquid_is_as_high_as_the_liquid_lets_it() -> None:
    """Also that of a sphere that the rest speed stops: it would rise by less than in a vacuum."""
    law = HuntCrossley(stiffness=1e4, restitution=0.4)
    plate = random_modes(1, 8, 100.0, 2e4, 1.2, 0.01)
    problem = drop_on(law, plate, speed=0.3, impacts=3, liquid=vi.Liquid())
    response = vi.simulate(problem)
    assert response.outcomes == (vi.Outcome.REST_SPEED,)
    separation = response.impacts["separation_speed_m_s"][-1]
    gap = response.impacts["rebound_height_m"][-1] - 0.025
    in_vacuum = 0.5 * separation**2 / float(problem.net_gravity)
    # added mass carries it higher than buoyancy alone would let it, by half of the displaced mass
    assert 1.2 * in_vacuum < gap < 1.0 * in_vacuum * float(problem.flight_inertia) * 1.5
