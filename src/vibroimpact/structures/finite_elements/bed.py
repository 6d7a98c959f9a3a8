"""The bed of a plate: an elastic foundation of a held part of its lower face.

It stands for the local compliance between that part and the middle plane.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.assembly import pair_assembly, scaled_shapes
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh

# compliance of the bed across the plate and along it, over h (1 - nu^2) / E: coefficients of 1, nu,
# nu^2, nu^3
_NORMAL = (0.2066, 0.0480, 0.1398, -0.5132)
_SHEAR = (0.1371, -0.1190, -0.1577, -0.0455)
# relative increase of the stiffness across and along, per ratio of thickness to radius of a patch
_BENT = 1.5
_NARROW = 0.05


def bed_stiffness(material: Material, thickness: float) -> tuple[float, float]:
    r"""Return the stiffness of the bed per area, along the plate and across it [N/m^3].

    Parameters
    ----------
    material : Material
        Of the plate.
    thickness : float
        Thickness h of the plate [m].

    Notes
    -----
    A plate held on its lower face deforms at the rim of the support: its normals rotate, shear and
    stretch over about half a thickness. Plate theory fixes the normal over its full height and is
    too stiff; frequencies of the paper's plate on patches come out 1.4 % too high. Here springs
    connect the lower face, which turns with the plate, to the ground or body below it, of a
    compliance of :math:`a(\nu)\,h (1-\nu^2) / E` per area along and across. The two factors a are
    chosen so that at a straight rim the rotation under a moment and the deflection under a
    transverse force are those of the elastic half strip in plane strain, held on one half of one
    side. Both compliances of the rim agree within 0.2 %,
    for Poisson's ratios from 0 to 0.495; that under an in-plane force, which is not fitted, within
    15 %. The half strip was computed with finite elements graded to 1e-7 of the thickness at the
    rim, where the stress is singular; the tests repeat the computation.

    Examples
    --------
    >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> along, across = bed_stiffness(steel, 0.01)
    >>> (
    ...     round(along * 0.01 * (1 - 0.3**2) / 210e9, 2),
    ...     round(across * 0.01 * (1 - 0.3**2) / 210e9, 2),
    ... )
    (11.63, 4.55)
    """
    ratio = material.poissons_ratio
    unit = material.youngs_modulus / (thickness * (1.0 - ratio**2))
    along = unit / float(np.polynomial.polynomial.polyval(ratio, _SHEAR))
    across = unit / float(np.polynomial.polynomial.polyval(ratio, _NORMAL))
    return along, across


def end_compliance(material: Material, thickness: float) -> float:
    r"""Return the rotation at a fully held end of a plate in excess of plate theory [1/N].

    It is that under a unit moment per width.

    Notes
    -----
    It is negative: the held side cannot expand in height as bending would make it, and is stiffer.
    In plane strain it is, per moment per width, :math:`-(\nu / (1 - \nu))^2 (0.80 - 0.38 \nu)\,(1 -
    \nu^2) / (E h^2)`, fitted within 3 % to the half strip of `bed_stiffness`, held at its end
    instead. The stiffness matrix neglects it: frequencies of a
    clamped plate of 8 mm on 420 mm are 0.1 % too low.
    """
    ratio = material.poissons_ratio
    unit = (1.0 - ratio**2) / (material.youngs_modulus * thickness**2)
    return -((ratio / (1.0 - ratio)) ** 2) * (0.80 - 0.38 * ratio) * unit


def patch_bed(bed: tuple[float, float], slenderness: float) -> tuple[float, float]:
    """Return the stiffness of a bed under a round patch, along and across the plate.

    The slenderness is thickness over radius.

    Notes
    -----
    The curved rim of a small patch is stiffer than a straight one. The stiffness of a bed is
    proportional to the square of the radius, that of the half space, which a plate is to a much
    smaller patch, to the radius; hence the correction, a multiple of thickness over radius. Along
    the plate the multiple is that of a disc bonded to the half space, 8 G R / (2 - nu). Across it
    is fitted, as a rim rotates more than a disc sinks: with 1.5, twenty frequencies each of plates
    on round patches of 1.25 to 2.5 thicknesses in radius are those of refined bricks within 0.25 %
    (without it, 1.3 %), except for in-plane motions, which are up to 0.9 % too stiff at 1.5
    thicknesses.
    """
    along, across = bed
    return along * (1.0 + _NARROW * slenderness), across * (1.0 + _BENT * slenderness)


def elements_within(mesh: Mesh, nodes: Integers) -> Integers:
    """Return the plate elements of which all nodes are among the given ones."""
    is_given = np.zeros(len(mesh.nodes), dtype=bool)
    is_given[nodes] = True
    return np.flatnonzero(is_given[mesh.blocks[0].connectivity].all(axis=1))


def area_products(mesh: Mesh, elements: Integers) -> csr_array:
    """Return the integrals of N_a N_b over some plate elements [m^2], sparse (nodes, nodes)."""
    block = mesh.blocks[0]
    held = Mesh(mesh.nodes, (ElementBlock(block.kind, block.connectivity[elements]),))
    summed, matrix = pair_assembly(held)
    products: Floats = summed(
        [values.transpose(0, 2, 1) @ values for values, _ in scaled_shapes(held, held.blocks[0])]
    )
    return matrix(products[:, None, None])
