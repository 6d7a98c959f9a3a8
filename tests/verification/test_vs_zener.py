r"""Zener's sphere on an infinite thin plate, against a plate so large that no wave comes back
during the contact.

An infinite plate gives way at a speed in proportion to the force, :math:`\dot w = F / (8 \sqrt{D
\rho h})`, which takes energy away for
good. In Hertz's contact of a mass m at a speed v one parameter is left, :math:`\lambda = m / (8
\sqrt{D \rho h}\, T)` with :math:`T = (m
/ (K \sqrt v))^{2/5}`; the restitution is that of :math:`\sigma'' + (1 + \lambda\, d/d\tau)
\sigma^{3/2} = 0`. The plate here is square
and simply supported, with closed-form modes of Kirchhoff's theory, without damping; what its modes
leave out of its static compliance, 0.01160084 L^2 / D in all, is in series with the law.

Source: Zener, C. (1941). The intrinsic inelasticity of large plates. Phys. Rev. 59, 669-673.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import vibroimpact as vi
from agreement import Against, Agrees
from oracles.three_dimensional_plate import (
    PMMA,
    STEEL,
    Elastic,
    Impact,
    contact_time,
    hertz,
    impact,
)
from vibrating import STIFFNESS, drop_on, modes_of
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.quasi_static import QuasiStatic

AGAINST = Against(
    "Zener, impact of a sphere on an infinite plate",
    "closed form",
    "impacts on vibrating bodies",
    "Zener 1941, Phys. Rev. 59, 669, doi 10.1103/PhysRev.59.669; Zener's equation "
    "integrated by SciPy at a tolerance of 1e-10",
)


NAVIER = Against(
    "Kirchhoff plate, Navier series",
    "own independent computation",
    "impacts on vibrating bodies",
    "closed-form modes; time integration by tests/oracles/three_dimensional_plate.py",
)

MASS, SPEED, SIDE = 0.09032078879, 8.826664149, 30.0
TIME = (MASS / (STIFFNESS * np.sqrt(SPEED))) ** 0.4
TABLE = [
    (0.05, 0.917772),
    (0.1, 0.843339),
    (0.2, 0.714045),
    (0.5, 0.436895),
    (1.0, 0.184123),
    (0.17680, 0.74196),
]


def plate_response(
    inelasticity: float, highest: float = 60.0, residual: bool = True, side: float = SIDE
) -> vi.Response:
    """The impact on a plate of side SIDE * sqrt(c T), c = sqrt(D / rho h) = 1, with the
    modes up to `highest` / T.
    """
    rigidity = MASS / (8.0 * inelasticity * TIME)  # and mass per area
    length = side * np.sqrt(TIME)
    # those with a node line at the centre are not met
    number = 2 * np.arange(int(np.sqrt(highest / TIME) * length / np.pi)) + 1
    omega = (np.pi / length) ** 2 * (number[:, None] ** 2 + number**2).ravel()
    omega = np.sort(omega[omega < highest / TIME])
    shape = 2.0 / np.sqrt(rigidity * length**2)
    left_out = 0.01160084 * length**2 / rigidity - float((shape**2 / omega**2).sum())
    modes = modes_of(omega / (2.0 * np.pi), shape)
    series = QuasiStatic(linear=left_out if residual else 0.0)
    return vi.simulate(
        drop_on(Hertz(stiffness=STIFFNESS), modes, speed=SPEED, gravity=0.0, quasi_static=series)
    )


@pytest.mark.parametrize(("inelasticity", "restitution"), TABLE)
def test_restitution(agrees: Agrees, inelasticity: float, restitution: float) -> None:
    response = plate_response(inelasticity)
    assert response.impacts["contacts"][0] == 1
    case = "inelasticity parameter 0.05 to 1, closed-form modes of a large plate"
    agrees(
        case,
        "coefficient of restitution",
        response.impacts["restitution_achieved"],
        restitution,
        relative=3e-5,
    )
    part = response.impacts["energy_to_vibration_J"] / response.energy["input_J"]
    agrees(
        case,
        "vibration energy of the plate, normalized by the input energy",
        part,
        1.0 - restitution**2,
        relative=3e-5,
    )


def test_history_of_the_force(agrees: Agrees) -> None:
    """Of the equation of Zener itself: peak, duration, and its course, as a part of the peak."""
    inelasticity = 0.1768
    exact = contact(inelasticity, 10.0, dense_output=True)
    response = plate_response(inelasticity)
    end = float(response.impacts["duration_s"][0]) / TIME
    agrees(
        "inelasticity parameter 0.1768",
        "contact duration, in Zener's unit of time",
        end,
        exact.t[-1],
        relative=1e-4,
    )
    tau = np.linspace(0.0, 0.999 * min(end, exact.t[-1]), 200)
    unit = MASS * SPEED / TIME
    force = np.maximum(exact.sol(tau)[0], 0.0) ** 1.5
    agrees(
        "inelasticity parameter 0.1768",
        "maximum contact force",
        response.impacts["max_force_N"],
        unit * force.max(),
        unit="N",
        relative=1e-4,
    )
    found = response.at(tau * TIME)["force_N"] / unit
    agrees(
        "inelasticity parameter 0.1768",
        "contact force history, in Zener's unit of force",
        found,
        force,
        of_the_largest=1e-3,
    )


def test_what_is_not_an_infinite_plate() -> None:
    """Where waves come back during the contact, and where the compliance of the modes
    left out is forgotten.
    """
    assert plate_response(0.1768, side=5.0).impacts["restitution_achieved"][0] < 0.95 * 0.74196
    assert plate_response(1.0, residual=False).impacts["restitution_achieved"][0] < 0.99 * 0.184123


def kirchhoff(
    side: float, radius: float, modes: int, theory: str = "thin"
) -> tuple[vi.Response, Impact, float]:
    """A steel ball at 1 m/s on 5 mm of PMMA: the package's plate, the Navier series of
    Kirchhoff's plate, and the inelasticity.
    """
    size, place, thickness = (side, 0.9 * side, 0.005), (0.013, 0.007), 0.005
    mass, stiffness = hertz(PMMA, radius, STEEL)
    rigidity = PMMA.modulus * thickness**3 / (12.0 * (1.0 - PMMA.ratio**2))
    area = PMMA.density * thickness
    waves = [np.arange(1, 1200) * np.pi / length for length in size[:2]]
    omega = np.sqrt(rigidity / area) * (waves[0][:, None] ** 2 + waves[1] ** 2)
    sines = [
        np.sin(k * (at + 0.5 * length))
        for k, at, length in zip(waves, place, size[:2], strict=True)
    ]
    shape = 2.0 / np.sqrt(area * size[0] * size[1]) * np.outer(*sines)
    time = contact_time(PMMA, radius, STEEL, 1.0)
    kept = omega < 2.0 * np.pi * 60.0 / time
    rest = float(((shape / omega)[~kept] ** 2).sum())
    series = impact(mass, stiffness, 1.0, omega[kept], shape[kept], rest, time / 1500, 4500)

    def material(given: Elastic) -> dict[str, float]:
        return {
            "density": given.density,
            "youngs_modulus": given.modulus,
            "poissons_ratio": given.ratio,
        }

    plate = {
        "size": list(size),
        "material": material(PMMA),
        "model": "elastic",
        "supports": "simply-supported",
        "modes": modes,
    }
    case = {
        "sphere": {"radius": radius, "material": material(STEEL)},
        "plate": {**plate, "mesh": {"theory": theory}},
        "drop": {"speed": 1.0, "position": list(place), "gravity": 0.0},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1},
    }
    inelasticity = mass / (8.0 * np.sqrt(rigidity * area) * (mass / stiffness) ** 0.4)
    return vi.simulate(vi.case_of(case)), series, float(inelasticity)


@pytest.mark.slow
def test_the_thin_theory_is_kirchhoffs(agrees: Agrees) -> None:
    """With point shapes and the deflection of a point, which is finite, a plate of thin
    elements meets the Navier series.
    """
    response, series, _ = kirchhoff(0.1, 0.003, 80)
    row = response.impacts
    case = "steel sphere on PMMA, thin-plate elements"
    agrees(
        case,
        "maximum contact force",
        row["max_force_N"],
        series.force,
        unit="N",
        against=NAVIER,
        relative=5e-3,
    )
    agrees(
        case,
        "contact duration",
        row["duration_s"],
        series.duration,
        unit="s",
        against=NAVIER,
        relative=5e-3,
    )
    agrees(
        case,
        "coefficient of restitution",
        row["restitution_achieved"],
        series.restitution,
        against=NAVIER,
        relative=5e-3,
    )


@pytest.mark.slow
def test_a_large_plate_of_thin_elements(agrees: Agrees) -> None:
    """Zener's restitution, on a plate from whose edges no wave comes back in time; thick
    theory, which is nearer the truth, is not that.
    """
    response, series, inelasticity = kirchhoff(0.2, 0.003, 300)
    exact = restitution(inelasticity)
    assert series.restitution == pytest.approx(exact, rel=1e-3)
    agrees(
        "large plate, thin-plate elements",
        "coefficient of restitution",
        response.impacts["restitution_achieved"],
        exact,
        relative=5e-3,
    )
    thick, _, _ = kirchhoff(0.2, 0.003, 300, "thick")
    assert thick.impacts["restitution_achieved"][0] != pytest.approx(exact, rel=2e-2)


def restitution(inelasticity: float) -> float:
    """Of Zener's equation."""
    return -float(contact(inelasticity, 20.0).y[1, -1])


def contact(inelasticity: float, longest: float, **options: Any) -> Any:
    """Zener's equation, integrated by SciPy until the sphere leaves."""

    def slopes(_: float, y: np.ndarray) -> list[float]:
        root = np.sqrt(max(y[0], 0.0))
        return [y[1], -root * max(y[0], 0.0) - 1.5 * inelasticity * root * y[1]]

    def apart(_: float, y: np.ndarray) -> float:
        return float(y[0])

    apart.terminal, apart.direction = True, -1  # type: ignore[attr-defined]
    return solve_ivp(
        slopes,
        (0.0, longest),
        [0.0, 1.0],
        method="DOP853",
        rtol=1e-10,
        atol=1e-12,
        events=apart,
        **options,
    )
