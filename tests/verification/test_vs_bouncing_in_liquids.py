"""Rebounds in liquids against what was published on spheres that meet walls in them.

* The correlation e/e_air = exp(-35/St) of Legendre and others (2006, Chem. Eng. Sci. 61:3543), St =
  (rho + rho_f/2) d v/(9 mu), written here a second time.
* Stokes numbers of two experiments of Gondret and others (2002, Phys. Fluids 14:643), with spheres
  in silicone oils, as Biegert and others tell them (2017, J. Comput. Phys. 340:105, Table 1): these
  are without the half mass of the liquid.
* Three bounces of the second of these spheres, 3 mm of the density of steel: its places every 2 ms,
  read off Gondret's figure by the authors of the program PARTIES (test case "Gondret", file
  gondret152_expy.dat). With other numbers of places in the parabolas the restitutions differ by up
  to 7 %.
* Joseph and others (2001, J. Fluid Mech. 433:329): no rebound below a Stokes number of about 10;
  above 500 the restitution is near that in air.
* SciPy's integration of falls and bounces with buoyancy, drag and half the displaced mass.
* The falls before Gondret's three bounces, from their first places on; height and speed there are
  fitted.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import vibroimpact as vi
from agreement import Against, Agrees
from bounces_compared import agrees_on_bounces
from bounces_in_oil import (
    DIAMETER,
    OIL_DENSITY,
    SPHERE_DENSITY,
    TRACKS,
    VISCOSITY,
    computed_restitution,
    fall_in,
    speed_at_touch,
)
from oracles.bouncing_in_air import Medium, bounces, clift_gauvin
from vibroimpact.bodies.rigid_bodies import rigid_plate, rigid_sphere
from vibroimpact.dynamics.fluids.liquid import CRITICAL_STOKES, restitution_kept

AGAINST = Against(
    "Gondret et al., measured rebounds of a sphere in silicone oil",
    "fitted to measurements",
    "flight, bounces and shaken plates",
    "Gondret et al. 2002, Phys. Fluids 14, 643, to whose measurements Legendre et al. 2006, "
    "Chem. Eng. Sci. 61, 3543, fitted the "
    "correlation; positions as digitized in the test case of the program PARTIES",
)
CORRELATION = Against(
    "correlation of Legendre et al., e/e_air = exp(-35/St)",
    "closed form",
    "flight, bounces and shaken plates",
    "Legendre et al. 2006, Chem. Eng. Sci. 61, 3543; evaluated separately in the test",
)
SCIPY = Against(
    "numerical integration of flights through a liquid (SciPy)",
    "own independent computation",
    "flight, bounces and shaken plates",
    "Newton's second law with buoyancy, half the displaced mass, and the drag coefficient "
    "of Clift and Gauvin 1970; "
    "tests/oracles/bouncing_in_air.py",
)
TERMINAL = Against(
    "terminal speed in a liquid, balance of forces",
    "closed form",
    "flight, bounces and shaken plates",
    "drag by Clift and Gauvin 1970 = weight less buoyancy; evaluated separately in the test",
)
FALLS = Against(
    "Gondret et al., measured falls of a sphere in silicone oil",
    "fitted to measurements",
    "flight, bounces and shaken plates",
    "Gondret et al. 2002, Phys. Fluids 14, 643, positions as digitized in the test case of "
    "the program PARTIES; height and speed at the first position are fitted",
)

QUARTZ = vi.Material(density=2650.0, youngs_modulus=60e9, poissons_ratio=0.17)
RADIUS, OIL = 0.003, vi.Liquid(density=935.0, viscosity=0.01)


def drops(law: str, speeds: np.ndarray, **options: object) -> vi.Response:
    found = vi.laws.find_contact_law(law)
    pair = {"stiffness": 1e9, "restitution": 0.9}
    more = {"effective_mass": rigid_sphere(RADIUS, QUARTZ).mass}
    law_of = found(
        **{
            key: value
            for key, value in {**pair, **more}.items()
            if key in found.__dataclass_fields__
        }
    )
    stated = {
        "sphere": rigid_sphere(RADIUS, QUARTZ),
        "plate": rigid_plate(),
        "gravity": 0.0,
        "impacts": 1,
        **options,
    }
    return vi.simulate(vi.Problem(laws=(law_of,), speed=speeds, liquid=OIL, **stated))


@pytest.mark.parametrize("law", ["tsuji", "newton"])
def test_achieved_restitutions_follow_the_correlation(agrees: Agrees, law: str) -> None:
    speeds = np.geomspace(0.05, 5.0, 12)
    stokes = (2650.0 + 0.5 * 935.0) * 2.0 * RADIUS * speeds / (9.0 * 0.01)
    assert stokes.min() < CRITICAL_STOKES + 1.0
    assert stokes.max() > 1000.0
    impacts = drops(law, speeds).impacts
    expected = 0.9 * np.exp(-35.0 / stokes)
    np.testing.assert_allclose(impacts["restitution_asked"][:, 0], expected, rtol=1e-12)
    case = "two contact laws, approach speeds 0.05 to 5 m/s"
    agrees(
        case,
        "coefficient of restitution",
        impacts["restitution_achieved"][:, 0],
        expected,
        against=CORRELATION,
        relative=1e-8,
    )


def test_each_impact_has_the_restitution_of_its_own_speed() -> None:
    impacts = drops("newton", np.array([2.0]), gravity=9.81, impacts=4).impacts
    for speed, leaving in zip(
        impacts["approach_speed_m_s"][0], impacts["separation_speed_m_s"][0], strict=True
    ):
        stokes = (2650.0 + 0.5 * 935.0) * 2.0 * RADIUS * speed / (9.0 * 0.01)
        assert leaving == pytest.approx(0.9 * np.exp(-35.0 / stokes) * speed, rel=1e-9)


@pytest.mark.parametrize(("stokes", "deviation"), [(152, 0.03), (82, 0.03), (45, 0.19)])
def test_three_measured_bounces(agrees: Agrees, stokes: int, deviation: float) -> None:
    before, after = map(speed_at_touch, TRACKS[stokes])
    assert SPHERE_DENSITY * DIAMETER * before / (9.0 * VISCOSITY) == pytest.approx(stokes, rel=0.05)
    agrees(
        f"Stokes number {stokes}",
        "coefficient of restitution",
        computed_restitution(before),
        after / before,
        relative=deviation,
    )


@pytest.mark.parametrize(
    ("stokes", "ratio", "viscosity", "radius", "speed"),
    [(27.0, 8.083, 1.036e-4, 0.003, 0.518), (152.0, 8.342, 1.070e-5, 0.0015, 0.585)],
)
def test_stokes_numbers_of_published_experiments(
    stokes: float, ratio: float, viscosity: float, radius: float, speed: float
) -> None:
    # of the oil; only the ratio of the densities and the kinematic viscosity matter
    density = 935.0
    found = vi.Liquid(density=density, viscosity=viscosity * density).stokes_number(
        speed, radius, ratio * density
    )
    assert found * ratio / (ratio + 0.5) == pytest.approx(stokes, rel=5e-3)


def test_slow_spheres_stay_and_fast_ones_rebound_as_in_air() -> None:
    assert restitution_kept(CRITICAL_STOKES) < 0.05
    assert restitution_kept(500.0) > 0.9
    assert restitution_kept(5000.0) > 0.99


WATER = Medium(998.2, 1.002e-3, 1.0, 0.5)


def fall(density: float, radius: float, medium: Medium, **how: object) -> vi.Problem:
    """Spheres that rebound as in air with 0.8 of their speed, less what the film takes."""
    ball = vi.Body(mass=4.0 / 3.0 * np.pi * radius**3 * density, contact_offset=radius)
    liquid = vi.Liquid(density=medium.density, viscosity=medium.viscosity)
    return vi.Problem(
        sphere=ball,
        plate=rigid_plate(),
        laws=(vi.laws.find_contact_law("newton")(restitution=0.8),),
        liquid=liquid,
        **how,
    )


@pytest.mark.parametrize(
    ("density", "radius"), [(2500.0, 0.005), (7850.0, 0.01), (1050.0, 0.02), (2650.0, 0.001)]
)
def test_falls_and_bounces_in_water(agrees: Agrees, density: float, radius: float) -> None:
    def restitution(speed: float) -> float:
        return 0.8 * float(
            np.exp(
                -35.0
                * 9.0
                * WATER.viscosity
                / ((density + 0.5 * WATER.density) * 2.0 * radius * speed)
            )
        )

    seen = bounces(radius, density, 0.5, restitution, 3, medium=WATER)
    response = vi.simulate(fall(density, radius, WATER, height=0.5, impacts=3))
    found, case = response.impacts, "four spheres in water, three bounces"
    agrees_on_bounces(agrees, case, found, found["rebound_height_m"], seen, SCIPY)
    assert response.energy["closure_relative"] < 1e-12
    begin = response.at(np.array([0.0]))
    assert begin["acceleration_m_s2"][0] == pytest.approx(
        -9.80665 * (density - 998.2) / (density + 499.1), rel=1e-12
    )


def test_a_glass_sphere_of_10_mm_reaches_its_terminal_speed_in_water(agrees: Agrees) -> None:
    """Drag is the weight less buoyancy: 0.70 m/s, where it would have 4.42 m/s after 1 m
    in a vacuum.
    """

    def left(speed: float) -> float:
        drag = (
            0.5
            * 998.2
            * clift_gauvin(998.2 * speed * 0.01 / 1.002e-3)
            * np.pi
            * 0.005**2
            * speed**2
        )
        return 4.0 / 3.0 * np.pi * 0.005**3 * (2500.0 - 998.2) * 9.80665 - drag

    terminal = float(brentq(left, 0.1, 5.0, xtol=1e-15))
    found = vi.simulate(fall(2500.0, 0.005, WATER, height=3.0, impacts=1)).impacts[
        "approach_speed_m_s"
    ]
    case = "glass sphere of 10 mm that falls 3 m in water"
    agrees(case, "approach speed", found, [terminal], unit="m/s", against=TERMINAL, relative=1e-10)
    assert terminal == pytest.approx(0.70, abs=0.005)


@pytest.mark.parametrize(("stokes", "apart"), [(152, 20e-6), (82, 27e-6)])
def test_falls_before_measured_bounces(agrees: Agrees, stokes: int, apart: float) -> None:
    """A parabola, as of a vacuum, leaves four times as much at a Stokes number of 152."""
    found, seen = fall_in(stokes, vi.Liquid(density=OIL_DENSITY, viscosity=VISCOSITY))
    assert np.abs(found - seen).max() < np.abs(np.subtract(*fall_in(stokes, None))).max(), (
        "of a vacuum"
    )
    agrees(
        f"Stokes number {stokes}",
        "position in the fall",
        found,
        seen,
        unit="m",
        against=FALLS,
        absolute=apart,
    )
