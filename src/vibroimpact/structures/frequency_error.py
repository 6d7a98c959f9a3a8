"""Errors of computed frequencies due to the mesh, the theory of plates, the model of supports and a reduction."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.modes import Eigenmodes
from vibroimpact.structures.plate_waves import bending_error, stiff_shear_error, stretching_error, wave_numbers
from vibroimpact.structures.supports.constraints import HeldStructure

MESH, THEORY, SUPPORTS, REDUCTION = "the mesh", "the theory of plates", "the supports", "the reduction"
"""Causes of errors of frequencies."""

_BED = 0.1  # of the stiffness of a bed: how far it is off, by plates on round patches of 1.25 to 2.5 thicknesses in radius
_BED_IN_PLANE = 0.85  # the same for motions in the plane, which were 0.9 to 2.0 % (steel) and 3.0 to 3.2 % (acrylic) too stiff
_EDGES = 2e-4  # beside what Lamb's waves say: plates with edges differ from refined bricks by so much


def from_coarser(fine: Floats, coarse: Floats, gain: float) -> Floats:
    """Return the relative errors of frequencies due to the mesh, estimated from those of a coarser one.

    Parameters
    ----------
    fine, coarse : array, shape (modes,)
        Frequencies on both meshes, each ascending.
    gain : float
        How many times less the fine mesh is off than the coarse one, > 1.

    Notes
    -----
    Richardson's extrapolation: what is left is the difference over gain - 1.

    Examples
    --------
    >>> from_coarser(np.array([100.0]), np.array([103.0]), 4.0).round(12).tolist()
    [0.01]
    """
    return np.asarray(np.abs(coarse / fine - 1.0) / (gain - 1.0))


def of_supports(held: HeldStructure, modes: Eigenmodes) -> Floats:
    """Return the relative errors of frequencies due to how the supports of plate elements are modelled.

    Notes
    -----
    To first order the square of a frequency changes by the part of the strain energy that is in a bed, times the change of the
    bed's stiffness; and by the squares of the reactions over the modal mass, times a compliance in series with them that is left out.
    """
    squared, shapes = modes.angular_frequencies**2, modes.shapes
    if not held.structure.thickness:
        return np.zeros(len(squared))
    off = _BED + (_BED_IN_PLANE - _BED) * _in_plane(held, modes)
    in_beds = off * np.einsum("ij,ij->j", shapes, held.bed @ shapes) / squared
    dofs, compliances = held.neglected
    if not len(dofs):
        return np.asarray(0.5 * in_beds)
    structure = held.structure
    moved = held.expansion @ shapes
    reactions = structure.stiffness[dofs] @ moved - (structure.mass[dofs] @ moved) * squared
    return np.asarray(0.5 * (in_beds + np.abs(compliances @ reactions**2) / squared))


def of_plate_theory(held: HeldStructure, modes: Eigenmodes, material: Material, thin: bool = False) -> Floats:
    """Return the relative errors of frequencies of a plate due to its theory.

    Parameters
    ----------
    held : HeldStructure
        Of plate elements.
    modes : Eigenmodes
        Its modes.
    material : Material
        Of the plate.
    thin : bool, default False
        Kirchhoff's theory instead of Mindlin's.

    Notes
    -----
    What `bending_error` says of waves of bending as long as plate theory makes them at the frequency of a mode, and `stretching_error`
    of waves in the plane. Modes have the mean of both, weighted by kinetic energy, and 0.02 % more for what the edges of a plate do
    that waves in the middle of it do not.
    """
    thickness, ratio, omega, in_plane = held.structure.thickness, material.poissons_ratio, modes.angular_frequencies, _in_plane(held, modes)
    bending = np.abs(bending_error(thickness * wave_numbers(omega, thickness, material, thin), ratio, thin))
    return np.asarray(_EDGES + (1.0 - in_plane) * bending + in_plane * stretching_error(omega, thickness, material))


def _in_plane(held: HeldStructure, modes: Eigenmodes) -> Floats:
    """Return the part of the kinetic energy of modes of plate elements that is of motion in the plane."""
    structure = held.structure
    moved = (held.expansion @ modes.shapes).reshape(len(structure.mesh.nodes), 5, -1)
    momenta = (structure.mass @ moved.reshape(-1, moved.shape[2])).reshape(moved.shape)
    energy = np.einsum("nim,nim->im", moved, momenta)
    return np.asarray(energy[:2].sum(axis=0) / np.maximum(energy.sum(axis=0), 1e-300))


def of_one_layer(angular_frequencies: Floats, material: Material, thickness: float) -> Floats:
    """Return the relative errors of bending frequencies of one layer of bricks of second order, which are too high.

    Notes
    -----
    Their shear strain does not vary over the height as that of a plate does, so that shear is as stiff as without the
    factor 5 / (6 - nu) of Mindlin's theory.
    """
    waves = thickness * wave_numbers(angular_frequencies, thickness, material)
    return stiff_shear_error(waves, material.poissons_ratio)


def main_cause(parts: Mapping[str, Floats]) -> str:
    """Return the name of the largest error of the mode whose sum of errors is largest."""
    worst = int(np.nanargmax(sum(parts.values()))) if parts else 0
    return max(parts, key=lambda name: float(parts[name][worst]), default="")
