"""Systems of several bodies: what they say of themselves, and what they refuse."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from random_systems import HERTZ, free_beam, modes_at, row_of_balls
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.laws.newton import Newton
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws
from vibroimpact.structures.modal_model import ModalBasis

WALL = vi.MovingBody(mass=math.inf)
BALL = vi.MovingBody(mass=0.1, velocity=(0.0, 0.0, -1.0))
PAIR = ContactPair(2.4264724e9, 0.025, 0.09032078879, 8e7, 0.28)


def ball_and_wall(**more: Any) -> vi.System:
    given = {"above": "ball", "below": "wall", "law": HERTZ}
    settings = {name: more.pop(name) for name in list(more) if name in ("gravity", "tolerance")}
    return vi.System(
        bodies={"ball": BALL, "wall": WALL},
        contacts={"at": vi.PointContact(**{**given, **more})},
        **settings,
    )


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (
            lambda: vi.System(bodies={"ball": BALL}, contacts={}),
            "contacts: the system has no contact",
        ),
        (lambda: ball_and_wall(above="bal"), 'there is no body "bal" Did you mean "ball"?'),
        (lambda: ball_and_wall(above="wall"), "a body cannot touch itself"),
        (lambda: ball_and_wall(gap=-1e-6), "the bodies overlap at the start"),
        (lambda: ball_and_wall(gap="1 mm"), "gap must be a number"),
        (lambda: ball_and_wall(normal=(0.0, 0.0, 2.0)), "normal must be a vector of length 1"),
        (lambda: ball_and_wall(point=(0.0, 1.0)), "point must be three finite numbers"),
        (lambda: ball_and_wall(law=Newton(restitution=0.5)), "must give a force"),
        (lambda: ball_and_wall(tolerance=1.0), "tolerance must lie between"),
        (lambda: vi.MovingBody(mass=0.0), "greater than 0 kg"),
        (lambda: vi.MovingBody(mass="1 kg"), "mass must be a number"),
        (
            lambda: vi.MovingBody(mass=math.inf, velocity=(0.0, 0.0, 1.0)),
            "held, of infinite mass, has no velocity",
        ),
        (
            lambda: vi.MovingBody(mass=1.0, angular_velocity=(0.0, 0.0, 1.0)),
            "does not turn: give inertia",
        ),
        (lambda: vi.MovingBody(mass=1.0, inertia=-1.0), "inertia must be"),
        (lambda: vi.MovingBody(mass=1.0, inertia="1"), "inertia must be"),
        (lambda: vi.MovingBody(mass=1.0, inertia=[1.0, 2.0]), "inertia must be"),
        (
            lambda: vi.MovingBody(mass=1.0, inertia=(1.0, 1.0, 100.0)),
            "more than the sum of the others",
        ),
        (lambda: vi.MovingBody(mass=10**400), "beyond all numbers"),
        (
            lambda: vi.MovingBody(mass=1.0, centre=(1e100, 0.0, 0.0)),
            "centre must be three finite numbers",
        ),
        (
            lambda: vi.MovingBody(mass=1.0, velocity=(1j, 0.0, 0.0)),
            "velocity must be three finite numbers",
        ),
        (lambda: vi.MovingBody(mass=1.0, modes="a"), "modes must be a ModalBasis"),
        (
            lambda: vi.MovingBody(mass=1.0, modes=modes_at(np.array([1.0, np.nan]), 0.0)),
            "frequencies greater than 0 Hz",
        ),
        (
            lambda: vi.MovingBody(mass=1.0, modes=modes_at(np.array([1.0]), -0.1)),
            "damping ratios, not negative",
        ),
        (
            lambda: vi.MovingBody(mass=1.0, modes=modes_at(np.array([1.0]), 0.1, at=np.ones(2))),
            'shapes of the point "at" must be',
        ),
        (lambda: ball_and_wall(above=None), "above must be the name of a body"),
        (lambda: ball_and_wall(series=3), "series must be a QuasiStatic"),
        (lambda: ball_and_wall(same_spot=np.array([1, 2])), "same_spot must be True or False"),
        (
            lambda: ball_and_wall(law=Hertz(stiffness=np.array([1e9, 2e9]))),
            "a system is one, and no batch",
        ),
        (lambda: vi.System(bodies=None, contacts={}), "bodies: bodies must be a mapping"),
        (lambda: vi.System(bodies={"ball": 3}, contacts={}), "bodies: bodies must be a mapping"),
        (
            lambda: vi.System(bodies={"ball": BALL}, contacts=["a"]),
            "contacts: contacts must be a mapping",
        ),
        (lambda: vi.simulate_system(None, duration=1.0), "system must be a System"),
        (lambda: vi.simulate_system(ball_and_wall(), duration=1e300), "less than 1e+09 s"),
        (
            lambda: vi.simulate_system(ball_and_wall(), duration=1e-3, progress="x"),
            "progress must be a function",
        ),
        (
            lambda: vi.simulate_system(ball_and_wall(), duration=1e-3).forces("a"),
            "times must be numbers within the run",
        ),
        (
            lambda: vi.simulate_system(ball_and_wall(), duration=0.0),
            "duration must be a number greater than 0 s",
        ),
        (
            lambda: vi.simulate_system(ball_and_wall(), duration="1 ms"),
            "duration must be a number greater than 0 s",
        ),
        (
            lambda: vi.simulate_system(ball_and_wall(), duration=1e-3).at(1.0),
            "times must be numbers within the run",
        ),
    ],
)
def test_faults_have_one_sentence(made: Callable[[], object], words: str) -> None:
    with pytest.raises(vi.InputError) as raised:
        made()
    assert words in str(raised.value)
    assert "\n" not in str(raised.value)


def test_two_bodies_that_are_held() -> None:
    with pytest.raises(vi.InputError, match='neither "a" nor "b" can move'):
        vi.System(
            bodies={"a": WALL, "b": WALL},
            contacts={"at": vi.PointContact(above="a", below="b", law=HERTZ)},
        )


def test_a_free_plate_that_falls_away() -> None:
    """Both fall alike, so that nothing presses them together: they would never meet again."""
    plate = free_beam(0.3, 0.05, 0.008, (7850.0, 210e9), 0, at=0.0)
    bodies = {"ball": vi.MovingBody(mass=0.1), "plate": plate}
    with pytest.raises(vi.InputError, match="no contact will ever bear a force"):
        vi.simulate_system(
            vi.System(
                bodies=bodies,
                contacts={"at": vi.PointContact(above="ball", below="plate", law=HERTZ, gap=0.1)},
                gravity=(0, 0, -9.8),
            ),
            duration=1.0,
        )


def test_a_ball_comes_to_rest() -> None:
    """It lies in its static indentation in the end; until then it bounces, and then swings."""
    lossy = LankaraniNikravesh(stiffness=1e6, restitution=0.1)
    response = vi.simulate_system(
        ball_and_wall(law=lossy, gap=1e-4, gravity=(0.0, 0.0, -9.8)), duration=100.0
    )
    assert response.forces(100.0)["at"] == pytest.approx(0.98, rel=1e-6)
    assert -response.gaps(100.0)["at"] == pytest.approx(0.98e-6 ** (2.0 / 3.0), rel=1e-6)
    assert np.isnan(response.impacts["duration_s"][-1])
    assert response.energy["closure_relative"] < 1e-9


def test_contacts_without_end_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("vibroimpact.dynamics.vibrating.marched_system._MOST_STRETCHES", 50)
    with pytest.raises(
        vi.ComputationError,
        match="follow each other ever faster because a body comes to rest, or last long; ask for "
        "a shorter duration",
    ):
        vi.simulate_system(ball_and_wall(gap=1e-4, gravity=(0.0, 0.0, -9.8)), duration=100.0)


def test_modes_must_know_the_contact() -> None:
    plate = vi.MovingBody(
        mass=math.inf, modes=modes_at(np.array([100.0]), 0.0, left=np.array([1.0]))
    )
    with pytest.raises(
        vi.InputError,
        match=r'contacts.right: the modes of "plate" have no shapes at its contact: add "right"',
    ):
        vi.System(
            bodies={"ball": BALL, "plate": plate},
            contacts={"right": vi.PointContact(above="ball", below="plate", law=HERTZ)},
        )


def test_histories() -> None:
    """Forces are those that change the momentum, gaps those of the places, whatever the
    shape of the times.
    """
    response = vi.simulate_system(ball_and_wall(gap=1e-3), duration=2e-3)
    times = np.linspace(0.0, 2e-3, 4001).reshape(1, -1)
    force, gap, moved = (
        response.forces(times)["at"],
        response.gaps(times)["at"],
        response.at(times)["ball"],
    )
    assert force.shape == gap.shape == times.shape
    assert moved.velocity.shape == (1, 4001, 3)
    np.testing.assert_allclose(gap, 1e-3 + moved.displacement[..., 2], atol=1e-18)
    assert ((force > 0.0) == (gap < 0.0)).mean() > 0.999
    impulse = float(np.trapezoid(force[0], times[0]))
    assert impulse == pytest.approx(float(response.impacts["impulse_N_s"][0]), rel=1e-5)
    assert 0.1 * (float(moved.velocity[0, -1, 2]) + 1.0) == pytest.approx(
        float(response.impacts["impulse_N_s"][0]), rel=1e-10
    )
    assert response.impacts["time_s"] == pytest.approx([1e-3], rel=1e-12)
    assert repr(response) == "<SystemResponse: 1 impacts in 0.002 s>"


def test_bounces_under_gravity_are_those_of_the_drop() -> None:
    lossy = LankaraniNikravesh(stiffness=1e9, restitution=0.7)
    problem = vi.Problem(
        sphere=vi.Body(mass=0.1, contact_offset=0.01),
        plate=vi.rigid_plate(),
        laws=lossy,
        height=0.51,
        impacts=4,
    )
    rows = vi.simulate(problem).impacts
    ball = vi.MovingBody(mass=0.1)
    contact = vi.PointContact(above="ball", below="wall", law=lossy, gap=0.5)
    system = vi.System(
        bodies={"ball": ball, "wall": WALL}, contacts={"at": contact}, gravity=(0.0, 0.0, -9.80665)
    )
    found = vi.simulate_system(system, duration=float(rows["time_s"][-1]) + 1e-2)
    np.testing.assert_allclose(found.impacts["time_s"], rows["time_s"], rtol=1e-9)
    np.testing.assert_allclose(found.impacts["max_force_N"], rows["max_force_N"], rtol=1e-8)
    assert found.energy["closure_relative"] < 1e-9


def balls_on_a_floor(*balls: dict[str, Any]) -> vi.SystemResponse:
    """Return the response of balls side by side on a floor whose vibration joins them.

    It is so little that each moves as alone, to 1e-11.
    """
    law = vi.laws.HuntCrossley
    little = {f"at {number}": np.array([1e-6]) for number in range(len(balls))}
    system = vi.System(
        bodies={
            "wall": replace(WALL, modes=modes_at(np.array([1e3]), 0.0, **little)),
            **{
                f"ball {number}": vi.MovingBody(
                    mass=ball["mass"], velocity=(0.0, 0.0, ball["velocity"])
                )
                for number, ball in enumerate(balls)
            },
        },
        contacts={
            f"at {number}": vi.PointContact(
                above=f"ball {number}",
                below="wall",
                law=law(stiffness=ball["stiffness"], restitution=0.7),
                gap=ball["gap"],
            )
            for number, ball in enumerate(balls)
        },
        gravity=(0.0, 0.0, -9.81),
    )
    return vi.simulate_system(system, duration=0.02)


def test_of_two_touches_in_a_stretch_of_another_contact_the_first_counts() -> None:
    """They were 21 us apart, in a stretch of a millisecond: the second began in an overlap, whose
    energy came from nothing.
    """
    soft = {"mass": 1.0, "stiffness": 2e4, "gap": 0.0, "velocity": -0.2}
    later = {"mass": 0.1, "stiffness": 1e9, "gap": 1.003e-3, "velocity": 0.0}
    first = {**later, "gap": 1e-3}
    together = balls_on_a_floor(soft, later, first)
    assert together.impacts["contact"].tolist() == ["at 0", "at 2", "at 1"]
    for row, ball in ((1, first), (2, later)):
        alone = balls_on_a_floor(ball)
        for name in ("time_s", "closing_speed_m_s", "impulse_N_s", "max_force_N"):
            assert together.impacts[name][row] == pytest.approx(alone.impacts[name][0], rel=1e-9)
    assert together.energy["closure_relative"] < 1e-12


def test_a_body_that_falls_elsewhere_does_not_change_a_contact() -> None:
    """The rounding of its energy, which is 10^10 times that of the contact, was taken for an error
    of this, so that it was not to be integrated.
    """
    small = {"mass": 0.1, "stiffness": 1e9, "gap": 1e-4, "velocity": 0.0}
    heavy = {"mass": 1e3, "stiffness": 1e9, "gap": 1e3, "velocity": 50.0}
    beside = balls_on_a_floor(small, heavy)
    alone = balls_on_a_floor(small)
    assert len(alone.impacts["time_s"]) >= 2
    for name in ("time_s", "closing_speed_m_s", "impulse_N_s", "max_force_N"):
        np.testing.assert_allclose(beside.impacts[name], alone.impacts[name], rtol=1e-9)


@pytest.mark.parametrize("same_spot", [True, False])
def test_a_dent_is_found_again_or_not(same_spot: bool) -> None:
    """As by a ball that drops on a plate."""
    law, ball = Thornton.example(PAIR), vi.Body(mass=0.1, contact_offset=0.01)
    problem = vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=law,
        speed=3.0,
        gravity=9.8,
        impacts=2,
        same_spot=same_spot,
    )
    rows = vi.simulate(problem).impacts
    contact = vi.PointContact(above="ball", below="wall", law=law, same_spot=same_spot)
    bodies = {"ball": vi.MovingBody(mass=0.1, velocity=(0.0, 0.0, -3.0)), "wall": WALL}
    system = vi.System(bodies=bodies, contacts={"at": contact}, gravity=(0.0, 0.0, -9.8))
    response = vi.simulate_system(system, duration=float(rows["time_s"][-1]) + 1e-2)
    for name in ("time_s", "max_indentation_m", "max_force_N", "duration_s"):
        np.testing.assert_allclose(response.impacts[name], rows[name], rtol=1e-7)
    assert response.energy["plastic_work_J"] == pytest.approx(
        float(rows["plastic_work_J"].sum()), rel=1e-8
    )
    assert response.energy["closure_relative"] < 1e-9


def test_progress_is_told() -> None:
    seen: list[float] = []
    vi.simulate_system(row_of_balls(3), duration=1e-3, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_a_body_without_a_contact_goes_its_way() -> None:
    bodies = {
        "ball": BALL,
        "wall": WALL,
        "other": vi.MovingBody(mass=1.0, inertia=(1.0, 2.0, 3.0), angular_velocity=(0.0, 1.0, 0.0)),
    }
    system = vi.System(
        bodies=bodies, contacts={"at": vi.PointContact(above="ball", below="wall", law=HERTZ)}
    )
    other = vi.simulate_system(system, duration=1e-3).at(1e-3)["other"]
    np.testing.assert_allclose(other.rotation, [0.0, 1e-3, 0.0], atol=1e-15)
    np.testing.assert_allclose(other.angular_velocity, [0.0, 1.0, 0.0], atol=1e-15)


def test_contacts_that_turn_or_part_at_once() -> None:
    """Two balls beside one another on a wall do as each alone: their laws remember, part
    and stop pushing at the same instant.
    """
    for name, more in (
        ("walton-braun", {"stiffness": 1e7, "restitution": 0.8}),
        ("thornton", {"stiffness": 5e8, "yield_pressure": 1e8, "effective_radius": 0.025}),
        ("adams-poisson", {"penalty": 1e7, "restitution": 0.8}),
        (
            "adams-impact",
            {"stiffness": 1.92e6, "damping_max": 43.9, "full_damping_penetration": 3.66e-6},
        ),
    ):
        kind = vi.laws.find_contact_law(name)
        law = kind(**more) if set(more) <= set(kind.__dataclass_fields__) else kind.example(PAIR)
        names, ball = ("x", "y"), vi.MovingBody(mass=0.0112, velocity=(0.0, 0.0, -1.0))
        contacts = {one: vi.PointContact(above=one, below="wall", law=law) for one in names}
        both = vi.simulate_system(
            vi.System(bodies={"wall": WALL, "x": ball, "y": ball}, contacts=contacts), duration=2e-2
        )
        alone = vi.simulate_system(
            vi.System(bodies={"wall": WALL, "x": ball}, contacts={"x": contacts["x"]}),
            duration=2e-2,
        )
        for one in names:
            np.testing.assert_allclose(
                both.at(2e-2)[one].velocity, alone.at(2e-2)["x"].velocity, rtol=1e-9
            )


@pytest.mark.slow
def test_a_ball_does_not_fall_through_its_dent() -> None:
    """Which the next impact does not find again: it parts within it, and comes back into it."""
    law = vi.laws.find_contact_law("walton-braun")(stiffness=1e6, restitution=0.3)
    ball = vi.MovingBody(mass=0.1, velocity=(0.0, 0.0, -0.1))
    contact = vi.PointContact(above="ball", below="wall", law=law)
    response = vi.simulate_system(
        vi.System(
            bodies={"ball": ball, "wall": WALL}, contacts={"at": contact}, gravity=(0.0, 0.0, -9.81)
        ),
        duration=0.2,
    )
    assert -1e-4 < response.gaps(0.2)["at"] < 1e-3


@pytest.mark.parametrize(("speed", "gap"), [(0.1, 1e-2), (1.0, 0.5), (0.01, 1e-4)])
def test_bodies_that_fall_alike_meet_as_in_free_space(speed: float, gap: float) -> None:
    bodies = {
        "below": vi.MovingBody(mass=0.3),
        "above": vi.MovingBody(mass=0.3, velocity=(0.0, 0.0, -speed)),
    }
    contact = vi.PointContact(above="above", below="below", law=HERTZ, gap=gap)
    response = vi.simulate_system(
        vi.System(bodies=bodies, contacts={"at": contact}, gravity=(0, 0, -9.81)),
        duration=1.5 * gap / speed,
    )
    assert response.impacts["time_s"] == pytest.approx([gap / speed], rel=1e-12)


@pytest.mark.parametrize("name", ["thornton", "walton-braun", "adams-impact"])
@pytest.mark.parametrize("part", [0.3, 0.6, 0.95])
def test_a_run_may_end_within_a_contact(name: str, part: float) -> None:
    """While it loads, unloads or recoils without a force."""
    law = vi.laws.find_contact_law(name).example(PAIR)
    ball = vi.MovingBody(mass=0.09, velocity=(0.0, 0.0, -3.0))
    system = vi.System(
        bodies={"ball": ball, "wall": WALL},
        contacts={"at": vi.PointContact(above="ball", below="wall", law=law)},
    )
    whole = float(vi.simulate_system(system, duration=0.05).impacts["duration_s"][0])
    assert vi.simulate_system(system, duration=part * whole).energy["closure_relative"] < 1e-9


@pytest.mark.parametrize(("tolerance", "speed"), [(1e-13, 10.0), (1e-9, 1e4)])
def test_what_goes_on_elsewhere_does_not_matter(tolerance: float, speed: float) -> None:
    bodies = {
        "a": vi.MovingBody(mass=0.1),
        "b": BALL,
        "bystander": vi.MovingBody(mass=1.0, velocity=(speed, 0.0, 0.0)),
    }
    contacts = {"at": vi.PointContact(above="b", below="a", law=HERTZ)}
    moved = vi.simulate_system(
        vi.System(bodies=bodies, contacts=contacts, tolerance=tolerance), duration=1e-3
    ).at(1e-3)
    assert moved["a"].velocity[2] == pytest.approx(-1.0, abs=1e-9)


def test_the_indentation_does_not_depend_on_which_body_is_called_above() -> None:
    plate = vi.MovingBody(mass=0.5, modes=modes_at(np.array([800.0]), 0.0, at=np.array([4.0])))
    found = []
    for above, below, up in (("ball", "plate", 1.0), ("plate", "ball", -1.0)):
        contact = vi.PointContact(above=above, below=below, law=HERTZ, normal=(0.0, 0.0, up))
        system = vi.System(bodies={"plate": plate, "ball": BALL}, contacts={"at": contact})
        found.append(vi.simulate_system(system, duration=3e-3).impacts["max_indentation_m"])
    np.testing.assert_allclose(found[0], found[1], rtol=1e-9)


def test_bodies_that_no_contact_joins_do_not_know_of_each_other() -> None:
    """Balls on a floor, one of which glides past and one of which touches nothing: each as alone."""
    law = LankaraniNikravesh(stiffness=1e8, restitution=0.6)
    heights = {"a": 1e-3, "b": 1.3e-3, "c": 4e-3}

    def falling(*names: str) -> vi.SystemResponse:
        bodies = {
            name: vi.MovingBody(mass=0.1, velocity=(2.0, 0.0, 0.0), inertia=2e-5) for name in names
        }
        contacts = {
            name: vi.PointContact(above=name, below="floor", law=law, gap=heights[name])
            for name in names
        }
        system = vi.System(
            bodies={**bodies, "floor": WALL, "idle": BALL},
            contacts=contacts,
            gravity=(0.0, 0.0, -9.8),
        )
        return vi.simulate_system(system, duration=0.1)

    together = falling(*heights)
    assert np.all(np.diff(together.impacts["time_s"]) >= 0.0)
    times = np.linspace(0.0, 0.1, 31)
    for name in heights:
        alone = falling(name)
        of_it = together.impacts["contact"] == name
        for column, values in alone.impacts.items():
            np.testing.assert_array_equal(together.impacts[column][of_it], values)
        np.testing.assert_array_equal(together.forces(times)[name], alone.forces(times)[name])
        moved, moved_alone = together.at(times), alone.at(times)
        np.testing.assert_array_equal(moved[name].displacement, moved_alone[name].displacement)
    assert moved["idle"].velocity[-1, 2] == pytest.approx(-1.0 - 0.98)


@pytest.mark.parametrize("parts", [1, 2, 3, 7])
def test_numbers_do_not_depend_on_the_room_for_parts(
    monkeypatch: pytest.MonkeyPatch, parts: int
) -> None:
    """Laws that remember, and balls on one another, on a plate that vibrates."""
    names = ("a", "b", "c")
    shapes = {name: np.array([1.0 - 0.6 * row, 0.4]) for row, name in enumerate(names)}
    plate = vi.MovingBody(mass=math.inf, modes=modes_at(np.array([80.0, 700.0]), 0.01, **shapes))
    bodies = {"plate": plate, "top": BALL} | dict.fromkeys(names, BALL)
    law = Thornton(effective_modulus=7e10, effective_radius=0.01, yield_pressure=1e9)
    contacts = {
        name: vi.PointContact(above=name, below="plate", law=law, gap=1e-5 * number)
        for number, name in enumerate(names)
    }
    contacts["top"] = vi.PointContact(above="top", below="b", law=HERTZ, gap=3e-5)
    system = vi.System(bodies=bodies, contacts=contacts, gravity=(0.0, 0.0, -9.8))
    expected = vi.simulate_system(system, duration=0.15)
    assert len(expected.impacts["time_s"]) > 8
    monkeypatch.setattr("vibroimpact.dynamics.vibrating.marched_system._FIRST_PARTS", parts)
    response = vi.simulate_system(system, duration=0.15)
    for name, values in expected.impacts.items():
        np.testing.assert_array_equal(response.impacts[name], values, err_msg=name)
    assert response.energy == expected.energy
    for marched in (bodies.marched for bodies in response._motion.joined):
        room = marched.parts
        assert room.written.tolist() == [
            len(room.start),
            len(room.contact),
            len(room.origin),
            len(room.impacts),
        ]


def test_progress_is_told_on_the_way_and_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    system = ball_and_wall(
        law=LankaraniNikravesh(stiffness=1e6, restitution=0.5), gap=0.1, gravity=(0.0, 0.0, -9.8)
    )
    expected = vi.simulate_system(system, duration=1.0)
    monkeypatch.setattr("vibroimpact.dynamics.vibrating.marched_system._AT_ONCE", 5)
    told: list[float] = []
    response = vi.simulate_system(system, duration=1.0, progress=told.append)
    assert len(told) > 5
    assert told == sorted(told)
    assert told[0] < 0.5
    assert told[-1] == 1.0
    for name, values in expected.impacts.items():
        np.testing.assert_array_equal(response.impacts[name], values, err_msg=name)


def test_a_plate_joins_what_falls_on_it() -> None:
    """Two balls on a plate that vibrates are no longer alone, though they never touch."""
    shapes = {"a": np.array([1.0, 0.4]), "b": np.array([0.7, -0.8])}
    plate = vi.MovingBody(mass=math.inf, modes=modes_at(np.array([80.0, 300.0]), 0.01, **shapes))
    gaps = {"a": 0.0, "b": 1e-4}

    def falling(*names: str) -> vi.SystemResponse:
        contacts = {
            name: vi.PointContact(above=name, below="plate", law=HERTZ, gap=gaps[name])
            for name in names
        }
        bodies = dict.fromkeys(names, BALL)
        return vi.simulate_system(
            vi.System(
                bodies={**bodies, "plate": replace(plate, modes=_at(plate.modes, names))},
                contacts=contacts,
            ),
            duration=2e-3,
        )

    together, alone = falling("a", "b"), falling("a")
    peak = together.impacts["max_force_N"][together.impacts["contact"] == "a"][0]
    assert abs(peak / alone.impacts["max_force_N"][0] - 1.0) < 0.2
    at_end = together.at(2e-3)["a"].velocity[2] - alone.at(2e-3)["a"].velocity[2]
    assert abs(at_end) > 1e-3
    assert together.energy["closure_relative"] < 1e-9


def _at(modes: ModalBasis, names: tuple[str, ...]) -> ModalBasis:
    """Return modes seen at some contacts only."""
    return replace(modes, points={name: modes.points[name] for name in names})


def test_all_that_touch_and_close_at_the_start_are_in_contact() -> None:
    """Also where their touches differ by rounding; balls that do not count would fall through."""
    random = np.random.default_rng(3)
    laws = [law for law in contact_laws().values() if issubclass(law, CompliantLaw)]
    for _ in range(150):
        number = int(random.integers(2, 7))
        names = [f"{ball}" for ball in range(number)]
        shapes = {name: random.normal(size=4) for name in names}
        frequencies = np.sort(10.0 ** random.uniform(1.5, 4.0, 4))
        plate = vi.MovingBody(
            mass=float(random.choice([math.inf, 0.5])), modes=modes_at(frequencies, 0.01, **shapes)
        )
        speeds = {name: float(random.uniform(-1.0, 0.2)) for name in names}
        bodies = {
            name: vi.MovingBody(mass=float(random.uniform(0.02, 0.2)), velocity=(0.0, 0.0, speed))
            for name, speed in speeds.items()
        }
        contacts = {
            name: vi.PointContact(
                above=name, below="plate", law=laws[random.integers(len(laws))].example(PAIR)
            )
            for name in names
        }
        system = vi.System(
            bodies={**bodies, "plate": plate},
            contacts=contacts,
            gravity=(0.0, 0.0, float(random.choice([0.0, -9.8]))),
        )
        if min(speeds.values()) >= 0.0:
            continue
        impacts = vi.simulate_system(system, duration=1e-4).impacts
        begun = set(impacts["contact"][impacts["time_s"] < 1e-12])
        assert {name for name, speed in speeds.items() if speed < 0.0} <= begun


def test_a_ball_that_leaves_its_dent_is_let_go_whatever_else_touches() -> None:
    """The surfaces still overlap where the next impact meets them undeformed."""
    law = Thornton(effective_modulus=7e10, effective_radius=0.01, yield_pressure=1e8)
    little = {name: np.array([1e-9]) for name in ("leaving", "touching")}
    floor = replace(WALL, modes=modes_at(np.array([1e3]), 0.0, **little))

    def response(gap: float | None) -> vi.SystemResponse:
        contacts = {"leaving": vi.PointContact(above="a", below="floor", law=law, same_spot=False)}
        if gap is not None:
            contacts["touching"] = vi.PointContact(above="b", below="floor", law=HERTZ, gap=gap)
        names = {"leaving"} if gap is None else {"leaving", "touching"}
        shown = replace(floor, modes=_at(floor.modes, tuple(names)))
        bodies = {"floor": shown, "a": BALL, "b": BALL}
        system = vi.System(bodies=bodies, contacts=contacts, gravity=(0.0, 0.0, -9.8))
        return vi.simulate_system(system, duration=0.1)

    alone = response(None)
    released = float(alone.impacts["time_s"][0] + alone.impacts["duration_s"][0])
    dent = -float(alone.gaps(released)["leaving"])
    assert dent > 1e-6
    time = released + 0.5 * dent / float(alone.at(released)["a"].velocity[2])
    beside = response(time + 4.9 * time**2)  # so far it falls until then
    leaving = beside.impacts["contact"] == "leaving"
    assert beside.impacts["time_s"][~leaving][0] == pytest.approx(time, rel=1e-9)
    assert leaving.sum() > 1
    for name in ("time_s", "max_force_N"):
        np.testing.assert_allclose(
            beside.impacts[name][leaving], alone.impacts[name], rtol=1e-7, atol=1e-12
        )


def test_what_touches_and_parts_at_the_start_is_not_in_contact() -> None:
    """Two balls on a floor: the lower one rises from it, and the upper one meets it."""
    bodies = {
        "floor": WALL,
        "low": vi.MovingBody(mass=0.1, velocity=(0.0, 0.0, 0.1)),
        "high": BALL,
    }
    contacts = {
        "low": vi.PointContact(above="low", below="floor", law=HERTZ),
        "high": vi.PointContact(above="high", below="low", law=HERTZ),
    }
    system = vi.System(bodies=bodies, contacts=contacts, gravity=(0.0, 0.0, -9.8))
    impacts = vi.simulate_system(system, duration=0.05).impacts
    assert impacts["contact"][0] == "high"
    assert impacts["closing_speed_m_s"][0] == pytest.approx(1.1)
    assert impacts["time_s"][1] > 1e-7


def test_balls_in_a_row_that_touch_wait_for_the_pulse() -> None:
    """The next but one closes at once, by less than rounding: were it in contact from then on, its
    force of nearly nothing would be resolved in ten times as many stretches.
    """
    law = vi.laws.HuntCrossley(stiffness=1e9, restitution=0.7)
    response = vi.simulate_system(row_of_balls(21, law=law), duration=2e-3)
    (joined,) = response._motion.joined
    assert len(response.impacts["time_s"]) == 20
    assert len(joined.marched) < 150
