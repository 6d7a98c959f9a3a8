"""Systems of several bodies: what they say of themselves, and what they refuse."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from moving import HERTZ, free_beam, modes_at, row_of_balls
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.contact.pair import ContactPair

WALL = vi.MovingBody(mass=math.inf)
BALL = vi.MovingBody(mass=0.1, velocity=(0.0, 0.0, -1.0))
PAIR = ContactPair(2.4264724e9, 0.025, 0.09032078879, 8e7, 0.28)


def ball_and_wall(**more: Any) -> vi.System:
    given = {"above": "ball", "below": "wall", "law": HERTZ}
    settings = {name: more.pop(name) for name in list(more) if name in ("gravity", "tolerance")}
    return vi.System(bodies={"ball": BALL, "wall": WALL}, contacts={"at": vi.PointContact(**{**given, **more})}, **settings)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: vi.System(bodies={"ball": BALL}, contacts={}), "contacts: the system has no contact"),
        (lambda: ball_and_wall(above="bal"), 'there is no body "bal" Did you mean "ball"?'),
        (lambda: ball_and_wall(above="wall"), "a body can not touch itself"),
        (lambda: ball_and_wall(gap=-1e-6), "the bodies overlap at the start"),
        (lambda: ball_and_wall(gap="1 mm"), "gap must be a number"),
        (lambda: ball_and_wall(normal=(0.0, 0.0, 2.0)), "normal must be a vector of length 1"),
        (lambda: ball_and_wall(point=(0.0, 1.0)), "point must be three finite numbers"),
        (lambda: ball_and_wall(law=Newton(restitution=0.5)), "must give a force"),
        (lambda: ball_and_wall(tolerance=1.0), "tolerance must lie between"),
        (lambda: vi.MovingBody(mass=0.0), "greater than 0 kg"),
        (lambda: vi.MovingBody(mass="1 kg"), "mass must be a number"),
        (lambda: vi.MovingBody(mass=math.inf, velocity=(0.0, 0.0, 1.0)), "held, of infinite mass, has no velocity"),
        (lambda: vi.MovingBody(mass=1.0, angular_velocity=(0.0, 0.0, 1.0)), "does not turn: give inertia"),
        (lambda: vi.MovingBody(mass=1.0, inertia=-1.0), "inertia must be"),
        (lambda: vi.simulate_system(ball_and_wall(), duration=0.0), "duration must be a number greater than 0 s"),
        (lambda: vi.simulate_system(ball_and_wall(), duration="1 ms"), "duration must be a number greater than 0 s"),
        (lambda: vi.simulate_system(ball_and_wall(), duration=1e-3).at(1.0), "times must lie within the run"),
    ],
)
def test_faults_have_one_sentence(made: Callable[[], object], words: str) -> None:
    with pytest.raises(vi.InputError) as raised:
        made()
    assert words in str(raised.value)
    assert "\n" not in str(raised.value)


def test_two_bodies_that_are_held() -> None:
    with pytest.raises(vi.InputError, match='neither "a" nor "b" can move'):
        vi.System(bodies={"a": WALL, "b": WALL}, contacts={"at": vi.PointContact(above="a", below="b", law=HERTZ)})


def test_a_free_plate_that_falls_away() -> None:
    """Both fall alike, so that nothing presses them together: they would never meet again."""
    plate = free_beam(0.3, 0.05, 0.008, (7850.0, 210e9), 0, at=0.0)
    bodies = {"ball": vi.MovingBody(mass=0.1), "plate": plate}
    with pytest.raises(vi.InputError, match="no surfaces will ever touch"):
        vi.simulate_system(
            vi.System(
                bodies=bodies, contacts={"at": vi.PointContact(above="ball", below="plate", law=HERTZ, gap=0.1)}, gravity=(0, 0, -9.8)
            ),
            duration=1.0,
        )


def test_a_ball_comes_to_rest() -> None:
    """It lies in its static indentation in the end; until then it bounces, and then swings."""
    lossy = LankaraniNikravesh(stiffness=1e6, restitution=0.1)
    response = vi.simulate_system(ball_and_wall(law=lossy, gap=1e-4, gravity=(0.0, 0.0, -9.8)), duration=100.0)
    assert response.forces(100.0)["at"] == pytest.approx(0.98, rel=1e-6)
    assert -response.gaps(100.0)["at"] == pytest.approx(0.98e-6 ** (2.0 / 3.0), rel=1e-6)
    assert np.isnan(response.impacts["duration_s"][-1])
    assert response.energy["closure_relative"] < 1e-9


def test_contacts_without_end_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vibroimpact.dynamics.march._MOST_STRETCHES", 50)
    with pytest.raises(
        vi.ComputationError, match="follow each other ever faster, as where a body comes to rest; ask for a shorter duration"
    ):
        vi.simulate_system(ball_and_wall(gap=1e-4, gravity=(0.0, 0.0, -9.8)), duration=100.0)


def test_modes_must_know_the_contact() -> None:
    plate = vi.MovingBody(mass=math.inf, modes=modes_at(np.array([100.0]), 0.0, left=np.array([1.0])))
    with pytest.raises(vi.InputError, match=r'contacts.right: the modes of "plate" do not tell how it moves there: add "right"'):
        vi.System(bodies={"ball": BALL, "plate": plate}, contacts={"right": vi.PointContact(above="ball", below="plate", law=HERTZ)})


def test_histories() -> None:
    """Forces are those that change the momentum, gaps those of the places, whatever the shape of the times."""
    response = vi.simulate_system(ball_and_wall(gap=1e-3), duration=2e-3)
    times = np.linspace(0.0, 2e-3, 4001).reshape(1, -1)
    force, gap, moved = response.forces(times)["at"], response.gaps(times)["at"], response.at(times)["ball"]
    assert force.shape == gap.shape == times.shape
    assert moved.velocity.shape == (1, 4001, 3)
    np.testing.assert_allclose(gap, 1e-3 + moved.displacement[..., 2], atol=1e-18)
    assert ((force > 0.0) == (gap < 0.0)).mean() > 0.999
    impulse = float(np.trapezoid(force[0], times[0]))
    assert impulse == pytest.approx(float(response.impacts["impulse_N_s"][0]), rel=1e-5)
    assert 0.1 * (float(moved.velocity[0, -1, 2]) + 1.0) == pytest.approx(float(response.impacts["impulse_N_s"][0]), rel=1e-10)
    assert response.impacts["time_s"] == pytest.approx([1e-3], rel=1e-12)
    assert repr(response) == "<SystemResponse: 1 impacts in 0.002 s>"


def test_bounces_under_gravity_are_those_of_the_drop() -> None:
    lossy = LankaraniNikravesh(stiffness=1e9, restitution=0.7)
    problem = vi.Problem(sphere=vi.Body(mass=0.1, contact_offset=0.01), plate=vi.rigid_plate(), laws=lossy, height=0.51, impacts=4)
    rows = vi.simulate(problem).impacts
    ball = vi.MovingBody(mass=0.1)
    contact = vi.PointContact(above="ball", below="wall", law=lossy, gap=0.5)
    system = vi.System(bodies={"ball": ball, "wall": WALL}, contacts={"at": contact}, gravity=(0.0, 0.0, -9.80665))
    found = vi.simulate_system(system, duration=float(rows["time_s"][-1]) + 1e-2)
    np.testing.assert_allclose(found.impacts["time_s"], rows["time_s"], rtol=1e-9)
    np.testing.assert_allclose(found.impacts["max_force_N"], rows["max_force_N"], rtol=1e-8)
    assert found.energy["closure_relative"] < 1e-9


@pytest.mark.parametrize("same_spot", [True, False])
def test_a_dent_is_found_again_or_not(same_spot: bool) -> None:
    """As by a ball that drops on a plate."""
    law, ball = Thornton.example(PAIR), vi.Body(mass=0.1, contact_offset=0.01)
    problem = vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=law, speed=3.0, gravity=9.8, impacts=2, same_spot=same_spot)
    rows = vi.simulate(problem).impacts
    contact = vi.PointContact(above="ball", below="wall", law=law, same_spot=same_spot)
    bodies = {"ball": vi.MovingBody(mass=0.1, velocity=(0.0, 0.0, -3.0)), "wall": WALL}
    system = vi.System(bodies=bodies, contacts={"at": contact}, gravity=(0.0, 0.0, -9.8))
    response = vi.simulate_system(system, duration=float(rows["time_s"][-1]) + 1e-2)
    for name in ("time_s", "max_indentation_m", "max_force_N", "duration_s"):
        np.testing.assert_allclose(response.impacts[name], rows[name], rtol=1e-7)
    assert response.energy["plastic_work_J"] == pytest.approx(float(rows["plastic_work_J"].sum()), rel=1e-8)
    assert response.energy["closure_relative"] < 1e-9


def test_progress_is_told() -> None:
    seen: list[float] = []
    vi.simulate_system(row_of_balls(3), duration=1e-3, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_a_body_without_a_contact_goes_its_way() -> None:
    bodies = {"ball": BALL, "wall": WALL, "other": vi.MovingBody(mass=1.0, inertia=(1.0, 2.0, 3.0), angular_velocity=(0.0, 1.0, 0.0))}
    system = vi.System(bodies=bodies, contacts={"at": vi.PointContact(above="ball", below="wall", law=HERTZ)})
    other = vi.simulate_system(system, duration=1e-3).at(1e-3)["other"]
    np.testing.assert_allclose(other.rotation, [0.0, 1e-3, 0.0], atol=1e-15)
    np.testing.assert_allclose(other.angular_velocity, [0.0, 1.0, 0.0], atol=1e-15)
