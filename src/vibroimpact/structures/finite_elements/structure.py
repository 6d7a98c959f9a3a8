"""Structure: a mesh of solid or plate elements with its stiffness and mass, without supports."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.assembly import node_adjacency
from vibroimpact.structures.finite_elements.bed import bed_stiffness, end_compliance
from vibroimpact.structures.finite_elements.elasticity import assemble_solid
from vibroimpact.structures.finite_elements.factor import (
    check_factor_memory,
    factor_entries,
    nested_dissection,
)
from vibroimpact.structures.finite_elements.geometry import (
    MassProperties,
    check_mesh,
    mass_properties,
)
from vibroimpact.structures.finite_elements.joints import hubs, joined_adjacency
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.plate_element import assemble_plate


@dataclass(frozen=True)
class Structure:
    """Finite-element model of a body without supports.

    Parameters
    ----------
    mesh : Mesh
        Mesh of the body.
    stiffness, mass : sparse arrays, shape (dofs, dofs)
        Stiffness and mass; degrees of freedom are ordered by nodes: three displacements, followed
        in plates by two slopes.
    properties : MassProperties
        Mass, centre of mass and inertia.
    thickness : float, default 0
        Thickness of plate elements [m].
    end_compliance : float, default 0
        Rotation [rad] per moment per width [N] at a held end in excess of plate theory; negative,
        as the end is stiffer: see `vibroimpact.structures.finite_elements.bed.end_compliance`.
    bed : tuple of two floats, optional
        Stiffness per area [N/m^3], along and across the plate, between plate elements and a support
        of their lower face; without it supports hold the full height of the plate.
    """

    mesh: Mesh
    stiffness: csr_array
    mass: csr_array
    properties: MassProperties
    thickness: float = 0.0
    end_compliance: float = 0.0
    bed: tuple[float, float] | None = None

    @cached_property
    def order(self) -> Integers:
        """Fill-reducing elimination order of the degrees of freedom.

        Raises
        ------
        InputError
            If the factors would not fit into the free memory.
        """
        mesh = self.mesh
        adjacency = node_adjacency(mesh)
        is_last = np.zeros(len(mesh.nodes), dtype=bool)
        if mesh.joints is not None:
            adjacency = joined_adjacency(adjacency, mesh.joints)
            is_last = hubs(mesh.joints, len(mesh.nodes))
        others = np.flatnonzero(~is_last)
        dissected = nested_dissection(mesh.nodes[others], adjacency[others][:, others])
        parts = [others[part] for part in dissected]
        if is_last.any():
            parts.append(np.flatnonzero(is_last))
        entries = mesh.dofs_per_node**2 * factor_entries(parts, adjacency)
        check_factor_memory(self.stiffness.shape[0], entries)
        first_dofs = mesh.dofs_per_node * np.concatenate(parts)[:, None]
        return (first_dofs + np.arange(mesh.dofs_per_node)).ravel()

    def rigid_motions(self) -> Floats:
        """Return the six rigid motions, (dofs, 6).

        They are unit translations, then unit rotations about the centre of mass.

        Examples
        --------
        >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
        >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
        >>> structure = solid_structure(box_mesh((1.0, 1.0, 1.0), (2, 1, 1)), steel)
        >>> bool(np.abs(structure.stiffness @ structure.rigid_motions()).max() < 1e-3)
        True
        """
        x, y, z = (self.mesh.nodes - self.properties.centre).T
        motions = np.zeros((len(self.mesh.nodes), self.mesh.dofs_per_node, 6))
        motions[:, :3, :3] = np.eye(3)
        motions[:, :3, 3:] = rotation_columns(x, y, z)
        if self.mesh.is_flat:
            motions[:, 3, 4] = 1.0  # a rotation about y moves a point at height z by z along x
            motions[:, 4, 3] = -1.0
        return motions.reshape(-1, 6)


def rotation_columns(x: Floats, y: Floats, z: Floats) -> Floats:
    """Return the displacements of points under unit rotations about x, y and z, (points, 3, 3)."""
    zero = np.zeros_like(x)
    along_x = np.stack([zero, z, -y], axis=-1)
    along_y = np.stack([-z, zero, x], axis=-1)
    along_z = np.stack([y, -x, zero], axis=-1)
    return np.stack([along_x, along_y, along_z], axis=1)


def solid_structure(mesh: Mesh, material: Material) -> Structure:
    """Return the structure of a mesh of solid elements.

    `material` is that of the elements that have none of their own.

    Raises
    ------
    InputError
        If elements are inverted or the mesh has loose parts.
    """
    check_mesh(mesh)
    density: float | Floats = material.density
    if mesh.materials:
        density = mesh.of_elements(material, lambda element_material: element_material.density)
    stiffness, mass = assemble_solid(mesh, material)
    return Structure(mesh, stiffness, mass, mass_properties(mesh, density))


def plate_structure(
    mesh: Mesh,
    material: Material,
    thickness: float,
    theory: str = "thick",
    shear_correction: float | None = None,
) -> Structure:
    """Return the structure of a mesh of plate elements; parameters are those of `assemble_plate`.

    Supports of the lower face of a thick plate act through a bed (`bed_stiffness`); those of
    Kirchhoff's thin plate on its full height.

    Raises
    ------
    InputError
        If elements are inverted, the mesh has loose parts, or the theory is unknown.
    """
    check_mesh(mesh)
    properties = mass_properties(mesh, material.density, thickness)
    bed = None
    if theory == "thick":
        bed = bed_stiffness(material, thickness)
    stiffness, mass = assemble_plate(mesh, material, thickness, theory, shear_correction)
    return Structure(
        mesh,
        stiffness,
        mass,
        properties,
        thickness=thickness,
        end_compliance=end_compliance(material, thickness),
        bed=bed,
    )
