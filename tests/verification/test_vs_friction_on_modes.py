"""Friction on a plate that vibrates, against an integration of its modes and of the
sphere in space by SciPy, and against momentum.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from turning_history import by_turning_points
from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.tangential_history import history_after
from vibroimpact.dynamics.oblique.tangential_history import tangential_history
from vibroimpact.dynamics.vibrating.drop_system import slices_of
from vibroimpact.structures.modal_model import ModalBasis

AGAINST = Against(
    "SciPy's DOP853, oblique impact on a vibrating plate",
    "own independent computation",
    "oblique impact and friction",
    "equations of motion of sphere, contact point, modes and rotation, "
    "tolerance 1e-12, in the test",
)
MOMENTUM = Against(
    "conservation of linear and angular momentum",
    "consistency",
    "oblique impact and friction",
    "momentum of the sphere and the free plate; no external reference",
)


MASS, RADIUS, MODULUS, SHEAR = 0.5, 0.025, 1.15e11, 0.92e11
STIFFNESS = 4.0 / 3.0 * MODULUS * RADIUS**0.5
GRAVITY = (1.5, 0.0)
EFFECTIVE = 2.0 / 7.0 * MASS


def bending_modes(seed: int, number: int = 12, *, size: float = 0.5) -> ModalBasis:
    """Modes whose contact point moves up and along x and y, as where bending turns the surface."""
    random = np.random.default_rng(seed)
    frequencies = np.sort(np.exp(random.uniform(np.log(200.0), np.log(2e4), number)))
    contact, along = size * random.normal(size=number), 0.5 * size * random.normal(size=(number, 2))
    return ModalBasis(
        frequencies, np.full(number, 0.02), contact, np.zeros((number, 3)), mass=4.0, along=along
    )


def drop(plate: ModalBasis, friction: Any, **oblique: Any) -> vi.Problem:
    law = vi.laws.find_contact_law("hertz")(stiffness=STIFFNESS)
    return vi.Problem(
        sphere=vi.Body(mass=MASS, contact_offset=RADIUS),
        plate=vi.Body(mass=np.inf, contact_offset=0.0, modes=plate),
        laws=(law,),
        speed=2.0,
        gravity=9.81,
        impacts=1,
        tolerance=1e-12,
        oblique=vi.Oblique(friction=friction, gravity=GRAVITY, **oblique),
    )


def friction(name: str, coefficient: float) -> Any:
    return vi.friction.find_friction_law(name)(
        coefficient=coefficient,
        effective_modulus=MODULUS,
        effective_shear_modulus=SHEAR,
        effective_radius=RADIUS,
    )


def integrated(
    plate: ModalBasis,
    slip: np.ndarray,
    law: str,
    coefficient: float,
    rolling: float = 0.0,
    motion: vi.PlateMotion | None = None,
) -> dict[str, Any]:
    """The first contact, by DOP853: fall, contact point of the sphere, and modes, with a spring
    that sticks, or sliding along x.

    `rolling`: coefficient of a moment against the spin of a sphere, which begins with that of
    rolling along x at 3 m/s. Supports may move with one frequency: the modes are relative to them,
    and begin in their steady motion.
    """
    omega, count = plate.angular_frequencies, len(plate.frequencies)
    assert plate.along is not None
    along, pull = plate.along, np.array(GRAVITY)
    driving, phasor, direction = 1.0, 0j, np.zeros(3)
    if motion is not None:
        driving, phasor, direction = (
            2.0 * np.pi * motion.frequency[0],
            motion.phasors[0],
            np.array(motion.direction),
        )
    inertia = plate.participation[:, :3] @ direction
    steady = (
        inertia
        * driving**2
        * phasor
        / (omega**2 - driving**2 + 2j * plate.damping_ratios * omega * driving)
    )

    def supports(time: float) -> tuple[np.ndarray, np.ndarray, float]:
        turned = phasor * np.exp(1j * driving * time)
        return (
            direction * turned.imag,
            direction * driving * turned.real,
            -(driving**2) * turned.imag,
        )

    def parts(state: np.ndarray) -> tuple[Any, ...]:
        (depth, fall), point, point_rate = state[:2], state[2:4], state[4:6]
        return (
            depth,
            fall,
            point,
            point_rate,
            state[6 : 6 + count],
            state[6 + count : 6 + 2 * count],
        )

    def forces(time: float, state: np.ndarray) -> tuple[float, np.ndarray]:
        depth, _, point, point_rate, place, rate = parts(state)
        moved, speed, _ = supports(time)
        overlap = max(depth + plate.contact @ place + moved[2], 0.0)
        force = STIFFNESS * overlap**1.5
        if law == "stick":
            return force, 2.0 * SHEAR * (RADIUS * overlap) ** 0.5 * (
                point - along.T @ (place - steady.imag) - moved[:2] + supports(0.0)[0][:2]
            )
        rubs = point_rate - along.T @ rate - speed[:2]
        return force, coefficient * force * rubs / np.hypot(*rubs)

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        _, fall, _, point_rate, place, rate = parts(state)
        force, rub = forces(time, state)
        modes = (
            -(omega**2) * place
            - 2.0 * plate.damping_ratios * omega * rate
            - plate.contact * force
            + along @ rub
        )
        modes -= inertia * supports(time)[2]
        spin = state[-2:]
        turned = 2.5 * rolling * force / MASS * spin / np.hypot(*spin)
        sphere = [fall, 9.81 - force / MASS, *point_rate, *(pull - rub / EFFECTIVE - turned)]
        return np.concatenate([sphere, rate, modes, -2.5 * rub / MASS - turned])

    def parted(time: float, state: np.ndarray) -> float:
        return (
            float(state[0] + plate.contact @ state[6 : 6 + count] + supports(time)[0][2])
            if time > 1e-6
            else 1.0
        )

    parted.terminal, parted.direction = True, -1.0  # type: ignore[attr-defined]
    begin = -float(supports(0.0)[0][2] + plate.contact @ steady.imag)
    start = np.concatenate(
        [[begin, 2.0, 0.0, 0.0], slip, steady.imag, driving * steady.real, [-3.0, 0.0]]
    )
    found = solve_ivp(
        rates,
        (0.0, 1e-2),
        start,
        method="DOP853",
        events=parted,
        rtol=1e-12,
        atol=1e-14,
        max_step=2e-6,
    )
    end = found.y[:, -1]
    return {
        "time": found.t[-1],
        "fall": end[1],
        "point": end[4:6],
        "place": end[6 : 6 + count],
        "rate": end[6 + count : 6 + 2 * count],
    }


def compare_release(
    agrees: Agrees,
    case: str,
    quantity: str,
    rising: Any,
    row: dict[str, Any],
    found: dict[str, Any],
) -> None:
    """Compare the duration of a contact that sticks, the velocity of the sphere upwards at its end,
    which is the quantity, and that of its lowest point along the plate.
    """
    agrees(case, "contact duration", row["duration_s"], found["time"], unit="s", relative=1e-7)
    agrees(case, quantity, rising, -found["fall"], unit="m/s", relative=1e-7)
    rolled = np.array([-row["spin_y_after_rad_s"], row["spin_x_after_rad_s"]]) * RADIUS
    point = np.array([row["separation_velocity_x_m_s"], row["separation_velocity_y_m_s"]]) + rolled
    assert point == pytest.approx(found["point"], rel=1e-7, abs=1e-7 * 0.4)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_contact_that_sticks_in_two_directions(agrees: Agrees, seed: int) -> None:
    """A single spring without limit is smooth: all velocities agree with an integration
    in time to 1e-7.
    """
    plate, velocity = bending_modes(seed), (0.4, -0.25)
    response = vi.simulate(drop(plate, friction("mindlin", 1e9), velocity=velocity))
    found = integrated(plate, np.array(velocity), "stick", 0.0)
    row = {name: values[0] for name, values in response.impacts.items()}
    assert row["contacts"] == 1
    case = "sticking contact, 12 modes"
    compare_release(agrees, case, "separation speed", row["separation_speed_m_s"], row, found)
    modes = 0.5 * (found["rate"] ** 2 + (plate.angular_frequencies * found["place"]) ** 2).sum()
    history = response.at([row["time_s"] + row["duration_s"]])
    agrees(
        case,
        "vibration energy of the plate",
        history["plate_kinetic_J"] + history["plate_strain_J"],
        modes,
        unit="J",
        relative=1e-7,
    )


@pytest.mark.parametrize("name", ["mdr", "mindlin", "mindlin-force"])
def test_a_contact_that_slides(agrees: Agrees, name: str) -> None:
    """Fast slip leaves no choice to any law: the coefficient times the normal force,
    against the slip over the surface as it moves.
    """
    plate = bending_modes(7)
    assert plate.along is not None
    straight = replace(plate, along=plate.along * np.array([1.0, 0.0]))
    problem = drop(straight, friction(name, 0.1), velocity=(3.0, 0.0))
    row = {name: values[0] for name, values in vi.simulate(problem).impacts.items()}
    found = integrated(straight, np.array([3.0, 0.0]), "slide", 0.1)
    point = row["separation_velocity_x_m_s"] - RADIUS * row["spin_y_after_rad_s"]
    assert row["contacts"] == 1
    case = "sliding contact, 12 modes"
    agrees(
        case,
        "tangential velocity of the contact point after impact",
        point,
        found["point"][0],
        unit="m/s",
        relative=1e-7,
    )
    agrees(
        case,
        "separation speed",
        row["separation_speed_m_s"],
        -found["fall"],
        unit="m/s",
        relative=1e-7,
    )


@pytest.mark.parametrize("seed", [1, 2])
def test_a_sphere_that_rolls_onto_a_plate_that_vibrates(agrees: Agrees, seed: int) -> None:
    """The moment of rolling resistance stretches a contact that sticks, beside the
    vibration of the plate below.
    """
    plate, rolling = bending_modes(seed), 0.01
    law = replace(friction("mindlin", 1e9), rolling_coefficient=rolling)
    response = vi.simulate(drop(plate, law, velocity=(3.0, 0.0), spin=(0.0, 3.0 / RADIUS, 0.0)))
    found = integrated(plate, np.zeros(2), "stick", 0.0, rolling)
    row = {name: values[0] for name, values in response.impacts.items()}
    assert row["contacts"] == 1
    agrees(
        "sphere with rolling resistance on a vibrating plate",
        "separation speed",
        row["separation_speed_m_s"],
        -found["fall"],
        unit="m/s",
        relative=1e-7,
    )
    point = row["separation_velocity_x_m_s"] - RADIUS * row["spin_y_after_rad_s"]
    agrees(
        "sphere with rolling resistance on a vibrating plate",
        "tangential velocity of the contact point after impact",
        point,
        found["point"][0],
        unit="m/s",
        absolute=1e-7 * 3.0,
    )
    assert abs(response.energy["closure_relative"]) < 1e-9


@pytest.mark.parametrize("name", ["mdr", "mindlin"])
def test_moments_of_a_contact_that_slides(name: str) -> None:
    """On a plate that hardly moves: mu of the impulse, 5/2 (mu -+ mu_r) of it for the
    spin, and little of that about the normal.
    """
    rolling, mu = 0.04, 0.3
    law = replace(friction(name, mu), rolling_coefficient=rolling)
    for speed, spin, turn in (
        (30.0, 0.0, 2.5 * (mu - rolling)),
        (0.0, -30.0, 2.5 * (mu + rolling)),
    ):
        problem = drop(
            bending_modes(1, size=1e-9), law, velocity=(speed, 0.0), spin=(0.0, spin / RADIUS, 1.0)
        )
        response = vi.simulate(
            replace(problem, oblique=replace(problem.oblique, gravity=(0.0, 0.0)), gravity=0.0)
        )
        row = {key: values[0] for key, values in response.impacts.items()}
        impulse = 2.0 + row["separation_speed_m_s"]
        assert row["separation_velocity_x_m_s"] == pytest.approx(speed - mu * impulse, rel=1e-8)
        assert RADIUS * row["spin_y_after_rad_s"] == pytest.approx(spin + turn * impulse, rel=1e-8)
        assert 0.999 < row["spin_z_after_rad_s"] < 1.0


class FreePlateImpact(NamedTuple):
    """An oblique impact of a sphere on a free plate, without gravity."""

    problem: vi.Problem
    response: vi.Response
    row: dict[str, float]
    """What the table of impacts says of it."""
    modal_speed: Floats
    """Speeds of the plate's modes at release."""
    impulse: Floats
    """Change of the sphere's momentum along x, y and z [N s]."""
    spun: Floats
    """Change of the sphere's angular momentum about its centre [N m s]."""


