r"""Size, speed and place of a sphere from records: the contact of the case is computed, and fitted to them.

The modes that the case keeps end somewhere, and its mesh has errors. These are unknowns of the fit with a prior, so that the intervals
contain them:

* the contact force is :math:`F + c\,\Delta F`, with the change :math:`\Delta F` by an estimate of all modes left out, and c of mean one
  and deviation one;
* the static compliance of the plate at the contact has an error of zero mean, of the size that the errors of the frequencies tell;
* the static response of the modes left out to each sensor is multiplied by :math:`1 + d_s`, of zero mean and deviation one, as it grows
  towards their frequencies;
* each frequency is multiplied by :math:`1 + \epsilon_i`, of zero mean and of its own estimated error.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.pair import contact_pair
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.identification.contact import ContactForce, contact_forces
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.plate import Place, Plate, compliance_error, compliances_of, shapes_of, with_compliance, with_modes_left_out
from vibroimpact.identification.pulses import Candidate
from vibroimpact.signals.inverse.gauss_newton import gauss_newton
from vibroimpact.signals.inverse.hertz_pulse import sphere_of_pulse

_NUDGE, _LEAP, _RATIO = 1e-4, 0.02, 2e-3
"""Steps of derivatives: along the plate [m], in time [samples], in radius and speed [-]."""
_RESTITUTION = 0.6
"""Restitution that the start is made with."""
_FITTED = 5
"""Number of parameters that are asked for; unknowns with a prior follow them."""
_OF_FORCE = [2, 3, 5, 6]
"""Those that the contact force depends on: radius, speed, c and the error of the compliance."""


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
    `force`: its contact force. `force_slopes`: derivatives of the facts of the force in radius, speed and its two unknowns, (3, 4).
    `problem`: with the contact at its place.
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
    prior = np.append(np.ones(2 + len(measured.sensors)), plate.frequency_errors)
    expected, own = np.eye(len(prior))[0], np.append(np.ones(_FITTED), prior)  # unknowns are in their deviations
    most = np.array([*(0.06 * np.array(plate.half)), 0.3, 0.3, 1.0 / measured.rate, *np.full(len(prior), np.inf)])
    by_prior = np.concatenate([np.zeros((len(prior), _FITTED)), np.eye(len(prior))], axis=1)
    free = np.concatenate([np.full(2, place is None), np.ones(3), prior])

    @lru_cache(maxsize=2)
    def explained(given: bytes) -> _Explained:
        return _explained(plate, measured, np.frombuffer(given) * own)

    def weighted(given: Floats, noise: Floats) -> tuple[Floats, Floats]:
        found = explained(given.tobytes())
        slopes = found.slopes * free / noise[:, None, None]
        residual = np.append(found.left / noise[:, None], given[_FITTED:] - expected)
        return residual, np.concatenate([slopes.reshape(-1, len(free)), by_prior])

    fit = gauss_newton(lambda given: weighted(given, measured.noise), np.append(parameters, expected), most)
    noise = _noise_of(explained(fit.parameters.tobytes()).left, weighted(fit.parameters, measured.noise)[1], fit.covariance)
    fit = gauss_newton(lambda given: weighted(given, noise), fit.parameters, most)
    found, half = explained(fit.parameters.tobytes()), np.array(plate.half)
    return SphereFit(
        np.append(np.clip(fit.parameters[:2], -half, half), fit.parameters[2:_FITTED]),
        fit.covariance[:_FITTED, :_FITTED],
        found.force,
        found.force_slopes @ fit.covariance[np.ix_(_OF_FORCE, _OF_FORCE)] @ found.force_slopes.T,
        -found.left,
        found.problem,
        fit.converged,
    )


def _noise_of(left: Floats, slopes: Floats, covariance: Floats) -> Floats:
    """Return the noise of each record from what a fit leaves of it (S, samples), which tells it better than a short quiet part does.

    What is left has less energy than the noise by what the fit follows of it: as many samples as unknowns that the record tells, which is
    the trace of its part of the projection (MacKay, as for the force).
    """
    sensors, samples = left.shape
    of_records = slopes[: left.size].reshape(sensors, samples, -1)
    followed = ((of_records @ covariance) * of_records).sum(axis=(1, 2))
    return np.asarray(np.sqrt((left**2).sum(axis=1) / (samples - followed)))


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
    (whole,) = contact_forces(case, with_modes_left_out(there), radii[:1], speeds[:1])
    (softer,) = contact_forces(case, with_compliance(there, compliance_error(there, plate.frequency_errors)), radii[:1], speeds[:1])

    def signals(at: Floats, of: ContactForce = force, later: float = 0.0) -> Floats:
        return sampled_responses(at, measured.rate, touch + later + of.time, of.impulse, samples)

    bare, later = signals(answers), _LEAP / measured.rate
    static = signals(compliances[:, None] * heard.residual)
    detuned = signals((shapes[:, None, None] * plate.detuned(names)).reshape(len(shapes) * len(names), -1))
    none = np.zeros(len(names))
    errors = np.concatenate(
        [
            np.stack([signals(answers, whole) - bare, signals(answers, softer) - bare]),
            np.eye(len(names))[:, :, None] * static,
            detuned.reshape(len(shapes), len(names), samples),
        ]
    )
    slopes = [
        *(signals(heard.at((one - nudged[0]) / _NUDGE, none)) for one in nudged[1:]),
        *((signals(answers, one) - bare) / _RATIO for one in others),
        (signals(answers, later=later) - bare) / later,
    ]
    of_force = [*((one.facts - force.facts) / _RATIO for one in others), whole.facts - force.facts, softer.facts - force.facts]
    return _Explained(
        bare + np.tensordot(unknown, errors, 1) - measured.value,
        np.moveaxis(np.concatenate([np.stack(slopes), errors]), 0, -1),
        replace(force, facts=force.facts + unknown[0] * of_force[2] + unknown[1] * of_force[3]),
        np.stack(of_force, axis=1),
        there,
    )
