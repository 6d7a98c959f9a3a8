"""Spheres that lie on the plate and slip, roll and twist on it, as the core follows them."""

from __future__ import annotations

from contextlib import nullcontext

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.compiled import interpreted
from vibroimpact.contact.friction.law import FrictionLaw
from vibroimpact.dynamics.core.sphere_records import RubbedSphere, SphereState
from vibroimpact.dynamics.core.spheres_on_plate import is_in_closed_form, lie_on_plate
from vibroimpact.dynamics.motion.along import Sphere, State

_FEW = 5
"""Fewer spheres than these whose motion is in closed form do not load the compiler."""


def lie(
    sphere: Sphere,
    start: State,
    law: FrictionLaw | None,
    pressing: Floats,
    times: Floats,
    half: tuple[float, float] = (np.inf, np.inf),
) -> tuple[State, Floats, Floats]:
    """Return the motion of B spheres that lie on the plate, at T times each.

    Parameters
    ----------
    sphere : Sphere
        The spheres.
    start : State
        Their states at the beginning.
    law : FrictionLaw or None
        The friction law; None if there is no friction.
    pressing : array, shape (B,)
        Acceleration of gravity along the normal [m/s^2].
    times : array, shape (B, T)
        Times since the beginning [s], the last one of each the largest.
    half : tuple of two floats, optional
        Half the sides of the plate [m]; by default it has no edge.

    Returns
    -------
    states : State
        Their states then, with B T columns.
    friction : array, shape (2, B T)
        The friction forces on them [N].
    times : array, shape (B, T)
        The same times; of a sphere that has left the plate before, the one at which its centre
        first was beyond an edge.

    Examples
    --------
    A sphere that starts without spin ends up rolling with 5/7 of its velocity:

    >>> from vibroimpact.contact.friction.laws.coulomb import Coulomb
    >>> one = np.ones(1)
    >>> ball, start = (
    ...     Sphere(one, one, 0.4 * one, np.zeros((2, 1))),
    ...     State(np.zeros((2, 1)), np.array([[7.0], [0.0]]), np.zeros((3, 1))),
    ... )
    >>> state, _, _ = lie(ball, start, Coulomb(coefficient=0.1), 9.81 * one, np.array([[10.0]]))
    >>> state.velocity[0].round(12).tolist(), state.spin[1].round(12).tolist()
    ([5.0], [5.0])
    """
    spheres = sphere.rows(law)
    starts = start.rows
    times = times.copy()
    states = np.empty((*times.shape, len(SphereState._fields)))
    friction = np.empty((*times.shape, 2))
    running = interpreted() if _are_quick(spheres, starts, pressing) else nullcontext()
    with running:
        lie_on_plate(spheres, starts, pressing, half, times, states, friction)
    return State.of_rows(states.reshape(-1, states.shape[2])), friction.reshape(-1, 2).T, times


def _are_quick(spheres: Floats, starts: Floats, pressing: Floats) -> bool:
    """Are the motions computed sooner than the compiler is loaded?"""
    if len(spheres) >= _FEW:
        return False
    with interpreted():
        return all(
            is_in_closed_form(RubbedSphere(*sphere), SphereState(*start), pull)
            for sphere, start, pull in zip(
                spheres.tolist(), starts.tolist(), pressing.tolist(), strict=True
            )
        )
