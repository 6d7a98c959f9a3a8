"""Linear elasticity: stiffness and consistent mass matrices of solid elements."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.assembly import isotropic, pair_assembly, scaled_shapes
from vibroimpact.structures.finite_elements.mesh import Mesh


def assemble_solid(mesh: Mesh, material: Material) -> tuple[csr_array, csr_array]:
    r"""Return the stiffness and the consistent mass matrix of a mesh of solid elements.

    Parameters
    ----------
    mesh : Mesh
        Mesh of tetrahedra, wedges, pyramids and bricks, with the materials of its elements if there
        are several.
    material : Material
        Density, Young's modulus and Poisson's ratio of the elements that have no material of their
        own.

    Returns
    -------
    stiffness, mass : sparse arrays, shape (3 nodes, 3 nodes)
        [N/m] and [kg]; degree of freedom 3 a + i is the displacement of node a along i.

    Notes
    -----
    :math:`K = \int B^T C B\,dV` and :math:`M = \int \rho N^T N\,dV` (O. C. Zienkiewicz and R. L.
    Taylor, The Finite Element Method), full Gauss quadrature, isoparametric. The kernel is one
    batched matrix product over the gradients of the scalar shape functions: with :math:`G_{ij} =
    \int \partial_i N_a\,\partial_j N_b\,dV` an isotropic material has :math:`K_{ij} = \lambda
    G_{ij} + \mu G_{ji} + \mu\,\delta_{ij}\,\mathrm{tr}\,G`.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.lattice import box_mesh
    >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> stiffness, mass = assemble_solid(box_mesh((1.0, 1.0, 1.0), (1, 1, 1)), steel)
    >>> round(float(mass.sum()) / 3.0, 6)
    7850.0
    """
    # integrals over each element, in chunks: of N_a N_b, and of dN_a/dx_i dN_b/dx_j
    value_products = []
    gradient_products = []
    for block in mesh.blocks:
        for values, gradients in scaled_shapes(mesh, block):
            value_products.append(values.transpose(0, 2, 1) @ values)
            gradient_products.append(gradients.transpose(0, 1, 3, 2)[:, None] @ gradients[None])
    summed, matrix = pair_assembly(mesh)

    def isotropic_stiffness(chunks: Sequence[Floats], lame: float, shear_modulus: float) -> Floats:
        product = np.array(
            [[summed([chunk[i, j] for chunk in chunks]) for j in range(3)] for i in range(3)]
        )
        return isotropic(product, lame, shear_modulus)

    if mesh.materials:
        # the stiffness is linear in both constants, so that each is a weight of the elements
        lame = mesh.of_elements(material, _lame)
        shear_modulus = mesh.of_elements(material, _shear_modulus)
        density = mesh.of_elements(material, _density)
        stiffness = isotropic_stiffness(_weighted(gradient_products, lame), 1.0, 0.0)
        stiffness = stiffness + isotropic_stiffness(
            _weighted(gradient_products, shear_modulus), 0.0, 1.0
        )
        scalar_mass = summed(_weighted(value_products, density))
    else:
        stiffness = isotropic_stiffness(
            gradient_products, _lame(material), _shear_modulus(material)
        )
        scalar_mass = material.density * summed(value_products)
    return matrix(stiffness), matrix(scalar_mass[:, None, None] * np.eye(3))


def _weighted(chunks: Sequence[Floats], weights: Floats) -> list[Floats]:
    """Return chunks of element matrices (..., elements, nodes, nodes) times weights of elements."""
    ends = np.cumsum([chunk.shape[-3] for chunk in chunks])[:-1]
    return [
        chunk * chunk_weights[:, None, None]
        for chunk, chunk_weights in zip(chunks, np.split(weights, ends), strict=True)
    ]


def _lame(material: Material) -> float:
    """Return Lame's first parameter [Pa]."""
    ratio = material.poissons_ratio
    return material.youngs_modulus * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio))


def _shear_modulus(material: Material) -> float:
    """Return the shear modulus [Pa]."""
    return material.youngs_modulus / (2.0 * (1.0 + material.poissons_ratio))


def _density(material: Material) -> float:
    """Return the density [kg/m^3]."""
    return material.density
