"""Against NAFEMS' benchmarks of plates: Selected Benchmarks for Natural Frequency Analysis, FV12,
FV13 and FV21.

FV13's printed targets are Navier's closed form, FV21's are Mindlin's with his shear factor pi^2/12.
FV12's are up to 1 % high from the fourth on: Ritz's method with Legendre's polynomials gives
converged ones. The plate element has 5 / (6 - nu) unless told otherwise, with which it meets the
exact solution in three dimensions to 0.03 % (45.971, 109.857, 168.819, 205.865 Hz; 0.2 to 0.7 %
above the targets).
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.linalg import eigh

from agreement import Against, Agrees
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh, solid_plate_mesh
from vibroimpact.structures.finite_elements.structure import (
    Structure,
    plate_structure,
    solid_structure,
)
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.support import Support, held_by

AGAINST = Against(
    "NAFEMS benchmark FV12, free plate",
    "published computation",
    "plates, spheres and modes",
    "NAFEMS, Selected Benchmarks for Natural Frequency Analysis, 1987",
)
RITZ = Against(
    "Ritz's method with Legendre polynomials, free thin plate",
    "own independent computation",
    "plates, spheres and modes",
    "Kirchhoff's plate, polynomials to degree 11, in the test",
)
NAVIER = Against(
    "Navier, thin simply supported plate: NAFEMS benchmark FV13",
    "closed form",
    "plates, spheres and modes",
    "printed targets of NAFEMS, Selected Benchmarks for Natural Frequency Analysis, 1987, "
    "which are Navier's closed form",
)
MINDLIN = Against(
    "Mindlin plate theory, simply supported plate: NAFEMS benchmark FV21",
    "closed form",
    "plates, spheres and modes",
    "Mindlin 1951, J. Appl. Mech. 18, 31, of which NAFEMS' printed targets are values",
)
EXACT = Against(
    "three-dimensional elasticity, NAFEMS benchmark FV21",
    "own independent computation",
    "plates, spheres and modes",
    "Legendre polynomials through the thickness, as in tests/verification/test_vs_navier.py",
)


STEEL = Material(8000.0, 200e9, 0.3)
SIMPLY = tuple(Edge(edge, "simply-supported") for edge in EDGES)
PAIRS = ((1, 1), (1, 2), (2, 2), (1, 3))


def frequencies(structure: Structure, supports: tuple[Support, ...], number: int) -> np.ndarray:
    held = held_by(structure, supports)
    assert held.rigid.shape[1] == (0 if supports else 6)
    return ElasticSystem(held.stiffness, held.mass, held.rigid, held.order).modes(
        number
    ).angular_frequencies / (2 * np.pi)


def free_plate_by_ritz(number: int, degree: int = 12) -> np.ndarray:
    """Return the lowest frequencies of FV12 [Hz], after three rigid motions, with
    `degree` polynomials along each side.
    """
    at, weights = legendre.leggauss(degree + 4)
    values, slopes, curvatures = (
        np.array([legendre.legval(at, legendre.legder(one, order)) for one in np.eye(degree)])
        for order in range(3)
    )

    def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return (a * weights) @ b.T

    mass, bent, mixed = (
        product(values, values),
        product(curvatures, curvatures),
        product(curvatures, values),
    )
    across, twisted = np.kron(mixed, mixed.T), product(slopes, slopes)
    stiffness = (
        np.kron(bent, mass)
        + np.kron(mass, bent)
        + 0.3 * (across + across.T)
        + 1.4 * np.kron(twisted, twisted)
    )
    squares = eigh(stiffness, np.kron(mass, mass), eigvals_only=True)[3 : 3 + number]
    rigidity, mass_per_area, half = 200e9 * 0.05**3 / (12 * 0.91), 8000 * 0.05, 5.0
    return np.sqrt(squares * rigidity / mass_per_area) / (2 * np.pi * half**2)


def plates(
    thickness: float, element_size: float, theory: str = "thick", factor: float | None = None
) -> Structure:
    return plate_structure(plate_mesh((10.0, 10.0), element_size), STEEL, thickness, theory, factor)


def mindlin(m: int, n: int, thickness: float, factor: float) -> float:
    squared = np.pi**2 * (m**2 + n**2) / 100
    shear = factor * 200e9 / 2.6 * thickness
    rigidity, mass, inertia = (
        200e9 * thickness**3 / (12 * 0.91),
        8000 * thickness,
        8000 * thickness**3 / 12,
    )
    polynomial = [
        mass * inertia,
        -mass * (rigidity * squared + shear) - inertia * shear * squared,
        rigidity * shear * squared**2,
    ]
    return float(np.sqrt(np.roots(polynomial).min()) / (2 * np.pi))


@pytest.mark.parametrize("theory", ["thick", "thin"])
def test_fv13_thin_and_simply_supported(agrees: Agrees, theory: str) -> None:
    found = frequencies(plates(0.05, 2.0, theory), SIMPLY, 4)
    printed = [2.377, 5.942, 5.942, 9.507]
    agrees(
        "FV13, thin simply supported plate",
        "natural frequencies",
        found,
        printed,
        unit="Hz",
        against=NAVIER,
        relative=1e-3,
    )


def test_fv12_thin_and_free(agrees: Agrees) -> None:
    found, converged = frequencies(plates(0.05, 1.25), (), 7), free_plate_by_ritz(7)
    printed = [1.622, 2.360, 2.922, 4.233, 4.233, 7.416]
    agrees(
        "FV12, thin free plate, first to third mode",
        "natural frequencies",
        found[:3],
        printed[:3],
        unit="Hz",
        relative=1e-3,
    )
    agrees(
        "FV12, thin free plate, fourth to sixth mode",
        "natural frequencies",
        found[3:6],
        printed[3:],
        unit="Hz",
        relative=0.011,
    )
    agrees(
        "FV12, thin free plate",
        "natural frequencies",
        found,
        converged,
        unit="Hz",
        against=RITZ,
        relative=1e-3,
    )


@pytest.mark.slow
def test_fv12_with_bricks(agrees: Agrees) -> None:
    structure = solid_structure(solid_plate_mesh((10.0, 10.0, 0.05), 0.25), STEEL)
    converged = free_plate_by_ritz(5)
    agrees(
        "FV12, solid elements",
        "natural frequencies",
        frequencies(structure, (), 5),
        converged,
        unit="Hz",
        against=RITZ,
        relative=1e-3,
    )


@pytest.mark.parametrize(
    ("factor", "targets", "tolerance"),
    [
        (np.pi**2 / 12, (45.897, 109.44, 167.89, 204.51), 1e-4),
        (None, (45.971, 109.857, 168.819, 205.865), 3e-4),
    ],
    ids=["as printed", "in three dimensions"],
)
def test_fv21_thick_and_simply_supported(
    agrees: Agrees, factor: float | None, targets: tuple[float, ...], tolerance: float
) -> None:
    found = frequencies(plates(1.0, 2.0, factor=factor), SIMPLY, 8)
    at = [0, 1, 5, 6]  # the fourth and fifth move in the plane of the plate
    case = (
        "FV21, thick simply supported plate, Mindlin's shear correction factor"
        if factor
        else "FV21, thick simply supported plate, three-dimensional elasticity"
    )
    agrees(
        case,
        "natural frequencies",
        found[at],
        targets,
        unit="Hz",
        against=MINDLIN if factor else EXACT,
        relative=tolerance,
    )
    exact = [mindlin(*pair, 1.0, factor or 5 / 5.7) for pair in PAIRS]
    agrees(
        "FV21, thick simply supported plate",
        "natural frequencies",
        found[at],
        exact,
        unit="Hz",
        against=MINDLIN,
        relative=1e-4,
    )
    np.testing.assert_allclose(found[[3, 4]], np.sqrt(200e9 / 2.6 / 8000) / 20, rtol=1e-6)


def test_fv21_targets_have_mindlins_factor() -> None:
    found = [mindlin(*pair, 1.0, np.pi**2 / 12) for pair in PAIRS]
    np.testing.assert_allclose(found, [45.897, 109.44, 167.89, 204.51], rtol=1e-4)


@pytest.mark.slow
def test_fv21_with_bricks(agrees: Agrees) -> None:
    """Three layers of bricks, within 0.1 % of the exact solution in three dimensions
    (test_vs_navier has it).
    """
    structure = solid_structure(solid_plate_mesh((10.0, 10.0, 1.0), 1.0, 3, "hex27"), STEEL)
    found = frequencies(structure, SIMPLY, 6)[[0, 1, 5]]
    agrees(
        "FV21, solid elements, three-dimensional elasticity",
        "natural frequencies",
        found,
        [45.971, 109.857, 168.819],
        unit="Hz",
        against=EXACT,
        relative=1e-3,
    )
