"""How far computed frequencies may be off: for the mesh, for the theory of plates, for how supports hold, and for a reduction."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping

import numpy as np
from scipy.optimize import brentq

from vibroimpact.materials import Material
from vibroimpact.structures.mesh import Floats
from vibroimpact.structures.modes import Eigenmodes
from vibroimpact.structures.plate_element import shear_factor
from vibroimpact.structures.supports.constraints import HeldStructure

MESH, THEORY, SUPPORTS, REDUCTION = "the mesh", "the theory of plates", "the supports", "the reduction"
"""What frequencies are off for."""

_BED = 0.1  # of the stiffness of a bed: how far it is off, by plates on round patches of 1.25 to 2.5 thicknesses in radius
_BED_IN_PLANE = 0.5  # the same for motions in the plane, which were 0.9 to 1.8 % too stiff
_EDGES = 2e-4  # beside what Lamb's waves say: plates with edges differ from refined bricks by so much
_LAYERS = (0.05, 6.0, 60)  # wave number times thickness, from and to, and how many of the table of plate theory


def from_coarser(fine: Floats, coarse: Floats, gain: float) -> Floats:
    """Return by what part frequencies are off for the mesh, from those of a coarser one.

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
    >>> from_coarser(np.array([100.0]), np.array([103.0]), 4.0).tolist()
    [0.01]
    """
    return np.asarray(np.abs(coarse / fine - 1.0) / (gain - 1.0))


def of_supports(held: HeldStructure, modes: Eigenmodes) -> Floats:
    """Return by what part frequencies are off for how the supports of plate elements are modelled.

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


def of_plate_theory(held: HeldStructure, modes: Eigenmodes, material: Material) -> Floats:
    """Return by what part frequencies of a thick plate are off for its theory.

    Parameters
    ----------
    held : HeldStructure
        Of plate elements.
    modes : Eigenmodes
        Its modes.
    material : Material
        Of the plate.

    Notes
    -----
    Bending waves of the frequency of a mode, as long as Mindlin's theory makes them, have another frequency in three dimensions:
    that of H. Lamb's lowest antisymmetric wave (Proc. R. Soc. A 93:114, 1917). Waves in the plane are as much slower than plane stress
    makes them as Lamb's lowest symmetric wave, nu^2 (k h)^2 / (24 (1 - nu)^2). Modes have the mean of both, weighted by kinetic energy,
    and 0.02 % more for what the edges of a plate do that waves in the middle of it do not.
    """
    nu, in_plane = material.poissons_ratio, _in_plane(held, modes)
    speed = math.sqrt(material.youngs_modulus / (2.0 * (1.0 + nu) * material.density))
    scaled = modes.angular_frequencies * held.structure.thickness / speed  # frequencies over shear speed and thickness
    places, errors = _bending_errors(nu)
    stretch = nu**2 / (24.0 * (1.0 - nu) ** 2) * 0.5 * (1.0 - nu) * scaled**2  # of the wave number of plane stress
    return np.asarray(_EDGES + (1.0 - in_plane) * np.interp(scaled, places, errors) + in_plane * stretch)


def _in_plane(held: HeldStructure, modes: Eigenmodes) -> Floats:
    """Return the part of the kinetic energy of modes of plate elements that is of motion in the plane."""
    structure = held.structure
    moved = (held.expansion @ modes.shapes).reshape(len(structure.mesh.nodes), 5, -1)
    momenta = (structure.mass @ moved.reshape(-1, moved.shape[2])).reshape(moved.shape)
    energy = np.einsum("nim,nim->im", moved, momenta)
    return np.asarray(energy[:2].sum(axis=0) / np.maximum(energy.sum(axis=0), 1e-300))


def of_one_layer(frequencies: Floats, material: Material, thickness: float) -> Floats:
    """Return by what part bending frequencies of one layer of bricks of second order are too high.

    Notes
    -----
    Their shear strain does not vary over the height as that of a plate does, so that shear is as stiff as without the
    factor 5 / (6 - nu) of Mindlin's theory.
    """
    nu = material.poissons_ratio
    speed = math.sqrt(material.youngs_modulus / (2.0 * (1.0 + nu) * material.density))
    scaled = 2.0 * np.pi * np.asarray(frequencies) * thickness / speed
    waves = np.geomspace(*_LAYERS)
    soft = np.array([_mindlin(wave, nu, shear_factor(nu)) for wave in waves])
    stiff = np.array([_mindlin(wave, nu, 1.0) for wave in waves])
    return np.asarray(np.interp(scaled, soft, stiff / soft - 1.0))


def main_cause(parts: Mapping[str, Floats]) -> str:
    """Return the part that is largest where the sum of all parts is."""
    worst = int(np.nanargmax(sum(parts.values()))) if parts else 0
    return max(parts, key=lambda name: float(parts[name][worst]), default="")


def _mindlin(wave: float, nu: float, factor: float) -> float:
    """Return the frequency of Mindlin's bending wave, over shear speed and thickness, of a wave number times thickness."""
    rigidity, shear = 1.0 / (6.0 * (1.0 - nu)), factor  # over G h^3, and over G h
    squared = wave**2
    linear = -(rigidity * squared + shear + shear * squared / 12.0)
    root = math.sqrt(linear**2 - rigidity * shear * squared**2 / 3.0)
    return math.sqrt(2.0 * rigidity * shear * squared**2 / (-linear + root))


@functools.cache
def _bending_errors(nu: float) -> tuple[Floats, Floats]:
    """Return frequencies of Mindlin's bending waves, over shear speed and thickness, and by what part each is off."""
    waves = np.geomspace(*_LAYERS)
    found = np.array([_mindlin(wave, nu, shear_factor(nu)) for wave in waves])
    errors = np.abs(found / np.array([_lamb(wave, nu, near) for wave, near in zip(waves, found, strict=True)]) - 1.0)
    return found, np.maximum.accumulate(errors)  # where it changes its sign it is not right


def _lamb(wave: float, nu: float, near: float) -> float:
    """Return the frequency of Lamb's lowest antisymmetric wave near one, in the units of `_mindlin`."""
    ratio = 0.5 * (1.0 - 2.0 * nu) / (1.0 - nu)  # of the squares of the speeds of shear and of pressure

    def left(frequency: float) -> float:
        fast, slow = math.sqrt(wave**2 - ratio * frequency**2), math.sqrt(wave**2 - frequency**2)
        return 4.0 * wave**2 * fast * slow * math.tanh(0.5 * slow) - (wave**2 + slow**2) ** 2 * math.tanh(0.5 * fast)

    high = min(1.05 * near, wave * (1.0 - 1e-12))
    return float(brentq(left, 0.9 * near, high, xtol=1e-14 * near, rtol=1e-14))
