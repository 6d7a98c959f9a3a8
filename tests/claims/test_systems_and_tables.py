"""Numbers of the pages on several bodies and on shaken plates."""

from __future__ import annotations

from math import hypot, pi

import vibroimpact as vi
from stated_numbers import says
from vibroimpact.cases.rigid.plate_motion import _FEWEST, _MOST

SYSTEMS = "docs/systems.md"
SHAKEN = "docs/shaken.md"


def test_newtons_cradle() -> None:
    law = vi.laws.find_contact_law("hertz")(stiffness=1e9)
    balls = {
        f"{number}": vi.MovingBody(mass=0.1, velocity=(float(number == 0), 0.0, 0.0))
        for number in range(5)
    }
    contacts = {
        f"at {number}": vi.PointContact(
            below=f"{number}", above=f"{number + 1}", law=law, normal=(1.0, 0.0, 0.0)
        )
        for number in range(4)
    }
    moved = vi.simulate_system(vi.System(bodies=balls, contacts=contacts), duration=1.2e-3).at(
        1.2e-3
    )
    last, first = float(moved["4"].velocity[0]), float(moved["0"].velocity[0])
    assert first < 0.0
    says(
        SYSTEMS,
        "The last ball separates with {} % of the speed, and the first rebounds with {} %",
        100 * last,
        -100 * first,
    )


def test_samples_of_a_motion() -> None:
    says(SHAKEN, "{} to {} samples are allowed", _FEWEST, _MOST)


def test_thresholds_of_the_table_in_the_picture() -> None:
    """By the formulas of the page, which tests of the verification hold, at the
    restitution of the picture.
    """
    restitution = 0.5
    exists = pi * (1 - restitution) / (1 + restitution)
    doubles = hypot(exists, 2 * (1 + restitution**2) / (1 + restitution) ** 2)
    says(SHAKEN, "from {} g on one period, from {} g on two values", exists, doubles)
