"""Against closed forms of statics: beams, bars, plates and constant strain (S. P.
Timoshenko and J. N. Goodier; R. Szilard).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from agreement import Against, Agrees
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
from vibroimpact.structures.finite_elements.rectangle import Disc
from vibroimpact.structures.finite_elements.sphere_mesh import sphere_mesh
from vibroimpact.structures.finite_elements.structure import (
    Structure,
    plate_structure,
    solid_structure,
)
from vibroimpact.structures.finite_elements.surface import surface_motion
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.supports.constraints import Constraints, HeldStructure
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.support import Support, held_by

AGAINST = Against(
    "statics of beams and plates, patch tests",
    "closed form",
    "plates, spheres and modes",
    "Timoshenko and Goodier, Theory of Elasticity; Timoshenko and Woinowsky-Krieger, Theory "
    "of Plates and Shells, table 37; Navier series",
)


SOLIDS = ("tet4", "tet10", "hex8", "hex20", "hex27")
STEEL = Material(7850.0, 210e9, 0.3)


@dataclass(frozen=True)
class BeamEnd:
    """The end x-min keeps its plane; its middle line keeps its height, and its middle its
    place across.
    """

    discs = ()
    lines = ((), ())

    def hold(self, constraints: Constraints) -> None:
        x, y, z = constraints.structure.mesh.nodes.T
        end = np.isclose(x, x.min())
        for axis, nodes in enumerate((end, end & np.isclose(y, 0), end & np.isclose(z, 0))):
            constraints.hold(3 * np.flatnonzero(nodes) + axis)


BEAM_END = (BeamEnd(),)


def response(held: HeldStructure, load: np.ndarray) -> np.ndarray:
    """Static displacements of all degrees of freedom of the structure."""
    elastic = ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)
    return np.asarray(held.expansion @ elastic.static(held.expansion.T @ load))


def plate_under(
    places: np.ndarray, supports: tuple[Support, ...], structure: Structure
) -> np.ndarray:
    """Deflections at places, under a unit load at the first."""
    motion, _ = surface_motion(structure.mesh, places, "upper", structure.thickness)
    vertical = motion[[3 * index + 2 for index in range(len(places))]]
    return np.asarray(vertical @ response(held_by(structure, supports), vertical[[0]].toarray()[0]))


@pytest.mark.parametrize(
    ("kind", "counts"), [("hex20", (8, 1, 1)), ("hex27", (8, 1, 1)), ("tet10", (16, 2, 2))]
)
@pytest.mark.parametrize("ratio", [0.0, 0.3])
def test_tip_of_a_cantilever(
    agrees: Agrees, kind: str, counts: tuple[int, int, int], ratio: float
) -> None:
    """F L^3 / 3 E I + F L / (5/6 G A), within 0.5 %; the edge is so held that the end may
    contract, as it does in a beam.
    """
    length, width, height = 1.0, 0.05, 0.06
    structure = solid_structure(
        box_mesh((length, width, height), counts, kind), Material(7850.0, 210e9, ratio)
    )
    traction = shares_of_the_end(structure.mesh)
    load = np.zeros((len(traction), 3))
    load[:, 2] = traction
    found = response(held_by(structure, BEAM_END), load.ravel()).reshape(-1, 3)
    area, second = width * height, width * height**3 / 12
    exact = length**3 / (3 * 210e9 * second) + length / (5 / 6 * 210e9 / (2 + 2 * ratio) * area)
    agrees(
        "cantilever beam, three solid elements",
        "tip deflection under 1 N",
        traction @ found[:, 2],
        exact,
        unit="m",
        relative=5e-3,
    )


def shares_of_the_end(mesh: Mesh) -> np.ndarray:
    """The part of an evenly spread unit load that each node takes: turned so that the end
    is on top, seen at points of Gauss's rule.
    """
    turned = Mesh(mesh.nodes[:, [1, 2, 0]], mesh.blocks)
    low, high = turned.nodes.min(axis=0)[:2], turned.nodes.max(axis=0)[:2]
    steps = (1 + np.array([-1, 1]) / np.sqrt(3)) / 2
    cells = [(cell + step) / 2 for cell in range(2) for step in steps]
    points = np.array([low + (high - low) * [a, b] for a in cells for b in cells])
    motion, _ = surface_motion(turned, points, "upper")
    return np.asarray(motion.toarray()[2::3].mean(axis=0).reshape(-1, 3)[:, 2])


@pytest.mark.parametrize("kind", ["tet10", "hex20", "hex27"])
def test_a_bar_that_hangs(kind: str) -> None:
    """Under its own weight its end sinks by rho g L^2 / 2 E, exactly where Poisson's
    ratio is zero.
    """
    material = Material(7850.0, 210e9, 0.0)
    structure = solid_structure(box_mesh((2.0, 0.1, 0.1), (3, 1, 1), kind), material)
    load = structure.mass @ np.tile([9.81, 0.0, 0.0], len(structure.mesh.nodes))
    found = response(held_by(structure, [Edge("x-min", "clamped")]), load).reshape(-1, 3)
    x = structure.mesh.nodes[:, 0] + 1.0
    np.testing.assert_allclose(
        found[:, 0], 7850 * 9.81 * (2 * 2.0 * x - x**2) / 2 / 210e9, rtol=1e-8, atol=1e-18
    )


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.1, -0.07)])
def test_point_load_on_a_simply_supported_plate(agrees: Agrees, place: tuple[float, float]) -> None:
    """Navier's series, each term with Mindlin's shear; away from the load, where it
    converges, within 1e-4.
    """
    length, width, height = 0.52, 0.42, 0.008
    structure = plate_structure(plate_mesh((length, width), 0.05), STEEL, height)
    elsewhere = (-0.13, 0.09)
    found = plate_under(
        np.array([place, elsewhere]),
        tuple(Edge(edge, "simply-supported") for edge in EDGES),
        structure,
    )
    m, n = np.meshgrid(np.arange(1, 400), np.arange(1, 400), indexing="ij")
    k = np.pi**2 * ((m / length) ** 2 + (n / width) ** 2)
    rigidity = 210e9 * height**3 / (12 * 0.91)
    flexibility = (
        4 / (length * width) * (1 / (rigidity * k**2) + 1 / (5 / 5.7 * 210e9 / 2.6 * height * k))
    )

    def shape(at: tuple[float, float]) -> np.ndarray:
        return np.sin(m * np.pi * (at[0] / length + 0.5)) * np.sin(
            n * np.pi * (at[1] / width + 0.5)
        )

    exact = (flexibility * shape(place) * shape(elsewhere)).sum()
    agrees(
        "point load on a simply supported plate",
        "deflection away from the load",
        found[1],
        exact,
        unit="m",
        relative=1e-4,
    )


def test_centre_of_a_clamped_square_plate(agrees: Agrees) -> None:
    """0.00560 P a^2 / D (S. P. Timoshenko and S. Woinowsky-Krieger, Theory of Plates and
    Shells, table 37).
    """
    height = 0.002
    structure = plate_structure(plate_mesh((1.0, 1.0), 0.1), STEEL, height)
    found = plate_under(
        np.array([[0.0, 0.0]]), tuple(Edge(edge, "clamped") for edge in EDGES), structure
    )
    part = found[0] * 210e9 * height**3 / (12 * 0.91)
    agrees(
        "clamped square plate, force at the centre",
        "central deflection, normalized by P a²/D",
        part,
        0.00560,
        relative=2e-3,
    )


def test_a_free_sphere_under_a_load_at_its_pole() -> None:
    """It is carried by the inertia of the whole sphere: the response has no momentum, and
    its stresses balance the rest of the load.
    """
    structure = solid_structure(sphere_mesh(0.025, 6, "hex20"), STEEL)
    held = held_by(structure)
    rigid = structure.rigid_motions()
    load = np.zeros((len(structure.mesh.nodes), 3))
    load[structure.mesh.nodes[:, 2].argmin()] = [3.0, -1.0, 10.0]
    load = load.ravel()
    found = response(held, load)
    scale = (
        structure.properties.mass * np.abs(found).max() * np.array([1, 1, 1, 0.025, 0.025, 0.025])
    )
    np.testing.assert_allclose(rigid.T @ (structure.mass @ found) / scale, 0.0, atol=1e-12)
    force, moment = (rigid.T @ load)[:3], (rigid.T @ load)[3:]
    inertia = structure.properties.inertia
    acceleration = rigid @ np.concatenate(
        [force / structure.properties.mass, np.linalg.solve(inertia, moment)]
    )
    np.testing.assert_allclose(
        structure.stiffness @ found, load - structure.mass @ acceleration, atol=1e-8
    )


@pytest.mark.parametrize("kind", SOLIDS)
def test_patch_test_of_solids(agrees: Agrees, kind: str) -> None:
    """Distorted elements carry any constant strain without a residual inside, with the
    energy of constant strain.
    """
    regular = box_mesh((1.0, 0.8, 0.6), (2, 2, 2), "hex8" if kind.startswith("hex") else "tet4")
    random = np.random.default_rng(3)
    inside = (np.abs(regular.nodes) < 0.499 * regular.extent).all(axis=1)
    moved = regular.nodes + 0.07 * random.uniform(-1, 1, regular.nodes.shape) * inside[:, None]
    element = box_mesh((1.0, 0.8, 0.6), (2, 2, 2), kind)
    nodes = element.nodes.copy()
    corners = element.blocks[0].element.corners
    for cell, linear in zip(
        element.blocks[0].connectivity, regular.blocks[0].connectivity, strict=True
    ):
        assert np.allclose(element.nodes[cell[:corners]], regular.nodes[linear])
        values = regular.blocks[0].element.basis(element.blocks[0].element.reference)[0]
        nodes[cell] = values @ moved[linear]
    structure = solid_structure(Mesh(nodes, element.blocks), STEEL)
    gradient = random.standard_normal((3, 3))
    field = (nodes @ gradient.T).ravel()
    force = (structure.stiffness @ field).reshape(-1, 3)
    held_inside = (np.abs(nodes) < 0.499 * element.extent).all(axis=1)
    assert held_inside.any()
    assert np.abs(force[held_inside]).max() < 1e-12 * np.abs(force).max()
    strain = (gradient + gradient.T) / 2
    mu, lame = 210e9 / 2.6, 210e9 * 0.3 / (1.3 * 0.4)
    energy = 0.48 * (lame * np.trace(strain) ** 2 / 2 + mu * (strain**2).sum())
    agrees(
        "patch test, five solid elements",
        "strain energy",
        field @ force.ravel() / 2,
        energy,
        unit="J",
        relative=1e-11,
    )


@pytest.mark.parametrize(("bent", "tolerance"), [(False, 1e-9), (True, 1e-5)])
def test_patch_test_of_the_plate_element(agrees: Agrees, bent: bool, tolerance: float) -> None:
    """Constant stretch, bending with its parabolic deflection, and shear; elements bent
    around a disc hold parabolas only nearly.
    """
    height = 0.02
    mesh = plate_mesh((1.0, 0.8), 0.3, [Disc(0.1, 0.05, 0.12)] if bent else [])
    nodes = mesh.nodes.copy()
    if not bent:  # straight sides, none of them parallel
        nodes[:, :2] *= 1 + 0.3 * nodes[:, 1:0:-1] * nodes[:, :1] + 0.2 * nodes[:, 1:2]
        element = mesh.blocks[0].element
        for cell in mesh.blocks[0].connectivity:
            x, y = element.reference.T
            corner = nodes[cell[list(element.faces[0])]]
            nodes[cell] = (
                np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=1) @ corner
            )
    structure = plate_structure(Mesh(nodes, mesh.blocks), STEEL, height)
    x, y, _ = nodes.T
    zero = np.zeros_like(x)
    a, b, c = 0.3, -0.2, 0.5
    mu, area, plane = 210e9 / 2.6, structure.properties.mass / (7850 * height), 210e9 / 0.91
    strained = plane * (a**2 + b**2 + 0.6 * a * b) / 2 + mu * 2 * c**2
    slopes = [a * x + c * y, b * y + c * x]
    fields = {
        "stretch": ([*slopes, zero, zero, zero], height * strained),
        "bending": (
            [zero, zero, -(a * x**2 / 2 + b * y**2 / 2 + c * x * y), *slopes],
            height**3 / 12 * strained,
        ),
        "shear": (
            [zero, zero, a * x + b * y, zero, zero],
            5 / 5.7 * mu * height * (a**2 + b**2) / 2,
        ),
    }
    for name, (field, density) in fields.items():
        motion = np.stack(field, axis=1).ravel()
        energy, case = (
            motion @ (structure.stiffness @ motion) / 2,
            "curved sides around a disc" if bent else "straight sides",
        )
        agrees(
            f"patch test of the plate element, {case}",
            f"strain energy of {name}",
            energy,
            area * density,
            unit="J",
            relative=tolerance,
        )
