"""Against Lamb's free vibrations of an elastic sphere: H. Lamb, Proc. London Math. Soc. 13:189,
1882.

With eta = omega R / c_T and xi = omega R / c_L, torsional modes T of order l are the roots of (l -
1) j_l(eta) = eta j_l+1(eta), and spheroidal modes S those of a determinant of two rows (A. C.
Eringen and E. S. Suhubi, Elastodynamics 2, 1975, section 8.13). Each has 2 l + 1 shapes. The roots
are found here, and compared with the numbers that are printed for them.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import spherical_jn

from agreement import Against, Agrees
from support import one_in
from vibroimpact.bodies.elastic import sphere_recipe
from vibroimpact.materials import Material, find_material
from vibroimpact.structures.finite_elements.sphere_mesh import sphere_mesh
from vibroimpact.structures.finite_elements.structure import solid_structure
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.recipe import Reduction, computed_model
from vibroimpact.structures.supports.support import held_by

AGAINST = Against(
    "Lamb, free vibration of an elastic sphere",
    "closed form",
    "plates, spheres and modes",
    "Lamb 1882, Proc. London Math. Soc. 13, 189; Eringen and Suhubi, Elastodynamics 2, "
    "1975, section 8.13",
)


RADIUS = 0.025
ROCK = find_material("rock-paper")


def condition(eta: np.ndarray, order: int, ratio: float, family: str) -> np.ndarray:
    xi = eta * np.sqrt((1 - 2 * ratio) / (2 - 2 * ratio))
    torsion = (order - 1) * spherical_jn(order, eta) - eta * spherical_jn(order + 1, eta)
    if family == "T":
        return torsion
    ball, next_ball = spherical_jn(order, xi), spherical_jn(order + 1, xi)
    first = (order**2 - order - eta**2 / 2) * ball + 2 * xi * next_ball
    if order == 0:
        return first
    slip = (order - 1) * ball - xi * next_ball
    last = (order**2 - 1 - eta**2 / 2) * spherical_jn(order, eta) + eta * spherical_jn(
        order + 1, eta
    )
    return first * last - order * (order + 1) * torsion * slip


def roots(order: int, ratio: float, family: str, highest: float = 6.0) -> list[float]:
    grid = np.linspace(0.5, highest, 600)
    found = zip(pairwise(grid), pairwise(condition(grid, order, ratio, family)), strict=True)
    return [
        brentq(condition, *ends, (order, ratio, family), xtol=1e-13)
        for ends, (a, b) in found
        if a * b < 0
    ]


def spectrum(ratio: float, number: int) -> np.ndarray:
    """Eta of the lowest modes, each as often as it has shapes."""
    orders = {"T": range(1, 7), "S": range(7)}
    every = [
        eta
        for family, some in orders.items()
        for order in some
        for eta in roots(order, ratio, family) * (2 * order + 1)
    ]
    return np.sort(every)[:number]


def elastic(kind: str, across: int, material: Material = ROCK) -> ElasticSystem:
    held = held_by(solid_structure(sphere_mesh(RADIUS, across, kind), material))
    return ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)


def eta_of(angular: np.ndarray, material: Material = ROCK) -> np.ndarray:
    shear = material.youngs_modulus / (2 * (1 + material.poissons_ratio))
    return angular * RADIUS / np.sqrt(shear / material.density)


@pytest.mark.parametrize(
    ("family", "order", "ratio", "eta"),
    [
        ("T", 2, 0.28, 2.501133),
        ("T", 3, 0.28, 3.864700),
        ("S", 2, 0.28, 2.643768),
        ("S", 2, 0.25, 2.639869),
        ("S", 2, 0.30, 2.646217),
        ("S", 1, 0.28, 3.488696),
        ("S", 0, 0.28, 4.752453),
    ],
)
def test_printed_numbers(agrees: Agrees, family: str, order: int, ratio: float, eta: float) -> None:
    agrees(
        "roots of the frequency equations, printed values",
        "dimensionless natural frequency ω R/c_T",
        roots(order, ratio, family)[0],
        eta,
        relative=1e-6,
    )


def test_the_papers_rock(agrees: Agrees) -> None:
    """Its default mesh, as a case makes it: T2 12735.4 Hz and S2 13461.6 Hz, five times
    each, and S1 three times, within 0.1 %.
    """
    model = computed_model(sphere_recipe(RADIUS, ROCK, Reduction(modes=13)))
    assert len(model.rigid_coefficients) == 6
    agrees(
        "the paper's rock sphere, default mesh",
        "natural frequency of mode T2",
        model.frequencies[:5],
        12735.4,
        unit="Hz",
        relative=1e-3,
    )
    agrees(
        "the paper's rock sphere, default mesh",
        "natural frequency of mode S2",
        model.frequencies[5:10],
        13461.6,
        unit="Hz",
        relative=1e-3,
    )
    agrees(
        "the paper's rock sphere, default mesh",
        "dimensionless natural frequencies ω R/c_T, 13 modes",
        eta_of(model.angular_frequencies),
        spectrum(0.28, 13),
        relative=1e-3,
    )
    np.testing.assert_allclose(model.participation, 0.0, atol=1e-9)  # free modes carry no momentum


@pytest.mark.parametrize(
    "ratio",
    [
        pytest.param(0.0, marks=pytest.mark.slow),
        0.25,
        pytest.param(0.30, marks=pytest.mark.slow),
        pytest.param(0.45, marks=pytest.mark.slow),
    ],
)
@pytest.mark.slow
def test_other_materials(agrees: Agrees, ratio: float) -> None:
    """The order of the multiplets changes with Poisson's ratio."""
    material = Material(2500.0, 60e9, ratio)
    modes = elastic("hex27", 8, material).modes(10)
    found = eta_of(modes.angular_frequencies, material)
    agrees(
        "Poisson's ratios 0 to 0.45",
        "dimensionless natural frequencies ω R/c_T, 10 modes",
        found,
        spectrum(ratio, 10),
        relative=1e-3,
    )


