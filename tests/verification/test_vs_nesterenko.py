"""Against Nesterenko (1984), J. Appl. Mech. Tech. Phys. 24, 733-743: the solitary wave in a chain
of beads that just touch.

Its speed for the largest velocity u of a bead is :math:`(16/25)^{1/5} c^{4/5} u^{1/5}` with
:math:`c^2 = 2 E / (\\pi \\rho (1 - \\nu^2))`,
in the limit of waves much longer than a bead. Real ones are five beads long, so that a chain of
beads meets it to 1 %.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.moving_bodies import integrate
from random_systems import row_of_balls
from support import one_in
from vibroimpact.contact.laws.hertz import Hertz

AGAINST = Against(
    "Nesterenko, solitary wave in a chain of spheres",
    "closed form",
    "several bodies",
    "Nesterenko 1984, J. Appl. Mech. Tech. Phys. 24, 733, long-wave limit",
)
DOP853 = Against(
    "SciPy's DOP853, chain of spheres",
    "own independent computation",
    "several bodies",
    "tests/oracles/moving_bodies.py",
)


MODULUS, RATIO, DENSITY, RADIUS = 210e9, 0.3, 7850.0, 2.38e-3
MASS = 4.0 / 3.0 * np.pi * RADIUS**3 * DENSITY
STIFFNESS = 4.0 / 3.0 * MODULUS / (2.0 * (1.0 - RATIO**2)) * np.sqrt(0.5 * RADIUS)


@pytest.fixture(scope="module")
def chain() -> vi.SystemResponse:
    """Sixty steel beads, the first of which comes at 0.5 m/s."""
    return vi.simulate_system(
        row_of_balls(60, 0.5, mass=MASS, law=Hertz(stiffness=STIFFNESS)), duration=5e-4
    )


@pytest.mark.slow
def test_speed_of_the_wave(agrees: Agrees, chain: vi.SystemResponse) -> None:
    peaks = chain.impacts["time_of_max_force_s"]  # contacts begin in their order
    speed = 2.0 * RADIUS * 15.0 / (peaks[40] - peaks[25])
    moved = chain.at(np.linspace(peaks[32], peaks[34], 401))
    fastest = float(moved["33"].velocity[:, 2].max())
    wave = np.sqrt(2.0 * MODULUS / (np.pi * DENSITY * (1.0 - RATIO**2)))
    expected = (16.0 / 25.0) ** 0.2 * wave**0.8 * fastest**0.2
    agrees("chain of sixty steel spheres", "wave speed", speed, expected, unit="m/s", relative=0.01)


@pytest.mark.slow
def test_it_does_not_change_its_shape(chain: vi.SystemResponse) -> None:
    peaks = chain.impacts["max_force_N"][35:45]
    assert np.ptp(peaks) < 1e-8 * peaks[0]


@pytest.mark.slow
def test_nothing_is_lost(chain: vi.SystemResponse) -> None:
    assert chain.energy["closure_relative"] < 1e-9
    np.testing.assert_allclose(
        chain.momentum(np.linspace(0.0, 5e-4, 51))[:, 2], 0.5 * MASS, rtol=1e-12
    )


def test_every_bead_moves_as_dop853_moves_it(agrees: Agrees) -> None:
    system = replace(
        row_of_balls(10, 0.5, mass=MASS, law=Hertz(stiffness=STIFFNESS)), tolerance=1e-11
    )
    expected, moved = (
        integrate(system, 1e-4, 1e-6),
        vi.simulate_system(system, duration=1e-4).at(1e-4),
    )
    for name in system.bodies:
        agrees(
            "chain of ten spheres",
            "velocities",
            moved[name].velocity,
            expected.velocity[name],
            unit="m/s",
            against=DOP853,
            absolute=1e-9,
        )


@pytest.mark.parametrize("number", one_in(4, range(8, 17)))
def test_rows_against_a_wall(number: int) -> None:
    """The wave comes back from the wall, and contacts part and touch in any order: no
    touch is missed.
    """
    row = row_of_balls(number, 0.5, mass=MASS, law=Hertz(stiffness=STIFFNESS))
    last = vi.PointContact(below=f"{number - 1}", above="wall", law=Hertz(stiffness=STIFFNESS))
    bodies, contacts = (
        {**row.bodies, "wall": vi.MovingBody(mass=np.inf)},
        {**row.contacts, "wall": last},
    )
    assert (
        vi.simulate_system(vi.System(bodies=bodies, contacts=contacts), duration=3e-4).energy[
            "closure_relative"
        ]
        < 1e-9
    )
