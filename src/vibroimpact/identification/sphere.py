r"""Size, speed and place of a sphere from records: the contact of the case, fitted to them.

The modes that the case keeps end somewhere, and its mesh has errors. These are unknowns of the fit
with a prior, so that the intervals contain them:

* the contact force is :math:`F + c_1\,\Delta_1 F + c_2\,\Delta_2 F`, with the changes by an
  estimate of the modes left out, in the next octave and above it, and both c of mean one, with the
  deviations 0.3 and one;
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

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.rigid.pair import contact_pair, sphere_density
from vibroimpact.dynamics.sensors.place_responses import PlaceResponses, sampled_responses
from vibroimpact.dynamics.statement.problem import Problem
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

_NUDGE = 1e-4
"""Step of derivatives along the plate [m]."""
_LEAP = 0.02
"""Step of derivatives in time [samples]."""
_RATIO = 2e-3
"""Step of derivatives in the logarithms of radius and speed [-]."""
_RESTITUTION = 0.6
"""Restitution that the start is made with."""
_ROUNDS = 6
"""Most fits with the noise of the fit before."""
_SETTLED = 0.95
"""Part of that noise that the last fit leaves at least: within its scatter."""
_EXACT = 1e-4
"""Error of the responses of the model itself, over the rms value of a record.

It is the least noise that a fit can have.
"""
_NEXT_OCTAVE = 0.3
"""Standard deviation of the effect of the modes of the next octave, over its estimate.

It is twice that over 60 places of a plate.
"""
_FITTED = 5
"""Number of parameters that are asked for; unknowns with a prior follow them."""
_OF_CONTACT = 3
"""Number of unknowns of the contact, which come first: both c and the error of the compliance."""
_LARGEST_STEPS = np.array([3e-3, 6e-3, 3e-3, 3e-3, 0.3, 0.1])
"""Largest change of the numbers of a set-up in a step of the fit.

