"""Linear elasticity: stiffness and consistent mass matrices of solid elements."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.materials import Material
from vibroimpact.structures.assembly import isotropic, pair_assembly, scaled_shapes
from vibroimpact.structures.mesh import Mesh


def assemble_solid(mesh: Mesh, material: Material) -> tuple[csr_array, csr_array]:
    r"""Return the stiffness and the consistent mass matrix of a mesh of solid elements.

    Parameters
    ----------
    mesh : Mesh
        Mesh of tetrahedra and bricks.
    material : Material
        Density, Young's modulus and Poisson's ratio.

    Returns
    -------
    stiffness, mass : sparse arrays, shape (3 nodes, 3 nodes)
        [N/m] and [kg]; degree of freedom 3 a + i is the displacement of node a along i.

    Notes
    -----
    :math:`K = \int B^T C B\,dV` and :math:`M = \int \rho N^T N\,dV` (O. C. Zienkiewicz and R. L. Taylor, The Finite Element
    Method), full Gauss quadrature, isoparametric. The kernel is one batched matrix product over the gradients of the scalar
    shape functions: with :math:`G_{ij} = \int \partial_i N_a\,\partial_j N_b\,dV` an isotropic material has
    :math:`K_{ij} = \lambda G_{ij} + \mu G_{ji} + \mu\,\delta_{ij}\,\mathrm{tr}\,G`.

    Examples
    --------
    >>> from vibroimpact.structures.lattice import box_mesh
    >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> stiffness, mass = assemble_solid(box_mesh((1.0, 1.0, 1.0), (1, 1, 1)), steel)
    >>> round(float(mass.sum()) / 3.0, 6)
    7850.0
    """
    modulus, ratio = material.youngs_modulus, material.poissons_ratio
    mu = modulus / (2.0 * (1.0 + ratio))
    lame = modulus * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio))
    products, masses = [], []
    for block in mesh.blocks:
        for values, gradients in scaled_shapes(mesh, block):
            masses.append(values.transpose(0, 2, 1) @ values)
            products.append(gradients.transpose(0, 1, 3, 2)[:, None] @ gradients[None])
    summed, matrix = pair_assembly(mesh)
    product = np.array([[summed([chunk[i, j] for chunk in products]) for j in range(3)] for i in range(3)])
    scalar = material.density * summed(masses)
    return matrix(isotropic(product, lame, mu)), matrix(scalar[:, None, None] * np.eye(3))
