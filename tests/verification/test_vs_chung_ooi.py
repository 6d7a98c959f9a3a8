"""Against Chung and Ooi (2011), Granular Matter 13, 643-656, doi 10.1007/s10035-011-0277-0: tests 1 and 2.

Inputs from the article; values from Hertz's closed form, which its digitised curves meet to 1 %. Tolerance 1e-5,
the digits given.
"""

from __future__ import annotations

import math

import pytest

import vibroimpact as vi
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.pair import effective_modulus, hertz_stiffness


def impact(mass: float, stiffness: float, speed: float) -> dict:
    ball = vi.Body(mass=mass, contact_offset=0.01)
    problem = vi.Problem(sphere=ball, plate=vi.rigid_plate(), laws=(Hertz(stiffness=stiffness),), speed=speed, gravity=0.0, impacts=1)
    return vi.simulate(problem).impacts


def test_1_two_identical_glass_spheres() -> None:
    glass = vi.find_material("glass-chung-ooi")
    mass = 4 / 3 * math.pi * 0.01**3 * glass.density
    # two equal spheres at +-10 m/s: half the mass, half the radius, 20 m/s
    row = impact(mass / 2, hertz_stiffness(effective_modulus(glass, glass), 0.005), 20.0)
    assert row["max_indentation_m"][0] == pytest.approx(274.113e-6, rel=1e-5)
    assert row["max_force_N"][0] == pytest.approx(10696.9, rel=1e-5)
    assert row["duration_s"][0] == pytest.approx(40.3395e-6, rel=1e-5)


def test_1_as_it_is_meant() -> None:
    """Two spheres that meet, as a system of two bodies."""
    glass = vi.find_material("glass-chung-ooi")
    mass, law = 4 / 3 * math.pi * 0.01**3 * glass.density, Hertz(stiffness=hertz_stiffness(effective_modulus(glass, glass), 0.005))
    spheres = {"left": vi.MovingBody(mass=mass, velocity=(10.0, 0, 0)), "right": vi.MovingBody(mass=mass, velocity=(-10.0, 0, 0))}
    contact = vi.PointContact(below="left", above="right", law=law, normal=(1.0, 0, 0))
    response = vi.simulate_system(vi.System(bodies=spheres, contacts={"contact": contact}), duration=1e-4)
    assert response.impacts["max_indentation_m"] == pytest.approx([274.113e-6], rel=1e-5)
    assert response.impacts["max_force_N"] == pytest.approx([10696.9], rel=1e-5)
    assert response.impacts["duration_s"] == pytest.approx([40.3395e-6], rel=1e-5)
    for name, speed in (("left", -10.0), ("right", 10.0)):
        assert response.at(1e-4)[name].velocity[0] == pytest.approx(speed, rel=1e-12)


def test_1_from_a_case() -> None:
    """A sphere that comes at 20 m/s on one that flies free: the same seen from that one, which is the plate's place."""
    case = vi.read_case(
        {
            "sphere": {"radius": 0.01, "material": "glass-chung-ooi"},
            "plate": {"radius": 0.01, "material": "glass-chung-ooi", "supports": "free"},
            "drop": {"speed": 20.0, "gravity": 0.0},
            "contact": {"law": "hertz"},
            "run": {"impacts": 1},
        }
    )
    response = vi.simulate(case)
    assert response.impacts["max_indentation_m"] == pytest.approx([274.113e-6], rel=1e-5)
    assert response.impacts["max_force_N"] == pytest.approx([10696.9], rel=1e-5)
    assert response.impacts["duration_s"] == pytest.approx([40.3395e-6], rel=1e-5)
    end = response.at(response.end_time)  # equal spheres exchange their velocities
    assert end["velocity_m_s"] == pytest.approx([0.0], abs=1e-9)
    assert end["plate_velocity_m_s"] == pytest.approx([-20.0], rel=1e-12)


def test_2_as_it_is_meant() -> None:
    """A sphere and a wall that is held, as a system."""
    aluminium = vi.find_material("aluminium-chung-ooi")
    law = Hertz(stiffness=hertz_stiffness(effective_modulus(aluminium, vi.find_material("rigid")), 0.1))
    ball = vi.MovingBody(mass=4 / 3 * math.pi * 0.1**3 * aluminium.density, velocity=(0, 0, -0.2))
    bodies = {"ball": ball, "wall": vi.MovingBody(mass=math.inf)}
    contact = vi.PointContact(above="ball", below="wall", law=law)
    response = vi.simulate_system(vi.System(bodies=bodies, contacts={"contact": contact}), duration=1e-3)
    assert response.impacts["max_indentation_m"] == pytest.approx([49.7172e-6], rel=1e-5)
    assert response.impacts["max_force_N"] == pytest.approx([11369.9], rel=1e-5)
    assert response.impacts["duration_s"] == pytest.approx([731.657e-6], rel=1e-5)


def test_2_aluminium_sphere_on_a_rigid_wall() -> None:
    case = vi.read_case(
        {
            "sphere": {"radius": 0.1, "material": "aluminium-chung-ooi"},
            "plate": {"material": "rigid"},
            "drop": {"speed": 0.2, "gravity": 0.0},
            "contact": {"law": "hertz"},
            "run": {"impacts": 1},
        }
    )
    row = vi.simulate(case).impacts
    assert row["max_indentation_m"][0] == pytest.approx(49.7172e-6, rel=1e-5)
    assert row["max_force_N"][0] == pytest.approx(11369.9, rel=1e-5)
    assert row["duration_s"][0] == pytest.approx(731.657e-6, rel=1e-5)
