"""Displacement of the face of a plate in the modes of plate theory."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.structures.plate_waves import bending_factor, mindlin_squares, shear_wave_factor
from vibroimpact.structures.surface import slope_divergence


def face_shapes(
    model: ModalModel, material: Material, place: tuple[float, float], deflection: Floats
) -> Floats:
    r"""Return the upward displacement of the face of a plate at a place in its modes, (modes,)
    [kg^-1/2].

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
    -k_j^2 w_j` (Mindlin 1951): a bending
    wave and a shear wave, which below :math:`\sqrt{12 \kappa G / (\rho h^2)}` is evanescent and
    occurs near edges and supports only. As
    the divergence of the slopes :math:`\beta` is :math:`\sum_j (k_j^2 - \rho \omega^2 / \kappa
    G)\,w_j`, both parts follow from w and
    that divergence. Then w_1 is multiplied by `bending_factor` of its wave number, and w_2 by
    `shear_wave_factor`.
    """
    thickness = model.thickness
    divergence = model.cached(
        f"divergence {place}", lambda: model.modal_values(slope_divergence(model.mesh, place))[:, 0]
    )
    bending, shearing, lag = mindlin_squares(model.angular_frequencies, thickness, material)
    of_bending = (divergence - (shearing - lag) * deflection) / (bending - shearing)
    first = bending_factor(np.sqrt(bending) * thickness, material.poissons_ratio)
    second = shear_wave_factor(shearing * thickness**2, material.poissons_ratio)
    return np.asarray(second * deflection + (first - second) * of_bending)
