r"""Estimates of the error due to modal truncation, from the modes that are kept."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.power_law import HERTZ_TIME
from vibroimpact.dynamics.problem import Problem

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis


def truncation_estimates(problem: Problem, impacts: dict[str, Floats]) -> dict[str, float]:
    r"""Return the estimated relative error of the first impact's largest force due to modal
    truncation, for each body that vibrates.

    The compliance of the modes left out is known where the law or a static solution carries it;
    what is missing then is their
    inertia, :math:`\sum \chi^2 / \omega^4\,\ddot F`, and at most all of what they do. Its sum over
    the modes left out is not
    more than that over the last octave of those kept, since :math:`\chi^2` times the density of
    modes is constant in a plate and
    grows with :math:`\omega^2` in a solid. Where nothing carries it, the same is done with
    :math:`\sum \chi^2 / \omega^2\,F`.
    Both over the tangent compliance of the contact, two thirds of indentation over force.

    Parameters
    ----------
    problem : Problem
        What was simulated.
    impacts : dict of str to array
        The impact table.

    Returns
    -------
    dict of str to float
        By the name of the body; NaN without an impact.
    """
    carried = bool(problem.facts.get("treatment", "consistent") != "superposed")
    found = {}
    for name in ("sphere", "plate"):
        modes = getattr(problem, name).modes
        if modes is not None:
            found[name] = _estimate(modes, impacts, carried)
    return found


def time_of_contact(impacts: Mapping[str, Any]) -> float:
    """Return the contact duration of the first impact [s]; for several contacts, that of a Hertzian
    contact of the same depth.

    Parameters
    ----------
    impacts : mapping of str to array
        The impact table, with at least one impact.
    """
    duration, contacts = float(impacts["duration_s"][0]), impacts.get("contacts")
    if contacts is None or contacts[0] < 2:
        return duration
    return min(
        duration,
        HERTZ_TIME
        * float(impacts["max_indentation_m"][0])
        / float(impacts["approach_speed_m_s"][0]),
    )


def _estimate(modes: ModalBasis, impacts: dict[str, Floats], carried: bool) -> float:
    if not len(impacts["impact"]):
        return float("nan")
    force, depth, duration = (
        float(impacts["max_force_N"][0]),
        float(impacts["max_indentation_m"][0]),
        time_of_contact(impacts),
    )
    omega, shape = modes.angular_frequencies, modes.contact
    octave = omega > 0.5 * omega[-1]
    compliance = (shape[octave] / omega[octave]) ** 2
    if carried:
        compliance = compliance * np.minimum(np.pi / (duration * omega[octave]), 1.0) ** 2
    return float(compliance.sum()) * force / (2.0 / 3.0 * depth)
