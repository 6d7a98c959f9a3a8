"""Estimated errors of natural frequencies.

Their causes are the mesh, plate theory, the model of supports and a reduction.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.modes import Eigenmodes
from vibroimpact.structures.plate_waves import (
    bending_error,
    stiff_shear_error,
    stretching_error,
    wave_numbers,
)
from vibroimpact.structures.supports.constraints import HeldStructure

# causes of errors of natural frequencies
MESH = "the mesh"
THEORY = "the theory of plates"
SUPPORTS = "the supports"
REDUCTION = "the reduction"

# relative error of the stiffness of a bed, from plates on round patches of 1.25 to 2.5 thicknesses
# in radius
_BED = 0.1
# the same for in-plane motions, which were 0.9 to 2.0 % (steel) and 3.0 to 3.2 % (acrylic) too
# stiff
_BED_IN_PLANE = 0.85
# in addition to the error with respect to Lamb waves: difference between plates with edges and
# refined bricks
_EDGES = 2e-4


def mesh_errors(fine: Floats, coarse: Floats, gain: float) -> Floats:
    """Return the relative errors of frequencies due to the mesh, estimated from a coarser mesh.

    Parameters
    ----------
    fine, coarse : array, shape (modes,)
        Frequencies of both meshes, ascending.
    gain : float
        Ratio of the errors of the coarse and the fine mesh, > 1.

    Notes
    -----
    Richardson's extrapolation: the error is the difference over gain - 1.

    Examples
    --------
    >>> mesh_errors(np.array([100.0]), np.array([103.0]), 4.0).round(12).tolist()
    [0.01]
    """
    return np.asarray(np.abs(coarse / fine - 1.0) / (gain - 1.0))


def support_errors(held: HeldStructure, modes: Eigenmodes) -> Floats:
    """Return the relative errors of frequencies due to the supports of plate elements.

    Notes
    -----
    To first order the relative change of the squared frequency is the fraction of the strain energy
    in the bed times the relative change of the bed's stiffness; for a neglected compliance in
    series with a support, the squared reaction over the modal mass and the squared frequency, times
    that compliance.
    """
    structure = held.structure
    squared_frequencies = modes.angular_frequencies**2
    if not structure.thickness:
        return np.zeros(len(squared_frequencies))
    bed_error = _BED + (_BED_IN_PLANE - _BED) * _in_plane(held, modes)
    bed_energy = np.einsum("ij,ij->j", modes.shapes, held.bed @ modes.shapes)
    by_beds = bed_error * bed_energy / squared_frequencies
    dofs, compliances = held.neglected
    if not len(dofs):
        return np.asarray(0.5 * by_beds)
    shapes = held.expansion @ modes.shapes
    reactions = (
        structure.stiffness[dofs] @ shapes - (structure.mass[dofs] @ shapes) * squared_frequencies
    )
    by_compliances = np.abs(compliances @ reactions**2) / squared_frequencies
    # half, as the error is that of the frequency, not of its square
    return np.asarray(0.5 * (by_beds + by_compliances))


def plate_theory_errors(
    held: HeldStructure, modes: Eigenmodes, material: Material, thin: bool = False
) -> Floats:
    """Return the relative errors of frequencies due to plate theory.

    Parameters
    ----------
    held : HeldStructure
        Plate of plate elements.
    modes : Eigenmodes
        Modes of the plate.
    material : Material
        Material of the plate.
    thin : bool, default False
        Whether the plate is one of Kirchhoff's theory instead of Mindlin's.

    Notes
    -----
    The mean of `bending_error` at the wave number that plate theory has at the frequency of the
    mode, and of `stretching_error`, weighted by the kinetic energies of bending and of in-plane
    motion; plus 0.02 % for the effect of edges, which plane waves do not have.
    """
    thickness = held.structure.thickness
    omega = modes.angular_frequencies
    in_plane = _in_plane(held, modes)
    waves = thickness * wave_numbers(omega, thickness, material, thin)
    bending = np.abs(bending_error(waves, material.poissons_ratio, thin))
    stretching = stretching_error(omega, thickness, material)
    return np.asarray(_EDGES + (1.0 - in_plane) * bending + in_plane * stretching)


def _in_plane(held: HeldStructure, modes: Eigenmodes) -> Floats:
    """Return the fraction of the kinetic energy of in-plane motion, for modes of plate elements."""
    structure = held.structure
    nodes = len(structure.mesh.nodes)
    shapes = (held.expansion @ modes.shapes).reshape(nodes, 5, -1)
    momenta = (structure.mass @ shapes.reshape(-1, shapes.shape[2])).reshape(shapes.shape)
    energy = np.einsum("nim,nim->im", shapes, momenta)  # by degree of freedom of a node, and mode
    return np.asarray(energy[:2].sum(axis=0) / np.maximum(energy.sum(axis=0), 1e-300))


def one_layer_errors(angular_frequencies: Floats, material: Material, thickness: float) -> Floats:
    """Return the relative errors of bending frequencies of one layer of second-order bricks.

    The frequencies are too high.

    Notes
    -----
    The shear strain of such elements does not vary over the height as that of a plate, so that
    their shear stiffness lacks the factor 5 / (6 - nu) of Mindlin's theory.
    """
    waves = thickness * wave_numbers(angular_frequencies, thickness, material)
    return stiff_shear_error(waves, material.poissons_ratio)


def main_cause(parts: Mapping[str, Floats]) -> str:
    """Return the cause of the largest contribution to the largest error of a mode.

    It is "" without causes.
    """
    if not parts:
        return ""
    worst_mode = int(np.nanargmax(sum(parts.values())))
    return max(parts, key=lambda cause: float(parts[cause][worst_mode]))
