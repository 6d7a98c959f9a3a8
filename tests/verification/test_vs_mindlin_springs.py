"""Friction as a single spring of Mindlin's stiffness, against an integration of it in many small steps, as discrete-element codes do."""

from __future__ import annotations

import pytest

import vibroimpact as vi
from agreement import Against, Agrees

AGAINST = Against(
    "spring of Mindlin's tangential stiffness, 20,000 Verlet steps",
    "own independent computation",
    "oblique impact and friction",
    "incremental friction as in discrete-element codes, in the test",
)


RADIUS, MASS, SPEED, SLIP, COEFFICIENT = 0.025, 0.09, 3.0, 1.0, 0.3
PAIR = {"effective_modulus": 2.4e9, "effective_shear_modulus": 2.0e9, "effective_radius": RADIUS}
STIFFNESS = 4.0 / 3.0 * PAIR["effective_modulus"] * RADIUS**0.5


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
        friction = friction + spring * step * slip if law == "mindlin-force" else spring * (stretch := stretch + step * slip)
        friction = min(max(friction, -COEFFICIENT * force), COEFFICIENT * force)
        stretch, brake = friction / spring, force / MASS
        rate, slip = rate - 0.5 * step * brake, slip - 0.5 * step * friction / (2.0 / 7.0 * MASS)


@pytest.mark.parametrize("name", ["mindlin", "mindlin-rescale", "mindlin-force"])
def test_slip_after(agrees: Agrees, name: str) -> None:
    """The contact slips, sticks and is turned back."""
    law = vi.find_friction_law(name)(coefficient=COEFFICIENT, **PAIR)
    problem = vi.Problem(
        sphere=vi.Body(mass=MASS, contact_offset=RADIUS),
        plate=vi.rigid_plate(),
        laws=(vi.find_contact_law("hertz")(stiffness=STIFFNESS),),
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