FREE_RADIUS, FREE_SPEED, FREE_ANGLE = 0.02, 2.0, math.radians(35.0)
"""Radius of the sphere on the free plate [m], its speed [m/s] and its angle from the normal."""


def on_a_free_plate(
    place: tuple[float, float], spin: tuple[float, float, float], friction: dict[str, Any]
) -> FreePlateImpact:
    case = vi.case_of(
        {
            "sphere": {"radius": FREE_RADIUS, "material": "steel"},
            "plate": {
                "size": [0.3, 0.2, 0.01],
                "material": "steel",
                "model": "elastic",
                "supports": "free",
                "modes": 30,
            },
            "drop": {
                "speed": FREE_SPEED,
                "angle": FREE_ANGLE,
                "gravity": 0.0,
                "position": list(place),
                "spin": list(spin),
            },
            "contact": {"law": "hunt-crossley", "restitution": 0.8, "friction": friction},
            "run": {"impacts": 1},
        }
    )
    problem = case.to_problem()
    response = vi.simulate(problem)
    assert response.bounces is not None
    contact = response.bounces[0].contact
    assert contact is not None
    end = contact.pieces[-1].motion.end  # type: ignore[union-attr]
    row = {name: values[0] for name, values in response.impacts.items()}
    mass = float(problem.sphere.mass)
    before, after = (
        np.array([row[f"{when}_velocity_{axis}_m_s"] for axis in "xy"])
        for when in ("approach", "separation")
    )
    rising = float(response.at([row["time_s"] + row["duration_s"]])["velocity_m_s"][0])
    gained = np.array(
        [row[f"spin_{axis}_after_rad_s"] - row[f"spin_{axis}_before_rad_s"] for axis in "xyz"]
    )
    return FreePlateImpact(
        problem,
        response,
        row,
        modal_speed=end.velocity[slices_of(problem)[0]],
        impulse=mass * np.append(after - before, rising + FREE_SPEED * math.cos(FREE_ANGLE)),
        spun=0.4 * mass * FREE_RADIUS**2 * gained,
    )


