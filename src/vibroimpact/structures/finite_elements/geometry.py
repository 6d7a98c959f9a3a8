"""Geometry of a mesh: Jacobians of the isoparametric map, mass properties and checks.

The checks are for inverted elements and loose parts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats, Integers
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.element_kinds import ElementKind
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.finite_elements.parts import part_of_nodes, used_nodes

_MIRRORED_ALONG_X_Y = (4, 5)  # corners of tetrahedra and pyramids
# exact for the product of two coordinates and the Jacobian of a second-order brick
_INERTIA_DEGREE = 9
_SHOWN = 5  # inverted elements in a message
_CHUNK = 5000  # elements whose determinants are taken at once


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
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> round(mass_properties(box_mesh((2.0, 1.0, 1.0), (2, 1, 1)), 7850.0).mass, 6)
    15700.0
    """
    # moments over the mean density: integrals of 1, x_i and x_i x_j
    volume = 0.0
    first_moment = np.zeros(3)
    second_moment = np.zeros((3, 3))
    mean_density = float(np.mean(density))
    ratios = np.broadcast_to(np.asarray(density) / mean_density, mesh.number_of_elements)
    ends = np.cumsum([len(block.connectivity) for block in mesh.blocks])[:-1]
    for block, ratio in zip(mesh.blocks, np.split(ratios, ends), strict=True):
        element = block.element
        is_plate = element.dimension == 2
        points, weights = element.quadrature(max(_INERTIA_DEGREE, element.degree))
        values, gradients = element.basis(points)
        nodes = mesh.nodes[block.connectivity]
        height = thickness if is_plate else 1.0
        # of the quadrature points, weighted with the density
        jacobian = np.abs(determinants(nodes, gradients))
        volumes = ratio[:, None] * weights * jacobian * height
        positions = np.einsum("qk,eki->eqi", values, nodes, optimize=True)
        volume += volumes.sum()
        first_moment += np.einsum("eq,eqi->i", volumes, positions)
        second_moment += np.einsum("eq,eqi,eqj->ij", volumes, positions, positions, optimize=True)
        if is_plate:  # z^2 over the thickness: h^2/12
            second_moment[2, 2] += volumes.sum() * thickness**2 / 12.0
    centre = first_moment / volume
    # Steiner's theorem, then J = tr(S) I - S
    about_centre = mean_density * (second_moment - volume * np.outer(centre, centre))
    inertia = np.trace(about_centre) * np.eye(3) - about_centre
    return MassProperties(float(mean_density * volume), centre, inertia)


def determinants(nodes: Floats, gradients: Floats) -> Floats:
    """Return the Jacobian determinants det dx/dxi, (elements, points).

    They follow from nodes (elements, nodes, 3) and reference gradients.
    """
    dimension = gradients.shape[1]
    return np.asarray(np.linalg.det(jacobians(nodes[:, :, :dimension], gradients)))


def jacobians(nodes: Floats, gradients: Floats) -> Floats:
    """Return the Jacobians dx_i/dxi_d, (elements, points, dimension d, dimension i)."""
    points, dimension, nodes_of_element = gradients.shape
    products = gradients.reshape(-1, nodes_of_element) @ nodes
    return np.asarray(products.reshape(len(nodes), points, dimension, -1))


def renumbered_by_volume(mesh: Mesh) -> Mesh:
    """Return a mesh of solids in which inverted elements are numbered the other way round.

    They are those of wholly negative volume, which other programs read. Elements whose volume is
    negative in part are folded, and stay as they are.

    Examples
    --------
    >>> tet = Mesh(np.eye(4, 3), (ElementBlock("tet4", np.array([[0, 3, 1, 2]])),))
    >>> renumbered_by_volume(tet).blocks[0].connectivity.tolist()
    [[0, 1, 3, 2]]
    """
    return replace(mesh, blocks=tuple(_renumbered(mesh, block) for block in mesh.blocks))


def _renumbered(mesh: Mesh, block: ElementBlock) -> ElementBlock:
    """Return a block of solids with inverted elements numbered the other way round."""
    corners = block.element.reference[: block.element.corners]
    _, gradients = block.element.basis(corners.mean(axis=0, keepdims=True))
    in_middle = determinants(mesh.nodes[block.connectivity], gradients)[:, 0]
    inverted = np.flatnonzero(in_middle < 0.0)
    if not len(inverted):
        return block
    renumbered = block.connectivity[inverted][:, _other_way_round(block.element)]
    is_right = _smallest_determinants(mesh, ElementBlock(block.kind, renumbered)) > 0.0
    connectivity = block.connectivity.copy()
    connectivity[inverted[is_right]] = renumbered[is_right]
    return ElementBlock(block.kind, connectivity)


def _other_way_round(element: ElementKind) -> Integers:
    """Return the numbering of a mirrored element.

    Of a tetrahedron or pyramid x and y are exchanged, of a wedge or brick top and bottom.
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
    first = 0  # number of the first element of a block
    for block in mesh.blocks:
        inverted = np.flatnonzero(_smallest_determinants(mesh, block) <= 0.0)
        if len(inverted):
            numbers = ", ".join(str(first + index + 1) for index in inverted[:_SHOWN])
            if len(inverted) > _SHOWN:
                numbers += ", ..."
            kinds = ", kind by kind" if len(mesh.blocks) > 1 else ""
            raise InputError(
                f"{len(inverted)} of {len(block.connectivity)} {block.kind} elements are "
                "inverted or folded "
                "(their volume is not positive everywhere): "
                f"number {numbers}, counted from 1 in the order of the mesh{kinds}; "
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
    """Return the smallest Jacobian determinant of each element.

    It is that at the quadrature points and at the corners.
    """
    quadrature_points, _ = block.element.quadrature()
    corners = block.element.reference[: block.element.corners]
    _, gradients = block.element.basis(np.concatenate([quadrature_points, corners]))
    chunks = np.array_split(block.connectivity, len(block.connectivity) // _CHUNK + 1)
    return np.concatenate(
        [determinants(mesh.nodes[chunk], gradients).min(axis=1) for chunk in chunks]
    )
