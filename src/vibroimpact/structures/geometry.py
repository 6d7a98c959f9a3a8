"""Geometry of a mesh: Jacobians of the isoparametric map, mass properties, and checks for
inverted elements and loose parts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.element_kinds import ElementKind
from vibroimpact.structures.mesh import ElementBlock, Mesh
from vibroimpact.structures.parts import part_of_nodes, used_nodes

_MIRRORED_ALONG_X_Y = (4, 5)  # corners of tetrahedra and pyramids
# exact for the product of two coordinates and the Jacobian of a second-order brick
_INERTIA_DEGREE = 9


@dataclass(frozen=True)
class MassProperties:
    """Mass properties of a body.

    Parameters
    ----------
    mass : float
        Mass [kg].
    centre : array, shape (3,)
        Centre of mass [m].
    inertia : array, shape (3, 3)
        Inertia tensor about the centre of mass [kg m^2].
    """

    mass: float
    centre: Floats
    inertia: Floats


def mass_properties(mesh: Mesh, density: float | Floats, thickness: float = 1.0) -> MassProperties:
    """Return the mass, centre of mass and inertia of a mesh, integrated over its elements.

    Parameters
    ----------
    mesh : Mesh
        Solid or plate elements.
    density : float or array, shape (elements,)
        Density [kg/m^3], > 0, of the body or of each element.
    thickness : float, default 1
        Thickness of plate elements [m]; not used for solids.

    Examples
    --------
    >>> from vibroimpact.structures.lattice import box_mesh
    >>> round(mass_properties(box_mesh((2.0, 1.0, 1.0), (2, 1, 1)), 7850.0).mass, 6)
    15700.0
    """
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    reference = float(np.mean(density))
    ratios = np.broadcast_to(np.asarray(density) / reference, mesh.number_of_elements)
    ends = np.cumsum([len(block.connectivity) for block in mesh.blocks])[:-1]
    for block, ratio in zip(mesh.blocks, np.split(ratios, ends), strict=True):
        points, weights = block.element.quadrature(max(_INERTIA_DEGREE, block.element.degree))
        values, slopes = block.element.basis(points)
        at = mesh.nodes[block.connectivity]
        scale = (
            ratio[:, None]
            * weights
            * np.abs(determinants(at, slopes))
            * (thickness if block.element.dimension == 2 else 1.0)
        )
        positions = np.einsum("qk,eki->eqi", values, at, optimize=True)
        volume += scale.sum()
        first += np.einsum("eq,eqi->i", scale, positions)
        second += np.einsum("eq,eqi,eqj->ij", scale, positions, positions, optimize=True)
        if block.element.dimension == 2:
            second[2, 2] += scale.sum() * thickness**2 / 12.0
    centre = first / volume
    spread = reference * (second - volume * np.outer(centre, centre))
    return MassProperties(float(reference * volume), centre, np.trace(spread) * np.eye(3) - spread)


def determinants(at: Floats, slopes: Floats) -> Floats:
    """Return the Jacobian determinants det dx/dxi, (elements, points), from nodes `at`
    (elements, nodes, 3) and reference gradients.
    """
    dimension = slopes.shape[1]
    return np.asarray(np.linalg.det(jacobians(at[:, :, :dimension], slopes)))


def jacobians(at: Floats, slopes: Floats) -> Floats:
    """Return the Jacobians dx_i/dxi_d, (elements, points, dimension d, dimension i)."""
    elements, (points, dimension, nodes) = len(at), slopes.shape
    return np.asarray((slopes.reshape(-1, nodes) @ at).reshape(elements, points, dimension, -1))


def renumbered_by_volume(mesh: Mesh) -> Mesh:
    """Return a mesh of solids in which elements of wholly negative volume are numbered the other
    way round, which other programs read.

    Elements whose volume is negative in part are folded, and stay as they are.

    Examples
    --------
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[0, 3, 1, 2]])),))
    >>> renumbered_by_volume(tet).blocks[0].connectivity.tolist()
    [[0, 1, 3, 2]]
    """
    blocks = []
    for block in mesh.blocks:
        middle = block.element.reference[: block.element.corners].mean(axis=0, keepdims=True)
        turned = np.flatnonzero(
            determinants(mesh.nodes[block.connectivity], block.element.basis(middle)[1])[:, 0] < 0.0
        )
        if len(turned):
            other = _other_way_round(block.element)
            connectivity = block.connectivity.copy()
            connectivity[turned] = connectivity[turned][:, other]
            right = (
                _smallest_determinants(mesh, ElementBlock(block.kind, connectivity[turned])) > 0.0
            )
            connectivity[turned[~right]] = block.connectivity[turned[~right]]
            block = ElementBlock(block.kind, connectivity)
        blocks.append(block)
    return replace(mesh, blocks=tuple(blocks))


def _other_way_round(element: ElementKind) -> Integers:
    """Return the numbering of a mirrored element: a tetrahedron or pyramid with x and y
    exchanged, a wedge or brick from top to bottom.
    """
    mirrored = element.reference.copy()
    if element.corners in _MIRRORED_ALONG_X_Y:
        mirrored[:, :2] = element.reference[:, 1::-1]
    else:
        mirrored[:, 2] = 1.0 - element.reference[:, 2]
    distance = np.abs(mirrored[:, None] - element.reference[None]).max(axis=2)
    return np.asarray(distance.argmin(axis=1), dtype=np.int64)


def check_mesh(mesh: Mesh) -> None:
    """Raise unless a mesh is connected and no element is inverted.

    Raises
    ------
    InputError
        With the inverted elements, or the number of loose parts.
    """
    first = 0
    for block in mesh.blocks:
        bad = np.flatnonzero(_smallest_determinants(mesh, block) <= 0.0)
        if len(bad):
            shown = ", ".join(str(first + index + 1) for index in bad[:5]) + (
                ", ..." if len(bad) > 5 else ""
            )
            kinds = ", kind by kind" if len(mesh.blocks) > 1 else ""
            raise InputError(
                f"{len(bad)} of {len(block.connectivity)} {block.kind} elements are "
                "inverted or folded "
                "(their volume is not positive everywhere): "
                f"number {shown}, counted from 1 in the order of the mesh{kinds}; "
                "use smaller elements, or mesh the part again if the mesh was imported"
            )
        first += len(block.connectivity)
    parts = len(np.unique(part_of_nodes(mesh)[used_nodes(mesh)]))
    if parts > 1:
        raise InputError(
            f"the mesh consists of {parts} loose parts that share no node and are not "
            "joined; a body is one part: merge coincident nodes"
        )


def _smallest_determinants(mesh: Mesh, block: ElementBlock) -> Floats:
    """Return the smallest Jacobian determinant of each element, at the quadrature points
    and at the corners.
    """
    points = np.concatenate(
        [block.element.quadrature()[0], block.element.reference[: block.element.corners]]
    )
    slopes = block.element.basis(points)[1]
    found = [
        determinants(mesh.nodes[part], slopes).min(axis=1)
        for part in np.array_split(block.connectivity, len(block.connectivity) // 5000 + 1)
    ]
    return np.concatenate(found)
