"""Plate element: Reissner-Mindlin bending, and plane stress in its middle plane.

It is a quadrilateral of order four.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.errors import InputError
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.assembly import isotropic, pair_assembly, scaled_shapes
from vibroimpact.structures.finite_elements.mesh import Mesh

_THIN_SHEAR = 1e4  # factor on the shear stiffness that stands for the thin plate


def shear_factor(poissons_ratio: float) -> float:
    """Return the shear correction factor of a plate [-], 5 / (6 - nu).

    It is J. R. Hutchinson's (J. Appl. Mech. 51:581, 1984).
    """
    return 5.0 / (6.0 - poissons_ratio)


def assemble_plate(
    mesh: Mesh,
    material: Material,
    thickness: float,
    theory: str = "thick",
    shear_correction: float | None = None,
) -> tuple[csr_array, csr_array]:
    r"""Return the stiffness and the consistent mass matrix of a plate.

    Parameters
    ----------
    mesh : Mesh
        One block of "quad25"; z of its nodes is not used.
    material : Material
        Density, Young's modulus and Poisson's ratio.
    thickness : float
        Thickness h [m], > 0.
    theory : str, default "thick"
        "thick" is Reissner and Mindlin's theory, with transverse shear and rotary inertia; "thin"
        is Kirchhoff's, without.
    shear_correction : float, optional
        Shear correction factor s [-]; 5 / (6 - nu) by default.

    Returns
    -------
    stiffness, mass : sparse arrays, shape (5 nodes, 5 nodes)
        Degrees of freedom of a node: displacements u, v, w of the middle plane [m], then the slopes
        :math:`\beta_x, \beta_y` [rad], so that a point at height z moves by :math:`u + z \beta_x`
        and :math:`v + z \beta_y`.

    Raises
    ------
    InputError
        If the theory is unknown.

    Notes
    -----
    Strain energy :math:`\tfrac12\int h\,\varepsilon^T C \varepsilon + \tfrac{h^3}{12} \kappa^T C
    \kappa + s G h\,|\nabla w + \beta|^2\,dA` with C of plane stress (R. D. Mindlin, J. Appl. Mech.
    18:31, 1951). The factor s = 5 / (6 - nu) is J. R. Hutchinson's (J. Appl. Mech. 51:581, 1984):
    errors of frequencies with respect to three-dimensional elasticity are twenty times smaller than
    with E. Reissner's 5/6 or Mindlin's pi^2/12. Integration is full, as quadrilaterals of order
    four do not lock. The thin plate is the thick one with ten thousand times the shear stiffness
    and without rotary inertia.

    Examples
    --------
    >>> from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
    >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> stiffness, mass = assemble_plate(plate_mesh((0.5, 0.4), 0.1), steel, 0.01)
    >>> translation = np.tile([0.0, 0.0, 1.0, 0.0, 0.0], mass.shape[0] // 5)
    >>> round(float(translation @ mass @ translation), 6)
    15.7
    """
    if theory not in ("thick", "thin"):
        raise InputError(f'"{theory}" is not a theory of plates; it must be "thick" or "thin"')
    is_thick = theory == "thick"
    ratio = material.poissons_ratio
    shear_modulus = material.youngs_modulus / (2.0 * (1.0 + ratio))
    lame = material.youngs_modulus * ratio / (1.0 - ratio**2)  # in plane stress
    if shear_correction is None:
        shear_correction = shear_factor(ratio)
    shear_stiffness = shear_correction * shear_modulus * thickness  # s G h
    if not is_thick:
        shear_stiffness *= _THIN_SHEAR
    second_moment = thickness**3 / 12.0

    # chunks of values and gradients of the shape functions times sqrt(dA)
    chunks = list(scaled_shapes(mesh, mesh.blocks[0]))
    summed, matrix = pair_assembly(mesh)
    # integrals of N_a N_b, and of dN_a/dx_i dN_b/dx_j
    value_products = summed([values.transpose(0, 2, 1) @ values for values, _ in chunks])
    gradient_products = np.empty((2, 2, len(value_products)))
    for i in range(2):
        for j in range(2):
            products = [gradients[i].transpose(0, 2, 1) @ gradients[j] for _, gradients in chunks]
            gradient_products[i, j] = summed(products)
    plane_stress = isotropic(gradient_products, lame, shear_modulus)

    # blocks of pairs of nodes, with the degrees of freedom u, v, w and two slopes
    stiffness, mass = np.zeros((2, len(value_products), 5, 5))
    # membrane and bending: h eps^T C eps and h^3/12 kappa^T C kappa
    stiffness[:, :2, :2] = thickness * plane_stress
    stiffness[:, 3:, 3:] = second_moment * plane_stress
    # shear: s G h (|grad w|^2 + 2 grad w . beta + |beta|^2)
    stiffness[:, 2, 2] = shear_stiffness * np.trace(gradient_products)
    for axis in range(2):
        slope = 3 + axis
        stiffness[:, slope, slope] += shear_stiffness * value_products
        gradient_values = [
            gradients[axis].transpose(0, 2, 1) @ values for values, gradients in chunks
        ]
        value_gradients = [
            values.transpose(0, 2, 1) @ gradients[axis] for values, gradients in chunks
        ]
        stiffness[:, 2, slope] = shear_stiffness * summed(gradient_values)
        stiffness[:, slope, 2] = shear_stiffness * summed(value_gradients)
        if is_thick:
            mass[:, slope, slope] = material.density * second_moment * value_products
    for axis in range(3):
        mass[:, axis, axis] = material.density * thickness * value_products
    return matrix(stiffness), matrix(mass)