@pytest.mark.parametrize("spin", [(20.0, -30.0, 400.0), (0.0, 0.0, 0.3), (-100.0, 60.0, 0.0)])
def test_momentum_of_a_free_plate_that_moments_turn(
    agrees: Agrees, spin: tuple[float, float, float]
) -> None:
    """Momentum and angular momentum of sphere and plate together stay, to 1e-9, with
    rolling resistance and twisting friction.
    """
    rolling = {"law": "mdr", "coefficient": 0.2, "rolling_coefficient": 0.1}
    problem, response, row, speed, impulse, spun = on_a_free_plate((0.06, -0.03), spin, rolling)
    rigid = problem.plate.rigid
    assert rigid is not None
    assert rigid.turning is not None
    scale = float(problem.sphere.mass) * FREE_SPEED
    assert speed @ rigid.participation == pytest.approx(-impulse, abs=1e-9 * scale)
    turned = problem.models["plate"].properties.inertia @ (speed @ rigid.turning)
    centre = np.array([0.06, -0.03, 0.005 + FREE_RADIUS])
    balance = (turned + spun + np.cross(centre, impulse)) / (scale * FREE_RADIUS)
    agrees(
        "free plate rotated by contact moments",
        "balance of angular momentum, normalized by m v R",
        balance,
        np.zeros(3),
        against=MOMENTUM,
        absolute=1e-9,
    )
    # the moments are what friction at the place of contact does not explain
    moments = spun - np.cross([0.0, 0.0, -FREE_RADIUS], impulse)
    rolls = np.hypot(*moments[:2]) / (0.1 * FREE_RADIUS * impulse[2])
    assert rolls == pytest.approx(1.0, abs=2e-2) if spin[2] == 0.0 else 0.0 < rolls < 1.0 + 1e-6
    assert moments[2] * (spin[2] - (speed @ rigid.turning)[2]) < -1e-7 * scale * FREE_RADIUS
    assert abs(response.energy["closure_relative"]) < 1e-9
    assert row["friction_lost_J"] > 0.0


