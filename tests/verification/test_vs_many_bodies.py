"""Systems of bodies with several contacts against scipy's DOP853
(`oracles.moving_bodies`), closed forms, and the drop on a plate.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.moving_bodies import integrate
from random_systems import HERTZ, free_beam, modes_at, row_of_balls
from support import one_in
from vibrating import drop_on
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.contact.laws.linear_spring_dashpot import LinearSpringDashpot
from vibroimpact.contact.laws.tsuji import Tsuji
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws

AGAINST = Against(
    "SciPy's DOP853, impacts of several bodies",
    "own independent computation",
    "several bodies",
    "tests/oracles/moving_bodies.py, equations of motion in body coordinates",
)
DROP = Against(
    "solver of this package for drops on a rigid plate",
    "consistency",
    "several bodies",
    "another solver of this package; no external reference",
)
SYMMETRY = Against(
    "symmetry of two spheres on one plate",
    "consistency",
    "several bodies",
    "each sphere excites the symmetric modes, which both drive; no external reference",
)
RIGID = Against(
    "impact of rigid bodies",
    "closed form",
    "several bodies",
    "reduced mass; Goldsmith, Impact, 1960, section 2.3",
)


PAIR = ContactPair(2.4264724e9, 0.025, 0.09032078879, 8e7, 0.28)
COMPLIANT = [law for law in contact_laws().values() if issubclass(law, CompliantLaw)]
WALL = vi.MovingBody(mass=math.inf)
STEEL = (7850.0, 210e9)
LAWS = (
    HERTZ,
    LinearSpringDashpot(stiffness=1e7, damping=30.0),
    Tsuji(stiffness=1e9, restitution=0.8, effective_mass=0.1),
    KuwabaraKono.example(PAIR),
)


def energy_of(system: vi.System, moved: dict[str, vi.BodyMotion]) -> float:
    """Kinetic energy of all rigid motions [J]."""
    found = 0.0
    for name, body in system.bodies.items():
        if not body.held:
            found += 0.5 * body.mass * float(moved[name].velocity @ moved[name].velocity)
        if body.inertia is not None:
            found += 0.5 * float(
                moved[name].angular_velocity @ body.inertia @ moved[name].angular_velocity
            )
    return found


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_a_ball_against_a_wall_is_the_drop(agrees: Agrees, law: type[CompliantLaw]) -> None:
    """Every law, cut, sticking and with a memory: the same as the solver of rigid bodies,
    which shares no line but the law's.
    """
    made = law.example(PAIR)
    row = vi.simulate(drop_on(made, gravity=0.0, tolerance=1e-12)).impacts
    ball = vi.MovingBody(mass=0.09032078879, velocity=(0.0, 0.0, -3.0))
    contacts = {"at": vi.PointContact(above="ball", below="wall", law=made)}
    system = vi.System(bodies={"ball": ball, "wall": WALL}, contacts=contacts, tolerance=1e-12)
    response = vi.simulate_system(system, duration=2.0 * float(row["duration_s"][0]))
    case, impacts = "sphere against a wall, all laws with a contact force", response.impacts
    agrees(
        case,
        "maximum contact force",
        impacts["max_force_N"],
        row["max_force_N"],
        unit="N",
        against=DROP,
        relative=1e-8,
    )
    agrees(
        case,
        "contact duration",
        impacts["duration_s"],
        row["duration_s"],
        unit="s",
        against=DROP,
        relative=1e-9,
    )
    after = response.at(response.end_time)["ball"].velocity[2]
    agrees(
        case,
        "separation speed",
        after,
        row["separation_speed_m_s"][0],
        unit="m/s",
        against=DROP,
        relative=1e-8,
    )
    assert response.energy["closure_relative"] < 1e-9


@pytest.mark.parametrize(("number", "gap"), [(3, 0.0), (5, 0.0), (5, 1e-6), (5, 3e-5)])
def test_newtons_cradle(agrees: Agrees, number: int, gap: float) -> None:
    """Balls that touch or nearly do: the last takes most of the momentum, the others the
    rest (Herrmann and Schmalzle 1981).
    """
    system = row_of_balls(number, gap=gap)
    response, expected = (
        vi.simulate_system(system, duration=1.5e-3),
        integrate(system, 1.5e-3, 5e-6),
    )
    moved = response.at(1.5e-3)
    for name in system.bodies:
        agrees(
            "Newton's cradle, 3 and 5 spheres",
            "velocities",
            moved[name].velocity,
            expected.velocity[name],
            unit="m/s",
            absolute=2e-11,
        )
    assert response.momentum(1.5e-3)[2] == pytest.approx(0.1, rel=1e-12)
    assert response.energy["closure_relative"] < 1e-10
    assert gap or 0.98 < float(moved[f"{number - 1}"].velocity[2]) < 0.9999


def random_system(seed: int) -> vi.System:
    """Two or three balls that hit one body, free or held, that turns and vibrates, at
    random places and times.
    """
    random = np.random.default_rng([19, seed])
    number, free = int(random.integers(2, 4)), bool(random.integers(2))
    names = [f"ball {ball}" for ball in range(number)]
    modes = modes_at(
        np.sort(np.exp(random.uniform(5.5, 9.0, 4))),
        (0.0, 0.01, 0.1)[random.integers(3)],
        **{name: random.normal(size=4) for name in names},
    )
    spread = random.normal(size=(3, 3))
    # of the mass along the axes, so that the inertia is one that a body can have
    spread = spread @ spread.T + np.eye(3)
    target = vi.MovingBody(
        mass=float(random.uniform(0.3, 3.0)) if free else math.inf,
        inertia=1e-3 * (np.trace(spread) * np.eye(3) - spread) if free else None,
        modes=modes,
    )
    law = LAWS[seed % 4]
    bodies, contacts = {"target": target}, {}
    for name in names:
        normal = random.normal(size=3) * [0.2, 0.2, 0.0] + [0.0, 0.0, 1.0]
        normal = normal / np.linalg.norm(normal)
        bodies[name] = vi.MovingBody(
            mass=float(random.uniform(0.05, 0.3)), velocity=-normal * random.uniform(0.5, 2.0)
        )
        contacts[name] = vi.PointContact(
            above=name,
            below="target",
            law=law,
            normal=normal,
            point=random.uniform(-0.1, 0.1, 3),
            gap=float(random.uniform(0.0, 2e-4)),
        )
    return vi.System(bodies=bodies, contacts=contacts, tolerance=1e-10)


@pytest.mark.parametrize("seed", one_in(5, range(25)))
def test_contacts_that_overlap_at_random(agrees: Agrees, seed: int) -> None:
    system = random_system(seed)
    response = vi.simulate_system(system, duration=1e-3)
    begun, ended = (
        response.impacts["time_s"],
        response.impacts["time_s"] + np.nan_to_num(response.impacts["duration_s"], nan=1.0),
    )
    assert (begun[1:, None] < ended[None, :-1]).any()  # or nothing would act together
    expected, moved = integrate(system, 1e-3, 5e-6), response.at(1e-3)
    for name in system.bodies:
        body, theirs = moved[name], expected.angular_velocity[name]
        agrees(
            "random systems, simultaneous contacts",
            "velocities",
            body.velocity,
            expected.velocity[name],
            unit="m/s",
            absolute=1e-8,
        )
        agrees(
            "random systems, simultaneous contacts",
            "angular velocities",
            body.angular_velocity,
            theirs,
            unit="rad/s",
            absolute=1e-7,
        )
    assert response.energy["closure_relative"] < 1e-9


def test_mirrored_balls_are_one_of_which_the_plate_feels_twice_the_force(agrees: Agrees) -> None:
    """By symmetry each sees the symmetric modes driven by both."""
    frequencies, even, odd = (
        np.array([260.0, 900.0, 2100.0, 5000.0]),
        np.array([2.5, 0.0, -1.5, 2.0]),
        np.array([0.0, 1.7, 0.0, 0.0]),
    )
    plate = vi.MovingBody(
        mass=math.inf, modes=modes_at(frequencies, 0.01, left=even - odd, right=even + odd)
    )
    ball = vi.MovingBody(mass=0.09032078879, velocity=(0.0, 0.0, -3.0))
    contacts = {
        side: vi.PointContact(above=side, below="plate", law=HERTZ) for side in ("left", "right")
    }
    both = vi.simulate_system(
        vi.System(bodies={"plate": plate, "left": ball, "right": ball}, contacts=contacts),
        duration=5e-4,
    )
    alone = replace(plate, modes=modes_at(frequencies, 0.01, left=math.sqrt(2.0) * even))
    one = vi.simulate_system(
        vi.System(bodies={"plate": alone, "left": ball}, contacts={"left": contacts["left"]}),
        duration=5e-4,
    )
    for name, quantity, unit in (
        ("max_force_N", "maximum contact force", "N"),
        ("impulse_N_s", "impulse", "N s"),
        ("max_indentation_m", "maximum indentation", "m"),
    ):
        first = len(one.impacts[name])
        for side in ("left", "right"):
            here = both.impacts[name][both.impacts["contact"] == side]
            agrees(
                "two symmetrically placed spheres on a vibrating plate",
                quantity,
                here,
                one.impacts[name],
                unit=unit,
                against=SYMMETRY,
                relative=1e-9,
            )
        assert len(both.impacts[name]) == 2 * first
    np.testing.assert_allclose(
        both.at(5e-4)["left"].velocity, one.at(5e-4)["left"].velocity, rtol=1e-9
    )


def test_a_central_impact_on_a_free_plate_is_that_of_the_reduced_mass(agrees: Agrees) -> None:
    plate = free_beam(0.3, 0.05, 0.008, STEEL, 0, at=0.0)
    ball = vi.MovingBody(mass=0.09032078879, velocity=(0.0, 0.0, -3.0))
    contact = vi.PointContact(above="ball", below="plate", law=HERTZ)
    response = vi.simulate_system(
        vi.System(bodies={"ball": ball, "plate": plate}, contacts={"at": contact}), duration=1e-3
    )
    reduced = ball.mass * plate.mass / (ball.mass + plate.mass)
    problem = drop_on(HERTZ, gravity=0.0)
    row = vi.simulate(replace(problem, sphere=vi.Body(mass=reduced, contact_offset=0.025))).impacts
    for name in ("max_force_N", "max_indentation_m", "duration_s"):
        assert response.impacts[name] == pytest.approx(row[name], rel=1e-10)
    impulse = response.impacts["impulse_N_s"]
    agrees(
        "central impact on a free plate",
        "impulse",
        impulse,
        2.0 * reduced * 3.0,
        unit="N s",
        against=RIGID,
        relative=1e-10,
    )
    assert response.momentum(1e-3)[2] == pytest.approx(-3.0 * ball.mass, rel=1e-12)
    assert energy_of(response.system, response.at(1e-3)) == pytest.approx(4.5 * ball.mass, rel=1e-9)


@pytest.mark.parametrize("place", [0.0, 0.05, 0.12, 0.15])
def test_an_excentric_impact_on_a_free_beam(agrees: Agrees, place: float) -> None:
    """Rigid, with rotation: the impulse is (1 + e) v / (1/m + 1/M + x^2/I) (Goldsmith,
    Impact, 1960, section 2.3).
    """
    beam = free_beam(0.3, 0.05, 0.008, STEEL, 0, at=place)
    ball = vi.MovingBody(mass=0.05, velocity=(0.0, 0.0, -2.0))
    contact = vi.PointContact(above="ball", below="beam", law=HERTZ, point=(place, 0.0, 0.0))
    response = vi.simulate_system(
        vi.System(bodies={"ball": ball, "beam": beam}, contacts={"at": contact}), duration=1e-3
    )
    turning = float(np.asarray(beam.inertia)[1, 1])
    impulse = 2.0 * 2.0 / (1.0 / ball.mass + 1.0 / beam.mass + place**2 / turning)
    moved = response.at(1e-3)
    case = "eccentric impact on a free rigid beam"
    agrees(
        case,
        "impulse",
        response.impacts["impulse_N_s"],
        impulse,
        unit="N s",
        against=RIGID,
        relative=1e-9,
    )
    agrees(
        case,
        "velocity",
        moved["beam"].velocity,
        [0.0, 0.0, -impulse / beam.mass],
        unit="m/s",
        against=RIGID,
        absolute=1e-10,
    )
    turned = [0.0, impulse * place / turning, 0.0]
    agrees(
        case,
        "angular velocity",
        moved["beam"].angular_velocity,
        turned,
        unit="rad/s",
        against=RIGID,
        absolute=1e-8,
    )
    np.testing.assert_allclose(
        moved["ball"].velocity, [0.0, 0.0, -2.0 + impulse / ball.mass], atol=1e-10
    )


@pytest.mark.parametrize("place", [0.0, 0.05, 0.12])
def test_an_excentric_impact_on_a_free_beam_that_bends(agrees: Agrees, place: float) -> None:
    """Several contacts: the beam comes back to the ball. Momentum, angular momentum and
    energy hold, and DOP853 finds the same.
    """
    beam = free_beam(0.3, 0.05, 0.008, STEEL, 6, at=place)
    ball = vi.MovingBody(mass=0.05, velocity=(0.0, 0.0, -2.0))
    contact = vi.PointContact(above="ball", below="beam", law=HERTZ, point=(place, 0.0, 0.0))
    system = vi.System(
        bodies={"ball": ball, "beam": beam}, contacts={"at": contact}, tolerance=1e-10
    )
    response, expected = vi.simulate_system(system, duration=1e-3), integrate(system, 1e-3, 5e-6)
    moved = response.at(np.linspace(0.0, 1e-3, 101))
    for name in ("ball", "beam"):
        case, body, theirs = (
            "eccentric impact on a free flexible beam",
            moved[name],
            expected.angular_velocity[name],
        )
        agrees(
            case,
            "velocities",
            body.velocity[-1],
            expected.velocity[name],
            unit="m/s",
            absolute=1e-8,
        )
        agrees(
            case,
            "angular velocities",
            body.angular_velocity[-1],
            theirs,
            unit="rad/s",
            absolute=1e-7,
        )
    np.testing.assert_allclose(
        response.momentum(np.linspace(0.0, 1e-3, 101))[:, 2], -0.1, rtol=1e-9
    )
    turned = moved["beam"].angular_velocity @ np.asarray(beam.inertia)
    np.testing.assert_allclose(
        turned[:, 1] - ball.mass * place * moved["ball"].velocity[:, 2],
        2.0 * ball.mass * place,
        atol=1e-9 * 2.0 * ball.mass,
    )
    assert response.energy["closure_relative"] < 1e-9
