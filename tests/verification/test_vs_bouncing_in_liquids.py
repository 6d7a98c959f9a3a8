"""Rebounds in liquids against what was published on spheres that meet walls in them.

* The correlation e/e_air = exp(-35/St) of Legendre and others (2006, Chem. Eng. Sci. 61:3543), St = (rho + rho_f/2) d v/(9 mu), written
  here a second time.
* Stokes numbers of two experiments of Gondret and others (2002, Phys. Fluids 14:643), with spheres in silicone oils, as Biegert and
  others tell them (2017, J. Comput. Phys. 340:105, Table 1): these are without the half mass of the liquid.
* Three bounces of the second of these spheres, 3 mm of the density of steel: its places every 2 ms, read off Gondret's figure by the
  authors of the program PARTIES (test case "Gondret", file gondret152_expy.dat). With other numbers of places in the parabolas the
  restitutions differ by up to 7 %.
* Joseph and others (2001, J. Fluid Mech. 433:329): no rebound below a Stokes number of about 10; above 500 the restitution is near that
  in air.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from agreement import Against, Agrees
from bounces_in_oil import DIAMETER, SPHERE_DENSITY, TRACKS, VISCOSITY, computed_restitution, speed_at_touch
from vibroimpact.bodies.rigid import rigid_plate, rigid_sphere
from vibroimpact.dynamics.liquid import CRITICAL_STOKES, restitution_kept

AGAINST = Against(
    "Gondret et al., measured rebounds of a sphere in silicone oil",
    "fitted to measurements",
    "flight, bounces and shaken plates",
    "Gondret et al. 2002, Phys. Fluids 14, 643, to whose measurements Legendre et al. 2006, Chem. Eng. Sci. 61, 3543, fitted the "
    "correlation; positions as digitized in the test case of the program PARTIES",
)
CORRELATION = Against(
    "correlation of Legendre et al., e/e_air = exp(-35/St)",
    "closed form",
    "flight, bounces and shaken plates",
    "Legendre et al. 2006, Chem. Eng. Sci. 61, 3543; evaluated separately in the test",
)


QUARTZ = vi.Material(density=2650.0, youngs_modulus=60e9, poissons_ratio=0.17)
RADIUS, OIL = 0.003, vi.Liquid(density=935.0, viscosity=0.01)


def drops(law: str, speeds: np.ndarray, **options: object) -> vi.Response:
    found = vi.find_contact_law(law)
    pair = {"stiffness": 1e9, "restitution": 0.9}
    more = {"effective_mass": rigid_sphere(RADIUS, QUARTZ).mass}
    law_of = found(**{key: value for key, value in {**pair, **more}.items() if key in found.__dataclass_fields__})
    stated = {"sphere": rigid_sphere(RADIUS, QUARTZ), "plate": rigid_plate(), "gravity": 0.0, "impacts": 1, **options}
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
    agrees(case, "coefficient of restitution", impacts["restitution_achieved"][:, 0], expected, against=CORRELATION, relative=1e-8)


def test_each_impact_has_the_restitution_of_its_own_speed() -> None:
    impacts = drops("newton", np.array([2.0]), gravity=9.81, impacts=4).impacts
    for speed, next_speed in zip(impacts["approach_speed_m_s"][0, :-1], impacts["approach_speed_m_s"][0, 1:], strict=True):
        stokes = (2650.0 + 0.5 * 935.0) * 2.0 * RADIUS * speed / (9.0 * 0.01)
        assert next_speed == pytest.approx(0.9 * np.exp(-35.0 / stokes) * speed, rel=1e-9)


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
    ("stokes", "ratio", "viscosity", "radius", "speed"), [(27.0, 8.083, 1.036e-4, 0.003, 0.518), (152.0, 8.342, 1.070e-5, 0.0015, 0.585)]
)
def test_stokes_numbers_of_published_experiments(stokes: float, ratio: float, viscosity: float, radius: float, speed: float) -> None:
    density = 935.0  # of the oil; only the ratio of the densities and the kinematic viscosity matter
    found = vi.Liquid(density=density, viscosity=viscosity * density).stokes_number(speed, radius, ratio * density)
    assert found * ratio / (ratio + 0.5) == pytest.approx(stokes, rel=5e-3)


def test_slow_spheres_stay_and_fast_ones_rebound_as_in_air() -> None:
    assert restitution_kept(CRITICAL_STOKES) < 0.05
    assert restitution_kept(500.0) > 0.9
    assert restitution_kept(5000.0) > 0.99
