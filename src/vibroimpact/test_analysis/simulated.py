"""What the sensors of a case read: of its own impact, or of a force that was measured."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.build import problem_of
from vibroimpact.cases.oblique import oblique_keys
from vibroimpact.cases.schema import CaseTable
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.dynamics.sensors.place_responses import responses_at, sampled_responses
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import InputError
from vibroimpact.identification.plate import compliances_of, shapes_of

_NODES = np.polynomial.legendre.leggauss(96)
"""Nodes on [-1, 1] and weights of the quadrature of a force."""
_SPAN = 16.0
"""Samples within a quadrature."""
_BEFORE = 4 * HALF_LENGTH
"""Samples before a record that are computed too: what begins before it may reach into it."""


@dataclass(frozen=True)
class Pushes:
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
    if keys := oblique_keys(case):
        raise InputError("only a normal impact can be correlated; leave this out", keys[0])
    if not case.sensors:
        raise InputError(
            "the case has no sensors; give those of the records, with their positions", "sensors"
        )
    return problem_of(case, progress)


def pushes_of_impact(problem: Problem, rate: float, duration: float, impacts: int | None) -> Pushes:
    """Return the contact forces of a problem, in time since the first touch.

    Parameters
    ----------
    problem : Problem
        The problem.
    rate : float
        Rate at which they are heard [Hz].
    duration : float
        Time from the first touch on within which contacts are sought [s].
    impacts : int, optional
        Impacts after which no more are sought; None for all.
    """
    speed = problem.speed
    if speed is None:
        speed = (
            simulate(replace(problem, impacts=1, duration=None, sensors=()))
            .impacts["approach_speed_m_s"]
            .flat[0]
        )
    response = simulate(
        replace(
            problem,
            height=None,
            velocity=0.0,
            speed=float(speed),
            impacts=impacts,
            duration=duration,
            sensors=(),
        )
    )
    begin, lasting = (response.impacts[name].ravel() for name in ("time_s", "duration_s"))
    nodes, weights = _NODES
    times, impulses = [], []
    for first, span in zip(begin.tolist(), lasting.tolist(), strict=True):
        edges = first + np.linspace(0.0, span, int(np.ceil(span * rate / _SPAN)) + 1)
        half = 0.5 * np.diff(edges)[:, None]
        time = (edges[:-1, None] + half * (1.0 + nodes)).ravel()
        times.append(time)
        impulses.append((half * weights).ravel() * response.at(time, ["force_N"])["force_N"])
    return Pushes(
        np.concatenate(times), np.concatenate(impulses), np.stack([begin, begin + lasting], axis=1)
    )


@dataclass(frozen=True)
class Listening:
    """Sensors that hear a force at the contact point of a plate.

    Parameters
    ----------
    answers : array, shape (S, points)
        Their responses to a unit impulse, as of `PlaceResponses`.
    rate : float
        Samples per second [Hz].
    samples : int
        Number of samples.
    """

    answers: Floats
    rate: float
    samples: int

    def to(self, pushes: Pushes, at: float) -> Floats:
        """Return the samples, (S, samples), of pushes whose time begins at a time after
        the first sample [s].
        """
        times = pushes.time + at + _BEFORE / self.rate
        heard = times >= 0.0
        whole = sampled_responses(
            self.answers, self.rate, times[heard], pushes.impulse[heard], self.samples + _BEFORE
        )
        return whole[:, _BEFORE:]


def listening(problem: Problem, sensors: Sequence[Sensor], samples: int) -> Listening:
    """Return sensors that hear the plate of a problem for a number of samples.

    Raises
    ------
    InputError
        If one of them is a microphone, or has no anti-alias filter.
    """
    rate = sensors[0].rate
    there = replace(problem, sensors=tuple(sensors))
    compliance = compliances_of(there, [sensor.name for sensor in sensors])
    return Listening(
        responses_at(there, sensors, (samples + _BEFORE) / rate, shapes_of(there), compliance),
        rate,
        samples,
    )
