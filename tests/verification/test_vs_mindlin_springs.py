"""Friction as a single spring of Mindlin's stiffness, against an integration of it in
many small steps, as discrete-element codes do.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.law import CompliantLaw

AGAINST = Against(
    "spring of Mindlin's tangential stiffness, 20,000 Verlet steps",
    "own independent computation",
    "oblique impact and friction",
    "incremental friction as in discrete-element codes, in the test",
)


RADIUS, MASS, SPEED, SLIP, COEFFICIENT = 0.025, 0.09, 3.0, 1.0, 0.3
PAIR = {"effective_modulus": 2.4e9, "effective_shear_modulus": 2.0e9, "effective_radius": RADIUS}
STIFFNESS = 4.0 / 3.0 * PAIR["effective_modulus"] * RADIUS**0.5
STIFFNESS_OF_SPRING = 2e6  # N/m, of the laws whose force jumps


def slip_by_small_steps(law: str, steps: int = 20_000) -> float:
    """Return the velocity of the contact point after a Hertzian impact, by the Verlet method."""
    deepest = (1.25 * MASS * SPEED**2 / STIFFNESS) ** 0.4
    step = 2.9432 * deepest / SPEED / steps
    depth, rate, slip = 0.0, SPEED, SLIP
    brake = friction = stretch = before = 0.0
    while True:
        rate, slip = rate - 0.5 * step * brake, slip - 0.5 * step * friction / (2.0 / 7.0 * MASS)
        depth += step * rate
        if depth <= 0.0:
            return slip
        force, contact = STIFFNESS * depth**1.5, (RADIUS * depth) ** 0.5
        spring = 2.0 * PAIR["effective_shear_modulus"] * contact
        if law == "mindlin-rescale" and contact < before:
            stretch *= contact / before
        before = contact
        friction = (
            friction + spring * step * slip
            if law == "mindlin-force"
            else spring * (stretch := stretch + step * slip)
        )
        friction = min(max(friction, -COEFFICIENT * force), COEFFICIENT * force)
        stretch, brake = friction / spring, force / MASS
        rate, slip = rate - 0.5 * step * brake, slip - 0.5 * step * friction / (2.0 / 7.0 * MASS)


@pytest.mark.parametrize("name", ["mindlin", "mindlin-rescale", "mindlin-force"])
def test_slip_after(agrees: Agrees, name: str) -> None:
    """The contact slips, sticks and is turned back."""
    law = vi.friction.find_friction_law(name)(coefficient=COEFFICIENT, **PAIR)
    problem = vi.Problem(
        sphere=vi.Body(mass=MASS, contact_offset=RADIUS),
        plate=vi.rigid_plate(),
        laws=(vi.laws.find_contact_law("hertz")(stiffness=STIFFNESS),),
        speed=SPEED,
        gravity=0.0,
        impacts=1,
        oblique=vi.Oblique(velocity=(SLIP, 0.0), friction=law),
    )
    impacts = vi.simulate(problem).impacts
    found = impacts["separation_velocity_x_m_s"][0] - RADIUS * impacts["spin_y_after_rad_s"][0]
    agrees(
        f"friction law `{name}`, sliding, sticking and reversal",
        "tangential velocity of the contact point after impact",
        found,
        slip_by_small_steps(name),
        unit="m/s",
        absolute=4e-4 * SLIP,
    )


def slip_where_force_jumps(name: str, normal: CompliantLaw, steps: int = 40_000) -> float:
    """Return the velocity of the contact point after an impact whose normal force jumps at touch,
    by the Verlet method.

    A single spring, or a row of 1,000 for `mdr`. Hertz's depth and radius are those under the
    normal force. At touch nothing has moved yet, so that friction begins with zero, whatever the
    normal force.
    """
    ratio = COEFFICIENT * PAIR["effective_modulus"] / PAIR["effective_shear_modulus"]
    place = (np.arange(1000) + 0.5) / 1000 * RADIUS
    stretch = np.zeros(1000 if name == "mdr" else 1)
    step = 1.2 * np.pi * (MASS / STIFFNESS_OF_SPRING) ** 0.5 / steps
    delta, rate, slip = 0.0, SPEED, SLIP
    brake = float(np.add(*normal.forces(0.0, SPEED, SPEED))) / MASS
    friction = 0.0
    while True:
        rate, slip = rate - 0.5 * step * brake, slip - 0.5 * step * friction / (2.0 / 7.0 * MASS)
        delta += step * rate
        force = float(np.add(*normal.forces(delta, rate, SPEED)))
        if delta <= 0.0 or (rate < 0.0 and force <= 0.0):
            return slip
        depth = (force / STIFFNESS) ** (2.0 / 3.0)
        if name == "mdr":
            limit = ratio * np.maximum(depth - place**2 / RADIUS, 0.0)
            stretch = np.clip(stretch + step * slip, -limit, limit)
            friction = 2.0 * PAIR["effective_shear_modulus"] * float(stretch.sum()) * RADIUS / 1000
        else:
            spring = 2.0 * PAIR["effective_shear_modulus"] * (RADIUS * depth) ** 0.5
            friction = min(
                max(spring * (float(stretch[0]) + step * slip), -COEFFICIENT * force),
                COEFFICIENT * force,
            )
            stretch[0] = friction / spring
        brake = force / MASS
        rate, slip = rate - 0.5 * step * brake, slip - 0.5 * step * friction / (2.0 / 7.0 * MASS)


@pytest.mark.parametrize("name", ["mindlin", "mdr"])
def test_friction_begins_with_zero_where_the_normal_force_jumps(agrees: Agrees, name: str) -> None:
    """A dashpot pushes at once at touch. Friction does not: it was up to its bound there,
    before this was seen.
    """
    normal = vi.laws.find_contact_law("linear-spring-dashpot")(
        stiffness=STIFFNESS_OF_SPRING, restitution=0.5, effective_mass=MASS
    )
    problem = vi.Problem(
        sphere=vi.Body(mass=MASS, contact_offset=RADIUS),
        plate=vi.rigid_plate(),
        laws=(normal,),
        speed=SPEED,
        gravity=0.0,
        impacts=1,
        oblique=vi.Oblique(
            velocity=(SLIP, 0.0),
            friction=vi.friction.find_friction_law(name)(coefficient=COEFFICIENT, **PAIR),
        ),
    )
    impacts = vi.simulate(problem).impacts
    agrees(
        f"friction law `{name}` under a normal force that jumps at touch (`linear-spring-dashpot`)",
        "tangential velocity of the contact point after impact",
        impacts["separation_velocity_x_m_s"][0] - RADIUS * impacts["spin_y_after_rad_s"][0],
        slip_where_force_jumps(name, normal),
        unit="m/s",
        absolute=1e-3 * SLIP,
    )