@pytest.mark.parametrize("place", [(0.06, -0.03), (-0.11, 0.05)])
@pytest.mark.parametrize("law", ["mdr", "mindlin-rescale"])
def test_momentum_of_a_free_plate(agrees: Agrees, place: tuple[float, float], law: str) -> None:
    """An oblique drop beside the centre of a free plate: momentum and angular momentum of
    both together stay, to 1e-9.
    """
    impact = on_a_free_plate(place, (20.0, -30.0, 0.0), {"law": law, "coefficient": 0.2})
    problem, response, _, speed, impulse, spun = impact
    rigid = problem.plate.rigid
    assert rigid is not None
    assert rigid.along is not None
    scale = float(problem.sphere.mass) * FREE_SPEED
    found = (speed @ rigid.participation) / scale
    agrees(
        "free plate, oblique eccentric impact",
        "momentum, normalized by m v (initial sphere momentum)",
        found,
        -impulse / scale,
        against=MOMENTUM,
        absolute=1e-9,
    )
    # the plate turns about its centre by the impulse at the place of contact, half its thickness
    # above
    arm = np.array([*place, 0.005])
    inertia = problem.models["plate"].properties.inertia
    assert rigid.rotation is not None
    moments, axes = np.linalg.eigh(inertia)
    turned = axes @ (np.sqrt(moments) * (speed @ rigid.rotation))
    assert turned == pytest.approx(np.cross(arm, -impulse), abs=1e-9 * scale * 0.15)
    assert spun == pytest.approx(
        np.cross([0.0, 0.0, -FREE_RADIUS], impulse), abs=1e-9 * scale * FREE_RADIUS
    )
    assert abs(response.energy["closure_relative"]) < 1e-9


