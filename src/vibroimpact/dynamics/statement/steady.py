r"""Steady motion of a plate on supports that move.

A mode i of unit modal mass, with the momentum :math:`\Gamma_i` per unit modal velocity along the
motion of the supports, obeys

.. math:: \ddot q_i + 2 \zeta_i \omega_i \dot q_i + \omega_i^2 q_i = -\Gamma_i \ddot s

in displacements relative to the supports (Craig and Kurdila, Fundamentals of Structural Dynamics,
2nd ed., section 9.2). The plate moves steadily when a drop begins; what impacts excite is the
difference from that, as the equations are linear.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.dynamics.statement.plate_motion import PlateMotion

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices


def steady_phasors(
    motion: PlateMotion, modes: ModalBasis | None, shapes: Floats | None = None
) -> Complex:
    """Return the phasors of the steady motion of a point of the plate along its normal [m] (k,).

    They are as `PlateMotion.at` takes them.

    Parameters
    ----------
    motion : PlateMotion
        Motion of the supports.
    modes : ModalBasis or None
        Modes of the plate.
    shapes : array, shape (modes,), optional
        Displacement of the point by each mode [kg^-1/2]; by default of the contact point.
    """
    supports = motion.direction[2] * motion.phasors
    if modes is None:
        return np.asarray(supports)
    if shapes is None:
        shapes = modes.contact
    return np.asarray(supports + shapes @ steady_modes(motion, modes))


def steady_surface(motion: PlateMotion, modes: ModalBasis) -> Complex:
    """Return the phasors of the steady motion of the contact point in space [m] (3, k).

    They are along x, y and the normal, as `PlateMotion.at` takes them. The modes must tell how they
    move the point along the plate.
    """
    assert modes.along is not None
    shapes = np.column_stack([modes.along, modes.contact])
    supports = np.outer(motion.direction, motion.phasors)
    return np.asarray(supports + shapes.T @ steady_modes(motion, modes))


def steady_modes(motion: PlateMotion, modes: ModalBasis) -> Complex:
    """Return the phasors of the modes in the steady motion [kg^1/2 m] (modes, k).

    They are relative to the supports.
    """
    momentum = (modes.participation @ np.array(motion.direction))[:, None]  # Gamma
    omega = modes.angular_frequencies[:, None]
    ratio = modes.damping_ratios[:, None]
    driving = motion.angular_frequency
    dynamic_stiffness = omega**2 - driving**2 + 2j * ratio * omega * driving
    return np.asarray(momentum * driving**2 * motion.phasors / dynamic_stiffness)
