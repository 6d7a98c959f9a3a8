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
from vibroimpact.dynamics.impact_conditions import impact_conditions_of
from vibroimpact.dynamics.rigid.line_contact import FEW, release_rates
from vibroimpact.dynamics.tolerance import check_tolerance
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.ranges import Range

Law = TypeVar("Law", bound=ContactLaw)

_INVERSE_TOLERANCE = 1e-12


def achieved_restitution(
    law: ContactLaw, mass: Array, speed: Array, *, tolerance: float = 1e-9
) -> Array:
    """Return the restitution that a law achieves, by its closed form where there is one, else by
    integration.

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
    found = law.closed_form_restitution(
        np.asarray(mass, dtype=float), np.asarray(speed, dtype=float)
    )
    return (
        integrated_restitution(law, mass, speed, tolerance=tolerance)
        if found is None
        else np.broadcast_to(found, shape)[()]
    )


def integrated_restitution(
    law: ContactLaw, mass: Array, speed: Array, *, tolerance: float = 1e-9
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
    found = _by_integration(law, mass, speed, tolerance)
    if np.isnan(found).any():
        raise ComputationError(
            f"{law.name} could not be integrated to the tolerance for "
            f"{int(np.isnan(found).sum())} of {np.size(found)} drops"
        )
    return found


def _by_integration(law: ContactLaw, mass: Array, speed: Array, tolerance: float) -> Array:
    """Return the restitution achieved, NaN where the contact could not be integrated."""
    shape = _shape(law, mass, speed)
    if isinstance(law, InstantaneousLaw):
        return np.broadcast_to(law.closed_form_restitution(mass, speed), shape)[()]
    assert isinstance(law, CompliantLaw)
    masses, speeds = (
        np.broadcast_to(np.asarray(value, dtype=float), shape).ravel() for value in (mass, speed)
    )
    arrays = {item.name: value for item in fields(law) if np.ndim(value := getattr(law, item.name))}
    flat = law.changed(
        {name: np.broadcast_to(value, shape).ravel() for name, value in arrays.items()}
    )
    with interpreted() if len(masses) < FEW else nullcontext():
        conditions = impact_conditions_of(flat, masses, np.zeros(len(masses)), speeds)
    with np.errstate(all="ignore"):  # Newton iterates may overflow
        return np.abs(release_rates(conditions, tolerance) / speeds).reshape(shape)[()]


def law_achieving(law: Law, restitution: Array, mass: Array, speed: Array) -> Law:
    """Return a law whose free parameter is set so that it achieves a given restitution.

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
    wanted, mass, speed = (np.asarray(value, dtype=float) for value in (restitution, mass, speed))
    try:
        Range(at_least=0, at_most=1).check(wanted)
    except InputError as error:
        raise InputError(error.message, "restitution") from None
    name = law.free_parameter
    if name is None:
        now = np.asarray(achieved_restitution(law, mass, speed))
        if np.all(np.abs(now - wanted) <= 1e-12):
            return law
        raise InputError(
            f"{law.name} has no loss parameter; it achieves {_between(now)}, not "
            f"{_between(wanted, 12)}"
        )
    shape = np.broadcast_shapes(_shape(law, mass, speed), wanted.shape)
    allowed: Range = next(item for item in fields(law) if item.name == name).metadata["range"]

    def achieved(value: Array) -> Array:
        trial = law.changed({name: value})
        found = trial.closed_form_restitution(mass, speed)
        return np.asarray(
            _by_integration(trial, mass, speed, _INVERSE_TOLERANCE) if found is None else found
        )

    now = np.broadcast_to(np.asarray(getattr(law, name), dtype=float), shape)
    # the undamped law achieves the most
    damps = allowed.at_least == 0.0 and not np.isfinite(allowed.at_most)
    found = solve_monotonic(achieved, wanted, np.where(now > 0.0, now, 1.0), allowed, falls=damps)
    missed = np.isnan(found.place)
    if missed.any():
        first = np.flatnonzero(missed.ravel())[0]
        numbers = (
            float(np.broadcast_to(value, shape).ravel()[first])
            for value in (found.least, found.most, speed, wanted)
        )
        least, most, at, asked = numbers
        highest = _apart(most, asked)
        reach = (
            f"up to {highest}"
            if damps and asked > most
            else f"from {_apart(least, asked)} to {highest}"
        )
        raise InputError(f"{law.name} reaches restitutions {reach} at {at:.4g} m/s, not {asked:g}")
    return law.changed({name: found.place if shape else float(found.place)})


def _between(values: Array, digits: int = 4) -> str:
    least, most = float(np.min(values)), float(np.max(values))
    return f"{least:.{digits}g}" if least == most else f"{least:.{digits}g} to {most:.{digits}g}"


def _apart(value: float, asked: float) -> str:
    """Return a value in four digits, or in as many as show on which side of the value asked for it
    lies.

    Examples
    --------
    >>> _apart(0.662871, 0.5), _apart(0.9999702, 1.0)
    ('0.6629', '0.99997')
    """
    texts = (f"{value:.{digits}g}" for digits in range(4, 17))
    return next(
        (
            text
            for text in texts
            if float(text) != asked and (float(text) < asked) == (value < asked)
        ),
        f"{value:.4g}",
    )


def _shape(law: ContactLaw, mass: Array, speed: Array) -> tuple[int, ...]:
    """Return the common shape of the validated arguments."""
    if not isinstance(law, ContactLaw):
        raise InputError(
            "law must be a contact law with its parameters, such as "
            f'vi.find_contact_law("hertz")(stiffness=5e8), not {law!r}'
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
