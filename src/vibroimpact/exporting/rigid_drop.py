"""The rigid-body version of a drop, for programs that support rigid bodies only: all
deformation is in the contact law.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.calibration.fit.single_impacts import first_approach_speed
from vibroimpact.contact.speed_function import SpeedFunction
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.exporting.contact_parameters import law_at, laws_at_impacts
from vibroimpact.exporting.drop import Drop

_PASSES = 50
_SAME = 1e-11


def as_rigid(drop: Drop) -> Drop:
    """Return the same drop between rigid bodies, simulated anew.

    The contact laws keep the order of the impacts: the first law is that of the first impact of the
    rigid bodies, and so on, though the approach speeds differ from those of elastic bodies, which
    absorb energy. A drop of rigid bodies is returned unchanged, unless a parameter is a function of
    the approach speed; then it is simulated with that function.

    Raises
    ------
    InputError
        If the sphere flies through air or touches in a liquid, or the plate is moved.
    """
    check_in_vacuum_at_rest(drop)
    if drop.rigid is None:
        return drop
    if drop.function is None:
        response = simulate(drop.rigid)
    else:
        response = _by_function(drop.rigid, *drop.function)
    laws = drop.laws
    if drop.rigid.by_speed:
        # rigid bodies meet at other speeds from the second impact on
        laws = laws_at_impacts(drop.rigid, response.impacts["approach_speed_m_s"])
    name = drop.name
    original_impacts: Mapping[str, Floats] = {}
    if drop.elastic or drop.local_element or drop.finite_sphere:
        name = f"{drop.name}, rigid"
        original_impacts = drop.impacts
    return replace(
        drop,
        name=name,
        laws=laws,
        rigid=None,
        original_impacts=original_impacts,
        end_time=float(response.end_time[0]),
        impacts=response.impacts,
        history={},
        signals={},
        surface={},
    )


def check_in_vacuum_at_rest(drop: Drop) -> None:
    """Check that a drop is in a vacuum, on a plate at rest.

    Raises
    ------
    InputError
        If the sphere flies through air or touches in a liquid, or the plate is moved.
    """
    if drop.motion is not None:
        raise InputError(
            "programs get a plate at rest; formats of data hold a drop on one that moves",
            "plate.motion",
        )
    if drop.in_air:
        raise InputError(
            "programs get drops in a vacuum; formats of data hold one in air", "drop.air"
        )
    if drop.in_liquid:
        raise InputError(
            "programs get contacts without a liquid; formats of data hold one in it",
            "contact.liquid",
        )


def _by_function(problem: Problem, name: str, function: SpeedFunction) -> Response:
    """Return the response in which the parameter of each impact is the function at its own approach
    speed.

    Fixed-point iteration: the speed of an impact depends on the impacts before it only, so that
    each pass fixes at least one more. Convergence is usually much faster, since the parameter
    varies slowly with the speed.
    """
    law = problem.laws[0]
    speeds = np.array([first_approach_speed(problem)])
    for _ in range(_PASSES):
        response = simulate(
            replace(
                problem, laws=tuple(law_at(law, name, function, float(speed)) for speed in speeds)
            )
        )
        before = speeds
        speeds = response.impacts["approach_speed_m_s"]
        if not len(speeds) or (
            len(speeds) == len(before) and np.allclose(speeds, before, rtol=_SAME, atol=0.0)
        ):
            break
    return response
