"""Peak values of the motion of elastic bodies, as stored in `summary.json`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.bending import largest_bending

if TYPE_CHECKING:
    from vibroimpact.dynamics.response import Response
    from vibroimpact.structures.modal_model import ModalBasis

Peaks = Mapping[str, Any]

MAXIMA = (
    "max_displacement_m",
    "max_velocity_m_s",
    "max_acceleration_m_s2",
    "max_kinetic_energy_J",
    "max_strain_energy_J",
    "max_bending_m",
)
"""Names of the peak values of a body, the last one of a plate only."""
FREQUENCIES = ("frequencies_Hz", "frequency_errors")


def peaks_of(response: Response, history: Mapping[str, Floats]) -> Mapping[str, Peaks]:
    """Return peak values and frequencies of the bodies that have modes, by body name.

    Displacement, velocity and acceleration are largest magnitudes of the vertical motion of the
    centre of mass; the sphere's displacement is relative to its initial position, the plate's to
    its position at rest. The maxima are over the points of the history; the sphere's acceleration
    also includes that of the impact table.

    Parameters
    ----------
    response : Response
        Response of one drop.
    history : mapping of str to array
        Its history, as returned by `fine_history`.
    """
    problem = response.problem
    peaks: dict[str, dict[str, Any]] = {}
    if problem.sphere.modes is not None:
        impact_acceleration = float(np.max(response.impacts["max_acceleration_m_s2"], initial=0.0))
        peaks["sphere"] = {
            "max_displacement_m": _largest(history["position_m"] - history["position_m"][0]),
            "max_velocity_m_s": _largest(history["velocity_m_s"]),
            "max_acceleration_m_s2": max(
                impact_acceleration, _largest(history["acceleration_m_s2"])
            ),
            "max_kinetic_energy_J": _largest(history["kinetic_J"] + history["sphere_vibration_J"]),
            "max_strain_energy_J": _largest(history["sphere_strain_J"]),
            **frequencies_of(problem.sphere.modes),
        }
    if problem.plate.modes is not None:
        peaks["plate"] = {
            "max_displacement_m": _largest(history["plate_displacement_m"]),
            "max_velocity_m_s": _largest(history["plate_velocity_m_s"]),
            "max_acceleration_m_s2": _largest(history["plate_acceleration_m_s2"]),
            "max_kinetic_energy_J": _largest(history["plate_kinetic_J"]),
            "max_strain_energy_J": _largest(history["plate_strain_J"]),
            **frequencies_of(problem.plate.modes),
        }
        bending = largest_bending(response)
        if np.isfinite(bending):
            peaks["plate"]["max_bending_m"] = bending
    return peaks


def frequencies_of(modes: ModalBasis) -> dict[str, Any]:
    """Return the frequencies of a body's modes [Hz] and their errors, as in `summary.json`."""
    errors = known_errors(modes.frequency_errors, len(modes.frequencies))
    return dict(zip(FREQUENCIES, (modes.frequencies.tolist(), errors), strict=True))


def known_errors(errors: Floats | None, number: int) -> list[float | None]:
    """Return relative frequency errors as a list for JSON, None where an error is unknown.

    Parameters
    ----------
    errors : array or None
        Relative errors of the frequencies, NaN where unknown; None if all are.
    number : int
        Number of frequencies.

    Examples
    --------
    >>> known_errors(np.array([0.001, np.nan]), 2)
    [0.001, None]
    """
    if errors is None:
        return [None] * number
    return [float(error) if np.isfinite(error) else None for error in errors]


def _largest(column: Floats) -> float:
    return float(np.abs(column).max())
