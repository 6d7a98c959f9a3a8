"""The restitution that a law achieves, in closed form or by integration, and its inverse.

Always without gravity: for a mass that comes with a speed and leaves with another.
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import fields
from typing import TypeVar

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import interpreted
from vibroimpact.contact.law import CompliantLaw, ContactLaw, InstantaneousLaw
from vibroimpact.contact.roots import solve_monotonic
from vibroimpact.dynamics.motion.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.rigid.line_contact import FEW, release_rates
from vibroimpact.dynamics.statement.tolerance import DEFAULT_TOLERANCE, check_tolerance
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.ranges import Range

Law = TypeVar("Law", bound=ContactLaw)

_INVERSE_TOLERANCE = 1e-12


def achieved_restitution(
    law: ContactLaw, mass: Array, speed: Array, *, tolerance: float = DEFAULT_TOLERANCE
) -> Array:
    """Return the coefficient of restitution that results from a contact law.

    It is that of its closed form where there is one, else that of an integration.

    Parameters
    ----------
    law : ContactLaw
        The law; its parameters may be arrays.
    mass : float or array
        Effective mass of the pair [kg], > 0; of a sphere on a plate that is held, the sphere's.
    speed : float or array
        Approach speed [m/s], > 0.
    tolerance : float, default 1e-9
        Relative error allowed where it is integrated, from 1e-13 to 1e-6.

    Returns
    -------
    float or array
        Separation speed over approach speed [-], in the shape that the arguments and the law's
        parameters have together; zero where the bodies stick.

    Raises
    ------
    InputError
        If mass or speed is not positive and finite, the shapes do not agree, or the tolerance is
        out of range.
    ComputationError
        If the contact can't be integrated.

    See Also
    --------
    integrated_restitution : by integration always.

    Examples
    --------
    >>> from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
    >>> law = HuntCrossley(stiffness=5e8, restitution=0.7)
    >>> [round(float(achieved_restitution(law, 0.09, v)), 4) for v in (1.0, 3.0)]
    [0.768, 0.768]
    """
    shape = _shape(law, mass, speed)
    closed_form = law.closed_form_restitution(
        np.asarray(mass, dtype=float), np.asarray(speed, dtype=float)
    )
    if closed_form is None:
        return integrated_restitution(law, mass, speed, tolerance=tolerance)
    return np.broadcast_to(closed_form, shape)[()]


def integrated_restitution(
    law: ContactLaw, mass: Array, speed: Array, *, tolerance: float = DEFAULT_TOLERANCE
) -> Array:
    """Return the restitution that a law achieves, by integrating the contact.

    Parameters
    ----------
    law : ContactLaw
        The law; its parameters may be arrays.
    mass : float or array
        Effective mass of the pair [kg], > 0.
    speed : float or array
        Approach speed [m/s], > 0.
    tolerance : float, default 1e-9
        Relative error allowed.

    See Also
    --------
    achieved_restitution : says more of arguments, result and errors.

    Examples
    --------
    >>> from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
    >>> law = HuntCrossley(stiffness=5e8, restitution=0.7)
    >>> float(
    ...     abs(integrated_restitution(law, 0.09, 3.0) - achieved_restitution(law, 0.09, 3.0))
    ... ) < 1e-9
    True
    """
    check_tolerance(tolerance)
    restitution = _by_integration(law, mass, speed, tolerance)
    failed = np.isnan(restitution)
    if failed.any():
        raise ComputationError(
            f"{law.name} could not be integrated to the tolerance for "
            f"{int(failed.sum())} of {np.size(restitution)} drops"
        )
    return restitution


def _by_integration(law: ContactLaw, mass: Array, speed: Array, tolerance: float) -> Array:
    """Return the restitution achieved, NaN where the contact could not be integrated."""
    shape = _shape(law, mass, speed)
    if isinstance(law, InstantaneousLaw):
        return np.broadcast_to(law.closed_form_restitution(mass, speed), shape)[()]
    assert isinstance(law, CompliantLaw)

    def flat(value: Array) -> Array:
        return np.broadcast_to(value, shape).ravel()

    masses = flat(np.asarray(mass, dtype=float))
    speeds = flat(np.asarray(speed, dtype=float))
    arrays = {}
    for field in fields(law):
        value = getattr(law, field.name)
        if np.ndim(value):
            arrays[field.name] = flat(value)
    laws = law.changed(arrays)
    # for a few contacts the compiler takes longer to load than they take in plain Python
    running = interpreted() if len(masses) < FEW else nullcontext()
    with running:
        conditions = impact_conditions_of(laws, masses, np.zeros(len(masses)), speeds)
    with np.errstate(all="ignore"):  # Newton iterates may overflow
        return np.abs(release_rates(conditions, tolerance) / speeds).reshape(shape)[()]


def law_achieving(law: Law, restitution: Array, mass: Array, speed: Array) -> Law:
    """Tune the free parameter of a contact law to a given coefficient of restitution.

    Parameters
    ----------
    law : ContactLaw
        The law; all but its free parameter stays.
    restitution : float or array
        Restitution to achieve, without gravity [-].
    mass : float or array
        Effective mass of the pair [kg].
    speed : float or array
        Approach speed [m/s].

    Raises
    ------
    InputError
        If no value of the parameter achieves it; the message names the range that can be reached.

    Examples
    --------
    >>> from vibroimpact.contact.laws.flores import Flores
    >>> law = law_achieving(
    ...     Flores(stiffness=5e8, restitution=0.7), restitution=0.7, mass=0.09, speed=3.0
    ... )
    >>> round(law.restitution, 6)
    0.715939
    """
    target = np.asarray(restitution, dtype=float)
    mass = np.asarray(mass, dtype=float)
    speed = np.asarray(speed, dtype=float)
    try:
        Range(at_least=0, at_most=1).check(target)
    except InputError as error:
        raise InputError(error.message, "restitution") from None
    name = law.free_parameter
    if name is None:
        fixed = np.asarray(achieved_restitution(law, mass, speed))
        if np.all(np.abs(fixed - target) <= 1e-12):
            return law
        raise InputError(
            f"{law.name} has no loss parameter; it achieves {_between(fixed)}, not "
            f"{_between(target, 12)}"
        )
    shape = np.broadcast_shapes(_shape(law, mass, speed), target.shape)
    parameter = next(field for field in fields(law) if field.name == name)
    allowed: Range = parameter.metadata["range"]

    def achieved(value: Array) -> Array:
        trial = law.changed({name: value})
        closed_form = trial.closed_form_restitution(mass, speed)
        if closed_form is None:
            return np.asarray(_by_integration(trial, mass, speed, _INVERSE_TOLERANCE))
        return np.asarray(closed_form)

    current = np.broadcast_to(np.asarray(getattr(law, name), dtype=float), shape)
    # the undamped law achieves the most
    damps = allowed.at_least == 0.0 and not np.isfinite(allowed.at_most)
    start = np.where(current > 0.0, current, 1.0)
    solution = solve_monotonic(achieved, target, start, allowed, falls=damps)
    missed = np.isnan(solution.place)
    if missed.any():
        first = np.flatnonzero(missed.ravel())[0]
        least, most, speed_of_first, target_of_first = (
            float(np.broadcast_to(value, shape).ravel()[first])
            for value in (solution.least, solution.most, speed, target)
        )
        highest = _apart(most, target_of_first)
        if damps and target_of_first > most:
            reach = f"up to {highest}"
        else:
            reach = f"from {_apart(least, target_of_first)} to {highest}"
        raise InputError(
            f"{law.name} reaches restitutions {reach} at {speed_of_first:.4g} m/s, "
            f"not {target_of_first:g}"
        )
    place = solution.place if shape else float(solution.place)
    return law.changed({name: place})


def _between(values: Array, digits: int = 4) -> str:
    """Return the range of values in some digits, or their common value."""
    least = float(np.min(values))
    most = float(np.max(values))
    if least == most:
        return f"{least:.{digits}g}"
    return f"{least:.{digits}g} to {most:.{digits}g}"


def _apart(value: float, limit: float) -> str:
    """Return a value in four digits, or in as many as show on which side of a limit it lies.

    Examples
    --------
    >>> _apart(0.662871, 0.5), _apart(0.9999702, 1.0)
    ('0.6629', '0.99997')
    """
    for digits in range(4, 17):
        text = f"{value:.{digits}g}"
        if float(text) != limit and (float(text) < limit) == (value < limit):
            return text
    return f"{value:.4g}"


def _shape(law: ContactLaw, mass: Array, speed: Array) -> tuple[int, ...]:
    """Return the common shape of the validated arguments."""
    if not isinstance(law, ContactLaw):
        raise InputError(
            "law must be a contact law with its parameters, such as "
            f'vi.laws.find_contact_law("hertz")(stiffness=5e8), not {law!r}'
        )
    for name, value, unit in (("mass", mass, "kg"), ("speed", speed, "m/s")):
        try:
            Range(above=0).check(value, unit)
        except InputError as error:
            raise InputError(error.message, name) from None
    values = [mass, speed, *(getattr(law, item.name) for item in fields(law))]
    try:
        return np.broadcast_shapes(*(np.shape(value) for value in values if value is not None))
    except ValueError:
        raise InputError(
            "the arrays of mass, speed and the law's parameters must agree in shape"
        ) from None
