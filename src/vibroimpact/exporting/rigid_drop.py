"""The drop that a program with rigid bodies can be told of: the same case, in which nothing but the contact deforms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.calibration.single_impacts import first_approach_speed
from vibroimpact.calibration.speed_function import SpeedFunction
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.exporting.contact_alone import law_at
from vibroimpact.exporting.drop import Drop

_PASSES = 50
_SAME = 1e-11


def as_rigid(drop: Drop) -> Drop:
    """Return a drop with its bodies taken as rigid, simulated anew, as a program that knows rigid bodies alone will move it.

    The values of the contact law stay in the order of the impacts: the first goes with the first impact of the rigid bodies, and so
    on, whose approach speeds are other ones than those of bodies that take up energy. A drop of rigid bodies is returned as it is,
    unless a parameter follows a function of the approach speed; then its impacts are those under the function.
    """
    if drop.rigid is None:
        return drop
    response = simulate(drop.rigid) if drop.function is None else _by_function(drop.rigid, *drop.function)
    deforms = bool(drop.elastic or drop.local_element or drop.finite_sphere)
    return replace(
        drop,
        name=f"{drop.name}, rigid" if deforms else drop.name,
        rigid=None,
        here=drop.impacts if deforms else {},
        end_time=float(response.end_time[0]),
        impacts=response.impacts,
        history={},
        signals={},
        surface={},
    )


def _by_function(problem: Problem, name: str, function: SpeedFunction) -> Response:
    """Return the run in which each impact has the value of the function at its own approach speed.

    The speed of an impact depends on the values of those before it alone, so that each pass makes one more of them right; most of
    them it makes right much sooner, as the value changes little with the speed.
    """
    law, speeds = problem.laws[0], np.array([first_approach_speed(problem)])
    for _ in range(_PASSES):
        response = simulate(replace(problem, laws=tuple(law_at(law, name, function, float(speed)) for speed in speeds)))
        before, speeds = speeds, response.impacts["approach_speed_m_s"]
        if not len(speeds) or (len(speeds) == len(before) and np.allclose(speeds, before, rtol=_SAME, atol=0.0)):
            break
    return response
