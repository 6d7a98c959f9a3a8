"""What the sensors of a case read: of its own impact, or of a force that was measured."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.build import problem_of
from vibroimpact.cases.rigid.oblique import oblique_keys
from vibroimpact.cases.sections.schema import CaseTable
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.place_responses import responses_at, sampled_responses
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.identification.plate import compliances_of, shapes_of

_QUADRATURE = np.polynomial.legendre.leggauss(96)
"""Nodes on [-1, 1] and weights of the Gauss quadrature of a force."""

_SPAN = 16.0
"""Samples within a quadrature."""

_BEFORE = 4 * HALF_LENGTH
"""Samples before a record that are computed too: what begins before it may reach into it."""


@dataclass(frozen=True)
class ForceImpulses:
    """A force on a plate.

    Parameters
    ----------
    time, impulse : array, shape (n,)
        Times [s] and impulses [N s] that stand for it.
    contacts : array, shape (contacts, 2)
        Begin and end of each contact, or of each pulse of a measured force [s].
    """

    time: Floats
    impulse: Floats
    contacts: Floats


def plate_problem(case: CaseTable, progress: Callable[[float], None] | None = None) -> Problem:
    """Return the problem of a case whose plate vibrates and is hit along its normal.

    Raises
    ------
    InputError
        If the plate is rigid or moves, the impact is oblique, or the case has no sensors.
    """
    if case.plate.model == "rigid":
        raise InputError(
            'the plate is rigid, so that its points do not move; give it model = "elastic"',
            "plate.model",
        )
    if case.plate.motion is not None:
        raise InputError(
            "only an impact on a plate at rest can be correlated; leave this out", "plate.motion"
        )
    keys = oblique_keys(case)
    if keys:
        raise InputError("only a normal impact can be correlated; leave this out", keys[0])
    if not case.sensors:
        raise InputError(
            "the case has no sensors; give those of the records, with their positions", "sensors"
        )
    return problem_of(case, progress)


def impact_force(
    problem: Problem, rate: float, duration: float, impacts: int | None
) -> ForceImpulses:
    """Return the contact forces of a problem, in time since the first touch.

    Parameters
    ----------
    problem : Problem
        The problem.
    rate : float
        Rate at which they are sampled [Hz].
    duration : float
        Time from the first touch on within which contacts are sought [s].
    impacts : int, optional
        Impacts after which no more are sought; None for all.
    """
    # it begins at the plate, so that its time is that since the first touch
    from_first_touch = replace(
        problem,
        height=None,
        velocity=0.0,
        speed=_approach_speed(problem),
        impacts=impacts,
        duration=duration,
        sensors=(),
    )
    response = simulate(from_first_touch)
    begins = response.impacts["time_s"].ravel()
    durations = response.impacts["duration_s"].ravel()
    nodes, weights = _QUADRATURE
    times = []
    impulses = []
    for begin, contact_duration in zip(begins.tolist(), durations.tolist(), strict=True):
        # a long contact is split, so that the nodes stay dense beside the samples
        interval_count = int(np.ceil(contact_duration * rate / _SPAN))
        edges = begin + np.linspace(0.0, contact_duration, interval_count + 1)
        half = 0.5 * np.diff(edges)[:, None]
        time = (edges[:-1, None] + half * (1.0 + nodes)).ravel()
        times.append(time)
        impulses.append((half * weights).ravel() * response.at(time, ["force_N"])["force_N"])
    return ForceImpulses(
        time=np.concatenate(times),
        impulse=np.concatenate(impulses),
        contacts=np.stack([begins, begins + durations], axis=1),
    )


def _approach_speed(problem: Problem) -> float:
    """Return the approach speed of the first impact [m/s]."""
    if problem.speed is not None:
        return float(problem.speed)
    first_impact = simulate(replace(problem, impacts=1, duration=None, sensors=())).impacts
    return float(first_impact["approach_speed_m_s"].flat[0])


@dataclass(frozen=True)
class ImpulseResponses:
    """Responses of sensors to an impulse at the contact point of a plate.

    Parameters
    ----------
    responses : array, shape (S, points)
        Their responses to a unit impulse, as of `PlaceResponses`.
    rate : float
        Samples per second [Hz].
    samples : int
        Number of samples.
    """

    responses: Floats
    rate: float
    samples: int

    def signals(self, force: ForceImpulses, start: float) -> Floats:
        """Return the samples, (S, samples), of the response to a force.

        The time of the force begins at `start` after the first sample [s].
        """
        times = force.time + start + _BEFORE / self.rate
        computed = times >= 0.0
        signals = sampled_responses(
            self.responses,
            self.rate,
            times[computed],
            force.impulse[computed],
            self.samples + _BEFORE,
        )
        return signals[:, _BEFORE:]


def impulse_responses(
    problem: Problem, sensors: Sequence[Sensor], samples: int
) -> ImpulseResponses:
    """Return the responses of sensors on the plate of a problem, for a number of samples.

    Raises
    ------
    InputError
        If one of them is a microphone, or has no anti-alias filter.
    """
    rate = sensors[0].rate
    with_sensors = replace(problem, sensors=tuple(sensors))
    responses = responses_at(
        with_sensors,
        sensors,
        (samples + _BEFORE) / rate,
        shapes_of(with_sensors),
        compliances_of(with_sensors, [sensor.name for sensor in sensors]),
    )
    return ImpulseResponses(responses, rate, samples)
