"""Drops on bodies whose modes are made by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import vibroimpact as vi
from oracles.modal_integration import Drop
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.structures.modal_model import ModalBasis

STIFFNESS = 5.1154524848e8


def modes_of(frequencies: ArrayLike, contact: ArrayLike, damping: ArrayLike = 0.0) -> ModalBasis:
    """Modes of given frequencies [Hz], motions of the contact point [kg^-1/2] and damping
    ratios, sorted.
    """
    frequencies = np.atleast_1d(np.asarray(frequencies, dtype=float))
    order = np.argsort(frequencies)
    contact, damping = (
        np.broadcast_to(np.asarray(part, dtype=float), frequencies.shape)[order]
        for part in (contact, damping)
    )
    points = {"a": np.outer(contact, [0.0, 0.0, 1.0])}
    return ModalBasis(
        frequencies[order], damping, contact, np.outer(contact, [0.0, 0.0, 1.0]), points, 1.0
    )


def random_modes(
    seed: int, number: int, lowest: float, highest: float, size: float, damping: float = 0.0
) -> ModalBasis:
    """Modes spread over the octaves, with motions of the contact point of either sign and
    a standard deviation of `size` [kg^-1/2].
    """
    random = np.random.default_rng(seed)
    frequencies = np.exp(random.uniform(np.log(lowest), np.log(highest), number))
    return modes_of(frequencies, size * random.normal(size=number), damping)


def drop_on(
    law: ContactLaw, plate: ModalBasis | None = None, sphere: ModalBasis | None = None, **more: Any
) -> vi.Problem:
    """The paper's sphere, without an indentation of its own but that of the law, at 3 m/s
    unless said otherwise.
    """
    given = {"speed": 3.0, "gravity": 9.8, "impacts": 1, **more}
    if "height" in given:
        del given["speed"]
    bodies = {
        "sphere": vi.Body(mass=0.09032078879, contact_offset=0.025, modes=sphere),
        "plate": vi.Body(mass=np.inf, contact_offset=0.0, modes=plate),
    }
    return vi.Problem(laws=(law,), **bodies, **given)


def oracle(problem: vi.Problem, **settings: float) -> Drop:
    """The same drop, as the oracle takes it from first touch."""
    law = problem.laws[0]
    assert isinstance(law, CompliantLaw)
    bodies = [
        (body, sign)
        for body, sign in ((problem.sphere.modes, -1.0), (problem.plate.modes, 1.0))
        if body is not None
    ]

    def of(parts: list[np.ndarray]) -> np.ndarray:
        return np.concatenate([np.zeros(0), *parts])

    def force(delta: float, speed: float) -> tuple[float, float]:
        static, dashpot = law.forces(np.array(delta), np.ones(()), np.array(speed))
        return float(static), float(dashpot)

    fall = (
        0.0
        if problem.height is None
        else float(problem.height) - float(problem.sphere.contact_offset)
    )
    speed = (
        float(problem.speed)
        if problem.speed is not None
        else float(np.sqrt(2.0 * problem.gravity * fall))
    )
    inside = of(
        [np.full(len(body.contact), sign < 0.0 and problem.sphere_inside) for body, sign in bodies]
    ).astype(bool)
    return Drop(
        float(problem.sphere.mass),
        float(problem.gravity),
        of([body.angular_frequencies for body, _ in bodies]),
        of([body.damping_ratios for body, _ in bodies]),
        of([sign * body.contact for body, sign in bodies]),
        force,
        speed,
        inside,
        problem.local_element,
        problem.quasi_static.linear,
        True,
        **settings,
    )