Those of thickness, modulus [-], x, y of a sensor [m], its sensitivity and resonance [-].
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

    `misfit`: its signals less the records, (S, samples). `slopes`: derivatives of `misfit` in all
    parameters and unknowns (S, samples, p). `force`: its contact force. `force_slopes`: derivatives
    of the facts of the force in all parameters and unknowns, (3, p). `problem`: with the contact at
    its place. `plate`: in its set-up.
    """

    misfit: Floats
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
    sensors = len(measured.sensors)
    setup_deviations = plate.errors.deviations(sensors)
    expected = _expected_unknowns(plate, sensors, len(setup_deviations))
    unknowns = len(expected)
    prior_slopes = np.concatenate([np.zeros((unknowns, _FITTED)), np.eye(unknowns)], axis=1)
    # a place that is known is no parameter
    free = np.concatenate([np.full(2, place is None), np.ones(3 + unknowns)])
    largest_steps = _largest_steps(plate, measured, unknowns)

    # a fit asks again for the parameters that it came to
    @lru_cache(maxsize=2)
    def explained(parameters: bytes) -> _Explained:
        return _explained(plate, measured, np.frombuffer(parameters))

    def weighted(parameters: Floats, noise: Floats) -> tuple[Floats, Floats]:
        """Return residuals over their deviations, those of the priors last, and their slopes."""
        sphere = explained(parameters.tobytes())
        weights = measured.heard / noise[:, None]
        slopes = sphere.slopes * free * weights[:, :, None]
        residual = np.append(sphere.misfit * weights, parameters[_FITTED:] - expected)
        return residual, np.concatenate([slopes.reshape(-1, len(free)), prior_slopes])

    exact = _EXACT * measured.rms

    def noise_about(fit: Fit, noise: Floats) -> Floats:
        """Return the noise of each record about a fit that was made with some noise."""
        _, slopes = weighted(fit.parameters, noise)
        misfit = explained(fit.parameters.tobytes()).misfit
        of_records = slopes[: measured.value.size]
        return np.maximum(noise_left(misfit, measured.heard, of_records, fit.covariance), exact)

    parameters = np.append(_first_parameters(plate, start, place), expected)
    fit = gauss_newton(partial(weighted, noise=measured.noise), parameters, largest_steps)
    noise = noise_about(fit, measured.noise)
    for _ in range(_ROUNDS):
        fit = gauss_newton(partial(weighted, noise=noise), fit.parameters, largest_steps)
        noise_of_fit = noise_about(fit, noise)
        if np.all(noise_of_fit > _SETTLED * noise):
            break
        # the fit came from afar, and began with what was left there as noise
        noise = noise_of_fit

    sphere = explained(fit.parameters.tobytes())
    fitted_place = np.clip(fit.parameters[:2], *plate.bounds)
    return SphereFit(
        parameters=np.append(fitted_place, fit.parameters[2:_FITTED]),
        covariance=fit.covariance[:_FITTED, :_FITTED],
        force=sphere.force,
        force_covariance=sphere.force_slopes @ fit.covariance @ sphere.force_slopes.T,
        residual=-sphere.misfit,
        noise=noise,
        problem=sphere.problem,
        plate=sphere.plate,
        setting=_setting(plate, fit, setup_deviations),
        converged=fit.converged,
    )


def _setting(plate: Plate, fit: Fit, deviations: Floats) -> Setting:
    """Return the set-up of a fit, whose last unknowns are its numbers in these deviations."""
    of_setup = slice(-len(deviations), None)
    # a square root of the covariance: its principal axes, each times its deviation
    axes, variances, _ = np.linalg.svd(fit.covariance[of_setup, of_setup], hermitian=True)
    return Setting(
        plate,
        numbers=fit.parameters[of_setup] * deviations,
        errors=deviations[:, None] * axes * np.sqrt(variances),
    )


def _first_parameters(plate: Plate, start: Candidate, place: Place | None) -> Floats:
    """Return the parameters of the sphere with a Hertzian impact that makes the first pulse."""
    case = plate.case
    density = float(sphere_density(case.sphere))
    modulus = contact_pair(case).effective_modulus
    radius, speed = sphere_of_pulse(start.impulse, start.duration, density, modulus, _RESTITUTION)
    x, y = start.place if place is None else place
    return np.array([x, y, np.log(radius), np.log(speed), start.touch])


def _expected_unknowns(plate: Plate, sensors: int, of_setup: int) -> Floats:
    """Return the means of the unknowns by their priors, in their standard deviations."""
    missing, deviation = compliance_error(plate, plate.problem)
    of_compliance = missing / deviation if deviation else 0.0
    of_contact = [1.0 / _NEXT_OCTAVE, 1.0, of_compliance]
    return np.append(of_contact, np.zeros(sensors + len(plate.frequency_errors) + of_setup))


def _largest_steps(plate: Plate, measured: Measured, unknowns: int) -> Floats:
    """Return the largest change of each parameter and unknown in a step of the fit.

    Errors of the model, in which the records are linear, have no limit.
    """
    low, high = plate.bounds
    sensors = len(measured.sensors)
    deviations = plate.errors.deviations(sensors)
    of_setup = np.concatenate([_LARGEST_STEPS[:2], np.repeat(_LARGEST_STEPS[2:], sensors)])
    # what is certain has no deviation, and no limit: it does not move
    in_deviations = np.full(len(deviations), np.inf)
    np.divide(of_setup, deviations, out=in_deviations, where=deviations > 0.0)
    of_model = np.full(unknowns - len(deviations), np.inf)
    of_place = 0.03 * (high - low)
    return np.array([*of_place, 0.3, 0.3, 1.0 / measured.rate, *of_model, *in_deviations])


def _explained(plate: Plate, measured: Measured, parameters: Floats) -> _Explained:
    """Return what a sphere makes of the records, from its parameters and the unknowns.

    Unknowns are in their deviations.
    """
    names = tuple(sensor.name for sensor in measured.sensors)
    setup_deviations = plate.errors.deviations(len(names))
    place = np.clip(parameters[:2], *plate.bounds)
    log_radius, log_speed, touch = parameters[2:_FITTED]
    of_model = parameters[_FITTED : -len(setup_deviations)]
    numbers = parameters[-len(setup_deviations) :] * setup_deviations

    here = plate
    if not plate.errors.is_none:
        here = plate.under(Setup.of(numbers), names)
    position = (float(place[0]), float(place[1]))
    touched = here.at(position)
    forces = _contact_forces(plate, here, touched, position, numbers, names, log_radius, log_speed)
    impact = _Impact(measured, names, plate, here, touched, numbers, place, touch, forces)
    force = forces.of_sphere

    by_model = impact.by_model
    slopes = np.concatenate(
        [
            np.stack(impact.by_parameters),
            by_model,
            setup_deviations[:, None, None] * impact.by_setup,
        ]
    )
    facts_by_contact = impact.contact_deviations * impact.facts_by(forces.by_model)
    facts_by_setup = np.zeros((len(force.facts), len(setup_deviations)))
    for number, changed in forces.by_setup.items():
        facts_by_setup[:, number] = (changed.facts - force.facts) / STEPS[number]
    force_slopes = [
        np.zeros((3, 2)),  # the force is taken as the same at neighbouring places
        impact.facts_by([forces.larger, forces.faster]) / _RATIO,
        np.zeros((3, 1)),  # when it touches does not matter
        facts_by_contact,
        np.zeros((len(force.facts), len(by_model) - _OF_CONTACT)),
        facts_by_setup * setup_deviations,
    ]
    return _Explained(
        misfit=impact.bare + np.tensordot(of_model, by_model, 1) - measured.value,
        slopes=np.moveaxis(slopes, 0, -1),
        force=replace(force, facts=force.facts + facts_by_contact @ of_model[:_OF_CONTACT]),
        force_slopes=np.concatenate(force_slopes, axis=1),
        problem=touched,
        plate=here,
    )


@dataclass(frozen=True, eq=False)
class _Impact:
    """A sphere that hits a plate at a place, and its records with their derivatives.

    `stated`: the plate as the case states it; `here`: in its set-up, which has the `numbers`;
    `touched`: with the contact at the place [m]. `touch`: first touch after the first sample [s].
    """

    measured: Measured
    names: tuple[str, ...]
    stated: Plate
    here: Plate
    touched: Problem
    numbers: Floats
    place: Floats
    touch: float
    forces: _Forces

    @cached_property
    def gains(self) -> Floats:
        """What each sensor reads, over what it should, (S, 1)."""
        return 1.0 + Setup.of(self.numbers).gain[:, None]

    @cached_property
    def heard(self) -> PlaceResponses:
        """Responses of the sensors to forces anywhere on the plate."""
        return self.here.heard(self.names)

    @cached_property
    def responses(self) -> Floats:
        """Responses of the sensors to a unit impulse at the place, (S, points)."""
        shapes = shapes_of(self.touched)
        compliances = compliances_of(self.touched, self.names)
        return self.heard.at(shapes, compliances)

    def signals(
        self, responses: Floats, force: ContactForce | None = None, later: float = 0.0
    ) -> Floats:
        """Return the records of sensors with some responses, of its contact force or another."""
        if force is None:
            force = self.forces.of_sphere
        times = self.touch + later + force.time
        samples = self.measured.value.shape[1]
        return self.gains * sampled_responses(
            responses, self.measured.rate, times, force.impulse, samples
        )

    @cached_property
    def bare(self) -> Floats:
        """Its records, without errors of the model, (S, samples)."""
        return self.signals(self.responses)

    def change(self, force: ContactForce) -> Floats:
        """Return by how much the records of another contact force differ."""
        return self.signals(self.responses, force) - self.bare

    def facts_by(self, forces: Sequence[ContactForce]) -> Floats:
        """Return by how much the facts of other contact forces differ, (3, n)."""
        facts = self.forces.of_sphere.facts
        return np.stack([force.facts - facts for force in forces], axis=1)

    @property
    def by_parameters(self) -> list[Floats]:
        """Derivatives in x, y, logarithms of radius and speed, and first touch."""
        nudges = _NUDGE * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
        at_place, *beside = self.here.deflections(self.place + nudges)
        no_compliance = np.zeros(len(self.names))
        by_place = [
            self.signals(self.heard.at((shapes - at_place) / _NUDGE, no_compliance))
            for shapes in beside
        ]
        later = _LEAP / self.measured.rate
        return [
            *by_place,
            self.change(self.forces.larger) / _RATIO,
            self.change(self.forces.faster) / _RATIO,
            (self.signals(self.responses, later=later) - self.bare) / later,
        ]

    @property
    def contact_deviations(self) -> Floats:
        """Standard deviations of the unknowns of the contact, in changes of its force, (3,)."""
        return self.here.model_error * np.array([_NEXT_OCTAVE, 1.0, 1.0])

    @cached_property
    def by_model(self) -> Floats:
        """Derivatives in the errors of the model, in their deviations, the contact's first."""
        contact_changes = [self.change(force) for force in self.forces.by_model]
        force = self.forces.of_sphere
        path_changes = model_error_signals(
            self.here,
            self.touched,
            self.names,
            self.measured.rate,
            self.touch + force.time,
            force.impulse,
            self.measured.value.shape[1],
        )
        return np.concatenate(
            [
                self.contact_deviations[:, None, None] * contact_changes,
                self.gains * path_changes,
            ]
        )

    @property
    def by_setup(self) -> Floats:
        """Derivatives in the numbers of the set-up, (2 + 4 S, S, samples).

        The set-up changes the way to the sensors, and the plate that is touched.
        """
        if self.stated.errors.is_none:
            return np.zeros((len(self.numbers), *self.bare.shape))

        def without_gains(responses: Floats) -> Floats:
            return self.signals(responses) / self.gains

        position = (float(self.place[0]), float(self.place[1]))
        slopes = setup_slopes(
            self.stated, self.here, self.numbers, self.names, position, without_gains
        )
        for number, force in self.forces.by_setup.items():
            slopes[number] += self.change(force) / STEPS[number]
        return slopes


