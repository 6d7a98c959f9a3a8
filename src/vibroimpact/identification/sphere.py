r"""Size, speed and place of a sphere from records: the contact of the case is computed, and fitted
to them.

The modes that the case keeps end somewhere, and its mesh has errors. These are unknowns of the fit
with a prior, so that the intervals contain them:

* the contact force is :math:`F + c_1\,\Delta_1 F + c_2\,\Delta_2 F`, with the changes by an
  estimate of the modes left out, in the next
  octave and above it, and both c of mean one, with the deviations 0.3 and one;
* the static compliance of the plate at the contact lacks what a finer mesh adds, with the spread
  over places and the errors of the frequencies as its deviation;
* the static response of the modes left out to each sensor is multiplied by :math:`1 + d_s`, of zero
  mean and deviation one, as it grows towards their frequencies;
* each frequency is multiplied by :math:`1 + \epsilon_i`, of zero mean and of its own estimated
  error;
* what is stated as uncertain of the plate and its sensors: thickness, modulus, positions,
  sensitivities, resonances. The records are not linear in these, and are computed again for each
  step of the fit.
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
from vibroimpact.identification.contact import ContactForce, Spheres, contact_forces_of
from vibroimpact.identification.measured import Measured
from vibroimpact.identification.model_errors import model_error_signals
from vibroimpact.identification.plate import (
    Place,
    Plate,
    compliance_error,
    compliances_of,
    shapes_of,
    with_compliance,
    with_modes_left_out,
)
from vibroimpact.identification.pulses import Candidate
from vibroimpact.identification.setting import OF_PLATE, STEPS, Setting, numbers_of, setup_slopes
from vibroimpact.identification.setup import Setup
from vibroimpact.signals.inverse.gauss_newton import Fit, gauss_newton
from vibroimpact.signals.inverse.hertz_pulse import sphere_of_pulse
from vibroimpact.signals.inverse.noise_left import noise_left

_NUDGE, _LEAP, _RATIO = 1e-4, 0.02, 2e-3
"""Steps of derivatives: along the plate [m], in time [samples], in radius and speed [-]."""
_RESTITUTION = 0.6
"""Restitution that the start is made with."""
_ROUNDS, _SETTLED = 6, 0.95
"""Most fits with the noise of the fit before, and the part of that noise that the last
one leaves at least: within its scatter.
"""
_EXACT = 1e-4
"""Error of the responses of the model itself, over the rms value of a record: the least
noise that a fit can have.
"""
_NEXT_OCTAVE = 0.3
"""Standard deviation of the effect of the modes of the next octave, over its estimate:
twice that over 60 places of a plate.
"""
_FITTED = 5
"""Number of parameters that are asked for; unknowns with a prior follow them."""
_OF_CONTACT = 3
"""Number of unknowns of the contact, which are the first: both c and the error of the
compliance.
"""
_FARTHEST = np.array([3e-3, 6e-3, 3e-3, 3e-3, 0.3, 0.1])
"""Largest change in a step of the fit of thickness, modulus [-], x, y of a sensor [m],
its sensitivity and resonance [-].
"""


@dataclass(frozen=True)
class SphereFit:
    """A sphere whose contact explains the records.

    Parameters
    ----------
    parameters : array, shape (5,)
        x and y of the place [m], logarithms of the radius [m] and of the speed [m/s], and first
        touch after the first sample [s].
    covariance : array, shape (5, 5)
        Their covariance.
    force : ContactForce
        The contact force.
    force_covariance : array, shape (3, 3)
        Covariance of the facts of the force.
    residual : array, shape (S, samples)
        What the fit leaves of the records, in their units.
    noise : array, shape (S,)
        Standard deviation of each record about the fit, as it tells it.
    problem : Problem
        The problem with its contact at the place.
    plate : Plate
        The plate in the set-up that was found.
    setting : Setting
        That set-up, with its errors; as the case states it, where it is taken as certain.
    converged : bool
        Whether the fit came to an end.
    """

    parameters: Floats
    covariance: Floats
    force: ContactForce
    force_covariance: Floats
    residual: Floats
    noise: Floats
    problem: Problem
    plate: Plate
    setting: Setting
    converged: bool


class _Explained(NamedTuple):
    """What a sphere makes of the records.

    `left`: its signals less the records, (S, samples). `slopes`: derivatives of `left` in all
    parameters and unknowns (S, samples, p). `force`: its contact force. `force_slopes`: derivatives
    of the facts of the force in all parameters and unknowns, (3, p). `problem`: with the contact at
    its place. `plate`: in its set-up.
    """

    left: Floats
    slopes: Floats
    force: ContactForce
    force_slopes: Floats
    problem: Problem
    plate: Plate


def fit_sphere(
    plate: Plate, measured: Measured, start: Candidate, place: Place | None = None
) -> SphereFit:
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
    case, sensors = plate.case, len(measured.sensors)
    pulse = (
        start.impulse,
        start.duration,
        float(sphere_density(case.sphere)),
        contact_pair(case).effective_modulus,
    )
    radius, speed = sphere_of_pulse(*pulse, _RESTITUTION)
    parameters = np.array(
        [*(start.place if place is None else place), np.log(radius), np.log(speed), start.touch]
    )
    lacking, deviation = compliance_error(plate, plate.problem)
    deviations = plate.errors.deviations(sensors)
    # in their deviations
    unknowns = _OF_CONTACT + sensors + len(plate.frequency_errors) + len(deviations)
    expected = np.append(
        [1.0 / _NEXT_OCTAVE, 1.0, lacking / deviation if deviation else 0.0],
        np.zeros(unknowns - _OF_CONTACT),
    )
    low, high = plate.bounds
    farthest = np.concatenate([_FARTHEST[:2], np.repeat(_FARTHEST[2:], sensors)])
    in_deviations = np.divide(
        farthest, deviations, out=np.full(len(deviations), np.inf), where=deviations > 0.0
    )
    of_model = np.full(unknowns - len(deviations), np.inf)
    most = np.array(
        [*(0.03 * (high - low)), 0.3, 0.3, 1.0 / measured.rate, *of_model, *in_deviations]
    )
    by_prior = np.concatenate([np.zeros((unknowns, _FITTED)), np.eye(unknowns)], axis=1)
    free = np.concatenate([np.full(2, place is None), np.ones(3 + unknowns)])

    @lru_cache(maxsize=2)
    def explained(given: bytes) -> _Explained:
        return _explained(plate, measured, np.frombuffer(given))

    def weighted(given: Floats, noise: Floats) -> tuple[Floats, Floats]:
        found, weights = explained(given.tobytes()), measured.heard / noise[:, None]
        slopes = found.slopes * free * weights[:, :, None]
        residual = np.append(found.left * weights, given[_FITTED:] - expected)
        return residual, np.concatenate([slopes.reshape(-1, len(free)), by_prior])

    def left_by(fit: Fit, noise: Floats) -> Floats:
        slopes = weighted(fit.parameters, noise)[1][: measured.value.size]
        return noise_left(
            explained(fit.parameters.tobytes()).left, measured.heard, slopes, fit.covariance
        )

    fit = gauss_newton(
        partial(weighted, noise=measured.noise), np.append(parameters, expected), most
    )
    exact = _EXACT * measured.rms
    noise = np.maximum(left_by(fit, measured.noise), exact)
    for _ in range(_ROUNDS):
        fit = gauss_newton(partial(weighted, noise=noise), fit.parameters, most)
        less = np.maximum(left_by(fit, noise), exact)
        if np.all(less > _SETTLED * noise):
            break
        noise = less  # the fit came from afar, and ended with what was left there as noise
    found = explained(fit.parameters.tobytes())
    vectors, values, _ = np.linalg.svd(
        fit.covariance[-len(deviations) :, -len(deviations) :], hermitian=True
    )
    return SphereFit(
        np.append(np.clip(fit.parameters[:2], low, high), fit.parameters[2:_FITTED]),
        fit.covariance[:_FITTED, :_FITTED],
        found.force,
        found.force_slopes @ fit.covariance @ found.force_slopes.T,
        -found.left,
        noise,
        found.problem,
        found.plate,
        Setting(
            plate,
            fit.parameters[-len(deviations) :] * deviations,
            deviations[:, None] * vectors * np.sqrt(values),
        ),
        fit.converged,
    )


def _explained(plate: Plate, measured: Measured, parameters: Floats) -> _Explained:
    """Return what a sphere makes of the records, from its parameters and the unknowns, in
    their deviations.
    """
    names, sensors = [sensor.name for sensor in measured.sensors], len(measured.sensors)
    deviations, samples = plate.errors.deviations(sensors), measured.value.shape[1]
    place, (radius, speed, touch) = np.clip(parameters[:2], *plate.bounds), parameters[2:_FITTED]
    unknown, numbers = (
        parameters[_FITTED : -len(deviations)],
        parameters[-len(deviations) :] * deviations,
    )
    setup, at = Setup.of(numbers), (float(place[0]), float(place[1]))
    here = plate if plate.errors.is_none else plate.under(setup, names)
    heard, there = here.heard(names), here.at(at)
    answers = heard.at(shapes_of(there), compliances_of(there, names))
    nudged = here.deflections(place + _NUDGE * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    radii, speeds = (
        np.exp(radius + _RATIO * np.array([0, 1, 0])),
        np.exp(speed + _RATIO * np.array([0, 0, 1])),
    )
    softer = with_compliance(there, compliance_error(here, there)[1])
    uncertain = np.flatnonzero(deviations[:OF_PLATE]).tolist()
    others = [
        plate.under(Setup.of(numbers + STEPS[number] * numbers_of(number, sensors)), names)
        for number in uncertain
    ]
    spheres = [
        Spheres(here.touched, there, radii, speeds),
        *(
            Spheres(here.touched, one, radii[:1], speeds[:1])
            for one in (*with_modes_left_out(there), softer)
        ),
        *(Spheres(other.touched, other.at(at), radii[:1], speeds[:1]) for other in others),
    ]
    force, larger, faster, *rest = contact_forces_of(spheres)
    changed, on_others = rest[:_OF_CONTACT], rest[_OF_CONTACT:]
    gains = 1.0 + setup.gain[:, None]

    def signals(of_sensors: Floats, of: ContactForce = force, later: float = 0.0) -> Floats:
        return gains * sampled_responses(
            of_sensors, measured.rate, touch + later + of.time, of.impulse, samples
        )

    bare, later = signals(answers), _LEAP / measured.rate

    of_setup, facts_of_setup = (
        np.zeros((len(deviations), *bare.shape)),
        np.zeros((len(force.facts), len(deviations))),
    )
    if not plate.errors.is_none:
        of_setup = setup_slopes(plate, here, numbers, names, at, lambda of: signals(of) / gains)
    for number, of in zip(uncertain, on_others, strict=True):
        of_setup[number] += (signals(answers, of) - bare) / STEPS[number]
        facts_of_setup[:, number] = (of.facts - force.facts) / STEPS[number]
    of_model = model_error_signals(
        here, there, names, measured.rate, touch + force.time, force.impulse, samples
    )
    of_contact = here.model_error * np.array([_NEXT_OCTAVE, 1.0, 1.0])
    errors = np.concatenate(
        [
            of_contact[:, None, None] * [signals(answers, one) - bare for one in changed],
            gains * of_model,
        ]
    )
    none = np.zeros(len(names))
    slopes = [
        *(signals(heard.at((one - nudged[0]) / _NUDGE, none)) for one in nudged[1:]),
        *((signals(answers, one) - bare) / _RATIO for one in (larger, faster)),
        (signals(answers, later=later) - bare) / later,
    ]
    facts_of_contact = of_contact * np.stack([one.facts - force.facts for one in changed], axis=1)
    facts_of_radius_and_speed = np.stack(
        [(one.facts - force.facts) / _RATIO for one in (larger, faster)], axis=1
    )
    nothing = np.zeros((len(force.facts), len(errors) - _OF_CONTACT))
    facts = [
        np.zeros((3, 2)),
        facts_of_radius_and_speed,
        np.zeros((3, 1)),
        facts_of_contact,
        nothing,
        facts_of_setup * deviations,
    ]
    return _Explained(
        bare + np.tensordot(unknown, errors, 1) - measured.value,
        np.moveaxis(
            np.concatenate([np.stack(slopes), errors, deviations[:, None, None] * of_setup]), 0, -1
        ),
        replace(force, facts=force.facts + facts_of_contact @ unknown[:_OF_CONTACT]),
        np.concatenate(facts, axis=1),
        there,
        here,
    )
