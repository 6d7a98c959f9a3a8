"""Stiffness and damping of a local element, from the largest force and the rebound of one
impact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.errors import ComputationError, InputError

_WITHIN = 1e-9  # relative, of force and speed
_SWEEPS = 40
_STEP = 1e-4  # relative, of difference quotients
# damping over that of a critical oscillator of the sphere's mass, to search
_LOSSES = (1e-4, *np.geomspace(0.02, 50.0, 8).tolist())


def identify_local_element(
    problem: Problem,
    max_force: float,
    *,
    separation_speed: float | None = None,
    rebound_height: float | None = None,
) -> tuple[float, float]:
    """Return stiffness [N/m] and damping [N s/m] of the local element that reproduces a measured
    impact.

    Parameters
    ----------
    problem : Problem
        The drop; only its first impact counts, and a local element that it has does not.
    max_force : float
        Largest contact force of the first impact [N], > 0.
    separation_speed : float, optional
        Speed of the sphere's centre after it [m/s], > 0.
    rebound_height : float, optional
        Height of the sphere's centre at the top of its rebound [m], instead of the speed.

    Returns
    -------
    tuple of two floats
        Such that both are met to 1e-9.

    Raises
    ------
    InputError
        If no local element gives both, the message says what can be reached; or not one of speed
        and height is given.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> problem = vi.load_case("paper:type1-constant").to_problem()
    >>> stiffness, damping = identify_local_element(problem, 3582.036, rebound_height=0.26228)
    >>> f"{stiffness:.3g} N/m, {damping:.3g} N s/m"
    '1.16e+06 N/m, 581 N s/m'
    """
    if (separation_speed is None) == (rebound_height is None):
        raise InputError("give either separation_speed [m/s] or rebound_height [m]")
    column, rebound, unit = (
        ("separation_speed_m_s", separation_speed, "m/s")
        if rebound_height is None
        else ("rebound_height_m", rebound_height, "m")
    )
    wanted = np.array([max_force, rebound], dtype=float)
    problem = replace(problem, impacts=1, duration=None, local_element=None)

    def outcome(element: tuple[float, float] | None) -> Floats:
        return _outcome(problem, element, column)

    hard = outcome(None)
    if not max_force < hard[0]:
        raise InputError(
            "a local element only makes the impact softer: without one the largest force "
            f"is {hard[0]:.5g} N, and {max_force:.5g} N was measured"
        )
    mass = float(problem.sphere.mass)
    speed = float(simulate(problem).impacts["approach_speed_m_s"][0])
    soft = (max_force / speed) ** 2 / mass  # stiffness of a linear spring with that largest force

    def misses(logarithms: Floats) -> Floats:
        stiffness, damping = np.exp(logarithms).tolist()
        return np.asarray(outcome((stiffness, damping)) / wanted - 1.0)

    for loss in (1.0, 0.2, 5.0):
        found = _newton(misses, np.log([soft, 2.0 * loss * np.sqrt(soft * mass)]))
        if found is not None:
            stiffness, damping = np.exp(found).tolist()
            return stiffness, damping
    reached = _reached(outcome, max_force, soft, mass)
    if not reached or min(reached) <= wanted[1] <= max(reached):
        raise InputError(
            "no local element was found that gives both a largest force of "
            f"{max_force:.5g} N and a rebound of {rebound:.5g} {unit}; see "
            "whether both are of one impact, and in these units"
        )
    raise InputError(
        f"no local element gives both: with a largest force of {max_force:.5g} N the "
        f"rebound can be {min(reached):.3g} to "
        f"{max(reached):.3g} {unit}, and {rebound:.5g} {unit} was measured"
    )


def local_element_deviations(
    problem: Problem,
    element: tuple[float, float],
    max_force_deviation: float,
    separation_speed_deviation: float,
) -> tuple[float, float]:
    """Return the standard deviations of stiffness [N/m] and damping [N s/m] of a local element
    identified from force and rebound.

    By linear propagation of independent errors.

    Parameters
    ----------
    problem : Problem
        The drop; only its first impact counts.
    element : tuple of two floats
        Stiffness [N/m] and damping [N s/m], as `identify_local_element` found them.
    max_force_deviation, separation_speed_deviation : float
        Standard deviations of the largest force [N] and of the separation speed [m/s].

    Examples
    --------
    >>> import vibroimpact as vi
    >>> problem = vi.load_case("paper:type1-constant").to_problem()
    >>> element = identify_local_element(problem, 3582.036, rebound_height=0.26228)
    >>> stiffness, damping = local_element_deviations(problem, element, 36.0, 0.02)
    >>> f"{stiffness:.2g} N/m, {damping:.2g} N s/m"
    '2.4e+04 N/m, 9.5 N s/m'
    """
    problem = replace(problem, impacts=1, duration=None)
    column, slopes = "separation_speed_m_s", []
    for number in range(2):
        high, low = (
            [
                value * (1.0 + side * _STEP * (place == number))
                for place, value in enumerate(element)
            ]
            for side in (1.0, -1.0)
        )
        change = _outcome(problem, (high[0], high[1]), column) - _outcome(
            problem, (low[0], low[1]), column
        )
        slopes.append(change / (2.0 * _STEP * element[number]))
    noise = np.linalg.inv(np.array(slopes).T) * [max_force_deviation, separation_speed_deviation]
    stiffness, damping = np.linalg.norm(noise, axis=1).tolist()
    return stiffness, damping


def _outcome(problem: Problem, element: tuple[float, float] | None, column: str) -> Floats:
    """Return the largest force [N] and a rebound of the first impact with a local element."""
    impacts = simulate(replace(problem, local_element=element)).impacts
    return np.array([impacts["max_force_N"][0], impacts[column][0]])


def _newton(function: Callable[[Floats], Floats], start: Floats) -> Floats | None:
    """Return a zero of a function of two variables by damped Newton iteration, or None if
    it does not converge.
    """
    place = start
    try:
        value = function(place)
        for _ in range(_SWEEPS):
            if np.abs(value).max() < _WITHIN:
                return place
            slopes = np.stack(
                [(function(place + step) - value) / 1e-5 for step in 1e-5 * np.eye(2)], axis=1
            )
            step = np.linalg.solve(slopes, value)
            step *= min(1.0, 1.0 / float(np.abs(step).max()))
            for _ in range(6):
                new = function(place - step)
                if np.abs(new).max() < np.abs(value).max():
                    break
                step = 0.5 * step
            else:
                return None
            place, value = place - step, new
    except (np.linalg.LinAlgError, ComputationError, InputError):
        # an element too soft or too stiff for a number
        return None
    return None


def _reached(
    outcome: Callable[[tuple[float, float]], Floats], max_force: float, soft: float, mass: float
) -> list[float]:
    """Return the rebounds of elements that give the measured force, from low to high
    damping; empty if none is found.
    """
    reached = []
    for loss in _LOSSES:
        low, high = 1e-6 * soft, 1e6 * soft
        # bisection: the force grows with the stiffness, as the damping is a fixed multiple of
        # critical damping
        for _ in range(40):
            middle = float(np.sqrt(low * high))
            try:
                force, rebound = outcome(
                    (middle, 2.0 * loss * float(np.sqrt(middle * mass)))
                ).tolist()
            except (ComputationError, InputError):  # too soft or too stiff to be computed
                break
            low, high = (low, middle) if force > max_force else (middle, high)
            if abs(force / max_force - 1.0) < 1e-3:
                reached.append(rebound)
                break
    return reached
