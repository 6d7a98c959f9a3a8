"""Linear elasticity: stiffness and consistent mass matrices of solid elements."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.assembly import isotropic, pair_assembly, scaled_shapes
from vibroimpact.structures.mesh import Mesh


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
    Taylor, The Finite Element
    Method), full Gauss quadrature, isoparametric. The kernel is one batched matrix product over the
    gradients of the scalar
    shape functions: with :math:`G_{ij} = \int \partial_i N_a\,\partial_j N_b\,dV` an isotropic
    material has
    :math:`K_{ij} = \lambda G_{ij} + \mu G_{ji} + \mu\,\delta_{ij}\,\mathrm{tr}\,G`.

    Examples
    --------
    >>> from vibroimpact.structures.lattice import box_mesh
    >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> stiffness, mass = assemble_solid(box_mesh((1.0, 1.0, 1.0), (1, 1, 1)), steel)
    >>> round(float(mass.sum()) / 3.0, 6)
    7850.0
    """
    products, masses = [], []
    for block in mesh.blocks:
        for values, gradients in scaled_shapes(mesh, block):
            masses.append(values.transpose(0, 2, 1) @ values)
            products.append(gradients.transpose(0, 1, 3, 2)[:, None] @ gradients[None])
    summed, matrix = pair_assembly(mesh)

    def stiffness_of(chunks: Sequence[Floats], lame: float, mu: float) -> Floats:
        product = np.array(
            [[summed([chunk[i, j] for chunk in chunks]) for j in range(3)] for i in range(3)]
        )
        return isotropic(product, lame, mu)

    # the stiffness is linear in both constants, so that each is a weight of the elements
    if mesh.materials:
        lame, mu, density = (
            _of_chunks(mesh.of_elements(material, value), masses)
            for value in (_lame, _shear_modulus, lambda one: one.density)
        )
        weighted = [
            [chunk * of[:, None, None] for chunk, of in zip(products, each, strict=True)]
            for each in (lame, mu)
        ]
        stiffness = stiffness_of(weighted[0], 1.0, 0.0) + stiffness_of(weighted[1], 0.0, 1.0)
        scalar = summed(
            [chunk * of[:, None, None] for chunk, of in zip(masses, density, strict=True)]
        )
    else:
        stiffness = stiffness_of(products, _lame(material), _shear_modulus(material))
        scalar = material.density * summed(masses)
    return matrix(stiffness), matrix(scalar[:, None, None] * np.eye(3))


def _of_chunks(values: Floats, chunks: Sequence[Floats]) -> list[Floats]:
    """Return a number per element as one array per chunk of elements."""
    return np.split(values, np.cumsum([len(chunk) for chunk in chunks])[:-1])


def _lame(material: Material) -> float:
    modulus, ratio = material.youngs_modulus, material.poissons_ratio
    return modulus * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio))


def _shear_modulus(material: Material) -> float:
    return material.youngs_modulus / (2.0 * (1.0 + material.poissons_ratio))
