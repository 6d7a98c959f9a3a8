"""Bodies of two materials against closed forms: a bar in two parts, layers side by side,
a sandwich beam; and scikit-fem's own assembly.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.sparse.linalg import eigsh, spsolve

import vibroimpact as vi
from agreement import Against, Agrees
from support import plain_case
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.structure import solid_structure

AGAINST = Against(
    "closed forms of bars and beams of two materials, and the assembly of scikit-fem",
    "closed form",
    "plates, spheres and modes",
    "without lateral contraction one-dimensional theory is exact in bars; scikit-fem takes "
    "elastic constants per element",
)

STEEL = Material(7850.0, 210e9, 0.0, name="steel")
RUBBER = Material(1100.0, 10e6, 0.0, name="rubber")
ALUMINIUM = Material(2700.0, 70e9, 0.0, name="aluminium")


def of_two(
    mesh: Mesh, one: Material, other: Material, is_other: Callable[[np.ndarray], np.ndarray]
) -> Mesh:
    """A mesh whose elements are of the other material where their centres are so."""
    centres = np.concatenate([mesh.nodes[block.connectivity].mean(axis=1) for block in mesh.blocks])
    return replace(mesh, materials=(one, other), element_materials=is_other(centres).astype(int))


def test_longitudinal_vibration_of_a_bar_in_two_parts(agrees: Agrees) -> None:
    """Held at the end of steel: E1 k1 cot(k1 L1) = E2 k2 tan(k2 L2)."""
    mesh = of_two(box_mesh((2.0, 0.1, 0.1), (60, 1, 1)), STEEL, ALUMINIUM, lambda at: at[:, 0] > 0)
    structure = solid_structure(mesh, RUBBER)
    free = np.flatnonzero(mesh.nodes[:, 0] > -1.0 + 1e-9)
    # along x alone
    stiffness, mass = (
        matrix.tocsr()[3 * free][:, 3 * free] for matrix in (structure.stiffness, structure.mass)
    )
    squares = eigsh(stiffness.tocsc(), 4, mass.tocsc(), sigma=0.0, return_eigenvectors=False)

    def misfit(omega: float) -> float:
        first, second = (
            omega * math.sqrt(one.density / one.youngs_modulus) for one in (STEEL, ALUMINIUM)
        )
        return STEEL.youngs_modulus * first * math.cos(first) * math.cos(
            second
        ) - ALUMINIUM.youngs_modulus * second * math.sin(first) * math.sin(second)

    grid = np.linspace(1.0, 40e3, 4001)
    values = np.array([misfit(omega) for omega in grid])
    roots = [
        brentq(misfit, grid[at], grid[at + 1])
        for at in np.flatnonzero(values[1:] * values[:-1] < 0)
    ][:4]
    for number, (ours, theirs) in enumerate(zip(np.sort(np.sqrt(squares)), roots, strict=True), 1):
        agrees(
            "a bar half steel, half aluminium, held at one end",
            f"frequency of longitudinal mode {number}",
            ours,
            theirs,
            unit="rad/s",
            relative=1e-6,
        )
    agrees(
        "a bar half steel, half aluminium",
        "mass",
        structure.properties.mass,
        0.01 * (7850 + 2700),
        unit="kg",
        relative=1e-12,
    )
    first, second = 0.01 * 7850, 0.01 * 2700
    centre = 0.5 * (second - first) / (first + second)
    agrees(
        "a bar half steel, half aluminium",
        "centre of mass",
        structure.properties.centre[0],
        centre,
        unit="m",
        relative=1e-12,
    )
    turning = sum(
        part * ((1 + 0.1**2) / 12 + (at - centre) ** 2)
        for part, at in ((first, -0.5), (second, 0.5))
    )
    agrees(
        "a bar half steel, half aluminium",
        "moment of inertia",
        structure.properties.inertia[1, 1],
        turning,
        unit="kg m^2",
        relative=1e-12,
    )


@pytest.mark.parametrize("way", ["one behind the other", "side by side"])
def test_stiffness_of_two_materials_in_tension(agrees: Agrees, way: str) -> None:
    axis = 0 if way == "one behind the other" else 2
    mesh = of_two(
        box_mesh((2.0, 0.1, 0.1), (8, 2, 2), "hex8"), STEEL, RUBBER, lambda at: at[:, axis] > 0
    )
    stiffness = solid_structure(mesh, STEEL).stiffness.tocsc()
    x = mesh.nodes[:, 0]
    moved, held = 3 * np.flatnonzero(x > 1.0 - 1e-9), 3 * np.flatnonzero(x < -1.0 + 1e-9)
    inner = np.setdiff1d(
        np.arange(stiffness.shape[0]),
        np.concatenate([moved, held, np.arange(len(x)) * 3 + 1, np.arange(len(x)) * 3 + 2]),
    )
    motion = np.zeros(stiffness.shape[0])
    motion[moved] = 1.0
    motion[inner] = spsolve(stiffness[inner][:, inner], -(stiffness @ motion)[inner])
    first, second = (0.01 * one.youngs_modulus for one in (STEEL, RUBBER))
    theirs = 1.0 / (1.0 / first + 1.0 / second) if axis == 0 else 0.5 * (first + second) / 2.0
    agrees(
        f"steel and rubber {way}",
        "stiffness in tension",
        float((stiffness @ motion)[moved].sum()),
        theirs,
        unit="N/m",
        relative=1e-9,
    )


def test_a_sandwich_beam_from_a_deck(agrees: Agrees, tmp_path: Path) -> None:
    """Faces of steel on a core of aluminium, free: f = 4.7300^2 / (2 pi L^2) sqrt(EI /
    rho A), with EI and rho A of the layers.
    """
    made = box_mesh((1.0, 0.02, 0.012), (40, 1, 3))
    vi.meshes.write_nastran(
        of_two(made, STEEL, ALUMINIUM, lambda at: np.abs(at[:, 2]) < 0.002),
        tmp_path / "beam.bdf",
        STEEL,
    )
    case = plain_case(
        plate={
            "material": {"density": 7850, "youngs_modulus": 210e9, "poissons_ratio": 0.0},
            "model": "elastic",
            "supports": "free",
        }
        | {"modes": 8, "mesh": str(tmp_path / "beam.bdf")},
        drop={"speed": 1.0, "gravity": 0.0},
    )
    found = vi.compute_modes(vi.case_of(case))["plate"]
    per_length = 0.02 * (0.008 * 7850 + 0.004 * 2700)
    rigidity = 0.02 / 12 * (70e9 * 0.004**3 + 210e9 * (0.012**3 - 0.004**3))
    theirs = 4.730041**2 / (2 * math.pi) * math.sqrt(rigidity / per_length)
    agrees(
        "a free sandwich beam of steel and aluminium",
        "mass",
        found.model.properties.mass,
        per_length,
        unit="kg",
        relative=1e-9,
    )
    agrees(
        "a free sandwich beam of steel and aluminium",
        "frequency of the first bending mode",
        found.model.frequencies[0],
        theirs,
        unit="Hz",
        relative=2e-3,
    )


@pytest.mark.parametrize("kind", ["hex20", "tet10"])
def test_matrices_against_another_assembly(agrees: Agrees, kind: str) -> None:
    """Every entry, with materials that differ from element to element, and lateral contraction."""
    from skfem import (
        Basis,
        BilinearForm,
        ElementHex1,
        ElementHexS2,
        ElementTetP1,
        ElementTetP2,
        ElementVector,
        MeshHex,
        MeshTet,
    )
    from skfem.helpers import ddot, dot, eye, sym_grad, trace

    mesh = box_mesh((1.0, 0.7, 0.4), (3, 2, 2), kind)
    choose = np.random.default_rng(4)
    materials = tuple(
        Material(*choose.uniform([1e3, 1e9, 0.0], [9e3, 3e11, 0.45])) for _ in range(5)
    )
    mesh = replace(
        mesh, materials=materials, element_materials=choose.integers(-1, 5, mesh.number_of_elements)
    )
    body = Material(500.0, 5e9, 0.2)
    ours = solid_structure(mesh, body)

    (block,) = mesh.blocks
    corners = block.connectivity[:, : block.element.corners]
    used, places = np.unique(corners, return_inverse=True)
    element, corner, kind_of_mesh = (
        (ElementHexS2(), ElementHex1(), MeshHex)
        if kind == "hex20"
        else (ElementTetP2(), ElementTetP1(), MeshTet)
    )
    apart = np.abs(
        corner.doflocs[:, None] - block.element.reference[None, : block.element.corners]
    ).max(axis=2)
    theirs_of_ours = apart.argmin(axis=1)  # scikit-fem numbers corners otherwise
    flat = kind_of_mesh(
        mesh.nodes[used].T.copy(), places.reshape(corners.shape)[:, theirs_of_ours].T.copy()
    )
    basis = Basis(flat, ElementVector(element), intorder=5)
    numbers = mesh.element_materials
    modulus, ratio, density = (
        np.array([getattr((*materials, body)[number], key) for number in numbers])[:, None]
        for key in ("youngs_modulus", "poissons_ratio", "density")
    )
    lame, mu = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio)), modulus / (2 * (1 + ratio))

    @BilinearForm
    def elastic(u, v, w):  # type: ignore[no-untyped-def]
        strain = sym_grad(u)
        return ddot(2 * mu * strain + eye(lame * trace(strain), 3), sym_grad(v))

    @BilinearForm
    def inert(u, v, w):  # type: ignore[no-untyped-def]
        return density * dot(u, v)

    theirs = elastic.assemble(basis), inert.assemble(basis)
    # the same motion of all nodes in both: energies of random polynomials of second degree, which
    # both elements hold
    coefficients = choose.standard_normal((3, 10))

    def motion(at: np.ndarray) -> np.ndarray:
        x, y, z = at
        terms = np.stack([np.ones_like(x), x, y, z, x * y, y * z, z * x, x**2, y**2, z**2])
        return np.asarray(np.tensordot(coefficients, terms, 1))

    here = motion(mesh.nodes.T).T.ravel()
    there = basis.project(motion)
    for name, one, other in zip(
        ("strain", "kinetic"), (ours.stiffness, ours.mass), theirs, strict=True
    ):
        agrees(
            f"{kind} of six materials",
            f"{name} energy",
            float(here @ one @ here),
            float(there @ other @ there),
            unit="J",
            relative=1e-9,
        )
