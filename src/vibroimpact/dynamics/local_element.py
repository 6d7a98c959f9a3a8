"""Stiffness and damping of a local element, from the largest force and rebound of one impact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import ComputationError, InputError

_WITHIN = 1e-9  # relative, of force and speed
_SWEEPS = 40
_STEP = 1e-4  # relative, of difference quotients
# damping over that of a critical oscillator of the sphere's mass, to search
_DAMPING_RATIOS = (1e-4, *np.geomspace(0.02, 50.0, 8).tolist())


def identify_local_element(
    problem: Problem,
    max_force: float,
    *,
    separation_speed: float | None = None,
    rebound_height: float | None = None,
) -> tuple[float, float]:
    """Identify the stiffness [N/m] and damping [N s/m] of a contact from a measured impact.

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
    if rebound_height is None:
        rebound = separation_speed
        column = "separation_speed_m_s"
        unit = "m/s"
    else:
        rebound = rebound_height
        column = "rebound_height_m"
        unit = "m"
    measured = np.array([max_force, rebound], dtype=float)
    problem = replace(problem, impacts=1, duration=None, local_element=None)

    def outcome(element: tuple[float, float] | None) -> Floats:
        return _outcome(problem, element, column)

    force_without_element, _ = outcome(None)
    if not max_force < force_without_element:
        raise InputError(
            "a local element only makes the impact softer: without one the largest force "
            f"is {force_without_element:.5g} N, and {max_force:.5g} N was measured"
        )
    mass = float(problem.sphere.mass)
    speed = float(simulate(problem).impacts["approach_speed_m_s"][0])
    # of a linear spring with that largest force, v sqrt(k m)
    spring_stiffness = (max_force / speed) ** 2 / mass

    def deviations(logarithms: Floats) -> Floats:
        stiffness, damping = np.exp(logarithms).tolist()
        return np.asarray(outcome((stiffness, damping)) / measured - 1.0)

    for damping_ratio in (1.0, 0.2, 5.0):
        start_damping = 2.0 * damping_ratio * np.sqrt(spring_stiffness * mass)
        logarithms = _newton(deviations, np.log([spring_stiffness, start_damping]))
        if logarithms is not None:
            stiffness, damping = np.exp(logarithms).tolist()
            return stiffness, damping
    reached = _reached(outcome, max_force, spring_stiffness, mass)
    if not reached or min(reached) <= measured[1] <= max(reached):
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
    """Return the standard deviations of stiffness [N/m] and damping [N s/m] of a local element.

    The element is identified from force and rebound. Independent errors are propagated linearly.

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
    stiffness, damping = element

    def outcome(stiffness: float, damping: float) -> Floats:
        return _outcome(problem, (stiffness, damping), "separation_speed_m_s")

    # central differences of force and speed
    higher = 1.0 + _STEP
    lower = 1.0 - _STEP
    change = outcome(stiffness * higher, damping) - outcome(stiffness * lower, damping)
    by_stiffness = change / (2.0 * _STEP * stiffness)
    change = outcome(stiffness, damping * higher) - outcome(stiffness, damping * lower)
    by_damping = change / (2.0 * _STEP * damping)
    jacobian = np.array([by_stiffness, by_damping]).T
    errors = np.linalg.inv(jacobian) * [max_force_deviation, separation_speed_deviation]
    stiffness_deviation, damping_deviation = np.linalg.norm(errors, axis=1).tolist()
    return stiffness_deviation, damping_deviation


def _outcome(problem: Problem, element: tuple[float, float] | None, column: str) -> Floats:
    """Return the largest force [N] and a rebound of the first impact with a local element."""
    impacts = simulate(replace(problem, local_element=element)).impacts
    return np.array([impacts["max_force_N"][0], impacts[column][0]])


def _newton(function: Callable[[Floats], Floats], start: Floats) -> Floats | None:
    """Return a zero of a function of two variables by damped Newton iteration.

    It is None if that does not converge.
    """
    x = start
    try:
        value = function(x)
        for _ in range(_SWEEPS):
            if np.abs(value).max() < _WITHIN:
                return x
            slopes = np.stack(
                [(function(x + step) - value) / 1e-5 for step in 1e-5 * np.eye(2)], axis=1
            )
            step = np.linalg.solve(slopes, value)
            step *= min(1.0, 1.0 / float(np.abs(step).max()))
            # halved until the value decreases
            for _ in range(6):
                next_value = function(x - step)
                if np.abs(next_value).max() < np.abs(value).max():
                    break
                step = 0.5 * step
            else:
                return None
            x = x - step
            value = next_value
    except (np.linalg.LinAlgError, ComputationError, InputError):
        # an element too soft or too stiff for a number
        return None
    return None


def _reached(
    outcome: Callable[[tuple[float, float]], Floats],
    max_force: float,
    spring_stiffness: float,
    mass: float,
) -> list[float]:
    """Return the rebounds of elements that give the measured force, from low to high damping.

    They are empty if none is found.
    """
    rebounds = []
    for damping_ratio in _DAMPING_RATIOS:
        low = 1e-6 * spring_stiffness
        high = 1e6 * spring_stiffness
        # bisection: the force grows with the stiffness, as the damping is a fixed multiple of
        # critical damping
        for _ in range(40):
            stiffness = float(np.sqrt(low * high))
            damping = 2.0 * damping_ratio * float(np.sqrt(stiffness * mass))
            try:
                force, rebound = outcome((stiffness, damping)).tolist()
            except (ComputationError, InputError):  # too soft or too stiff to be computed
                break
            if force > max_force:
                high = stiffness
            else:
                low = stiffness
            if abs(force / max_force - 1.0) < 1e-3:
                rebounds.append(rebound)
                break
    return rebounds
