"""The bed of a plate: what gives between its middle plane and a part of its lower face that is held."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats, Integers
from vibroimpact.materials import Material
from vibroimpact.structures.assembly import scaled_shapes, summation
from vibroimpact.structures.mesh import ElementBlock, Mesh

_NORMAL = (0.2066, 0.0480, 0.1398, -0.5132)  # compliances over h (1 - nu^2) / E: coefficients of 1, nu, nu^2, nu^3
_BENT, _NARROW = 1.5, 0.05  # of the stiffness across and along: how much more there is under a disc as wide as the plate is thick
_SHEAR = (0.1371, -0.1190, -0.1577, -0.0455)


def bed_stiffness(material: Material, thickness: float) -> tuple[float, float]:
    r"""Return the stiffness of the bed along the plate and across it, per area [N/m^3].

    Parameters
    ----------
    material : Material
        Of the plate.
    thickness : float
        Thickness h of the plate [m].

    Notes
    -----
    A plate that is held on its lower face gives way at the rim of what holds it: its fibres turn, and are sheared and pulled, over
    about half a thickness. Plate theory holds the whole height of the fibre and is too stiff; the paper's plate on patches comes
    1.4 % too high in frequency. Here the middle plane rests on the lower face by springs, spread over the face, of compliance
    :math:`a(\nu)\,h (1-\nu^2) / E` per area along and across. Two numbers a are chosen so that at a straight rim the plate turns
    under a moment, and sinks under a transverse force, as the elastic half strip in plane strain does that is held on one half of
    one side. Both compliances of the rim are met within 0.2 %, for Poisson's ratios from 0 to 0.495; that under a force in the plane,
    which was not asked for, within 15 %. The half strip was computed with finite elements graded to 1e-7 of the thickness at the
    rim, where the stress is singular; the tests compute it anew.

    Examples
    --------
    >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> along, across = bed_stiffness(steel, 0.01)
    >>> round(along * 0.01 * (1 - 0.3**2) / 210e9, 2), round(across * 0.01 * (1 - 0.3**2) / 210e9, 2)
    (11.63, 4.55)
    """
    ratio = material.poissons_ratio
    unit = material.youngs_modulus / (thickness * (1.0 - ratio**2))
    along, across = (unit / float(np.polynomial.polynomial.polyval(ratio, compliance)) for compliance in (_SHEAR, _NORMAL))
    return along, across


def end_compliance(material: Material, thickness: float) -> float:
    r"""Return how far a plate turns under a moment at an end whose whole side is held, beyond what plate theory says [1/N].

    Notes
    -----
    Less than nothing: a side that is held can't grow as high as bending would make it, and is stiffer. In plane strain it turns, for a
    moment per width, by :math:`-(\nu / (1 - \nu))^2 (0.80 - 0.38 \nu)\,(1 - \nu^2) / (E h^2)`, fitted within 3 % to the half strip of
    `bed_stiffness`, held at its end instead. Frequencies leave it out: of a clamped plate of 8 mm on 420 mm they are 0.1 % too low.
    """
    ratio = material.poissons_ratio
    unit = (1.0 - ratio**2) / (material.youngs_modulus * thickness**2)
    return -((ratio / (1.0 - ratio)) ** 2) * (0.80 - 0.38 * ratio) * unit


def bed_under(bed: tuple[float, float], slenderness: float) -> tuple[float, float]:
    """Return the stiffness of a bed, along and across, over a round patch; the slenderness is thickness over radius.

    Notes
    -----
    The rim of a small patch is bent, and gives less than a straight one. A bed carries with the square of a radius, the half space that a
    plate is to a much smaller patch with the radius, so that the bed must be stiffer by a multiple of thickness over radius. Along the
    plate it is that of a disc bonded to the half space, 8 G R / (2 - nu). Across it is fitted, as a rim turns more than a disc sinks: with
    1.5, twenty frequencies each of plates on round patches of 1.25 to 2.5 thicknesses in radius are those of refined bricks within 0.25 %
    (without it, 1.3 %), but for motions in the plane, which are up to 0.9 % too stiff at 1.5 thicknesses.
    """
    return bed[0] * (1.0 + _NARROW * slenderness), bed[1] * (1.0 + _BENT * slenderness)


def elements_within(mesh: Mesh, nodes: Integers) -> Integers:
    """Return the plate elements all of whose nodes are among some."""
    inside = np.zeros(len(mesh.nodes), dtype=bool)
    inside[nodes] = True
    return np.flatnonzero(inside[mesh.blocks[0].connectivity].all(axis=1))


def area_products(mesh: Mesh, elements: Integers) -> csr_array:
    """Return the integrals of N_a N_b over some plate elements [m^2], as a sparse matrix (nodes, nodes)."""
    part = Mesh(mesh.nodes, (ElementBlock(mesh.blocks[0].kind, mesh.blocks[0].connectivity[elements]),))
    summed, matrix = summation(part)
    products: Floats = summed([values.transpose(0, 2, 1) @ values for values, _ in scaled_shapes(part, part.blocks[0])])
    return matrix(products[:, None, None])