class _Forces(NamedTuple):
    """Contact forces of a sphere, and of what differs a little from it.

    `of_sphere`: its own. `larger`, `faster`: with another radius, and another speed. `by_model`:
    with each error of the contact. `by_setup`: on plates of other set-ups, by their number.
    """

    of_sphere: ContactForce
    larger: ContactForce
    faster: ContactForce
    by_model: list[ContactForce]
    by_setup: dict[int, ContactForce]


def _contact_forces(
    plate: Plate,
    here: Plate,
    touched: Problem,
    position: Place,
    numbers: Floats,
    names: Sequence[str],
    log_radius: float,
    log_speed: float,
) -> _Forces:
    """Return the contact forces of a sphere and of what differs from it, computed side by side.

    The sphere touches a plate in a set-up with some numbers, `here`, at a position.
    """
    radii = np.exp(log_radius + _RATIO * np.array([0, 1, 0]))
    speeds = np.exp(log_speed + _RATIO * np.array([0, 0, 1]))
    _, compliance_deviation = compliance_error(here, touched)
    wrong_models = [
        *with_modes_left_out(touched),
        with_compliance(touched, compliance_deviation),
    ]
    spheres = [Spheres(here.touched, touched, radii, speeds)]
    for problem in wrong_models:
        spheres.append(Spheres(here.touched, problem, radii[:1], speeds[:1]))

    sensors = len(names)
    deviations = plate.errors.deviations(sensors)
    uncertain = np.flatnonzero(deviations[:OF_PLATE]).tolist()
    for number in uncertain:
        step = STEPS[number] * numbers_of(number, sensors)
        other = plate.under(Setup.of(numbers + step), names)
        spheres.append(Spheres(other.touched, other.at(position), radii[:1], speeds[:1]))

    of_sphere, larger, faster, *changed = contact_forces_of(spheres)
    return _Forces(
        of_sphere,
        larger,
        faster,
        by_model=changed[:_OF_CONTACT],
        by_setup=dict(zip(uncertain, changed[_OF_CONTACT:], strict=True)),
    )