@pytest.mark.parametrize("slip", [0.05, 0.3, 0.8, 3.0])
@pytest.mark.parametrize("name", ["mdr", "mindlin", "mindlin-force"])
def test_a_plate_that_hardly_moves_is_a_rigid_one(name: str, slip: float) -> None:
    """Sticking, slipping in part and sliding: springs and nodes here, turning points and
    steps there.
    """
    still = bending_modes(1, size=1e-9)
    level = vi.Oblique(
        velocity=(slip, 0.3 * slip), spin=(3.0, 1.0, 20.0), friction=friction(name, 0.2)
    )
    problem = replace(drop(still, level.friction), oblique=level, tolerance=1e-9)
    rigid = vi.simulate(replace(problem, plate=vi.rigid_plate())).impacts
    found = vi.simulate(problem).impacts
    before = slip + 0.08  # about the slip speed, with that of the spin
    for axis in "xy":
        for key, scale in (
            (f"separation_velocity_{axis}_m_s", before),
            (f"spin_{axis}_after_rad_s", 2.5 * before / RADIUS),
        ):
            assert found[key][0] == pytest.approx(rigid[key][0], abs=2e-4 * scale)
    # twisting begins where a slip ends, which steps here and there find differently
    assert found["spin_z_after_rad_s"][0] == pytest.approx(rigid["spin_z_after_rad_s"][0], rel=3e-3)
    for key in ("friction_lost_J", "microslip_lost_J", "gross_slip_lost_J"):
        # of what slips, and of what twists
        scale = 5e-4 * MASS * slip**2 + 1e-4 * 0.4 * MASS * (RADIUS * 20.0) ** 2
        assert found[key][0] == pytest.approx(rigid[key][0], abs=scale)


@pytest.mark.slow
@pytest.mark.parametrize("rolling", [0.0, 0.1])
def test_random_drops_close_their_ledger_and_gain_nothing(rolling: float) -> None:
    random = np.random.default_rng(0)
    laws = ("mdr", "mindlin", "mindlin-rescale", "mindlin-force")
    for number in range(24):
        plate = bending_modes(
            number, int(random.integers(1, 40)), size=float(10 ** random.uniform(-1.5, 0.3))
        )
        problem = drop(
            plate,
            replace(
                friction(laws[number % 4], float(10 ** random.uniform(-2.0, 0.5))),
                rolling_coefficient=rolling,
            ),
            velocity=tuple(random.normal(size=2) * 10 ** random.uniform(-3.0, 1.0)),
            spin=tuple(random.normal(size=3) * 10 ** random.uniform(0.0, 2.0)),
        )
        law = vi.laws.find_contact_law("hunt-crossley")(
            stiffness=STIFFNESS, restitution=float(random.uniform(0.1, 1.0))
        )
        response = vi.simulate(
            replace(
                problem,
                laws=(law,),
                speed=float(10 ** random.uniform(-2.0, 1.0)),
                impacts=2,
                tolerance=1e-9,
            )
        )
        assert response.energy["closure_relative"] < 2e-9
        assert (response.impacts["friction_lost_J"] > -1e-9 * response.energy["input_J"]).all()


