"""Three bounces of a sphere in a silicone oil that Gondret and others measured (Phys.
Fluids 14:643, 2002).
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import least_squares

import vibroimpact as vi
from vibroimpact.bodies.rigid_bodies import rigid_plate, rigid_sphere

DIAMETER, OIL_DENSITY, VISCOSITY = 0.003, 935.0, 1.070e-5 * 935.0
SPHERE_DENSITY = 8.342 * OIL_DENSITY
DRY_RESTITUTION = 0.97
TRACKS = {  # height of the sphere's lowest point [um] before and after an impact, every 2 ms
    152: (
        (7961.9, 6786.3, 5614.1, 4441.9, 3284.5, 2112.3, 913.97),
        (1153.4, 1999.9, 2730.7, 3384.3, 3958.5, 4522.5),
    ),
    82: (
        (3506.9, 3038.2, 2553.7, 2044.2, 1508.6, 953.69, 329.57),
        (591.7, 916.24, 1249.9, 1484.8, 1691.3, 1906.9),
    ),
    45: (
        (1593.7, 1380.3, 1142.1, 879.93, 580.35, 272.84),
        (214.96, 350.0, 452.13, 510.0, 520.21, 516.81),
    ),
}


def speed_at_touch(heights: tuple[float, ...]) -> float:
    """The speed where a parabola through heights [um], every 2 ms, passes zero [m/s]."""
    times = 2e-3 * np.arange(len(heights))
    fitted = np.polyfit(times, 1e-6 * np.array(heights), 2)
    roots = np.roots(fitted).real
    middle = times[-1] if heights[0] > heights[-1] else 0.0
    return abs(float(np.polyval(np.polyder(fitted), roots[np.argmin(abs(roots - middle))])))


def computed_restitution(speed: float) -> float:
    """Return the restitution of an impact at a speed [m/s]."""
    sphere = rigid_sphere(
        0.5 * DIAMETER,
        vi.Material(density=SPHERE_DENSITY, youngs_modulus=2.1e11, poissons_ratio=0.3),
    )
    law, oil = (
        vi.laws.find_contact_law("newton")(restitution=DRY_RESTITUTION),
        vi.Liquid(density=OIL_DENSITY, viscosity=VISCOSITY),
    )
    drop = vi.Problem(
        sphere=sphere,
        plate=rigid_plate(),
        laws=(law,),
        speed=speed,
        gravity=0.0,
        impacts=1,
        liquid=oil,
    )
    return float(vi.simulate(drop).impacts["restitution_achieved"][0])


def fall_in(stokes: int, liquid: vi.Liquid | None) -> tuple[np.ndarray, np.ndarray]:
    """Return computed and measured heights in the fall before a bounce [m]; height and
    speed at the first of them are fitted.
    """
    seen = 1e-6 * np.array(TRACKS[stokes][0])
    sphere = rigid_sphere(
        0.5 * DIAMETER,
        vi.Material(density=SPHERE_DENSITY, youngs_modulus=2.1e11, poissons_ratio=0.3),
    )
    stated = {
        "sphere": sphere,
        "plate": rigid_plate(),
        "laws": (vi.laws.find_contact_law("newton")(restitution=DRY_RESTITUTION),),
    }

    def heights(begin: np.ndarray) -> np.ndarray:
        drop = vi.Problem(
            **stated, height=0.5 * DIAMETER + begin[0], velocity=-begin[1], impacts=1, liquid=liquid
        )
        return vi.simulate(drop).at(2e-3 * np.arange(len(seen)))["position_m"] - 0.5 * DIAMETER

    start = [seen[0], (seen[0] - seen[1]) / 2e-3]
    fitted = least_squares(
        lambda begin: 1e6 * (heights(begin) - seen), start, diff_step=1e-4, x_scale=[1e-3, 0.1]
    )
    return heights(fitted.x), seen
