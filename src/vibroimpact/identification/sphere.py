r"""Size, speed and place of a sphere from records: the contact of the case is computed, and fitted to them.

The modes that the case keeps end somewhere, and its mesh has errors. These are unknowns of the fit with a prior, so that the intervals
contain them:

* the contact force is :math:`F + c_1\,\Delta_1 F + c_2\,\Delta_2 F`, with the changes by an estimate of the modes left out, in the next
  octave and above it, and both c of mean one, with the deviations 0.3 and one;
* the static compliance of the plate at the contact lacks what a finer mesh adds, with the spread over places and the errors of the
  frequencies as its deviation;
* the static response of the modes left out to each sensor is multiplied by :math:`1 + d_s`, of zero mean and deviation one, as it grows
  towards their frequencies;
* each frequency is multiplied by :math:`1 + \epsilon_i`, of zero mean and of its own estimated error.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.pair import contact_pair, sphere_density
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.place_responses import sampled_responses
from vibroimpact.identification.contact import ContactForce, contact_forces
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.model_errors import model_error_signals
from vibroimpact.identification.plate import Place, Plate, compliance_error, compliances_of, shapes_of, with_compliance, with_modes_left_out
from vibroimpact.identification.pulses import Candidate
from vibroimpact.signals.inverse.gauss_newton import Fit, gauss_newton
from vibroimpact.signals.inverse.hertz_pulse import sphere_of_pulse

_NUDGE, _LEAP, _RATIO = 1e-4, 0.02, 2e-3
"""Steps of derivatives: along the plate [m], in time [samples], in radius and speed [-]."""
_RESTITUTION = 0.6
"""Restitution that the start is made with."""
_ROUNDS, _SETTLED = 6, 0.7
"""Most fits with the noise of the fit before, and the part of that noise that the last one leaves at least."""
_EXACT = 1e-4
"""Error of the responses of the model itself, over the rms value of a record: the least noise that a fit can have."""
_NEXT_OCTAVE = 0.3
"""Standard deviation of the effect of the modes of the next octave, over its estimate: twice that over 60 places of a plate."""
_FITTED = 5
"""Number of parameters that are asked for; unknowns with a prior follow them."""
_OF_FORCE = [2, 3, 5, 6, 7]
"""Those that the contact force depends on: radius, speed, both c and the error of the compliance."""


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
    `force`: its contact force. `force_slopes`: derivatives of the facts of the force in radius, speed and its three unknowns, (3, 5).
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
    pulse = (start.impulse, start.duration, float(sphere_density(case.sphere)), contact_pair(case).effective_modulus)
    radius, speed = sphere_of_pulse(*pulse, _RESTITUTION)
    parameters = np.array([*(start.place if place is None else place), np.log(radius), np.log(speed), start.touch])
    lacking, deviation = compliance_error(plate, plate.problem)
    unknowns = 3 + len(measured.sensors) + len(plate.frequency_errors)  # in their deviations
    expected = np.append([1.0 / _NEXT_OCTAVE, 1.0, lacking / deviation if deviation else 0.0], np.zeros(unknowns - 3))
    most = np.array([*(0.06 * np.array(plate.half)), 0.3, 0.3, 1.0 / measured.rate, *np.full(unknowns, np.inf)])
    by_prior = np.concatenate([np.zeros((unknowns, _FITTED)), np.eye(unknowns)], axis=1)
    free = np.concatenate([np.full(2, place is None), np.ones(3 + unknowns)])

    @lru_cache(maxsize=2)
    def explained(given: bytes) -> _Explained:
        return _explained(plate, measured, np.frombuffer(given))

    def weighted(given: Floats, noise: Floats) -> tuple[Floats, Floats]:
        found = explained(given.tobytes())
        slopes = found.slopes * free / noise[:, None, None]
        residual = np.append(found.left / noise[:, None], given[_FITTED:] - expected)
        return residual, np.concatenate([slopes.reshape(-1, len(free)), by_prior])

    def noise_left(fit: Fit, noise: Floats) -> Floats:
        return _noise_of(explained(fit.parameters.tobytes()).left, weighted(fit.parameters, noise)[1], fit.covariance)

    fit = gauss_newton(partial(weighted, noise=measured.noise), np.append(parameters, expected), most)
    exact = _EXACT * np.sqrt((measured.value**2).mean(axis=1))
    noise = np.maximum(noise_left(fit, measured.noise), exact)
    for _ in range(_ROUNDS):
        fit = gauss_newton(partial(weighted, noise=noise), fit.parameters, most)
        less = np.maximum(noise_left(fit, noise), exact)
        if np.all(less > _SETTLED * noise):
            break
        noise = less  # the fit came from afar, and ended with what was left there as noise
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
    """Return what a sphere makes of the records, from its parameters and the unknowns, in their deviations."""
    case, names = plate.case, [sensor.name for sensor in measured.sensors]
    heard, bound, samples = plate.heard(names), np.array(plate.half), measured.value.shape[1]
    place, (radius, speed, touch), unknown = np.clip(parameters[:2], -bound, bound), parameters[2:_FITTED], parameters[_FITTED:]
    there = plate.at((float(place[0]), float(place[1])))
    answers = heard.at(shapes_of(there), compliances_of(there, names))
    nudged = plate.deflections(place + _NUDGE * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    radii, speeds = np.exp(radius + _RATIO * np.array([0, 1, 0])), np.exp(speed + _RATIO * np.array([0, 0, 1]))
    force, *others = contact_forces(case, there, radii, speeds)
    softer = with_compliance(there, compliance_error(plate, there)[1])
    changed = [contact_forces(case, one, radii[:1], speeds[:1])[0] for one in (*with_modes_left_out(there), softer)]

    def signals(at: Floats, of: ContactForce = force, later: float = 0.0) -> Floats:
        return sampled_responses(at, measured.rate, touch + later + of.time, of.impulse, samples)

    bare, later = signals(answers), _LEAP / measured.rate
    of_model = model_error_signals(plate, there, names, measured.rate, touch + force.time, force.impulse, samples)
    deviations = np.array([_NEXT_OCTAVE, 1.0, 1.0])
    errors = np.concatenate([deviations[:, None, None] * [signals(answers, one) - bare for one in changed], of_model])
    none = np.zeros(len(names))
    slopes = [
        *(signals(heard.at((one - nudged[0]) / _NUDGE, none)) for one in nudged[1:]),
        *((signals(answers, one) - bare) / _RATIO for one in others),
        (signals(answers, later=later) - bare) / later,
    ]
    of_unknowns = deviations * np.stack([one.facts - force.facts for one in changed], axis=1)
    of_radius_and_speed = np.stack([(one.facts - force.facts) / _RATIO for one in others], axis=1)
    return _Explained(
        bare + np.tensordot(unknown, errors, 1) - measured.value,
        np.moveaxis(np.concatenate([np.stack(slopes), errors]), 0, -1),
        replace(force, facts=force.facts + of_unknowns @ unknown[: len(changed)]),
        np.concatenate([of_radius_and_speed, of_unknowns], axis=1),
        there,
    )