def test_springs_follow_the_turning_points() -> None:
    """Along one direction, a displacement that turns twice while the contact grows and
    shrinks: within 1e-4 of the largest friction.
    """
    steps = 1600
    angle = np.linspace(0.0, np.pi, 20 * steps + 1)
    depth = 1e-6 * np.maximum(np.sin(angle), 0.0)
    moved = 2e-7 * (np.sin(2.6 * angle + 0.3) - np.sin(0.3))
    ratio = 0.1 * MODULUS / SHEAR
    curve = 2.0 * SHEAR * RADIUS**0.5 * ratio * by_turning_points(depth, moved / ratio)
    force = STIFFNESS * depth[::20] ** 1.5
    springs = tangential_history(friction("mdr", 0.1), float(force.max()))
    for point in range(1, steps + 1):
        way = (moved[20 * point] - moved[20 * point - 20]) * np.array([0.6, 0.8])
        springs = history_after(springs, float(force[point]), *way)
        rub = springs.force
        assert rub @ [0.6, 0.8] == pytest.approx(curve[20 * point], abs=1e-4 * 0.1 * force.max())
        assert abs(rub @ [0.8, -0.6]) < 1e-12 * force.max()


def shaken(plate: ModalBasis, seed: int) -> tuple[ModalBasis, vi.PlateMotion]:
    """A plate whose supports reach its modes in all directions, and their motion by 0.2
    mm at 400 Hz.
    """
    random = np.random.default_rng(seed)
    direction = random.normal(size=3)
    moves = np.concatenate(
        [
            0.5 * random.normal(size=(len(plate.frequencies), 3)),
            np.zeros((len(plate.frequencies), 3)),
        ],
        axis=1,
    )
    motion = vi.PlateMotion(
        amplitude=2e-4,
        frequency=400.0,
        phase=random.uniform(0.0, 6.0),
        direction=tuple(direction / np.linalg.norm(direction)),
    )
    return replace(plate, participation=moves[:, : plate.participation.shape[1]]), motion


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_contact_that_sticks_to_a_plate_that_is_shaken(agrees: Agrees, seed: int) -> None:
    """Sphere, modes and prescribed motion in all directions, the velocities to 1e-7."""
    (plate, motion), velocity = shaken(bending_modes(seed), seed), (0.4, -0.25)
    response = vi.simulate(
        replace(drop(plate, friction("mindlin", 1e9), velocity=velocity), motion=motion)
    )
    found = integrated(plate, np.array(velocity), "stick", 0.0, motion=motion)
    row = {name: values[0] for name, values in response.impacts.items()}
    assert row["contacts"] == 1
    history = response.at([row["time_s"] + row["duration_s"]])
    case = "sticking contact on a shaken plate"
    quantity = "normal velocity after impact"
    compare_release(agrees, case, quantity, history["velocity_m_s"], row, found)
    assert response.modal(row["time_s"] + row["duration_s"])["plate"][0] == pytest.approx(
        found["place"], abs=1e-7 * np.abs(found["place"]).max()
    )
    assert response.energy["closure_relative"] < 1e-9


@pytest.mark.parametrize("name", ["mdr", "mindlin", "mindlin-force"])
def test_a_contact_that_slides_on_a_plate_that_is_shaken(agrees: Agrees, name: str) -> None:
    plate = bending_modes(7)
    assert plate.along is not None
    straight, motion = shaken(replace(plate, along=plate.along * np.array([1.0, 0.0])), 7)
    motion = replace(motion, direction=(0.6, 0.0, 0.8))
    row = {
        key: values[0]
        for key, values in vi.simulate(
            replace(drop(straight, friction(name, 0.1), velocity=(3.0, 0.0)), motion=motion)
        ).impacts.items()
    }
    found = integrated(straight, np.array([3.0, 0.0]), "slide", 0.1, motion=motion)
    assert row["contacts"] == 1
    point = row["separation_velocity_x_m_s"] - RADIUS * row["spin_y_after_rad_s"]
    agrees(
        "sliding contact on a shaken plate",
        "tangential velocity of the contact point after impact",
        point,
        found["point"][0],
        unit="m/s",
        relative=1e-7,
    )
    agrees(
        "sliding contact on a shaken plate",
        "contact duration",
        row["duration_s"],
        found["time"],
        unit="s",
        relative=1e-7,
    )
