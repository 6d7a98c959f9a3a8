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


TRACKS = {  # height of the sphere's lowest point [um] before and after an impact, every 2 ms
    152: ((7961.9, 6786.3, 5614.1, 4441.9, 3284.5, 2112.3, 913.97), (1153.4, 1999.9, 2730.7, 3384.3, 3958.5, 4522.5)),
    82: ((3506.9, 3038.2, 2553.7, 2044.2, 1508.6, 953.69, 329.57), (591.7, 916.24, 1249.9, 1484.8, 1691.3, 1906.9)),
    45: ((1593.7, 1380.3, 1142.1, 879.93, 580.35, 272.84), (214.96, 350.0, 452.13, 510.0, 520.21, 516.81)),
}


def speed_at_touch(heights: tuple[float, ...]) -> float:
    """The speed where a parabola through heights [um], every 2 ms, passes zero [m/s]."""
    times = 2e-3 * np.arange(len(heights))
    fitted = np.polyfit(times, 1e-6 * np.array(heights), 2)
    roots = np.roots(fitted).real
    middle = times[-1] if heights[0] > heights[-1] else 0.0
    return abs(float(np.polyval(np.polyder(fitted), roots[np.argmin(abs(roots - middle))])))


@pytest.mark.parametrize(("stokes", "deviation"), [(152, 0.03), (82, 0.03), (45, 0.19)])
def test_three_measured_bounces(agrees: Agrees, stokes: int, deviation: float) -> None:
    before, after = map(speed_at_touch, TRACKS[stokes])
    density, oil = 8.342 * 935.0, vi.Liquid(density=935.0, viscosity=1.070e-5 * 935.0)
    assert density * 0.003 * before / (9.0 * 1.070e-5 * 935.0) == pytest.approx(stokes, rel=0.05)
    sphere = rigid_sphere(0.0015, vi.Material(density=density, youngs_modulus=2.1e11, poissons_ratio=0.3))
    law = vi.find_contact_law("newton")(restitution=0.97)
    drop = vi.Problem(sphere=sphere, plate=rigid_plate(), laws=(law,), speed=before, gravity=0.0, impacts=1, liquid=oil)
    computed = float(vi.simulate(drop).impacts["restitution_achieved"][0])
    agrees(
        f"Stokes number {stokes}",
        "coefficient of restitution",
        computed,
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