@pytest.mark.parametrize("kind", one_in(2, ["hex20", "tet10"]))
def test_other_elements(agrees: Agrees, kind: str) -> None:
    """Within 0.2 %."""
    found = eta_of(elastic(kind, 8).modes(13).angular_frequencies)
    agrees(
        "other element types, 8 elements across the diameter",
        "dimensionless natural frequencies ω R/c_T, 13 modes",
        found,
        spectrum(0.28, 13),
        relative=2e-3,
    )


def test_numbers_that_cut_a_multiplet() -> None:
    coarse = elastic("hex20", 4)
    every = coarse.modes(20).angular_frequencies
    for cut in (1, 3, 7, 12):
        np.testing.assert_allclose(coarse.modes(cut).angular_frequencies, every[:cut], rtol=1e-9)


@pytest.mark.slow
def test_fine_mesh(agrees: Agrees) -> None:
    """12 elements across: T2, S2 and S1 within 0.01 %, and all of the lowest 41 modes, to
    eta = 5, within 0.1 %.
    """
    modes = elastic("hex27", 12).modes(41)
    exact = spectrum(0.28, 41)
    assert np.isclose(exact, 4.752453, rtol=1e-6).sum() == 1  # S0 is among them, once
    found = eta_of(modes.angular_frequencies)
    agrees(
        "12 elements across the diameter",
        "dimensionless natural frequencies ω R/c_T, modes T2, S2 and S1",
        found[:13],
        exact[:13],
        relative=1e-4,
    )
    agrees(
        "12 elements across the diameter",
        "dimensionless natural frequencies ω R/c_T, 41 modes",
        found,
        exact,
        relative=1e-3,
    )


@pytest.mark.slow
def test_mass_converges() -> None:
    """A sphere of curved elements gains its mass with the fourth power of their size;
    inertia is 2/5 m R^2.
    """
    exact = 4 / 3 * np.pi * RADIUS**3 * ROCK.density
    properties = [
        solid_structure(sphere_mesh(RADIUS, across, "hex27"), ROCK).properties
        for across in (4, 8, 16)
    ]
    errors = [abs(found.mass / exact - 1) for found in properties]
    assert errors[1] < 2e-4
    assert all(np.log2(coarse / fine) > 3.8 for coarse, fine in pairwise(errors))
    np.testing.assert_allclose(
        properties[-1].inertia, 0.4 * exact * RADIUS**2 * np.eye(3), rtol=2e-5, atol=1e-15
    )
    np.testing.assert_allclose(properties[-1].centre, 0.0, atol=1e-12)


@pytest.mark.slow
@pytest.mark.whole
def test_finest_mesh() -> None:
    """16 elements across: every frequency printed for nu = 0.28 within 0.01 %, with its
    multiplicity.
    """
    found = eta_of(elastic("hex27", 16).modes(41).angular_frequencies)
    for eta, times in ((2.501133, 5), (2.643768, 5), (3.488696, 3), (3.864700, 7), (4.752453, 1)):
        assert np.isclose(found, eta, rtol=1e-4).sum() == times
