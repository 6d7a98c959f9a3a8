r"""Size, speed and place of a sphere from records: the contact of the case is computed, and fitted to them.

The modes that the case keeps end somewhere, and their frequencies have errors. These are unknowns of the fit with a prior of zero mean,
so that the intervals contain them:

* the contact force is :math:`F + c\,\Delta F`, with the change :math:`\Delta F` from half of the modes to all, and c of deviation one: if
  each doubling changes half of what the last one did, all further ones together change as much as the last;
* the static response of the modes left out to each sensor is multiplied by :math:`1 + d_s`, of deviation one, as it grows towards their
  frequencies;
* each frequency is multiplied by :math:`1 + \epsilon_i`, of its own estimated error.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.pair import contact_pair
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.identification.contact import ContactForce, contact_forces
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.plate import Place, Plate, compliances_of, shapes_of, with_half_the_modes
from vibroimpact.identification.pulses import Candidate
from vibroimpact.signals.inverse.gauss_newton import gauss_newton
from vibroimpact.signals.inverse.hertz_pulse import sphere_of_pulse

_NUDGE, _LEAP, _RATIO = 1e-4, 0.02, 2e-3
"""Steps of derivatives: along the plate [m], in time [samples], in radius and speed [-]."""
_RESTITUTION = 0.6
"""Restitution that the start is made with."""
_FITTED = 5
"""Number of parameters that are asked for; unknowns with a prior follow them."""


@dataclass(frozen=True)
class SphereFit:
    """A sphere whose contact explains the records.

    Parameters
    ----------
    parameters : array, shape (5,)
        x and y of the place [m], logarithms of the radius [m] and of the speed [m/s], and first touch after the first sample [s].
    covariance : array, shape (5, 5)
        Their covariance.
    force : ContactForce
        The contact force.
    force_covariance : array, shape (3, 3)
        Covariance of the facts of the force.
    residual : array, shape (S, samples)
        What the fit leaves of the records, in their units.
    problem : Problem
        The problem with its contact at the place.
    converged : bool
        Whether the fit came to an end.
    """

    parameters: Floats
    covariance: Floats
    force: ContactForce
    force_covariance: Floats
    residual: Floats
    problem: Problem
    converged: bool


class _Explained(NamedTuple):
    """What a sphere makes of the records.

    `left`: its signals less the records, (S, samples). `slopes`: derivatives of `left` in all parameters and unknowns (S, samples, p).
    `force`: its contact force. `force_slopes`: derivatives of the facts of the force in radius, speed and c, (3, 3). `problem`: with the
    contact at its place.
    """

    left: Floats
    slopes: Floats
    force: ContactForce
    force_slopes: Floats
    problem: Problem


def fit_sphere(plate: Plate, measured: Measured, start: Candidate, place: Place | None = None) -> SphereFit:
    """Return the sphere that explains the records, from near a pulse that does.

    Parameters
    ----------
    plate : Plate
        The plate, with the material of the sphere and the contact law.
    measured : Measured
        The records.
    start : Candidate
        The pulse.
    place : tuple of two floats, optional
        The place [m], if it is known.
    """
    case = plate.case
    pulse = (start.impulse, start.duration, case.sphere.material.density, contact_pair(case).effective_modulus)
    radius, speed = sphere_of_pulse(*pulse, _RESTITUTION)
    parameters = np.array([*(start.place if place is None else place), np.log(radius), np.log(speed), start.touch])
    prior = np.concatenate([np.ones(1 + len(measured.sensors)), plate.frequency_errors])
    most = np.array([*(0.06 * np.array(plate.half)), 0.3, 0.3, 1.0 / measured.rate, *np.full(len(prior), np.inf)])
    by_prior = np.concatenate([np.zeros((len(prior), _FITTED)), np.eye(len(prior))], axis=1)
    free = np.concatenate([np.full(2, place is None), np.ones(3), prior])  # unknowns are in their deviations

    def weighted(given: Floats, noise: Floats) -> tuple[Floats, Floats]:
        found = _explained(plate, measured, given * np.append(np.ones(_FITTED), prior))
        slopes = found.slopes * free / noise[:, None, None]
        residual = np.append(found.left / noise[:, None], given[_FITTED:])
        return residual, np.concatenate([slopes.reshape(-1, len(free)), by_prior])

    noise = measured.noise
    fit = gauss_newton(lambda given: weighted(given, noise), np.append(parameters, np.zeros(len(prior))), most)
    # what the first fit leaves tells better than a short quiet part how the records are to be weighed
    left = fit.residual[: measured.value.size].reshape(measured.value.shape)
    noise = noise * np.sqrt(np.mean(left**2, axis=1))
    fit = gauss_newton(lambda given: weighted(given, noise), fit.parameters, most)
    found = _explained(plate, measured, fit.parameters * np.append(np.ones(_FITTED), prior))
    scale = float(fit.residual @ fit.residual) / (measured.value.size - _FITTED)  # what the prior adds counts as data
    covariance, half = scale * fit.covariance, np.array(plate.half)
    told = np.ix_([2, 3, _FITTED], [2, 3, _FITTED])  # radius, speed and c
    return SphereFit(
        np.append(np.clip(fit.parameters[:2], -half, half), fit.parameters[2:_FITTED]),
        covariance[:_FITTED, :_FITTED],
        found.force,
        found.force_slopes @ covariance[told] @ found.force_slopes.T,
        -found.left,
        found.problem,
        fit.converged,
    )


def _explained(plate: Plate, measured: Measured, parameters: Floats) -> _Explained:
    """Return what a sphere makes of the records, from its parameters and the unknowns, each in its own unit."""
    case, names = plate.case, [sensor.name for sensor in measured.sensors]
    heard, bound, samples = plate.heard(names), np.array(plate.half), measured.value.shape[1]
    place, (radius, speed, touch), unknown = np.clip(parameters[:2], -bound, bound), parameters[2:_FITTED], parameters[_FITTED:]
    there = plate.at((float(place[0]), float(place[1])))
    shapes, compliances = shapes_of(there), compliances_of(there, names)
    answers = heard.at(shapes, compliances)
    nudged = plate.deflections(place + _NUDGE * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    radii, speeds = np.exp(radius + _RATIO * np.array([0, 1, 0])), np.exp(speed + _RATIO * np.array([0, 0, 1]))
    force, *others = contact_forces(case, there, radii, speeds)
    (coarse,) = contact_forces(case, with_half_the_modes(there), radii[:1], speeds[:1])

    def signals(at: Floats, of: ContactForce = force, later: float = 0.0) -> Floats:
        return sampled_responses(at, measured.rate, touch + later + of.time, of.impulse, samples)

    bare, later = signals(answers), _LEAP / measured.rate
    static = signals(compliances[:, None] * heard.residual)
    detuned = signals((shapes[:, None, None] * plate.detuned(names)).reshape(len(shapes) * len(names), -1))
    none = np.zeros(len(names))
    errors = np.concatenate(
        [
            (bare - signals(answers, coarse))[None],
            np.eye(len(names))[:, :, None] * static,
            detuned.reshape(len(shapes), len(names), samples),
        ]
    )
    slopes = [
        *(signals(heard.at((one - nudged[0]) / _NUDGE, none)) for one in nudged[1:]),
        *((signals(answers, one) - bare) / _RATIO for one in others),
        (signals(answers, later=later) - bare) / later,
    ]
    of_force = [*((one.facts - force.facts) / _RATIO for one in others), force.facts - coarse.facts]
    return _Explained(
        bare + np.tensordot(unknown, errors, 1) - measured.value,
        np.moveaxis(np.concatenate([np.stack(slopes), errors]), 0, -1),
        replace(force, facts=force.facts + unknown[0] * of_force[2]),
        np.stack(of_force, axis=1),
        there,
    )
