r"""Estimates of the error due to modal truncation, from the modes that are kept."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.power_law import HERTZ_TIME
from vibroimpact.dynamics.statement.problem import Problem

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis


def truncation_estimates(problem: Problem, impacts: dict[str, Floats]) -> dict[str, float]:
    r"""Return the estimated relative error of the first largest force by modal truncation.

    There is one for each body that vibrates. The compliance of the modes left out is known where
    the law or a static solution carries it; what is missing then is their inertia,
    :math:`\sum \chi^2 / \omega^4\,\ddot F`, and at most all of what they do. Its sum over the modes
    left out is not more than that over the last octave of those kept, since :math:`\chi^2` times
    the density of modes is constant in a plate and grows with :math:`\omega^2` in a solid. Where
    nothing carries it, the same is done with :math:`\sum \chi^2 / \omega^2\,F`. Both are taken over
    the tangent compliance of the contact, two thirds of indentation over force.

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
    estimates = {}
    for name, body in (("sphere", problem.sphere), ("plate", problem.plate)):
        if body.modes is not None:
            estimates[name] = _estimate(body.modes, impacts, carried)
    return estimates


def time_of_contact(impacts: Mapping[str, Any]) -> float:
    """Return the contact duration of the first impact [s].

    For several contacts, it is that of a Hertzian contact of the same depth.

    Parameters
    ----------
    impacts : mapping of str to array
        The impact table, with at least one impact.
    """
    duration = float(impacts["duration_s"][0])
    contacts = impacts.get("contacts")
    if contacts is None or contacts[0] < 2:
        return duration
    depth = float(impacts["max_indentation_m"][0])
    speed = float(impacts["approach_speed_m_s"][0])
    return min(duration, HERTZ_TIME * depth / speed)


def _estimate(modes: ModalBasis, impacts: dict[str, Floats], carried: bool) -> float:
    """Return the estimate of one body, from the compliance of the last octave of its modes.

    `carried`: whether the law or a static solution carries the compliance of the modes left out.
    """
    if not len(impacts["impact"]):
        return float("nan")
    force = float(impacts["max_force_N"][0])
    depth = float(impacts["max_indentation_m"][0])
    duration = time_of_contact(impacts)
    last_octave = modes.angular_frequencies > 0.5 * modes.angular_frequencies[-1]
    omega = modes.angular_frequencies[last_octave]
    compliance = (modes.contact[last_octave] / omega) ** 2
    if carried:
        compliance = compliance * np.minimum(np.pi / (duration * omega), 1.0) ** 2
    return float(compliance.sum()) * force / (2.0 / 3.0 * depth)
