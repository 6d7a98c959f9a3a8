"""Displacement of the face of a plate in the modes of plate theory."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.surface import slope_divergence
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.structures.plate_waves import bending_factor, mindlin_squares, shear_wave_factor


def face_shapes(
    model: ModalModel, material: Material, place: tuple[float, float], deflection: Floats
) -> Floats:
    r"""Return the upward displacement of a face of a plate at a place, (modes,) [kg^-1/2].

    Parameters
    ----------
    model : ModalModel
        Modes of plate elements by the thick theory.
    material : Material
        Material of the plate.
    place : tuple of two floats
        x and y [m].
    deflection : array, shape (modes,)
        Upward deflection at the place by plate theory [kg^-1/2].

    Raises
    ------
    InputError
        If the place is not on the body.

    Notes
    -----
    At one angular frequency the deflection is :math:`w = w_1 + w_2` with :math:`\nabla^2 w_j =
    -k_j^2 w_j` (Mindlin 1951): a bending wave and a shear wave, which below :math:`\sqrt{12 \kappa
    G / (\rho h^2)}` is evanescent and occurs near edges and supports only. As the divergence of the
    slopes :math:`\beta` is :math:`\sum_j (k_j^2 - \rho \omega^2 / \kappa G)\,w_j`, both parts
    follow from w and that divergence. Then w_1 is multiplied by `bending_factor` of its wave
    number, and w_2 by `shear_wave_factor`.
    """
    thickness = model.thickness
    ratio = material.poissons_ratio
    divergence = model.cached(
        f"divergence {place}", lambda: model.modal_values(slope_divergence(model.mesh, place))[:, 0]
    )
    # k_1^2, k_2^2 and rho omega^2 / kappa G
    bending_square, shear_square, shear_term = mindlin_squares(
        model.angular_frequencies, thickness, material
    )
    bending_part = (divergence - (shear_square - shear_term) * deflection) / (
        bending_square - shear_square
    )
    of_bending = bending_factor(np.sqrt(bending_square) * thickness, ratio)
    of_shear = shear_wave_factor(shear_square * thickness**2, ratio)
    # the shear part is the rest of the deflection
    return np.asarray(of_shear * deflection + (of_bending - of_shear) * bending_part)
